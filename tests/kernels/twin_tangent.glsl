// In: a unit vector n, edges e1, e2, changes duv1, duv2, a texel, a scale. Out: map_normal and map_sphere_normal of them, sphere_uv of n,
// and map_uv of duv1 with e1 and e2 as rows.
#ifndef TWIN_TANGENT_GLSL
#define TWIN_TANGENT_GLSL
#include "cases.glsl"
#include "normal_map.glsl"
#include "texture.glsl"

real given_at(uint at) { return number_of(given[at]); }
real3 given3(uint at) { return real3(given_at(at), given_at(at + 1u), given_at(at + 2u)); }
real2 given2(uint at) { return real2(given_at(at), given_at(at + 1u)); }

void main() {
    uint number = gl_GlobalInvocationID.x, from = 17u * number, to = 10u * number;
    if (number >= case_count) return;
    real3 n = given3(from), e1 = given3(from + 3u), e2 = given3(from + 6u), texel = given3(from + 13u);
    real2 duv1 = given2(from + 9u), duv2 = given2(from + 11u);
    real scale = given_at(from + 16u);
    real3 mapped = map_normal(n, e1, e2, duv1, duv2, texel, scale), on_sphere = map_sphere_normal(n, texel, scale);
    real2 uv = sphere_uv(n), transformed = map_uv(vec3(e1), vec3(e2), duv1);
    for (uint k = 0u; k < 3u; k++) {
        results[to + k] = word_of(mapped[k]);
        results[to + 3u + k] = word_of(on_sphere[k]);
    }
    for (uint k = 0u; k < 2u; k++) {
        results[to + 6u + k] = word_of(uv[k]);
        results[to + 8u + k] = word_of(transformed[k]);
    }
}

#endif
