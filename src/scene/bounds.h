// The box of a scene.
#ifndef SCENE_BOUNDS_H
#define SCENE_BOUNDS_H

#include "scene/scene.h"

// Fills bounds_min and bounds_max: exact for vertices, rounded outward for spheres; what reaches beyond the range of fp32 is cut to
// ±FLT_MAX. min = +FLT_MAX and max = -FLT_MAX when there are no shapes.
void scene_bounds(struct scene *scene);

#endif
