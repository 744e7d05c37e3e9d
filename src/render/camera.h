// The camera as the few fp32 numbers that define every camera ray, computed in fp64 on the host and rounded once.
//
// The direction through film position (x + a, y + b), pixel (0,0) top left, is, for each of its three components, in fp32,
// in this order, every operation rounded to nearest (no contraction, no reassociation):
//     d = ((corner + x·du) + y·dv) + (a·du + b·dv)        x, y the integer pixel converted to fp32
// and the origin is `position`. The direction is not normalised. du points right by one pixel, dv down by one pixel, corner is
// the direction to the top left corner of pixel (0,0) on a plane at distance 1. Pixels are square.
#ifndef RENDER_CAMERA_H
#define RENDER_CAMERA_H

#include "scene/scene.h"

struct camera_rays { float position[3], corner[3], du[3], dv[3]; };

// For a film of width × height pixels. fov_y covers the height. Where up is parallel to the view, another up is chosen.
struct camera_rays camera_rays_make(const struct scene_camera *camera, uint32_t width, uint32_t height);

// The ray through film position (x + offset[0], y + offset[1]), as said above, for t from 0 to infinity.
struct gn_ray camera_ray(const struct camera_rays *camera, uint32_t x, uint32_t y, const float offset[2]);

#endif
