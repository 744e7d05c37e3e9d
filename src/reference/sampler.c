// After B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020; constants by N. Vegdahl; integer hash lowbias32 by C. Wellons.
#include "reference/sampler.h"

static uint32_t reverse_bits(uint32_t x) {
    uint32_t result = 0;
    for (int i = 0; i < 32; i++) result |= (x >> i & 1) << (31 - i);
    return result;
}

static uint32_t hash(uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

static uint32_t hash_pair(uint32_t seed, uint32_t value) { return hash(seed ^ (value + 0x9e3779b9u + (seed << 6) + (seed >> 2))); }

// Each bit is flipped by a hash of the bits above it (nested uniform scrambling); the hash itself works from the lowest bit up.
static uint32_t owen_scramble(uint32_t x, uint32_t seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x = (x + seed) * (seed >> 16 | 1);
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

// First two Sobol dimensions: the direction numbers of the second follow v' = v ^ v/2.
static uint32_t sobol_first(uint32_t index) { return reverse_bits(index); }

static uint32_t sobol_second(uint32_t index) {
    uint32_t result = 0;
    for (uint32_t v = 0x80000000u; index != 0; index >>= 1, v ^= v >> 1) {
        if (index & 1) result ^= v;
    }
    return result;
}

void sampler_bits(uint32_t bits[2], uint32_t seed, uint32_t x, uint32_t y, uint32_t index, uint32_t pair) {
    uint32_t key = hash_pair(hash_pair(hash_pair(hash(seed), x), y), pair);
    uint32_t shuffled = owen_scramble(index, hash_pair(key, 0));
    bits[0] = owen_scramble(sobol_first(shuffled), hash_pair(key, 1));
    bits[1] = owen_scramble(sobol_second(shuffled), hash_pair(key, 2));
}

void sampler_independent_bits(uint32_t bits[2], uint32_t seed, uint32_t x, uint32_t y, uint32_t index, uint32_t pair) {
    uint32_t key = hash_pair(hash_pair(hash_pair(hash_pair(hash(seed), x), y), pair), index);
    bits[0] = hash_pair(key, 0);
    bits[1] = hash_pair(key, 1);
}

void sampler_draw(float u[2], const struct draws *draws, uint32_t pair) {
    uint32_t bits[2];
    (draws->independent ? sampler_independent_bits : sampler_bits)(bits, draws->seed, draws->x, draws->y, draws->number, pair);
    for (int i = 0; i < 2; i++) u[i] = (float)(bits[i] >> 8) * 0x1p-24f;
}

void sampler_draw_of_ray(float u[2], const struct draws *draws, uint32_t depth, uint32_t pair) {
    sampler_draw(u, draws, SAMPLER_PAIR_PATH + depth * SAMPLER_PAIRS_OF_A_RAY + pair);
}

void sampler_film(float offset[2], bool independent, uint32_t seed, uint32_t x, uint32_t y, uint32_t index, uint32_t spp) {
    const struct draws draws = {.seed = seed, .x = x, .y = y, .number = index, .independent = independent};
    offset[0] = offset[1] = 0.5f;
    if (spp > 1) sampler_draw(offset, &draws, SAMPLER_PAIR_FILM);
}
