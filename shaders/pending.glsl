// Pending samples of the exact tier: a ray that the error bounds leave undecided is written down as a question; the sample is done again when the
// second stage or the host has answered it. Layout: BINDING_PENDING in shared.h. In other tiers all of this is compiled out.
#ifndef PENDING_GLSL
#define PENDING_GLSL
#include "constants.glsl"
#include "ray.glsl"

layout(set = 0, binding = BINDING_PENDING) buffer pending_buffer {
    uint pending_count;     // records taken, also beyond the capacity
    uint pending_unused[3];
    uvec4 pending_words[];
};

struct pending_sample {
    uint record;            // where it stands in the buffer; only with RESOLVE
    uint answers;           // it has
    uint used;              // of them in this run of the sample
    bool asks;              // a ray was undecided
    uvec4 question[3];      // words 1 to 3 of the record
};

pending_sample pending_none() { return pending_sample(0u, 0u, 0u, false, uvec4[3](uvec4(0u), uvec4(0u), uvec4(0u))); }

// The sample of this invocation, when the kernel runs over the records; false if there is none.
bool pending_find(out pending_sample pending, out ivec2 at) {
    uint record = gl_GlobalInvocationID.x;
    pending = pending_none();
    at = ivec2(0);
    if (record >= min(pending_count, PENDING_CAPACITY)) return false;
    uvec4 head = pending_words[record * PENDING_WORDS];
    pending.record = record;
    pending.answers = head.z;
    at = ivec2(head.xy);
    return head.w == PENDING_ANSWERED;
}

// The answer for ray `number` of the sample, if it has been asked for. Answers come in the order of their rays.
bool pending_answer(inout pending_sample pending, uint number, out hit h) {
    h = hit_none();
    if (!RESOLVE || pending.used >= pending.answers) return false;
    uint at = pending.record * PENDING_WORDS + 4u + 2u * pending.used;
    uvec4 what = pending_words[at];
    if (what.x != number) return false;
    vec3 tuv = uintBitsToFloat(pending_words[at + 1u].xyz);
    h = hit(tuv.x, tuv.y, tuv.z, what.w, int(what.y), int(what.z));
    pending.used++;
    return true;
}

void pending_ask(inout pending_sample pending, ray r, bool any, uint number) {
    pending.asks = true;
    pending.question[0] = uvec4(floatBitsToUint(vec3(r.o)), r.self);
    pending.question[1] = uvec4(floatBitsToUint(vec3(r.d)), floatBitsToUint(float(r.tmax)));
    pending.question[2] = uvec4(2u * number + (any ? 1u : 0u), r.target_object, r.target_index, floatBitsToUint(r.time));
}

// Writes the question down, or that the sample is done. A new one that finds no place is asked again by the next dispatch. Returns whether there was a question
// and it found a place.
bool pending_store(pending_sample pending, ivec2 at) {
    uint record = pending.record;
    if (!RESOLVE) {
        if (!pending.asks) return false;
        record = atomicAdd(pending_count, 1u);
        if (record >= PENDING_CAPACITY) return false;
    }
    uint word = record * PENDING_WORDS;
    pending_words[word] = uvec4(uvec2(at), pending.answers, pending.asks ? PENDING_ASKS : PENDING_DONE);
    if (!pending.asks) return false;
    pending_words[word + 1u] = pending.question[0];
    pending_words[word + 2u] = pending.question[1];
    pending_words[word + 3u] = pending.question[2];
    return true;
}

#endif
