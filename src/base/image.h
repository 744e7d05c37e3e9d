// Images in memory and in files: PNG (libspng), OpenEXR (OpenEXRCore), JPEG (libjpeg-turbo), Radiance, PFM. Knows nothing of rendering.
#ifndef BASE_IMAGE_H
#define BASE_IMAGE_H

#include "base/context.h"
#include "base/file.h"

// Row-major, top row first, channels interleaved. Zeroed is empty.
struct image {
    uint32_t width, height, channels;
    float *pixels; // width × height × channels
};

bool image_init(struct image *out, struct context *ctx, uint32_t width, uint32_t height, uint32_t channels, const char *what);
void image_finish(struct image *image);

// How light becomes an 8-bit code.
enum transfer { TRANSFER_SRGB, TRANSFER_LINEAR };

// The 8-bit code of a linear value: round(255·f(value)), clamped to 0…255; NaN gives 0. For sRGB the code is right at every fp32
// input: a table of the 255 exact thresholds, not pow.
uint8_t transfer_encode(enum transfer transfer, float value);

// The linear value of an 8-bit code.
float transfer_decode(enum transfer transfer, uint8_t code);

// The linear value of an sRGB-encoded one, both 0 to 1 (IEC 61966-2-1).
double srgb_decode(double encoded);

// One named layer of an EXR file: image with 1, 2 or 3 channels; channel names in the file are given by `names`.
struct image_layer {
    const struct image *image;
    const char *names[4]; // one for each channel, e.g. "R","G","B" or "Z" or "normal.X"
};

// Writers; each whole or not there (GN_IO). PNG takes 1 or 3 channels, PFM 1 or 3; the layers of an EXR are of one size.
bool image_write_png(const struct image *image, struct context *ctx, const char *path, enum transfer transfer);
bool image_write_pfm(const struct image *image, struct context *ctx, const char *path);
bool image_write_exr(const struct image_layer *layers, size_t count, struct context *ctx, const char *path);

// A PNG in memory, of 1 or 3 channels, as image_write_png writes it; smaller rather than quick. file_bytes_finish frees it.
bool image_encode_png(struct file_bytes *out, struct context *ctx, const struct image *image, enum transfer transfer);

// Reads .png (8 or 16 bit, grey or colour, decoded from sRGB to linear, unless the file says that its gamma is 1; alpha is ignored), .jpg
// (decoded from sRGB), .exr (channels R, G, B, or Y; half, float or uint; scan lines or tiles, of which the finest level is read), .hdr
// (Radiance) or .pfm (its scale is ignored), by its content; 3 channels. GN_IO with the path and what is wrong.
bool image_read(struct image *out, struct context *ctx, const char *path);

// A picture of 8-bit codes. Row-major, top row first. Zeroed is empty.
struct codes {
    uint32_t width, height;
    uint8_t *pixels; // 4 × width × height: red, green, blue, alpha
};
void codes_finish(struct codes *codes);

// Decodes a file of any of the formats above that lies in memory. PNG and JPEG: their codes, whatever they mean, alpha 255 where there is
// none; the others, which hold linear values: the codes by `transfer`. GN_IO with the path and what is wrong.
bool codes_decode(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes, enum transfer transfer);

#endif
