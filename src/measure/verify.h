// Whether a device's picture is the reference's: pixel by pixel, in colour and in what the first sample hit. Knows nothing of how they were
// made.
//
// The rule. Both sides shoot the same rays and draw the same random numbers, so on a right device a pixel is off by the rounding of fp32
// shading only, some 1e-6. Where an edge, or a shadow's edge, passes within rounding of a sample, the two may decide differently, and the
// pixel is off by anything. Hence two limits: a pixel differs when a channel is off by more than the tolerance (1/255 in linear light: one
// step of an 8-bit picture without gamma; for values over 1 at least 2^-12 of the value, which fp32 shading keeps with room to spare), and
// few pixels may differ: 1 in 10 000, and 1 in 100 000 more for each further sample of a pixel, any of which may be decided differently, up
// to 1 in 1 000; or 2 in a small picture. A whole edge drawn wrongly, a missing shadow, a lost triangle or another
// random number is far more than that; so is one value that is not finite, which fails alone.
//
// Errors that colours hide are found in what the first sample hit: as many hits may be wrong as pixels may differ at
// one sample. Not counted there are ties, wrong hits at the
// right depth: where surfaces coincide, in a stack of decals, say, the order of a tier that rounds is chance, and does no harm where the
// colour is right, too.
#ifndef MEASURE_VERIFY_H
#define MEASURE_VERIFY_H

#include "base/image.h"

#define VERIFY_TOLERANCE (1.0 / 255.0)
#define VERIFY_RELATIVE 0x1p-12
#define VERIFY_ALLOWED_FRACTION 1e-4
#define VERIFY_ALLOWED_FURTHER 1e-5 // for each sample but the first
#define VERIFY_ALLOWED_MOST 1e-3
#define VERIFY_ALLOWED_LEAST 2

struct verify_side {
    const struct image *color; // 3 channels
    const struct image *id;    // 2 channels: object and primitive of the first sample
    const struct image *depth; // 1 channel
};

// How many of `pixels` pixels with `spp` samples each may differ.
uint64_t verify_allowed(uint64_t pixels, uint32_t spp);

// Compares. out->nonfinite_pixels must hold what the device dropped, and is added to; `device` and `reference` of *out are left alone.
// *difference, if asked for, becomes 1 channel: 0 for equal, 0.5 at the tolerance, 1 for twice that and more and for what is not finite.
bool verify_pictures(struct gn_verify_result *out, struct image *difference, struct context *ctx, struct verify_side device,
                     struct verify_side reference, uint32_t spp, double tolerance);

#endif
