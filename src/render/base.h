// The point that device coordinates are measured from.
#ifndef RENDER_BASE_H
#define RENDER_BASE_H

#include "scene/scene.h"

// Where the geometry is, on each axis that is far from the origin compared with its size; 0 on the others. Differences of all coordinates of the scene from it are
// fp32 numbers, and those of `eye` (or NULL: none).
void scene_base(float base[3], const struct scene *scene, const float *eye);

#endif
