// NumPy's .npy files, as far as rays and hits need them (format: NEP 1).
#ifndef BASE_NPY_H
#define BASE_NPY_H

#include "base/context.h"

// Reads float32 (little-endian, C order; versions 1 to 3) of shape (N, columns). Everything else is refused with GN_IO and what
// was found and expected. *data: N × columns floats, to be freed; N may be 0.
bool npy_read_f32(float **data, size_t *rows, struct context *ctx, const char *path, size_t columns);

// Writes float32 of shape (rows, columns).
bool npy_write_f32(const float *data, size_t rows, size_t columns, struct context *ctx, const char *path);

// Writes hits of shape (count,) as the structured type of the interface contract.
bool npy_write_hits(const struct gn_hit *hits, size_t count, struct context *ctx, const char *path);

// Reads what npy_write_hits writes.
bool npy_read_hits(struct gn_hit **hits, size_t *count, struct context *ctx, const char *path);

#endif
