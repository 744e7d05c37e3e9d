// In: a value, how often. Out: the compensated sum.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "film.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    film_pixel pixel = film_pixel(vec3(0.0), vec3(0.0), 0u, 0u, vec4(0.0), ivec4(0));
    uint times = uint(given[2u * i + 1u]);
    for (uint k = 0u; k < min(times, 60000u); k++) film_add(pixel, film_sample(vec3(given[2u * i]), vec3(0.0), 0.0, -1, -1));
    put3(4u * i, pixel.sum);
    result[4u * i + 3u] = float(pixel.nonfinite);
}
