// What textures and normal maps say, in fp64.
#ifndef REFERENCE_TEXTURE_H
#define REFERENCE_TEXTURE_H

#include "scene/scene.h"

// Red, green, blue and alpha at texture coordinates uv, linear. `srgb`: the first three are sRGB codes. Coordinates within 2^-23 of the
// picture from a texel's center are there; NaN and infinity count as 0.
void texture_at(double rgba[4], const struct scene_texture *texture, bool srgb, const double uv[2]);

// (u', v') = transform · (u, v, 1).
void map_transform(double out[2], const struct scene_map *map, const double uv[2]);

// Where a sphere's picture has the point with unit normal n: longitude, from -z around to -z again, and colatitude, from +y, as shares of a
// turn and of half a turn. At the poles u is 1/2.
void sphere_uv(double uv[2], const double n[3]);

// A triangle's edges from its first vertex, and what the texture coordinates change along them.
struct tangent_frame {
    double e1[3], e2[3], duv1[2], duv2[2];
};
struct tangent_frame sphere_tangents(const double n[3]);

// The unit normal n (of the front) becomes what a normal map's texel, 0 to 1 linear, makes of it; `scale` multiplies its x and y.
void normal_map_apply(double n[3], const struct tangent_frame *frame, const double texel[3], double scale);

#endif
