// Batches of rays: in portions that fit the device's buffers, each portion in pieces.
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "reference/resolve.h"
#include "render/kernels.h"
#include "render/pieces.h"
#include "render/render.h"
#include "render/upload.h"

#define PORTION_RAYS (2u << 20)     // rays on the device at a time: 64 MiB of rays, 48 MiB of hits

struct batch {
    struct context *ctx;
    struct device *device;
    const struct render_trace_params *params;
    struct render_trace_stats *stats;
    struct ref_world world;         // for the host's answers
    struct device_scene ds;
    struct buffer rays, hits, list, status;
    struct kernel kernel, again;    // the second stage: exact tier, devices with doubles
    struct pieces pieces;
    double *times;                  // seconds spent shooting, by repeat
};

static bool make_buffers(struct batch *b, size_t portion) {
    struct buffer_params rays = {.name = "rays", .kind = BUFFER_TEXELS, .size = portion * sizeof(struct gn_ray), .host_writes = true};
    struct buffer_params hits = {.name = "hits", .kind = BUFFER_STORAGE, .size = portion * sizeof(struct gn_hit), .host_reads = true};
    struct buffer_params status = {.name = "status", .kind = BUFFER_STORAGE, .size = sizeof(struct status), .host_writes = true, .host_reads = true};
    size_t listed = b->params->tier == TIER_EXACT ? 2 * portion : 1; // by the first stage, by the second
    struct buffer_params list = {.name = "undecided rays", .kind = BUFFER_STORAGE, .size = listed * sizeof(uint32_t), .host_reads = true};
    return buffer_init(&b->list, b->ctx, b->device, &list) && buffer_init(&b->rays, b->ctx, b->device, &rays) && buffer_init(&b->hits, b->ctx, b->device, &hits) &&
           buffer_init(&b->status, b->ctx, b->device, &status);
}

static enum kernel_name first_kernel(const struct batch *b) {
    if (b->params->tier == TIER_FP64) return KERNEL_TRACE_FP64;
    return b->params->tier == TIER_EXACT && b->device->has_fp64 ? KERNEL_TRACE_REFINE : KERNEL_TRACE;
}

static bool make_kernel(struct batch *b, struct kernel *out, enum kernel_name name) {
    struct kernel_binding bindings[BINDING_COUNT];
    size_t count = device_scene_bindings(&b->ds, bindings, false);
    bindings[count++] = (struct kernel_binding){BINDING_RAYS, &b->rays, NULL};
    bindings[count++] = (struct kernel_binding){BINDING_HITS, &b->hits, NULL};
    bindings[count++] = (struct kernel_binding){BINDING_LIST, &b->list, NULL};
    bindings[count++] = (struct kernel_binding){BINDING_STATUS, &b->status, NULL};
    struct kernel_specialization constants = {.tier = b->params->tier, .effects = b->params->effects, .any_hit = b->params->any};
    return render_kernel_init(out, b->ctx, b->device, name, &constants, bindings, count, sizeof(struct trace_args));
}

static bool dispatch(struct batch *b, struct kernel *kernel, struct trace_args *args, uint32_t groups, double *seconds) {
    struct status *status = b->status.map;
    *status = (struct status){0};
    if (!kernel_run(kernel, b->ctx, b->device, args, groups, seconds)) return false;
    b->stats->hits += status->hits;
    if (status->stuck == 0) return true;
    return fail(b->ctx, GN_LIMIT,
                "%u rays need more than %u traversal steps, the most that this device's driver allows; "
                "another device or a newer driver may do (gnomon devices)",
                status->stuck, b->device->max_loop_steps);
}

// A kernel that the driver has compiled: software devices do so at the first dispatch, which is not to count as shooting.
static bool make_warm(struct batch *b, struct kernel *out, enum kernel_name name) {
    struct trace_args nothing = {.root = REF_NONE, .base = {0, 0, 0, 1}};
    return make_kernel(b, out, name) && dispatch(b, out, &nothing, 1, NULL);
}

// Rays that a stage left undecided: entries of the list.
struct listed { uint32_t first, count; };

// Shoots `count` rays with a kernel once, in pieces, and adds the time to *spent; those it leaves undecided are listed from open->first on.
static bool shoot(struct batch *b, struct kernel *kernel, uint32_t count, double *spent, struct listed *open) {
    struct trace_args args = {.root = b->ds.root, .base = {b->ds.base[0], b->ds.base[1], b->ds.base[2], b->ds.scale}, .list_first = open->first};
    for (uint32_t first = 0; first < count; first += args.count) {
        uint32_t groups = (count - first + GROUP_SIZE - 1) / GROUP_SIZE;
        if (groups > b->pieces.groups) groups = b->pieces.groups;
        args.first = first;
        args.count = count - first < groups * GROUP_SIZE ? count - first : groups * GROUP_SIZE;
        double seconds;
        if (!dispatch(b, kernel, &args, groups, &seconds)) return false;
        pieces_learn(&b->pieces, groups, seconds);
        *spent += seconds;
        args.list_first += ((struct status *)b->status.map)->undecided;
        if (!progress(b->ctx, "trace", -1, -1)) return false;
    }
    open->count = args.list_first - open->first;
    return true;
}

// The rays in the buffer once, through both stages; *open becomes what they leave to the host.
static bool shoot_both(struct batch *b, uint32_t count, double *spent, struct listed *open) {
    *open = (struct listed){0};
    if (!shoot(b, &b->kernel, count, spent, open)) return false;
    uint32_t undecided = open->count;
    b->stats->undecided_rays += undecided;
    if (undecided == 0 || !b->device->has_fp64) return true;
    if (!b->again.pipeline && !make_warm(b, &b->again, KERNEL_TRACE_AGAIN)) return false;
    open->first = undecided;
    if (!shoot(b, &b->again, undecided, spent, open)) return false;
    b->stats->second_stage_rays += undecided - open->count;
    return true;
}

// Decides the listed ones of a portion by exact arithmetic; the time counts as shooting.
static bool resolve_undecided(struct batch *b, const struct gn_ray *rays, struct gn_hit *hits, struct listed open) {
    double start = clock_seconds();
    const uint32_t *numbers = (const uint32_t *)b->list.map + open.first;
    struct resolve_ray *questions = array_alloc(b->ctx, open.count, sizeof *questions, "undecided rays");
    struct resolve_answer *answers = array_alloc(b->ctx, open.count, sizeof *answers, "undecided rays");
    bool ok = questions && answers;
    for (size_t i = 0; ok && i < open.count; i++) {
        const struct gn_ray *ray = &rays[numbers[i]];
        struct resolve_ray *q = &questions[i];
        *q = (struct resolve_ray){.tmin = ray->tmin, .tmax = ray->tmax, .self = RESOLVE_NO_SELF, .any = b->params->any};
        for (int k = 0; k < 3; k++) {
            q->o[k] = ray->origin[k];
            q->d[k] = ray->direction[k];
        }
    }
    ok = ok && resolve_rays(answers, b->ctx, &b->world, questions, open.count);
    for (size_t i = 0; ok && i < open.count; i++) {
        struct gn_hit *hit = &hits[numbers[i]];
        *hit = answers[i].hit;
        hit->flags |= HIT_UNDECIDED;
        b->stats->hits += hit->object >= 0;
    }
    free(questions);
    free(answers);
    for (uint32_t i = 0; i == 0 || i < b->params->repeat; i++) b->times[i] += clock_seconds() - start;
    return ok;
}

static bool shoot_portion(struct batch *b, const struct gn_ray *rays, struct gn_hit *hits, size_t begin, size_t count, size_t total) {
    if (!buffer_upload(&b->rays, b->ctx, b->device, rays + begin, count * sizeof *rays)) return false;
    uint32_t repeat = b->params->repeat ? b->params->repeat : 1;
    const struct render_trace_stats before = *b->stats;
    struct listed open = {0};
    for (uint32_t i = 0; i < repeat; i++) {
        *b->stats = before; // every repeat finds the same hits; they count once
        if (!shoot_both(b, (uint32_t)count, &b->times[i], &open)) return false;
        double done = (double)begin * repeat + (double)count * (i + 1);
        if (!progress(b->ctx, "trace", done / ((double)total * repeat), -1)) return false;
    }
    if (!buffer_download(&b->hits, b->ctx, b->device, hits + begin, count * sizeof *hits)) return false;
    return b->params->tier != TIER_EXACT || open.count == 0 || resolve_undecided(b, rays + begin, hits + begin, open);
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count) {
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

static bool run_batch(struct batch *b, const struct scene *scene, const struct bvh *bvh, const struct gn_ray *rays, struct gn_hit *hits, size_t count) {
    size_t portion = count < PORTION_RAYS ? count : PORTION_RAYS;
    b->world = ref_world_make(scene, bvh, b->params->effects);
    double start = clock_seconds();
    if (!device_scene_init(&b->ds, b->ctx, b->device, scene, bvh, b->params->effects, NULL, false) || !make_buffers(b, portion)) return false;
    b->stats->upload_ms = clock_ms_since(start);
    start = clock_seconds();
    if (!make_warm(b, &b->kernel, first_kernel(b))) return false;
    b->stats->pipeline_ms = clock_ms_since(start);
    for (size_t begin = 0; begin < count; begin += portion) {
        size_t size = count - begin < portion ? count - begin : portion;
        if (!shoot_portion(b, rays, hits, begin, size, count)) return false;
    }
    b->stats->trace_ms = 1e3 * median(b->times, b->params->repeat ? b->params->repeat : 1);
    return true;
}

static void batch_finish(struct batch *b) {
    kernel_finish(&b->kernel, b->device);
    kernel_finish(&b->again, b->device);
    buffer_finish(&b->list, b->device);
    buffer_finish(&b->rays, b->device);
    buffer_finish(&b->hits, b->device);
    buffer_finish(&b->status, b->device);
    device_scene_finish(&b->ds, b->device);
    free(b->times);
}

bool render_trace(struct gn_hit *hits, struct render_trace_stats *stats, struct context *ctx, struct device *device, const struct scene *scene,
                  const struct bvh *bvh, const struct render_trace_params *params, const struct gn_ray *rays, size_t count) {
    *stats = (struct render_trace_stats){0};
    struct batch b = {.ctx = ctx, .device = device, .params = params, .stats = stats, .pieces = pieces_make(0)};
    b.times = array_alloc(ctx, params->repeat ? params->repeat : 1, sizeof *b.times, "times");
    bool ok = tier_available(ctx, device, params->tier) && b.times && run_batch(&b, scene, bvh, rays, hits, count);
    batch_finish(&b);
    return ok;
}
