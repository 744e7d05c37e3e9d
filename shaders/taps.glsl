// Where a coordinate lies between the centers of a picture's texels, and how the picture goes on beyond its edges.
//
// 1 is the whole picture; texel i of n has its center at (i + 1/2)/n. Coordinates are fp32 data: what is within 2^-23 of the picture from a
// texel's center is there, so that a center which fp32 cannot hold gives exactly its texel. No number leads out of the picture; NaN and
// infinity count as 0.
#ifndef TAPS_GLSL
#define TAPS_GLSL
#include "real.glsl"
#include "shared.h"

// The part of a coordinate that counts, in [0, 1].
real wrap_coordinate(real x, uint wrap) {
    x = abs(x) < INFINITY ? x : 0.0;
    real repeated = x - floor(x), within_two = x - 2.0 * floor(0.5 * x);
    real mirrored = within_two > 1.0 ? 2.0 - within_two : within_two;
    return wrap == TEXTURE_REPEATS ? repeated : wrap == TEXTURE_MIRRORS ? mirrored : clamp(x, real(0.0), real(1.0));
}

// Two neighbours along an axis, and the weight of the second.
struct taps {
    uint first, second;
    real weight;
};

// Between the centers of the first texel and the last, the next one is the other, where the picture repeats, else the same once more.
taps taps_of(real x, uint size, uint wrap, bool nearest) {
    precise real place = wrap_coordinate(x, wrap) * real(size);
    precise real from_center = place - 0.5;
    real own = min(floor(place), real(size) - 1.0);
    bool there = nearest || abs(from_center - own) <= 1.5e-7 * real(size);
    real low = there ? own : floor(from_center);
    int first = int(low), second = first + 1, last = int(size) - 1;
    first = first < 0 && wrap == TEXTURE_REPEATS ? last : clamp(first, 0, last);
    second = second > last && wrap == TEXTURE_REPEATS ? 0 : clamp(second, 0, last);
    return taps(uint(first), uint(second), there ? 0.0 : from_center - low);
}

#endif
