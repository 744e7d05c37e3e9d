// In: a number. Out: SCALE times it, negated where NEGATE is set.
#version 460
layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint count; };
layout(set = 0, binding = 0) readonly buffer input_buffer { uint given[]; };
layout(set = 0, binding = 1) writeonly buffer output_buffer { uint result[]; };
layout(constant_id = 7) const uint SCALE = 1;
layout(constant_id = 63) const bool NEGATE = false;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    result[i] = NEGATE ? -(SCALE * given[i]) : SCALE * given[i];
}
