// Lights with a size: the shaders' samples against fp64, the reference's against closed forms, by the chi-squared test and by the light that arrives; and
// the table of lights, from a scene through the device's arrays.
#include "scratch.h"
#include "twins.h"

#include <float.h>
#include <math.h>

#include "bvh/scene_boxes.h"
#include "reference/light_shapes.h"
#include "reference/lights.h"
#include "render/upload.h"
#include "scene/area_lights.h"
#include "twin_light.h"
#include "twin_light_fp64.h"
#include "twin_light_table.h"
#include "twin_light_table_fp64.h"

#define CASES 16384
#define PI 3.14159265358979323846
#define LAST_U (1 - 0x1p-24)

enum { SPHERE, TRIANGLE, RECTANGLE, SPOT };
enum { WHAT, P, SHAPE = 4, U = 13, IN = 15 };
enum { WAY, PDF = 3, AGAIN, SEEN, OUT };

static double given[CASES][IN], got[CASES][OUT];
static const struct twins LIGHT = {TWINS(twin_light), .in = IN, .out = OUT};

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static double length(const double v[3]) { return sqrt(dot(v, v)); }

static void cross(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void subtract(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

static float random_u(void) { return (float)(random_bits() >> 8) * 0x1p-24f; }

static bool reference_sample(double way[3], double *pdf, const double *c) {
    const float u[2] = {(float)c[U], (float)c[U + 1]};
    double v[3][3];
    memcpy(v, c + SHAPE, sizeof v);
    const double(*const at)[3] = (const double(*)[3])v;
    if (c[WHAT] == SPHERE) return ref_sphere_light_sample(way, pdf, c + P, c + SHAPE, c[SHAPE + 3], u);
    return c[WHAT] == TRIANGLE ? ref_triangle_light_sample(way, pdf, c + P, at, u) : ref_rectangle_light_sample(way, pdf, c + P, at, u);
}

static double reference_pdf(const double *c) {
    double v[3][3];
    memcpy(v, c + SHAPE, sizeof v);
    const double(*const at)[3] = (const double(*)[3])v;
    if (c[WHAT] == SPHERE) return ref_sphere_light_pdf(c + P, c + SHAPE, c[SHAPE + 3]);
    return c[WHAT] == TRIANGLE ? ref_triangle_light_pdf(c + P, at) : ref_rectangle_light_pdf(c + P, at);
}

// ---------------------------------------------------------------------------------------------------------------- twins

// A light of this size at this distance; triangles are not thin, and not seen from the side.
static void make_case(double *c, int what, double size, double distance) {
    double way[3], e1[3], e2[3], normal[3];
    for (int k = 0; k < 3; k++) c[P + k] = random_in(-1, 1);
    random_direction(way);
    do {
        random_direction(e1);
        random_direction(e2);
        cross(normal, e1, e2);
    } while (!(length(normal) > 0.3) || !(fabs(dot(normal, way)) > 0.2));
    c[WHAT] = what;
    for (int k = 0; k < 3; k++) {
        const double center = c[P + k] + distance * way[k], corner = center - size * (e1[k] + e2[k]) / 3;
        c[SHAPE + k] = what == SPHERE ? center : corner;
        c[SHAPE + 3 + k] = what == SPHERE ? size : corner + size * e1[k];
        c[SHAPE + 6 + k] = what == SPHERE ? 0 : corner + size * e2[k];
    }
    c[U] = random_u();
    c[U + 1] = random_u();
    for (int k = 0; k < IN; k++) c[k] = (float)c[k];
}

// Limits in the unit roundoff: of the way's direction, absolute, and of the density, relative. What the reference itself loses of small lights, being written in angles, is
// allowed to fp64 on top.
struct distance_row { double size, distance, way, pdf; };
static const struct distance_row DISTANCES[] = {
    {1, 1.5, 30, 40}, {0.1, 1.5, 10, 40}, {0.01, 1.5, 10, 40}, {1e-4, 1.5, 10, 40}, {10, 100, 10, 40}, {1000, 1500, 30, 40}, {1, 0.5, 500, 200},
};

static void compare(const struct distance_row *row, int what, bool fp64) {
    const double unit = fp64 ? 0x1p-53 : 0x1p-24, lost = fp64 ? fmax(1, row->distance / row->size) : 1;
    const double way_limit = row->way * unit, pdf_limit = row->pdf * lost * unit;
    int caught = 0;
    for (int i = 0; i < CASES; i++) make_case(given[i], what, row->size, row->distance);
    twins_run(&LIGHT, fp64, given[0], got[0], CASES);
    for (int i = 0; i < CASES; i++) {
        double way[3], pdf, apart[3];
        const double *g = got[i];
        assert_true(reference_sample(way, &pdf, given[i]) && g[SEEN] == 1);
        assert_true(reference_pdf(given[i]) == pdf && g[AGAIN] == g[PDF]);
        for (int k = 0; k < 3; k++) apart[k] = g[WAY + k] / length(g + WAY) - way[k] / length(way);
        if (!(length(apart) <= way_limit) || !(fabs(g[PDF] / pdf - 1) <= pdf_limit))
            fail_msg("fp%d, shape %d of size %g at %g: way off by %g, density by %g", fp64 ? 64 : 32, what, row->size, row->distance, length(apart),
                     fabs(g[PDF] / pdf - 1));
        caught += !(fabs(g[PDF] * (1 + 2 * pdf_limit) / pdf - 1) <= pdf_limit);
    }
    assert_true(caught > CASES / 2);
}

static void shapes_agree_with_fp64(void **state) {
    (void)state;
    for (int fp64 = 0; fp64 < twins_count(); fp64++)
        for (int what = SPHERE; what <= RECTANGLE; what++)
            for (size_t i = 0; i < sizeof DISTANCES / sizeof DISTANCES[0]; i++) compare(&DISTANCES[i], what, fp64);
}

// ------------------------------------------------------------------------------------------------------- nasty places

enum { NEVER, ALWAYS, AT_TIMES };
struct place { const char *name; int what; double p[3], shape[9]; int seen; };

static const struct place PLACES[] = {
    {"C10: a sphere 1e4 radii away", SPHERE, {0, 0, 0}, {1, 0, 0, 1e-4f}, ALWAYS},
    {"a sphere 1e15 radii away", SPHERE, {0, 0, 0}, {1, 0, 0, 1e-15f}, ALWAYS},
    {"a sphere 1e30 radii away", SPHERE, {0, 0, 0}, {1, 0, 0, 1e-30f}, NEVER},
    {"the center of a sphere", SPHERE, {1, 2, 3}, {1, 2, 3, 0.5f}, ALWAYS},
    {"within a sphere", SPHERE, {0, 0, 0.75f}, {0, 0, 0, 1}, ALWAYS},
    {"on a sphere, where half of all ways lead out", SPHERE, {0, 0, 1}, {0, 0, 0, 1}, AT_TIMES},
    {"an ulp above a sphere", SPHERE, {0, 0, 1 + 0x1p-23}, {0, 0, 0, 1}, ALWAYS},
    {"below the south pole", SPHERE, {0, 0, 5}, {0, 0, 0, 1}, ALWAYS},
    {"over a triangle", TRIANGLE, {0.25f, 0.25f, 1e-6f}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, ALWAYS},
    {"in a triangle's plane, outside", TRIANGLE, {2, 2, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, NEVER},
    {"a corner", TRIANGLE, {1, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, NEVER},
    {"the first corner", TRIANGLE, {0, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, NEVER},
    {"next to a corner", TRIANGLE, {1e-7f, 1e-7f, 1e-7f}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, ALWAYS},
    {"no area", TRIANGLE, {0, 0, 1}, {0, 0, 0, 1, 0, 0, 0.5f, 0, 0}, NEVER},
    {"a point", TRIANGLE, {0, 0, 1}, {1, 1, 1, 1, 1, 1, 1, 1, 1}, NEVER},
    {"a triangle of 1e-10", TRIANGLE, {0, 0, 1}, {0, 0, 0, 1e-10f, 0, 0, 0, 1e-10f, 0}, ALWAYS},
    {"a triangle of 1e-25", TRIANGLE, {0, 0, 1}, {0, 0, 0, 1e-25f, 0, 0, 0, 1e-25f, 0}, NEVER},
    {"a needle", TRIANGLE, {0, 0, 1}, {0, 0, 0, 1, 0, 0, 1, 1e-6f, 0}, ALWAYS},
    {"a wall without end", TRIANGLE, {0, 0, 1}, {-1e6f, -1e6f, 0, 1e6f, -1e6f, 0, 0, 1e6f, 0}, ALWAYS},
    {"over a rectangle", RECTANGLE, {0.25f, 0.25f, 1e-6f}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, ALWAYS},
    {"over a rectangle's diagonal", RECTANGLE, {0.5f, 0.5f, 1e-3f}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, ALWAYS},
    {"in a rectangle's plane, outside", RECTANGLE, {2, 0.5f, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, NEVER},
};
#define PLACE_COUNT (sizeof PLACES / sizeof PLACES[0])

// How far the end of a way is from the shape, in its plane and off it: 0 for a point of it.
static double end_error(const double *c, const double *way) {
    double end[3], e1[3], e2[3], normal[3], across[3];
    for (int k = 0; k < 3; k++) end[k] = c[P + k] + way[k] - c[SHAPE + k];
    if (c[WHAT] == SPHERE) return fabs(length(end) - c[SHAPE + 3]);
    subtract(e1, c + SHAPE + 3, c + SHAPE);
    subtract(e2, c + SHAPE + 6, c + SHAPE);
    cross(normal, e1, e2);
    const double area2 = dot(normal, normal);
    cross(across, end, e2);
    const double u = dot(across, normal) / area2;
    cross(across, e1, end);
    const double v = dot(across, normal) / area2;
    const double outside = fmax(fmax(-u, -v), c[WHAT] == TRIANGLE ? u + v - 1 : fmax(u, v) - 1);
    return fmax(fabs(dot(end, normal)) / sqrt(area2), fmax(0, outside) * fmax(length(e1), length(e2)));
}

// All u, with the largest (C06), from all places: numbers, and ways that end on the light (O08): off by no more than a few ulp of the coordinates.
static void nasty_places(void **state) {
    (void)state;
    enum { EACH = 64 };
    static const float ENDS[] = {0, 0x1p-24f, 0.5f, (float)LAST_U};
    for (size_t i = 0; i < PLACE_COUNT; i++) {
        for (int k = 0; k < EACH; k++) {
            double *c = given[EACH * i + k];
            c[WHAT] = PLACES[i].what;
            memcpy(c + P, PLACES[i].p, sizeof PLACES[i].p);
            memcpy(c + SHAPE, PLACES[i].shape, sizeof PLACES[i].shape);
            c[U] = k < 16 ? ENDS[k / 4] : random_u();
            c[U + 1] = k < 16 ? ENDS[k % 4] : random_u();
        }
    }
    twins_run(&LIGHT, false, given[0], got[0], EACH * PLACE_COUNT);
    int worse = 0;
    for (size_t i = 0; i < EACH * PLACE_COUNT; i++) {
        const double *c = given[i], *g = got[i];
        const struct place *place = &PLACES[i / EACH];
        double largest = 0;
        for (int k = 1; k < U; k++) largest = fmax(largest, fabs(c[k]));
        if (place->seen != AT_TIMES && g[SEEN] != place->seen && (place->seen == NEVER || i % EACH >= 16)) fail_msg("%s: seen is %g for %g, %g", place->name, g[SEEN], c[U], c[U + 1]);
        if (!(g[PDF] >= 0 && g[PDF] <= FLT_MAX)) fail_msg("%s: the density is %g", place->name, g[PDF]);
        if (g[SEEN] != 1) continue;
        const double off = end_error(c, g + WAY);
        if (!(g[PDF] > 0 && length(g + WAY) > 0)) fail_msg("%s: density %g, way of length %g", place->name, g[PDF], length(g + WAY));
        if (!(off <= 16 * 0x1p-24 * largest)) fail_msg("%s: the end of the way is off by %g for %g, %g", place->name, off, c[U], c[U + 1]);
        worse += off > 0x1p-29 * largest;
    }
    assert_true(worse > 0); // the control: ends are not all exact, so that the limit can fail
}

// The density at C10 and its neighbours: 1/(2π(1 - cos)) is right to 2^-20, where the plain difference has nothing left.
static void small_spheres_keep_their_density(void **state) {
    (void)state;
    int plain_fails = 0, count = 0;
    for (double radius = 1; radius > 1e-15; radius *= 0.5, count++) {
        const double c[IN] = {SPHERE, 0, 0, 0, 2, 0, 0, radius};
        memcpy(given[count], c, sizeof c);
    }
    twins_run(&LIGHT, false, given[0], got[0], (uint32_t)count);
    for (int i = 0; i < count; i++) {
        const double x = given[i][SHAPE + 3] / 2, right = (1 + sqrt(1 - x * x)) / (2 * PI * x * x);
        const float cosine = sqrtf(1 - (float)(x * x));
        plain_fails += !(fabs(1 / (2 * PI * (1 - cosine)) / right - 1) <= 0x1p-20);
        assert_true(fabs(got[i][PDF] / right - 1) <= 0x1p-20);
    }
    assert_true(plain_fails > count / 2);
}

// --------------------------------------------------------------------------------------------------------- chi-squared

enum { SIDE = 8, CELLS = SIDE * SIDE, DRAWS = CASES };

// The solid angle of [0, x] × [0, y] at height 1, from below the origin.
static double corner_angle(double x, double y) { return atan(x * y / sqrt(x * x + y * y + 1)); }

// By A. Girard: the sum of the angles less π. Angles between the planes of the sides.
static double triangle_angle(const double v[3][3]) {
    double sum = -PI, normal[3][3];
    for (int k = 0; k < 3; k++) cross(normal[k], v[k], v[(k + 1) % 3]);
    for (int k = 0; k < 3; k++) sum += PI - acos(dot(normal[k], normal[(k + 1) % 3]) / (length(normal[k]) * length(normal[(k + 1) % 3])));
    return sum;
}

// A light seen from the origin, as cells: the share of the solid angle of each, and of what the control takes for it.
struct cells { const char *name; int what; double shape[9]; };

static const struct cells CELLED[] = {
    {"sphere", SPHERE, {0.3, -0.4, 1, 0.7}},          {"sphere from inside", SPHERE, {0.3, 0.1, 0.2, 1}},
    {"triangle", TRIANGLE, {-1, -0.5, 1, 2, -0.5, 1, 0, 1.5, 1}}, {"near triangle", TRIANGLE, {-8, -5, 1, 20, -5, 1, 0, 15, 1}},
    {"rectangle", RECTANGLE, {-1, -0.5, 1, 2, -0.5, 1, -1, 1.5, 1}}, {"near rectangle", RECTANGLE, {-10, -5, 1, 20, -5, 1, -10, 15, 1}},
};

// The corner i/SIDE along the first edge, k/SIDE along the second.
static void grid_point(double out[3], const double *shape, double i, double k) {
    for (int j = 0; j < 3; j++) out[j] = shape[j] + i / SIDE * (shape[3 + j] - shape[j]) + k / SIDE * (shape[6 + j] - shape[j]);
}

// Of a triangle or a rectangle cell (i, k) of the grid along its edges; in a triangle, what lies beyond the diagonal is not there, and cells on the diagonal are halves.
static double flat_angle(const struct cells *c, int i, int k) {
    if (c->what == RECTANGLE) { // at height 1, with edges along x and y
        double low[3], high[3];
        grid_point(low, c->shape, i, k);
        grid_point(high, c->shape, i + 1, k + 1);
        return corner_angle(high[0], high[1]) - corner_angle(low[0], high[1]) - corner_angle(high[0], low[1]) + corner_angle(low[0], low[1]);
    }
    if (i + k >= SIDE) return 0;
    double half[3][3];
    grid_point(half[0], c->shape, i, k);
    grid_point(half[1], c->shape, i + 1, k);
    grid_point(half[2], c->shape, i, k + 1);
    double angle = triangle_angle((const double(*)[3])half);
    if (i + k == SIDE - 1) return angle;
    grid_point(half[0], c->shape, i + 1, k + 1);
    return angle + triangle_angle((const double(*)[3])half);
}

static void expect(double share[CELLS], double control[CELLS], const struct cells *c) {
    double sum = 0, control_sum = 0;
    for (int i = 0; i < CELLS; i++) {
        const int row = i / SIDE, column = i % SIDE;
        share[i] = c->what == SPHERE ? 1 : flat_angle(c, row, column);
        // The control: a sphere's cone as if angles were even, flat shapes as if areas were.
        control[i] = c->what == SPHERE ? sin(0.5 * PI * (row + 0.5) / SIDE) : c->what == RECTANGLE || row + column < SIDE - 1 ? 2 : row + column == SIDE - 1 ? 1 : 0;
        sum += share[i];
        control_sum += control[i];
    }
    for (int i = 0; i < CELLS; i++) share[i] /= sum, control[i] /= control_sum;
}

// The cell where a way ends.
static int cell_of(const struct cells *c, const double way[3]) {
    double x, y;
    if (c->what == SPHERE) {
        const double distance = length(c->shape), radius = c->shape[3];
        const double axis[3] = {c->shape[0] / distance, c->shape[1] / distance, c->shape[2] / distance}, side[3] = {axis[1], -axis[0], 0};
        const double widest = distance > radius ? 1 - sqrt(1 - radius * radius / (distance * distance)) : 2;
        double other[3];
        cross(other, axis, side);
        x = (1 - dot(way, axis) / length(way)) / widest * SIDE;
        y = (atan2(dot(way, other), dot(way, side)) / (2 * PI) + 0.5) * SIDE;
    } else {
        x = (way[0] - c->shape[0]) / (c->shape[3] - c->shape[0]);
        y = (way[1] - c->shape[1]) / (c->shape[7] - c->shape[1]) * SIDE;
        // Edges lie along x and y, but for the third corner of a triangle, which is shifted in x.
        x = (way[0] - c->shape[0] - y / SIDE * (c->shape[6] - c->shape[0])) / (c->shape[3] - c->shape[0]) * SIDE;
    }
    return (int)fmin(SIDE - 1, fmax(0, floor(x))) * SIDE + (int)fmin(SIDE - 1, fmax(0, floor(y)));
}

// Pearson's sum over cells that expect 5 or more, and what it exceeds with a probability of 1e-6 (E. B. Wilson and M. M. Hilferty, 1931).
static bool is_likely(const uint32_t count[CELLS], const double share[CELLS]) {
    double sum = 0, rest = 0, rest_share = 0;
    int freedom = 0;
    for (int i = 0; i < CELLS; i++) {
        const double expected = share[i] * DRAWS;
        if (!(expected >= 5)) {
            rest += count[i];
            rest_share += expected;
            continue;
        }
        sum += (count[i] - expected) * (count[i] - expected) / expected;
        freedom++;
    }
    if (rest_share >= 5) sum += (rest - rest_share) * (rest - rest_share) / rest_share;
    else if (rest > 40) return false;
    const double spread = 2.0 / (9.0 * freedom), limit = freedom * pow(1 - spread + 4.753 * sqrt(spread), 3);
    return sum <= limit;
}

// The device's samples and the reference's fall into cells by their solid angle, and not as the control says.
static void samples_are_even(void **state) {
    (void)state;
    for (size_t row = 0; row < sizeof CELLED / sizeof CELLED[0]; row++) {
        const struct cells *c = &CELLED[row];
        double share[CELLS], control[CELLS];
        uint32_t device[CELLS] = {0}, reference[CELLS] = {0};
        expect(share, control, c);
        for (int i = 0; i < DRAWS; i++) {
            memset(given[i], 0, sizeof given[i]);
            given[i][WHAT] = c->what;
            memcpy(given[i] + SHAPE, c->shape, sizeof c->shape);
            given[i][U] = random_u();
            given[i][U + 1] = random_u();
        }
        twins_run(&LIGHT, false, given[0], got[0], DRAWS);
        for (int i = 0; i < DRAWS; i++) {
            double way[3], pdf;
            assert_true(got[i][SEEN] == 1 && reference_sample(way, &pdf, given[i]));
            device[cell_of(c, got[i] + WAY)]++;
            reference[cell_of(c, way)]++;
        }
        if (!is_likely(device, share) || !is_likely(reference, share)) fail_msg("%s: device %d, reference %d", c->name, is_likely(device, share), is_likely(reference, share));
        if (is_likely(device, control)) fail_msg("%s: the control is likely, too", c->name);
    }
}

// ---------------------------------------------------------------------------------------------------------- irradiance

// The irradiance at the origin, normal +z, from radiance 1. J. H. Lambert, "Photometria", 1760: of a polygon half the sum of the angles of its sides times the cosines
// of the sides' planes; of a sphere above the horizon π (r/d)² cos.
static double irradiance(const double *c) {
    double sum = 0, corner[4][3];
    if (c[WHAT] == SPHERE) {
        const double distance2 = dot(c + SHAPE, c + SHAPE), radius = c[SHAPE + 3];
        return radius * radius >= distance2 ? PI : PI * radius * radius / distance2 * c[SHAPE + 2] / sqrt(distance2);
    }
    const int corners = c[WHAT] == RECTANGLE ? 4 : 3;
    memcpy(corner[0], c + SHAPE, sizeof corner[0]);
    memcpy(corner[1], c + SHAPE + 3, sizeof corner[1]);
    for (int k = 0; k < 3; k++) {
        corner[2][k] = corners == 4 ? c[SHAPE + 3 + k] + c[SHAPE + 6 + k] - c[SHAPE + k] : c[SHAPE + 6 + k];
        corner[3][k] = c[SHAPE + 6 + k];
    }
    for (int k = 0; k < corners; k++) {
        double normal[3];
        cross(normal, corner[k], corner[(k + 1) % corners]);
        sum += 0.5 * atan2(length(normal), dot(corner[k], corner[(k + 1) % corners])) * normal[2] / length(normal);
    }
    return fabs(sum);
}

static const double SHINING[][9] = {
    {0.5, 0.3, 2, 0.5}, {0, 0, 1.001, 1}, {1, 1, 3, 1e-3}, {0.1, 0.2, 0.3, 1}, // spheres
    {-1, -1, 2, 1, -1, 2, 0, 1, 2}, {1, 0, 0.001, 2, 0, 0.001, 1, 1, 5}, {-20, -20, 0.3, 20, -20, 0.3, 0, 20, 0.3}, {3, 3, 3, 3.001, 3, 3, 3, 3.001, 3},
    {-1, -1, 2, 1, -1, 2, -1, 1, 2}, {1, -2, 0.001, 1, 2, 0.001, 1, -2, 3}, {-20, -20, 0.3, 20, -20, 0.3, -20, 20, 0.3}, {0, 0, 0.01, 1, 0, 0.01, 0, 1, 0.01},
};

// Samples on a grid of u in every shape give the light that arrives to 0.03 %; with a density that is wrong by 0.1 % they do not.
static void the_right_light_arrives(void **state) {
    (void)state;
    enum { GRID = 128 };
    for (size_t row = 0; row < sizeof SHINING / sizeof SHINING[0]; row++) {
        double device = 0, reference = 0;
        for (int i = 0; i < GRID * GRID; i++) {
            memset(given[i], 0, sizeof given[i]);
            given[i][WHAT] = row < 4 ? SPHERE : row < 8 ? TRIANGLE : RECTANGLE;
            memcpy(given[i] + SHAPE, SHINING[row], sizeof SHINING[row]);
            given[i][U] = (i / GRID + 0.5) / GRID;
            given[i][U + 1] = (i % GRID + 0.5) / GRID;
            for (int k = 0; k < IN; k++) given[i][k] = (float)given[i][k];
        }
        twins_run(&LIGHT, false, given[0], got[0], GRID * GRID);
        for (int i = 0; i < GRID * GRID; i++) {
            double way[3], pdf;
            assert_true(reference_sample(way, &pdf, given[i]));
            device += fmax(0, got[i][WAY + 2] / length(got[i] + WAY)) / got[i][PDF] / (GRID * GRID);
            reference += fmax(0, way[2] / length(way)) / pdf / (GRID * GRID);
        }
        const double right = irradiance(given[0]);
        if (!(fabs(reference / right - 1) <= 3e-4)) fail_msg("row %zu: the reference has %g, not %g", row, reference, right);
        if (!(fabs(device / right - 1) <= 3e-4)) fail_msg("row %zu: the device has %g, not %g", row, device, right);
        assert_false(fabs(device * 1.001 / right - 1) <= 3e-4);
    }
}

// --------------------------------------------------------------------------------------------------------------- spots

static void spots_end_at_their_cones(void **state) {
    (void)state;
    static const double CONES[][2] = {{0, 45}, {20, 30}, {0.001, 0.01}, {89, 90}, {30, 30}};
    int count = 0, inside = 0, outside = 0, between = 0;
    for (size_t row = 0; row < sizeof CONES / sizeof CONES[0]; row++) {
        for (int i = 0; i < 1024; i++, count++) {
            double *c = given[count], axis[3], across[3], tangent[3];
            const double inner = CONES[row][0] * PI / 180, outer = CONES[row][1] * PI / 180, angle = 1.5 * outer * i / 1024;
            random_direction(axis);
            random_direction(tangent);
            cross(across, axis, tangent);
            c[WHAT] = SPOT;
            for (int k = 0; k < 3; k++) {
                c[P + k] = (float)(cos(angle) * axis[k] + sin(angle) * across[k] / length(across));
                c[SHAPE + k] = (float)axis[k];
            }
            c[SHAPE + 3] = 2 * sin(outer / 2) * sin(outer / 2);
            c[SHAPE + 4] = inner < outer ? 1 / (2 * sin(outer / 2) * sin(outer / 2) - 2 * sin(inner / 2) * sin(inner / 2)) : 1e30;
        }
    }
    twins_run(&LIGHT, false, given[0], got[0], (uint32_t)count);
    for (int i = 0; i < count; i++) {
        const double inner = CONES[i / 1024][0] * PI / 180, outer = CONES[i / 1024][1] * PI / 180;
        double apart[3];
        subtract(apart, given[i] + P, given[i] + SHAPE);
        const double angle = 2 * asin(length(apart) / 2), cosine = (cos(angle) - cos(outer)) / (cos(inner) - cos(outer));
        const double share = inner < outer ? pow(fmin(1, fmax(0, cosine)), 2) : angle < outer;
        const double edge = fmin(fabs(angle - inner), fabs(angle - outer));
        if (inner >= outer && edge < 1e-6) continue;
        if (!(fabs(got[i][PDF] - share) <= 1e-4)) fail_msg("cone %g to %g at %g: %g, not %g", inner, outer, angle, got[i][PDF], share);
        inside += got[i][PDF] == 1;
        outside += got[i][PDF] == 0;
        between += fabs(got[i][PDF] * 1.01 - share) > 1e-4; // what a wrong share would show
    }
    assert_true(inside > 256 && outside > 1024 && between > 1024);
}

// ------------------------------------------------------------------------------------------------------------- scenes

// Two triangles of an area of 6 and one of 2, of which material "b" has the last two; a needle without area; "c" does not emit.
#define MESH                                                                                                                               \
    "mtllib m.mtl\nv 0 0 4\nv 4 0 4\nv 0 3 4\nv 4 3 4\nv 8 0 4\nv 6 1 4\nusemtl a\nf 1 2 3\nusemtl b\nf 2 4 3\nf 2 5 6\nf 1 1 2\n"         \
    "usemtl c\nf 4 5 6\n"
#define LIBRARY "newmtl a\nnewmtl b\nnewmtl c\n"
#define SCENE                                                                                                                              \
    "{\"version\": 1, \"materials\": {\"glow\": {\"emission\": [3,2,1]}, \"plain\": {}, \"holes\": {\"emission\": [1,1,1], \"alpha_mode\": \"mask\"}},"         \
    "\"lights\": [{\"type\": \"point\", \"position\": [-10,10,4], \"intensity\": [0.8,0.7,0.6]},"                                          \
    "{\"type\": \"point\", \"position\": [1,2,30], \"intensity\": [8,7,6], \"falloff\": \"inverse_square\"},"                              \
    "{\"type\": \"directional\", \"direction\": [0,-2,1], \"intensity\": [1,2,3]},"                                                        \
    "{\"type\": \"spot\", \"position\": [0,0,9], \"direction\": [0,0,-2], \"inner_deg\": 5, \"outer_deg\": 60, \"falloff\": \"inverse_square\"}]," \
    "\"shapes\": [{\"type\": \"sphere\", \"center\": [5,5,5], \"radius\": 1, \"material\": \"glow\"},"                                     \
    "{\"type\": \"triangle\", \"vertices\": [[0,0,7],[1,0,7],[0,2,8]], \"material\": \"glow\"},"                                           \
    "{\"type\": \"rectangle\", \"corner\": [-3,0,6], \"edges\": [[0,2,0],[1,0,0]], \"material\": \"glow\"},"                               \
    "{\"type\": \"mesh\", \"file\": \"m.obj\"},"                                                                                           \
    "{\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 9, \"material\": \"plain\"},"                                                 \
    "{\"type\": \"sphere\", \"center\": [0,9,0], \"radius\": 1, \"material\": \"glow\", \"motion\": [1,0,0]},"                             \
    "{\"type\": \"sphere\", \"center\": [0,9,0], \"radius\": 1, \"material\": \"holes\"},"                                                 \
    "{\"type\": \"triangle\", \"vertices\": [[0,0,7],[1,0,7],[2,0,7]], \"material\": \"glow\"}]}"

#define FIRST_AREA 4u
#define MESH_NUMBER 7u
#define EFFECTS_HERE                                                                                                                       \
    (uint32_t)(EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_BVH | EFFECT_DIFFUSE | EFFECT_DIRECTIONAL | EFFECT_SPOT | EFFECT_EMISSION | EFFECT_SOFT_SHADOWS)

static void emit(struct scene *scene, const char *name, float r, float g, float b) {
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (strcmp(scene->materials[i].name, name) == 0) memcpy(scene->materials[i].emission, (float[3]){r, g, b}, 3 * sizeof(float));
}

// The scene, with a mesh whose materials emit: such a file cannot say that yet.
static struct scene load(void) {
    struct scene scene;
    scratch_file("m.obj", MESH, strlen(MESH));
    scratch_file("m.mtl", LIBRARY, strlen(LIBRARY));
    scratch_assert(scene_load(&scene, scratch_context(), scratch_file("a.json", SCENE, strlen(SCENE))));
    assert_int_equal(scene.light_count, FIRST_AREA + 3);
    scene.light_count = FIRST_AREA;
    emit(&scene, "a", 1, 1, 1);
    emit(&scene, "b", 2, 2, 2);
    scratch_assert(scene_area_lights(&scene, scratch_context()));
    return scene;
}

// Shapes that emit evenly from some area and stand still; others are no lights.
static void shapes_become_lights(void **state) {
    (void)state;
    struct scene scene = load();
    assert_int_equal(scene.light_count, FIRST_AREA + 4);
    for (uint32_t i = 0; i < scene.shape_count; i++) assert_int_equal(scene_light_of(&scene, i), i < 4 ? FIRST_AREA + i : NO_LIGHT_NUMBER);
    for (uint32_t i = 0; i < 4; i++) {
        const struct scene_light *light = &scene.lights[FIRST_AREA + i];
        assert_true(light->type == LIGHT_AREA && light->shape == i);
        assert_true(light->intensity[0] == (i == 3 ? 2 : 3) && light->intensity[2] == (i == 3 ? 2 : 1));
    }
    assert_true(scene.lights[FIRST_AREA].position[0] == 5);
    scene_finish(&scene);
}

// What has a kind depends on what runs; a mesh's triangles are chosen by area × luminance, with exactly the probability that is said (C07).
static void tables_say_what_lights_are(void **state) {
    (void)state;
    static const uint32_t KINDS[] = {POINT_LIGHT, POINT_LIGHT, DIRECTIONAL_LIGHT, SPOT_LIGHT, SPHERE_LIGHT, TRIANGLE_LIGHT, RECTANGLE_LIGHT, MESH_LIGHT};
    struct scene scene = load();
    struct light_table table;
    for (int lacking = -1; lacking < EFFECT_COUNT; lacking++) {
        scratch_assert(light_table_init(&table, scratch_context(), &scene, lacking < 0 ? EFFECTS_HERE : EFFECTS_HERE & ~(1u << lacking)));
        const uint32_t lack = lacking < 0 ? 0 : 1u << lacking;
        for (uint32_t i = 0; i < scene.light_count; i++) {
            const bool sized = i >= FIRST_AREA, sphere = i == FIRST_AREA;
            const bool absent = (lack == EFFECT_DIRECTIONAL && i == 2) || (lack == EFFECT_SPOT && i == 3) || (lack == EFFECT_SOFT_SHADOWS && sized) ||
                                (lack == EFFECT_SPHERES && sphere) || (lack == EFFECT_TRIANGLES && sized && !sphere);
            assert_int_equal(table.kind[i], absent ? ABSENT_LIGHT : KINDS[i]);
        }
        light_table_finish(&table);
    }
    scratch_assert(light_table_init(&table, scratch_context(), &scene, EFFECTS_HERE));
    assert_int_equal(table.first[scene.light_count], 3);
    static const double POWERS[] = {6, 12, 4};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const struct emitter *e = &table.emitters[i];
        assert_true(fabs(e->probability - POWERS[i] / 22) <= 4 * 0x1p-24);
        assert_ptr_equal(emitter_chosen(&table, MESH_NUMBER, (float)sum), e);
        sum += e->probability;
        assert_true(e->cdf == (float)sum);
        assert_ptr_equal(emitter_chosen(&table, MESH_NUMBER, (float)(sum - 0x1p-24)), e);
        assert_ptr_equal(emitter_of(&table, MESH_NUMBER, e->primitive), e);
    }
    assert_true(sum == 1);
    for (uint32_t i = 3; i < 6; i++) assert_null(emitter_of(&table, MESH_NUMBER, i));
    light_table_finish(&table);
    scene_finish(&scene);
}

enum { LIGHT_NUMBER, POINT, UNIT = 4, NUMBERS, CHOICE = 7, TRIANGLE_NUMBER, TABLE_IN };
enum { VISIBLE, TO_LIGHT, RADIANCE = 4, DENSITY = 7, OBJECT, INDEX, ENDLESS, DENSITY_OF, TABLE_OUT };

static void make_question(double *c, const struct device_scene *ds, uint32_t light) {
    float p[3], device[3];
    for (int k = 0; k < 3; k++) p[k] = (float)random_in(-2, 6);
    p[2] = (float)random_in(-4, 3);
    device_point(device, ds, p);
    c[LIGHT_NUMBER] = light;
    for (int k = 0; k < 3; k++) c[POINT + k] = device[k];
    c[UNIT] = 1 / (double)ds->scale;
    for (int k = 0; k < 3; k++) c[NUMBERS + k] = random_u();
    c[TRIANGLE_NUMBER] = light == MESH_NUMBER ? (int)(random_bits() % 5) : 0;
}

// What the device says of a light is what the reference says; in scene units.
static void judge(const double *c, const double *g, const struct device_scene *ds, const struct ref_lights *lights, bool fp64) {
    const double limit = fp64 ? 2e-6 : 4e-5; // of p and of the records, fp32 in both
    double p[3];
    const float u[2] = {(float)c[NUMBERS], (float)c[NUMBERS + 1]};
    struct ref_light_sample r;
    for (int k = 0; k < 3; k++) p[k] = c[POINT + k] / ds->scale + ds->base[k];
    const uint32_t light = (uint32_t)c[LIGHT_NUMBER];
    const bool seen = ref_light_sample(&r, lights, light, p, u, (float)c[CHOICE]);
    assert_int_equal(seen, g[VISIBLE] == 1);
    const double density = ref_light_pdf(lights, light, p, (uint32_t)c[TRIANGLE_NUMBER]);
    if (!(fabs(g[DENSITY_OF] - density) <= limit * density)) fail_msg("light %u: density %g, not %g", light, g[DENSITY_OF], density);
    if (!seen) return;
    const double scale = r.infinite ? 1 : ds->scale;
    for (int k = 0; k < 3; k++) {
        if (!(fabs(g[TO_LIGHT + k] / scale - r.way[k]) <= limit * fmax(1, length(r.way)))) fail_msg("light %u: the way is off by %g", light, g[TO_LIGHT + k] / scale - r.way[k]);
        if (!(fabs(g[RADIANCE + k] - r.radiance[k]) <= limit * r.radiance[k])) fail_msg("light %u: %g, not %g", light, g[RADIANCE + k], r.radiance[k]);
    }
    assert_true(fabs(g[DENSITY] - r.pdf) <= limit * r.pdf && (g[ENDLESS] == 1) == r.infinite);
    assert_true(g[OBJECT] == (r.target.there ? (double)r.target.object : -1) && g[INDEX] == (r.target.there ? r.target.index : -1));
}

static void device_knows_lights(void **state) {
    (void)state;
    static double questions[CASES][TABLE_IN], answers[CASES][TABLE_OUT];
    struct scene scene = load();
    struct bvh bvh;
    struct device_scene ds;
    struct ref_lights lights;
    fixture_assert(bvh_build_scene(&bvh, fixture_context(), &scene));
    fixture_assert(device_scene_init(&ds, fixture_context(), fixture_device(), &scene, &bvh, EFFECTS_HERE, NULL, true));
    fixture_assert(ref_lights_init(&lights, fixture_context(), &scene, EFFECTS_HERE));
    const struct kernel_binding bindings[] = {{BINDING_LIGHTS, &ds.lights, NULL}, {BINDING_EMITTERS, &ds.emitters, NULL}};
    const struct twins table = {TWINS(twin_light_table), .in = TABLE_IN, .out = TABLE_OUT, .bindings = bindings, .binding_count = 2};
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        int seen = 0, unlike = 0;
        for (uint32_t i = 0; i < CASES; i++) make_question(questions[i], &ds, i % scene.light_count);
        twins_run(&table, fp64, questions[0], answers[0], CASES);
        for (int i = 0; i < CASES; i++) {
            judge(questions[i], answers[i], &ds, &lights, fp64);
            seen += answers[i][VISIBLE] == 1;
            unlike += answers[i][DENSITY] > 0 && answers[i][DENSITY] != answers[i][DENSITY_OF];
        }
        assert_true(seen > CASES * 3 / 4 && unlike > 0);
    }
    ref_lights_finish(&lights);
    device_scene_finish(&ds, fixture_device());
    bvh_finish(&bvh);
    scene_finish(&scene);
}

static int open_all(void **state) { return scratch_open(state); }
static int close_all(void **state) { return scratch_close(state) | fixture_close(state); }

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_agree_with_fp64),     cmocka_unit_test(nasty_places),      cmocka_unit_test(small_spheres_keep_their_density),
        cmocka_unit_test(samples_are_even),           cmocka_unit_test(the_right_light_arrives), cmocka_unit_test(spots_end_at_their_cones),
        cmocka_unit_test(shapes_become_lights),       cmocka_unit_test(tables_say_what_lights_are), cmocka_unit_test(device_knows_lights),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
