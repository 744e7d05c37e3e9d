// Single rays decided exactly, for a device that could not: each with the primitive it starts on left out.
#ifndef REFERENCE_RESOLVE_H
#define REFERENCE_RESOLVE_H

#include "reference/traverse.h"

#define RESOLVE_NO_SELF UINT32_MAX

struct resolve_ray {
    float o[3], d[3], tmin, tmax; // open interval
    uint32_t self;                // number, as the BVH has them, of the primitive that the ray starts on, or RESOLVE_NO_SELF
    bool any;                     // occlusion only
    struct ref_target target;     // is not hit
    float time;
};

struct resolve_answer {
    struct gn_hit hit; // as reference_trace gives it; of an occluded ray only object, 0
    uint32_t number;   // of the primitive, as the BVH has them
};

// Decides rays[0 … count) on all cores. Of the primitive a ray starts on, a triangle is not hit again, a sphere only at its other root.
// False when cancelled.
bool resolve_rays(struct resolve_answer *answers, struct context *ctx, const struct ref_world *world, const struct resolve_ray *rays,
                  size_t count);

#endif
