// Fog: the shaders' fp32 and fp64 against the reference; samples against densities; numbers that are known; the ball that it fills.
#include "twins.h"

#include "chi_squared.h"
#include "reference/fog.h"
#include "reference/vector.h"
#include "twin_fog.h"
#include "twin_fog_fp64.h"

#define CASES 8192
#define PI 3.14159265358979323846
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const struct twins fog = {TWINS(twin_fog), .in = 9, .out = 7};

// As the kernel reads and writes them.
struct given { double density, way, cosine, g, u[2], direction[3]; };
struct told { double transmittance, distance, phase, scattered[3], pdf; };

static float random_unit(void) { return (float)(random_bits() >> 8) * 0x1p-24f; }

// Numbers that fp32 holds, so that both kernels see the same ones.
static struct given random_given(void) {
    static const double anisotropies[] = {0, 0x1p-149, 1e-9, -1e-6, 0.3, -0.7, 0.95, 0.9999, -0.9999};
    struct given given = {.density = (float)exp(random_in(-20, 10)), .cosine = (float)random_in(-1, 1), .u = {random_unit(), random_unit()}};
    given.way = (float)(random_in(0, 20) / given.density);
    given.g = random_bits() % 2 ? (float)random_in(-0.99, 0.99) : (float)anisotropies[random_bits() % COUNT(anisotropies)];
    random_direction(given.direction);
    for (int i = 0; i < 3; i++) given.direction[i] = (float)given.direction[i];
    return given;
}

static struct given given_cases[CASES];
static struct told told[CASES];

static void run(int kernel, uint32_t count) { twins_run(&fog, kernel, (const double *)given_cases, (double *)told, count); }

// Whether the share of `right` that is missing is within the limit.
static bool near_to(double got, double right, double limit) { return fabs(got - right) <= limit * fabs(right); }

// ------------------------------------------------------------------------------------------------------------- against fp64

static void check_case(const struct given *g, const struct told *t, double unit, int *caught) {
    const double depth = g->density * g->way, transmittance = ref_fog_transmittance(g->density, g->way);
    if (!near_to(t->transmittance, transmittance, (4 + depth) * unit)) fail_msg("transmittance at %g: %g, expected %g", depth, t->transmittance, transmittance);
    const double distance = ref_fog_distance(g->density, (float)g->u[0]);
    if (!near_to(t->distance, distance, 8 * unit)) fail_msg("distance at %g: %g, expected %g", g->u[0], t->distance, distance);
    const double phase = ref_fog_phase(g->cosine, g->g);
    if (!near_to(t->phase, phase, 32 * unit)) fail_msg("phase at %g, %g: %g, expected %g", g->cosine, g->g, t->phase, phase);
    double scattered[3], pdf;
    ref_fog_sample(scattered, &pdf, g->direction, g->g, (const float[]){(float)g->u[0], (float)g->u[1]});
    for (int i = 0; i < 3; i++)
        if (!(fabs(t->scattered[i] - scattered[i]) <= 1e-7 + 16 * unit)) // directions that fp32 holds are not quite unit
            fail_msg("scattered at g = %g, u = %g, %g: %g, expected %g", g->g, g->u[0], g->u[1], t->scattered[i], scattered[i]);
    if (!near_to(t->pdf, pdf, 1e-7 + 32 * unit)) fail_msg("density at g = %g, u = %g: %g, expected %g", g->g, g->u[0], t->pdf, pdf);
    *caught += !near_to(t->phase, ref_fog_phase(g->cosine, 0.98 * g->g + 0.01), 32 * unit) && !near_to(t->transmittance, transmittance * 1.0001, (4 + depth) * unit);
}

static void shaders_are_the_reference(void **state) {
    (void)state;
    for (int kernel = 0; kernel < twins_count(); kernel++) {
        int caught = 0;
        for (int i = 0; i < CASES; i++) given_cases[i] = random_given();
        run(kernel, CASES);
        for (int i = 0; i < CASES; i++) check_case(&given_cases[i], &told[i], kernel ? 0x1p-52 : 0x1p-23, &caught);
        assert_true(caught > CASES * 9 / 10);
    }
}

// ------------------------------------------------------------------------------------------------------------------ hard cases

// R10, g at its ends and random numbers at theirs: numbers, unit directions, densities that are not 0.
static void nothing_is_nan(void **state) {
    (void)state;
    static const double anisotropies[] = {-1, -1 + 0x1p-24, -0.5, -1e-30, 0, 0x1p-149, 1e-8, 0.5, 1 - 0x1p-24, 1};
    static const float numbers[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
    static const double densities[] = {0, 0x1p-149, 1e-30, 1, 1e30}, ways[] = {0, 1e-30, 1, 1e30, INFINITY}, cosines[] = {-1 - 0x1p-23, -1, 0, 1, 1 + 0x1p-23};
    uint32_t count = 0;
    for (size_t a = 0; a < COUNT(anisotropies); a++)
        for (size_t u = 0; u < COUNT(numbers) * COUNT(numbers); u++)
            for (size_t d = 0; d < 25; d++)
                given_cases[count++] = (struct given){densities[d / 5], ways[d % 5], cosines[(u + d) % 5], anisotropies[a], {numbers[u / 4], numbers[u % 4]}, {0, d % 2 ? 1 : 0, d % 2 ? 0 : -1}};
    for (int kernel = 0; kernel < twins_count(); kernel++) {
        run(kernel, count);
        for (uint32_t i = 0; i < count; i++) {
            const struct given *g = &given_cases[i];
            const struct told *t = &told[i];
            const bool fine = t->transmittance >= 0 && t->transmittance <= 1 && t->distance >= 0 && t->phase > 0 && isfinite(t->phase) && t->pdf > 0 && isfinite(t->pdf) &&
                              fabs(vector_dot(t->scattered, t->scattered) - 1) <= 1e-6;
            if (!fine)
                fail_msg("density %g, way %g, cosine %a, g %a, u %a, %a: %g, %g, %g, density %g, length² %g", g->density, g->way, g->cosine, g->g, g->u[0], g->u[1],
                         t->transmittance, t->distance, t->phase, t->pdf, vector_dot(t->scattered, t->scattered));
            if (g->density == 0) assert_true(t->transmittance == 1 && isinf(t->distance));
            if (g->density >= 1e-30 && isinf(g->way)) assert_true(t->transmittance == 0);
        }
    }
}

// --------------------------------------------------------------------------------------------------------------------- samples

#define RINGS 16
#define SECTORS 8

// What the phase function makes one expect of `count` samples in cells of equal steps in the angle's cosine and around.
static void expect(double cells[RINGS * SECTORS], double g, double count) {
    enum { STEPS = 4000 };
    for (int i = 0; i < RINGS; i++) {
        double sum = 0;
        for (int k = 0; k < STEPS; k++) sum += ref_fog_phase(-1 + 2.0 * (i + (k + 0.5) / STEPS) / RINGS, g);
        for (int k = 0; k < SECTORS; k++) cells[i * SECTORS + k] = count * sum / STEPS * 2.0 / RINGS * 2 * PI / SECTORS;
    }
}

static const double ANISOTROPIES[] = {0, 1e-7, -1e-3, 0.4, -0.8, 0.93};

// Chances of Pearson's test, and mean and square of the cosine, which is g and (1 + 2g²)/3; a phase function that is a little off, and a mean, are the control.
static void samples_are_the_phase_function(void **state) {
    (void)state;
    for (size_t a = 0; a < COUNT(ANISOTROPIES); a++) {
        const double g = (float)ANISOTROPIES[a];
        static double counts[RINGS * SECTORS], expected[RINGS * SECTORS], wrong[RINGS * SECTORS];
        double mean = 0, square = 0, total = 0;
        memset(counts, 0, sizeof counts);
        for (int round = 0; round < 8; round++) {
            for (int i = 0; i < CASES; i++) given_cases[i] = (struct given){.g = g, .u = {random_unit(), random_unit()}, .direction = {0, 0, 1}};
            run(0, CASES);
            for (int i = 0; i < CASES; i++) {
                const double *w = told[i].scattered, turn = atan2(w[1], w[0]) / (2 * PI) + 0.5;
                const int ring = (int)fmin(0.5 * (w[2] + 1) * RINGS, RINGS - 1), sector = (int)fmin(turn * SECTORS, SECTORS - 1);
                counts[ring * SECTORS + sector]++;
                mean += w[2];
                square += w[2] * w[2];
                if (!near_to(told[i].pdf, ref_fog_phase(w[2], g), 1e-3)) fail_msg("g = %g: density %g at %g, expected %g", g, told[i].pdf, w[2], ref_fog_phase(w[2], g));
            }
            total += CASES;
        }
        expect(expected, g, total);
        expect(wrong, g > 0 ? g - 0.03 : g + 0.03, total);
        const double chance = chi_squared_chance(counts, expected, RINGS * SECTORS), control = chi_squared_chance(counts, wrong, RINGS * SECTORS);
        if (!(chance > 1e-4 / COUNT(ANISOTROPIES))) fail_msg("g = %g: a chance of %g", g, chance);
        if (!(control < 1e-4 / COUNT(ANISOTROPIES))) fail_msg("g = %g: what is off has a chance of %g", g, control);
        const double deviation = sqrt((1 + 2 * g * g) / 3 - g * g) / sqrt(total);
        if (!(fabs(mean / total - g) <= 4.5 * deviation)) fail_msg("g = %g: the mean is %g", g, mean / total);
        assert_true(fabs(mean / total - (g + 0.03)) > 4.5 * deviation);
        assert_true(fabs(square / total - (1 + 2 * g * g) / 3) <= 4.5 / sqrt(total));
    }
}

// The phase function's integral is 1, and the mean of its cosine g.
static void phase_is_a_density(void **state) {
    (void)state;
    enum { STEPS = 200000 };
    for (size_t a = 0; a < COUNT(ANISOTROPIES); a++) {
        double sum = 0, mean = 0;
        for (int k = 0; k < STEPS; k++) {
            const double cosine = -1 + (k + 0.5) * 2 / STEPS, density = ref_fog_phase(cosine, ANISOTROPIES[a]) * 2 * PI * 2 / STEPS;
            sum += density;
            mean += cosine * density;
        }
        if (!(fabs(sum - 1) <= 1e-6 && fabs(mean - ANISOTROPIES[a]) <= 1e-6)) fail_msg("g = %g: the integral is %g, the mean %g", ANISOTROPIES[a], sum, mean);
    }
}

// Free paths: mean and mean square of an exponential distribution, and as many longer than a way as light comes through it.
static void free_paths_are_exponential(void **state) {
    (void)state;
    const double density = 0.25, way = 3;
    for (int kernel = 0; kernel < twins_count(); kernel++) {
        for (int i = 0; i < CASES; i++) given_cases[i] = (struct given){.density = density, .way = way, .u = {(i + 0.5) / CASES, 0}, .direction = {0, 0, 1}};
        run(kernel, CASES);
        double mean = 0, square = 0, longer = 0;
        for (int i = 0; i < CASES; i++) {
            mean += told[i].distance / CASES;
            square += told[i].distance * told[i].distance / CASES;
            longer += (told[i].distance > way) / (double)CASES;
        }
        assert_true(near_to(mean, 1 / density, 1e-3) && near_to(square, 2 / (density * density), 5e-3));
        assert_false(near_to(mean, 1.01 / density, 1e-3));
        assert_true(fabs(longer - told[0].transmittance) <= 1.5 / CASES);
        assert_true(fabs(told[0].transmittance - exp(-0.75)) <= 1e-6);
    }
}

// ------------------------------------------------------------------------------------------------------------------------ ball

// A ray from the origin, and how much of it is in a ball around (0, 0, 4) of radius 2.
static const struct {
    const char *name;
    double origin[3], way[3], end, length;
} RAYS[] = {
    {"through the middle", {0, 0, 0}, {0, 0, 1}, INFINITY, 4},
    {"ends in the middle", {0, 0, 0}, {0, 0, 1}, 4, 2},
    {"ends before it", {0, 0, 0}, {0, 0, 1}, 1, 0},
    {"away from it", {0, 0, 0}, {0, 0, -1}, INFINITY, 0},
    {"beside it", {0, 3, 0}, {0, 0, 1}, INFINITY, 0},
    {"a tangent", {0, 2, 0}, {0, 0, 1}, INFINITY, 0},
    {"from within", {0, 0, 4}, {0.6, 0.8, 0}, INFINITY, 2},
    {"from within, not far", {0, 0, 4}, {0.6, 0.8, 0}, 0.5, 0.5},
    {"off the middle", {1.2, 0, 0}, {0, 0, 1}, INFINITY, 3.2},
};

static void ball_is_what_is_filled(void **state) {
    (void)state;
    const struct ref_fog ball = {.ball = {{0, 0, 4}, 2}, .density = 0.5};
    for (size_t i = 0; i < COUNT(RAYS); i++) {
        const double through = ref_fog_lets_through(&ball, RAYS[i].origin, RAYS[i].way, RAYS[i].end), right = exp(-0.5 * RAYS[i].length);
        if (!(fabs(through - right) <= 1e-12)) fail_msg("%s: %g comes through, expected %g", RAYS[i].name, through, right);
        int scattered = 0;
        for (int k = 0; k < 4096; k++) {
            double distance;
            if (!ref_fog_scatters(&distance, &ball, RAYS[i].origin, RAYS[i].way, RAYS[i].end, (float)k / 4096)) continue;
            scattered++;
            double square = 0;
            for (int j = 0; j < 3; j++) square += pow(RAYS[i].origin[j] + distance * RAYS[i].way[j] - ball.ball.center[j], 2);
            if (!(square <= 4 + 1e-12 && distance <= RAYS[i].end)) fail_msg("%s: scattered at %g, outside", RAYS[i].name, distance);
        }
        if (!(fabs(scattered / 4096.0 - (1 - right)) <= 1.0 / 4096)) fail_msg("%s: a share of %g is scattered", RAYS[i].name, scattered / 4096.0);
    }
}

// Shapes and camera are in the ball.
static void ball_holds_the_scene(void **state) {
    (void)state;
    struct scene scene = {.camera = {.position = {0, 0, 9}, .lens_radius = 0.5f}, .bounds_min = {-1, -2, -3}, .bounds_max = {1, 2, 3}};
    struct fog_ball ball = scene_fog_ball(&scene);
    assert_true(ball.center[0] == 0 && ball.center[1] == 0 && ball.center[2] == 0);
    assert_true(ball.radius >= 9.5 && ball.radius <= 9.51);
    scene.camera.position[2] = 0;
    assert_true(scene_fog_ball(&scene).radius >= sqrt(14) && scene_fog_ball(&scene).radius <= 1.001 * sqrt(14));
    scene.camera.moves = true;
    scene.camera.position_end[0] = 20;
    assert_true(scene_fog_ball(&scene).radius >= 20);
    scene.bounds_min[1] = 3; // no shapes
    assert_true(isfinite(scene_fog_ball(&scene).radius));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_are_the_reference),
        cmocka_unit_test(nothing_is_nan),
        cmocka_unit_test(samples_are_the_phase_function),
        cmocka_unit_test(phase_is_a_density),
        cmocka_unit_test(free_paths_are_exponential),
        cmocka_unit_test(ball_is_what_is_filled),
        cmocka_unit_test(ball_holds_the_scene),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
