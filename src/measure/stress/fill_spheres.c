// The worlds of rows S: a ray and a sphere; and of the rows of rays among B, C and X: boxes, cameras, far places.
#include <math.h>
#include <string.h>

#include "measure/stress/fill.h"

static const double PI = 3.14159265358979323846;

static void shoot_line(struct world *world, float ox, float oy, float oz, float dx, float dy, float dz) {
    world_ray(world, (float[3]){ox, oy, oz}, (float[3]){dx, dy, dz}, 0, INFINITY);
}

static void unit_sphere(struct world *world) { world_sphere(world, (float[3]){0, 0, 0}, 1); }

// Rays from `distance` away past the limb of a sphere: a third anywhere near it, the rest by where rounding decides.
static void aim_at_limb(struct world *world, struct random *random, const double center[3], double radius, double distance) {
    double away[3], across[3], side[3], p[3];
    float o[3];
    random_direction(away, random);
    random_direction(side, random);
    double along = away[0] * side[0] + away[1] * side[1] + away[2] * side[2], length = 0;
    for (int k = 0; k < 3; k++) across[k] = side[k] - along * away[k], length += across[k] * across[k];
    double offset = random_below(random, 3) ? ldexp(random_in(random, -1, 1), -(int)random_below(random, 30)) : random_in(random, -1, 0.2);
    for (int k = 0; k < 3; k++) {
        o[k] = (float)(center[k] + distance * away[k]);
        p[k] = center[k] + radius * (1 + offset) * across[k] / sqrt(length);
    }
    world_aim(world, o, p);
}

static void limb_from(struct world *world, struct random *random, uint32_t rays, double distance) {
    unit_sphere(world);
    for (uint32_t i = 0; i < rays && !world->failed; i++) aim_at_limb(world, random, (double[3]){0, 0, 0}, 1, distance);
}

// S01, S02, S03
FILL(sphere_limb) {
    (void)part;
    limb_from(world, random, rays, 150);
}

FILL(sphere_limb_far) {
    (void)part;
    limb_from(world, random, rays, 1500);
}

FILL(sphere_limb_very_far) {
    static const double distances[] = {1.5e4, 1.5e5, 1.5e6};
    limb_from(world, random, rays, distances[part % 3]);
}

// S04
FILL(far_sphere) {
    (void)part;
    unit_sphere(world);
    shoot_line(world, -8192, 0, 0, 1, 0, 0);
    shoot_line(world, 0, -8192, 0.5f, 0, 1, 0);
    for (uint32_t i = world->ray_count; i < rays && !world->failed; i++) aim_at_limb(world, random, (double[3]){0, 0, 0}, 1, 8192);
}

// S05: tangents whose numbers are small integers, so that F is exactly 0.
FILL(tangent) {
    (void)random, (void)rays, (void)part;
    unit_sphere(world);
    world_sphere(world, (float[3]){7, 24, 5}, 25);
    shoot_line(world, 1, 0, -5, 0, 0, 1);
    shoot_line(world, 1, 0, -5, 0, 0, 0.25f);
    shoot_line(world, -1, -1, 3, 0, 1, 0);
    shoot_line(world, 32, 0, -5, 0, 0, 2);
    shoot_line(world, 7 - 24 + 7, 24 + 7 + 24, 5, 24, -7, 0); // touches at (14, 48, 5)
}

// S07
FILL(leaving_sphere) {
    (void)random, (void)rays, (void)part;
    unit_sphere(world);
    shoot_line(world, 1, 0, 0, 1, 0, 0);
    shoot_line(world, 0, 0, -1, 0, 0, -3);
    shoot_line(world, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0);
    shoot_line(world, 0, 1, 0, 0.5f, 0.001f, 0.25f);
}

// S08
FILL(touching_sphere) {
    (void)random, (void)rays, (void)part;
    unit_sphere(world);
    shoot_line(world, 1, 0, 0, 0, 1, 0);
    shoot_line(world, 1, 0, 0, 0, 0.5f, -2);
    shoot_line(world, 0, 0, -1, 1, 1, 0);
}

// S09
FILL(just_inside) {
    (void)random, (void)rays, (void)part;
    unit_sphere(world);
    shoot_line(world, 0x1.fffffep-1f, 0, 0, -1, 0, 0);
    shoot_line(world, 0, 0x1.fffffep-1f, 0, 0.25f, -1, 0);
    shoot_line(world, 0, 0, -0x1.fffffep-1f, 0, 0.001f, 1);
    shoot_line(world, 0, 0, -0x1.fffffep-1f, 1, 0, 0);
}

// S10
FILL(scaled_direction) {
    static const double lengths[] = {2, 1e-3, 1e10, 1e-10};
    unit_sphere(world);
    for (uint32_t i = 0; i < rays && !world->failed; i++) aim_at_limb(world, random, (double[3]){0, 0, 0}, 1, 3);
    for (uint32_t i = 0; i < world->ray_count; i++)
        for (int k = 0; k < 3; k++) world->rays[i].direction[k] = (float)(world->rays[i].direction[k] * lengths[part % 4]);
}

// S14
FILL(distant_camera) {
    (void)part;
    world_sphere(world, (float[3]){0, 0, 800000}, 1600);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        double angle = random_in(random, 0, 2 * PI), limb = tan(asin(1600.0 / 3200.0)),
               offset = ldexp(random_in(random, -1, 1), -(int)random_below(random, 30));
        float r = (float)(limb * (1 + offset));
        shoot_line(world, 0, 0, 796800, r * (float)cos(angle), r * (float)sin(angle), 1);
    }
}

// S15: d·d = 4097, l·d = 4098, |l|² - r² = 4099, so that the discriminant is 1 and t is 1; and a triangle whose edge functions are
// 4098² - 4097·4099 = 1.
FILL(cancelling) {
    (void)random, (void)rays, (void)part;
    world_sphere(world, (float[3]){64, 2, 0}, 1);
    shoot_line(world, 0, 0, 0, 64, 1, 0);
    shoot_line(world, 0, 0, 0, 128, 2, 0);
    world_lone_triangle(world, (float[9]){4098, 4097, -9000, 4099, 4098, -9000, -8197, -8195, -9000});
    shoot_line(world, 0, 0, 0, 0, 0, -1);
    shoot_line(world, 0, 0, -16384, 0, 0, 2);
}

// ------------------------------------------------------------------------------------------------------- through boxes

// A rectangle across axis `k` at `at`, from -1 to 1 in the other two.
static void square(struct world *world, int k, float at) {
    uint32_t first = world->vertex_count;
    for (int i = 0; i < 4; i++) {
        float v[3];
        v[k] = at;
        v[(k + 1) % 3] = i == 1 || i == 2 ? 1 : -1;
        v[(k + 2) % 3] = i >= 2 ? 1 : -1;
        world_vertex(world, v[0], v[1], v[2]);
    }
    world_triangle(world, first, first + 1, first + 2);
    world_triangle(world, first, first + 2, first + 3);
}

// B01, B14: boxes without thickness, and rays along axes in their faces, edges and corners: 0·inf in a slab test.
FILL(flat_boxes) {
    (void)part;
    for (int i = 0; i < 6; i++) square(world, i % 3, (float)(i / 3));
    world_lone_triangle(world, (float[9]){0, -0.5f, -0.5f, 0, 0.5f, -0.5f, 0.5f, 0, 2});
    static const float places[] = {-1, 0, 1, 0.5f, -0.0f, 2};
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        int k = (int)random_below(random, 3);
        float o[3], d[3] = {0, 0, random_bits(random) & 1 ? -0.0f : 0.0f};
        for (int j = 0; j < 3; j++) o[j] = places[random_below(random, 6)];
        d[k] = random_bits(random) & 1 ? 1 : -1;
        o[k] = -4 * d[k];
        if (random_below(random, 4) == 0) d[(k + 1) % 3] = (float)random_in(random, -0.5, 0.5);
        world_ray(world, o, d, 0, INFINITY);
    }
}

// B15: intervals that end where something is hit, to the bit; and ties.
FILL(bounds_of_t) {
    (void)random, (void)rays, (void)part;
    square(world, 2, -3);
    square(world, 2, -3);
    square(world, 2, -4);
    world_sphere(world, (float[3]){0, 0, -4}, 1);
    const float near = 3, before = nextafterf(near, 0), after = nextafterf(near, 4);
    const float bounds[] = {0, before, near, after, 4, 5, nextafterf(5, 6), INFINITY};
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 8; k++) {
            world_ray(world, (float[3]){0.25f, 0.125f, 0}, (float[3]){0, 0, -1}, bounds[i], bounds[k]);
            world_ray(world, (float[3]){0, 0, 0}, (float[3]){0, 0, -1}, bounds[i], bounds[k]);
            world_ray(world, (float[3]){0, 0, 0}, (float[3]){0, 0, -4}, bounds[i] / 4, bounds[k] / 4);
        }
}

// B08: from inside, from the faces and from the corners of boxes.
FILL(origin_on_box) {
    (void)part;
    for (int k = 0; k < 3; k++) square(world, k, 1), square(world, k, -1);
    world_sphere(world, (float[3]){0.25f, 0, 0}, 0.25f);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3], d[3];
        for (int k = 0; k < 3; k++) {
            uint32_t choice = random_below(random, 4);
            o[k] = choice < 3 ? (float)choice - 1 : (float)random_in(random, -1, 1);
            d[k] = random_below(random, 3) ? (float)random_in(random, -1, 1) : 0;
        }
        world_ray(world, o, d, 0, INFINITY);
    }
}

// B07: components of the direction that are zero, denormal, or next to nothing; and from so far away that they count.
FILL(denormal_directions) {
    (void)part;
    static const float small[] = {0, -0.0f, 1e-40f, -1e-40f, 1e-45f, 1e-38f, 1e-30f, -1e-20f, 1e-8f};
    for (int k = 0; k < 3; k++) square(world, k, 0.5f), square(world, k, -0.25f);
    for (int i = 0; i < 8; i++)
        shoot_line(world, 0.25f, -0.125f, -0x1p120f, (float)ldexp(random_in(random, -1, 1), -120),
                   (float)ldexp(random_in(random, -1, 1), -121), 1);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3], d[3];
        for (int k = 0; k < 3; k++) {
            o[k] = random_bits(random) & 1 ? (float)random_in(random, -2, 2) : (float)random_below(random, 5) * 0.25f - 0.5f;
            d[k] = random_below(random, 3) ? small[random_below(random, 9)] : (float)random_in(random, -1, 1);
        }
        world_ray(world, o, d, 0, INFINITY);
    }
}

// B02: boxes that are points to a hierarchy: grains of 2^-20 far from the origin, each aimed at through its middle.
FILL(grains) {
    (void)part;
    for (int i = 0; i < 64; i++) {
        float c[3], v[9];
        for (int k = 0; k < 3; k++) c[k] = (float)(floor(random_in(random, -1024, 1024) * 4096) / 4096);
        for (int k = 0; k < 9; k++) v[k] = c[k % 3] + ((float)random_below(random, 3) - 1) / 4096;
        world_lone_triangle(world, v);
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        const struct world_triangle *t = &world->triangles[random_below(random, 64)];
        double p[3];
        float o[3];
        for (int k = 0; k < 3; k++) {
            p[k] = ((double)world->vertices[t->v[0]][k] + world->vertices[t->v[1]][k] + world->vertices[t->v[2]][k]) / 3;
            o[k] = random_below(random, 4) ? (float)(floor(random_in(random, -1024, 1024) * 4096) / 4096) : world->vertices[t->v[0]][k];
        }
        world_aim(world, o, p);
    }
}

// B13: extents of 1e20, and among them things of 1 or of 1e-25.
FILL(huge_extents) {
    const float size = part % 2 ? 1e-25f : 1;
    for (int k = 0; k < 3; k++) square(world, k, 1e20f);
    world_lone_triangle(world, (float[9]){-1e20f, -1e20f, 3, 1e20f, -1e20f, 3, 0, 1e20f, 3});
    uint32_t first = world->vertex_count;
    for (int i = 0; i < 24; i++) square(world, i % 3, (float)i);
    for (uint32_t i = first; i < world->vertex_count; i++)
        for (int k = 0; k < 3; k++) world->vertices[i][k] *= size;
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        const float *v = world->vertices[first + random_below(random, world->vertex_count - first)];
        float o[3], d[3];
        for (int k = 0; k < 3; k++)
            o[k] = (float)(size * random_in(random, -20, 20)), d[k] = i % 2 ? v[k] - o[k] : (float)random_in(random, -1, 1);
        world_ray(world, o, d, 0, INFINITY);
    }
}

// ------------------------------------------------------------------------------------------------------------ far places

// X09: a city at (4.5e6, 6e6, 6), in metres: walls and a roof, and rays of a few metres between them.
FILL(far_city) {
    (void)part;
    const double at[3] = {4.5e6, 6e6, 6};
    for (int i = 0; i < 12; i++) {
        double x = at[0] + 8 * (i % 4), y = at[1] + 8.5 * (i / 4);
        uint32_t first = world->vertex_count;
        for (int k = 0; k < 4; k++)
            world_vertex(world, x + 5 * (k == 1 || k == 2), y + (i % 2 ? 3 : 0) * (k == 1 || k == 2), at[2] + 9 * (k >= 2));
        world_triangle(world, first, first + 1, first + 2);
        world_triangle(world, first, first + 2, first + 3);
    }
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3], d[3];
        for (int k = 0; k < 3; k++) o[k] = (float)(at[k] + random_in(random, 0, k < 2 ? 24 : 9)), d[k] = (float)random_in(random, -1, 1);
        if (random_bits(random) & 1) {
            const float *v = world->vertices[random_below(random, world->vertex_count)];
            for (int k = 0; k < 3; k++) d[k] = v[k] - o[k];
        }
        if (d[0] != 0 || d[1] != 0 || d[2] != 0) world_ray(world, o, d, 0, INFINITY);
    }
}

// X11: a thing of the size of a man 35 400 units from the origin.
FILL(far_thing) {
    (void)part;
    const double at[3] = {35400, 12, -17};
    fill_ball(world, random, 12, 24, 1, 0.2, at);
    world_sphere(world, (float[3]){35402.5f, 12, -17}, 1);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        double direction[3], p[3];
        float o[3];
        const float *v = world->vertices[random_below(random, world->vertex_count)];
        random_direction(direction, random);
        for (int k = 0; k < 3; k++) o[k] = (float)(at[k] + 6 * direction[k]), p[k] = v[k];
        world_aim(world, o, p);
    }
}

// C03: camera and things at 1e7, where fp32 has every whole number.
FILL(far_camera) {
    (void)part;
    for (int i = 0; i < 8; i++)
        world_lone_triangle(world, (float[9]){1e7f + (float)i, -4, -8.0f - (float)i, 1e7f + 4, (float)i, -12, 1e7f - 3, 5, -7});
    world_sphere(world, (float[3]){1e7f + 6, 3, -9}, 3);
    for (uint32_t i = 0; i < rays && !world->failed; i++)
        shoot_line(world, 1e7f, 0, 0, (float)random_in(random, -1, 1), (float)random_in(random, -1, 1), -1);
}
