// Rows of rays that leave a surface: the first ray finds a point, as a camera ray does; the second one starts there, as a shadow ray
// does.
//
// Judged, with exact arithmetic: that the second ray does not hit the primitive it starts on; that its start lies on the side that the
// first ray saw, and no farther from the surface than a small multiple of what rounding makes uncertain; and that it hits what a ray
// from that very start hits.
#include <gmp.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bvh/scene_boxes.h"
#include "effects/plan.h"
#include "measure/stress/job.h"
#include "measure/stress/oracle.h"
#include "reference/resolve.h"

#define FAR_ENOUGH 24.0    // units of roundoff, relative to the point and the triangle, that a start may be away from its surface
#define LARGEST_SHARE 1e-3 // of the primitive's size

struct first_ray {
    float o[3], d[3], w[3];
}; // w: direction of the second ray, up to its sign

struct second_ray {
    float t1, object1, index1, undecided1; // numbers of objects and primitives are bits
    float t2, object2, index2, undecided2;
    float start[6]; // fp32: three numbers, device coordinates; fp64: the bits of three doubles
    float direction[3];
    float normal[3];
};

_Static_assert(sizeof(struct first_ray) == STRESS_LEAVE_IN * sizeof(float), "what the kernel reads");
_Static_assert(sizeof(struct second_ray) == STRESS_LEAVE_OUT * sizeof(float), "what the kernel writes");

// Everything of one world. Zeroed is empty.
struct departure {
    struct stress *s;
    uint32_t tier;
    struct world world, device_world; // as filled; in device coordinates, with the second rays
    struct scene scene, device_scene;
    struct bvh bvh, device_bvh;
    struct device_scene ds;
    uint32_t effects;
    struct oracle_answer *firsts; // by ray of `world`
    struct first_ray *in;
    struct second_ray *out;
    uint32_t *judged, *self; // by ray of `device_world`: its number in `world`, and the primitive it starts on
};

static int32_t int_of(float bits) {
    int32_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static double start_of(const struct second_ray *ray, int k, bool fp64) {
    double value;
    if (!fp64) return ray->start[k];
    memcpy(&value, &ray->start[2 * k], sizeof value);
    return value;
}

// ------------------------------------------------------------------------------------------------------------- set-up

static void departure_finish(struct departure *d) {
    device_scene_finish(&d->ds, d->s->device);
    world_finish(&d->world);
    world_finish(&d->device_world);
    scene_finish(&d->scene);
    scene_finish(&d->device_scene);
    bvh_finish(&d->bvh);
    bvh_finish(&d->device_bvh);
    free(d->firsts);
    free(d->in);
    free(d->out);
    free(d->judged);
    free(d->self);
}

// What is hit, as a primitive of the world: a triangle's number, or triangle_count + a sphere's.
static uint32_t primitive_number(const struct world *world, int32_t object, int32_t index) {
    uint32_t first_sphere = world_sphere_object(world, 0), mesh = (uint32_t)object - world_mesh_object(world, 0), first = 0;
    if (world->sphere_count && (uint32_t)object >= first_sphere && (uint32_t)object < first_sphere + world->sphere_count)
        return world->triangle_count + (uint32_t)object - first_sphere;
    while (world->triangles[first].mesh < mesh) first++;
    return first + (uint32_t)index;
}

// A normal of a primitive at the exact hit; any length, any side.
static void normal_at(double n[3], const struct world *world, uint32_t number, const struct gn_ray *ray, double t) {
    if (number >= world->triangle_count) {
        const struct world_sphere *sphere = &world->spheres[number - world->triangle_count];
        for (int k = 0; k < 3; k++) n[k] = ray->origin[k] + t * ray->direction[k] - sphere->center[k];
        return;
    }
    const uint32_t *v = world->triangles[number].v;
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)world->vertices[v[1]][k] - world->vertices[v[0]][k];
        b[k] = (double)world->vertices[v[2]][k] - world->vertices[v[0]][k];
    }
    for (int k = 0; k < 3; k++) n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// The direction of the second ray: anywhere, or at a cosine of 1e-3 to the normal.
static void choose_direction(float w[3], struct random *random, const double normal[3], bool grazing) {
    double any[3], length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]), along = 0;
    random_direction(any, random);
    for (int k = 0; k < 3; k++) along += any[k] * normal[k] / length;
    for (int k = 0; k < 3; k++) w[k] = (float)(grazing ? any[k] - (along - 1e-3) * normal[k] / length : any[k]);
}

static bool fill_in(struct departure *d) {
    struct stress *s = d->s;
    for (uint32_t i = 0; i < d->world.ray_count; i++) {
        const struct gn_ray *ray = &d->world.rays[i];
        const struct oracle_answer *first = &d->firsts[i];
        double normal[3] = {0, 0, 1};
        memcpy(d->in[i].o, ray->origin, sizeof ray->origin);
        memcpy(d->in[i].d, ray->direction, sizeof ray->direction);
        if (first->hit) normal_at(normal, &d->world, primitive_number(&d->world, first->object, first->primitive), ray, first->t);
        choose_direction(d->in[i].w, &s->random, normal, s->row->flags & LEAVE_GRAZING);
    }
    return true;
}

static bool depart(struct departure *d, uint32_t part) {
    struct context *ctx = d->s->ctx;
    struct plan plan;
    d->s->row->fill(&d->world, &d->s->random, d->s->rays / (d->s->row->parts ? d->s->row->parts : 1) / 2 + 1, part);
    uint32_t count = d->world.ray_count;
    d->firsts = array_alloc(ctx, count, sizeof *d->firsts, "the answers of a case");
    d->in = array_alloc(ctx, count, sizeof *d->in, "rays");
    d->out = array_alloc(ctx, count, sizeof *d->out, "rays");
    d->judged = array_alloc(ctx, count, sizeof *d->judged, "rays");
    d->self = array_alloc(ctx, count, sizeof *d->self, "rays");
    const struct oracle_params params = {.threads = context_threads(ctx)};
    if (!d->firsts || !d->in || !d->out || !d->judged || !d->self || !world_ok(&d->world, ctx)) return false;
    if (!oracle_answer(d->firsts, ctx, &d->world, &params) || !world_scene(&d->scene, ctx, &d->world)) return false;
    if (!bvh_build_scene(&d->bvh, ctx, &d->scene) || !plan_make(&plan, ctx, &d->scene, &(struct plan_params){.spp = 1})) return false;
    d->effects = plan.effects;
    return device_scene_init(&d->ds, ctx, d->s->device, &d->scene, &d->bvh, d->effects, NULL, true) && fill_in(d);
}

// The world as the device has it, without rays. Coordinates that are not exact there are a fault of the device's copy, and not looked
// at here.
static bool make_device_world(struct departure *d) {
    struct world *w = &d->device_world;
    world_finish(w);
    scene_finish(&d->device_scene);
    bvh_finish(&d->device_bvh);
    if (!world_copy(w, d->s->ctx, &d->world)) return false;
    w->ray_count = 0;
    for (uint32_t i = 0; i < w->vertex_count; i++) device_point(w->vertices[i], &d->ds, d->world.vertices[i]);
    for (uint32_t i = 0; i < w->sphere_count; i++) {
        device_point(w->spheres[i].center, &d->ds, d->world.spheres[i].center);
        w->spheres[i].radius *= d->ds.scale;
    }
    return world_scene(&d->device_scene, d->s->ctx, w) && bvh_build_scene(&d->device_bvh, d->s->ctx, &d->device_scene);
}

// ------------------------------------------------------------------------------------------------------------- judging

// Rational vectors, for the few exact numbers that are needed here.
static void rational(mpq_t out[3], const double x[3]) {
    for (int k = 0; k < 3; k++) {
        mpq_init(out[k]);
        mpq_set_d(out[k], x[k]);
    }
}

static void rational_clear(mpq_t a[3]) { mpq_clears(a[0], a[1], a[2], (mpq_ptr)0); }

static void widen(double out[3], const float x[3]) {
    for (int k = 0; k < 3; k++) out[k] = x[k];
}

// The determinant of three vectors, exact until it is rounded.
static double determinant(mpq_t a[3], mpq_t b[3], mpq_t c[3]) {
    mpq_t sum, term;
    mpq_inits(sum, term, (mpq_ptr)0);
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        mpq_mul(term, a[k], b[y]);
        mpq_mul(term, term, c[z]);
        mpq_add(sum, sum, term);
        mpq_mul(term, a[k], b[z]);
        mpq_mul(term, term, c[y]);
        mpq_sub(sum, sum, term);
    }
    double value = mpq_get_d(sum);
    mpq_clears(sum, term, (mpq_ptr)0);
    return value;
}

// Twice the volume that a point spans with a triangle's edges: its sign says on which side the point is.
static double volume_over(const struct world *world, uint32_t triangle, const double point[3]) {
    const uint32_t *v = world->triangles[triangle].v;
    double p[3][3];
    mpq_t about[3], a[3], b[3], c[3];
    for (int i = 0; i < 3; i++) widen(p[i], world->vertices[v[i]]);
    rational(about, p[0]), rational(a, p[1]), rational(b, p[2]), rational(c, point);
    for (int k = 0; k < 3; k++) {
        mpq_sub(a[k], a[k], about[k]);
        mpq_sub(b[k], b[k], about[k]);
        mpq_sub(c[k], c[k], about[k]);
    }
    double value = determinant(a, b, c);
    rational_clear(about), rational_clear(a), rational_clear(b), rational_clear(c);
    return value;
}

// (|point - center|² - r²)/2r: the height over the sphere, to first order; its sign is exact.
static double height_over_sphere(const struct world_sphere *sphere, const double point[3]) {
    double center[3];
    mpq_t c[3], p[3], sum, r;
    mpq_inits(sum, r, (mpq_ptr)0);
    widen(center, sphere->center);
    rational(c, center), rational(p, point);
    mpq_set_d(r, (double)sphere->radius);
    mpq_mul(r, r, r);
    mpq_neg(sum, r);
    for (int k = 0; k < 3; k++) {
        mpq_sub(p[k], p[k], c[k]);
        mpq_mul(p[k], p[k], p[k]);
        mpq_add(sum, sum, p[k]);
    }
    double value = mpq_get_d(sum) / (2 * (double)sphere->radius);
    rational_clear(c), rational_clear(p);
    mpq_clears(sum, r, (mpq_ptr)0);
    return value;
}

// The distance of a start from its triangle's plane or its sphere, positive on the side where the first ray came from.
static double height_over(const struct world *world, uint32_t number, const double start[3], const float origin[3]) {
    double from[3], normal[3], length;
    widen(from, origin);
    if (number >= world->triangle_count) {
        const struct world_sphere *sphere = &world->spheres[number - world->triangle_count];
        double height = height_over_sphere(sphere, start);
        return height_over_sphere(sphere, from) < 0 ? -height : height;
    }
    normal_at(normal, world, number, NULL, 0);
    length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    double height = volume_over(world, number, start) / length;
    return volume_over(world, number, from) < 0 ? -height : height;
}

static double largest_of(const float v[3]) { return fmax(fabs((double)v[0]), fmax(fabs((double)v[1]), fabs((double)v[2]))); }

// How large a primitive is, and how large its coordinates are.
static void measure(double *size, double *reach, const struct world *world, uint32_t number) {
    *size = *reach = 0;
    if (number >= world->triangle_count) {
        const struct world_sphere *sphere = &world->spheres[number - world->triangle_count];
        *size = sphere->radius;
        *reach = largest_of(sphere->center) + sphere->radius;
        return;
    }
    const uint32_t *v = world->triangles[number].v;
    for (int i = 0; i < 3; i++) {
        *reach = fmax(*reach, largest_of(world->vertices[v[i]]));
        for (int k = 0; k < 3; k++) *size = fmax(*size, fabs((double)world->vertices[v[i]][k] - world->vertices[v[(i + 1) % 3]][k]));
    }
}

// What is wrong with a start, or NULL.
static const char *start_fault(const struct departure *d, uint32_t number, const double start[3], const float origin[3]) {
    double size, reach, unit = d->tier == TIER_FP64 ? 0x1p-53 : 0x1p-24;
    measure(&size, &reach, &d->device_world, number);
    for (int k = 0; k < 3; k++)
        if (!isfinite(start[k])) return "not finite";
    double height = height_over(&d->device_world, number, start, origin), rounding = unit * (size + reach);
    if (!(height > 0)) return "on the other side";
    if (height > LARGEST_SHARE * size && height > FAR_ENOUGH * rounding) return "a thousandth of the primitive away";
    if (d->tier != TIER_FAST && height > FAR_ENOUGH * rounding) return "farther away than rounding asks for";
    return NULL;
}

// Takes up the second rays whose first ray hit what it should.
static bool take_seconds(struct departure *d) {
    struct world *w = &d->device_world;
    bool fp64 = d->tier == TIER_FP64;
    if (!make_device_world(d)) return false;
    for (uint32_t i = 0; i < d->world.ray_count; i++) {
        const struct second_ray *ray = &d->out[i];
        const struct oracle_answer *first = &d->firsts[i];
        if (!first->hit || ray->undecided1 != 0 || int_of(ray->object1) != first->object || int_of(ray->index1) != first->primitive)
            continue;
        float start[3];
        for (int k = 0; k < 3; k++) start[k] = (float)start_of(ray, k, fp64);
        d->judged[w->ray_count] = i;
        d->self[w->ray_count] = primitive_number(w, first->object, first->primitive);
        world_ray(w, start, ray->direction, 0, INFINITY);
    }
    return world_ok(w, d->s->ctx);
}

// The exact tier leaves some second rays open: decided as a picture's are.
static bool resolve_seconds(struct departure *d) {
    struct world *w = &d->device_world;
    struct ref_world world = ref_world_make(&d->device_scene, &d->device_bvh, EFFECT_TRIANGLES | EFFECT_SPHERES);
    for (uint32_t i = 0; i < w->ray_count; i++) {
        struct second_ray *ray = &d->out[d->judged[i]];
        if (ray->undecided2 == 0) continue;
        struct resolve_ray question = {.tmin = 0, .tmax = INFINITY, .self = d->self[i]};
        struct resolve_answer answer;
        for (int k = 0; k < 3; k++) question.o[k] = w->rays[i].origin[k], question.d[k] = w->rays[i].direction[k];
        if (!resolve_rays(&answer, d->s->ctx, &world, &question, 1)) return false;
        memcpy(&ray->object2, &answer.hit.object, sizeof ray->object2);
        memcpy(&ray->index2, &answer.hit.primitive, sizeof ray->index2);
    }
    return true;
}

static void judge_second(struct departure *d, uint32_t i, const struct oracle_answer *right) {
    struct tally *tally = &d->s->tally[d->tier];
    const struct world *w = &d->device_world;
    const struct second_ray *ray = &d->out[d->judged[i]];
    int32_t object = int_of(ray->object2), index = int_of(ray->index2);
    float origin[3];
    double start[3];
    device_point(origin, &d->ds, d->world.rays[d->judged[i]].origin);
    for (int k = 0; k < 3; k++) start[k] = start_of(ray, k, d->tier == TIER_FP64);
    tally->rays++;
    const char *fault = start_fault(d, d->self[i], start, origin);
    if (!fault && d->self[i] < w->triangle_count && object >= 0 && primitive_number(w, object, index) == d->self[i])
        fault = "hits its own triangle";
    if (!fault && d->tier != TIER_FP64 && (object != right->object || index != right->primitive))
        fault = "hits something else than it should";
    if (fault)
        tally_wrong(tally, "primitive %u, start (%a, %a, %a) d (%a, %a, %a): %s; right %d/%d, got %d/%d", d->self[i], start[0], start[1],
                    start[2], ray->direction[0], ray->direction[1], ray->direction[2], fault, right->object, right->primitive, object,
                    index);
}

static bool run_tier(struct departure *d) {
    struct stress *s = d->s;
    const struct job job = {.fp32 = KERNEL_STRESS_LEAVE,
                            .fp64 = KERNEL_STRESS_LEAVE_FP64,
                            .tier = d->tier,
                            .effects = d->effects,
                            .count = d->world.ray_count,
                            .in = d->in->o,
                            .out = &d->out->t1,
                            .in_each = STRESS_LEAVE_IN,
                            .out_each = STRESS_LEAVE_OUT,
                            .ds = &d->ds};
    if (!job_run(s, &job) || !take_seconds(d)) return false;
    uint32_t count = d->device_world.ray_count;
    struct oracle_answer *answers = array_alloc(s->ctx, count, sizeof *answers, "the answers of a case");
    const struct oracle_params params = {.self = d->self, .threads = context_threads(s->ctx)};
    bool done = answers && oracle_answer(answers, s->ctx, &d->device_world, &params) && (d->tier != TIER_EXACT || resolve_seconds(d));
    for (uint32_t i = 0; done && i < count; i++) judge_second(d, i, &answers[i]);
    free(answers);
    return done;
}

bool run_leave(struct stress *s) {
    bool done = true;
    uint32_t parts = s->row->parts ? s->row->parts : 1;
    for (uint32_t part = 0; done && part < parts; part++) {
        struct departure d = {.s = s};
        done = depart(&d, part);
        for (d.tier = 0; done && d.tier < TIER_COUNT; d.tier++)
            if (s->judged[d.tier]) done = run_tier(&d);
        departure_finish(&d);
    }
    return done;
}
