#include "noise.h"

static uint32_t mix(uint32_t h) {
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

uint32_t hash3(uint32_t a, uint32_t b, uint32_t c) { return mix(a + 0x9e3779b9u * mix(b + 0x85ebca6bu * mix(c + 0x632be5abu))); }

// A pseudo-random vector in the cube [-1, 1]³ for a lattice point.
static struct v3 lattice_gradient(int32_t x, int32_t y, int32_t z, uint32_t seed) {
    uint32_t h = hash3((uint32_t)x ^ seed, (uint32_t)y, (uint32_t)z);
    return v3((int)(h & 1023) / 511.5 - 1, (int)(h >> 10 & 1023) / 511.5 - 1, (int)(h >> 20 & 1023) / 511.5 - 1);
}

struct fade {
    double s, ds;
}; // Perlin's quintic and its derivative

static struct fade fade(double t) { return (struct fade){t * t * t * (t * (6 * t - 15) + 10), 30 * t * t * (t - 1) * (t - 1)}; }

struct noise noise_at(struct v3 p, uint32_t seed) {
    struct v3 base = v3(floor(p.x), floor(p.y), floor(p.z)), f = v3_sub(p, base);
    struct fade fx = fade(f.x), fy = fade(f.y), fz = fade(f.z);
    struct noise sum = {0, {0, 0, 0}};
    for (int corner = 0; corner < 8; corner++) {
        int cx = corner & 1, cy = corner >> 1 & 1, cz = corner >> 2;
        struct v3 g = lattice_gradient((int32_t)base.x + cx, (int32_t)base.y + cy, (int32_t)base.z + cz, seed);
        double wx = cx ? fx.s : 1 - fx.s, wy = cy ? fy.s : 1 - fy.s, wz = cz ? fz.s : 1 - fz.s;
        double dx = cx ? fx.ds : -fx.ds, dy = cy ? fy.ds : -fy.ds, dz = cz ? fz.ds : -fz.ds;
        double height = v3_dot(g, v3_sub(f, v3(cx, cy, cz))), weight = wx * wy * wz;
        sum.value += weight * height;
        sum.gradient = v3_mad(sum.gradient, weight, g);
        sum.gradient = v3_mad(sum.gradient, height, v3(dx * wy * wz, wx * dy * wz, wx * wy * dz));
    }
    return sum;
}

unsigned noise_octaves(double segment, unsigned most) {
    unsigned octaves = 1;
    while (octaves < most && segment * (1u << octaves) <= 0.4) octaves++;
    return octaves;
}

// Octaves are shifted against each other, so that their lattice points, where noise is zero, do not coincide.
static struct v3 octave_point(struct v3 p, double frequency, unsigned k) {
    return v3_add(v3_scale(p, frequency), v3(0.37 * k, 0.71 * k, 0.53 * k));
}

struct noise noise_fractal(struct v3 p, unsigned octaves, double gain, uint32_t seed) {
    struct noise sum = {0, {0, 0, 0}};
    double amplitude = 1, frequency = 1;
    for (unsigned k = 0; k < octaves; k++) {
        struct noise octave = noise_at(octave_point(p, frequency, k), seed + k);
        sum.value += amplitude * octave.value;
        sum.gradient = v3_mad(sum.gradient, amplitude * frequency, octave.gradient);
        amplitude *= gain;
        frequency *= 2;
    }
    return sum;
}

struct noise noise_ridged(struct v3 p, unsigned octaves, double gain, uint32_t seed) {
    struct noise sum = {0, {0, 0, 0}};
    double amplitude = 1, frequency = 1;
    for (unsigned k = 0; k < octaves; k++) {
        struct noise octave = noise_at(octave_point(p, frequency, k), seed + k);
        double distance = sqrt(octave.value * octave.value + 0.01), ridge = 1 - distance, slope = -2 * ridge * octave.value / distance;
        sum.value += amplitude * ridge * ridge;
        sum.gradient = v3_mad(sum.gradient, amplitude * frequency * slope, octave.gradient);
        amplitude *= gain;
        frequency *= 2;
    }
    return sum;
}
