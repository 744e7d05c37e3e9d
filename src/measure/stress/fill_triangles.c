// The worlds of rows T: a ray and triangles.
#include <math.h>
#include <string.h>

#include "measure/stress/fill.h"

static const double PI = 3.14159265358979323846;

static void shoot_line(struct world *world, float ox, float oy, float oz, float dx, float dy, float dz) {
    world_ray(world, (float[3]){ox, oy, oz}, (float[3]){dx, dy, dz}, 0, INFINITY);
}

// A float from its bits.
static float bits(uint32_t value) {
    float x;
    memcpy(&x, &value, sizeof x);
    return x;
}

// T01
FILL(shared_diagonal) {
    (void)random, (void)rays, (void)part;
    world_vertex(world, -5, -5, 0);
    world_vertex(world, 5, -5, 0);
    world_vertex(world, 5, 5, 0);
    world_vertex(world, -5, 5, 0);
    world_triangle(world, 0, 1, 2);
    world_triangle(world, 0, 2, 3);
    shoot_line(world, 0, 0, 10, 0.30458447f, 0.30458447f, -0.9024725f);
}

// --------------------------------------------------------------------------------------------------------- closed meshes

uint32_t fill_ball(struct world *world, struct random *random, uint32_t rows, uint32_t columns, double radius, double bump,
                   const double center[3]) {
    uint32_t first = world->vertex_count, last = 1 + (rows - 1) * columns;
    for (uint32_t i = 0; i <= last; i++) {
        uint32_t row = i == 0 ? 0 : i == last ? rows : 1 + (i - 1) / columns, column = (i - 1) % columns;
        double r = radius * (1 + bump * random_unit(random)), theta = PI * row / rows, phi = 2 * PI * column / columns;
        double ring = row == 0 || row == rows ? 0 : sin(theta);
        world_vertex(world, center[0] + r * ring * cos(phi), center[1] + r * ring * sin(phi), center[2] + r * cos(theta));
    }
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t k = 0; k < columns; k++) {
            uint32_t up = first + 1 + (row - 1) * columns, down = up + columns, next = (k + 1) % columns;
            uint32_t a = row ? up + k : first, b = row ? up + next : first;
            uint32_t c = row < rows - 1 ? down + k : first + last, d = row < rows - 1 ? down + next : first + last;
            if (row < rows - 1) world_triangle(world, a, c, d);
            if (row) world_triangle(world, a, d, b);
        }
    return first;
}

// From a point of the sphere of this radius around `center` at p.
static void aim_from_sphere(struct world *world, struct random *random, const double center[3], double radius, const double p[3]) {
    double direction[3];
    float o[3];
    random_direction(direction, random);
    for (int k = 0; k < 3; k++) o[k] = (float)(center[k] + radius * direction[k]);
    world_aim(world, o, p);
}

static void random_vertex(double p[3], const struct world *world, struct random *random) {
    const float *v = world->vertices[random_below(random, world->vertex_count)];
    for (int k = 0; k < 3; k++) p[k] = v[k];
}

// A point of an edge, `along` from its beginning to its end, as fp32 has it.
static void edge_point(double p[3], const struct world *world, uint32_t triangle, uint32_t edge, double along) {
    const uint32_t *v = world->triangles[triangle].v;
    const float *a = world->vertices[v[edge]], *b = world->vertices[v[(edge + 1) % 3]];
    for (int k = 0; k < 3; k++) p[k] = (float)(a[k] + along * ((double)b[k] - a[k]));
}

static void random_edge_point(double p[3], const struct world *world, struct random *random) {
    uint32_t triangle = random_below(random, world->triangle_count), edge = random_below(random, 3);
    edge_point(p, world, triangle, edge, random_unit(random));
}

static const double ORIGIN[3] = {0, 0, 0};

// T02, T03: pbrt's bumpy sphere, from inside.
FILL(bumpy_vertices) {
    (void)part;
    double p[3];
    fill_ball(world, random, 16, 16, 1, 5, ORIGIN);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        random_vertex(p, world, random);
        aim_from_sphere(world, random, ORIGIN, 0.5, p);
    }
}

FILL(bumpy_edges) {
    (void)part;
    double p[3];
    fill_ball(world, random, 16, 16, 1, 5, ORIGIN);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        random_edge_point(p, world, random);
        aim_from_sphere(world, random, ORIGIN, 0.5, p);
    }
}

static void ball_from_outside(struct world *world, struct random *random, uint32_t rays, double radius, const double center[3]) {
    double p[3];
    fill_ball(world, random, 16, 32, radius, 0, center);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        if (i & 1)
            random_vertex(p, world, random);
        else
            random_edge_point(p, world, random);
        aim_from_sphere(world, random, center, 3 * radius, p);
    }
}

// T12, T15
FILL(tiny_sphere) {
    static const double sizes[] = {1e-4, 1e-6, 1e-12, 1e-20};
    ball_from_outside(world, random, rays, sizes[part % 4], ORIGIN);
}

FILL(huge_sphere) {
    (void)part;
    ball_from_outside(world, random, rays, 1e20, ORIGIN);
}

// T17
FILL(long_directions) {
    ball_from_outside(world, random, rays, 1, ORIGIN);
    static const int exponents[] = {60, -60, 20, -20};
    for (uint32_t i = 0; i < world->ray_count; i++)
        for (int k = 0; k < 3; k++) world->rays[i].direction[k] = ldexpf(world->rays[i].direction[k], exponents[part % 4]);
}

// T23: a control; and a sphere that far away from everything, seen from afar.
FILL(far_mesh) {
    (void)part;
    ball_from_outside(world, random, rays, 2, (double[3]){148376, 1234, -223423});
}

// T33: a camera outside whose rays go through the vertices.
FILL(uv_sphere) {
    (void)part;
    fill_ball(world, random, 16, 32, 1, 0, ORIGIN);
    for (uint32_t i = 0; i < world->vertex_count && !world->failed; i++) {
        const float *v = world->vertices[i];
        world_aim(world, (float[3]){0.3f, -4, 0.7f}, (double[3]){v[0], v[1], v[2]});
    }
    while (world->ray_count < rays && !world->failed) {
        double p[3];
        random_vertex(p, world, random);
        aim_from_sphere(world, random, ORIGIN, 4, p);
    }
}

// C12: a pinhole camera in front of a grid whose vertices project to the corners of pixels. The grid reaches beyond the picture.
FILL(vertex_grid) {
    (void)random, (void)part;
    enum { SIDE = 17 };
    uint32_t side = (uint32_t)fmin(64, fmax(4, sqrt(rays)));
    for (int y = 0; y <= SIDE; y++)
        for (int x = 0; x <= SIDE; x++)
            world_vertex(world, (x - 0.5 * SIDE) * 0.0625, (y - 0.5 * SIDE) * 0.0625, -1 - 0.03125 * ((3 * x + 5 * y) % 7));
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            uint32_t a = y * (SIDE + 1) + x, c = a + SIDE + 1;
            world_triangle(world, a, a + 1, c + 1);
            world_triangle(world, a, c + 1, c);
        }
    for (uint32_t i = 0; i < side * side && !world->failed; i++) {
        const float *v = world->vertices[(SIDE + 1) * (1 + i / side % (SIDE - 1)) + 1 + i % side % (SIDE - 1)];
        shoot_line(world, 0, 0, 0, v[0], v[1], v[2]);
    }
}

// ------------------------------------------------------------------------------------------------------- exact crossings

// k·2^-14 for |k| up to `most`·2^14.
static float grid_number(struct random *random, double most) { return (float)(floor(random_in(random, -most, most) * 16384) / 16384); }

static void grid_point(float p[3], struct random *random, double most) {
    for (int k = 0; k < 3; k++) p[k] = grid_number(random, most);
}

// T04: the middle of an edge is a number, and so is the way there.
FILL(grid_midpoints) {
    (void)part;
    for (int i = 0; i < 8; i++) {
        float v[9];
        for (int k = 0; k < 3; k++) grid_point(v + 3 * k, random, 64);
        world_lone_triangle(world, v);
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3];
        double p[3];
        grid_point(o, random, 64);
        edge_point(p, world, random_below(random, 8), i % 3, 0.5);
        world_aim(world, o, p);
    }
}

// T06
FILL(fan) {
    static const uint32_t sizes[] = {4, 5, 16, 64, 256, 1024};
    uint32_t n = sizes[part % 6], step = 1 + n / (rays ? rays : 1);
    (void)random;
    world_vertex(world, 0, 0, 0);
    for (uint32_t i = 0; i < n; i++) world_vertex(world, sin(2 * PI * i / n), cos(2 * PI * i / n), 0);
    for (uint32_t i = 0; i < n; i++) world_triangle(world, 0, 1 + i, 1 + (i + 1) % n);
    const float o[3] = {0, 0, -1};
    world_ray(world, o, (float[3]){0, 0, 1}, 0.01f, 9);
    for (uint32_t i = 0; i < n && !world->failed; i += step) {
        const float *rim = world->vertices[1 + i];
        world_ray(world, o, (float[3]){0.5f * rim[0], 0.5f * rim[1], 1}, 0.01f, 9);
    }
}

// T07: two triangles on the same side of an edge that the ray meets, their vertices given in bits.
FILL(same_side) {
    (void)random, (void)rays, (void)part;
    world_vertex(world, bits(0x3f800000), 0, bits(0xbf800000));
    world_vertex(world, 0, bits(0x3f800000), bits(0xbf800000));
    world_vertex(world, bits(0x3ec83ac8), bits(0x3f1be29d), bits(0xbed79c23));
    world_vertex(world, bits(0x3e8f7a0c), bits(0x3f353a70), bits(0xbf4fab47));
    world_triangle(world, 0, 1, 2);
    world_triangle(world, 1, 0, 3);
    shoot_line(world, bits(0x3f708000), bits(0x3d780000), 0, 0, 0, -1);
}

// T08: thin as a few steps of the grid.
FILL(needles) {
    (void)part;
    for (int i = 0; i < 16; i++) {
        float v[9];
        grid_point(v, random, 32);
        grid_point(v + 3, random, 64);
        for (int k = 0; k < 3; k++) v[6 + k] = v[k] + ((float)random_below(random, 9) - 4) / 16384;
        world_lone_triangle(world, v);
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3];
        double p[3];
        grid_point(o, random, 64);
        edge_point(p, world, random_below(random, 16), random_below(random, 3), random_unit(random));
        world_aim(world, o, p);
    }
}

// T09
FILL(collinear) {
    (void)random, (void)rays, (void)part;
    world_lone_triangle(world, (float[9]){-1113.45459f, -79.049614f, -56.2431908f, -1113.45459f, -87.0922699f, -56.2431908f, -1113.45459f,
                                          -79.2090149f, -56.2431908f});
    shoot_line(world, -1081.47925f, 99.9999542f, 87.7701111f, -32.1072998f, -183.355865f, -144.607635f);
}

// T11: a vertex twice, a vertex three times, and behind them a triangle that is none of that.
FILL(degenerate) {
    (void)part;
    float o[3] = {0.25f, 0.125f, 4};
    world_vertex(world, -1, -1, 0);
    world_vertex(world, 1, -1, 0);
    world_vertex(world, 0, 1, 0);
    world_triangle(world, 0, 1, 1);
    world_triangle(world, 2, 2, 2);
    world_triangle(world, 2, 0, 2);
    world_lone_triangle(world, (float[9]){-8, -8, -1, 8, -8, -1, 0, 8, -1});
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        double p[3], along = random_unit(random);
        edge_point(p, world, i % 3, 0, i % 4 ? along : 0);
        for (int k = 0; k < 2; k++) o[k] = (float)random_in(random, -1, 1);
        world_aim(world, o, p);
    }
}

static void unit_triangle(struct world *world) { world_lone_triangle(world, (float[9]){0, 0, 0, 1, 0, 0, 0, 1, 0}); }

// T18
FILL(origin_in_plane) {
    (void)random, (void)rays, (void)part;
    unit_triangle(world);
    shoot_line(world, 0.25f, 0.25f, 0, 0, 0, -1);
    shoot_line(world, 0.25f, 0.25f, 0, 0.5f, 0.25f, 1);
    shoot_line(world, 0, 0, 0, 0.5f, 0.25f, 1);
}

// T19
FILL(ray_in_plane) {
    (void)part;
    unit_triangle(world);
    world_lone_triangle(world, (float[9]){1, 1, 1, 2, 1, 3, 1, 2, 2}); // in the plane z = 2x + y - 2
    shoot_line(world, -1, 0.25f, 0, 1, 0, 0);
    shoot_line(world, -1, 0, 0, 1, 0, 0);
    shoot_line(world, -1, -1, 0, 1, 1, 0);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float x = grid_number(random, 4), y = grid_number(random, 4), dx = grid_number(random, 4), dy = grid_number(random, 4);
        if (dx != 0 || dy != 0) shoot_line(world, x, y, 2 * x + y - 2, dx, dy, 2 * dx + dy);
    }
}

// T20
FILL(grazing) {
    (void)random, (void)rays, (void)part;
    unit_triangle(world);
    for (int k = 10; k < 60; k += 5) shoot_line(world, -1, 0.25f, ldexpf(1, -k), 1, 0, -ldexpf(1, -k));
    shoot_line(world, -1, 0.25f, 1e-6f, 1, 0, -1e-6f);
}

// T21, T22
FILL(far_above) {
    (void)random, (void)rays, (void)part;
    unit_triangle(world);
    shoot_line(world, 0.3f, 0.3f, 1e7f, 0, 0, -1);
    shoot_line(world, 0.5f, 0.5f, 1e7f, 0, 0, -1);
    shoot_line(world, 0, 0, 1e7f, 0, 0, -1);
}

FILL(far_aside) {
    (void)random, (void)rays, (void)part;
    unit_triangle(world);
    shoot_line(world, 1e7f, 0.3f, 1e7f, -1, 0, -1);
    shoot_line(world, 1e7f, 0.5f, 1e7f, -1, 0, -1);
}

// T25: fp32(1.6) + fp32(14.4) is not 16, and the diagonals of the faces go through (·, 8, 8) or near it.
FILL(cube) {
    (void)random, (void)rays, (void)part;
    static const uint8_t faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    for (int i = 0; i < 8; i++) world_vertex(world, i & 1 ? 14.4 : 1.6, i & 2 ? 14.4 : 1.6, i & 4 ? 14.4 : 1.6);
    for (int i = 0; i < 6; i++) {
        world_triangle(world, faces[i][0], faces[i][1], faces[i][2]);
        world_triangle(world, faces[i][0], faces[i][2], faces[i][3]);
    }
    const float o[3] = {1, 8, 8}, d[3] = {1, 0, 0};
    world_ray(world, o, d, 0, INFINITY);
    world_ray(world, o, d, 1, INFINITY);
    world_ray(world, o, d, 1, 13);
    world_ray(world, o, d, 14, INFINITY);
    shoot_line(world, 1, 8, 8, 1, 0, 1e-9f);
}

// T26: the same triangle three times, in one object and in another; the lowest number is hit.
FILL(twins) {
    for (uint32_t i = 0; i < 3; i++) {
        world->mesh = i == 2 && part % 2 ? 1 : 0;
        world_lone_triangle(world, (float[9]){0, 0, 0, 1, 0, 0.5f, 0, 1, 0.25f});
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float x = (float)random_in(random, 0, 0.6), y = (float)random_in(random, 0, 0.6);
        shoot_line(world, x, y, 3, (float)random_in(random, -0.01, 0.01), (float)random_in(random, -0.01, 0.01), -1);
    }
}

// T29: each number of a ray in turn; shapes with such numbers are refused when they are loaded.
FILL(not_finite) {
    (void)random, (void)rays, (void)part;
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    unit_triangle(world);
    for (int i = 0; i < 24; i++) {
        float ray[8] = {0.25f, 0.25f, 1, 0, 0, 0, -1, 8};
        ray[i / 3] = bad[i % 3];
        world_ray(world, ray, ray + 4, ray[3], ray[7]);
    }
    world_ray(world, (float[3]){0.25f, 0.25f, 1}, (float[3]){0, 0, 0}, 0, INFINITY);
    world_ray(world, (float[3]){0.25f, 0.25f, 1}, (float[3]){0, -0.0f, 0}, 0, INFINITY);
    world_ray(world, (float[3]){0.25f, 0.25f, 1}, (float[3]){0, 0, -1}, 2, 1);
    world_ray(world, (float[3]){0.25f, 0.25f, 1}, (float[3]){0, 0, -1}, 1, 1);
}

// T30: every choice of signs for the zeros.
FILL(negative_zero) {
    (void)random, (void)rays, (void)part;
    world_lone_triangle(world, (float[9]){-0.0f, -1, 0, 1, 0.5f, -0.0f, -1, 0.5f, 0});
    for (int i = 0; i < 32; i++) {
        float zero[5];
        for (int k = 0; k < 5; k++) zero[k] = i >> k & 1 ? -0.0f : 0.0f;
        shoot_line(world, zero[0], zero[1], 1, zero[2], zero[3], -1);
        shoot_line(world, zero[0], 1, zero[1], zero[2], -1, zero[3]);
        world_ray(world, (float[3]){zero[0], zero[1], 1}, (float[3]){zero[2], zero[3], -1}, zero[4], INFINITY);
    }
}

// T32: the square [-1, 1]² turned by 90° about (1, 1, 1), which takes x to (1, 1+√3, 1-√3)/3 and so on; a point of its diagonal is
// aimed at.
FILL(turned_quad) {
    (void)part;
    const double a = 1.0 / 3, b = (1 + sqrt(3)) / 3, c = (1 - sqrt(3)) / 3;
    const double x[3] = {a, b, c}, y[3] = {c, a, b};
    for (int i = 0; i < 4; i++) {
        double sx = i == 1 || i == 2 ? 1 : -1, sy = i >= 2 ? 1 : -1;
        world_vertex(world, sx * x[0] + sy * y[0], sx * x[1] + sy * y[1], sx * x[2] + sy * y[2]);
    }
    world_triangle(world, 0, 1, 2);
    world_triangle(world, 0, 2, 3);
    const double target[3] = {0.5 * (x[0] + y[0]), 0.5 * (x[1] + y[1]), 0.5 * (x[2] + y[2])};
    for (uint32_t i = 0; i < rays && !world->failed; i++) aim_from_sphere(world, random, target, 4, target);
}
