// The sampler's fp32 numbers on the CPU, with the same bits as shaders/sampler.glsl: Owen-scrambled Sobol points, or independent ones; counter-based.
#ifndef REFERENCE_SAMPLER_H
#define REFERENCE_SAMPLER_H

#include <stdbool.h>
#include <stdint.h>

// Pairs of dimensions, as in sampler.glsl.
#define SAMPLER_PAIR_FILM 0u
#define SAMPLER_PAIR_LENS 1u
#define SAMPLER_PAIR_TIME 2u
#define SAMPLER_PAIR_PATH 16u
#define SAMPLER_PAIRS_OF_A_RAY 65536u
#define SAMPLER_PAIR_FOG 0x40000000u
#define SAMPLER_PAIR_ALPHA 0x80000000u
#define SAMPLER_PAIR_DIRECTION 0u
#define SAMPLER_PAIR_CHOICE 1u
#define SAMPLER_PAIR_LIGHTS 4u

// Two numbers of 32 random bits for sample `index` of pixel (x, y).
void sampler_bits(uint32_t bits[2], uint32_t seed, uint32_t x, uint32_t y, uint32_t index, uint32_t pair);

// The same, independent of each other and of those of other samples.
void sampler_independent_bits(uint32_t bits[2], uint32_t seed, uint32_t x, uint32_t y, uint32_t index, uint32_t pair);

// The random numbers of one sample.
struct draws {
    uint32_t seed, x, y, number;
    bool independent;
};

// A pair of numbers in [0, 1); the second: that of ray `depth` of the path.
void sampler_draw(float u[2], const struct draws *draws, uint32_t pair);
void sampler_draw_of_ray(float u[2], const struct draws *draws, uint32_t depth, uint32_t pair);

// Where in its pixel sample `index` of `spp` lies, in [0, 1): the centre when there is but one.
void sampler_film(float offset[2], bool independent, uint32_t seed, uint32_t x, uint32_t y, uint32_t index, uint32_t spp);

#endif
