// The hierarchies of a scene: one over its triangles, by number through the scene, its spheres, and its instances; and one over each part that instances draw,
// in the part's own coordinates.
#ifndef BVH_SCENE_BOXES_H
#define BVH_SCENE_BOXES_H

#include "bvh/bvh.h"
#include "scene/scene.h"

// Builds the hierarchies of a scene: primitive i < scene_triangle_count is triangle i; then come the spheres, whose boxes are rounded
// outward (docs/right-answer.md's exact sphere lies inside), then the instances, each in a leaf for itself. Boxes of what moves hold it at all times.
// In out->parts are those of the parts; primitive i of a part is triangle i of its mesh.
bool bvh_build_scene(struct bvh *out, struct context *ctx, const struct scene *scene);

#endif
