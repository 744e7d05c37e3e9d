#include "render/upload_sky.h"

#include <stdlib.h>
#include <string.h>

#include "scene/sky.h"
#include "shaders/shared.h"

_Static_assert(sizeof(struct sky_texel) == sizeof(struct word4) && sizeof(struct sky_row) == sizeof(struct word4), "both are words");

static bool make(struct buffer *out, struct context *ctx, struct device *device, const char *name, uint64_t words) {
    struct buffer_params params = {.name = name, .kind = BUFFER_TEXELS, .size = words * sizeof(struct word4), .host_writes = true};
    return buffer_init(out, ctx, device, &params);
}

static bool upload_rows(struct buffer *out, struct context *ctx, struct device *device, const struct sky *sky) {
    struct word4 *words = array_alloc(ctx, 1 + (size_t)sky->height, sizeof *words, "the environment");
    if (!words) return false;
    words[0] = (struct word4){{sky->width, sky->height, 0, 0}};
    memcpy(&words[0].w[2], &sky->turns, sizeof sky->turns);
    memcpy(words + 1, sky->rows, sky->height * sizeof *sky->rows);
    bool ok = buffer_upload(out, ctx, device, words, (1 + (size_t)sky->height) * sizeof *words);
    free(words);
    return ok;
}

// Both buffers are made first: if the device has no room for them, the tables need not be.
static bool fill(struct device_sky *out, struct context *ctx, struct device *device, const struct scene_environment *environment) {
    struct sky sky;
    if (!sky_init(&sky, ctx, environment)) return false;
    bool ok = upload_rows(&out->rows, ctx, device, &sky) &&
              buffer_upload(&out->texels, ctx, device, sky.texels, (size_t)sky.width * sky.height * sizeof *sky.texels);
    sky_finish(&sky);
    return ok;
}

bool device_sky_init(struct device_sky *out, struct context *ctx, struct device *device, const struct scene *scene, uint32_t effects) {
    *out = (struct device_sky){0};
    const struct scene_environment *environment = &scene->environment;
    bool used = effects & EFFECT_ENVIRONMENT && environment->width > 0;
    bool ok = make(&out->texels, ctx, device, "environment", used ? (uint64_t)environment->width * environment->height : 0) &&
              make(&out->rows, ctx, device, "rows of the environment", used ? 1ull + environment->height : 0) &&
              (!used || fill(out, ctx, device, environment));
    if (!ok) device_sky_finish(out, device);
    return ok;
}

void device_sky_finish(struct device_sky *sky, struct device *device) {
    buffer_finish(&sky->texels, device);
    buffer_finish(&sky->rows, device);
    *sky = (struct device_sky){0};
}

void device_sky_bindings(struct device_sky *sky, struct kernel_binding bindings[DEVICE_SKY_BINDINGS]) {
    bindings[0] = (struct kernel_binding){BINDING_SKY, &sky->texels, NULL};
    bindings[1] = (struct kernel_binding){BINDING_SKY_ROWS, &sky->rows, NULL};
}
