// Boxes of triangles and instances are exact; those of spheres are rounded outward. Shapes are walked in order, a piece of the scene's
// primitives at a time.
#include "bvh/scene_boxes.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "bvh/watch.h"
#include "scene/instances.h"

#define GRAIN 16384 // primitives of a piece

struct boxes_of_scene {
    const struct scene *scene;
    struct bvh_box *boxes;
    uint32_t triangle_count, sphere_count;
    struct bvh_watch watch;
};

// The least float that is not below the exact a + b.
static float sum_up(float a, float b) {
    // Knuth's two-sum: the exact sum is sum + error.
    double sum = (double)a + (double)b;
    double b_part = sum - (double)a;
    double error = ((double)a - (sum - b_part)) + ((double)b - b_part);
    float rounded = (float)sum;
    bool below = (double)rounded < sum || ((double)rounded == sum && error > 0);
    return below ? nextafterf(rounded, INFINITY) : rounded;
}

static struct bvh_box sphere_box(const struct scene_shape *shape) {
    struct bvh_box box;
    float begin[3], end[3]; // between them it is between them: fl(p + fl(τ·m)) is monotone in τ
    scene_place(begin, shape, shape->center, 0);
    scene_place(end, shape, shape->center, 1);
    for (int axis = 0; axis < 3; axis++) {
        box.min[axis] = -sum_up(shape->radius, -fminf(begin[axis], end[axis]));
        box.max[axis] = sum_up(shape->radius, fmaxf(begin[axis], end[axis]));
    }
    return box;
}

static struct bvh_box triangle_box(const struct scene_mesh *mesh, uint32_t triangle) {
    const uint32_t *vertices = &mesh->indices[3 * (size_t)triangle];
    struct bvh_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int corner = 0; corner < 3; corner++) {
        const float *position = &mesh->positions[3 * (size_t)vertices[corner]];
        for (int axis = 0; axis < 3; axis++) {
            box.min[axis] = position[axis] < box.min[axis] ? position[axis] : box.min[axis];
            box.max[axis] = position[axis] > box.max[axis] ? position[axis] : box.max[axis];
        }
    }
    return box;
}

// The shape that holds this number, in first[0 … count]: the last that begins at or before it.
static uint32_t shape_of(const uint32_t *first, uint32_t count, uint32_t number) {
    uint32_t low = 0, high = count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (first[middle] <= number)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void triangle_boxes(struct boxes_of_scene *all, uint32_t begin, uint32_t end) {
    const struct scene *scene = all->scene;
    uint32_t shape = shape_of(scene->first_triangle, scene->shape_count, begin);
    for (uint32_t i = begin; i < end; i++) {
        while (scene->first_triangle[shape + 1] <= i) shape++;
        all->boxes[i] = triangle_box(&scene->shapes[shape].mesh, i - scene->first_triangle[shape]);
    }
}

static void sphere_boxes(struct boxes_of_scene *all, uint32_t begin, uint32_t end) {
    const struct scene *scene = all->scene;
    uint32_t shape = shape_of(scene->first_sphere, scene->shape_count, begin);
    for (uint32_t i = begin; i < end; i++) {
        while (scene->first_sphere[shape + 1] <= i) shape++;
        all->boxes[all->triangle_count + i] = sphere_box(&scene->shapes[shape]);
    }
}

static struct bvh_box instance_box(const struct scene_instance *instance) {
    struct bvh_box box;
    memcpy(box.min, instance->min, sizeof box.min);
    memcpy(box.max, instance->max, sizeof box.max);
    return box;
}

static bool piece_boxes(void *data, size_t begin, size_t end, unsigned thread) {
    struct boxes_of_scene *all = data;
    size_t triangles = all->triangle_count, others = triangles + all->sphere_count, last = end < others ? end : others;
    if (begin < triangles) triangle_boxes(all, (uint32_t)begin, (uint32_t)(end < triangles ? end : triangles));
    if (last > triangles && begin < others) sphere_boxes(all, (uint32_t)(begin > triangles ? begin - triangles : 0), (uint32_t)(last - triangles));
    for (size_t i = begin > others ? begin : others; i < end; i++) all->boxes[i] = instance_box(&all->scene->instances[i - others]);
    return bvh_watch_go_on(&all->watch, thread);
}

static bool build_top(struct bvh *out, struct context *ctx, const struct scene *scene) {
    uint32_t triangles = scene->first_triangle[scene->shape_count], spheres = scene->first_sphere[scene->shape_count];
    if (spheres > UINT32_MAX - triangles || scene->instance_count > UINT32_MAX - triangles - spheres)
        return fail(ctx, GN_LIMIT, "%" PRIu32 " triangles, %" PRIu32 " spheres and %" PRIu32 " instances are more than a BVH can hold", triangles,
                    spheres, scene->instance_count);
    uint32_t count = triangles + spheres + scene->instance_count;
    if (count == 0) return true;
    struct bvh_params params = {.split_at = triangles, .singles = scene->instance_count};
    struct boxes_of_scene all = {.scene = scene, .triangle_count = triangles, .sphere_count = spheres};
    all.boxes = array_alloc(ctx, count, sizeof *all.boxes, "the boxes of the scene's primitives");
    if (!all.boxes) return false;
    bool done = bvh_watch_begin(&all.watch, ctx, count) && parallel_for(context_threads(ctx), count, GRAIN, piece_boxes, &all) &&
                bvh_build(out, ctx, all.boxes, count, &params);
    free(all.boxes);
    return done;
}

// The boxes of a part's triangles.
struct boxes_of_part {
    const struct scene_mesh *mesh;
    struct bvh_box *boxes;
};

static bool part_boxes(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    struct boxes_of_part *all = data;
    for (size_t i = begin; i < end; i++) all->boxes[i] = triangle_box(all->mesh, (uint32_t)i);
    return true;
}

static bool build_part(struct bvh *out, struct context *ctx, const struct scene_mesh *mesh) {
    const uint32_t count = mesh->triangle_count;
    struct boxes_of_part all = {.mesh = mesh, .boxes = array_alloc(ctx, count, sizeof *all.boxes, "the boxes of an instance's triangles")};
    if (!all.boxes) return false;
    bool done = parallel_for(context_threads(ctx), count, GRAIN, part_boxes, &all) &&
                bvh_build(out, ctx, all.boxes, count, &(struct bvh_params){.split_at = count});
    free(all.boxes);
    return done;
}

bool bvh_build_scene(struct bvh *out, struct context *ctx, const struct scene *scene) {
    *out = (struct bvh){0};
    if (scene->shape_count == 0) return true; // first_triangle may be NULL then
    if (!build_top(out, ctx, scene)) return false;
    if (scene->part_count == 0) return true;
    out->parts = array_alloc(ctx, scene->part_count, sizeof *out->parts, "BVHs of instances");
    bool done = out->parts != NULL;
    while (done && out->part_count < scene->part_count) {
        done = build_part(&out->parts[out->part_count], ctx, scene->parts[out->part_count].mesh);
        out->part_count++;
    }
    if (!done) bvh_finish(out);
    return done;
}
