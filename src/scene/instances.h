// What is drawn by way of a hierarchy of its own: instances, and meshes, triangles and rectangles that move.
//
// The mesh that an instance draws is a part: it is kept once, in its own coordinates, however often it is drawn. In scene coordinates a vertex is what
// scene_place says, a fixed sequence of fp32 operations: that, and nothing else, is where it is, on every device and in the reference.
#ifndef SCENE_INSTANCES_H
#define SCENE_INSTANCES_H

#include "scene/scene.h"

// Where a vertex of a shape's mesh, or the center of a sphere, is at a time in [0, 1]. Of an instance v is in the prototype's coordinates.
void scene_place(float out[3], const struct scene_shape *shape, const float v[3], float time);

// A normal of a shape's mesh in scene coordinates, up to a positive factor that all its normals share: by the inverse transpose, which keeps it on its side of the surface.
void scene_place_normal(double n[3], const struct scene_shape *shape);

// The inverse of the 3 × 3 part of a placement, row-major, each entry right to 2^-33 of itself; false, and zeros, where the placement is singular, or so nearly that
// entries are not so right: where the largest row sum of absolute values times that of the inverse is above PLACEMENT_CONDITION.
bool placement_inverse(double inverse[9], const float placement[12]);
#define PLACEMENT_CONDITION 65536.0

// Draws what needs no hierarchy of its own as a mesh of the scene: a prototype that one shape draws, which does not move; and what a hierarchy cannot serve well, a
// nearly singular placement, vertices that take denormal numbers on the way to their place (which some devices take for 0). Lists the others in scene->instances
// and scene->parts. GN_SCENE where a vertex leaves the range of fp32, GN_LIMIT.
bool scene_list_instances(struct scene *scene, struct context *ctx);

#endif
