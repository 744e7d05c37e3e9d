// In: diffuse, specular, shininess, n, l, v. Out: what a light of unit intensity adds.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "phong.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 16u * i;
    phong_material m = phong_material(vec3(0.0), given3(at), given3(at + 3u), given[at + 6u]);
    put3(3u * i, phong_reflect(m, given3(at + 7u), given3(at + 10u), given3(at + 13u), true, true));
}
