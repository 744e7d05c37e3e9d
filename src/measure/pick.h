// Which setting, tier and samples per pixel, meets an error at the least time, or has the least error within a time: from renders of a
// sample of the picture, whose error is measured against the reference and whose time is scaled to the whole.
//
// The error is the RMSE of linear values over all pixels and channels. Where the number of samples is up to us, it is that against very many
// samples at other places, so that the error of sampling is in it; where it is given, against the reference with the very same samples.
//
// Samples per pixel are tried in powers of two, each against a reference of at least four times as many, as long as that takes some seconds
// or a share of what rendering with them would, half a minute at most. Beyond, errors are taken to fall with the root of their number, which
// points that are well spread do at least; three powers of two, and no further.
#ifndef MEASURE_PICK_H
#define MEASURE_PICK_H

#include "device/device.h"
#include "measure/sample.h"
#include "shaders/shared.h"

#define PICK_MOST_CANDIDATES 96
#define PICK_MARGIN 1.25 // between the error that is asked for and the one that a sample shows: it is a sample

struct pick_params {
    struct sample what; // its lattice is not looked at
    uint32_t seed;
    uint32_t spp;       // given; 0: any
    uint32_t tiers;     // bit 1 << TIER_* for each that may be taken
    double max_error;   // 0: none
    double max_seconds; // from the call on, for picking, rendering and checking; 0: none
};

struct pick_candidate {
    uint32_t tier, spp;
    double error, seconds; // of the whole picture
    bool measured;         // the error; else it is extrapolated
};

// What was picked: candidates[picked].
struct pick {
    struct pick_candidate candidates[PICK_MOST_CANDIDATES];
    uint32_t count, picked;
    bool met;           // all that was asked for
    char because[320];  // for people
    double reference_speed; // seconds for one sample of one pixel
};

bool pick_setting(struct pick *out, struct context *ctx, struct device *device, const struct pick_params *params);

// The candidate to be taken: the fastest that meets the error and the time; else *met is false, and it is the one with the least error
// within the time; else the fastest. `count` is not 0. An error of 0, or a time, asks for nothing. With a time alone: the least error.
uint32_t pick_best(const struct pick_candidate *candidates, uint32_t count, double max_error, double max_seconds, bool *met);

// The error of a picture rendered with `spp` samples, by the same measure, on other pixels than picking has looked at: about as many as the
// reference, which takes reference_speed seconds for a sample of a pixel, can render in `seconds`; *pixels says how many.
bool pick_check(double *error, uint64_t *pixels, struct context *ctx, const struct pick_params *params, uint32_t spp, double reference_speed,
                const struct image *picture, double seconds);

#endif
