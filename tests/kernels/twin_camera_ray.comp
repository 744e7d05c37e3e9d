// In: two frames (corner, du, dv each), share; position, travel, time; lens, aim; pixel (two numbers), offset; two random numbers. Out: origin, direction, point of
// the disk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "camera.glsl"
#include "twin.glsl"

camera_frame given_frame(uint at) { return camera_frame(given3(at), given3(at + 3u), given3(at + 6u)); }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 34u * i;
    camera_frame frame = camera_frame_between(given_frame(at), given_frame(at + 9u), given[at + 18u]);
    vec3 position = camera_position(given3(at + 19u), given3(at + 22u), given[at + 25u]);
    uvec2 pixel = uvec2(uint(given[at + 28u]), uint(given[at + 29u]));
    vec3 direction = camera_direction(frame.corner, frame.du, frame.dv, pixel, vec2(given[at + 30u], given[at + 31u]));
    vec2 point = camera_disk_point(vec2(given[at + 32u], given[at + 33u]));
    put3(8u * i, camera_add(position, camera_lens_point(point, given[at + 26u], frame.du, frame.dv)));
    put3(8u * i + 3u, camera_add(direction, -camera_lens_point(point, given[at + 27u], frame.du, frame.dv)));
    result[8u * i + 6u] = point.x;
    result[8u * i + 7u] = point.y;
}
