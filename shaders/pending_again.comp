// The exact tier's second stage for pending samples: the rays that they ask for, in fp64. What it decides it answers; the rest is the host's.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "pending.glsl"
#include "traverse.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { trace_args args; };
layout(set = 0, binding = BINDING_STATUS) buffer status_buffer { status dispatch_status; };

ray asked_ray(uint word) {
    uvec4 w1 = pending_words[word + 1u], w2 = pending_words[word + 2u], w3 = pending_words[word + 3u];
    ray r = ray_make(dvec3(uintBitsToFloat(w1.xyz)), dvec3(uintBitsToFloat(w2.xyz)), 0.0, double(uintBitsToFloat(w2.w)), w1.w);
    r.target_object = int(w3.y);
    r.target_index = int(w3.z);
    r.time = uintBitsToFloat(w3.w);
    return r;
}

void answer(uint word, uvec4 head, uint number, hit h) {
    uint at = word + 4u + 2u * head.z;
    pending_words[at] = uvec4(number, uint(h.object), uint(h.index), h.primitive);
    pending_words[at + 1u] = uvec4(floatBitsToUint(vec3(h.t, h.u, h.v)), 0u);
    pending_words[word] = uvec4(head.xy, head.z + 1u, PENDING_ANSWERED);
}

void main() {
    uint record = gl_GlobalInvocationID.x, word = record * PENDING_WORDS;
    if (record >= min(pending_count, PENDING_CAPACITY)) return;
    uvec4 head = pending_words[word];
    uint question = pending_words[word + 3u].x;
    if (head.w != PENDING_ASKS || head.z >= PENDING_ANSWERS) return;
    bool any = (question & 1u) != 0u;
    int steps = int(MAX_STEPS);
    search q = traverse(asked_ray(word), any, args.root, steps);
    if (steps <= 0 || search_undecided(q, any)) return;
    answer(word, head, question >> 1, q.best);
    atomicAdd(dispatch_status.decided, 1u);
}
