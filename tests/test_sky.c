// The environment: its tables, what it looks like and how it is sampled, on the device in fp32 and in fp64 and in the reference.
#include "twins.h"

#include "reference/environment.h"
#include "render/upload_sky.h"
#include "shaders/shared.h"
#include "twin_sky.h"
#include "twin_sky_fp64.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define CASES 16384
static const double PI = 3.14159265358979323846;

// Numbers in and out of an invocation.
struct sky_in {
    double way[3], u[2];
};
struct sky_out {
    double radiance[3], pdf, sampled[3], sampled_pdf, looked_up_pdf;
};

// ----------------------------------------------------------------------------------------------------------------- skies

enum look { CONSTANT, RANDOM, ONE_TEXEL, HALF_BLACK, SUN, EXTREME, BLACK, LOOKS };

struct kind {
    const char *name;
    enum look look;
    uint32_t width, height;
    float rotation_deg;
};

static const struct kind KINDS[] = {
    {"one texel", CONSTANT, 1, 1, 0},
    {"a constant", CONSTANT, 8, 4, 10},
    {"a row", RANDOM, 5, 1, 0},
    {"a column", RANDOM, 1, 6, 50},
    {"an odd size", RANDOM, 3, 5, -100},
    {"a power of two", RANDOM, 64, 32, 33.3f},
    {"one texel with light", ONE_TEXEL, 16, 8, 270},
    {"rows without light", HALF_BLACK, 12, 7, 3600.5f},
    {"a sun", SUN, 32, 16, 1},
    {"the largest numbers beside the smallest", EXTREME, 32, 16, 0},
    {"no light", BLACK, 9, 4, 0},
};

static float value_of(enum look look, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    float noise = (float)random_in(0, 1);
    switch (look) {
    case CONSTANT:
        return 2;
    case RANDOM:
        return noise * noise * noise;
    case ONE_TEXEL:
        return x == 5 && y == 2 ? 100.0f : 0.0f;
    case HALF_BLACK:
        return y < height / 2 ? 0 : noise;
    case SUN:
        return x == width / 3 && y == height / 4 ? 1000 : 0.2f + noise;
    case EXTREME:
        return x == 7 && y == 3 ? 3e38f : x == 20 ? 1e-30f : noise;
    default:
        return 0;
    }
}

static void make_environment(struct scene *scene, const struct kind *kind) {
    *scene = (struct scene){.environment = {.width = kind->width, .height = kind->height, .scale = 1, .rotation_deg = kind->rotation_deg}};
    size_t count = (size_t)kind->width * kind->height;
    scene->environment.texels = malloc(3 * count * sizeof(float));
    assert_non_null(scene->environment.texels);
    for (size_t i = 0; i < count; i++) {
        float value = value_of(kind->look, (uint32_t)(i % kind->width), (uint32_t)(i / kind->width), kind->width, kind->height);
        float *texel = &scene->environment.texels[3 * i];
        texel[0] = value, texel[1] = kind->look == RANDOM ? (float)random_in(0, 1) : value, texel[2] = value;
    }
}

static void run_sky(const struct scene *scene, bool fp64, const struct sky_in *in, struct sky_out *out, uint32_t count) {
    struct device_sky sky;
    struct kernel_binding bindings[DEVICE_SKY_BINDINGS];
    fixture_assert(device_sky_init(&sky, fixture_context(), fixture_device(), scene, EFFECT_ENVIRONMENT));
    device_sky_bindings(&sky, bindings);
    const struct twins twins = {TWINS(twin_sky), .in = sizeof *in / sizeof(double), .out = sizeof *out / sizeof(double),
                                .bindings = bindings, .binding_count = DEVICE_SKY_BINDINGS};
    twins_run(&twins, fp64, (const double *)in, (double *)out, count);
    device_sky_finish(&sky, fixture_device());
}

// The number of random bits that a sample gets.
static double random_unit(void) { return (random_bits() >> 8) * 0x1p-24; }

// What is done with each sky, on the device in fp32 and in fp64.
static void for_each_sky(void (*check)(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64)) {
    for (size_t i = 0; i < COUNT(KINDS); i++) {
        struct scene scene;
        struct sky sky;
        make_environment(&scene, &KINDS[i]);
        fixture_assert(sky_init(&sky, fixture_context(), &scene.environment));
        for (int fp64 = 0; fp64 < twins_count(); fp64++) check(&KINDS[i], &scene, &sky, fp64);
        sky_finish(&sky);
        free(scene.environment.texels);
    }
}

static struct sky_in in[CASES];
static struct sky_out out[CASES];

// ---------------------------------------------------------------------------------------------------------------- tables

// Shares grow, by whole steps, to 1; wherever there is light, interpolated, a texel has at least one step.
static void check_shares(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64) {
    (void)scene;
    if (fp64) return;
    double before = 0;
    for (uint32_t row = 0; row < sky->height; row++) {
        double share = sky->rows[row].until - before, left = 0;
        if (!(share >= 0) || share * 0x1p24 != floor(share * 0x1p24)) fail_msg("%s: row %u takes %g", kind->name, row, share);
        for (uint32_t i = 0; i < sky->width; i++) {
            const struct sky_texel *texel = sky->texels + (size_t)row * sky->width + i;
            double part = texel->until - left;
            bool light = texel->radiance[0] > 0 || texel->radiance[1] > 0 || texel->radiance[2] > 0;
            if (!(part >= 0) || part * 0x1p24 != floor(part * 0x1p24)) fail_msg("%s: texel %u, %u takes %g", kind->name, i, row, part);
            if (light && !(part >= 0x1p-24 && share >= 0x1p-24)) fail_msg("%s: texel %u, %u has light and no share", kind->name, i, row);
            left = texel->until;
        }
        assert_true(left == 1);
        before = sky->rows[row].until;
    }
    assert_true(before == 1);
}

static void shares_are_whole_steps(void **state) {
    (void)state;
    for_each_sky(check_shares);
}

// ---------------------------------------------------------------------------------------------------------------- looks

// The largest radiance: what an error of a weight is multiplied with at most.
static double brightest(const struct sky *sky) {
    double most = 0;
    for (size_t i = 0; i < (size_t)sky->width * sky->height; i++)
        for (int k = 0; k < 3; k++) most = fmax(most, (double)sky->texels[i].radiance[k]);
    return most;
}

// Distance of x from the nearest texel's edge, in texels.
static double from_edge(double x) { return fabs(x - round(x)); }

// Radiance and density anywhere. Densities are compared where fp32 knows in which texel a direction is; the control is a sky that is turned
// by two degrees.
static void check_looks(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64) {
    for (int i = 0; i < CASES; i++) {
        random_direction(in[i].way);
        for (int k = 0; k < 3; k++) in[i].way[k] = (volatile float){(float)in[i].way[k]};
        in[i].u[0] = in[i].u[1] = 0;
    }
    run_sky(scene, fp64, in, out, CASES);
    double unit = fp64 ? 0x1p-52 : 0x1p-23, limit = 8 * unit * (sky->width + sky->height + 1) * brightest(sky);
    struct sky turned = *sky;
    turned.turns += 2 / 360.0f;
    int caught = 0, compared = 0;
    for (int i = 0; i < CASES; i++) {
        double right[3], other[3], x = (0.5 + atan2(in[i].way[0], -in[i].way[2]) / (2 * PI) + sky->turns) * sky->width;
        double y = atan2(hypot(in[i].way[0], in[i].way[2]), in[i].way[1]) / PI * sky->height, off = 0;
        environment_radiance(right, sky, in[i].way);
        environment_radiance(other, &turned, in[i].way);
        for (int k = 0; k < 3; k++) {
            if (!(fabs(out[i].radiance[k] - right[k]) <= limit))
                fail_msg("fp%d %s: radiance %g, not %g", fp64 ? 64 : 32, kind->name, out[i].radiance[k], right[k]);
            off = fmax(off, fabs(out[i].radiance[k] - other[k]));
        }
        caught += off > limit;
        if (from_edge(x) < 1e-4 || from_edge(y) < 1e-4) continue;
        double pdf = environment_pdf(sky, in[i].way);
        if (!(fabs(out[i].pdf - pdf) <= 2e-6 * pdf)) fail_msg("fp%d %s: density %g, not %g", fp64 ? 64 : 32, kind->name, out[i].pdf, pdf);
        compared++;
    }
    assert_true(compared > CASES * 9 / 10);
    if (kind->look == RANDOM && kind->width > 1) assert_true(caught > CASES / 2);
}

static void radiance_and_density_agree_with_the_reference(void **state) {
    (void)state;
    for_each_sky(check_looks);
}

struct known {
    const char *name;
    float rotation_deg;
    double way[3];
    uint32_t texel[2]; // of a picture of 4 × 2: the mean of the two
};

static const struct known KNOWN[] = {
    {"-z is the middle", 0, {0, 0.5, -0.5}, {1, 2}},
    {"+x is right of it", 0, {0.5, 0.5, 0}, {2, 3}},
    {"the seam", 0, {0, 0.5, 0.5}, {3, 0}},
    {"the seam from the other side", 0, {-1e-30, 0.5, 0.5}, {3, 0}},
    {"a center", 0, {0.5, 0.70710678118654752, -0.5}, {2, 2}},
    {"a center below", 0, {0.5, -0.70710678118654752, -0.5}, {6, 6}},
    {"turned to the left by 90 degrees, -x is the middle", 90, {-0.5, 0.5, 0}, {1, 2}},
    {"turned by 90 degrees, -z is what +x was", 90, {0, 0.5, -0.5}, {2, 3}},
    {"turned to the right", -90, {0.5, 0.5, 0}, {1, 2}},
    {"turned around", 360, {0, 0.5, -0.5}, {1, 2}},
};

static void places_that_are_known(void **state) {
    (void)state;
    static float texels[24] = {1, 2, 3, 10, 20, 30, 100, 200, 300, 1000, 2000, 3000, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8};
    for (size_t i = 0; i < COUNT(KNOWN); i++) {
        const struct scene scene = {
            .environment = {.width = 4, .height = 2, .texels = texels, .scale = 0.5f, .rotation_deg = KNOWN[i].rotation_deg}};
        memcpy(in[0].way, KNOWN[i].way, sizeof in[0].way);
        for (int fp64 = 0; fp64 < twins_count(); fp64++) {
            run_sky(&scene, fp64, in, out, 1);
            for (int k = 0; k < 3; k++) {
                double right =
                    0.25 * ((double)texels[3 * KNOWN[i].texel[0] + (uint32_t)k] + (double)texels[3 * KNOWN[i].texel[1] + (uint32_t)k]);
                if (!(fabs(out[0].radiance[k] - right) <= 1e-6 * right))
                    fail_msg("%s: %g, not %g", KNOWN[i].name, out[0].radiance[k], right);
            }
        }
    }
}

// Straight up and straight down, as light and as a density.
static void poles_are_places(void **state) {
    (void)state;
    struct scene scene;
    make_environment(&scene, &KINDS[5]);
    memset(in, 0, sizeof in[0] * 2);
    in[0].way[1] = 1, in[1].way[1] = -1;
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        run_sky(&scene, fp64, in, out, 2);
        for (int i = 0; i < 2; i++) assert_true(out[i].radiance[0] >= 0 && out[i].radiance[0] <= 1 && out[i].pdf > 0 && out[i].pdf < 10);
    }
    free(scene.environment.texels);
}

// -------------------------------------------------------------------------------------------------------------- samples

static void make_samples(void) {
    for (int i = 0; i < CASES; i++) {
        in[i] = (struct sky_in){.way = {0, 0, -1}, .u = {random_unit(), random_unit()}};
        if (i < 4) in[i].u[0] = i & 1 ? 1 - 0x1p-24 : 0, in[i].u[1] = i & 2 ? 1 - 0x1p-24 : 0;
    }
}

// The same texel in every precision, and the same place in it as far as 23 bits of its cosine tell, which next to a pole is not much of its
// sine. The density returned is that looked up, save next to an edge.
static void check_samples(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64) {
    make_samples();
    run_sky(scene, fp64, in, out, CASES);
    int same = 0;
    for (int i = 0; i < CASES; i++) {
        const float u[2] = {(float)in[i].u[0], (float)in[i].u[1]};
        double way[3], pdf, off = 0, length = 0;
        environment_sample(way, &pdf, sky, u);
        for (int k = 0; k < 3; k++) {
            off = fmax(off, fabs(way[k] - out[i].sampled[k]));
            length += out[i].sampled[k] * out[i].sampled[k];
        }
        double limit = 2e-6 + 3e-7 / fmax(1e-3, hypot(way[0], way[2]));
        if (!(off <= limit && fabs(length - 1) <= 1e-6)) fail_msg("fp%d %s: a direction off by %g", fp64 ? 64 : 32, kind->name, off);
        if (!(fabs(out[i].sampled_pdf - pdf) <= 2e-6 * pdf && pdf > 0))
            fail_msg("fp%d %s: density %g, not %g", fp64 ? 64 : 32, kind->name, out[i].sampled_pdf, pdf);
        same += fabs(out[i].looked_up_pdf - pdf) <= 2e-6 * pdf;
    }
    if (!(same >= CASES * 0.999)) fail_msg("fp%d %s: of %d densities %d are looked up", fp64 ? 64 : 32, kind->name, CASES, same);
}

static void samples_agree_with_the_reference(void **state) {
    (void)state;
    for_each_sky(check_samples);
}

// The share of samples that should fall into a texel: by the density at its middle, or if all texels took the same.
static double expected_share(const struct sky *sky, uint32_t row, uint32_t column, bool even) {
    if (even) return 1.0 / ((double)sky->width * sky->height);
    double longitude = 2 * PI * ((column + 0.5) / sky->width - 0.5 - sky->turns), angle = PI * (row + 0.5) / sky->height;
    const double way[3] = {sin(angle) * sin(longitude), cos(angle), -sin(angle) * cos(longitude)};
    return environment_pdf(sky, way) * 2 * PI / sky->width * (cos(PI * row / sky->height) - cos(PI * (row + 1.0) / sky->height));
}

// The probability that chi-squared with this many degrees of freedom is larger. E. B. Wilson, M. M. Hilferty, "The distribution of
// chi-square", 1931.
static double chance_of(double chi, double freedom) {
    double z = (cbrt(chi / freedom) - (1 - 2 / (9 * freedom))) / sqrt(2 / (9 * freedom));
    return 0.5 * erfc(z / sqrt(2));
}

// Cells of a texel along each axis: samples are even within it, by solid angle.
static uint32_t cells_of(const struct sky *sky) { return sky->width * sky->height <= 256 ? 4 : 1; }

// Samples in the cells of each texel against what is expected; cells that expect fewer than 8 are taken together.
static double chi_squared_chance(const struct sky *sky, const double *counts, double samples, bool even) {
    double chi = 0, few = 0, few_expected = 0;
    uint32_t cells = cells_of(sky) * cells_of(sky);
    int bins = -1;
    for (uint32_t row = 0; row < sky->height; row++)
        for (uint32_t column = 0; column < sky->width; column++) {
            double expected = samples * expected_share(sky, row, column, even) / cells;
            for (uint32_t cell = 0; cell < cells; cell++) {
                double count = counts[((size_t)row * sky->width + column) * cells + cell];
                if (expected < 8) {
                    few += count, few_expected += expected;
                } else {
                    chi += (count - expected) * (count - expected) / expected;
                    bins++;
                }
            }
        }
    if (few_expected >= 8) chi += (few - few_expected) * (few - few_expected) / few_expected, bins++;
    if (few_expected < 8 && few > 8 + 8 * few_expected) return 0;
    return bins > 0 ? chance_of(chi, bins) : 1;
}

// Which cell a direction falls into.
static size_t cell_of(const struct sky *sky, const double way[3]) {
    double x = (0.5 + atan2(way[0], -way[2]) / (2 * PI) + sky->turns) * sky->width, angle = atan2(hypot(way[0], way[2]), way[1]);
    x -= floor(x / sky->width) * sky->width;
    uint32_t column = (uint32_t)fmin(x, sky->width - 1), row = (uint32_t)fmin(angle / PI * sky->height, sky->height - 1);
    double upper = cos(PI * row / sky->height), lower = cos(PI * (row + 1.0) / sky->height), down = (upper - cos(angle)) / (upper - lower);
    uint32_t cells = cells_of(sky), i = (uint32_t)fmin((x - column) * cells, cells - 1),
             j = (uint32_t)fmax(0, fmin(down * cells, cells - 1));
    return ((size_t)row * sky->width + column) * cells * cells + j * cells + i;
}

#define ROUNDS 4

// 2^16 samples fall where the density says, and nowhere else; the control, that all texels take the same, is refuted where they do not.
static void check_chi_squared(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64) {
    double *counts = calloc((size_t)sky->width * sky->height * cells_of(sky) * cells_of(sky), sizeof *counts);
    assert_non_null(counts);
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < CASES; i++) in[i] = (struct sky_in){.way = {0, 0, -1}, .u = {random_unit(), random_unit()}};
        run_sky(scene, fp64, in, out, CASES);
        for (int i = 0; i < CASES; i++) counts[cell_of(sky, out[i].sampled)]++;
    }
    double chance = chi_squared_chance(sky, counts, ROUNDS * CASES, false), even = chi_squared_chance(sky, counts, ROUNDS * CASES, true);
    free(counts);
    double limit = 1e-4 / (2 * COUNT(KINDS));
    if (!(chance > limit)) fail_msg("fp%d %s: chi-squared has a chance of %g", fp64 ? 64 : 32, kind->name, chance);
    bool uneven = kind->height > 2 || kind->look == RANDOM;
    if (uneven && kind->look != BLACK && !(even <= limit)) fail_msg("%s: even samples have a chance of %g", kind->name, even);
}

static void samples_fall_where_the_density_says(void **state) {
    (void)state;
    for_each_sky(check_chi_squared);
}

// The density, looked up in the middle of every texel, adds up to 1.
static void check_integral(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64) {
    uint32_t count = sky->width * sky->height;
    assert_true(count <= CASES);
    for (uint32_t i = 0; i < count; i++) {
        double longitude = 2 * PI * ((i % sky->width + 0.5) / sky->width - 0.5 - sky->turns),
               angle = PI * (i / sky->width + 0.5) / sky->height;
        in[i] = (struct sky_in){.way = {sin(angle) * sin(longitude), cos(angle), -sin(angle) * cos(longitude)}};
    }
    run_sky(scene, fp64, in, out, count);
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        double row = i / sky->width;
        sum += out[i].pdf * 2 * PI / sky->width * (cos(PI * row / sky->height) - cos(PI * (row + 1) / sky->height));
    }
    if (!(fabs(sum - 1) <= 1e-6)) fail_msg("fp%d %s: densities add up to %.9g", fp64 ? 64 : 32, kind->name, sum);
}

static void densities_add_up_to_1(void **state) {
    (void)state;
    for_each_sky(check_integral);
}

// The light of the whole sky, from samples, is what adding up its texels gives, within 4.5 deviations; of a constant sky each sample says
// 4π times it.
static void check_light(const struct kind *kind, const struct scene *scene, const struct sky *sky, bool fp64) {
    enum { FINE = 64 };
    if (kind->look == EXTREME || (size_t)sky->width * sky->height > 4096) return;
    double right = 0, sum = 0, squares = 0;
    for (uint32_t j = 0; j < sky->height * FINE; j++) {
        double angle = PI * (j + 0.5) / (sky->height * FINE), share = 2 * sin(angle) * sin(0.5 * PI / (sky->height * FINE));
        for (uint32_t i = 0; i < sky->width * 4; i++) {
            double longitude = 2 * PI * (i + 0.5) / (sky->width * 4) - 2 * PI * sky->turns, rgb[3];
            environment_radiance(rgb, sky, (double[3]){sin(angle) * sin(longitude), cos(angle), -sin(angle) * cos(longitude)});
            right += rgb[0] * share * 2 * PI / (sky->width * 4);
        }
    }
    for (int i = 0; i < CASES; i++) in[i] = (struct sky_in){.way = {0, 0, -1}, .u = {random_unit(), random_unit()}};
    run_sky(scene, fp64, in, out, CASES);
    for (int i = 0; i < CASES; i++) {
        double rgb[3];
        environment_radiance(rgb, sky, out[i].sampled);
        sum += rgb[0] / out[i].sampled_pdf, squares += pow(rgb[0] / out[i].sampled_pdf, 2);
    }
    double mean = sum / CASES, deviation = sqrt(fmax(0, squares / CASES - mean * mean) / CASES);
    if (!(fabs(mean - right) <= 4.5 * deviation + 2e-3 * right)) fail_msg("fp%d %s: %g, not %g", fp64 ? 64 : 32, kind->name, mean, right);
    if (kind->look == CONSTANT && !(fabs(mean - 8 * PI) <= 1e-4 && deviation <= 1e-5))
        fail_msg("%s: %g, deviation %g", kind->name, mean, deviation);
}

static void samples_give_the_light_of_the_sky(void **state) {
    (void)state;
    for_each_sky(check_light);
}

static void too_wide_is_a_limit(void **state) {
    (void)state;
    const struct scene_environment environment = {.width = (1u << 20) + 1, .height = 1};
    struct sky sky;
    assert_false(sky_init(&sky, fixture_context(), &environment));
    assert_int_equal(fixture_state()->error.status, GN_LIMIT);
    sky_finish(&sky);
}

static void no_environment_no_texels(void **state) {
    (void)state;
    struct scene scene;
    struct device_sky sky;
    make_environment(&scene, &KINDS[5]);
    fixture_assert(device_sky_init(&sky, fixture_context(), fixture_device(), &scene, 0));
    assert_true(sky.texels.size == 16 && sky.rows.size == 16);
    device_sky_finish(&sky, fixture_device());
    device_sky_finish(&sky, fixture_device());
    free(scene.environment.texels);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_are_whole_steps),
        cmocka_unit_test(radiance_and_density_agree_with_the_reference),
        cmocka_unit_test(places_that_are_known),
        cmocka_unit_test(poles_are_places),
        cmocka_unit_test(samples_agree_with_the_reference),
        cmocka_unit_test(samples_fall_where_the_density_says),
        cmocka_unit_test(densities_add_up_to_1),
        cmocka_unit_test(samples_give_the_light_of_the_sky),
        cmocka_unit_test(too_wide_is_a_limit),
        cmocka_unit_test(no_environment_no_texels),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
