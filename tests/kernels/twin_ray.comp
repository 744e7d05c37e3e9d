// In: d, tmin, tmax. Out: d, tmin, tmax, exponent of the ray at a safe scale.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ray.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    ray r = ray_make(vec3(0.0), given3(5u * i), given[5u * i + 3u], given[5u * i + 4u], SELF_NONE);
    put3(6u * i, r.d);
    result[6u * i + 3u] = r.tmin;
    result[6u * i + 4u] = r.tmax;
    result[6u * i + 5u] = float(r.exponent);
}
