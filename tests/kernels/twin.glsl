// What every kernel of a twin test shares: numbers in, numbers out, one invocation a case.
#ifndef TWIN_GLSL
#define TWIN_GLSL

layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint count; };
layout(set = 0, binding = 0) readonly buffer input_buffer { float given[]; };
layout(set = 0, binding = 1) writeonly buffer output_buffer { float result[]; };

vec3 given3(uint at) { return vec3(given[at], given[at + 1u], given[at + 2u]); }

void put3(uint at, vec3 v) {
    result[at] = v.x;
    result[at + 1u] = v.y;
    result[at + 2u] = v.z;
}

#endif
