// In: corner, du, dv, pixel (two numbers), offset. Out: the direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "camera.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 13u * i;
    uvec2 pixel = uvec2(uint(given[at + 9u]), uint(given[at + 10u]));
    vec2 offset = vec2(given[at + 11u], given[at + 12u]);
    put3(3u * i, camera_direction(given3(at), given3(at + 3u), given3(at + 6u), pixel, offset));
}
