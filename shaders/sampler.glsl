// Random numbers: Owen-scrambled Sobol points, or where the knob says so independent ones; counter-based, integer arithmetic only.
//
// The value depends on seed, pixel, sample and dimension pair alone, so that tiles, threads and devices change nothing. Pairs of dimensions are
// padded: each pair is the first two Sobol dimensions, its index shuffled and its values scrambled by hashes of its own.
// Sources: B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020 (equations and listing 3; the permutation is Laine and
// Karras', with the constants that N. Vegdahl optimised); the integer hash is C. Wellons' lowbias32.
#ifndef SAMPLER_GLSL
#define SAMPLER_GLSL
#include "shared.h"

// Dimension pairs, each used once per sample.
#define PAIR_FILM 0u
#define PAIR_LENS 1u
#define PAIR_TIME 2u                // when; unused
#define PAIR_PATH 16u               // and PAIRS_OF_A_RAY for each ray of the path
#define PAIRS_OF_A_RAY 65536u
#define PAIR_FOG 0x40000000u        // and the number of the ray in the sample: how far; unused
#define PAIR_ALPHA 0x80000000u      // and the number of the ray in the sample: whether the surface is there; unused
// Those of a ray, from where it arrives on.
#define PAIR_DIRECTION 0u
#define PAIR_CHOICE 1u              // of a lobe; whether the path goes on
#define PAIR_LIGHTS 4u              // two for each light: where on it; which part of it, unused

uint hash_uint(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

uint hash_combine(uint seed, uint value) { return hash_uint(seed ^ (value + 0x9e3779b9u + (seed << 6) + (seed >> 2))); }

// Owen scrambling in base 2 of a number whose bits are reversed: each bit is flipped by a hash of the bits below it.
uint owen_scramble_reversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Second Sobol dimension of `index`, with its bits reversed: Pascal's triangle modulo 2 times the index, which is the fivefold Kronecker power of
// (1 1; 0 1), so that five shifts do.
uint sobol_second_reversed(uint index) {
    index ^= (index & 0xffff0000u) >> 16;
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xaaaaaaaau) >> 1;
    return index;
}

// Two numbers of 32 random bits for sample `index` of a pixel.
uvec2 sample_bits(uint seed, uvec2 pixel, uint index, uint pair) {
    uint key = hash_combine(hash_combine(hash_combine(hash_uint(seed), pixel.x), pixel.y), pair);
    uint shuffled = bitfieldReverse(owen_scramble_reversed(bitfieldReverse(index), hash_combine(key, 0u)));
    uint x = bitfieldReverse(owen_scramble_reversed(shuffled, hash_combine(key, 1u)));
    uint y = bitfieldReverse(owen_scramble_reversed(sobol_second_reversed(shuffled), hash_combine(key, 2u)));
    return uvec2(x, y);
}

// The same, independent of each other and of those of other samples.
uvec2 independent_bits(uint seed, uvec2 pixel, uint index, uint pair) {
    uint key = hash_combine(hash_combine(hash_combine(hash_combine(hash_uint(seed), pixel.x), pixel.y), pair), index);
    return uvec2(hash_combine(key, 0u), hash_combine(key, 1u));
}

// To [0, 1): at most 1 - 2^-24, never 1.
vec2 unit_interval(uvec2 bits) { return vec2(bits >> 8u) * 5.9604644775390625e-8; }

// The random numbers of one sample.
struct draws {
    uint seed;
    uvec2 pixel;
    uint number;
};

vec2 draw(draws d, uint pair) {
    bool independent = CHOSEN_SAMPLER == SAMPLER_INDEPENDENT;
    return unit_interval(independent ? independent_bits(d.seed, d.pixel, d.number, pair) : sample_bits(d.seed, d.pixel, d.number, pair));
}

vec2 draw_of_ray(draws d, uint depth, uint pair) { return draw(d, PAIR_PATH + depth * PAIRS_OF_A_RAY + pair); }

// Where in its pixel sample `index` of `spp` lies: the centre when there is but one.
vec2 film_offset(uint seed, uvec2 pixel, uint index, uint spp) {
    if (spp == 1u) return vec2(0.5);
    if (CHOSEN_SAMPLER == SAMPLER_INDEPENDENT) return unit_interval(independent_bits(seed, pixel, index, PAIR_FILM));
    return unit_interval(sample_bits(seed, pixel, index, PAIR_FILM));
}

#endif
