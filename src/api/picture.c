// Finished pictures: their layers, and how they become files.
//
// An EXR holds all layers. PNG and PFM hold one: the others go beside it, name.depth.png and so on. The files for the layers are written
// first and the colour last, so that where the named file is, everything is; after a failure nothing is left.
#include "api/handles.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "measure/layers.h"

void gn_picture_destroy(struct gn_picture *picture) {
    if (!picture) return;
    image_finish(&picture->color);
    image_finish(&picture->depth);
    image_finish(&picture->normal);
    image_finish(&picture->id);
    image_finish(&picture->error);
    image_finish(&picture->ulp);
    image_finish(&picture->undecided);
    free(picture);
}

uint32_t gn_picture_width(const struct gn_picture *picture) { return picture->color.width; }
uint32_t gn_picture_height(const struct gn_picture *picture) { return picture->color.height; }
const struct gn_render_stats *gn_picture_stats(const struct gn_picture *picture) { return &picture->stats; }

const float *gn_picture_pixels(const struct gn_picture *picture, uint32_t aov) {
    switch (aov) {
    case 0:
        return picture->color.pixels;
    case GN_AOV_DEPTH:
        return picture->depth.pixels;
    case GN_AOV_NORMAL:
        return picture->normal.pixels;
    case GN_AOV_ID:
        return picture->id.pixels;
    case GN_AOV_ERROR:
        return picture->error.pixels;
    case GN_AOV_ULP:
        return picture->ulp.pixels;
    case GN_AOV_UNDECIDED:
        return picture->undecided.pixels;
    default:
        return NULL;
    }
}

// ------------------------------------------------------------------------------------- layers as pictures that people can look at

static size_t pixel_count(const struct image *image) { return (size_t)image->width * image->height; }

// Depth in grey: the nearest white, the farthest nearly black, between them by the reciprocal, so that a far background does not wash out
// what is near. What is not hit is black.
static bool view_of_depth(struct image *out, struct context *ctx, const struct image *depth) {
    if (!image_init(out, ctx, depth->width, depth->height, 1, "the picture of the depths")) return false;
    size_t count = pixel_count(depth);
    double nearest = INFINITY, farthest = 0;
    for (size_t i = 0; i < count; i++) {
        double z = depth->pixels[i];
        if (!(z > 0 && isfinite(z))) continue;
        nearest = fmin(nearest, z), farthest = fmax(farthest, z);
    }
    double range = 1 / nearest - 1 / farthest;
    for (size_t i = 0; i < count; i++) {
        double z = depth->pixels[i];
        if (z > 0 && isfinite(z)) out->pixels[i] = range > 0 ? (float)(0.05 + 0.95 * (1 / z - 1 / farthest) / range) : 1;
    }
    return true;
}

// A unit normal n as n/2 + 1/2; black where there is none.
static bool view_of_normal(struct image *out, struct context *ctx, const struct image *normal) {
    if (!image_init(out, ctx, normal->width, normal->height, 3, "the picture of the normals")) return false;
    size_t count = pixel_count(normal);
    for (size_t i = 0; i < count; i++) {
        const float *n = normal->pixels + 3 * i;
        if (n[0] == 0 && n[1] == 0 && n[2] == 0) continue;
        for (int c = 0; c < 3; c++) out->pixels[3 * i + c] = 0.5f * n[c] + 0.5f;
    }
    return true;
}

// A bijection of 32-bit words that mixes well (C. Wellons, "Prospecting for hash functions", 2018).
static uint32_t mixed(uint32_t x) {
    x ^= x >> 16, x *= 0x21f0aaadu;
    x ^= x >> 15, x *= 0xd35a2d97u;
    return x ^ x >> 15;
}

// Every (object, primitive) in a colour of its own, never dark; black where nothing is hit.
static bool view_of_id(struct image *out, struct context *ctx, const struct image *id) {
    if (!image_init(out, ctx, id->width, id->height, 3, "the picture of the ids")) return false;
    size_t count = pixel_count(id);
    for (size_t i = 0; i < count; i++) {
        if (id->pixels[2 * i] < 0) continue;
        uint32_t hash = mixed(mixed((uint32_t)id->pixels[2 * i] + 1) + (uint32_t)id->pixels[2 * i + 1]);
        for (int c = 0; c < 3; c++) out->pixels[3 * i + c] = (float)(55 + (hash >> 8 * c & 0xff) * 200 / 255) / 255;
    }
    return true;
}

// The ids as three channels, for a format that has no two: object, primitive, 0.
static bool padded_id(struct image *out, struct context *ctx, const struct image *id) {
    if (!image_init(out, ctx, id->width, id->height, 3, "the ids")) return false;
    size_t count = pixel_count(id);
    for (size_t i = 0; i < count; i++) memcpy(out->pixels + 3 * i, id->pixels + 2 * i, 2 * sizeof(float));
    return true;
}

// ---------------------------------------------------------------------------------------------------------------- files

struct side_file {
    const char *name; // name.<this>.png
    const struct image *image;
    bool (*view)(struct image *, struct context *, const struct image *);
    enum transfer transfer; // of the view
};

#define SIDE_FILES 6

static void list_side_files(struct side_file files[SIDE_FILES], const struct gn_picture *picture) {
    files[0] = (struct side_file){"depth", &picture->depth, view_of_depth, TRANSFER_SRGB};
    files[1] = (struct side_file){"normal", &picture->normal, view_of_normal, TRANSFER_LINEAR};
    files[2] = (struct side_file){"id", &picture->id, view_of_id, TRANSFER_LINEAR};
    files[3] = (struct side_file){"error", &picture->error, view_of_error, TRANSFER_SRGB};
    files[4] = (struct side_file){"ulp", &picture->ulp, view_of_ulp, TRANSFER_SRGB};
    files[5] = (struct side_file){"undecided", &picture->undecided, view_of_undecided, TRANSFER_SRGB};
}

// "dir/name.png" and "depth" make "dir/name.depth.png"; to be freed.
static char *side_path(struct context *ctx, const char *path, const char *name) {
    size_t size = strlen(path) + strlen(name) + 2;
    char *out = array_alloc(ctx, size, 1, "a path");
    const char *dot = strrchr(path, '.');
    if (out) snprintf(out, size, "%.*s.%s%s", (int)(dot - path), path, name, dot);
    return out;
}

static bool write_view(const struct side_file *file, struct context *ctx, const char *path) {
    struct image view = {0};
    bool done = file->view(&view, ctx, file->image) && image_write_png(&view, ctx, path, file->transfer);
    image_finish(&view);
    return done;
}

static bool write_raw(const struct side_file *file, struct context *ctx, const char *path) {
    if (file->image->channels != 2) return image_write_pfm(file->image, ctx, path);
    struct image padded = {0};
    bool done = padded_id(&padded, ctx, file->image) && image_write_pfm(&padded, ctx, path);
    image_finish(&padded);
    return done;
}

// Writes every layer there is beside `path`, then the colour.
static bool save_apart(const struct gn_picture *picture, struct context *ctx, const char *path, bool png) {
    struct side_file files[SIDE_FILES];
    char *written[SIDE_FILES] = {NULL};
    list_side_files(files, picture);
    bool done = true;
    for (int i = 0; i < SIDE_FILES && done; i++) {
        if (!files[i].image->pixels) continue;
        char *name = side_path(ctx, path, files[i].name);
        done = name && (png ? write_view : write_raw)(&files[i], ctx, name);
        if (done)
            written[i] = name;
        else
            free(name);
    }
    done = done && (png ? image_write_png(&picture->color, ctx, path, picture->transfer) : image_write_pfm(&picture->color, ctx, path));
    for (int i = 0; i < SIDE_FILES; i++) {
        if (written[i] && !done) remove(written[i]);
        free(written[i]);
    }
    return done;
}

static bool save_png(const struct gn_picture *picture, struct context *ctx, const char *path) {
    return save_apart(picture, ctx, path, true);
}
static bool save_pfm(const struct gn_picture *picture, struct context *ctx, const char *path) {
    return save_apart(picture, ctx, path, false);
}

static bool save_exr(const struct gn_picture *picture, struct context *ctx, const char *path) {
    const struct image_layer all[] = {
        {&picture->color, {"R", "G", "B"}},
        {&picture->depth, {"Z"}},
        {&picture->normal, {"normal.X", "normal.Y", "normal.Z"}},
        {&picture->id, {"id.object", "id.primitive"}},
        {&picture->error, {"error.R", "error.G", "error.B"}},
        {&picture->ulp, {"ulp"}},
        {&picture->undecided, {"undecided"}},
    };
    struct image_layer layers[sizeof all / sizeof *all];
    size_t count = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i].image->pixels) layers[count++] = all[i];
    return image_write_exr(layers, count, ctx, path);
}

static const struct {
    const char *suffix;
    bool (*save)(const struct gn_picture *picture, struct context *ctx, const char *path);
} formats[] = {{"png", save_png}, {"exr", save_exr}, {"pfm", save_pfm}};

bool gn_picture_save(struct gn_picture *picture, const char *path, struct gn_error *error) {
    struct context ctx = context_make(NULL, error);
    double start = clock_seconds();
    char suffix[16];
    path_suffix(path, suffix, sizeof suffix);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        if (strcmp(suffix, formats[i].suffix) != 0) continue;
        if (!formats[i].save(picture, &ctx, path)) return false;
        double ms = clock_ms_since(start);
        picture->stats.time_ms.output += ms, picture->stats.time_ms.total += ms;
        return true;
    }
    return fail(&ctx, GN_USAGE, "%s: the name of a picture ends in .png, .exr or .pfm", path);
}
