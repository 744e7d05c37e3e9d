// Batches of rays, as `gnomon trace --reference` shoots them.
#include "base/threads.h"
#include "reference/reference.h"
#include "reference/rounding.h"
#include "reference/traverse.h"

struct batch {
    struct gn_hit *hits;
    const struct gn_ray *rays;
    struct ref_world world;
    bool any;
};

static struct gn_hit shoot(const struct batch *batch, const struct gn_ray *from) {
    struct gn_hit hit = {.t = INFINITY, .object = -1, .primitive = -1};
    struct ref_ray ray;
    if (!ref_ray_make(&ray, from)) {
        hit.flags = GN_HIT_INVALID;
        return hit;
    }
    struct crossing crossing;
    if (batch->any) {
        hit.object = any_hit(&batch->world, &ray, NULL) ? 0 : -1;
    } else if (closest_hit(&crossing, &batch->world, &ray)) {
        crossing_round(&hit, &ray, &crossing);
        hit.object = (int32_t)crossing.object;
        hit.primitive = (int32_t)crossing.primitive;
    }
    if (ray.undecided > 0) hit.flags |= GN_HIT_UNDECIDED;
    return hit;
}

static bool shoot_some(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    struct batch *batch = data;
    for (size_t i = begin; i < end; i++) batch->hits[i] = shoot(batch, &batch->rays[i]);
    return true;
}

bool reference_trace(struct gn_hit *hits, struct context *ctx, const struct scene *scene, const struct bvh *bvh, const struct gn_ray *rays,
                     size_t count, bool any) {
    struct batch batch = {.hits = hits, .rays = rays, .any = any};
    batch.world = ref_world_make(scene, bvh, EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_INSTANCES);
    return parallel_for_progress(ctx, "reference", count, 256, shoot_some, &batch);
}
