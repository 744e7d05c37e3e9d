// In: o, d, v0, v1, v2. Out: t, u, v of the fast tier, then of the robust one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tier_fast.glsl"
#include "tier_robust.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 15u * i;
    vec3 o = given3(at), d = given3(at + 3u), v0 = given3(at + 6u), v1 = given3(at + 9u), v2 = given3(at + 12u);
    put3(6u * i, triangle_fast(o, d, v0, v1, v2));
    put3(6u * i + 3u, triangle_robust(o, shear_make(d), v0, v1, v2));
}
