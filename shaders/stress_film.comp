// Samples added to a pixel, for the stress cases: goes on from the sums it finds.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "film.glsl"
#include "stress.glsl"

// In: a value, and how often it is added. In and out: sum, residue, samples, those that were dropped. The counts are whole numbers as
// bits.
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.count) return;
    uint at = 4u * i, times = floatBitsToUint(given[2u * i + 1u]);
    film_pixel pixel = film_pixel(vec3(result[at]), vec3(result[at + 1u]), floatBitsToUint(result[at + 2u]), floatBitsToUint(result[at + 3u]),
                                  vec4(0.0), ivec4(0));
    film_sample s = film_sample(vec3(given[2u * i]), vec3(0.0), 0.0, -1, -1);
    for (uint k = 0u; k < min(times, MAX_STEPS / 2u); k++) film_add(pixel, s);
    result[at] = pixel.sum.x;
    result[at + 1u] = pixel.residue.x;
    result[at + 2u] = uintBitsToFloat(pixel.done);
    result[at + 3u] = uintBitsToFloat(pixel.nonfinite);
}
