// Shoots rays that batches do not have: with a target, a time, a primitive that they leave. In: 12 numbers a ray (origin, tmin; direction, tmax; target's
// object and index, self, time). Out: object, primitive, t, 1 for a ray left undecided.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "traverse.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { trace_args args; };
layout(set = 0, binding = BINDING_RAYS) uniform usamplerBuffer ray_words;
layout(set = 0, binding = BINDING_HITS) writeonly buffer hit_buffer { uvec4 result[]; };

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= args.count) return;
    uvec4 w0 = texelFetch(ray_words, int(3u * number)), w1 = texelFetch(ray_words, int(3u * number + 1u)), w2 = texelFetch(ray_words, int(3u * number + 2u));
    precise vec3 o = (uintBitsToFloat(w0.xyz) - args.base.xyz) * args.base.w;
    vec3 d = uintBitsToFloat(w1.xyz) * args.base.w;
    ray r = ray_make(o, d, uintBitsToFloat(w0.w), uintBitsToFloat(w1.w), w2.z);
    r.target_object = int(w2.x);
    r.target_index = int(w2.y);
    r.time = uintBitsToFloat(w2.w);
    int steps = int(MAX_STEPS);
    search q = traverse(r, ANY_HIT, args.root, steps);
    float t = q.best.object < 0 ? INFINITY : times_power_of_two(q.best.t, -r.exponent);
    result[number] = uvec4(q.best.object, q.best.index, floatBitsToUint(t), search_undecided(q, ANY_HIT) || steps <= 0 ? 1u : 0u);
}
