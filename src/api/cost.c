// gn_cost_…: settles the job, lets measure/cost measure, and tells its rows.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "measure/cost/report.h"
#include "measure/probe.h"

#define DEFAULT_ROUNDS 5
#define DEFAULT_SECONDS 60.0

struct gn_cost {
    struct cost cost;
    struct cost_place place;
    struct gn_cost_row *rows;
    struct gn_cost_skipped *skipped;
};

// -------------------------------------------------------------------------------------------------------------- measuring

static bool settle(struct cost_params *out, struct context *ctx, const struct gn_scene *scene, const struct gn_cost_params *params) {
    struct job job;
    const struct gn_render_params render = {.width = params->width, .height = params->height, .seed = params->seed, .spp = 2};
    if (params->rounds > COST_MOST_ROUNDS) return fail(ctx, GN_USAGE, "%u rounds: at most %d", params->rounds, COST_MOST_ROUNDS);
    if (!job_make(&job, ctx, scene, &render, true)) return false;
    *out = (struct cost_params){.width = job.width,
                                .height = job.height,
                                .seed = job.seed,
                                .effects = job.plan.effects,
                                .rounds = params->rounds ? params->rounds : DEFAULT_ROUNDS,
                                .seconds = params->seconds > 0 ? params->seconds : DEFAULT_SECONDS};
    return true;
}

static struct gn_cost_row tell(const struct cost *cost, const struct cost_row *row) {
    const struct cost_run *run = &cost->runs[row->run];
    const struct cost_decisions *decisions = &cost->decisions[run->config.tier];
    uint32_t pixels = run->color.width * run->color.height;
    double whole = (double)cost->params.width * cost->params.height;
    struct gn_cost_row out = {
        .pixels = pixels,
        .spp = run->config.spp,
        .converged = !run->config.same_samples,
        .base = row->base,
        .pareto = row->pareto,
        .time_ms = run->median,
        .time_low_ms = run->low,
        .time_high_ms = run->high,
        .picture_ms = run->median * whole / pixels,
        .rmse = run->rmse,
        .max_abs = run->max_abs,
        .flip = run->flip,
        .nonfinite_pixels = run->nonfinite_pixels,
        .differing_per_million = 1e6 * (double)run->differing_pixels / pixels,
        .wrong_per_million = 1e6 * (double)decisions->wrong / (double)decisions->rays,
        .t_ulp_max = decisions->ulp_max,
        .t_ulp_mean = decisions->ulp_mean,
    };
    memcpy(out.axis, row->axis, sizeof out.axis);
    memcpy(out.setting, row->setting, sizeof out.setting);
    snprintf(out.accuracy, sizeof out.accuracy, "%s", cost_tier_name(run->config.tier));
    return out;
}

static bool tell_all(struct gn_cost *out, struct context *ctx) {
    const struct cost *cost = &out->cost;
    out->rows = array_alloc(ctx, cost->row_count, sizeof *out->rows, "the rows of costs");
    out->skipped = array_alloc(ctx, cost->skipped_count, sizeof *out->skipped, "what was not measured");
    if (!out->rows || !out->skipped) return false;
    for (uint32_t i = 0; i < cost->row_count; i++) out->rows[i] = tell(cost, &cost->rows[i]);
    for (uint32_t i = 0; i < cost->skipped_count; i++) {
        memcpy(out->skipped[i].axis, cost->skipped[i].axis, sizeof out->skipped[i].axis);
        memcpy(out->skipped[i].setting, cost->skipped[i].setting, sizeof out->skipped[i].setting);
        memcpy(out->skipped[i].because, cost->skipped[i].because, sizeof out->skipped[i].because);
    }
    return true;
}

static void describe_place(struct cost_place *place, const struct gn_device *device, const struct gn_scene *scene) {
    place->device = device->device.info;
    const char *path = scene->scene.path, *slash = path ? strrchr(path, '/') : NULL;
    snprintf(place->scene, sizeof place->scene, "%s", slash ? slash + 1 : path ? path : "");
    place->triangles = scene_triangle_count(&scene->scene);
    place->spheres = scene_sphere_count(&scene->scene);
    place->lights = scene->scene.light_count;
    place->transfer = scene->scene.film.transfer;
}

struct gn_cost *gn_cost_measure(struct gn_device *device, struct gn_scene *scene, const struct gn_cost_params *params, struct gn_error *error) {
    static const struct gn_cost_params defaults;
    if (!params) params = &defaults;
    struct context ctx = context_make(params->host, error);
    struct cost_params settled;
    struct gn_cost *out = NULL;
    if (!device) {
        fail(&ctx, GN_USAGE, "what accuracy costs is measured on a device: one is needed");
        return NULL;
    }
    if (!settle(&settled, &ctx, scene, params) || !scene_bvh(scene, &ctx)) return NULL;
    if (!(out = array_alloc(&ctx, 1, sizeof *out, "what accuracy costs"))) return NULL;
    describe_place(&out->place, device, scene);
    if (probe_measure(out->place.probe, GN_PROBE_ROWS, &out->place.probe_count, &ctx, &device->device) &&
        cost_measure(&out->cost, &ctx, &device->device, &scene->scene, &scene->bvh, &settled) && device_validated(&device->device, &ctx) &&
        tell_all(out, &ctx)) {
        probe_judge(out->place.tiers, out->place.probe, out->place.probe_count, device->device.has_fp64);
        return out;
    }
    gn_cost_destroy(out);
    return NULL;
}

void gn_cost_destroy(struct gn_cost *cost) {
    if (!cost) return;
    cost_finish(&cost->cost);
    free(cost->rows);
    free(cost->skipped);
    free(cost);
}

// ---------------------------------------------------------------------------------------------------------------- telling

const struct gn_cost_row *gn_cost_rows(const struct gn_cost *cost, uint32_t *count) {
    *count = cost->cost.row_count;
    return cost->rows;
}

const struct gn_cost_skipped *gn_cost_skipped(const struct gn_cost *cost, uint32_t *count) {
    *count = cost->cost.skipped_count;
    return cost->skipped;
}

const struct gn_probe_row *gn_cost_probe(const struct gn_cost *cost, uint32_t *count, const struct gn_probe_tier **tiers) {
    *count = cost->place.probe_count;
    *tiers = cost->place.tiers;
    return cost->place.probe;
}

void gn_cost_summary(const struct gn_cost *cost, struct gn_cost_summary *summary) {
    const struct cost *c = &cost->cost;
    *summary = (struct gn_cost_summary){.width = c->params.width,
                                        .height = c->params.height,
                                        .stride = {c->targets[COST_CENTRES].lattice.stride, c->targets[COST_SAMPLES].lattice.stride},
                                        .reference_spp = c->targets[COST_SAMPLES].spp,
                                        .rounds = c->rounds,
                                        .rays = c->decisions[TIER_ROBUST].rays};
}

bool gn_cost_save(const struct gn_cost *cost, const char *path, struct gn_error *error) {
    struct context ctx = context_make(NULL, error);
    return cost_report(&cost->cost, &ctx, &cost->place, path);
}
