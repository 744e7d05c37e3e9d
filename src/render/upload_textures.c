#include "render/upload_textures.h"

#include <stdlib.h>
#include <string.h>

#include "shaders/shared.h"

#define EFFECTS_WITH_TEXTURES (EFFECT_TEXTURES | EFFECT_NORMAL_MAPS | EFFECT_ALPHA)

// Words before the texels of each texture, and before the end: texture_count + 1.
struct layout {
    const struct scene *scene;
    uint64_t *first;
};

static uint64_t texel_bytes(const struct scene_texture *texture) { return 4ull * texture->width * texture->height; }

static bool layout_init(struct layout *out, struct context *ctx, const struct scene *scene) {
    *out = (struct layout){scene, array_alloc(ctx, (size_t)scene->texture_count + 1, sizeof *out->first, "textures")};
    if (!out->first) return false;
    out->first[0] = TEXEL_CODE_WORDS;
    for (uint32_t i = 0; i < scene->texture_count; i++)
        out->first[i + 1] = out->first[i] + (texel_bytes(&scene->textures[i]) + sizeof(struct word4) - 1) / sizeof(struct word4);
    return true;
}

static bool fill_textures(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct layout *layout = data;
    struct word4 *word = to;
    uint64_t number = offset / (TEXTURE_WORDS * sizeof *word);
    for (uint64_t left = size / (TEXTURE_WORDS * sizeof *word); left; left--, number++, word++) {
        const struct scene_texture *t = &layout->scene->textures[number];
        uint32_t ways = (uint32_t)t->wrap_u | (uint32_t)t->wrap_v << 2 | (t->nearest ? TEXTURE_NEAREST : 0);
        *word = (struct word4){{t->width, t->height, (uint32_t)layout->first[number], ways}};
    }
    return true;
}

// What is to be filled: bytes [offset, offset + size) of the array, at `to`.
struct part {
    char *to;
    uint64_t offset, size;
};

// Bytes [first, first + size) of the array are those at `from`: those of them that the part wants.
static void put_bytes(const struct part *part, uint64_t first, uint64_t size, const void *from) {
    uint64_t begin = part->offset > first ? part->offset : first;
    uint64_t end = part->offset + part->size < first + size ? part->offset + part->size : first + size;
    if (end > begin) memcpy(part->to + (begin - part->offset), (const char *)from + (begin - first), end - begin);
}

// Red, a texel's first byte, is the lowest of a word's component, as hosts that run Vulkan are little-endian. Nobody reads what lies
// between two textures.
static bool fill_texels(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct layout *layout = data;
    const struct part part = {to, offset, size};
    float codes[2][256];
    for (int code = 0; code < 256; code++) {
        codes[0][code] = transfer_decode(TRANSFER_SRGB, (uint8_t)code);
        codes[1][code] = transfer_decode(TRANSFER_LINEAR, (uint8_t)code);
    }
    put_bytes(&part, 0, sizeof codes, codes);
    for (uint32_t i = 0; i < layout->scene->texture_count; i++)
        put_bytes(&part, sizeof(struct word4) * layout->first[i], texel_bytes(&layout->scene->textures[i]),
                  layout->scene->textures[i].texels);
    return true;
}

// One array of `count` words.
static bool make(struct buffer *buffer, struct context *ctx, struct device *device, struct layout *layout, const char *name, uint64_t count,
                 bool (*fill)(void *data, void *to, uint64_t offset, uint64_t size)) {
    struct buffer_params params = {.name = name, .kind = BUFFER_TEXELS, .size = count * sizeof(struct word4), .host_writes = true};
    if (!buffer_init(buffer, ctx, device, &params)) return false;
    return count == 0 || buffer_fill(buffer, ctx, device, sizeof(struct word4), fill, layout);
}

bool device_textures_init(struct device_textures *out, struct context *ctx, struct device *device, const struct scene *scene,
                          uint32_t effects) {
    *out = (struct device_textures){0};
    struct layout layout = {0};
    bool used = effects & EFFECTS_WITH_TEXTURES && scene->texture_count > 0;
    bool ok = layout_init(&layout, ctx, scene) &&
              make(&out->textures, ctx, device, &layout, "textures", used ? TEXTURE_WORDS * scene->texture_count : 0, fill_textures) &&
              make(&out->texels, ctx, device, &layout, "texels", used ? layout.first[scene->texture_count] : 0, fill_texels);
    free(layout.first);
    if (!ok) device_textures_finish(out, device);
    return ok;
}

void device_textures_finish(struct device_textures *textures, struct device *device) {
    buffer_finish(&textures->textures, device);
    buffer_finish(&textures->texels, device);
    *textures = (struct device_textures){0};
}

void device_textures_bindings(struct device_textures *textures, struct kernel_binding bindings[DEVICE_TEXTURES_BINDINGS]) {
    bindings[0] = (struct kernel_binding){BINDING_TEXTURES, &textures->textures, NULL};
    bindings[1] = (struct kernel_binding){BINDING_TEXELS, &textures->texels, NULL};
}
