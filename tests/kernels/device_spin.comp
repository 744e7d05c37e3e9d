// Computes for long: 60000 steps for each invocation, some 10 ms for each workgroup on one core.
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer output_buffer { uint result[]; };

void main() {
    uint value = gl_GlobalInvocationID.x;
    for (uint i = 0u; i < 60000u; i++) {
        value = value * 1664525u + 1013904223u + (value >> 7);
        value ^= value << 13;
        value ^= value >> 17;
        value ^= value << 5;
        value = value * 1103515245u + 12345u;
        value ^= value >> 11;
        value = value * 69069u + 1u;
        value ^= value << 7;
    }
    result[gl_LocalInvocationID.x] = value;
}
