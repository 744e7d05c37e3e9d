// In: x, y. Out: power(x, y), light_falloff(x, y).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "phong.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    result[2u * i] = power(given[2u * i], given[2u * i + 1u]);
    result[2u * i + 1u] = light_falloff(given[2u * i], given[2u * i + 1u]);
}
