// In: p, error, n. Out: the start of a ray that leaves p, robust tier.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tier_robust.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    put3(3u * i, leave_robust(given3(9u * i), given3(9u * i + 3u), given3(9u * i + 6u)));
}
