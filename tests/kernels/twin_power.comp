// In: x, y. Out: power(x, y), as the knob says.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "power.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    result[i] = power(given[2u * i], given[2u * i + 1u]);
}
