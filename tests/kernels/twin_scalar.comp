// In: x, y. Out: power(x, y), what arrives of a light of intensity 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_point.glsl"
#include "power.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    result[2u * i] = power(given[2u * i], given[2u * i + 1u]);
    result[2u * i + 1u] = light_arriving(vec3(1.0), given[2u * i], given[2u * i + 1u]).x;
}
