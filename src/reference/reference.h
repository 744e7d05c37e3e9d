// The fp64 renderer on the CPU: what says what is right. Its hit decisions are exact: fp64 with an error bound, then integers.
//
// It shares no arithmetic with the shaders but the random bits and the definition of a camera ray (camera.h), which is a sequence of fp32
// operations so that both sides shoot the same ray to the bit.
#ifndef REFERENCE_REFERENCE_H
#define REFERENCE_REFERENCE_H

#include "base/image.h"
#include "bvh/bvh.h"
#include "effects/plan.h"
#include "render/lattice.h"
#include "scene/scene.h"

struct reference_params {
    uint32_t width, height, spp, seed;
    uint32_t effects; // EFFECT_* bits that run
    uint32_t aovs;    // GN_AOV_* bits
    struct lattice lattice;   // the pixels that are rendered; zeroed: all
    bool independent_samples; // instead of Sobol points
};

// Pictures: colour is the mean over the samples, linear, 3 channels; the AOVs as gnomon.h says, empty when not asked for.
struct reference_film {
    struct image color, depth, normal, id;
    uint64_t rays, nonfinite_pixels;
};

bool reference_render(struct reference_film *out, struct context *ctx, const struct scene *scene, const struct bvh *bvh,
                      const struct reference_params *params);
void reference_film_finish(struct reference_film *film);

// Shoots rays with exact decisions; t, u, v within 0.5 ulp (docs/right-answer.md). `any`: only object is filled, 0 or -1.
bool reference_trace(struct gn_hit *hits, struct context *ctx, const struct scene *scene, const struct bvh *bvh, const struct gn_ray *rays,
                     size_t count, bool any);

#endif
