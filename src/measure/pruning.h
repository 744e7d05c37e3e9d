// What effects cost: a picture with those that the scene calls for, with all of them, and with one less at a time.
#ifndef MEASURE_PRUNING_H
#define MEASURE_PRUNING_H

#include "render/render.h"

#define PRUNING_ROUNDS 5     // that count, the time permitting; one at least
#define PRUNING_SECONDS 60.0 // after which no round begins

// Zeroed is empty.
struct pruning_side {
    uint32_t effects;       // that ran
    double pipeline_ms;     // making the kernel, the first time
    double trace_ms;        // median
    uint64_t rays;
    uint64_t memory;        // bytes of buffers and images
};

struct pruning {
    struct pruning_side pruned, full;
    struct pruning_side without[EFFECT_COUNT]; // without each effect; where that was not tried effects is 0
    struct render_place places[RENDER_PLACES]; // of the pruned picture
    uint32_t place_count, rounds;
};

// Measures. `params->effects` are those that the scene calls for. Sides take turns, so that what else the machine does is shared out.
bool pruning_measure(struct pruning *out, struct context *ctx, struct device *device, const struct scene *scene, const struct bvh *bvh,
                     const struct render_params *params);

#endif
