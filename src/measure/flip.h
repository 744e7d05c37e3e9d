// FLIP: the difference that a person sees when two images alternate. Knows nothing of files.
#ifndef MEASURE_FLIP_H
#define MEASURE_FLIP_H

#include "base/image.h"

// Fills *map with the FLIP error of each pixel, 0 to 1 (1 channel), and *mean with its mean. The images are linear, of 3 channels and of
// one size; they are clamped to 0…1, NaN being 0. Andersson et al. 2020, low dynamic range, 67 pixels per degree.
bool flip_compare(struct image *map, double *mean, struct context *ctx, const struct image *a, const struct image *b);

#endif
