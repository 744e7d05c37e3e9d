// A sample of a picture: its pixels on a lattice, rendered by the reference, and how far others are from that.
#ifndef MEASURE_SAMPLE_H
#define MEASURE_SAMPLE_H

#include "base/image.h"
#include "bvh/bvh.h"
#include "render/lattice.h"
#include "scene/scene.h"

// What is sampled.
struct sample {
    const struct scene *scene;
    const struct bvh *bvh;
    uint32_t width, height; // of the whole picture
    uint32_t effects;       // EFFECT_* bits that run
    struct lattice lattice;
};

// The lattice with about `pixels` pixels of a picture, at most all of them.
struct lattice sample_lattice(uint32_t width, uint32_t height, double pixels);

// Pixels on the lattice.
double sample_pixels(const struct sample *sample);

// The reference's picture of the sample, and the seconds that it took (NULL: not asked for).
bool sample_reference(struct image *out, double *seconds, struct context *ctx, const struct sample *sample, uint32_t spp, uint32_t seed);

// The root of the mean square difference of all channels of two pictures of one size; NaN and infinities make it infinite.
double sample_rmse(const struct image *a, const struct image *b);

// The pixels of a whole picture that the sample has.
bool sample_gather(struct image *out, struct context *ctx, const struct sample *sample, const struct image *whole);

#endif
