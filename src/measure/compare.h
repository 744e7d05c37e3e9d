// How two images differ: maximum, RMSE, PSNR, FLIP, worst pixel, heat map. Knows nothing of how they were made.
#ifndef MEASURE_COMPARE_H
#define MEASURE_COMPARE_H

#include "base/image.h"

// Compares two 3-channel linear images of the same size (GN_USAGE otherwise). max_abs, rmse and psnr (peak 1) are over linear values;
// a pixel differs when any channel does, by more than `tolerance`. A pixel with a NaN or infinity in either counts as nonfinite and
// enters none of the three; unless equal in both it counts as differing, and as worse than any other. FLIP (Andersson et al. 2020, LDR,
// 67 pixels per degree) is over the sRGB-encoded, clamped images. *flip_map, if asked for, becomes a 1-channel image of the error, 0 to 1.
bool compare_images(struct gn_compare_result *out, struct image *flip_map, struct context *ctx, const struct image *a,
                    const struct image *b, double tolerance);

// 1 channel, 0 to 1, to false colour (3 channels, linear light so that the sRGB encoding shows the magma-like map).
bool heat_map(struct image *out, struct context *ctx, const struct image *values);

#endif
