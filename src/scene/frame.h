// A camera and lights for a scene that has none.
#ifndef SCENE_FRAME_H
#define SCENE_FRAME_H

#include "scene/scene.h"

// A sphere around all shapes.
struct scene_ball {
    double center[3], radius;
};
struct scene_ball scene_ball(const struct scene *scene);

// A three-quarter view from slightly above, the whole ball in the picture. up_axis: 1 for y, 2 for z. GN_SCENE when that is beyond fp32.
bool frame_camera(struct scene_camera *camera, struct context *ctx, const struct scene_ball *ball, int up_axis);

// A camera that stands still, with a pinhole, from vectors of any length; false when it is not within fp32, or looks along `up`.
bool frame_view(struct scene_camera *camera, const double position[3], const double view[3], const double up[3], double fov_y_deg);

// Where lights stand for a camera: a key light up-left of it and a weak fill light to its right.
void frame_lights(struct scene_light lights[2], const struct scene_camera *camera, const struct scene_ball *ball);

// Scales the lights of a model file, whose units differ from file to file, so that all together they shine with 1 on the ball's center.
void frame_exposure(struct scene_light *lights, uint32_t count, const struct scene_ball *ball);

#endif
