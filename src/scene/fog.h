// Where fog is: in a ball around the scene, since a way through a medium without end would let nothing through.
#ifndef SCENE_FOG_H
#define SCENE_FOG_H

#include "scene/scene.h"

// Its center is the middle of all shapes; they and the camera, wherever it moves, are in it.
struct fog_ball { double center[3], radius; };
struct fog_ball scene_fog_ball(const struct scene *scene);

#endif
