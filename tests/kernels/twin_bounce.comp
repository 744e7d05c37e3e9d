// In, 8 numbers a case: a point of the unit sphere, a direction, how often, the index inside. Out, 8: the point and the direction after so
// many bounces inside a ball of glass, those that went through, the largest | |d| - 1 |.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "dielectric.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 p = given3(8u * i), d = given3(8u * i + 3u);
    float lost = 0.0, off = 0.0;
    for (int k = 0; k < int(given[8u * i + 6u]); k++) {
        p = normalize_robust(p - 2.0 * dot(p, d) * d);
        vec3 wi, weight;
        bool transmitted;
        dielectric_sample(-p, -p, -d, given[8u * i + 7u], 1.0, vec3(1.0), 0.9999, wi, weight, transmitted);
        lost += transmitted ? 1.0 : 0.0;
        d = wi;
        off = max(off, abs(length(d) - 1.0));
    }
    put3(8u * i, p);
    put3(8u * i + 3u, d);
    result[8u * i + 6u] = lost;
    result[8u * i + 7u] = off;
}
