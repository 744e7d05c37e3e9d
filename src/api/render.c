// gn_render and gn_trace: settle the job, make the BVH, and hand over to the device's passes or to the reference.
#include "api/handles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "device/machine_memory.h"
#include "measure/layers.h"
#include "reference/reference.h"
#include "render/render.h"

#define MOST_PIXELS 65535u      // along one side of a film
#define MOST_SAMPLES (1u << 24) // of a pixel

// Layers that both sides can fill, those that take both sides, and those that only a device has.
#define RENDERED_LAYERS ((uint32_t)(GN_AOV_DEPTH | GN_AOV_NORMAL | GN_AOV_ID))
#define COMPARED_LAYERS ((uint32_t)(GN_AOV_ERROR | GN_AOV_ULP))
#define DEVICE_LAYERS (COMPARED_LAYERS | GN_AOV_UNDECIDED)

// ------------------------------------------------------------------------------------------------------------- accuracy

static const char *const accuracy_names[GN_ACCURACY_COUNT] = {
    [GN_ROBUST] = "robust", [GN_FAST] = "fast", [GN_EXACT] = "exact", [GN_FP64] = "fp64"};

const char *gn_accuracy_name(enum gn_accuracy accuracy) {
    return accuracy >= 0 && accuracy < GN_ACCURACY_COUNT ? accuracy_names[accuracy] : NULL;
}

static const struct {
    uint32_t tier;
    const char *name;
} tiers[] = {
#define X(number, id, name, text) {TIER_##id, name},
    TIERS(X)
#undef X
};

bool tier_of_accuracy(uint32_t *tier, const char **name, struct context *ctx, enum gn_accuracy accuracy) {
    if (accuracy < 0 || accuracy >= GN_ACCURACY_COUNT) return fail(ctx, GN_USAGE, "there is no accuracy number %d", (int)accuracy);
    char there[128] = "";
    for (uint32_t i = 0; i < sizeof tiers / sizeof *tiers; i++) {
        if (strcmp(tiers[i].name, accuracy_names[accuracy]) == 0) {
            *tier = tiers[i].tier, *name = tiers[i].name;
            return true;
        }
        size_t used = strlen(there);
        snprintf(there + used, sizeof there - used, "%s%s", i ? ", " : "", tiers[i].name);
    }
    return fail(ctx, GN_USAGE, "accuracy '%s' is not available in this version; there is: %s", accuracy_names[accuracy], there);
}

// ------------------------------------------------------------------------------------------------------------ rendering

bool job_make(struct job *out, struct context *ctx, const struct gn_scene *scene, const struct gn_render_params *params, bool reference) {
    static const struct gn_render_params defaults;
    if (!params) params = &defaults;
    const struct scene_film *film = &scene->scene.film;
    *out = (struct job){
        .width = params->width ? params->width : film->width,
        .height = params->height ? params->height : film->height,
        .spp = params->spp ? params->spp : film->spp,
        .seed = params->seed,
        .aovs = params->aovs,
        .tile_pixels = params->tile_pixels,
        .accuracy = "reference",
    };
    if (out->width > MOST_PIXELS || out->height > MOST_PIXELS)
        return fail(ctx, GN_USAGE, "a picture of %u × %u pixels: at most %u along a side", out->width, out->height, MOST_PIXELS);
    if (out->spp > MOST_SAMPLES) return fail(ctx, GN_USAGE, "%u samples per pixel: at most %u", out->spp, MOST_SAMPLES);
    if (out->aovs & ~(RENDERED_LAYERS | DEVICE_LAYERS))
        return fail(ctx, GN_USAGE, "unknown layers 0x%x", out->aovs & ~(RENDERED_LAYERS | DEVICE_LAYERS));
    if (!reference && !tier_of_accuracy(&out->tier, &out->accuracy, ctx, params->accuracy)) return false;
    return plan_make(&out->plan, ctx, &scene->scene,
                     &(struct plan_params){.spp = out->spp, .disable = params->disable, .only = params->only, .no_prune = params->no_prune});
}

// Memory is handed out before it is there, so what a picture will take is held against what the machine has; the kernel would end the
// process instead. The 3 bytes are the codes of a PNG.
static bool picture_fits(const struct job *job, struct context *ctx) {
    static const uint32_t channels_of[] = {1, 3, 2, 3, 1, 1}; // of the layers, by bit
    uint32_t channels = job->aovs & COMPARED_LAYERS ? 8 : 3;  // two pictures with their depths
    for (uint32_t i = 0; i < sizeof channels_of / sizeof *channels_of; i++) channels += job->aovs >> i & 1 ? channels_of[i] : 0;
    uint64_t needed = (uint64_t)job->width * job->height * (channels * sizeof(float) + 3), left = machine_memory_free();
    if (needed <= left) return true;
    return fail(ctx, GN_LIMIT, "a picture of %u × %u pixels needs %.1f GB of memory, of which %.1f GB is free", job->width, job->height,
                1e-9 * (double)needed, 1e-9 * (double)left);
}

static bool render_on_device(struct gn_picture *picture, struct context *ctx, struct device *device, const struct gn_scene *scene,
                             const struct job *job) {
    struct render_film film = {0};
    const struct render_params params = {
        .width = job->width,
        .height = job->height,
        .spp = job->spp,
        .seed = job->seed,
        .tier = job->tier,
        .effects = job->plan.effects,
        .aovs = (job->aovs & ~COMPARED_LAYERS) | (job->aovs & GN_AOV_ULP ? GN_AOV_DEPTH : 0),
        .tile_pixels = job->tile_pixels,
    };
    if (!render_picture(&film, ctx, device, &scene->scene, &scene->bvh, &params) || !device_validated(device, ctx)) {
        render_film_finish(&film);
        return false;
    }
    picture->color = film.color, picture->depth = film.depth, picture->normal = film.normal, picture->id = film.id;
    picture->undecided = film.undecided;
    struct gn_render_stats *stats = &picture->stats;
    stats->rays = film.rays, stats->nonfinite_pixels = film.nonfinite_pixels, stats->undecided_rays = film.undecided_rays;
    stats->second_stage_rays = film.second_stage_rays, stats->host_rays = film.undecided_rays - film.second_stage_rays;
    stats->time_ms.pipeline = film.pipeline_ms, stats->time_ms.upload = film.upload_ms, stats->time_ms.trace = film.trace_ms;
    return true;
}

static bool render_on_cpu(struct gn_picture *picture, struct context *ctx, const struct gn_scene *scene, const struct job *job) {
    struct reference_film film = {0};
    const struct reference_params params = {
        .width = job->width,
        .height = job->height,
        .spp = job->spp,
        .seed = job->seed,
        .effects = job->plan.effects,
        .aovs = job->aovs,
    };
    double start = clock_seconds();
    if (!reference_render(&film, ctx, &scene->scene, &scene->bvh, &params)) {
        reference_film_finish(&film);
        return false;
    }
    picture->color = film.color, picture->depth = film.depth, picture->normal = film.normal, picture->id = film.id;
    struct gn_render_stats *stats = &picture->stats;
    stats->rays = film.rays, stats->nonfinite_pixels = film.nonfinite_pixels;
    stats->time_ms.trace = clock_ms_since(start);
    return true;
}

// The layers that compare with the reference, which renders the same picture for them.
static bool compare_layers(struct gn_picture *picture, struct context *ctx, const struct gn_scene *scene, const struct job *job) {
    bool want_error = job->aovs & GN_AOV_ERROR, want_ulp = job->aovs & GN_AOV_ULP;
    if (!want_error && !want_ulp) return true;
    struct job same = *job;
    same.aovs = GN_AOV_DEPTH;
    struct gn_picture right = {.transfer = TRANSFER_LINEAR};
    bool done = render_on_cpu(&right, ctx, scene, &same) &&
                (!want_error || layer_of_error(&picture->error, ctx, &picture->color, &right.color)) &&
                (!want_ulp || layer_of_ulp(&picture->ulp, ctx, &picture->depth, &right.depth));
    picture->stats.time_ms.reference = right.stats.time_ms.trace;
    image_finish(&right.color);
    image_finish(&right.depth);
    if (!(job->aovs & GN_AOV_DEPTH)) image_finish(&picture->depth);
    return done;
}

// Millions per second; 0 when nothing was measured.
static double mrays_per_s(uint64_t rays, double ms) { return ms > 0 ? (double)rays / (1e3 * ms) : 0; }

struct gn_picture *gn_render(struct gn_device *device, struct gn_scene *scene, const struct gn_render_params *params,
                             struct gn_error *error) {
    struct context ctx = context_make(params ? params->host : NULL, error);
    struct gn_picture *picture = array_alloc(&ctx, 1, sizeof *picture, "a picture");
    if (!picture) return NULL;
    double bvh_ms = scene->bvh_ms, start = clock_seconds();
    struct job job;
    if (!device && params && params->aovs & DEVICE_LAYERS) {
        fail(&ctx, GN_USAGE, "the layers error, ulp and undecided are about a device; the reference has none of them");
        goto fail;
    }
    if (!job_make(&job, &ctx, scene, params, !device) || !picture_fits(&job, &ctx) || !scene_bvh(scene, &ctx)) goto fail;
    if (!(device ? render_on_device(picture, &ctx, &device->device, scene, &job) : render_on_cpu(picture, &ctx, scene, &job))) goto fail;
    if (!compare_layers(picture, &ctx, scene, &job)) goto fail;

    picture->transfer = scene->scene.film.transfer;
    struct gn_render_stats *stats = &picture->stats;
    snprintf(stats->accuracy, sizeof stats->accuracy, "%s", job.accuracy);
    effect_names(job.plan.effects, stats->effects, sizeof stats->effects);
    struct gn_time *time = &stats->time_ms;
    time->startup = device ? device->startup_ms : 0, time->scene = scene->load_ms, time->bvh = scene->bvh_ms;
    time->total = time->startup + time->scene + bvh_ms + clock_ms_since(start);
    stats->mrays_per_s = mrays_per_s(stats->rays, time->trace);
    return picture;

fail:
    gn_picture_destroy(picture);
    return NULL;
}

// -------------------------------------------------------------------------------------------------------------- tracing

static bool trace_on_device(struct gn_hit *hits, struct gn_trace_stats *stats, struct context *ctx, struct device *device,
                            const struct gn_scene *scene, const struct gn_trace_params *params, const struct gn_ray *rays, size_t count) {
    const char *accuracy;
    struct render_trace_params shoot = {.any = params->any, .repeat = params->repeat ? params->repeat : 1};
    struct plan plan;
    if (!tier_of_accuracy(&shoot.tier, &accuracy, ctx, params->accuracy)) return false;
    if (!plan_make(&plan, ctx, &scene->scene, &(struct plan_params){.spp = 1})) return false;
    shoot.effects = plan.effects;
    struct render_trace_stats done = {0};
    if (!render_trace(hits, &done, ctx, device, &scene->scene, &scene->bvh, &shoot, rays, count)) return false;
    snprintf(stats->accuracy, sizeof stats->accuracy, "%s", accuracy);
    stats->hits = done.hits, stats->undecided_rays = done.undecided_rays;
    stats->second_stage_rays = done.second_stage_rays, stats->host_rays = done.undecided_rays - done.second_stage_rays;
    stats->time_ms.pipeline = done.pipeline_ms, stats->time_ms.upload = done.upload_ms, stats->time_ms.trace = done.trace_ms;
    return device_validated(device, ctx);
}

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool trace_on_cpu(struct gn_hit *hits, struct gn_trace_stats *stats, struct context *ctx, const struct gn_scene *scene,
                         const struct gn_trace_params *params, const struct gn_ray *rays, size_t count) {
    uint32_t repeat = params->repeat ? params->repeat : 1;
    double *times = array_alloc(ctx, repeat, sizeof *times, "the times of the repeats");
    if (!times) return false;
    bool done = true;
    for (uint32_t i = 0; i < repeat && done; i++) {
        double start = clock_seconds();
        done = reference_trace(hits, ctx, &scene->scene, &scene->bvh, rays, count, params->any);
        times[i] = clock_ms_since(start);
    }
    if (done) {
        qsort(times, repeat, sizeof *times, by_value);
        stats->time_ms.trace = times[repeat / 2];
        snprintf(stats->accuracy, sizeof stats->accuracy, "reference");
        for (size_t i = 0; i < count; i++) stats->hits += hits[i].object >= 0;
    }
    free(times);
    return done;
}

bool gn_trace(struct gn_device *device, struct gn_scene *scene, const struct gn_trace_params *params, const struct gn_ray *rays,
              struct gn_hit *hits, size_t count, struct gn_trace_stats *stats, struct gn_error *error) {
    static const struct gn_trace_params defaults;
    if (!params) params = &defaults;
    struct gn_trace_stats unwanted;
    if (!stats) stats = &unwanted;
    *stats = (struct gn_trace_stats){.rays = count};
    struct context ctx = context_make(params->host, error);
    double bvh_ms = scene->bvh_ms, start = clock_seconds();
    if (!scene_bvh(scene, &ctx)) return false;
    if (!(device ? trace_on_device(hits, stats, &ctx, &device->device, scene, params, rays, count)
                 : trace_on_cpu(hits, stats, &ctx, scene, params, rays, count)))
        return false;
    struct gn_time *time = &stats->time_ms;
    time->startup = device ? device->startup_ms : 0, time->scene = scene->load_ms, time->bvh = scene->bvh_ms;
    time->total = time->startup + time->scene + bvh_ms + clock_ms_since(start);
    stats->mrays_per_s = mrays_per_s(count, time->trace);
    return true;
}
