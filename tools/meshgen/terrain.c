// Mountains: ridged fractal noise over the square [-1, 1]², y up, from a plain at z = 1 to the peaks at z = −1. Not closed.
#include "shapes.h"

#include "noise.h"

#define RELIEF 0.32   // height of one unit of noise
#define FREQUENCY 1.6 // of the largest mountains

// Position and normal at a point of the square. The height is RELIEF · mask · noise: the mask flattens the foreground.
static struct vertex ground_at(double x, double z, unsigned octaves, uint32_t seed) {
    struct noise noise = noise_ridged(v3(FREQUENCY * x + 3.1, 0.5, FREQUENCY * z + 7.7), octaves, 0.45, seed);
    double near = (z + 1) / 2, mask = 1 - near * near * (3 - 2 * near), mask_slope = -3 * near * (1 - near);
    double shaped = noise.value - 0.9;
    double dx = RELIEF * mask * FREQUENCY * noise.gradient.x;
    double dz = RELIEF * (mask * FREQUENCY * noise.gradient.z + mask_slope * shaped);
    return (struct vertex){v3(x, RELIEF * mask * shaped, z), v3_unit(v3(-dx, 1, -dz))};
}

bool shape_terrain(const struct shape_params *params) {
    struct ply ply;
    struct ply_params header = ply_params_for(params);
    uint32_t n = params->n;
    unsigned octaves = noise_octaves(2.0 * 2 * FREQUENCY / n, 8);
    header.vertices = (uint64_t)(n + 1) * (n + 1);
    header.triangles = 2 * (uint64_t)n * n;
    if (!ply_begin(&ply, &header)) return false;
    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++) {
            struct vertex v = ground_at(2.0 * i / n - 1, 2.0 * j / n - 1, octaves, params->seed);
            ply_vertex(&ply, v.position, v.normal);
        }
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * (n + 1) + i, b = a + n + 1;
            ply_triangle(&ply, a, b, b + 1);
            ply_triangle(&ply, a, b + 1, a + 1);
        }
    return ply_end(&ply);
}
