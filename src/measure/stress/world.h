// What a stress case is made of: a few shapes and rays in memory, and what can be done to them without changing the question.
//
// Triangles share vertices by index, so that a closed mesh stays closed whatever happens to its vertices. A failed allocation is
// remembered in the world and reported by world_ok; until then adding to it does nothing.
#ifndef MEASURE_STRESS_WORLD_H
#define MEASURE_STRESS_WORLD_H

#include "bvh/bvh.h"
#include "measure/stress/random.h"
#include "scene/scene.h"

struct world_triangle {
    uint32_t v[3], mesh;
}; // numbers of vertices; mesh 0, 1, … never decreases along the array

struct world_sphere {
    float center[3], radius;
};

// Zeroed is empty; world_finish accepts anything.
struct world {
    float (*vertices)[3];
    struct world_triangle *triangles;
    struct world_sphere *spheres;
    struct gn_ray *rays;
    uint32_t vertex_count, triangle_count, sphere_count, ray_count;
    uint32_t vertex_room, triangle_room, sphere_room, ray_room;
    uint32_t mesh;      // that new triangles belong to
    bool spheres_first; // objects: spheres, then meshes [meshes, then spheres]
    bool failed;
};

void world_finish(struct world *world);

// Each appends one. world_vertex returns its number.
uint32_t world_vertex(struct world *world, double x, double y, double z);
void world_triangle(struct world *world, uint32_t a, uint32_t b, uint32_t c);
void world_sphere(struct world *world, const float center[3], float radius);
void world_ray(struct world *world, const float origin[3], const float direction[3], float tmin, float tmax);

// A triangle with vertices of its own: 9 numbers.
void world_lone_triangle(struct world *world, const float v[9]);

// A ray in (0, +inf) from o towards the point p: d = p - o, each component rounded once.
void world_aim(struct world *world, const float origin[3], const double p[3]);

// GN_LIMIT if something could not be added.
bool world_ok(const struct world *world, struct context *ctx);

bool world_copy(struct world *out, struct context *ctx, const struct world *from);

// --------------------------------------------------------------------------------------- what leaves the question the same

// Every number of shapes and rays moved by up to `ulps`; a zero may become one of the smallest denormals.
void world_fuzz(struct world *world, struct random *random, int ulps);

// Shapes and origins times 2^k, so that every t is 2^k times what it was. False, and nothing done, where a number would leave the
// normal range.
bool world_scale(struct world *world, int k);

// Axes permuted and flipped: `how` 0 … 47.
void world_turn(struct world *world, uint32_t how);

// The vertices of each triangle rotated, the triangles of each mesh shuffled.
void world_shuffle(struct world *world, struct random *random);

// A mesh of `count` small triangles scattered through the bounds, as an object of its own.
void world_clutter(struct world *world, struct random *random, uint32_t count);

// Rays appended until there are `count`: copies of those there are, moved by up to `ulps`; zeros stay.
void world_more_rays(struct world *world, struct random *random, uint32_t count, int ulps);

// ------------------------------------------------------------------------------------------------------------ as a scene

// A scene of the world's shapes, with one material and no light.
bool world_scene(struct scene *out, struct context *ctx, const struct world *world);

// A hierarchy with nothing to say for it but that it is one: random halves of random order, leaves of random size.
bool world_random_bvh(struct bvh *out, struct context *ctx, const struct scene *scene, struct random *random);

// The objects' numbers: of mesh m, of sphere s.
uint32_t world_mesh_object(const struct world *world, uint32_t mesh);
uint32_t world_sphere_object(const struct world *world, uint32_t sphere);
uint32_t world_mesh_count(const struct world *world);

#endif
