// Adds its place to every pixel: x, y, width and 1 to the first image, x and -y to the second.
#version 460
layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint width, height; };
layout(set = 0, binding = 0, rgba32f) uniform image2D color;
layout(set = 0, binding = 1, rg32i) uniform iimage2D id;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= width * height) return;
    ivec2 at = ivec2(i % width, i / width);
    imageStore(color, at, imageLoad(color, at) + vec4(at, width, 1.0));
    imageStore(id, at, imageLoad(id, at) + ivec4(at.x, -at.y, 0, 0));
}
