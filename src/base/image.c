// Images in memory, and the choice of a decoder by a file's first bytes.
#include "base/image.h"

#include <stdlib.h>
#include <string.h>

#include "base/image_codec.h"

#define MOST_SIDE 65536u
#define MOST_PIXELS ((uint64_t)1 << 28)

bool image_init(struct image *out, struct context *ctx, uint32_t width, uint32_t height, uint32_t channels, const char *what) {
    *out = (struct image){0};
    uint64_t pixels = (uint64_t)width * height;
    if (channels != 0 && pixels > SIZE_MAX / sizeof(float) / channels)
        return fail(ctx, GN_LIMIT, "no memory for %s: %u × %u pixels of %u channels", what, width, height, channels);
    float *memory = array_alloc(ctx, (size_t)pixels * channels, sizeof *memory, what);
    if (!memory) return false;
    *out = (struct image){.width = width, .height = height, .channels = channels, .pixels = memory};
    return true;
}

void image_finish(struct image *image) {
    free(image->pixels);
    *image = (struct image){0};
}

bool image_init_announced(struct image *out, struct context *ctx, const char *path, uint64_t width, uint64_t height, size_t file_size,
                          double most_per_byte) {
    *out = (struct image){0};
    if (width == 0 || height == 0) return fail(ctx, GN_IO, "%s: announces an empty image", path);
    if (width > MOST_SIDE || height > MOST_SIDE || width * height > MOST_PIXELS)
        return fail(ctx, GN_IO, "%s: announces %ju × %ju pixels; the limit is %u on a side and %ju in all", path, (uintmax_t)width,
                    (uintmax_t)height, MOST_SIDE, (uintmax_t)MOST_PIXELS);
    if ((double)(width * height) > most_per_byte * (double)file_size)
        return fail(ctx, GN_IO, "%s: announces %ju × %ju pixels, which cannot be in a file of %zu bytes", path, (uintmax_t)width,
                    (uintmax_t)height, file_size);
    return image_init(out, ctx, (uint32_t)width, (uint32_t)height, 3, path);
}

bool image_check_writable(const struct image *image, struct context *ctx, const char *path) {
    if (image->pixels && image->width > 0 && image->height > 0 && (image->channels == 1 || image->channels == 3)) return true;
    return fail(ctx, GN_INTERNAL, "%s: cannot hold an image of %u × %u pixels and %u channels", path, image->width, image->height,
                image->channels);
}

bool image_read(struct image *out, struct context *ctx, const char *path) {
    static const struct {
        const char *magic;
        size_t size;
        bool (*decode)(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
    } formats[] = {
        {"\x89PNG\r\n\x1a\n", 8, image_decode_png},
        {"\x76\x2f\x31\x01", 4, image_decode_exr},
        {"PF", 2, image_decode_pfm},
        {"Pf", 2, image_decode_pfm},
    };
    *out = (struct image){0};
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_IO)) return false;
    bool known = false, done = false;
    for (size_t i = 0; i < sizeof formats / sizeof *formats && !known; i++) {
        known = bytes.size >= formats[i].size && memcmp(bytes.data, formats[i].magic, formats[i].size) == 0;
        if (known) done = formats[i].decode(out, ctx, path, &bytes);
    }
    if (!known) fail(ctx, GN_IO, "%s: is neither PNG, OpenEXR nor PFM (%zu bytes)", path, bytes.size);
    file_bytes_finish(&bytes);
    return done;
}
