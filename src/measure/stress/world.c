// See world.h. Everything here works on the fp32 numbers themselves: what is to be exact is.
#include "measure/stress/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/build.h"
#include "scene/mesh.h"

void world_finish(struct world *world) {
    free(world->vertices);
    free(world->triangles);
    free(world->spheres);
    free(world->rays);
    *world = (struct world){0};
}

// Room for one more item; the array moves. False, and the world failed, without memory.
static bool grow(struct world *world, void *array, uint32_t count, uint32_t *room, size_t size) {
    void **pointer = array;
    if (world->failed) return false;
    if (count < *room) return true;
    uint32_t more = *room ? 2 * *room : 16;
    void *moved = more > *room ? realloc(*pointer, more * size) : NULL;
    if (!moved) return !(world->failed = true);
    *pointer = moved;
    *room = more;
    return true;
}

uint32_t world_vertex(struct world *world, double x, double y, double z) {
    if (!grow(world, &world->vertices, world->vertex_count, &world->vertex_room, sizeof *world->vertices)) return 0;
    float *v = world->vertices[world->vertex_count];
    v[0] = (float)x, v[1] = (float)y, v[2] = (float)z;
    return world->vertex_count++;
}

void world_triangle(struct world *world, uint32_t a, uint32_t b, uint32_t c) {
    if (!grow(world, &world->triangles, world->triangle_count, &world->triangle_room, sizeof *world->triangles)) return;
    world->triangles[world->triangle_count++] = (struct world_triangle){{a, b, c}, world->mesh};
}

void world_sphere(struct world *world, const float center[3], float radius) {
    if (!grow(world, &world->spheres, world->sphere_count, &world->sphere_room, sizeof *world->spheres)) return;
    world->spheres[world->sphere_count++] = (struct world_sphere){{center[0], center[1], center[2]}, radius};
}

void world_ray(struct world *world, const float origin[3], const float direction[3], float tmin, float tmax) {
    if (!grow(world, &world->rays, world->ray_count, &world->ray_room, sizeof *world->rays)) return;
    struct gn_ray *ray = &world->rays[world->ray_count++];
    memcpy(ray->origin, origin, sizeof ray->origin);
    memcpy(ray->direction, direction, sizeof ray->direction);
    ray->tmin = tmin, ray->tmax = tmax;
}

void world_lone_triangle(struct world *world, const float v[9]) {
    uint32_t first = world_vertex(world, v[0], v[1], v[2]);
    world_vertex(world, v[3], v[4], v[5]);
    world_vertex(world, v[6], v[7], v[8]);
    world_triangle(world, first, first + 1, first + 2);
}

void world_aim(struct world *world, const float origin[3], const double p[3]) {
    float d[3];
    for (int i = 0; i < 3; i++) d[i] = (float)(p[i] - origin[i]);
    world_ray(world, origin, d, 0, INFINITY);
}

bool world_ok(const struct world *world, struct context *ctx) {
    return !world->failed || fail(ctx, GN_LIMIT, "no memory for the shapes or rays of a case");
}

bool world_copy(struct world *out, struct context *ctx, const struct world *from) {
    *out = (struct world){.mesh = from->mesh, .spheres_first = from->spheres_first, .failed = from->failed};
    for (uint32_t i = 0; i < from->vertex_count; i++) world_vertex(out, from->vertices[i][0], from->vertices[i][1], from->vertices[i][2]);
    for (uint32_t i = 0; i < from->triangle_count; i++) {
        const struct world_triangle *t = &from->triangles[i];
        out->mesh = t->mesh;
        world_triangle(out, t->v[0], t->v[1], t->v[2]);
    }
    out->mesh = from->mesh;
    for (uint32_t i = 0; i < from->sphere_count; i++) world_sphere(out, from->spheres[i].center, from->spheres[i].radius);
    for (uint32_t i = 0; i < from->ray_count; i++) {
        const struct gn_ray *ray = &from->rays[i];
        world_ray(out, ray->origin, ray->direction, ray->tmin, ray->tmax);
    }
    return world_ok(out, ctx);
}

// ---------------------------------------------------------------------------------------- what leaves the question the same

static void fuzz_numbers(float *x, size_t count, struct random *random, int ulps, bool zeros) {
    for (size_t i = 0; i < count; i++) {
        float moved = zeros || x[i] != 0 ? random_ulps(random, x[i], ulps) : x[i];
        if (isfinite(moved)) x[i] = moved;
    }
}

static void fuzz_ray(struct gn_ray *ray, struct random *random, int ulps, bool zeros) {
    fuzz_numbers(ray->origin, 3, random, ulps, zeros);
    fuzz_numbers(ray->direction, 3, random, ulps, zeros);
    fuzz_numbers(&ray->tmin, 1, random, ulps, zeros);
    fuzz_numbers(&ray->tmax, 1, random, ulps, zeros);
}

void world_fuzz(struct world *world, struct random *random, int ulps) {
    fuzz_numbers(world->vertex_count ? world->vertices[0] : NULL, 3 * (size_t)world->vertex_count, random, ulps, true);
    for (uint32_t i = 0; i < world->sphere_count; i++) {
        fuzz_numbers(world->spheres[i].center, 3, random, ulps, true);
        fuzz_numbers(&world->spheres[i].radius, 1, random, ulps, true);
    }
    for (uint32_t i = 0; i < world->ray_count; i++) fuzz_ray(&world->rays[i], random, ulps, true);
}

static bool scales(const float *x, size_t count, int k) {
    for (size_t i = 0; i < count; i++) {
        float scaled = ldexpf(x[i], k);
        if (x[i] != 0 && isfinite(x[i]) && (fabsf(scaled) < 0x1p-120f || fabsf(scaled) > 0x1p120f)) return false;
    }
    return true;
}

static void scale_numbers(float *x, size_t count, int k) {
    for (size_t i = 0; i < count; i++) x[i] = ldexpf(x[i], k);
}

bool world_scale(struct world *world, int k) {
    if (world->vertex_count && !scales(world->vertices[0], 3 * (size_t)world->vertex_count, k)) return false;
    for (uint32_t i = 0; i < world->sphere_count; i++)
        if (!scales(world->spheres[i].center, 3, k) || !scales(&world->spheres[i].radius, 1, k)) return false;
    for (uint32_t i = 0; i < world->ray_count; i++) {
        const struct gn_ray *ray = &world->rays[i];
        if (!scales(ray->origin, 3, k) || !scales(&ray->tmin, 1, k) || !scales(&ray->tmax, 1, k)) return false;
    }
    if (world->vertex_count) scale_numbers(world->vertices[0], 3 * (size_t)world->vertex_count, k);
    for (uint32_t i = 0; i < world->sphere_count; i++) {
        scale_numbers(world->spheres[i].center, 3, k);
        scale_numbers(&world->spheres[i].radius, 1, k);
    }
    for (uint32_t i = 0; i < world->ray_count; i++) {
        struct gn_ray *ray = &world->rays[i];
        scale_numbers(ray->origin, 3, k);
        scale_numbers(&ray->tmin, 1, k);
        scale_numbers(&ray->tmax, 1, k);
    }
    return true;
}

static void turn_vector(float v[3], uint32_t how) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const int *order = orders[how / 8 % 6];
    float turned[3];
    for (int i = 0; i < 3; i++) turned[i] = how >> i & 1 ? -v[order[i]] : v[order[i]];
    memcpy(v, turned, sizeof turned);
}

void world_turn(struct world *world, uint32_t how) {
    for (uint32_t i = 0; i < world->vertex_count; i++) turn_vector(world->vertices[i], how);
    for (uint32_t i = 0; i < world->sphere_count; i++) turn_vector(world->spheres[i].center, how);
    for (uint32_t i = 0; i < world->ray_count; i++) {
        turn_vector(world->rays[i].origin, how);
        turn_vector(world->rays[i].direction, how);
    }
}

void world_shuffle(struct world *world, struct random *random) {
    for (uint32_t i = 0; i < world->triangle_count; i++) {
        struct world_triangle *t = &world->triangles[i];
        uint32_t by = random_below(random, 3), v[3] = {t->v[by], t->v[(by + 1) % 3], t->v[(by + 2) % 3]};
        memcpy(t->v, v, sizeof v);
    }
    for (uint32_t i = world->triangle_count; i-- > 1;) {
        struct world_triangle *a = &world->triangles[i], *b = &world->triangles[random_below(random, i + 1)], other = *a;
        if (a->mesh != b->mesh) continue;
        *a = *b;
        *b = other;
    }
}

static void bounds_of(const struct world *world, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (uint32_t i = 0; i < world->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], world->vertices[i][k]);
            high[k] = fmax(high[k], world->vertices[i][k]);
        }
    for (uint32_t i = 0; i < world->sphere_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)world->spheres[i].center[k] - world->spheres[i].radius);
            high[k] = fmax(high[k], (double)world->spheres[i].center[k] + world->spheres[i].radius);
        }
}

void world_clutter(struct world *world, struct random *random, uint32_t count) {
    double low[3], high[3], size = 0;
    bounds_of(world, low, high);
    for (int k = 0; k < 3; k++) size = fmax(size, high[k] - low[k]);
    world->mesh = world_mesh_count(world);
    for (uint32_t i = 0; i < count; i++) {
        float v[9];
        for (int k = 0; k < 3; k++) {
            double middle = random_in(random, low[k], high[k]);
            for (int corner = 0; corner < 3; corner++) v[3 * corner + k] = (float)(middle + size * random_in(random, -0.02, 0.02));
        }
        world_lone_triangle(world, v);
    }
}

void world_more_rays(struct world *world, struct random *random, uint32_t count, int ulps) {
    uint32_t base = world->ray_count;
    for (uint32_t i = 0; base > 0 && world->ray_count < count && !world->failed; i++) {
        struct gn_ray ray = world->rays[i % base];
        fuzz_ray(&ray, random, ulps, false);
        world_ray(world, ray.origin, ray.direction, ray.tmin, ray.tmax);
    }
}

// -------------------------------------------------------------------------------------------------------------- as a scene

uint32_t world_mesh_count(const struct world *world) {
    return world->triangle_count ? world->triangles[world->triangle_count - 1].mesh + 1 : 0;
}
uint32_t world_mesh_object(const struct world *world, uint32_t mesh) { return world->spheres_first ? world->sphere_count + mesh : mesh; }
uint32_t world_sphere_object(const struct world *world, uint32_t sphere) {
    return world->spheres_first ? sphere : world_mesh_count(world) + sphere;
}

static bool fill_mesh(struct scene_shape *shape, struct context *ctx, const struct world *world, uint32_t mesh) {
    uint32_t first = 0, end;
    while (world->triangles[first].mesh < mesh) first++;
    for (end = first; end < world->triangle_count && world->triangles[end].mesh == mesh;) end++;
    shape->type = SHAPE_MESH;
    if (!mesh_init(&shape->mesh, ctx, world->vertex_count, end - first, false)) return false;
    memcpy(shape->mesh.positions, world->vertices, world->vertex_count * sizeof *world->vertices);
    for (uint32_t i = first; i < end; i++)
        memcpy(shape->mesh.indices + 3 * (size_t)(i - first), world->triangles[i].v, sizeof world->triangles[i].v);
    return true;
}

static bool fill_scene(struct scene *out, struct context *ctx, const struct world *world) {
    uint32_t meshes = world_mesh_count(world), count = meshes + world->sphere_count;
    out->shapes = array_alloc(ctx, count, sizeof *out->shapes, "the shapes of a case");
    out->materials = array_alloc(ctx, 1, sizeof *out->materials, "the material of a case");
    if (!out->shapes || !out->materials) return false;
    out->shape_count = count;
    out->material_count = 1;
    for (uint32_t m = 0; m < meshes; m++)
        if (!fill_mesh(&out->shapes[world_mesh_object(world, m)], ctx, world, m)) return false;
    for (uint32_t i = 0; i < world->sphere_count; i++) {
        struct scene_shape *shape = &out->shapes[world_sphere_object(world, i)];
        shape->type = SHAPE_SPHERE;
        memcpy(shape->center, world->spheres[i].center, sizeof shape->center);
        shape->radius = world->spheres[i].radius;
    }
    return scene_derive(out, ctx);
}

bool world_scene(struct scene *out, struct context *ctx, const struct world *world) {
    *out = (struct scene){
        .camera = {.look_at = {0, 0, -1}, .up = {0, 1, 0}, .fov_y_deg = 90},
        .film = {.width = 1, .height = 1, .spp = 1},
        .shadows = true,
    };
    if (fill_scene(out, ctx, world)) return true;
    scene_finish(out);
    return false;
}

// --------------------------------------------------------------------------------------------------- a random hierarchy

#define LEAF_CHANCE 4 // a part that fits a leaf becomes one in … cases; else it is split further

struct builder {
    struct bvh *bvh;
    const struct scene *scene;
    struct random *random;
    uint32_t triangles;
};

static struct bvh_box primitive_box(const struct builder *b, uint32_t primitive) {
    struct bvh_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    if (primitive < b->triangles) {
        struct scene_triangle t = scene_triangle_at(b->scene, primitive);
        for (int i = 0; i < 9; i++) {
            box.min[i % 3] = fminf(box.min[i % 3], t.v[i / 3][i % 3]);
            box.max[i % 3] = fmaxf(box.max[i % 3], t.v[i / 3][i % 3]);
        }
        return box;
    }
    const struct scene_shape *sphere = &b->scene->shapes[scene_sphere_object(b->scene, primitive - b->triangles)];
    for (int i = 0; i < 3; i++) {
        box.min[i] = nextafterf((float)((double)sphere->center[i] - sphere->radius), -INFINITY);
        box.max[i] = nextafterf((float)((double)sphere->center[i] + sphere->radius), INFINITY);
    }
    return box;
}

static void set_box(struct builder *b, uint32_t node, uint32_t begin, uint32_t end) {
    struct bvh_node *n = &b->bvh->nodes[node];
    for (int k = 0; k < 3; k++) n->min[k] = INFINITY, n->max[k] = -INFINITY;
    for (uint32_t i = begin; i < end; i++) {
        struct bvh_box box = primitive_box(b, b->bvh->order[i]);
        for (int k = 0; k < 3; k++) n->min[k] = fminf(n->min[k], box.min[k]), n->max[k] = fmaxf(n->max[k], box.max[k]);
    }
}

// Where order[begin … end) is cut: between the kinds if both are there; 0 for a leaf. Never further from the middle than a quarter, so
// that no tree is too deep.
static uint32_t choose_cut(const struct builder *b, uint32_t begin, uint32_t end) {
    uint32_t count = end - begin;
    bool first_kind = b->bvh->order[begin] < b->triangles, last_kind = b->bvh->order[end - 1] < b->triangles;
    for (uint32_t i = begin + 1; first_kind != last_kind; i++)
        if ((b->bvh->order[i] < b->triangles) != first_kind) return i;
    if (count == 1 || (count <= BVH_MAX_LEAF && random_below(b->random, LEAF_CHANCE) == 0)) return 0;
    return begin + (count < 4 ? 1 : count / 4 + random_below(b->random, count / 2 + 1));
}

static void split(struct builder *b, uint32_t node, uint32_t begin, uint32_t end, uint32_t depth) {
    set_box(b, node, begin, end);
    uint32_t cut = choose_cut(b, begin, end);
    if (depth > b->bvh->depth) b->bvh->depth = depth;
    if (cut == 0) {
        b->bvh->nodes[node].first = begin;
        b->bvh->nodes[node].count = end - begin;
        return;
    }
    uint32_t children = b->bvh->node_count;
    b->bvh->node_count += 2;
    b->bvh->nodes[node].first = children;
    split(b, children, begin, cut, depth + 1);
    split(b, children + 1, cut, end, depth + 1);
}

bool world_random_bvh(struct bvh *out, struct context *ctx, const struct scene *scene, struct random *random) {
    uint32_t triangles = scene_triangle_count(scene), count = triangles + scene_sphere_count(scene);
    *out = (struct bvh){.primitive_count = count};
    if (count == 0) return true;
    out->nodes = array_alloc(ctx, 2 * (size_t)count, sizeof *out->nodes, "a hierarchy");
    out->order = array_alloc(ctx, count, sizeof *out->order, "a hierarchy");
    if (!out->nodes || !out->order) {
        bvh_finish(out);
        return false;
    }
    for (uint32_t i = 0; i < count; i++) out->order[i] = i;
    for (uint32_t i = count; i-- > 1;) {
        uint32_t low = i < triangles ? 0 : triangles, k = low + random_below(random, i - low + 1), other = out->order[i];
        out->order[i] = out->order[k];
        out->order[k] = other;
    }
    struct builder b = {out, scene, random, triangles};
    out->node_count = 1;
    split(&b, 0, 0, count, 0);
    return true;
}
