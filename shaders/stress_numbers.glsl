// One function of the shaders at a time, for the stress cases. Included by stress_numbers.comp and, with FP64 defined, by
// stress_numbers_fp64.comp.
#ifndef STRESS_NUMBERS_GLSL
#define STRESS_NUMBERS_GLSL
#include "camera.glsl"
#include "constants.glsl"
#include "light_point.glsl"
#include "phong.glsl"
#include "sampler.glsl"
#include "stress.glsl"
#include "tier_exact.glsl"
#include "tier_fast.glsl"
#include "tier_robust.glsl"

real3 told(verdict c) { return real3(c.lo, c.hi, c.lo > c.hi ? -1.0 : c.certain ? 1.0 : 0.0); }

// In: STRESS_NUMBERS_IN numbers, of which each function takes the first few. Out: 3 numbers.
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.count) return;
    uint at = STRESS_NUMBERS_IN * i;
    real3 answer = real3(0.0);
    if (args.what == STRESS_POWER) {
        answer.x = power(given1(at), given1(at + 1u));
    } else if (args.what == STRESS_LIGHT) {
        answer = light_arriving(given3(at), given1(at + 3u), given1(at + 4u));
    } else if (args.what == STRESS_NORMALIZE) {
        answer = TIER == TIER_FAST ? normalize_fast(given3(at)) : normalize_robust(given3(at));
    } else if (args.what == STRESS_PHONG) {
        phong_material m = phong_material(real3(0.0), given3(at), given3(at + 3u), given1(at + 6u));
        answer = phong_reflect(m, given3(at + 7u), given3(at + 10u), given3(at + 13u), true, true);
    } else if (args.what == STRESS_CAMERA) {
        uvec2 pixel = uvec2(uint(given[at + 9u]), uint(given[at + 10u]));
        vec3 corner = vec3(given3(at)), du = vec3(given3(at + 3u)), dv = vec3(given3(at + 6u));
        answer = real3(camera_direction(corner, du, dv, pixel, vec2(given[at + 11u], given[at + 12u])));
    } else if (args.what == STRESS_UNIT_INTERVAL) {
        answer.xy = real2(unit_interval(floatBitsToUint(vec2(given[at], given[at + 1u]))));
    } else if (args.what == STRESS_DISK) {
        answer.xy = real2(camera_disk_point(vec2(given[at], given[at + 1u])));
    } else if (args.what == STRESS_LENS) {
        vec2 point = camera_disk_point(vec2(given[at + 10u], given[at + 11u]));
        answer = real3(camera_add(vec3(given3(at)), -camera_lens_point(point, given[at + 9u], vec3(given3(at + 3u)), vec3(given3(at + 6u)))));
    } else if (args.what == STRESS_TRIANGLE) {
        ray r = ray_make(given3(at), given3(at + 3u), 0.0, INFINITY, SELF_NONE);
        answer = told(triangle_exact(r.o, shear_make(r.d), given3(at + 6u), given3(at + 9u), given3(at + 12u)));
    } else if (args.what == STRESS_SPHERE) {
        ray r = ray_make(given3(at), given3(at + 3u), 0.0, INFINITY, SELF_NONE);
        answer = told(sphere_exact(r.o, r.d, given3(at + 6u), given1(at + 9u), given1(at + 10u)));
    }
    put3(3u * i, answer);
}

#endif
