// Every decision about one ray and one or two primitives, against the oracle: the hard cases, fuzzed by a few ulp, scaled, permuted, and
// lattices on which ties are the rule. t, u and v must be the nearest fp32. None may be wrong; plain fp64, the negative control, must be.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include "oracle.h"
#include "reference/predicates.h"
#include "reference/rounding.h"

#include <cmocka.h>

struct ray_triangle {
    struct gn_ray ray;
    float v[3][3];
};
struct ray_sphere {
    struct gn_ray ray;
    float center[3], radius;
};

// Decisions made so far.
struct tally {
    unsigned cases, hits, undecided, wrong, control_wrong;
};

// ------------------------------------------------------------------------------------------------------------------ helpers

static float ulps(float x, int steps) {
    for (; steps > 0; steps--) x = nextafterf(x, INFINITY);
    for (; steps < 0; steps++) x = nextafterf(x, -INFINITY);
    return x;
}

// Moves numbers by up to ±3 ulp: each of them, or (more often) one.
static void fuzz(uint64_t *state, float *numbers, int count) {
    bool all = oracle_random(state) % 4 == 0;
    int one = (int)(oracle_random(state) % (uint32_t)count);
    for (int i = 0; i < count; i++) {
        if (all || i == one) numbers[i] = ulps(numbers[i], (int)(oracle_random(state) % 7) - 3);
    }
}

static float between(uint64_t *state, double lo, double hi) { return (float)(lo + (hi - lo) * oracle_uniform(state)); }
static float whole(uint64_t *state, int limit) { return (float)((int)(oracle_random(state) % (uint32_t)(2 * limit + 1)) - limit); }

// Any finite float: all exponents alike, denormals among them.
static float any_float(uint64_t *state) {
    uint32_t bits;
    do bits = oracle_random(state);
    while ((bits >> 23 & 255) == 255);
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static struct gn_ray ray_make(float ox, float oy, float oz, float dx, float dy, float dz) {
    return (struct gn_ray){{ox, oy, oz}, 0, {dx, dy, dz}, INFINITY};
}

static struct oracle_ray oracle_ray_of(const struct ref_ray *ray) {
    struct oracle_ray out = {.tmin = ray->tmin, .tmax = ray->tmax};
    memcpy(out.o, ray->o, sizeof out.o);
    memcpy(out.d, ray->d, sizeof out.d);
    return out;
}

// ------------------------------------------------------------------------------------------------------------------- checks

// The negative control: the edge functions in plain fp64, zeros inside.
static bool control_triangle(const struct ref_ray *ray, const float *const v[3]) {
    double b[3][3], f[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) b[i][k] = v[i][k] - ray->o[k];
    }
    for (int i = 0; i < 3; i++) {
        const double *p = b[(i + 1) % 3], *q = b[(i + 2) % 3], *d = ray->d;
        f[i] = d[0] * (q[1] * p[2] - q[2] * p[1]) + d[1] * (q[2] * p[0] - q[0] * p[2]) + d[2] * (q[0] * p[1] - q[1] * p[0]);
    }
    double det = f[0] + f[1] + f[2];
    bool inside = (f[0] >= 0 && f[1] >= 0 && f[2] >= 0) || (f[0] <= 0 && f[1] <= 0 && f[2] <= 0);
    double t = (f[0] * b[0][2] + f[1] * b[1][2] + f[2] * b[2][2]) / det / ray->d[2];
    return inside && det != 0 && (ray->d[2] == 0 || (t > ray->tmin && t < ray->tmax));
}

static bool control_sphere(const struct ref_ray *ray, const float center[3], float radius) {
    double a = 0, b = 0, k = -(double)radius * radius;
    for (int i = 0; i < 3; i++) {
        double l = center[i] - ray->o[i];
        a += ray->d[i] * ray->d[i];
        b += l * ray->d[i];
        k += l * l;
    }
    double f = b * b - a * k;
    if (!(f >= 0)) return false;
    double near = (b - sqrt(f)) / a, far = (b + sqrt(f)) / a;
    return (near > ray->tmin && near < ray->tmax) || (far > ray->tmin && far < ray->tmax);
}

static void count_wrong(struct tally *tally, const struct ref_ray *ray, const char *what, double found, double expected) {
    if (tally->wrong++ < 5) {
        print_message("o %a %a %a d %a %a %a (%g, %g): %s %a, expected %a\n", ray->o[0], ray->o[1], ray->o[2], ray->d[0], ray->d[1],
                      ray->d[2], ray->tmin, ray->tmax, what, found, expected);
    }
}

static void compare_number(struct tally *tally, const struct ref_ray *ray, const char *what, float found,
                           const struct oracle_number *expected) {
    float right = oracle_round(expected);
    if (found != right) count_wrong(tally, ray, what, (double)found, (double)right);
}

static void compare_hit(struct tally *tally, const struct ref_ray *ray, bool hit, const struct crossing *crossing,
                        const struct oracle_hit *expected, bool control) {
    tally->cases++;
    tally->hits += expected->hit;
    tally->undecided += ray->undecided > 0;
    tally->control_wrong += control != expected->hit;
    if (hit != expected->hit) {
        count_wrong(tally, ray, "hit", hit, expected->hit);
    } else if (hit) {
        struct gn_hit found;
        crossing_round(&found, ray, crossing);
        compare_number(tally, ray, "t", found.t, &expected->t);
        compare_number(tally, ray, "u", found.u, &expected->u);
        compare_number(tally, ray, "v", found.v, &expected->v);
    }
}

static bool check_exact_triangle(struct tally *tally, struct ref_ray ray, float vertices[3][3]) {
    const float *const v[3] = {vertices[0], vertices[1], vertices[2]};
    struct oracle_ray oracle = oracle_ray_of(&ray);
    struct oracle_hit expected;
    oracle_hit_init(&expected);
    oracle_triangle(&expected, &oracle, v);
    struct crossing crossing;
    bool hit = triangle_cross(&crossing, &ray, v);
    compare_hit(tally, &ray, hit, &crossing, &expected, control_triangle(&ray, v));
    oracle_hit_clear(&expected);
    return hit;
}

static bool check_triangle(struct tally *tally, struct ray_triangle *c) {
    struct ref_ray ray;
    return ref_ray_make(&ray, &c->ray) && check_exact_triangle(tally, ray, c->v);
}

static bool check_exact_sphere(struct tally *tally, struct ref_ray ray, const float center[3], float radius) {
    struct oracle_ray oracle = oracle_ray_of(&ray);
    struct oracle_hit expected;
    oracle_hit_init(&expected);
    oracle_sphere(&expected, &oracle, center, radius);
    struct crossing crossing;
    bool hit = sphere_cross(&crossing, &ray, center, radius);
    compare_hit(tally, &ray, hit, &crossing, &expected, control_sphere(&ray, center, radius));
    oracle_hit_clear(&expected);
    return hit;
}

static bool check_sphere(struct tally *tally, const struct ray_sphere *c) {
    struct ref_ray ray;
    return ref_ray_make(&ray, &c->ray) && c->radius > 0 && isfinite(c->radius) && check_exact_sphere(tally, ray, c->center, c->radius);
}

// ------------------------------------------------------------------------------------------------------- triangles: families

static void set_vertices(struct ray_triangle *c, const float v[9]) { memcpy(c->v, v, sizeof c->v); }

// d = target - o in fp32.
static void aim(struct gn_ray *ray, const float target[3]) {
    for (int i = 0; i < 3; i++) ray->direction[i] = target[i] - ray->origin[i];
}

static void diagonal(struct ray_triangle *c, uint64_t *state) { // T01
    bool upper = oracle_random(state) % 2;
    set_vertices(c, upper ? (float[]){-5, -5, 0, 5, -5, 0, 5, 5, 0} : (float[]){-5, -5, 0, 5, 5, 0, -5, 5, 0});
    float x = between(state, -0.4, 0.4);
    c->ray = ray_make(0, 0, 10, x, x, -0.9024725f);
}

static void random_triangle(struct ray_triangle *c, uint64_t *state) {
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) c->v[i][k] = between(state, -6, 6);
        c->ray.origin[i] = between(state, -0.5, 0.5);
    }
    c->ray.tmin = 0;
    c->ray.tmax = INFINITY;
}

static void vertex_aimed(struct ray_triangle *c, uint64_t *state) { // T02
    random_triangle(c, state);
    aim(&c->ray, c->v[oracle_random(state) % 3]);
}

static void edge_aimed(struct ray_triangle *c, uint64_t *state) { // T03
    random_triangle(c, state);
    double s = oracle_uniform(state);
    float p[3];
    for (int i = 0; i < 3; i++) p[i] = (float)(c->v[0][i] + s * ((double)c->v[1][i] - c->v[0][i]));
    aim(&c->ray, p);
}

static void grid_midpoint(struct ray_triangle *c, uint64_t *state) { // T04: the ray meets the edge exactly
    float p[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) c->v[i][k] = 2 * whole(state, 1 << 18) * 0x1p-14f;
        c->ray.origin[i] = whole(state, 1 << 18) * 0x1p-14f;
    }
    for (int i = 0; i < 3; i++) p[i] = 0.5f * (c->v[0][i] + c->v[1][i]);
    c->ray.tmin = 0, c->ray.tmax = oracle_random(state) % 4 ? INFINITY : 1;
    aim(&c->ray, p);
}

static void needle(struct ray_triangle *c, uint64_t *state) { // T08
    grid_midpoint(c, state);
    for (int i = 0; i < 3; i++) c->v[2][i] = c->v[0][i] + whole(state, 4) * 0x1p-14f;
    float p[3];
    double s = oracle_uniform(state), r = oracle_uniform(state);
    for (int i = 0; i < 3; i++) p[i] = (float)(c->v[0][i] + s * ((double)c->v[1][i] - c->v[0][i]) + r * ((double)c->v[2][i] - c->v[0][i]));
    aim(&c->ray, p);
}

static void collinear(struct ray_triangle *c, uint64_t *state) { // T09
    (void)state;
    set_vertices(c, (float[]){-1113.45459f, -79.049614f, -56.2431908f, -1113.45459f, -87.0922699f, -56.2431908f, -1113.45459f, -79.2090149f,
                              -56.2431908f});
    c->ray = ray_make(-1081.47925f, 99.9999542f, 87.7701111f, -32.1072998f, -183.355865f, -144.607635f);
}

static void degenerate(struct ray_triangle *c, uint64_t *state) { // T11
    vertex_aimed(c, state);
    uint32_t kind = oracle_random(state) % 3;
    memcpy(c->v[1], c->v[kind == 0 ? 0 : 2], sizeof c->v[1]);
    if (kind == 2) memcpy(c->v[0], c->v[2], sizeof c->v[0]);
}

static void scaled(struct ray_triangle *c, uint64_t *state) { // T12, T15, T17
    (oracle_random(state) % 2 ? edge_aimed : grid_midpoint)(c, state);
    int size = (int)(oracle_random(state) % 240) - 125, direction = (int)(oracle_random(state) % 121) - 60;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) c->v[i][k] = ldexpf(c->v[i][k], size);
        c->ray.origin[i] = ldexpf(c->ray.origin[i], size);
        c->ray.direction[i] = ldexpf(c->ray.direction[i], direction);
    }
}

static void in_plane(struct ray_triangle *c, uint64_t *state) { // T18, T19
    set_vertices(c, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    c->ray = ray_make(0.25f, 0.25f, 0, whole(state, 1), whole(state, 1), whole(state, 1));
}

static void grazing(struct ray_triangle *c, uint64_t *state) { // T20
    set_vertices(c, (float[]){-1, -1, 0, 1, 0, 0, 0, 1, 0});
    float height = between(state, 0, 1e-6);
    c->ray = ray_make(-1, 0.25f, height, 1, 0, -height);
}

static void far_away(struct ray_triangle *c, uint64_t *state) { // T21, T22
    set_vertices(c, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    if (oracle_random(state) % 2)
        c->ray = ray_make(between(state, 0, 1), between(state, 0, 1), 1e7f, 0, 0, -1);
    else
        c->ray = ray_make(1e7f + whole(state, 2), 0.3f, 1e7f, -1, 0, -1);
}

static void lattice(struct ray_triangle *c, uint64_t *state) { // most edge functions are 0
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) c->v[i][k] = whole(state, 2);
        c->ray.origin[i] = whole(state, 2);
        c->ray.direction[i] = oracle_random(state) % 4 ? whole(state, 2) : -0.0f; // T30
    }
    static const float bounds[] = {0, 1, 0.5f, 2, -1, INFINITY, -INFINITY};
    c->ray.tmin = oracle_random(state) % 2 ? 0 : bounds[oracle_random(state) % 7];
    c->ray.tmax = oracle_random(state) % 2 ? INFINITY : bounds[oracle_random(state) % 7];
}

static void any_bits(struct ray_triangle *c, uint64_t *state) {
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) c->v[i][k] = any_float(state);
        c->ray.origin[i] = any_float(state);
        c->ray.direction[i] = any_float(state);
    }
    c->ray.tmin = oracle_random(state) % 2 ? -INFINITY : any_float(state);
    c->ray.tmax = oracle_random(state) % 2 ? INFINITY : any_float(state);
}

static const struct {
    const char *name;
    void (*make)(struct ray_triangle *c, uint64_t *state);
    unsigned count;
    unsigned least_hits;
} triangle_families[] = {
    {"T01 diagonal", diagonal, 3000, 100},      {"T02 vertex", vertex_aimed, 3000, 100},   {"T03 edge", edge_aimed, 3000, 100},
    {"T04 midpoint", grid_midpoint, 3000, 100}, {"T08 needle", needle, 3000, 100},         {"T09 collinear", collinear, 500, 0},
    {"T11 degenerate", degenerate, 1500, 0},    {"T12 T15 T17 scaled", scaled, 3000, 100}, {"T18 T19 in plane", in_plane, 1000, 50},
    {"T20 grazing", grazing, 1500, 100},        {"T21 T22 far", far_away, 1500, 100},      {"lattice", lattice, 12000, 200},
    {"any bits", any_bits, 4000, 50},
};

// Permutes axes, flips signs, rotates the vertices: another case of the same kind.
static void turn_about(struct ray_triangle *c, uint64_t *state) {
    int shift = (int)(oracle_random(state) % 3), first = (int)(oracle_random(state) % 3);
    uint32_t flips = oracle_random(state);
    struct ray_triangle from = *c;
    for (int i = 0; i < 3; i++) {
        int axis = (i + shift) % 3;
        float sign = flips >> i & 1 ? -1 : 1;
        c->ray.origin[i] = sign * from.ray.origin[axis];
        c->ray.direction[i] = sign * from.ray.direction[axis];
        for (int k = 0; k < 3; k++) c->v[k][i] = sign * from.v[(k + first) % 3][axis];
    }
}

// A third as made, a third turned, a third fuzzed.
static void test_triangles(void **unused) {
    (void)unused;
    struct tally all = {0};
    for (size_t f = 0; f < sizeof triangle_families / sizeof triangle_families[0]; f++) {
        uint64_t state = 100 + f;
        struct tally tally = {0};
        for (unsigned i = 0; i < triangle_families[f].count; i++) {
            struct ray_triangle c;
            triangle_families[f].make(&c, &state);
            if (i % 3 > 0) turn_about(&c, &state);
            if (i % 3 > 1) fuzz(&state, c.v[0], 9), fuzz(&state, c.ray.origin, 3), fuzz(&state, c.ray.direction, 3);
            check_triangle(&tally, &c);
        }
        print_message("%-20s %6u cases %6u hits %6u undecided %u wrong; plain fp64 %u wrong\n", triangle_families[f].name, tally.cases,
                      tally.hits, tally.undecided, tally.wrong, tally.control_wrong);
        assert_true(tally.hits >= triangle_families[f].least_hits);
        all.wrong += tally.wrong;
        all.control_wrong += tally.control_wrong;
    }
    assert_int_equal(all.wrong, 0);
    assert_true(all.control_wrong > 100);
}

struct known_triangle {
    const char *name;
    struct gn_ray ray;
    float v[9];
    bool hit;
    float t;
};

static void test_known_triangles(void **unused) {
    (void)unused;
    static const struct known_triangle cases[] = {
        {"T09",
         {{-1081.47925f, 99.9999542f, 87.7701111f}, 0, {-32.1072998f, -183.355865f, -144.607635f}, INFINITY},
         {-1113.45459f, -79.049614f, -56.2431908f, -1113.45459f, -87.0922699f, -56.2431908f, -1113.45459f, -79.2090149f, -56.2431908f},
         false,
         0},
        {"T18", {{0.25f, 0.25f, 0}, 0, {0, 0, -1}, INFINITY}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, false, 0},
        {"T19", {{-1, 0.25f, 0}, 0, {1, 0, 0}, INFINITY}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, false, 0},
        {"T20", {{-1, 0.25f, 1e-6f}, 0, {1, 0, -1e-6f}, INFINITY}, {-1, -1, 0, 1, 0, 0, 0, 1, 0}, true, 1},
        {"T21", {{0.3f, 0.3f, 1e7f}, 0, {0, 0, -1}, INFINITY}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, 1e7f},
        {"T22", {{1e7f, 0.3f, 1e7f}, 0, {-1, 0, -1}, INFINITY}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, 1e7f},
        {"T30", {{0.25f, 0.25f, 2}, 0, {-0.0f, 0, -1}, INFINITY}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, 2},
        {"T30", {{0.25f, 0.25f, 2}, 0, {0, -0.0f, -1}, INFINITY}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, 2},
        {"tmax", {{0.25f, 0.25f, 2}, 0, {0, 0, -1}, 2}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, false, 0},
        {"tmin", {{0.25f, 0.25f, 2}, 2, {0, 0, -1}, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, false, 0},
        {"behind", {{0.25f, 0.25f, 2}, -INFINITY, {0, 0, 1}, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, -2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const float *const v[3] = {cases[i].v, cases[i].v + 3, cases[i].v + 6};
        struct ref_ray ray;
        struct crossing crossing;
        struct gn_hit hit = {0};
        assert_true(ref_ray_make(&ray, &cases[i].ray));
        bool found = triangle_cross(&crossing, &ray, v);
        if (found) crossing_round(&hit, &ray, &crossing);
        if (found != cases[i].hit || (found && hit.t != cases[i].t)) fail_msg("%s: hit %d, t %g", cases[i].name, found, (double)hit.t);
    }
}

// ------------------------------------------------------------------------------------- triangles together: exactly one is hit

// T01, T32: rays through the common edge of two triangles.
static void test_shared_edge(void **unused) {
    (void)unused;
    uint64_t state = 7;
    struct tally tally = {0};
    for (int i = 0; i < 3000; i++) {
        struct ray_triangle a, b;
        diagonal(&a, &state);
        if (i == 0) a.ray = ray_make(0, 0, 10, 0.30458447f, 0.30458447f, -0.9024725f);
        if (i % 2) fuzz(&state, a.ray.direction, 3), fuzz(&state, a.ray.origin, 3);
        b.ray = a.ray;
        set_vertices(&a, (float[]){-5, -5, 0, 5, -5, 0, 5, 5, 0});
        set_vertices(&b, (float[]){-5, -5, 0, 5, 5, 0, -5, 5, 0});
        int hits = check_triangle(&tally, &a) + check_triangle(&tally, &b);
        assert_int_equal(hits, 1);
    }
    assert_int_equal(tally.wrong, 0);
}

// T06: a closed fan, aimed at its centre, its spokes, and near them.
static void test_fan(void **unused) {
    (void)unused;
    uint64_t state = 8;
    struct tally tally = {0};
    for (int n = 4; n <= 1024; n *= 4) {
        for (int aimed = -1; aimed < (n < 64 ? n : 8); aimed++) {
            struct gn_ray ray = {{0, 0, -1}, 0.01f, {0, 0, 1}, 9};
            double angle = 2 * 3.14159265358979324 * aimed / n;
            if (aimed >= 0) ray.direction[0] = 0.5f * (float)sin(angle), ray.direction[1] = 0.5f * (float)cos(angle);
            if (aimed % 2) fuzz(&state, ray.direction, 2);
            int hits = 0;
            for (int i = 0; i < n; i++) {
                double from = 2 * 3.14159265358979324 * i / n, to = 2 * 3.14159265358979324 * ((i + 1) % n) / n;
                struct ray_triangle c = {.ray = ray};
                set_vertices(&c, (float[]){0, 0, 0, (float)sin(from), (float)cos(from), 0, (float)sin(to), (float)cos(to), 0});
                hits += check_triangle(&tally, &c);
            }
            assert_int_equal(hits, 1);
        }
    }
    assert_int_equal(tally.wrong, 0);
}

// T07: the common edge of a sliver and a triangle, met exactly. (By these bits the third vertices are on different sides: x+y is 1 + 2^-24
// and 0.99.)
static void test_sliver(void **unused) {
    (void)unused;
    static const uint32_t bits[2][9] = {
        {0x3f800000, 0, 0xbf800000, 0, 0x3f800000, 0xbf800000, 0x3ec83ac8, 0x3f1be29d, 0xbed79c23},
        {0, 0x3f800000, 0xbf800000, 0x3f800000, 0, 0xbf800000, 0x3e8f7a0c, 0x3f353a70, 0xbf4fab47},
    };
    struct tally tally = {0};
    int hits = 0;
    for (int i = 0; i < 2; i++) {
        struct ray_triangle c = {.ray = ray_make(0, 0, 0, 0, 0, -1)};
        static const uint32_t origin[2] = {0x3f708000, 0x3d780000};
        memcpy(c.ray.origin, origin, sizeof origin);
        memcpy(c.v, bits[i], sizeof c.v);
        hits += check_triangle(&tally, &c);
    }
    assert_int_equal(tally.wrong, 0);
    assert_int_equal(tally.undecided, 2);
    assert_int_equal(hits, 1);
}

// T25: the cube [1.6, 14.4]³ and the ray through its middle, along the diagonals of two faces.
static void test_cube(void **unused) {
    (void)unused;
    static const int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    struct tally tally = {0};
    int hits = 0;
    for (int i = 0; i < 12; i++) {
        struct ray_triangle c = {.ray = ray_make(1, 8, 8, 1, 0, 0)};
        for (int k = 0; k < 3; k++) {
            for (int axis = 0; axis < 3; axis++) c.v[k][axis] = faces[i][k] >> axis & 1 ? 14.4f : 1.6f;
        }
        hits += check_triangle(&tally, &c);
    }
    assert_int_equal(hits, 2);
    assert_int_equal(tally.wrong, 0);
}

// ----------------------------------------------------------------------------------------------------------------- spheres

static void sphere_at_origin(struct ray_sphere *c, float radius) {
    memset(c, 0, sizeof *c);
    c->radius = radius;
    c->ray.tmax = INFINITY;
}

// S01 to S03: aimed at the silhouette from afar.
static void silhouette(struct ray_sphere *c, uint64_t *state) {
    static const double distances[] = {150, 1500, 1.5e4, 1.5e5, 1.5e6};
    sphere_at_origin(c, 1);
    double distance = distances[oracle_random(state) % 5], angle = oracle_uniform(state) * 6.283;
    double side[3] = {sin(angle), cos(angle), 1 / distance};
    float target[3];
    for (int i = 0; i < 3; i++) target[i] = (float)(side[i] * (1 + 1e-7 * (oracle_uniform(state) - 0.5)));
    c->ray.origin[2] = (float)distance;
    aim(&c->ray, target);
}

static void tangent(struct ray_sphere *c, uint64_t *state) { // S05, S08, S15: F is 0 or next to it
    static const struct ray_sphere cases[] = {
        {{{1, 0, -5}, 0, {0, 0, 1}, INFINITY}, {0, 0, 0}, 1},   {{{1, 0, 0}, 0, {0, 1, 0}, INFINITY}, {0, 0, 0}, 1},
        {{{0, 0, 0}, 0, {64, 1, 0}, INFINITY}, {64, 2, 0}, 1},  {{{3, 4, -7}, 0, {0, 0, 2}, INFINITY}, {0, 0, 0}, 5},
        {{{-25, 0, 0}, 0, {24, 7, 0}, INFINITY}, {0, 0, 0}, 7}, {{{-25, 0, 0}, 0, {24, -7, 0}, 1}, {0, 0, 0}, 7},
    };
    *c = cases[oracle_random(state) % 6];
}

static void on_surface(struct ray_sphere *c, uint64_t *state) { // S07, S08, S09
    sphere_at_origin(c, 1);
    c->ray.origin[0] = ulps(1, (int)(oracle_random(state) % 5) - 2);
    for (int i = 0; i < 3; i++) c->ray.direction[i] = whole(state, 1);
}

static void scaled_sphere(struct ray_sphere *c, uint64_t *state) { // S10
    (oracle_random(state) % 2 ? silhouette : tangent)(c, state);
    int size = (int)(oracle_random(state) % 200) - 110, direction = (int)(oracle_random(state) % 121) - 60;
    for (int i = 0; i < 3; i++) {
        c->center[i] = ldexpf(c->center[i], size);
        c->ray.origin[i] = ldexpf(c->ray.origin[i], size);
        c->ray.direction[i] = ldexpf(c->ray.direction[i], direction);
    }
    c->radius = ldexpf(c->radius, size);
}

static void lattice_sphere(struct ray_sphere *c, uint64_t *state) { // points with whole coordinates, often on the sphere or tangent to it
    static const float radii[] = {1, 2, 3, 5, 7, 9};
    for (int i = 0; i < 3; i++) {
        c->center[i] = whole(state, 5);
        c->ray.origin[i] = whole(state, 9);
        c->ray.direction[i] = whole(state, 4);
    }
    c->radius = radii[oracle_random(state) % 6];
    c->ray.tmin = oracle_random(state) % 2 ? 0 : whole(state, 2);
    c->ray.tmax = oracle_random(state) % 2 ? INFINITY : c->ray.tmin + 1;
}

static void any_sphere(struct ray_sphere *c, uint64_t *state) {
    for (int i = 0; i < 3; i++) {
        c->center[i] = any_float(state);
        c->ray.origin[i] = any_float(state);
        c->ray.direction[i] = any_float(state);
    }
    c->radius = fabsf(any_float(state));
    c->ray.tmin = oracle_random(state) % 2 ? -INFINITY : any_float(state);
    c->ray.tmax = oracle_random(state) % 2 ? INFINITY : any_float(state);
}

static const struct {
    const char *name;
    void (*make)(struct ray_sphere *c, uint64_t *state);
    unsigned count, least_hits;
} sphere_families[] = {
    {"S01-S03 silhouette", silhouette, 3000, 500}, {"S05 S08 S15 tangent", tangent, 2000, 200},
    {"S07-S09 on surface", on_surface, 2000, 200}, {"S10 scaled", scaled_sphere, 2000, 200},
    {"lattice", lattice_sphere, 6000, 500},        {"any bits", any_sphere, 2000, 50},
};

static void test_spheres(void **unused) {
    (void)unused;
    struct tally all = {0};
    for (size_t f = 0; f < sizeof sphere_families / sizeof sphere_families[0]; f++) {
        uint64_t state = 200 + f;
        struct tally tally = {0};
        for (unsigned i = 0; i < sphere_families[f].count; i++) {
            struct ray_sphere c;
            sphere_families[f].make(&c, &state);
            if (i % 2) fuzz(&state, c.ray.origin, 3), fuzz(&state, c.ray.direction, 3), fuzz(&state, &c.radius, 1);
            check_sphere(&tally, &c);
        }
        print_message("%-20s %6u cases %6u hits %6u undecided %u wrong; plain fp64 %u wrong\n", sphere_families[f].name, tally.cases,
                      tally.hits, tally.undecided, tally.wrong, tally.control_wrong);
        assert_true(tally.hits >= sphere_families[f].least_hits);
        all.wrong += tally.wrong;
        all.control_wrong += tally.control_wrong;
    }
    assert_int_equal(all.wrong, 0);
    assert_true(all.control_wrong > 100);
}

static void test_known_spheres(void **unused) {
    (void)unused;
    static const struct {
        const char *name;
        struct ray_sphere c;
        bool hit;
        float t;
    } cases[] = {
        {"S04", {{{0, 0, 8192}, 0, {0, 0, -1}, INFINITY}, {0, 0, 0}, 1}, true, 8191},
        {"S05", {{{1, 0, -5}, 0, {0, 0, 1}, INFINITY}, {0, 0, 0}, 1}, true, 5},
        {"S07", {{{1, 0, 0}, 0, {1, 0, 0}, INFINITY}, {0, 0, 0}, 1}, false, 0},
        {"S07 inward", {{{1, 0, 0}, 0, {-1, 0, 0}, INFINITY}, {0, 0, 0}, 1}, true, 2},
        {"S08", {{{1, 0, 0}, 0, {0, 1, 0}, INFINITY}, {0, 0, 0}, 1}, false, 0},
        {"S09", {{{1 - 0x1p-24f, 0, 0}, 0, {-1, 0, 0}, INFINITY}, {0, 0, 0}, 1}, true, 2 /* 2 - 2^-24 is half-way: to even */},
        {"S10", {{{0, 0, 5}, 0, {0, 0, -1e-3f}, INFINITY}, {0, 0, 0}, 1}, true, (float)(4 / (double)1e-3f)},
        {"S10", {{{0, 0, 5}, 0, {0, 0, -2}, INFINITY}, {0, 0, 0}, 1}, true, 2},
        {"inside", {{{0, 0, 0}, 0, {0, 0, -2}, INFINITY}, {0, 0, 0}, 1}, true, 0.5f},
        {"behind", {{{0, 0, 5}, 0, {0, 0, 1}, INFINITY}, {0, 0, 0}, 1}, false, 0},
        {"second", {{{0, 0, 5}, 4, {0, 0, -1}, INFINITY}, {0, 0, 0}, 1}, true, 6},
        {"short", {{{0, 0, 5}, 0, {0, 0, -1}, 4}, {0, 0, 0}, 1}, false, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct ref_ray ray;
        struct crossing crossing;
        struct gn_hit hit = {0};
        assert_true(ref_ray_make(&ray, &cases[i].c.ray));
        bool found = sphere_cross(&crossing, &ray, cases[i].c.center, cases[i].c.radius);
        if (found) crossing_round(&hit, &ray, &crossing);
        if (found != cases[i].hit || (found && hit.t != cases[i].t)) fail_msg("%s: hit %d, t %a", cases[i].name, found, (double)hit.t);
    }
}

// ------------------------------------------------------------------------------------------------------------ which is first

struct candidate {
    float v[3][3], center[3], radius;
    bool is_sphere;
};

static bool cross_candidate(struct crossing *crossing, struct oracle_hit *expected, struct ref_ray *ray, const struct candidate *c) {
    struct oracle_ray oracle = oracle_ray_of(ray);
    const float *const v[3] = {c->v[0], c->v[1], c->v[2]};
    if (c->is_sphere)
        oracle_sphere(expected, &oracle, c->center, c->radius);
    else
        oracle_triangle(expected, &oracle, v);
    bool hit = c->is_sphere ? sphere_cross(crossing, ray, c->center, c->radius) : triangle_cross(crossing, ray, v);
    assert_int_equal(hit, expected->hit);
    return hit;
}

// A sphere with radius 3, 5 or 7 around a whole point, or a triangle of whole points; scaled, all by the same power of two.
static void make_candidate(struct candidate *c, uint64_t *state, int size) {
    c->is_sphere = oracle_random(state) % 2;
    c->radius = ldexpf((float)(3 + 2 * (oracle_random(state) % 3)), size);
    for (int i = 0; i < 3; i++) {
        c->center[i] = ldexpf(whole(state, 4), size);
        for (int k = 0; k < 3; k++) c->v[i][k] = ldexpf(whole(state, 6), size);
    }
    c->center[1] = c->center[2] = 0;
}

static void test_order(void **unused) {
    (void)unused;
    uint64_t state = 300;
    unsigned pairs = 0, ties = 0, wrong = 0, near_ties = 0;
    struct oracle_hit expected[2];
    oracle_hit_init(&expected[0]), oracle_hit_init(&expected[1]);
    for (int i = 0; i < 30000; i++) {
        int size = i % 4 == 0 ? (int)(oracle_random(&state) % 200) - 120 : 0;
        struct candidate c[2];
        struct gn_ray from = {.tmin = 0, .tmax = INFINITY};
        for (int k = 0; k < 3; k++) from.direction[k] = whole(&state, 3);
        from.origin[0] = ldexpf(whole(&state, 20), size);
        if (i % 3 == 0) from.direction[1] = from.direction[2] = 0;
        make_candidate(&c[0], &state, size), make_candidate(&c[1], &state, size);
        if (i % 8 == 1) c[1] = c[0];
        if (i % 2) fuzz(&state, c[0].v[0], 9), fuzz(&state, &c[0].radius, 1), fuzz(&state, from.direction, 3);
        struct ref_ray ray;
        struct crossing crossing[2];
        if (!ref_ray_make(&ray, &from)) continue;
        if (!cross_candidate(&crossing[0], &expected[0], &ray, &c[0]) || !cross_candidate(&crossing[1], &expected[1], &ray, &c[1]))
            continue;
        uint32_t before = ray.undecided;
        int order = oracle_compare(&expected[0].t, &expected[1].t);
        int found = crossing_compare(&ray, &crossing[0], &crossing[1]);
        pairs++;
        ties += order == 0;
        near_ties += order != 0 && ray.undecided > before;
        wrong += found != order || crossing_compare(&ray, &crossing[1], &crossing[0]) != -order;
    }
    oracle_hit_clear(&expected[0]), oracle_hit_clear(&expected[1]);
    print_message("%u pairs, %u ties, %u more undecided in fp64, %u wrong\n", pairs, ties, near_ties, wrong);
    assert_true(pairs > 1000 && ties > 100);
    assert_int_equal(wrong, 0);
}

// Ties among numbers of full length, which fp64 rounds differently: a triangle and a part of it, a sphere and the same with its centre
// turned about the ray.
static void make_twins(struct candidate c[2], struct gn_ray *ray, uint64_t *state) {
    memset(c, 0, 2 * sizeof *c);
    *ray = ray_make(0, 0, 0, between(state, 1, 2), 0, 0);
    if (oracle_random(state) % 2) {
        ray->direction[1] = ray->direction[2] = ray->direction[0];
        c[0].is_sphere = c[1].is_sphere = true;
        for (int i = 0; i < 3; i++) c[0].center[i] = ldexpf(between(state, 1, 8), -(int)(oracle_random(state) % 12));
        const float *p = c[0].center;
        bool graze = oracle_random(state) % 2, near = graze || oracle_random(state) % 2; // the ray starts near the surface; along it
        if (graze) c[0].center[2] = -(p[0] + p[1]) * between(state, 1 - 1e-3, 1 + 1e-3);
        float distance = (float)sqrt((double)p[0] * p[0] + (double)p[1] * p[1] + (double)p[2] * p[2]);
        c[0].radius = c[1].radius = near ? distance * between(state, 1 - 1e-5, 1 + 1e-5) : distance * between(state, 0.8, 0.9);
        for (int i = 0; i < 3; i++) c[1].center[i] = c[0].center[(i + 1) % 3];
        return;
    }
    float distance = ldexpf(between(state, 1, 2), -(int)(oracle_random(state) % 14)); // from the plane: T is far smaller than its terms
    for (int i = 0; i < 3; i++) {
        ray->direction[i] = between(state, -1, 1);
        for (int k = 0; k < 3; k++) c[0].v[k][i] = (float)((int)(oracle_random(state) % (1u << 24)) - (1 << 23)) * 0x1p-20f;
        for (int k = 0; k < 3; k++) c[1].v[k][i] = 0.5f * (c[0].v[k][i] + c[0].v[1][i]);
        ray->origin[i] = (c[1].v[0][i] + c[1].v[1][i] + c[1].v[2][i]) / 3 - distance * ray->direction[i];
    }
}

static void test_twins(void **unused) {
    (void)unused;
    uint64_t state = 350;
    unsigned pairs = 0, wrong = 0;
    struct oracle_hit expected[2];
    oracle_hit_init(&expected[0]), oracle_hit_init(&expected[1]);
    for (int i = 0; i < 20000; i++) {
        struct candidate c[2];
        struct gn_ray from;
        struct ref_ray ray;
        struct crossing crossing[2];
        make_twins(c, &from, &state);
        assert_true(ref_ray_make(&ray, &from));
        if (!cross_candidate(&crossing[1], &expected[1], &ray, &c[1]) || !cross_candidate(&crossing[0], &expected[0], &ray, &c[0]))
            continue;
        assert_int_equal(oracle_compare(&expected[0].t, &expected[1].t), 0);
        pairs++;
        wrong += crossing_compare(&ray, &crossing[0], &crossing[1]) != 0;
    }
    oracle_hit_clear(&expected[0]), oracle_hit_clear(&expected[1]);
    print_message("%u ties, %u wrong\n", pairs, wrong);
    assert_true(pairs > 1000);
    assert_int_equal(wrong, 0);
}

// Sphere against triangle and sphere where t differs by less than fp64 tells: a sphere that a plane almost touches where the ray meets
// both.
static void test_near_ties(void **unused) {
    (void)unused;
    uint64_t state = 400;
    unsigned pairs = 0, undecided = 0, wrong = 0;
    struct oracle_hit expected[2];
    oracle_hit_init(&expected[0]), oracle_hit_init(&expected[1]);
    for (int i = 0; i < 2000; i++) {
        // The plane z = tiny against the sphere of radius r around (0,0,-r): both at the distance of the origin to 1e-20 or so.
        float tiny = whole(&state, 2) * 0x1p-70f, r = between(&state, 1, 2);
        struct candidate c[2] = {{.v = {{-9, -9, tiny}, {9, -9, tiny}, {0, 9, tiny}}},
                                 {.is_sphere = true, .center = {0, 0, -r}, .radius = r}};
        if (i % 2) c[0] = (struct candidate){.is_sphere = true, .center = {0, 0, tiny - 1}, .radius = 1};
        struct gn_ray from = {{whole(&state, 2) * 0x1p-40f, whole(&state, 2) * 0x1p-40f, between(&state, 3, 4)},
                              0,
                              {0, 0, between(&state, -4, -3)},
                              INFINITY};
        struct ref_ray ray;
        struct crossing crossing[2];
        assert_true(ref_ray_make(&ray, &from));
        assert_true(cross_candidate(&crossing[0], &expected[0], &ray, &c[0]) && cross_candidate(&crossing[1], &expected[1], &ray, &c[1]));
        uint32_t before = ray.undecided;
        pairs++;
        wrong += crossing_compare(&ray, &crossing[0], &crossing[1]) != oracle_compare(&expected[0].t, &expected[1].t);
        undecided += ray.undecided > before;
    }
    oracle_hit_clear(&expected[0]), oracle_hit_clear(&expected[1]);
    print_message("%u pairs, %u undecided in fp64, %u wrong\n", pairs, undecided, wrong);
    assert_true(undecided > 500);
    assert_int_equal(wrong, 0);
}

// ----------------------------------------------------------------------------------------------------- rays that are doubles

// Shadow rays: from a rounded point of a triangle or a sphere to a light.
static void test_double_rays(void **unused) {
    (void)unused;
    uint64_t state = 500;
    struct tally tally = {0};
    for (int i = 0; i < 6000; i++) {
        struct ray_triangle c;
        random_triangle(&c, &state);
        double u = oracle_uniform(&state), v = (1 - u) * oracle_uniform(&state);
        float target[3] = {whole(&state, 3), whole(&state, 3), whole(&state, 3)};
        if (i % 3 == 0) memcpy(target, c.v[i % 2], sizeof target);
        struct ref_ray ray = {.tmin = 0, .tmax = 1};
        for (int k = 0; k < 3; k++) {
            ray.o[k] = c.v[0][k] + u * ((double)c.v[1][k] - c.v[0][k]) + v * ((double)c.v[2][k] - c.v[0][k]);
            if (i % 5 == 0) ray.o[k] = ldexp(ray.o[k], -170);
            ray.d[k] = target[k] - ray.o[k];
        }
        check_exact_triangle(&tally, ray, c.v);
        check_exact_sphere(&tally, ray, c.v[2], fabsf(c.v[1][0]) + 1);
    }
    print_message("%u cases %u hits %u undecided %u wrong; plain fp64 %u wrong\n", tally.cases, tally.hits, tally.undecided, tally.wrong,
                  tally.control_wrong);
    assert_int_equal(tally.wrong, 0);
    assert_true(tally.hits > 500 && tally.undecided > 100);
}

// Rays that pass a sphere within 1e-16 of its radius, on either side.
static void test_double_tangents(void **unused) {
    (void)unused;
    uint64_t state = 600;
    struct tally tally = {0};
    for (int i = 0; i < 4000; i++) {
        struct ref_ray ray = {.tmin = 0, .tmax = INFINITY};
        float center[3], radius = between(&state, 1, 2);
        double side[3], along[3], dot = 0, length = 0;
        for (int k = 0; k < 3; k++) {
            center[k] = between(&state, -4, 4);
            along[k] = between(&state, -1, 1);
            side[k] = between(&state, -1, 1);
        }
        for (int k = 0; k < 3; k++) dot += along[k] * side[k], length += along[k] * along[k];
        for (int k = 0; k < 3; k++) side[k] -= dot / length * along[k];
        length = sqrt(side[0] * side[0] + side[1] * side[1] + side[2] * side[2]);
        for (int k = 0; k < 3; k++) {
            ray.d[k] = along[k];
            ray.o[k] = center[k] + radius / length * side[k] - 5 * along[k];
        }
        check_exact_sphere(&tally, ray, center, radius);
    }
    print_message("%u cases %u hits %u undecided %u wrong; plain fp64 %u wrong\n", tally.cases, tally.hits, tally.undecided, tally.wrong,
                  tally.control_wrong);
    assert_int_equal(tally.wrong, 0);
    assert_true(tally.hits > 1000 && tally.hits < 3000 && tally.undecided > 1000 && tally.control_wrong > 100);
}

// Whether (c-o)·d > 0, of doubles all but at right angles.
static void test_double_chords(void **unused) {
    (void)unused;
    uint64_t state = 700;
    unsigned hits = 0, undecided = 0, wrong = 0;
    oracle_vec l, d;
    mpz_t b, o;
    oracle_vec_init(l), oracle_vec_init(d);
    mpz_inits(b, o, (mpz_ptr)0);
    for (int i = 0; i < 4000; i++) {
        struct ref_ray ray = {.tmin = 0, .tmax = INFINITY};
        float center[3];
        for (int k = 0; k < 3; k++) {
            center[k] = between(&state, -4, 4);
            ray.o[k] = center[k] + oracle_uniform(&state) - 0.5;
            ray.d[k] = oracle_uniform(&state) - 0.5;
        }
        ray.d[2] = (ray.d[0] * (center[0] - ray.o[0]) + ray.d[1] * (center[1] - ray.o[1])) / (ray.o[2] - center[2]);
        for (int k = 0; k < 3; k++) {
            oracle_set(l[k], center[k]), oracle_set(o, ray.o[k]), oracle_set(d[k], ray.d[k]);
            mpz_sub(l[k], l[k], o);
        }
        oracle_dot(b, l, d);
        struct crossing crossing;
        bool hit = sphere_cross_again(&crossing, &ray, center, 1);
        hits += hit;
        undecided += ray.undecided > 0;
        wrong += hit != (mpz_sgn(b) > 0);
    }
    oracle_vec_clear(l), oracle_vec_clear(d);
    mpz_clears(b, o, (mpz_ptr)0);
    assert_int_equal(wrong, 0);
    assert_true(hits > 1000 && hits < 3000 && undecided > 1000);
}

// A ray that starts on a sphere by definition: the other end of the chord, or nothing.
static void test_sphere_again(void **unused) {
    (void)unused;
    static const struct {
        double o[3], d[3], tmax;
        bool hit;
        float t;
    } cases[] = {
        {{1, 0, 0}, {1, 0, 0}, 1, false, 0},
        {{1, 0, 0}, {-4, 0, 0}, 1, true, 0.5f},
        {{1, 0, 0}, {-2, 0, 0}, 1, false, 1},
        {{1, 0, 0}, {0, 1, 0}, 1, false, 0},
        {{1, 0, 0}, {-0x1p-52, 1, 0}, 1, true, 0x1p-51f},
        {{1 + 0x1p-52, 0, 0}, {0, 1, 0}, 1, false, 0},
        {{1 - 0x1p-53, 0, 0}, {0x1p-60, 1, 0}, 1, false, 0},
    };
    static const float center[3] = {0, 0, 0};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct ref_ray ray = {.tmin = 0, .tmax = cases[i].tmax};
        memcpy(ray.o, cases[i].o, sizeof ray.o);
        memcpy(ray.d, cases[i].d, sizeof ray.d);
        struct crossing crossing;
        bool hit = sphere_cross_again(&crossing, &ray, center, 1);
        struct gn_hit found = {0};
        if (hit) crossing_round(&found, &ray, &crossing);
        if (hit != cases[i].hit || (hit && found.t != cases[i].t)) fail_msg("case %zu: hit %d, t %a", i, hit, (double)found.t);
    }
}

// ----------------------------------------------------------------------------------------------------------------- the rest

static void test_normal_and_plane(void **unused) {
    (void)unused;
    static const struct {
        float v[9];
        double n[3];
    } cases[] = {
        {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1}},
        {{0, 0, 0, 1e-38f, 0, 0, 0, 1e-38f, 0}, {0, 0, 1}},
        {{0, 0, 0, 3e38f, 0, 0, 0, 0, 3e38f}, {0, -1, 0}},
        {{0, 0, 0, 0x1.000002p23f, 0x1.000002p23f, 0, 0x1.000004p23f, 0x1.000004p23f, 0x1p-149f},
         {0.70710678118654752, -0.70710678118654752, 0}},
        {{1, 2, 3, 1, 2, 3, 4, 5, 6}, {0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const float *const v[3] = {cases[i].v, cases[i].v + 3, cases[i].v + 6};
        double n[3];
        triangle_normal(n, v);
        for (int k = 0; k < 3; k++) assert_true(fabs(n[k] - cases[i].n[k]) <= 1e-9);
    }
    static const float ground[3][3] = {{0, 0, 0}, {3, 1, 0}, {1, 4, 0}}, lifted[3][3] = {{7, 7, 0}, {9, 1, 0}, {5, 5, 0x1p-149f}};
    static const float slanted[3][3] = {{0.1f, 0.2f, 0.3f}, {1.1f, 0.7f, 0.9f}, {0.4f, 2.2f, 1.7f}};
    const float *const a[3] = {ground[0], ground[1], ground[2]}, *const b[3] = {lifted[0], lifted[1], lifted[0]};
    const float *const c[3] = {lifted[0], lifted[1], lifted[2]}, *const s[3] = {slanted[2], slanted[0], slanted[1]};
    assert_true(triangle_in_plane(a, b));
    assert_false(triangle_in_plane(a, c));
    assert_true(triangle_in_plane(s, s));
    assert_false(triangle_in_plane(s, a));
}

static void test_invalid_rays(void **unused) {
    (void)unused;
    static const struct gn_ray good = {{1, 2, 3}, 0, {4, 5, 6}, INFINITY};
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    struct ref_ray ray;
    assert_true(ref_ray_make(&ray, &good));
    for (int i = 0; i < 9; i++) {
        struct gn_ray o = good, d = good;
        o.origin[i / 3] = d.direction[i / 3] = bad[i % 3];
        assert_false(ref_ray_make(&ray, &o));
        assert_false(ref_ray_make(&ray, &d));
    }
    struct gn_ray still = good, low = good, high = good, open = good;
    still.direction[0] = still.direction[1] = 0, still.direction[2] = -0.0f;
    low.tmin = NAN, high.tmax = NAN, open.tmin = -INFINITY;
    assert_false(ref_ray_make(&ray, &still) || ref_ray_make(&ray, &low) || ref_ray_make(&ray, &high));
    assert_true(ref_ray_make(&ray, &open));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triangles),       cmocka_unit_test(test_known_triangles),
        cmocka_unit_test(test_shared_edge),     cmocka_unit_test(test_fan),
        cmocka_unit_test(test_sliver),          cmocka_unit_test(test_cube),
        cmocka_unit_test(test_spheres),         cmocka_unit_test(test_known_spheres),
        cmocka_unit_test(test_order),           cmocka_unit_test(test_twins),
        cmocka_unit_test(test_near_ties),       cmocka_unit_test(test_double_rays),
        cmocka_unit_test(test_double_tangents), cmocka_unit_test(test_double_chords),
        cmocka_unit_test(test_sphere_again),    cmocka_unit_test(test_normal_and_plane),
        cmocka_unit_test(test_invalid_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
