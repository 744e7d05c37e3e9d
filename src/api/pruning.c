// gn_plan_measure: settles the job, lets measure/pruning measure, and tells what came of it.
#include <stdio.h>

#include "api/handles.h"
#include "measure/pruning.h"

static struct gn_plan_side tell_side(const struct pruning_side *side) {
    return (struct gn_plan_side){side->pipeline_ms, side->trace_ms, side->rays, side->memory};
}

static void tell(struct gn_plan_cost *out, const struct pruning *pruning) {
    out->pruned = tell_side(&pruning->pruned);
    out->full = tell_side(&pruning->full);
    out->rounds = pruning->rounds;
    for (uint32_t i = 0; i < EFFECT_COUNT; i++) {
        out->without[i].measured = pruning->without[i].effects != 0;
        out->without[i].side = tell_side(&pruning->without[i]);
    }
    for (uint32_t i = 0; i < pruning->place_count && i < GN_PLAN_BUFFERS; i++) {
        struct gn_plan_buffer *buffer = &out->buffers[out->buffer_count++];
        *buffer = (struct gn_plan_buffer){.bytes = pruning->places[i].bytes, .limit = pruning->places[i].limit};
        snprintf(buffer->name, sizeof buffer->name, "%s", pruning->places[i].name);
    }
}

bool gn_plan_measure(struct gn_device *device, struct gn_scene *scene, const struct gn_render_params *params, struct gn_plan_cost *out,
                     struct gn_error *error) {
    struct context ctx = context_make(params ? params->host : NULL, error);
    struct pruning pruning;
    struct job job;
    *out = (struct gn_plan_cost){0};
    if (!device) return fail(&ctx, GN_USAGE, "effects cost time on a device: a device is needed");
    if (!job_make(&job, &ctx, scene, params, false) || !scene_bvh(scene, &ctx)) return false;
    const struct render_params render = {
        .width = job.width, .height = job.height, .spp = job.spp, .seed = job.seed, .tier = job.tier, .effects = job.plan.effects};
    if (!pruning_measure(&pruning, &ctx, &device->device, &scene->scene, &scene->bvh, &render)) return false;
    tell(out, &pruning);
    return device_validated(&device->device, &ctx);
}
