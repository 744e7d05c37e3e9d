// The plan: which effects a scene calls for, and because of what. The table of effects is EFFECTS in shaders/shared.h.
//
// An effect that is off is compiled out of the kernels by a specialization constant, its buffers are not made, and the reference skips it,
// too. Each rule is one small function with the argument for its correctness beside it.
#ifndef EFFECTS_PLAN_H
#define EFFECTS_PLAN_H

#include "scene/scene.h"
#include "shaders/shared.h"

struct plan {
    uint32_t effects;                // EFFECT_* bits that run
    char because[EFFECT_COUNT][160]; // for people: why it runs, or why it is pruned
};

struct plan_params {
    uint32_t spp;        // samples per pixel in force
    const char *disable; // comma-separated effect names to leave out [none]
    const char *only;    // comma-separated effect names: of the others only those of geometry run, triangles, spheres, bvh, instances [all]
    bool no_prune;       // everything on
};

// Fails with GN_USAGE when `disable` or `only` names no effect; the message lists the names.
bool plan_make(struct plan *out, struct context *ctx, const struct scene *scene, const struct plan_params *params);

// The name of effect number `effect`, e.g. "soft_shadows".
const char *effect_name(uint32_t effect);

// The names of the effects in `effects`, comma-separated, into text[capacity].
void effect_names(uint32_t effects, char *text, size_t capacity);

#endif
