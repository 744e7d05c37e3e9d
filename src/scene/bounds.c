// Bounds. Only what triangles use counts.
#include "scene/bounds.h"

#include <float.h>
#include <math.h>

#include "scene/instances.h"

// a + b rounded up to fp32. The sum in fp64 may itself be rounded: what that leaves out is found as D. E. Knuth does (TwoSum).
static float sum_up(float a, float b) {
    const double x = a, y = b, sum = x + y;
    const double part = sum - x, rest = (x - (sum - part)) + (y - part);
    if (sum >= FLT_MAX) return FLT_MAX;
    if (sum <= -FLT_MAX) return -FLT_MAX;
    const float rounded = (float)sum;
    return rounded < sum || (rounded == sum && rest > 0) ? nextafterf(rounded, FLT_MAX) : rounded;
}

static void include(struct scene *scene, int axis, float low, float high) {
    if (low < scene->bounds_min[axis]) scene->bounds_min[axis] = low;
    if (high > scene->bounds_max[axis]) scene->bounds_max[axis] = high;
}

static void include_mesh(struct scene *scene, const struct scene_mesh *mesh) {
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) { // not all vertices: some files have stray ones
        const float *p = mesh->positions + 3 * (size_t)mesh->indices[i];
        for (int axis = 0; axis < 3; axis++) include(scene, axis, p[axis], p[axis]);
    }
}

static void include_instance(struct scene *scene, const struct scene_instance *instance) {
    for (int axis = 0; axis < 3; axis++) include(scene, axis, instance->min[axis], instance->max[axis]);
}

// At the beginning and the end of its motion; between them it is between them.
static void include_sphere(struct scene *scene, const struct scene_shape *shape) {
    for (int end = 0; end <= 1; end++) {
        float center[3];
        scene_place(center, shape, shape->center, (float)end);
        for (int axis = 0; axis < 3; axis++)
            include(scene, axis, -sum_up(-center[axis], shape->radius), sum_up(center[axis], shape->radius));
    }
}

void scene_bounds(struct scene *scene) {
    for (int axis = 0; axis < 3; axis++) scene->bounds_min[axis] = FLT_MAX, scene->bounds_max[axis] = -FLT_MAX;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct scene_shape *shape = &scene->shapes[i];
        if (shape->instance)
            include_instance(scene, &scene->instances[shape->instance - 1]);
        else if (shape->type != SHAPE_SPHERE)
            include_mesh(scene, &shape->mesh);
        else
            include_sphere(scene, shape);
    }
}
