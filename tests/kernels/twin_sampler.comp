// In: seed, pixel x, y, sample, pair as bits. Out: two words of random bits, and both as numbers; two independent words.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "sampler.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 5u * i;
    uvec2 pixel = uvec2(floatBitsToUint(given[at + 1u]), floatBitsToUint(given[at + 2u]));
    uvec2 bits = sample_bits(floatBitsToUint(given[at]), pixel, floatBitsToUint(given[at + 3u]), floatBitsToUint(given[at + 4u]));
    uvec2 other = independent_bits(floatBitsToUint(given[at]), pixel, floatBitsToUint(given[at + 3u]), floatBitsToUint(given[at + 4u]));
    vec2 numbers = unit_interval(bits);
    result[6u * i] = uintBitsToFloat(bits.x);
    result[6u * i + 1u] = uintBitsToFloat(bits.y);
    result[6u * i + 2u] = numbers.x;
    result[6u * i + 3u] = numbers.y;
    result[6u * i + 4u] = uintBitsToFloat(other.x);
    result[6u * i + 5u] = uintBitsToFloat(other.y);
}
