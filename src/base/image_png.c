// PNG through libspng: 8 bits written, everything that PNG knows read. After the PNG Specification, third edition.
#include <spng.h>
#include <stdlib.h>
#include <string.h>

#include "base/image_codec.h"
#include "base/threads.h"

// Deflate makes a byte of at most 1032 (a match of 258 bytes from 2 bits); the least of a pixel is a bit.
#define MOST_PIXELS_PER_BYTE (8 * 1032.0)

// ---- writing

struct conversion {
    const struct image *image;
    enum transfer transfer;
    uint8_t *codes;
};

static bool convert_rows(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    const struct conversion *conversion = data;
    size_t row = (size_t)conversion->image->width * conversion->image->channels;
    const float *values = conversion->image->pixels;
    for (size_t i = begin * row; i < end * row; i++) conversion->codes[i] = transfer_encode(conversion->transfer, values[i]);
    return true;
}

static uint8_t *image_codes(const struct image *image, struct context *ctx, enum transfer transfer) {
    size_t row = (size_t)image->width * image->channels;
    uint8_t *codes = array_alloc(ctx, image->height, row, "the codes of a picture");
    if (!codes) return NULL;
    struct conversion conversion = {.image = image, .transfer = transfer, .codes = codes};
    parallel_for(context_threads(ctx), image->height, 1 + 65536 / row, convert_rows, &conversion);
    return codes;
}

struct png_output {
    struct output_file file;
    struct context *ctx;
};

static int write_bytes(spng_ctx *png, void *user, void *bytes, size_t length) {
    (void)png;
    struct png_output *output = user;
    return output_write(&output->file, output->ctx, bytes, length) ? 0 : SPNG_IO_ERROR;
}

static int png_encode(spng_ctx *png, const struct image *image, enum transfer transfer, const uint8_t *codes) {
    struct spng_ihdr ihdr = {.width = image->width,
                             .height = image->height,
                             .bit_depth = 8,
                             .color_type = image->channels == 3 ? SPNG_COLOR_TYPE_TRUECOLOR : SPNG_COLOR_TYPE_GRAYSCALE};
    int error = spng_set_ihdr(png, &ihdr);
    if (!error) error = transfer == TRANSFER_SRGB ? spng_set_srgb(png, 1) : spng_set_gama(png, 1.0); // 1: relative colorimetric
    size_t size = (size_t)image->width * image->height * image->channels;
    return error ? error : spng_encode_image(png, codes, size, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
}

// Quick rather than small: one filter, the lowest level. For smooth 512 × 512 pixels that is 12 ms and 184 kB; level 3 takes 21 ms for
// 146 kB, and no filter at level 3 takes 13 ms for 222 kB.
static int png_stream(spng_ctx *png, struct png_output *output, const struct image *image, enum transfer transfer, const uint8_t *codes) {
    int error = spng_set_png_stream(png, write_bytes, output);
    if (!error) error = spng_set_option(png, SPNG_IMG_COMPRESSION_LEVEL, 1);
    if (!error) error = spng_set_option(png, SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB);
    return error ? error : png_encode(png, image, transfer, codes);
}

static int png_buffer(spng_ctx *png, struct file_bytes *out, const struct image *image, enum transfer transfer, const uint8_t *codes) {
    int error = spng_set_option(png, SPNG_ENCODE_TO_BUFFER, 1);
    if (!error) error = png_encode(png, image, transfer, codes);
    if (!error) out->data = spng_get_png_buffer(png, &out->size, &error);
    return error;
}

bool image_encode_png(struct file_bytes *out, struct context *ctx, const struct image *image, enum transfer transfer) {
    *out = (struct file_bytes){0};
    if (!image_check_writable(image, ctx, "a picture")) return false;
    int error = SPNG_EMEM;
    uint8_t *codes = image_codes(image, ctx, transfer);
    spng_ctx *png = codes ? spng_ctx_new(SPNG_CTX_ENCODER) : NULL;
    if (png) error = png_buffer(png, out, image, transfer, codes);
    spng_ctx_free(png);
    free(codes);
    return error == 0 || fail(ctx, GN_LIMIT, "a picture cannot be encoded as PNG: %s", spng_strerror(error));
}

bool image_write_png(const struct image *image, struct context *ctx, const char *path, enum transfer transfer) {
    if (!image_check_writable(image, ctx, path)) return false;
    struct png_output output = {.ctx = ctx};
    int error = SPNG_EMEM;
    spng_ctx *png = NULL;
    uint8_t *codes = NULL;
    if (!output_begin(&output.file, ctx, path)) return false;
    codes = image_codes(image, ctx, transfer);
    if (!codes) goto fail;
    png = spng_ctx_new(SPNG_CTX_ENCODER);
    if (png) error = png_stream(png, &output, image, transfer, codes);
    if (error) {
        fail(ctx, error == SPNG_EMEM ? GN_LIMIT : GN_IO, "%s: cannot be encoded as PNG: %s", path, spng_strerror(error));
        goto fail;
    }
    spng_ctx_free(png);
    free(codes);
    return output_commit(&output.file, ctx);
fail:
    spng_ctx_free(png);
    free(codes);
    output_abort(&output.file);
    return false;
}

// ---- reading

// A file that says gamma 1, and does not say sRGB, is linear.
static bool is_linear(spng_ctx *png) {
    uint8_t intent;
    uint32_t gamma;
    return spng_get_srgb(png, &intent) != 0 && spng_get_gama_int(png, &gamma) == 0 && gamma == 100000;
}

static void expand_8bit(struct image *out, const uint8_t *codes, enum transfer transfer) {
    float value[256];
    for (unsigned code = 0; code < 256; code++) value[code] = transfer_decode(transfer, (uint8_t)code);
    size_t count = (size_t)out->width * out->height * 3;
    for (size_t i = 0; i < count; i++) out->pixels[i] = value[codes[i]];
}

static void expand_16bit(struct image *out, const uint16_t *codes, enum transfer transfer) {
    size_t count = (size_t)out->width * out->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) {
            double encoded = codes[4 * i + c] / 65535.0;
            out->pixels[3 * i + c] = (float)(transfer == TRANSFER_SRGB ? srgb_decode(encoded) : encoded);
        }
}

// Whether the last chunk is there, checksum and all: libspng does not read so far, and a file cut there would pass.
static bool has_end(const struct file_bytes *bytes) {
    static const char end[] = "\0\0\0\0IEND\xae\x42\x60\x82";
    for (size_t at = bytes->size; at-- > 0;)
        if (bytes->size - at >= sizeof end - 1 && memcmp(bytes->data + at, end, sizeof end - 1) == 0) return true;
    return false;
}

// Decodes to 8-bit RGB, or 16-bit RGBA where the file has 16 bits, and reads on to the end of the file, so that a truncated one is noticed.
static int png_decode_pixels(spng_ctx *png, int format, void *pixels, size_t size) {
    int error = spng_decode_image(png, pixels, size, format, 0);
    return error ? error : spng_decode_chunks(png);
}

// Finds out what the file is.
static bool png_open(spng_ctx *png, struct spng_ihdr *ihdr, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    int error = has_end(bytes) ? spng_set_png_buffer(png, bytes->data, bytes->size) : SPNG_IO_EOF;
    if (!error) error = spng_get_ihdr(png, ihdr);
    return !error || fail(ctx, GN_IO, "%s: is not a valid PNG file: %s", path, spng_strerror(error));
}

static bool png_decode(spng_ctx *png, struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    struct spng_ihdr ihdr;
    if (!png_open(png, &ihdr, ctx, path, bytes)) return false;
    if (!image_init_announced(out, ctx, path, ihdr.width, ihdr.height, bytes->size, MOST_PIXELS_PER_BYTE)) return false;
    bool deep = ihdr.bit_depth == 16;
    size_t count = (size_t)ihdr.width * ihdr.height, size = count * (deep ? 8 : 3);
    void *codes = array_alloc(ctx, count, deep ? 8 : 3, path);
    if (!codes) return false;
    int error = png_decode_pixels(png, deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGB8, codes, size);
    if (error) {
        fail(ctx, GN_IO, "%s: is not a valid PNG file: %s", path, spng_strerror(error));
    } else {
        enum transfer transfer = is_linear(png) ? TRANSFER_LINEAR : TRANSFER_SRGB;
        if (deep)
            expand_16bit(out, codes, transfer);
        else
            expand_8bit(out, codes, transfer);
    }
    free(codes);
    return error == 0;
}

bool image_decode_png(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    *out = (struct image){0};
    spng_ctx *png = spng_ctx_new(0);
    if (!png) return fail(ctx, GN_LIMIT, "%s: no memory to decode it", path);
    bool done = png_decode(png, out, ctx, path, bytes);
    spng_ctx_free(png);
    if (!done) image_finish(out);
    return done;
}

static bool png_decode_codes(spng_ctx *png, struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    struct spng_ihdr ihdr;
    if (!png_open(png, &ihdr, ctx, path, bytes) ||
        !codes_init_announced(out, ctx, path, ihdr.width, ihdr.height, bytes->size, MOST_PIXELS_PER_BYTE))
        return false;
    int error = spng_decode_image(png, out->pixels, 4 * (size_t)ihdr.width * ihdr.height, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS);
    if (!error) error = spng_decode_chunks(png);
    return !error || fail(ctx, GN_IO, "%s: is not a valid PNG file: %s", path, spng_strerror(error));
}

bool codes_decode_png(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    *out = (struct codes){0};
    spng_ctx *png = spng_ctx_new(0);
    if (!png) return fail(ctx, GN_LIMIT, "%s: no memory to decode it", path);
    const bool done = png_decode_codes(png, out, ctx, path, bytes);
    spng_ctx_free(png);
    if (!done) codes_finish(out);
    return done;
}
