// Paths of light in fp64: what shaders/path.glsl and render.glsl do, written from the same definition (interface.md's light model, and what docs/scene-format.md
// says of the rest), with rays that are decided exactly and the same random numbers.
#ifndef REFERENCE_PATH_H
#define REFERENCE_PATH_H

#include "reference/environment.h"
#include "reference/fog.h"
#include "reference/lights.h"
#include "reference/sampler.h"
#include "reference/surface.h"

// What all paths of a picture share.
struct path_world {
    struct ref_world world;
    struct ref_lights lights;
    struct sky sky;
    struct ref_fog fog;
};

struct path_result {
    double radiance[3];
    bool hit;               // the first point that is there; if not, nothing below is set
    struct surface surface;
    double depth;           // its distance from the camera
    uint64_t rays;
};

// Zeroed is empty; path_world_finish accepts a half-made one. `effects`: EFFECT_* bits that run. Scene and hierarchy stay.
bool path_world_init(struct path_world *out, struct context *ctx, const struct scene *scene, const struct bvh *bvh, uint32_t effects);
void path_world_finish(struct path_world *world);

// Follows the path of one camera ray.
void path_follow(struct path_result *out, const struct path_world *world, const struct ref_ray *camera, const struct draws *draws);

// A camera ray that is none: it meets the background.
void path_miss(struct path_result *out, const struct path_world *world);

#endif
