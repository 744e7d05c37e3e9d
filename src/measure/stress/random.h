// Random numbers for the stress cases: a state, and a few ways to draw from it. xorshift64*: S. Vigna, "An experimental exploration of
// Marsaglia's xorshift generators, scrambled", 2016.
#ifndef MEASURE_STRESS_RANDOM_H
#define MEASURE_STRESS_RANDOM_H

#include <stdint.h>

struct random {
    uint64_t state;
};

// Any seed and stream number give a good state.
static inline struct random random_make(uint64_t seed, uint64_t stream) {
    uint64_t state = (seed + 1) * 0x9e3779b97f4a7c15u ^ (stream + 1) * 0xbf58476d1ce4e5b9u;
    return (struct random){state ? state : 1};
}

static inline uint32_t random_bits(struct random *r) {
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (uint32_t)(r->state * 0x2545f4914f6cdd1du >> 32);
}

// 0 … count-1.
static inline uint32_t random_below(struct random *r, uint32_t count) { return (uint32_t)((uint64_t)random_bits(r) * count >> 32); }

// In [0, 1).
static inline double random_unit(struct random *r) { return random_bits(r) * 0x1p-32; }

static inline double random_in(struct random *r, double low, double high) { return low + (high - low) * random_unit(r); }

// A direction, uniform on the unit sphere.
void random_direction(double out[3], struct random *r);

// x moved by -most … most ulp. Zero may stay, or become one of the smallest denormals; what is not finite stays.
float random_ulps(struct random *r, float x, int most);

#endif
