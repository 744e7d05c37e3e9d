// In: o, d, center, radius. Out: both t of the fast tier, then of the robust one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tier_fast.glsl"
#include "tier_robust.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 10u * i;
    vec3 o = given3(at), d = given3(at + 3u), center = given3(at + 6u);
    vec2 fast = sphere_fast(o, d, center, given[at + 9u]), robust = sphere_robust(o, d, center, given[at + 9u]);
    result[4u * i] = fast.x;
    result[4u * i + 1u] = fast.y;
    result[4u * i + 2u] = robust.x;
    result[4u * i + 3u] = robust.y;
}
