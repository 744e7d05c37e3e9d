#include "render/pending.h"

#include <stdlib.h>
#include <string.h>

#include "reference/resolve.h"

#define HEADER_WORDS 1  // of the buffer: the count

// What ray.glsl calls the primitive that a ray leaves.
#define SELF_NONE 0xffffffffu
#define SELF_SPHERE 0x80000000u

bool pending_init(struct pending *out, struct context *ctx, struct device *device, bool exact) {
    *out = (struct pending){0};
    size_t words = HEADER_WORDS + (exact ? PENDING_CAPACITY * PENDING_WORDS : 1);
    struct buffer_params params = {
        .name = "pending samples", .kind = BUFFER_STORAGE, .size = words * sizeof(struct word4), .host_writes = true, .host_reads = true};
    return buffer_init(&out->buffer, ctx, device, &params);
}

void pending_finish(struct pending *pending, struct device *device) {
    kernel_finish(&pending->kernel, device);
    kernel_finish(&pending->again, device);
    buffer_finish(&pending->buffer, device);
    free(pending->slot_of);
    free(pending->primitive_at[0]);
    free(pending->primitive_at[1]);
    free(pending->place_of);
    *pending = (struct pending){0};
}

void pending_clear(struct pending *pending) { ((struct word4 *)pending->buffer.map)->w[0] = 0; }

bool pending_overflowed(const struct pending *pending) { return ((const struct word4 *)pending->buffer.map)->w[0] > PENDING_CAPACITY; }

static uint32_t record_count(const struct pending *pending) {
    uint32_t asked = ((const struct word4 *)pending->buffer.map)->w[0];
    return asked < PENDING_CAPACITY ? asked : PENDING_CAPACITY;
}

static struct word4 *record(const struct pending *pending, uint32_t number) {
    return (struct word4 *)pending->buffer.map + HEADER_WORDS + (size_t)number * PENDING_WORDS;
}

// Triangles of all parts.
static uint32_t part_triangles(const struct scene *scene) {
    const struct scene_part *last = scene->part_count ? &scene->parts[scene->part_count - 1] : NULL;
    return last ? last->first + last->mesh->triangle_count : 0;
}

// Leaf order to primitives and back; made once, when the first question comes.
static bool make_maps(struct pending *p, struct context *ctx, const struct scene *scene, const struct bvh *bvh) {
    uint32_t triangles = scene_triangle_count(scene), spheres = scene_sphere_count(scene), next[2] = {0, 0};
    p->slot_of = array_alloc(ctx, bvh->primitive_count, sizeof *p->slot_of, "primitive numbers");
    p->primitive_at[0] = array_alloc(ctx, triangles, sizeof *p->primitive_at[0], "primitive numbers");
    p->primitive_at[1] = array_alloc(ctx, spheres, sizeof *p->primitive_at[1], "primitive numbers");
    if (!p->slot_of || !p->primitive_at[0] || !p->primitive_at[1]) return false;
    for (uint32_t i = 0; i < bvh->primitive_count; i++) {
        uint32_t primitive = bvh->order[i], kind = primitive >= triangles;
        if (primitive >= triangles + spheres) continue;
        p->slot_of[primitive] = next[kind];
        p->primitive_at[kind][next[kind]++] = primitive;
    }
    p->place_of = array_alloc(ctx, part_triangles(scene), sizeof *p->place_of, "primitive numbers");
    for (uint32_t i = 0; p->place_of && i < scene->part_count; i++)
        for (uint32_t k = 0; k < bvh->parts[i].primitive_count; k++) p->place_of[scene->parts[i].first + bvh->parts[i].order[k]] = k;
    return p->place_of != NULL;
}

// On the device an instance's triangles are numbered in leaf order, in the BVH as the mesh has them; one set of numbers begins behind the triangles in
// leaf order, the other behind the spheres.
static uint32_t number_of(const struct pending *p, const struct pending_work *work, uint32_t self) {
    const struct scene *scene = work->scene;
    const uint32_t triangles = scene_triangle_count(scene), slots = triangles + part_triangles(scene);
    if (self & SELF_SPHERE || self < slots) return p->primitive_at[self >> 31][self & ~SELF_SPHERE];
    const struct scene_instance *instance = scene_instance_at(scene, self - slots);
    const uint32_t place = self - slots - instance->first;
    return triangles + scene_sphere_count(scene) + instance->first + work->bvh->parts[instance->part].order[place];
}

static uint32_t self_of(const struct pending *p, const struct scene *scene, uint32_t number) {
    const uint32_t triangles = scene_triangle_count(scene), others = triangles + scene_sphere_count(scene);
    if (number < others) return p->slot_of[number] | (number >= triangles ? SELF_SPHERE : 0);
    const struct scene_instance *instance = scene_instance_at(scene, number - others);
    const uint32_t triangle = number - others - instance->first;
    return triangles + part_triangles(scene) + instance->first + p->place_of[scene->parts[instance->part].first + triangle];
}

static bool make_ready(struct pending *p, const struct pending_work *work) {
    if (p->kernel.pipeline) return true;
    if (!p->slot_of && !make_maps(p, work->ctx, work->scene, work->bvh)) return false;
    struct kernel_specialization constants = *work->specialization;
    constants.resolve = true;
    if (work->device->has_fp64 && !p->again.pipeline) {
        if (!render_kernel_init(&p->again, work->ctx, work->device, KERNEL_PENDING_AGAIN, &constants, work->bindings, work->binding_count,
                                sizeof(struct trace_args)))
            return false;
    }
    return render_kernel_init(&p->kernel, work->ctx, work->device, KERNEL_RENDER, &constants, work->bindings, work->binding_count,
                              sizeof(struct render_args));
}

static float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// A record's question, in scene coordinates. The origin's sum is exact but for components a billion times smaller than the base, which fp64 rounds.
static struct resolve_ray question(const struct pending *p, const struct word4 *r, const struct pending_work *work) {
    const struct device_scene *ds = work->ds;
    struct resolve_ray ray = {.tmin = 0, .tmax = (double)float_of(r[2].w[3]) / ds->scale, .any = r[3].w[0] & 1, .self = RESOLVE_NO_SELF};
    for (int i = 0; i < 3; i++) {
        ray.o[i] = (double)float_of(r[1].w[i]) / ds->scale + ds->base[i];
        ray.d[i] = float_of(r[2].w[i]);
    }
    memcpy(&ray.time, &r[3].w[3], sizeof ray.time);
    int32_t object = (int32_t)r[3].w[1];
    if (object >= 0) ray.target = (struct ref_target){.there = true, .object = (uint32_t)object, .index = (int32_t)r[3].w[2]};
    uint32_t self = r[1].w[3];
    if (self != SELF_NONE) ray.self = number_of(p, work, self);
    return ray;
}

// Appends an answer to a record, in device units.
static void store_answer(const struct pending *p, struct word4 *r, const struct resolve_answer *answer, const struct pending_work *work) {
    uint32_t at = 4 + 2 * r[0].w[2]++;
    const struct gn_hit *hit = &answer->hit;
    bool closest = !(r[3].w[0] & 1) && hit->object >= 0;
    uint32_t primitive = closest ? self_of(p, work->scene, answer->number) : SELF_NONE;
    r[at] = (struct word4){{r[3].w[0] >> 1, (uint32_t)hit->object, (uint32_t)hit->primitive, primitive}};
    r[0].w[3] = PENDING_ANSWERED;
    r[at + 1] = (struct word4){{bits_of(hit->t * work->ds->scale), bits_of(hit->u), bits_of(hit->v), 0}};
}

// Decides the ray of every record that still asks.
static bool answer_all(struct pending *p, const struct pending_work *work, uint32_t records) {
    static const char *what = "undecided rays";
    struct resolve_ray *rays = array_alloc(work->ctx, records, sizeof *rays, what);
    struct resolve_answer *answers = array_alloc(work->ctx, records, sizeof *answers, what);
    uint32_t count = 0;
    bool ok = rays && answers;
    for (uint32_t i = 0; ok && i < records; i++) {
        const struct word4 *r = record(p, i);
        if (r[0].w[3] != PENDING_ASKS) continue;
        if (r[0].w[2] == PENDING_ANSWERS)
            ok = fail(work->ctx, GN_LIMIT, "more than %d rays of one sample are undecided, the most that the exact tier keeps", PENDING_ANSWERS);
        rays[count++] = question(p, r, work);
    }
    struct ref_world world = ref_world_make(work->scene, work->bvh, work->specialization->effects);
    ok = ok && resolve_rays(answers, work->ctx, &world, rays, count);
    for (uint32_t i = 0, k = 0; ok && i < records; i++)
        if (record(p, i)[0].w[3] == PENDING_ASKS) store_answer(p, record(p, i), &answers[k++], work);
    free(rays);
    free(answers);
    return ok;
}

static uint32_t records_in(const struct pending *p, uint32_t records, uint32_t state) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < records; i++) count += record(p, i)[0].w[3] == state;
    return count;
}

// The second stage on the device: answers what fp64 decides.
static bool run_again(struct pending *p, const struct pending_work *work, uint32_t groups, struct status *sums) {
    if (!p->again.pipeline) return true;
    struct trace_args args = {.root = work->ds->root};
    *work->status = (struct status){0};
    if (!kernel_run(&p->again, work->ctx, work->device, &args, groups, NULL)) return false;
    sums->decided += work->status->decided;
    return true;
}

// The samples that have their answers, once more.
static bool run_samples(struct pending *p, const struct pending_work *work, uint32_t groups, struct status *sums) {
    *work->status = (struct status){0};
    if (!kernel_run(&p->kernel, work->ctx, work->device, work->args, groups, NULL)) return false;
    sums->rays += work->status->rays;
    sums->nonfinite += work->status->nonfinite;
    sums->undecided += work->status->undecided;
    sums->stuck += work->status->stuck;
    return true;
}

bool pending_resolve(struct pending *pending, const struct pending_work *work, struct status *sums) {
    uint32_t records = record_count(pending), groups = (records + GROUP_SIZE - 1) / GROUP_SIZE;
    if (records == 0) return true;
    if (!make_ready(pending, work)) return false;
    while (records_in(pending, records, PENDING_ASKS) > 0) {
        if (!run_again(pending, work, groups, sums) || !answer_all(pending, work, records)) return false;
        if (!run_samples(pending, work, groups, sums)) return false;
    }
    return true;
}
