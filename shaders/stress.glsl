// What the kernels of the stress cases share: numbers in, numbers out, one invocation a case.
#ifndef STRESS_GLSL
#define STRESS_GLSL
#include "real.glsl"
#include "shared.h"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { stress_args args; };
layout(set = 0, binding = BINDING_RAYS) readonly buffer given_buffer { float given[]; };
layout(set = 0, binding = BINDING_HITS) buffer result_buffer { float result[]; };

real given1(uint at) { return real(given[at]); }
real3 given3(uint at) { return real3(given[at], given[at + 1u], given[at + 2u]); }

void put3(uint at, real3 v) {
    result[at] = float(v.x);
    result[at + 1u] = float(v.y);
    result[at + 2u] = float(v.z);
}

#endif
