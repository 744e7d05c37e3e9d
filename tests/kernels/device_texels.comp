// Copies texels, each shifted by one place to the left: from `first` the components x and y, from `second` z and w.
#version 460
layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint count; };
layout(set = 0, binding = 0) uniform usamplerBuffer first;
layout(set = 0, binding = 5) uniform usamplerBuffer second;
layout(set = 0, binding = 9) writeonly buffer output_buffer { uvec4 result[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    int from = int((i + 1u) % count);
    result[i] = uvec4(texelFetch(first, from).xy, texelFetch(second, from).zw);
}
