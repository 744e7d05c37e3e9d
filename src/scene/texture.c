// Textures are few: a list is searched for an equal source.
#include "scene/texture.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ------------------------------------------------------------------------------------------------------------------ sources

void texture_source_finish(struct texture_source *source) {
    free(source->name);
    free(source->alpha_name);
    file_bytes_finish(&source->bytes);
    *source = (struct texture_source){0};
}

void texture_sources_finish(struct texture_source *sources, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) texture_source_finish(&sources[i]);
    free(sources);
}

static bool same_picture(const struct texture_source *a, const struct texture_source *b) {
    const bool same_alpha = a->alpha_name && b->alpha_name ? strcmp(a->alpha_name, b->alpha_name) == 0 : !a->alpha_name && !b->alpha_name;
    return same_alpha && strcmp(a->name, b->name) == 0 && a->srgb == b->srgb;
}

static bool same_lookup(const struct texture_source *a, const struct texture_source *b) {
    return a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v && a->nearest == b->nearest;
}

bool texture_source_add(struct array *sources, struct context *ctx, struct texture_source *source, uint32_t *number) {
    struct texture_source *items = sources->items;
    for (*number = 1; *number <= sources->count; ++*number)
        if (same_picture(&items[*number - 1], source) && same_lookup(&items[*number - 1], source)) {
            texture_source_finish(source);
            return true;
        }
    struct texture_source *added = array_push(sources, ctx);
    if (!added) {
        texture_source_finish(source);
        return false;
    }
    *added = *source;
    *source = (struct texture_source){0};
    return true;
}

// ----------------------------------------------------------------------------------------------------------------- pictures

// Passes on what went wrong with a picture as a fault of the scene.
static bool blame_scene(struct context *ctx, const struct gn_error *error) {
    return fail(ctx, error->status == GN_IO ? GN_SCENE : error->status, "%s", error->message);
}

static bool read_file(struct codes *out, struct context *ctx, const char *path, enum transfer transfer) {
    struct file_bytes bytes;
    const bool done = file_read(&bytes, ctx, path, GN_IO) && codes_decode(out, ctx, path, &bytes, transfer);
    file_bytes_finish(&bytes);
    return done;
}

static bool has_alpha(const struct codes *codes) {
    const size_t count = (size_t)codes->width * codes->height;
    for (size_t i = 0; i < count; i++)
        if (codes->pixels[4 * i + 3] < 255) return true;
    return false;
}

// Sets alpha to that of another picture, or to its red if it has none. It may be of any size: the texel at the same place counts.
static void set_alpha(struct codes *codes, const struct codes *alpha) {
    const size_t channel = has_alpha(alpha) ? 3 : 0;
    for (size_t y = 0; y < codes->height; y++)
        for (size_t x = 0; x < codes->width; x++) {
            const size_t from_y = y * alpha->height / codes->height, from_x = x * alpha->width / codes->width;
            codes->pixels[4 * (y * codes->width + x) + 3] = alpha->pixels[4 * (from_y * alpha->width + from_x) + channel];
        }
}

static bool read_picture(struct codes *out, struct context *ctx, const struct texture_source *source) {
    const enum transfer transfer = source->srgb ? TRANSFER_SRGB : TRANSFER_LINEAR;
    struct codes alpha = {0};
    const bool done =
        source->bytes.data ? codes_decode(out, ctx, source->name, &source->bytes, transfer) : read_file(out, ctx, source->name, transfer);
    if (!done || !source->alpha_name) return done;
    if (!read_file(&alpha, ctx, source->alpha_name, TRANSFER_LINEAR)) return false;
    set_alpha(out, &alpha);
    codes_finish(&alpha);
    return true;
}

// -------------------------------------------------------------------------------------------------------------------- table

// The texels of a texture with the same picture, copied, if there is one.
static bool copy_picture(struct codes *out, bool *found, const struct texture_table *table, struct context *ctx,
                         const struct texture_source *source) {
    const struct texture_source *sources = table->sources.items;
    const struct scene_texture *textures = table->textures.items;
    size_t i = 0;
    while (i < table->sources.count && !same_picture(&sources[i], source)) i++;
    *found = i < table->sources.count;
    if (!*found) return true;
    const size_t size = (size_t)textures[i].width * textures[i].height;
    *out = (struct codes){.width = textures[i].width, .height = textures[i].height, .pixels = array_alloc(ctx, size, 4, source->name)};
    if (out->pixels) memcpy(out->pixels, textures[i].texels, 4 * size);
    return out->pixels != NULL;
}

static bool get_picture(struct codes *out, const struct texture_table *table, struct context *ctx, const struct texture_source *source) {
    bool found;
    struct gn_error error;
    struct context inner = context_make(&ctx->host, &error);
    *out = (struct codes){0};
    if (!copy_picture(out, &found, table, ctx, source)) return false;
    if (found || read_picture(out, &inner, source)) return true;
    codes_finish(out);
    return blame_scene(ctx, &error);
}

// A copy of a source without the bytes.
static struct texture_source note_source(const struct texture_source *source) {
    struct texture_source note = *source;
    note.bytes = (struct file_bytes){0};
    note.name = strdup(source->name);
    note.alpha_name = source->alpha_name ? strdup(source->alpha_name) : NULL;
    return note;
}

static bool add_texture(struct texture_table *table, struct context *ctx, const struct texture_source *source, struct codes *codes) {
    struct texture_source note = note_source(source);
    struct scene_texture *texture = note.name && (note.alpha_name || !source->alpha_name) ? array_push(&table->textures, ctx) : NULL;
    if (!texture) {
        texture_source_finish(&note);
        return fail(ctx, GN_LIMIT, "no memory for a texture");
    }
    *texture = (struct scene_texture){.name = strdup(source->name),
                                      .width = codes->width,
                                      .height = codes->height,
                                      .texels = codes->pixels,
                                      .wrap_u = source->wrap_u,
                                      .wrap_v = source->wrap_v,
                                      .nearest = source->nearest};
    *codes = (struct codes){0};
    uint32_t number;
    return texture_source_add(&table->sources, ctx, &note, &number) && (texture->name || fail(ctx, GN_LIMIT, "no memory for a texture"));
}

bool texture_need(struct texture_table *table, struct context *ctx, const struct texture_source *source, uint32_t *number) {
    const struct texture_source *sources = table->sources.items;
    for (*number = 1; *number <= table->sources.count; ++*number)
        if (same_picture(&sources[*number - 1], source) && same_lookup(&sources[*number - 1], source)) return true;
    struct codes codes;
    if (!progress(ctx, "scene", 0, -1) || !get_picture(&codes, table, ctx, source)) return false;
    const bool done = add_texture(table, ctx, source, &codes);
    codes_finish(&codes);
    return done;
}

void texture_table_take(struct texture_table *table, struct scene_texture **textures, uint32_t *count) {
    const uint32_t source_count = (uint32_t)table->sources.count;
    texture_sources_finish(array_take(&table->sources), source_count);
    *count = (uint32_t)table->textures.count;
    *textures = array_take(&table->textures);
}

// -------------------------------------------------------------------------------------------------------------- environment

// Makes every value finite and not negative. Returns how many were not.
static size_t sanitize(float *values, size_t count) {
    size_t bad = 0;
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) largest = fmaxf(largest, values[i]);
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i]) && values[i] >= 0) continue;
        values[i] = values[i] > 0 ? largest : 0;
        bad++;
    }
    return bad;
}

bool environment_load(struct scene_environment *out, struct context *ctx, const char *path) {
    struct image image;
    struct gn_error error;
    struct context inner = context_make(&ctx->host, &error);
    if (!image_read(&image, &inner, path)) return blame_scene(ctx, &error);
    const size_t count = 3 * (size_t)image.width * image.height, bad = sanitize(image.pixels, count);
    if (bad > 0)
        notify(ctx, GN_LEVEL_WARNING, "%s: %zu of %zu values are negative or not finite; they count as 0, or as the largest finite one",
               path, bad, count);
    out->width = image.width, out->height = image.height, out->texels = image.pixels;
    return true;
}
