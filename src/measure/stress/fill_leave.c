// The worlds of rows O: surfaces that rays leave.
#include <math.h>

#include "measure/stress/fill.h"

static double exponential(struct random *random, double low, double high) {
    return (random_bits(random) & 1 ? 1 : -1) * pow(10, random_in(random, low, high));
}

// A ray from o towards a random point of a triangle.
static void aim_at_triangle(struct world *world, struct random *random, uint32_t triangle, const float o[3]) {
    double a = sqrt(random_unit(random)), b = random_unit(random), p[3];
    const uint32_t *v = world->triangles[triangle].v;
    for (int k = 0; k < 3; k++)
        p[k] = (1 - a) * world->vertices[v[0]][k] + a * (1 - b) * world->vertices[v[1]][k] + a * b * world->vertices[v[2]][k];
    world_aim(world, o, p);
}

// Triangles of this size around `at`, and rays at them from about as far away.
static void triangles_around(struct world *world, struct random *random, uint32_t rays, uint32_t count, const double at[3], double size) {
    uint32_t first = world->triangle_count;
    for (uint32_t i = 0; i < count; i++) {
        float v[9];
        for (int k = 0; k < 9; k++) v[k] = (float)(at[k % 3] + size * random_in(random, -1, 1));
        world_lone_triangle(world, v);
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3];
        for (int k = 0; k < 3; k++) o[k] = (float)(at[k] + 2 * size * random_in(random, -1, 1));
        aim_at_triangle(world, random, first + random_below(random, count), o);
    }
}

// Spheres of many sizes, near and far, from outside and from inside.
static void spheres_to_leave(struct world *world, struct random *random, uint32_t rays, uint32_t part) {
    float center[3];
    const double radius = pow(10, (double)(part % 8) - 4);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) center[k] = (float)(radius * random_in(random, -3, 3) * (part < 8 ? 1 : 1000));
        world_sphere(world, center, (float)(radius * random_in(random, 0.5, 1)));
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        const struct world_sphere *sphere = &world->spheres[random_below(random, 4)];
        double direction[3], p[3], inside = random_bits(random) & 1 ? 0.5 : 3;
        float o[3];
        random_direction(direction, random);
        for (int k = 0; k < 3; k++) o[k] = (float)(sphere->center[k] + inside * sphere->radius * direction[k]);
        random_direction(direction, random);
        for (int k = 0; k < 3; k++) p[k] = sphere->center[k] + 0.9 * sphere->radius * direction[k];
        world_aim(world, o, p);
    }
}

// O01: pbrt's Reintersect: a triangle whose numbers are of any size from 1e-8 to 1e8, alone in its world; in every fourth part spheres.
FILL(any_scale) {
    float v[9], o[3];
    if (part % 4 == 3) {
        spheres_to_leave(world, random, rays, part / 4);
        return;
    }
    for (int k = 0; k < 9; k++) v[k] = (float)exponential(random, -8, 8);
    for (int k = 0; k < 3; k++) o[k] = (float)exponential(random, -8, 8);
    world_lone_triangle(world, v);
    for (uint32_t i = 0; i < rays && !world->failed; i++) aim_at_triangle(world, random, 0, o);
}

// O02
FILL(size_and_place) {
    static const double sizes[][2] = {{1, 0},    {1, 1e2},    {1, 1e4},  {1, 1e6},     {1e-3, 0},
                                      {1e-3, 1}, {1e-3, 1e2}, {1e-6, 0}, {1e-6, 1e-2}, {1e6, 0}};
    const double *which = sizes[part % 10], at[3] = {which[1], -0.7 * which[1], 0.3 * which[1]};
    triangles_around(world, random, rays, 16, at, which[0]);
}

// O03, O04
FILL(large_triangles) {
    (void)part;
    triangles_around(world, random, rays, 16, (double[3]){0, 0, 0}, 1e4);
}

FILL(small_triangles) {
    (void)part;
    triangles_around(world, random, rays, 16, (double[3]){0, 0, 0}, 1e-3);
}

// O05: two closed shells 4e-5 apart, and rays in between and from inside.
FILL(thin_shell) {
    (void)part;
    const double center[3] = {0, 0, 0};
    fill_ball(world, random, 12, 24, 1, 0, center);
    world->mesh = 1;
    fill_ball(world, random, 12, 24, 1.00004, 0, center);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        const float *v = world->vertices[random_below(random, world->vertex_count / 2)];
        float o[3];
        for (int k = 0; k < 3; k++) o[k] = (float)(v[k] * (i & 1 ? 1.00002 : 0.5));
        aim_at_triangle(world, random, random_below(random, world->triangle_count), o);
    }
}

// O14
FILL(distant_rectangle) {
    const float distance = part % 2 ? 1e7f : 1e4f;
    world_vertex(world, -1, -1, 0.25);
    world_vertex(world, 1, -1, 0.125);
    world_vertex(world, 1, 1, -0.25);
    world_vertex(world, -1, 1, -0.125);
    world_triangle(world, 0, 1, 2);
    world_triangle(world, 0, 2, 3);
    for (uint32_t i = 0; i < rays && !world->failed; i++) aim_at_triangle(world, random, i & 1, (float[3]){0.3f, 0.2f, distance});
}

// O15: a planet in metres, a sphere or a mesh, seen from 2.2e6 above; and a boulder on it.
FILL(planet) {
    const double radius = 6.4e6;
    if (part % 2)
        fill_ball(world, random, 16, 32, radius, 0, (double[3]){0, 0, 0});
    else
        world_sphere(world, (float[3]){0, 0, 0}, (float)radius);
    world->mesh = world_mesh_count(world);
    fill_ball(world, random, 4, 6, 1e4, 0.5, (double[3]){0, 0, radius});
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        double direction[3], p[3];
        random_direction(direction, random);
        for (int k = 0; k < 3; k++) p[k] = radius * direction[k];
        p[2] = fabs(p[2]) + (random_bits(random) & 1 ? 0 : radius);
        world_aim(world, (float[3]){1e5f, -2e5f, 8.6e6f}, p);
    }
}
