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

static bool check_announced(struct context *ctx, const char *path, uint64_t width, uint64_t height, size_t file_size,
                            double most_per_byte) {
    if (width == 0 || height == 0) return fail(ctx, GN_IO, "%s: announces an empty image", path);
    if (width > MOST_SIDE || height > MOST_SIDE || width * height > MOST_PIXELS)
        return fail(ctx, GN_IO, "%s: announces %ju × %ju pixels; the limit is %u on a side and %ju in all", path, (uintmax_t)width,
                    (uintmax_t)height, MOST_SIDE, (uintmax_t)MOST_PIXELS);
    if ((double)(width * height) > most_per_byte * (double)file_size)
        return fail(ctx, GN_IO, "%s: announces %ju × %ju pixels, which cannot be in a file of %zu bytes", path, (uintmax_t)width,
                    (uintmax_t)height, file_size);
    return true;
}

bool image_init_announced(struct image *out, struct context *ctx, const char *path, uint64_t width, uint64_t height, size_t file_size,
                          double most_per_byte) {
    *out = (struct image){0};
    return check_announced(ctx, path, width, height, file_size, most_per_byte) &&
           image_init(out, ctx, (uint32_t)width, (uint32_t)height, 3, path);
}

bool codes_init_announced(struct codes *out, struct context *ctx, const char *path, uint64_t width, uint64_t height, size_t file_size,
                          double most_per_byte) {
    *out = (struct codes){0};
    if (!check_announced(ctx, path, width, height, file_size, most_per_byte)) return false;
    out->pixels = array_alloc(ctx, (size_t)(width * height), 4, path);
    if (!out->pixels) return false;
    out->width = (uint32_t)width, out->height = (uint32_t)height;
    return true;
}

void codes_finish(struct codes *codes) {
    free(codes->pixels);
    *codes = (struct codes){0};
}

bool image_check_writable(const struct image *image, struct context *ctx, const char *path) {
    if (image->pixels && image->width > 0 && image->height > 0 && (image->channels == 1 || image->channels == 3)) return true;
    return fail(ctx, GN_INTERNAL, "%s: cannot hold an image of %u × %u pixels and %u channels", path, image->width, image->height,
                image->channels);
}

// The formats, by a file's first bytes. Each has one of the two decoders, or both.
struct format {
    const char *magic;
    size_t size;
    bool (*decode)(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
    bool (*decode_codes)(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
};

static const struct format *find_format(struct context *ctx, const char *path, const struct file_bytes *bytes) {
    static const struct format formats[] = {
        {"\x89PNG\r\n\x1a\n", 8, image_decode_png, codes_decode_png},
        {"\x76\x2f\x31\x01", 4, image_decode_exr, NULL},
        {"\xff\xd8\xff", 3, NULL, codes_decode_jpeg},
        {"#?", 2, image_decode_hdr, NULL},
        {"PF", 2, image_decode_pfm, NULL},
        {"Pf", 2, image_decode_pfm, NULL},
    };
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (bytes->size >= formats[i].size && memcmp(bytes->data, formats[i].magic, formats[i].size) == 0) return &formats[i];
    fail(ctx, GN_IO, "%s: is neither PNG, OpenEXR, JPEG, Radiance (.hdr) nor PFM (%zu bytes)", path, bytes->size);
    return NULL;
}

// sRGB codes as linear values.
static bool codes_to_image(struct image *out, struct context *ctx, const struct codes *codes) {
    if (!image_init(out, ctx, codes->width, codes->height, 3, "a picture")) return false;
    float value[256];
    for (unsigned code = 0; code < 256; code++) value[code] = transfer_decode(TRANSFER_SRGB, (uint8_t)code);
    const size_t count = (size_t)codes->width * codes->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) out->pixels[3 * i + c] = value[codes->pixels[4 * i + c]];
    return true;
}

static bool image_to_codes(struct codes *out, struct context *ctx, const struct image *image, enum transfer transfer) {
    const size_t count = (size_t)image->width * image->height;
    *out = (struct codes){.width = image->width, .height = image->height, .pixels = array_alloc(ctx, count, 4, "a picture")};
    if (!out->pixels) return false;
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++) out->pixels[4 * i + c] = transfer_encode(transfer, image->pixels[3 * i + c]);
        out->pixels[4 * i + 3] = 255;
    }
    return true;
}

bool codes_decode(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes, enum transfer transfer) {
    *out = (struct codes){0};
    const struct format *format = find_format(ctx, path, bytes);
    if (!format || format->decode_codes) return format && format->decode_codes(out, ctx, path, bytes);
    struct image image;
    const bool done = format->decode(&image, ctx, path, bytes) && image_to_codes(out, ctx, &image, transfer);
    image_finish(&image);
    return done;
}

bool image_read(struct image *out, struct context *ctx, const char *path) {
    *out = (struct image){0};
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_IO)) return false;
    const struct format *format = find_format(ctx, path, &bytes);
    struct codes codes = {0};
    const bool done = format && (format->decode ? format->decode(out, ctx, path, &bytes)
                                                : format->decode_codes(&codes, ctx, path, &bytes) && codes_to_image(out, ctx, &codes));
    codes_finish(&codes);
    file_bytes_finish(&bytes);
    return done;
}
