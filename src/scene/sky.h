// An environment made ready for sampling: tables that kernels and reference read alike.
//
// A sample picks a row, then a texel in it, then a place in the texel, even by solid angle. What a texel is worth is the mean luminance in
// it, interpolated as it is seen, times its solid angle, so that no place with light has a density of 0. Random numbers have 24 bits:
// shares are multiples of 2^-24, and whatever has light has at least one.
#ifndef SCENE_SKY_H
#define SCENE_SKY_H

#include "scene/scene.h"

struct sky_texel {
    float radiance[3];
    float until; // share of its row's samples that fall on it or on its left
};

// Edges are where 1 - cos θ is that much, θ the angle to the zenith; those of rows in the lower half (2·row >= height), where 1 + cos θ is.
// So they have all their digits next to the poles.
struct sky_row {
    float until;   // share of the samples that fall on it or above
    float density; // per solid angle, of a texel that took all samples of the row
    float upper_edge, lower_edge;
};

// Zeroed is empty; sky_finish accepts a half-made one.
struct sky {
    uint32_t width, height;
    float turns; // of the picture: what to add to a direction's turns from -z towards +x, to have its turns from the middle column
    struct sky_texel *texels; // width × height
    struct sky_row *rows;     // height
};

// GN_LIMIT where there is no memory for it, or it is wider or higher than 2^20.
bool sky_init(struct sky *out, struct context *ctx, const struct scene_environment *environment);
void sky_finish(struct sky *sky);

#endif
