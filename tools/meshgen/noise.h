// Noise with its gradient, from an integer hash: the same bits on every machine.
#ifndef MESHGEN_NOISE_H
#define MESHGEN_NOISE_H

#include <stdint.h>

#include "vec.h"

// A value in about [-1, 1] and its gradient.
struct noise {
    double value;
    struct v3 gradient;
};

// Gradient noise (Perlin 2002, "Improving Noise"): smooth, zero at lattice points.
struct noise noise_at(struct v3 p, uint32_t seed);

// How many octaves, at most `most`, a mesh can show whose segments are `segment` long, where the first octave's lattice has unit spacing.
unsigned noise_octaves(double segment, unsigned most);

// Σ gain^k · noise(2^k·p), k < octaves.
struct noise noise_fractal(struct v3 p, unsigned octaves, double gain, uint32_t seed);

// The same with (1 − √(noise² + 0.01))² in place of noise: ridges, as mountains have (after Musgrave's |noise|, 1994), a little blunted.
struct noise noise_ridged(struct v3 p, unsigned octaves, double gain, uint32_t seed);

// 32 well-mixed bits from three numbers.
uint32_t hash3(uint32_t a, uint32_t b, uint32_t c);

// In [0, 1).
static inline double unit_interval(uint32_t bits) { return bits / 4294967296.0; }

#endif
