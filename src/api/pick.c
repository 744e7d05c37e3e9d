// gn_pick and gn_pick_check: settle the job, and let measure/pick choose and check.
#include <stdio.h>
#include <string.h>

#include "api/handles.h"
#include "base/clock.h"
#include "measure/pick.h"
#include "render/kernels.h"

_Static_assert(sizeof((struct gn_pick *)0)->candidates / sizeof(struct gn_pick_candidate) == PICK_MOST_CANDIDATES, "candidates have room");

static bool accuracy_of_tier(enum gn_accuracy *out, struct context *ctx, uint32_t wanted) {
    for (int accuracy = 0; accuracy < GN_ACCURACY_COUNT; accuracy++) {
        uint32_t tier;
        const char *name;
        *out = (enum gn_accuracy)accuracy;
        if (!tier_of_accuracy(&tier, &name, ctx, *out)) return false;
        if (tier == wanted) return true;
    }
    return fail(ctx, GN_INTERNAL, "tier %u has no name", wanted);
}

// The tiers that may be picked: what is asked for, or all that the device has.
static bool find_tiers(uint32_t *out, struct context *ctx, struct gn_device *device, const struct gn_pick_params *params) {
    uint32_t kept;
    const char *name;
    *out = 0;
    if (params->keep_accuracy) {
        if (!tier_of_accuracy(&kept, &name, ctx, params->render.accuracy)) return false;
        *out = 1u << kept;
        return true;
    }
    for (uint32_t tier = 0; device && tier < TIER_COUNT; tier++) {
        struct gn_error unused;
        struct context other = context_make(NULL, &unused);
        if (tier_available(&other, &device->device, tier)) *out |= 1u << tier;
    }
    return true;
}

static bool settle(struct pick_params *out, struct context *ctx, struct gn_device *device, struct gn_scene *scene,
                   const struct gn_pick_params *params) {
    struct job job;
    struct gn_render_params render = params->render;
    if (!render.spp) render.spp = 2; // any number but one: the plan has antialiasing then
    if (!job_make(&job, ctx, scene, &render, true) || !scene_bvh(scene, ctx)) return false;
    *out = (struct pick_params){
        .what = {.scene = &scene->scene, .bvh = &scene->bvh, .width = job.width, .height = job.height, .effects = job.plan.effects},
        .seed = job.seed,
        .spp = params->render.spp,
        .max_error = params->max_error,
    };
    return find_tiers(&out->tiers, ctx, device, params);
}

static bool tell_candidate(struct gn_pick_candidate *out, struct context *ctx, const struct pick_candidate *from) {
    *out = (struct gn_pick_candidate){.spp = from->spp, .error = from->error, .seconds = from->seconds, .measured = from->measured};
    return accuracy_of_tier(&out->accuracy, ctx, from->tier);
}

static bool tell(struct gn_pick *out, struct context *ctx, const struct pick *pick) {
    out->count = pick->count;
    out->met = pick->met;
    out->reference_seconds = pick->reference_speed;
    memcpy(out->because, pick->because, sizeof out->because);
    for (uint32_t i = 0; i < pick->count; i++)
        if (!tell_candidate(&out->candidates[i], ctx, &pick->candidates[i])) return false;
    out->picked = out->candidates[pick->picked];
    return true;
}

bool gn_pick(struct gn_device *device, struct gn_scene *scene, const struct gn_pick_params *params, struct gn_pick *pick, struct gn_error *error) {
    *pick = (struct gn_pick){.count = 0};
    struct context ctx = context_make(params->render.host, error);
    struct pick_params settled;
    struct pick found;
    double start = clock_seconds();
    if (!device) return fail(&ctx, GN_USAGE, "the reference has one setting; a device is needed to pick from several");
    if (!(params->max_error > 0) && !(params->max_seconds > 0)) return fail(&ctx, GN_USAGE, "picking takes an error or a time that is asked for");
    if (!settle(&settled, &ctx, device, scene, params)) return false;
    // What the hierarchy took is gone; a time that is over is not the same as none.
    if (params->max_seconds > 0) settled.max_seconds = params->max_seconds - (clock_seconds() - start);
    if (params->max_seconds > 0 && !(settled.max_seconds > 1e-9)) settled.max_seconds = 1e-9;
    return pick_setting(&found, &ctx, &device->device, &settled) && device_validated(&device->device, &ctx) && tell(pick, &ctx, &found);
}

bool gn_pick_check(struct gn_scene *scene, const struct gn_pick_params *params, const struct gn_pick *pick, const struct gn_picture *picture,
                   double seconds, double *measured_error, uint64_t *pixels, struct gn_error *error) {
    *measured_error = 0, *pixels = 0;
    struct context ctx = context_make(params->render.host, error);
    struct pick_params settled;
    if (!settle(&settled, &ctx, NULL, scene, params)) return false;
    if (picture->color.width != settled.what.width || picture->color.height != settled.what.height)
        return fail(&ctx, GN_USAGE, "the picture has %u × %u pixels, %u × %u were picked for", picture->color.width, picture->color.height,
                    settled.what.width, settled.what.height);
    return pick_check(measured_error, pixels, &ctx, &settled, pick->picked.spp, pick->reference_seconds, &picture->color, seconds);
}
