// Shoots a batch of rays: each invocation one. Included by trace.comp and, with FP64 defined, by trace_fp64.comp, which also brings the exact tier's t, u and v
// to within 1 ulp; without it the host does that.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "shared.h"
#include "constants.glsl"
#include "ray.glsl"
#ifdef FP64
#include "refine_fp64.glsl"
#endif
#include "traverse.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { trace_args args; };
layout(set = 0, binding = BINDING_RAYS) uniform usamplerBuffer ray_words;
layout(set = 0, binding = BINDING_HITS) writeonly buffer hit_buffer { uint hit_words[]; };
layout(set = 0, binding = BINDING_STATUS) buffer status_buffer { status dispatch_status; };

void store_hit(uint number, float t, hit h, uint flags) {
    uint at = 6u * number;
    hit_words[at] = floatBitsToUint(t);
    hit_words[at + 1u] = floatBitsToUint(h.u);
    hit_words[at + 2u] = floatBitsToUint(h.v);
    hit_words[at + 3u] = uint(h.object);
    hit_words[at + 4u] = uint(h.index);
    hit_words[at + 5u] = flags;
}

bool is_valid(vec3 o, vec3 d, float tmin, float tmax) {
    return is_finite(o) && is_finite(d) && (d.x != 0.0 || d.y != 0.0 || d.z != 0.0) && !is_nan(tmin) && !is_nan(tmax);
}

// Brings the hit's numbers to within 1 ulp; false if that takes more than fp64.
bool refine(ray r, inout hit h) {
#ifdef FP64
    vec3 tuv = vec3(h.t, h.u, h.v);
    bool on_sphere = HAS_SPHERES && (!HAS_TRIANGLES || (h.primitive & SELF_SPHERE) != 0u), fine;
    if (on_sphere) {
        uvec4 w0 = sphere_word(SPHERE_WORDS * (h.primitive & ~SELF_SPHERE));
        vec3 center = uintBitsToFloat(w0.xyz);
        fine = refine_sphere(r.o, r.d, center, uintBitsToFloat(w0.w), h.t * dot(r.d, r.d) > dot(center - r.o, r.d), tuv);
    } else {
        uint at = TRIANGLE_WORDS * h.primitive;
        vec3 v0 = uintBitsToFloat(triangle_word(at).xyz), v1 = uintBitsToFloat(triangle_word(at + 1u).xyz);
        fine = refine_triangle(r.o, r.d, v0, v1, uintBitsToFloat(triangle_word(at + 2u).xyz), tuv);
    }
    h.t = tuv.x;
    h.u = tuv.y;
    h.v = tuv.z;
    return fine;
#else
    return false;
#endif
}

void main() {
    uint number = args.first + gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= args.count) return;
    uvec4 w0 = texelFetch(ray_words, int(2u * number));
    uvec4 w1 = texelFetch(ray_words, int(2u * number + 1u));
    vec3 o = uintBitsToFloat(w0.xyz), d = uintBitsToFloat(w1.xyz);
    float tmin = uintBitsToFloat(w0.w), tmax = uintBitsToFloat(w1.w);
    bool valid = is_valid(o, d, tmin, tmax);
    bool empty = !(tmin < tmax);

    int steps = int(MAX_STEPS);
    ray r = ray_make(o * args.scale, valid ? d : vec3(1.0), tmin * args.scale, tmax * args.scale, SELF_NONE);
    search q = traverse(r, ANY_HIT, valid && !empty ? args.root : REF_NONE, steps);
    // An origin that lost bits on its way to device units is not the ray that was given.
    bool lossy = TIER == TIER_EXACT && valid && !empty && (o * args.scale) / args.scale != o;
    bool undecided = lossy || search_undecided(q, ANY_HIT);
    hit h = q.best;
    if (TIER == TIER_EXACT && !ANY_HIT && !undecided && h.object >= 0) undecided = !refine(r, h);
    if (undecided) h = hit_none();
    float t = h.object < 0 ? INFINITY : h.t * r.t_scale / args.scale;
    if (ANY_HIT && h.object >= 0) h.object = 0;
    store_hit(number, t, h, (valid ? 0u : HIT_INVALID) | (undecided ? HIT_UNDECIDED : 0u));
    if (undecided) atomicAdd(dispatch_status.undecided, 1u);
    if (h.object >= 0) atomicAdd(dispatch_status.hits, 1u);
    if (steps <= 0) atomicAdd(dispatch_status.stuck, 1u);
}

#endif
