// How images differ: numbers that can be worked out by hand, FLIP against its authors' own program, the heat map.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>

// Ours before cmocka's: that has a macro called fail.
#include "measure/compare.h"
#include "measure/flip.h"

#include <cmocka.h>

static struct gn_error error;
static struct context ctx;

static int fresh_context(void **state) {
    (void)state;
    ctx = context_make(NULL, &error);
    return 0;
}

// An image of one colour.
static struct image flat(uint32_t width, uint32_t height, float r, float g, float b) {
    struct image image;
    assert_true(image_init(&image, &ctx, width, height, 3, "a test"));
    for (size_t i = 0; i < (size_t)width * height; i++) {
        image.pixels[3 * i] = r;
        image.pixels[3 * i + 1] = g;
        image.pixels[3 * i + 2] = b;
    }
    return image;
}

static bool near(double found, double expected, double tolerance) { return fabs(found - expected) <= tolerance; }

// ---- the plain metrics

static void equal_images_do_not_differ(void **state) {
    (void)state;
    struct image a = flat(20, 10, 0.2f, 0.5f, 3), map;
    struct gn_compare_result r;
    assert_true(compare_images(&r, &map, &ctx, &a, &a, 0));
    assert_true(r.max_abs == 0 && r.rmse == 0 && r.flip == 0 && r.pixels_differing == 0 && r.nonfinite_pixels == 0);
    assert_true(isinf(r.psnr_db) && r.psnr_db > 0);
    assert_int_equal(r.width, 20);
    assert_int_equal(r.height, 10);
    assert_int_equal(map.channels, 1);
    for (int i = 0; i < 200; i++) assert_true(map.pixels[i] == 0);
    image_finish(&a);
    image_finish(&map);
}

static void metrics_are_those_of_the_formulas(void **state) {
    (void)state;
    struct image a = flat(4, 2, 0.5f, 0.5f, 0.5f), b = flat(4, 2, 0.5f, 0.5f, 0.5f);
    struct gn_compare_result r;
    b.pixels[3 * 6 + 1] = 0.25f;         // pixel (2, 1)
    b.pixels[3 * 1 + 2] = 0.5f + 0.125f; // pixel (1, 0)
    assert_true(compare_images(&r, NULL, &ctx, &a, &b, 0.125));
    assert_true(r.max_abs == 0.25);
    assert_true(near(r.rmse, sqrt((0.0625 + 0.015625) / 24), 1e-15));
    assert_true(near(r.psnr_db, 10 * log10(24 / 0.078125), 1e-12));
    assert_int_equal(r.pixels_differing, 1); // a difference of the tolerance is none
    assert_int_equal(r.worst_x, 2);
    assert_int_equal(r.worst_y, 1);
    assert_true(compare_images(&r, NULL, &ctx, &a, &b, 0.12499));
    assert_int_equal(r.pixels_differing, 2);
    assert_true(compare_images(&r, NULL, &ctx, &a, &b, (double)NAN));
    assert_int_equal(r.pixels_differing, 8);
    image_finish(&a);
    image_finish(&b);
}

static void numbers_that_are_none_are_counted(void **state) {
    (void)state;
    const struct {
        float a, b;
        unsigned differing;
        double max_abs;
    } cases[] = {
        {NAN, NAN, 0, 0},     {INFINITY, INFINITY, 0, 0}, {NAN, 1, 1, 0}, {1, NAN, 1, 0}, {INFINITY, -INFINITY, 1, 0},
        {-INFINITY, 0, 1, 0}, {INFINITY, NAN, 1, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct image a = flat(3, 2, 0, 0, 0), b = flat(3, 2, 0, 0, 0);
        struct gn_compare_result r;
        a.pixels[3 * 4 + 2] = cases[i].a; // pixel (1, 1)
        b.pixels[3 * 4 + 2] = cases[i].b;
        assert_true(compare_images(&r, NULL, &ctx, &a, &b, 1e9));
        assert_int_equal(r.nonfinite_pixels, 1);
        assert_int_equal(r.pixels_differing, cases[i].differing);
        assert_true(r.max_abs == 0 && r.rmse == 0);
        assert_int_equal(r.worst_x, cases[i].differing);
        assert_int_equal(r.worst_y, cases[i].differing);
        assert_true(isfinite(r.flip));
        image_finish(&a);
        image_finish(&b);
    }
}

static void other_sizes_are_refused(void **state) {
    (void)state;
    struct image a = flat(3, 2, 0, 0, 0), b = flat(2, 3, 0, 0, 0), map;
    struct gn_compare_result r;
    assert_false(compare_images(&r, &map, &ctx, &a, &b, 0));
    assert_int_equal(error.status, GN_USAGE);
    assert_string_equal(error.message, "the images differ in size: 3 × 2 and 2 × 3 pixels");
    assert_null(map.pixels);
    image_finish(&a);
    image_finish(&b);
}

// ---- FLIP

// CIELab with the Hunt effect, written from the definitions: primaries and white of sRGB, then CIE 1976.
static void hunt_lab(const double rgb[3], double lab[3]) {
    double x = (0.4124564 * rgb[0] + 0.3575761 * rgb[1] + 0.1804375 * rgb[2]) / 0.95047;
    double y = 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2];
    double z = (0.0193339 * rgb[0] + 0.1191920 * rgb[1] + 0.9503041 * rgb[2]) / 1.08883;
    double f[3] = {x, y, z};
    for (int i = 0; i < 3; i++) f[i] = f[i] > 0.008856 ? pow(f[i], 1 / 3.0) : 7.787037 * f[i] + 16 / 116.0;
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]) * lab[0] / 100;
    lab[2] = 200 * (f[1] - f[2]) * lab[0] / 100;
}

static double hyab(const double a[3], const double b[3]) {
    double p[3], q[3];
    hunt_lab(a, p);
    hunt_lab(b, q);
    return fabs(p[0] - q[0]) + sqrt((p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

// Images of one colour have no features and are not changed by a blur: FLIP is the compressed colour difference alone.
static double flip_of_colours(const double a[3], const double b[3]) {
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double largest = pow(hyab(green, blue), 0.7), e = pow(hyab(a, b), 0.7);
    return e < 0.4 * largest ? 0.95 * e / (0.4 * largest) : 0.95 + 0.05 * (e - 0.4 * largest) / (0.6 * largest);
}

static void flip_of_single_colours(void **state) {
    (void)state;
    static const double colours[][2][3] = {{{1, 1, 1}, {0, 0, 0}},
                                           {{0, 1, 0}, {0, 0, 1}},
                                           {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}},
                                           {{0.5, 0.5, 0.5}, {0.51, 0.5, 0.5}},
                                           {{0.01, 0.02, 0.03}, {0, 0, 0}},
                                           {{1, 0, 0}, {0.2, 0.9, 0.4}}};
    for (size_t i = 0; i < sizeof colours / sizeof *colours; i++) {
        const double *p = colours[i][0], *q = colours[i][1];
        struct image a = flat(30, 20, (float)p[0], (float)p[1], (float)p[2]), b = flat(30, 20, (float)q[0], (float)q[1], (float)q[2]), map;
        double mean, expected = flip_of_colours(p, q);
        assert_true(flip_compare(&map, &mean, &ctx, &a, &b));
        assert_true(near(mean, expected, 2e-4));
        assert_true(expected == 0 || !near(1.01 * mean, expected, 2e-4));
        for (int k = 0; k < 600; k++) assert_true(near((double)map.pixels[k], expected, 2e-4));
        image_finish(&a);
        image_finish(&b);
        image_finish(&map);
    }
    // White against black is nearly the most that there is.
    const double white[3] = {1, 1, 1}, black[3] = {0, 0, 0};
    assert_in_range(1000 * flip_of_colours(white, black), 960, 1000);
}

static float noise(uint32_t x) {
    x *= 2654435761u;
    x ^= x >> 15;
    x *= 2246822519u;
    x ^= x >> 13;
    return (float)(x >> 8) * 0x1p-24f;
}

enum { NOISE, STRIPES, DOT, GRADIENT, PAIR_COUNT };

// A sample of one of the two images of a pair: noise and other noise; stripes, and the same a pixel further; grey, and a dot on it;
// a gradient, and the same in steps.
static float pair_sample(int pair, uint32_t side, uint32_t x, uint32_t y, uint32_t c) {
    float ramp = ((float)x + (float)y * (float)(c + 1)) / 150.0f;
    switch (pair) {
    case NOISE:
        return noise((y * 40 + x) * 3 + c + side * 1000003u);
    case STRIPES:
        return (x + side) % 8 < 4 ? (c == 0 ? 0.8f : 0.3f) : 0.1f + 0.1f * (float)c;
    case DOT:
        return side && x == 20 && y == 11 ? 1.0f - (float)c * 0.25f : 0.2f;
    default:
        return side ? floorf(ramp * 8) / 8 : ramp;
    }
}

static struct image pair_image(int pair, uint32_t side) {
    struct image image = flat(40, 30, 0, 0, 0);
    for (uint32_t i = 0; i < 40 * 30 * 3; i++) image.pixels[i] = pair_sample(pair, side, i / 3 % 40, i / 120, i % 3);
    return image;
}

// What the authors' program (FLIP.h of version 1.7, fp32) gives for these pairs.
static void flip_is_that_of_its_authors(void **state) {
    (void)state;
    static const uint32_t places[4] = {0, 11 * 40 + 20, 11 * 40 + 21, 29 * 40 + 39};
    static const struct {
        double mean, at[4];
    } expected[PAIR_COUNT] = {
        [NOISE] = {0.4141017, {0.806532, 0.505271, 0.361804, 0.478797}},
        [STRIPES] = {0.3189397, {0.116692, 0.419667, 0, 0.748426}},
        [DOT] = {0.0053678, {0, 0.343257, 0.265606, 0}},
        [GRADIENT] = {0.3099864, {0.294051, 0.313321, 0.315778, 0.249155}},
    };
    for (int pair = 0; pair < PAIR_COUNT; pair++) {
        struct image a = pair_image(pair, 0), b = pair_image(pair, 1), map;
        double mean;
        assert_true(flip_compare(&map, &mean, &ctx, &a, &b));
        assert_true(near(mean, expected[pair].mean, 4e-5));
        assert_false(near(1.02 * mean, expected[pair].mean, 4e-5));
        for (int i = 0; i < 4; i++) assert_true(near((double)map.pixels[places[i]], expected[pair].at[i], 4e-5));
        image_finish(&a);
        image_finish(&b);
        image_finish(&map);
    }
}

static void flip_is_symmetric_and_bounded(void **state) {
    (void)state;
    for (int pair = 0; pair < PAIR_COUNT; pair++) {
        struct image a = pair_image(pair, 0), b = pair_image(pair, 1), there, back, self;
        double mean, mean_back, mean_self;
        assert_true(flip_compare(&there, &mean, &ctx, &a, &b));
        assert_true(flip_compare(&back, &mean_back, &ctx, &b, &a));
        assert_true(flip_compare(&self, &mean_self, &ctx, &a, &a));
        assert_true(mean == mean_back && mean_self == 0 && mean > 0);
        assert_memory_equal(there.pixels, back.pixels, 1200 * sizeof(float));
        for (int i = 0; i < 1200; i++) assert_true(there.pixels[i] >= 0 && there.pixels[i] <= 1);
        image_finish(&a);
        image_finish(&b);
        image_finish(&there);
        image_finish(&back);
        image_finish(&self);
    }
}

static void flip_does_not_depend_on_threads_nor_on_what_is_out_of_range(void **state) {
    (void)state;
    struct image a = pair_image(NOISE, 0), b = pair_image(NOISE, 1), one, many;
    double mean_one, mean_many;
    ctx.host.threads = 1;
    assert_true(flip_compare(&one, &mean_one, &ctx, &a, &b));
    ctx.host.threads = 5;
    a.pixels[100] = 1;
    assert_true(flip_compare(&many, &mean_many, &ctx, &a, &b));
    assert_false(mean_one == mean_many);
    image_finish(&one);
    assert_true(flip_compare(&one, &mean_one, &ctx, &a, &b));
    assert_true(mean_one == mean_many);
    assert_memory_equal(one.pixels, many.pixels, 1200 * sizeof(float));
    a.pixels[100] = 7; // the same as 1
    image_finish(&many);
    assert_true(flip_compare(&many, &mean_many, &ctx, &a, &b));
    assert_true(mean_one == mean_many);
    a.pixels[100] = NAN;
    image_finish(&many);
    assert_true(flip_compare(&many, &mean_many, &ctx, &a, &b));
    assert_true(isfinite(mean_many) && mean_one != mean_many);
    image_finish(&a);
    image_finish(&b);
    image_finish(&one);
    image_finish(&many);
}

static void flip_takes_images_of_any_size(void **state) {
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 70}, {70, 1}, {2, 3}, {33, 65}};
    const double p[3] = {0.5, 0.25, 0.125}, q[3] = {0.25, 0.25, 0.25};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct image a = flat(sizes[i][0], sizes[i][1], 0.5f, 0.25f, 0.125f), b = flat(sizes[i][0], sizes[i][1], 0.25f, 0.25f, 0.25f), map;
        double mean;
        assert_true(flip_compare(&map, &mean, &ctx, &a, &b));
        assert_true(near(mean, flip_of_colours(p, q), 2e-4));
        image_finish(&a);
        image_finish(&b);
        image_finish(&map);
    }
}

static bool stop(void *user, const struct gn_progress *progress) {
    (void)user, (void)progress;
    return false;
}

static void flip_can_be_cancelled(void **state) {
    (void)state;
    struct image a = flat(1500, 1500, 0, 0, 0), map;
    double mean;
    ctx.host.progress = stop;
    assert_false(flip_compare(&map, &mean, &ctx, &a, &a));
    assert_int_equal(error.status, GN_CANCELLED);
    assert_null(map.pixels);
    image_finish(&a);
}

// ---- the heat map

static double lightness(const float *rgb) { return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2]; }

static void heat_map_gets_lighter(void **state) {
    (void)state;
    struct image values, heat;
    assert_true(image_init(&values, &ctx, 260, 1, 1, "a test"));
    for (int i = 0; i < 256; i++) values.pixels[i] = (float)i / 255;
    values.pixels[256] = -1;
    values.pixels[257] = NAN;
    values.pixels[258] = 7;
    values.pixels[259] = INFINITY;
    assert_true(heat_map(&heat, &ctx, &values));
    assert_int_equal(heat.channels, 3);
    for (int i = 1; i < 256; i++) assert_true(lightness(heat.pixels + 3 * i) > lightness(heat.pixels + 3 * (i - 1)));
    assert_true(lightness(heat.pixels) < 0.001 && lightness(heat.pixels + 3 * 255) > 0.9);
    for (int i = 0; i < 2; i++) {
        assert_memory_equal(heat.pixels + 3 * (256 + i), heat.pixels, 3 * sizeof(float));
        assert_memory_equal(heat.pixels + 3 * (258 + i), heat.pixels + 3 * 255, 3 * sizeof(float));
    }
    image_finish(&values);
    image_finish(&heat);
}

#define TEST(function) cmocka_unit_test_setup(function, fresh_context)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(equal_images_do_not_differ),
        TEST(metrics_are_those_of_the_formulas),
        TEST(numbers_that_are_none_are_counted),
        TEST(other_sizes_are_refused),
        TEST(flip_of_single_colours),
        TEST(flip_is_that_of_its_authors),
        TEST(flip_is_symmetric_and_bounded),
        TEST(flip_does_not_depend_on_threads_nor_on_what_is_out_of_range),
        TEST(flip_takes_images_of_any_size),
        TEST(flip_can_be_cancelled),
        TEST(heat_map_gets_lighter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
