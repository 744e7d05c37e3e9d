#include "scene/instances.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "scene/mesh.h"

#define GRAIN 8192 // vertices of a piece

static const float at_home[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

void scene_place(float out[3], const struct scene_shape *shape, const float v[3], float time) {
    const float x = v[0], y = v[1], z = v[2];
    for (int i = 0; i < 3; i++) {
        const float *m = shape->placement + 4 * i;
        out[i] = shape->type == SHAPE_INSTANCE ? ((m[0] * x + m[1] * y) + m[2] * z) + m[3] : v[i];
        if (shape->moves) out[i] = out[i] + time * shape->motion[i];
    }
}

// The inverse transpose is the cofactors over the determinant. Scaled by the largest, so that the result is neither too large nor too small for fp32.
void scene_place_normal(double n[3], const struct scene_shape *shape) {
    double m[3][3], c[3][3], v[3], largest = 0;
    if (shape->type != SHAPE_INSTANCE) return;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) m[i][k] = shape->placement[4 * i + k];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            c[i][k] = m[(i + 1) % 3][(k + 1) % 3] * m[(i + 2) % 3][(k + 2) % 3] - m[(i + 1) % 3][(k + 2) % 3] * m[(i + 2) % 3][(k + 1) % 3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) largest = fmax(largest, fabs(c[i][k]));
    const double sign = m[0][0] * c[0][0] + m[0][1] * c[0][1] + m[0][2] * c[0][2] < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) v[i] = sign * ((c[i][0] * n[0] + c[i][1] * n[1]) + c[i][2] * n[2]);
    for (int i = 0; i < 3; i++) n[i] = largest > 0 ? v[i] / largest : 0;
}

static double row_sum(double a, double b, double c) { return fabs(a) + fabs(b) + fabs(c); }

// Products of two fp32 numbers are exact in fp64, so that a cofactor is rounded once. The determinant's three products and two sums are off by 2^-50 of the sum of
// their absolute values, and that is at most the condition times the determinant.
bool placement_inverse(double inverse[9], const float placement[12]) {
    double m[3][3], cofactor[3][3], largest = 0, largest_inverse = 0;
    memset(inverse, 0, 9 * sizeof *inverse);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) m[i][k] = placement[4 * i + k];
    for (int i = 0; i < 3; i++) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int k = 0; k < 3; k++) cofactor[i][k] = m[i1][(k + 1) % 3] * m[i2][(k + 2) % 3] - m[i1][(k + 2) % 3] * m[i2][(k + 1) % 3];
        largest = fmax(largest, row_sum(m[i][0], m[i][1], m[i][2]));
    }
    const double determinant = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
    for (int k = 0; k < 3; k++)
        largest_inverse = fmax(largest_inverse, row_sum(cofactor[0][k], cofactor[1][k], cofactor[2][k]) / fabs(determinant));
    if (!(largest * largest_inverse <= PLACEMENT_CONDITION)) return false;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) inverse[3 * i + k] = cofactor[k][i] / determinant;
    return true;
}

// ------------------------------------------------------------------------------------------------------------- measuring

// One shape with its mesh, and what its vertices do.
struct placing {
    const struct scene_shape *shape;
    const struct scene_mesh *mesh;
    const unsigned char *used; // vertices that triangles use
    struct range { float min[3], max[3]; bool finite, denormal; } *ranges; // of the pieces
};

static bool is_denormal(float x) { return x != 0 && fabsf(x) < FLT_MIN; }

// Whether a device that flushes denormal numbers may put the vertex elsewhere.
static bool takes_denormals(const struct scene_shape *shape, const float v[3]) {
    bool any = is_denormal(v[0]) || is_denormal(v[1]) || is_denormal(v[2]);
    for (int i = 0; i < 3; i++) {
        const float *m = shape->type == SHAPE_INSTANCE ? shape->placement + 4 * i : at_home + 4 * i;
        const float x = m[0] * v[0], y = m[1] * v[1], z = m[2] * v[2];
        any |= is_denormal(x) || is_denormal(y) || is_denormal(z) || is_denormal(x + y) || is_denormal((x + y) + z) || is_denormal(((x + y) + z) + m[3]);
    }
    return any;
}

// fl(p + fl(τ·m)) goes from p to fl(p + m) and never back: rounding is monotone.
static void include(struct range *range, const struct scene_shape *shape, const float v[3], float time) {
    float p[3];
    scene_place(p, shape, v, time);
    for (int i = 0; i < 3; i++) {
        range->finite &= isfinite(p[i]) != 0;
        range->min[i] = p[i] < range->min[i] ? p[i] : range->min[i];
        range->max[i] = p[i] > range->max[i] ? p[i] : range->max[i];
    }
}

static const struct range empty_range = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}, true, false};

static bool measure_some(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    const struct placing *placing = data;
    struct range *range = &placing->ranges[begin / GRAIN];
    *range = empty_range;
    for (size_t i = begin; i < end; i++) {
        const float *v = placing->mesh->positions + 3 * i;
        if (!placing->used[i]) continue; // some files have stray ones
        include(range, placing->shape, v, 0);
        if (placing->shape->moves) include(range, placing->shape, v, 1);
        range->denormal |= takes_denormals(placing->shape, v);
    }
    return true;
}

// The range of a shape's vertices at all times.
static bool measure(struct range *out, struct context *ctx, const struct scene_shape *shape, const struct scene_mesh *mesh, const unsigned char *used) {
    const size_t pieces = (mesh->vertex_count + (size_t)GRAIN - 1) / GRAIN;
    struct placing placing = {shape, mesh, used, array_alloc(ctx, pieces, sizeof *placing.ranges, "bounds of an instance")};
    *out = empty_range;
    if (!placing.ranges) return false;
    parallel_for(context_threads(ctx), mesh->vertex_count, GRAIN, measure_some, &placing);
    for (size_t i = 0; i < pieces; i++) {
        for (int k = 0; k < 3; k++) {
            out->min[k] = fminf(out->min[k], placing.ranges[i].min[k]);
            out->max[k] = fmaxf(out->max[k], placing.ranges[i].max[k]);
        }
        out->finite &= placing.ranges[i].finite;
        out->denormal |= placing.ranges[i].denormal;
    }
    free(placing.ranges);
    return true;
}

static unsigned char *used_vertices(struct context *ctx, const struct scene_mesh *mesh) {
    unsigned char *used = array_alloc(ctx, mesh->vertex_count, 1, "vertices of a mesh");
    for (size_t i = 0; used && i < 3 * (size_t)mesh->triangle_count; i++) used[mesh->indices[i]] = 1;
    return used;
}

// ------------------------------------------------------------------------------------------------------------ flattening

static bool copy(void **out, struct context *ctx, const void *from, size_t count, size_t size) {
    *out = NULL;
    if (!from) return true;
    *out = array_alloc(ctx, count, size, "an instance");
    if (*out) memcpy(*out, from, count * size);
    return *out != NULL;
}

static bool copy_mesh(struct scene_mesh *out, struct context *ctx, const struct scene_mesh *from) {
    *out = (struct scene_mesh){.vertex_count = from->vertex_count, .triangle_count = from->triangle_count};
    return copy((void **)&out->positions, ctx, from->positions, 3 * (size_t)from->vertex_count, sizeof(float)) &&
           copy((void **)&out->normals, ctx, from->normals, 3 * (size_t)from->vertex_count, sizeof(float)) &&
           copy((void **)&out->uvs, ctx, from->uvs, 2 * (size_t)from->vertex_count, sizeof(float)) &&
           copy((void **)&out->indices, ctx, from->indices, 3 * (size_t)from->triangle_count, sizeof(uint32_t)) &&
           copy((void **)&out->materials, ctx, from->materials, from->triangle_count, sizeof(uint32_t));
}

// Turns an instance into a mesh. `last`: nobody else draws the prototype, its arrays are taken.
static bool flatten(struct scene *scene, struct context *ctx, struct scene_shape *shape, bool last) {
    struct scene_mesh *prototype = &scene->prototypes[shape->prototype];
    if (last) {
        shape->mesh = *prototype;
        *prototype = (struct scene_mesh){0};
    } else if (!copy_mesh(&shape->mesh, ctx, prototype)) {
        return false;
    }
    struct scene_mesh *mesh = &shape->mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float placed[3];
        scene_place(placed, shape, mesh->positions + 3 * i, 0);
        memcpy(mesh->positions + 3 * i, placed, sizeof placed);
        if (!mesh->normals) continue;
        double n[3] = {mesh->normals[3 * i], mesh->normals[3 * i + 1], mesh->normals[3 * i + 2]};
        scene_place_normal(n, shape);
        for (int k = 0; k < 3; k++) mesh->normals[3 * i + k] = (float)n[k];
    }
    if (shape->own_material) {
        free(mesh->materials);
        mesh->materials = NULL;
    }
    shape->type = SHAPE_MESH;
    return true;
}

// ---------------------------------------------------------------------------------------------------------------- listing

// What is known while the list is made.
struct listing {
    struct scene *scene;
    struct context *ctx;
    uint32_t *users;         // by prototype: shapes that draw it
    uint32_t *part_of;       // by prototype: 1 + its part; 0: none yet
    unsigned char **used;    // by prototype: its vertices in use; made when needed
    uint64_t triangles;      // of the instances so far
};

static bool is_placed(const struct scene_shape *shape) { return shape->type == SHAPE_INSTANCE || (shape->moves && shape->type != SHAPE_SPHERE); }

static void stop_if_still(struct scene_shape *shape) {
    shape->moves = shape->moves && (shape->motion[0] != 0 || shape->motion[1] != 0 || shape->motion[2] != 0);
}

// The part that a shape draws, new if it is the first to do so.
static uint32_t part_take(struct listing *listing, const struct scene_shape *shape) {
    struct scene *scene = listing->scene;
    const bool prototype = shape->type == SHAPE_INSTANCE;
    if (prototype && listing->part_of[shape->prototype]) return listing->part_of[shape->prototype] - 1;
    const struct scene_mesh *mesh = prototype ? &scene->prototypes[shape->prototype] : &shape->mesh;
    struct scene_part *part = &scene->parts[scene->part_count];
    *part = (struct scene_part){.mesh = mesh, .min = {FLT_MAX, FLT_MAX, FLT_MAX}, .max = {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    if (scene->part_count > 0) part->first = part[-1].first + part[-1].mesh->triangle_count;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const float x = mesh->positions[3 * (size_t)mesh->indices[i] + k];
            part->min[k] = fminf(part->min[k], x);
            part->max[k] = fmaxf(part->max[k], x);
        }
    if (prototype) listing->part_of[shape->prototype] = scene->part_count + 1;
    return scene->part_count++;
}

static bool list_add(struct listing *listing, uint32_t number, const struct range *range) {
    struct scene *scene = listing->scene;
    struct scene_shape *shape = &scene->shapes[number];
    struct scene_instance *instance = &scene->instances[scene->instance_count];
    *instance = (struct scene_instance){.shape = number, .part = part_take(listing, shape), .first = (uint32_t)listing->triangles};
    memcpy(instance->min, range->min, sizeof range->min);
    memcpy(instance->max, range->max, sizeof range->max);
    shape->instance = ++scene->instance_count;
    listing->triangles += scene->parts[instance->part].mesh->triangle_count;
    return listing->triangles <= MOST_INSTANCED ||
           fail(listing->ctx, GN_LIMIT, "%s: the instances have more than %u triangles in all", scene->path, MOST_INSTANCED);
}

static bool list_shape(struct listing *listing, uint32_t number) {
    struct scene *scene = listing->scene;
    struct scene_shape *shape = &scene->shapes[number];
    const bool instance = shape->type == SHAPE_INSTANCE;
    const struct scene_mesh *mesh = instance ? &scene->prototypes[shape->prototype] : &shape->mesh;
    unsigned char *own = NULL, **used = instance ? &listing->used[shape->prototype] : &own;
    double inverse[9];
    struct range range;
    if (mesh->triangle_count == 0) return true;
    if (!*used) *used = used_vertices(listing->ctx, mesh);
    const bool measured = *used && measure(&range, listing->ctx, shape, mesh, *used);
    free(own);
    if (!measured) return false;
    if (!range.finite) return fail(listing->ctx, GN_SCENE, "%s: shape %u leaves the range of fp32 (3.4e38)", scene->path, number);
    const bool last = instance && listing->users[shape->prototype] == 1;
    if (instance && !shape->moves && (last || range.denormal || !placement_inverse(inverse, shape->placement))) {
        listing->users[shape->prototype]--;
        return flatten(scene, listing->ctx, shape, last);
    }
    return list_add(listing, number, &range);
}

bool scene_list_instances(struct scene *scene, struct context *ctx) {
    uint32_t placed = 0;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        stop_if_still(&scene->shapes[i]);
        scene->shapes[i].instance = 0;
        placed += is_placed(&scene->shapes[i]);
    }
    if (placed == 0) return true;
    struct listing listing = {.scene = scene, .ctx = ctx};
    scene->instances = array_alloc(ctx, placed, sizeof *scene->instances, "instances");
    scene->parts = array_alloc(ctx, placed, sizeof *scene->parts, "instances");
    listing.users = array_alloc(ctx, scene->prototype_count, sizeof *listing.users, "instances");
    listing.part_of = array_alloc(ctx, scene->prototype_count, sizeof *listing.part_of, "instances");
    listing.used = array_alloc(ctx, scene->prototype_count, sizeof *listing.used, "instances");
    bool done = scene->instances && scene->parts && listing.users && listing.part_of && listing.used;
    for (uint32_t i = 0; done && i < scene->shape_count; i++)
        if (scene->shapes[i].type == SHAPE_INSTANCE) listing.users[scene->shapes[i].prototype]++;
    for (uint32_t i = 0; done && i < scene->shape_count; i++)
        if (is_placed(&scene->shapes[i])) done = list_shape(&listing, i);
    for (uint32_t i = 0; listing.used && i < scene->prototype_count; i++) free(listing.used[i]);
    free(listing.users);
    free(listing.part_of);
    free(listing.used);
    return done;
}
