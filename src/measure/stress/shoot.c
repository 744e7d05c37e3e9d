#include "measure/stress/shoot.h"

#include "effects/plan.h"
#include "render/render.h"

bool shoot(struct gn_hit *hits, double *ms, struct stress *s, const struct shot *shot) {
    struct plan plan;
    struct render_trace_stats stats;
    if (!plan_make(&plan, s->ctx, shot->scene, &(struct plan_params){.spp = 1})) return false;
    const uint32_t all = EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_BVH;
    uint32_t effects =
        plan.effects | (shot->bvh->node_count > 1 ? EFFECT_BVH : 0); // trees of our own have more nodes than there is need for
    if (s->rays < FEW_RAYS) effects = all; // one kernel for all worlds: drivers compile for longer than few rays take
    const struct render_trace_params params = {.tier = shot->tier, .effects = effects, .any = shot->any, .repeat = 1};
    if (!render_trace(hits, &stats, s->ctx, s->device, shot->scene, shot->bvh, &params, shot->rays, shot->count)) return false;
    *ms += stats.trace_ms;
    return true;
}
