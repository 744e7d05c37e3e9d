// In: a vector. Out: it normalised by the fast tier, then by the robust one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tier_fast.glsl"
#include "tier_robust.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    put3(6u * i, normalize_fast(given3(3u * i)));
    put3(6u * i + 3u, normalize_robust(given3(3u * i)));
}
