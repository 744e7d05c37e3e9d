// The environment: light from behind everything, from a picture in equirectangular projection. Reads SKY and SKY_ROWS of shared.h;
// scene/sky.h says how it is sampled.
//
// Directions may have any length but 0. A random number decides by fp32 comparisons with fp32 tables alone, in fp64, too, so that every
// precision picks the same texel.
#ifndef ENVIRONMENT_GLSL
#define ENVIRONMENT_GLSL
#include "math.glsl"
#include "taps.glsl"

layout(set = 0, binding = BINDING_SKY) uniform usamplerBuffer sky_words;
layout(set = 0, binding = BINDING_SKY_ROWS) uniform usamplerBuffer sky_row_words;

struct sky_header {
    uint width, height;
    real turns;
};

sky_header sky_size() {
    uvec4 word = texelFetch(sky_row_words, 0);
    return sky_header(word.x, word.y, real(uintBitsToFloat(word.z)));
}

// Where the picture has a direction; u is not yet wrapped.
real2 sky_uv(sky_header sky, real3 way) {
    real around = 0.5 + atan2_turns(way.x, -way.z) + sky.turns;
    return real2(around, 2.0 * atan2_turns(sqrt(way.x * way.x + way.z * way.z), way.y));
}

real3 sky_texel(sky_header sky, uint column, uint row) {
    return real3(uintBitsToFloat(texelFetch(sky_words, int(row * sky.width + column)).xyz));
}

// Radiance from a direction: bilinear, around the horizon without an end.
real3 sky_radiance(real3 way) {
    sky_header sky = sky_size();
    real2 uv = sky_uv(sky, way);
    taps u = taps_of(uv.x, sky.width, TEXTURE_REPEATS, false), v = taps_of(uv.y, sky.height, TEXTURE_CLAMPS, false);
    real3 a = sky_texel(sky, u.first, v.first), b = sky_texel(sky, u.second, v.first);
    real3 c = sky_texel(sky, u.first, v.second), d = sky_texel(sky, u.second, v.second);
    real3 upper = a + u.weight * (b - a), lower = c + u.weight * (d - c);
    return upper + v.weight * (lower - upper);
}

// Shares of samples until entry `number` of the rows, or of the texels.
float sky_until(bool rows, uint number) {
    return uintBitsToFloat(rows ? texelFetch(sky_row_words, int(number)).x : texelFetch(sky_words, int(number)).w);
}

// The share of entry `number` of those from `first` on.
float sky_share(bool rows, uint first, uint number) {
    float before = number > 0u ? sky_until(rows, first + number - 1u) : 0.0;
    return sky_until(rows, first + number) - before;
}

// Which of `count` entries u falls on, the first whose `until` is above it, and where in it, in (0, 1): in the middle of its step of 2^-24,
// since an entry may have but one.
uint sky_pick(bool rows, uint first, uint count, float u, out real place) {
    uint low = 0u, high = count - 1u;
    for (int step = 0; step < 24 && low < high; step++) {
        uint middle = (low + high) >> 1;
        bool above = sky_until(rows, first + middle) > u;
        low = above ? low : middle + 1u;
        high = above ? middle : high;
    }
    float before = low > 0u ? sky_until(rows, first + low - 1u) : 0.0, share = sky_until(rows, first + low) - before;
    place = min((real((u - before) * 16777216.0) + 0.5) / real(share * 16777216.0), real(0.99999994));
    return low;
}

// A direction with light, and its density per solid angle, which is positive.
real3 sky_sample(vec2 u, out real pdf) {
    sky_header sky = sky_size();
    real across, down;
    uint row = sky_pick(true, 1u, sky.height, u.y, down);
    uint column = sky_pick(false, row * sky.width, sky.width, u.x, across);
    vec4 word = uintBitsToFloat(texelFetch(sky_row_words, int(1u + row)));
    pdf = real(word.y) * real(sky_share(false, row * sky.width, column));
    real from_pole = real(word.z) + down * (real(word.w) - real(word.z)); // 1 - |cosine|
    real cosine = 2u * row < sky.height ? 1.0 - from_pole : from_pole - 1.0, sine = sqrt(from_pole * (2.0 - from_pole));
    real2 turn = sincos_turns((real(column) + across) / real(sky.width) - 0.5 - sky.turns);
    return real3(sine * turn.x, cosine, -sine * turn.y);
}

// The density of sky_sample at a direction.
real sky_pdf(real3 way) {
    sky_header sky = sky_size();
    real2 uv = sky_uv(sky, way);
    uint column = taps_of(uv.x, sky.width, TEXTURE_REPEATS, true).first, row = taps_of(uv.y, sky.height, TEXTURE_CLAMPS, true).first;
    real density = real(uintBitsToFloat(texelFetch(sky_row_words, int(1u + row)).y));
    return density * real(sky_share(false, row * sky.width, column));
}

#endif
