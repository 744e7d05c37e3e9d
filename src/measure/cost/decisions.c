// Every tier's decisions about one batch of rays, against the reference's, which are exact.
//
// Half of the rays are the camera's, through the pixels of the lattice: the first through their centres, others anywhere in them. The other
// half begin just before what a camera ray hits, on the ray, and end at a light, if that is on the viewer's side. A camera ray is decided
// wrongly when it hits another primitive, unless that is crossed at exactly the same t, where surfaces coincide; a light's when it hits and
// should not, or the other way round. A renderer does not ask whether a ray hits the primitive on which it begins, so such rays do not count.
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "measure/cost/cost.h"
#include "measure/layers.h"
#include "reference/predicates.h"
#include "reference/reference.h"
#include "reference/sampler.h"
#include "render/camera.h"
#include "render/render.h"

#define TRIAL_RAYS 2048
#define MOST_RAYS (1u << 19) // of a kind
#define STOP_SHORT 0x1p-20f  // of t: where a ray to a light begins; more than rounding can move it through the surface

struct batch {
    const struct cost_bench *bench;
    struct gn_ray *rays;
    struct gn_hit *right, *hits;
    uint32_t *camera_ray;       // of rays to lights: the camera ray whose hit they leave
    size_t count, camera_count; // of all rays, and of the camera's, which come first
};

static void batch_finish(struct batch *batch) {
    free(batch->rays);
    free(batch->right);
    free(batch->hits);
    free(batch->camera_ray);
}

static bool batch_init(struct batch *out, const struct cost_bench *bench, size_t camera_count) {
    *out = (struct batch){.bench = bench, .camera_count = camera_count};
    out->rays = array_alloc(bench->ctx, 2 * camera_count, sizeof *out->rays, "rays");
    out->right = array_alloc(bench->ctx, 2 * camera_count, sizeof *out->right, "the reference's hits");
    out->hits = array_alloc(bench->ctx, 2 * camera_count, sizeof *out->hits, "hits");
    out->camera_ray = array_alloc(bench->ctx, 2 * camera_count, sizeof *out->camera_ray, "rays");
    return out->rays && out->right && out->hits && out->camera_ray;
}

// ---------------------------------------------------------------------------------------------------------------- rays

static void aim_from_camera(struct batch *batch, const struct cost *cost) {
    const struct cost_params *params = &cost->params;
    const struct lattice *lattice = &cost->targets[COST_CENTRES].lattice;
    struct camera_rays camera;
    camera_rays_make(&camera, &batch->bench->scene->camera, params->width, params->height);
    uint32_t across = lattice_side(params->width, lattice->x, lattice->stride);
    uint32_t down = lattice_side(params->height, lattice->y, lattice->stride);
    for (size_t i = 0; i < batch->camera_count; i++) {
        size_t pixel = i % ((size_t)across * down);
        uint32_t sample = (uint32_t)(i / ((size_t)across * down));
        uint32_t x = lattice->x + lattice->stride * (uint32_t)(pixel % across), y = lattice->y + lattice->stride * (uint32_t)(pixel / across);
        struct camera_sample from = {.time = 0};
        sampler_film(from.offset, true, params->seed, x, y, sample, sample == 0 ? 1 : 2); // of one sample: the centre
        batch->rays[i] = camera_ray(&camera, x, y, &from);
    }
}

static double dot(const double a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void vertices(const float *v[3], const struct scene_shape *shape, int32_t primitive) {
    for (size_t k = 0; k < 3; k++) v[k] = shape->mesh.positions + 3 * (size_t)shape->mesh.indices[3 * (size_t)primitive + k];
}

// Whether the light of `ray` is on the side of what `from` hits, from which `from` comes.
static bool is_lit(const struct scene *scene, const struct gn_hit *hit, const struct gn_ray *from, const struct gn_ray *ray) {
    const struct scene_shape *shape = &scene->shapes[hit->object];
    double normal[3];
    const float *v[3];
    if (shape->type == SHAPE_SPHERE) {
        for (int i = 0; i < 3; i++) normal[i] = (double)ray->origin[i] - shape->center[i];
    } else {
        vertices(v, shape, hit->primitive);
        triangle_normal(normal, v);
    }
    return dot(normal, from->direction) * dot(normal, ray->direction) < 0;
}

static struct gn_ray to_light(const struct gn_ray *from, float t, const struct scene_light *light) {
    struct gn_ray ray = {.tmin = 0, .tmax = 1};
    for (int i = 0; i < 3; i++) {
        ray.origin[i] = from->origin[i] + t * (1 - STOP_SHORT) * from->direction[i];
        ray.direction[i] = light->position[i] - ray.origin[i];
    }
    return ray;
}

// For each camera ray that hits, one to the next light in turn.
static void aim_at_lights(struct batch *batch) {
    const struct scene *scene = batch->bench->scene;
    batch->count = batch->camera_count;
    for (size_t i = 0; i < batch->camera_count && scene->light_count > 0; i++) {
        if (batch->right[i].object < 0) continue;
        struct gn_ray ray = to_light(&batch->rays[i], batch->right[i].t, &scene->lights[i % scene->light_count]);
        if (!is_lit(scene, &batch->right[i], &batch->rays[i], &ray)) continue;
        batch->camera_ray[batch->count] = (uint32_t)i;
        batch->rays[batch->count++] = ray;
    }
}

static bool decide_rightly(struct batch *batch, size_t begin, size_t end) {
    const struct cost_bench *bench = batch->bench;
    return reference_trace(batch->right + begin, bench->ctx, bench->scene, bench->bvh, batch->rays + begin, end - begin, false);
}

// Camera rays that the reference decides in the time there is, with as many to the lights: from a trial.
static bool count_rays(size_t *out, const struct cost *cost, const struct cost_bench *bench) {
    struct batch trial;
    bool done = batch_init(&trial, bench, TRIAL_RAYS);
    double start = 0;
    if (done) {
        aim_from_camera(&trial, cost);
        start = clock_seconds();
        done = decide_rightly(&trial, 0, TRIAL_RAYS);
    }
    double fit = COST_SHARE_DECISIONS * cost->params.seconds * TRIAL_RAYS / fmax(2 * (clock_seconds() - start), 1e-6);
    *out = (size_t)fmin(fmax(fit, TRIAL_RAYS), MOST_RAYS);
    batch_finish(&trial);
    return done;
}

// --------------------------------------------------------------------------------------------------------------- judging

// Whether `ray` crosses the primitive of a hit at all, and where.
static bool cross_again(struct crossing *out, struct ref_ray *ray, const struct scene *scene, const struct gn_hit *hit) {
    const struct scene_shape *shape = &scene->shapes[hit->object];
    if (shape->type == SHAPE_SPHERE) return sphere_cross(out, ray, shape->center, shape->radius);
    const float *v[3];
    vertices(v, shape, hit->primitive);
    return triangle_cross(out, ray, v);
}

// Whether both hits are at exactly the same t.
static bool is_tie(const struct batch *batch, size_t i) {
    struct crossing ours, theirs;
    struct ref_ray ray;
    if (batch->hits[i].object < 0 || batch->right[i].object < 0 || !ref_ray_make(&ray, &batch->rays[i])) return false;
    const struct scene *scene = batch->bench->scene;
    return cross_again(&ours, &ray, scene, &batch->hits[i]) && cross_again(&theirs, &ray, scene, &batch->right[i]) &&
           crossing_compare(&ray, &ours, &theirs) == 0;
}

static bool same_primitive(const struct gn_hit *a, const struct gn_hit *b) { return a->object == b->object && a->primitive == b->primitive; }

static void judge_camera(struct cost_decisions *out, const struct batch *batch, size_t i, double *ulp_sum) {
    const struct gn_hit *hit = &batch->hits[i], *right = &batch->right[i];
    out->rays++;
    if (!same_primitive(hit, right)) {
        bool tie = is_tie(batch, i);
        out->ties += tie;
        out->wrong += !tie;
    } else if (hit->object >= 0) {
        double ulp = (double)ulp_distance(hit->t, right->t);
        out->ulp_max = fmax(out->ulp_max, ulp);
        out->compared++;
        *ulp_sum += ulp;
    }
}

static void judge_light(struct cost_decisions *out, const struct batch *batch, size_t i) {
    const struct gn_hit *hit = &batch->hits[i], *right = &batch->right[i], *start = &batch->right[batch->camera_ray[i]];
    if (same_primitive(hit, start) || same_primitive(right, start)) return;
    out->rays++;
    out->wrong += (hit->object < 0) != (right->object < 0);
}

static void judge(struct cost_decisions *out, const struct batch *batch) {
    double ulp_sum = 0;
    *out = (struct cost_decisions){.measured = true};
    for (size_t i = 0; i < batch->camera_count; i++) judge_camera(out, batch, i, &ulp_sum);
    for (size_t i = batch->camera_count; i < batch->count; i++) judge_light(out, batch, i);
    out->ulp_mean = out->compared ? ulp_sum / (double)out->compared : 0;
}

static bool decide(struct batch *batch, struct cost *cost, uint32_t tier) {
    const struct cost_bench *bench = batch->bench;
    const struct render_trace_params params = {.tier = tier, .effects = cost->params.effects, .repeat = 1};
    struct render_trace_stats stats;
    if (!render_trace(batch->hits, &stats, bench->ctx, bench->device, bench->scene, bench->bvh, &params, batch->rays, batch->count)) return false;
    judge(&cost->decisions[tier], batch);
    return true;
}

bool cost_decide(struct cost *cost, const struct cost_bench *bench) {
    struct batch batch = {0};
    size_t count;
    bool done = count_rays(&count, cost, bench) && batch_init(&batch, bench, count);
    if (done) aim_from_camera(&batch, cost);
    done = done && decide_rightly(&batch, 0, count);
    if (done) aim_at_lights(&batch);
    done = done && decide_rightly(&batch, count, batch.count);
    for (uint32_t i = 0; done && i < cost->row_count; i++) {
        uint32_t tier = cost->runs[cost->rows[i].run].config.tier;
        done = progress(bench->whole, "decisions", (double)i / cost->row_count, -1);
        if (done && !cost->decisions[tier].measured) done = decide(&batch, cost, tier);
    }
    batch_finish(&batch);
    return done;
}
