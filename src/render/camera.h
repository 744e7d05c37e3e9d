// The camera as the few fp32 numbers that define every camera ray, computed in fp64 on the host and rounded once.
//
// A sample has a film position (x + a, y + b), pixel (0,0) top left; a point (c, e) of the unit disk; and a time 0 ≤ τ < 1 between the shutter's opening and
// closing. For each of the three components of its ray, in fp32, in this order, every operation rounded to nearest (no contraction, no reassociation):
//     corner, du, dv = A + f·(B - A)                      A and B the frames k and k + 1, k the whole part of τ·CAMERA_FRAMES and f the rest, both exact
//     d = ((corner + x·du) + y·dv) + (a·du + b·dv)        x, y the integer pixel converted to fp32
//     direction = d - ((c·aim)·du + (e·aim)·dv)
//     origin = (position + τ·travel) + ((c·lens)·du + (e·lens)·dv)
// The direction is not normalised; in its units the plane of focus, on which the rays of one film position meet, is at t = focus_distance. du points right by one
// pixel, dv down by one pixel, corner is the direction to the top left corner of pixel (0,0) on a plane at distance 1. Pixels are square. Of a pinhole lens and
// aim are 0, of a camera that stands still travel is 0 and all frames are the same: both then fall out of the sums.
#ifndef RENDER_CAMERA_H
#define RENDER_CAMERA_H

#include "scene/scene.h"
#include "shaders/shared.h"

struct camera_frame { float corner[3], du[3], dv[3]; };

struct camera_rays {
    float base[3];          // scene units: origins are relative to it
    float position[3];      // when the shutter opens
    float travel[3];        // where it is when the shutter closes, minus position
    float lens;             // its radius over the length of du
    float aim;              // the same over the distance of focus, too
    struct camera_frame frames[CAMERA_FRAMES + 1]; // at equal intervals from the shutter's opening to its closing
};

// For a film of width × height pixels; base is 0. fov_y covers the height. Where up is parallel to the view, another up is chosen; where a moving camera is for a
// moment at what it looks at, the view is what it was before.
void camera_rays_make(struct camera_rays *out, const struct scene_camera *camera, uint32_t width, uint32_t height);

// Measures positions from `base` (0 before), from which the camera's position must differ by an fp32 number.
void camera_rays_rebase(struct camera_rays *camera, const float base[3]);

// What is drawn for a sample. Zeroed but for the offset: through the middle of the lens when the shutter opens.
struct camera_sample {
    float offset[2];        // a, b
    float lens[2];          // c, e
    float time;             // τ, a multiple of 2^-24
};

// The ray of a sample in pixel (x, y), as said above, for t from 0 to infinity.
struct gn_ray camera_ray(const struct camera_rays *camera, uint32_t x, uint32_t y, const struct camera_sample *sample);

// From two random numbers, multiples of 2^-24 in [0, 1), to a point of the unit disk, evenly: P. Shirley and K. Chiu, "A Low Distortion Map Between Disk and Square",
// 1997. A fixed sequence of fp32 operations, too, and within 3e-7 of the map.
void camera_disk_point(float point[2], const float u[2]);

#endif
