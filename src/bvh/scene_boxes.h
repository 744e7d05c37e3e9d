// The boxes of a scene's primitives: triangles by number through the scene, then spheres by number.
#ifndef BVH_SCENE_BOXES_H
#define BVH_SCENE_BOXES_H

#include "bvh/bvh.h"
#include "scene/scene.h"

// Builds the hierarchy of a scene: primitive i < scene_triangle_count is triangle i, the others are spheres, whose boxes are rounded
// outward (docs/right-answer.md's exact sphere lies inside).
bool bvh_build_scene(struct bvh *out, struct context *ctx, const struct scene *scene);

#endif
