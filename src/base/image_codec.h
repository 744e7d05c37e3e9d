// What the image formats share among themselves: each decodes a file that lies in memory to 3 channels.
#ifndef BASE_IMAGE_CODEC_H
#define BASE_IMAGE_CODEC_H

#include "base/file.h"
#include "base/image.h"

// Each reports GN_IO with the path on a fault, and leaves *out empty.
bool image_decode_png(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
bool image_decode_exr(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
bool image_decode_pfm(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
bool image_decode_hdr(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes);

// The same for 8-bit codes.
bool codes_decode_png(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes);
bool codes_decode_jpeg(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes);

// Makes the 3-channel image, or the codes, that a header announces, unless it is empty, larger than 65536 on a side or 2^28 pixels, or has
// more than `most_per_byte` pixels for a byte of the file, which then cannot hold them (GN_IO).
bool image_init_announced(struct image *out, struct context *ctx, const char *path, uint64_t width, uint64_t height, size_t file_size,
                          double most_per_byte);
bool codes_init_announced(struct codes *out, struct context *ctx, const char *path, uint64_t width, uint64_t height, size_t file_size,
                          double most_per_byte);

// Whether a writer can take the image: it has pixels, and 1 or 3 channels (GN_INTERNAL).
bool image_check_writable(const struct image *image, struct context *ctx, const char *path);

#endif
