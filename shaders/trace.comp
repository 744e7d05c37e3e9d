// Shoots a batch of rays: each invocation one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "constants.glsl"
#include "ray.glsl"
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
    if (undecided) h = hit_none();
    float t = h.object < 0 ? INFINITY : h.t * r.t_scale / args.scale;
    if (ANY_HIT && h.object >= 0) h.object = 0;
    store_hit(number, t, h, (valid ? 0u : HIT_INVALID) | (undecided ? HIT_UNDECIDED : 0u));
    if (undecided) atomicAdd(dispatch_status.undecided, 1u);
    if (h.object >= 0) atomicAdd(dispatch_status.hits, 1u);
    if (steps <= 0) atomicAdd(dispatch_status.stuck, 1u);
}
