// Layers that show where a picture's accuracy was lost: pixel by pixel against the reference. Knows nothing of how the two were made.
#ifndef MEASURE_LAYERS_H
#define MEASURE_LAYERS_H

#include "base/image.h"

// Distance of two positive fp32 numbers in steps of fp32, their ulp; +inf where one is finite and the other is not, 0 where neither is.
float ulp_distance(float a, float b);

// The absolute difference of two colour pictures; 3 channels.
bool layer_of_error(struct image *out, struct context *ctx, const struct image *color, const struct image *reference);

// ulp_distance of two depth pictures; 1 channel.
bool layer_of_ulp(struct image *out, struct context *ctx, const struct image *depth, const struct image *reference);

// Each as a picture in false colour (heat_map): the largest channel of an error on a logarithmic scale from 1e-7, black, to 1; of ulp and of
// counts log2(1 + x) to 12 and to 4.
bool view_of_error(struct image *out, struct context *ctx, const struct image *error);
bool view_of_ulp(struct image *out, struct context *ctx, const struct image *ulp);
bool view_of_undecided(struct image *out, struct context *ctx, const struct image *undecided);

#endif
