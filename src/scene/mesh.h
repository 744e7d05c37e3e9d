// What one does with a mesh whatever file it came from.
#ifndef SCENE_MESH_H
#define SCENE_MESH_H

#include "scene/scene.h"

// Triangles, and spheres, of a whole scene: what a reference in a BVH node can number.
#define MOST_PRIMITIVES ((1u << 26) - 1)

// Triangles of all instances together: with the others they are numbered in 31 bits.
#define MOST_INSTANCED (1u << 30)

void mesh_finish(struct scene_mesh *mesh);

// Makes room for counts of vertices and triangles; zeroed. GN_LIMIT when there are too many, or no memory.
bool mesh_init(struct scene_mesh *out, struct context *ctx, uint64_t vertices, uint64_t triangles, bool normals);

// Gives the mesh texture coordinates, zeroed.
bool mesh_add_uvs(struct scene_mesh *mesh, struct context *ctx);

// Whether a mesh may have so many triangles; else GN_LIMIT with the file's name.
bool mesh_count_allowed(struct context *ctx, const char *path, uint64_t triangles);

// An affine transform in fp64: point p becomes m·(p, 1), row-major, the last row 0 0 0 1.
struct transform {
    double m[4][4];
};

extern const struct transform transform_identity;
struct transform transform_product(const struct transform *a, const struct transform *b);

// Transforms vertices [first, first + count) in fp64 and rounds each coordinate once; normals go by the inverse transpose (up to a positive
// factor; a mirror image keeps them on the same side of the surface). Returns false, and *bad, when a vertex leaves the range of fp32.
bool mesh_transform(struct scene_mesh *mesh, const struct transform *transform, uint32_t first, uint32_t count, uint32_t *bad);

// How far the 3×3 part is from singular: Frobenius norm times that of its inverse; 3 for rotations, +inf for singular or not finite.
double transform_condition(const struct transform *transform);

// A change in the last digit of an fp32 number makes such a transform singular: 1 / FLT_EPSILON.
#define WORST_CONDITION 8388608.0

// Computes vertex normals: each the mean of the faces around a vertex, weighted by the angle of each face there. Faces that meet at an
// edge by more than crease_deg, or only at a vertex, are not averaged. Equal positions count as one vertex; the vertices are numbered anew.
// Where texture coordinates differ around such a vertex, there are several with the same normal.
bool mesh_smooth(struct scene_mesh *mesh, struct context *ctx, double crease_deg);

// The crease angle where nothing else is asked for.
#define CREASE_DEG 60.0

#endif
