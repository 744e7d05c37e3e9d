// In: box min, box max, o, d, tmin, tmax. Out: where the ray enters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 14u * i;
    result[i] = box_enter(given3(at), given3(at + 3u), slabs_make(given3(at + 6u), given3(at + 9u)), given[at + 12u], given[at + 13u]);
}
