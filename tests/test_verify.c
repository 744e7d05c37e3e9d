// The rule of measure/verify.h on small pictures made by hand; every limit with the case just beyond it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "measure/verify.h"

#include <cmocka.h>

#define SIDE 8
#define PIXELS (SIDE * SIDE)

struct picture {
    float color[3 * PIXELS], id[2 * PIXELS], depth[PIXELS];
};

// Value `device` where the reference has `reference`, in `count` pixels; as many wrong hits as said, at this depth instead of 8. Does it
// pass?
static const struct {
    float device, reference;
    int count, wrong;
    double tolerance;
    bool pass;
    int differing, nonfinite;
    float depth;
} rows[] = {
    {0.5f, 0.5f, 0, 0, VERIFY_TOLERANCE, true, 0, 0, 8},
    {0.5f + 0.99f / 255, 0.5f, PIXELS, 0, VERIFY_TOLERANCE, true, 0, 0, 8},
    {0.5f + 1.01f / 255, 0.5f, 1, 0, VERIFY_TOLERANCE, true, 1, 0, 8},
    {0.5f + 1.01f / 255, 0.5f, 2, 0, VERIFY_TOLERANCE, true, 2, 0, 8},
    {0.5f + 1.01f / 255, 0.5f, 3, 0, VERIFY_TOLERANCE, false, 3, 0, 8},
    {0.5f - 1.01f / 255, 0.5f, 3, 0, VERIFY_TOLERANCE, false, 3, 0, 8},
    {0.5f + 1.01f / 255, 0.5f, 3, 0, 0.1, true, 0, 0, 8},
    {0.5f + 1e-6f, 0.5f, 3, 0, 1e-7, false, 3, 0, 8},
    {100 * (1 + 0.9f / 4096), 100, PIXELS, 0, VERIFY_TOLERANCE, true, 0, 0, 8},
    {100 * (1 + 1.1f / 4096), 100, 3, 0, VERIFY_TOLERANCE, false, 3, 0, 8},
    {0.5f, 0.5f, 0, 2, VERIFY_TOLERANCE, true, 0, 0, 7},
    {0.5f, 0.5f, 0, 3, VERIFY_TOLERANCE, false, 0, 0, 7},
    {0.5f, 0.5f, 0, 3, VERIFY_TOLERANCE, false, 0, 0, INFINITY},
    {0.5f, 0.5f, 0, 3, VERIFY_TOLERANCE, false, 0, 0, 8 * (1 + 1.1f / 4096)},
    {0.5f, 0.5f, 0, PIXELS, VERIFY_TOLERANCE, true, 0, 0, 8 * (1 + 0.9f / 4096)},
    {NAN, 0.5f, 1, 0, VERIFY_TOLERANCE, false, 1, 1, 8},
    {0.5f, NAN, 1, 0, VERIFY_TOLERANCE, false, 1, 1, 8},
    {INFINITY, 0.5f, 1, 0, VERIFY_TOLERANCE, false, 1, 1, 8},
    {INFINITY, INFINITY, 1, 0, VERIFY_TOLERANCE, false, 1, 1, 8},
};

static struct image image_of(float *pixels, uint32_t channels) {
    return (struct image){.width = SIDE, .height = SIDE, .channels = channels, .pixels = pixels};
}

static void each_limit_holds(void **state) {
    (void)state;
    for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
        struct picture device = {0}, reference = {0};
        for (int i = 0; i < rows[row].count; i++)
            device.color[3 * i + i % 3] = rows[row].device, reference.color[3 * i + i % 3] = rows[row].reference;
        for (int i = 0; i < PIXELS; i++) device.depth[i] = reference.depth[i] = 8;
        for (int i = 0; i < rows[row].wrong; i++) device.id[2 * i + i % 2] = 1, device.depth[i] = rows[row].depth;
        struct image a = image_of(device.color, 3), b = image_of(reference.color, 3), c = image_of(device.id, 2),
                     d = image_of(reference.id, 2);
        struct image e = image_of(device.depth, 1), f = image_of(reference.depth, 1);
        struct gn_error error;
        struct context ctx = context_make(NULL, &error);
        struct gn_verify_result result = {0};
        assert_true(verify_pictures(&result, NULL, &ctx, (struct verify_side){&a, &c, &e}, (struct verify_side){&b, &d, &f}, 1,
                                    rows[row].tolerance));
        if (result.pass != rows[row].pass) fail_msg("row %zu: pass is %d", row, result.pass);
        if ((int)result.pixels_differing != rows[row].differing) fail_msg("row %zu: %d pixels differ", row, (int)result.pixels_differing);
        if ((int)result.nonfinite_pixels != rows[row].nonfinite) fail_msg("row %zu: %d are not finite", row, (int)result.nonfinite_pixels);
        assert_int_equal(result.wrong_hits, rows[row].wrong);
        assert_int_equal(result.pixels, PIXELS);
    }
}

static void what_the_device_dropped_fails(void **state) {
    (void)state;
    struct picture zero = {0};
    struct image color = image_of(zero.color, 3), id = image_of(zero.id, 2), depth = image_of(zero.depth, 1);
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct gn_verify_result result = {.nonfinite_pixels = 1};
    const struct verify_side side = {&color, &id, &depth};
    assert_true(verify_pictures(&result, NULL, &ctx, side, side, 1, VERIFY_TOLERANCE));
    assert_false(result.pass);
}

static void the_difference_and_the_worst_pixel(void **state) {
    (void)state;
    struct picture device = {0}, reference = {0};
    const float off[] = {0, 0.05f, 0.1f, 0.2f, 5, NAN}, seen[] = {0, 0.25f, 0.5f, 1, 1, 1};
    for (int i = 0; i < 6; i++) device.color[3 * (SIDE + i) + 1] = off[i];
    struct image a = image_of(device.color, 3), b = image_of(reference.color, 3), id = image_of(device.id, 2), difference = {0};
    struct image depth = image_of(device.depth, 1);
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct gn_verify_result result = {0};
    assert_true(
        verify_pictures(&result, &difference, &ctx, (struct verify_side){&a, &id, &depth}, (struct verify_side){&b, &id, &depth}, 1, 0.1));
    for (int i = 0; i < 6; i++) assert_true(fabsf(difference.pixels[SIDE + i] - seen[i]) <= 1e-6f);
    assert_true(result.worst_x == 4 && result.worst_y == 1 && result.max_abs == 5);
    double rmse = sqrt((0.05 * 0.05 + 0.1 * 0.1 + 0.2 * 0.2 + 5 * 5) / (3 * PIXELS));
    assert_true(fabs(result.rmse - rmse) <= 1e-6);
    image_finish(&difference);
}

static void few_pixels_may_differ(void **state) {
    (void)state;
    static const struct {
        uint64_t pixels, allowed;
        uint32_t spp;
    } sizes[] = {{1, 2, 1},       {64, 2, 1},  {20000, 2, 1},     {30000, 3, 1},       {262144, 26, 1},          {4294836225u, 429483, 1},
                 {262144, 26, 0}, {64, 2, 16}, {518400, 129, 16}, {518400, 518, 1000}, {518400, 518, UINT32_MAX}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        assert_int_equal(verify_allowed(sizes[i].pixels, sizes[i].spp), sizes[i].allowed);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_limit_holds),
        cmocka_unit_test(what_the_device_dropped_fails),
        cmocka_unit_test(the_difference_and_the_worst_pixel),
        cmocka_unit_test(few_pixels_may_differ),
    };
    return cmocka_run_group_tests_name("verify", tests, NULL, NULL);
}
