// Film filters: what is drawn against the filters' formulas, integrated here; and the device's offsets against the reference's, bit by bit.
#include "fixture.h"

#include <math.h>

#include "render/filter_table.h"
#include "twin_filter.h"

#define CASES (1 << 15)
#define STEPS 20000 // of an integral over half a filter

static const struct {
    const char *name;
    enum film_filter type;
    float radius;
} FILTERS[] = {
    {"box", FILTER_BOX, 0.5f},          {"wide box", FILTER_BOX, 1.7f},
    {"tent", FILTER_TENT, 1},           {"gaussian", FILTER_GAUSSIAN, 2},
    {"narrow gaussian", FILTER_GAUSSIAN, 0.01f}, {"Blackman-Harris", FILTER_BLACKMAN_HARRIS, 1.5f},
};
#define FILTER_COUNT (sizeof FILTERS / sizeof *FILTERS)

static struct filter_table table_of(size_t filter) {
    struct filter_table table;
    filter_table_make(&table, FILTERS[filter].type, FILTERS[filter].radius);
    return table;
}

static float offset_of(const struct filter_table *table, float u) {
    float offset[2] = {u, 0.5f};
    filter_table_offset(offset, table);
    assert_true(offset[1] == 0.5f); // one sample goes through the center
    return offset[0];
}

// The filter at x, |x| ≤ 1 its radius, as filter_table.h says; not normalized.
static double weight(enum film_filter type, double x) {
    const double phase = 3.14159265358979323846 * (x + 1);
    switch (type) {
    case FILTER_BOX: return 1;
    case FILTER_TENT: return 1 - fabs(x);
    case FILTER_GAUSSIAN: return exp(-8 * x * x);
    case FILTER_BLACKMAN_HARRIS: return 0.35875 - 0.48829 * cos(phase) + 0.14128 * cos(2 * phase) - 0.01168 * cos(3 * phase);
    }
    return 0;
}

// Random numbers that are nasty, then every so manieth.
static float number(uint32_t i) {
    static const uint32_t nasty[] = {0, 1, 2, 3, 31, 32, 33, 63, 64, 65, 0x400000, 0x3fffff, 0x7fffff, 0x800000, 0x800001, 0xc00000, 0xfffffe, 0xffffff};
    const uint32_t count = sizeof nasty / sizeof *nasty;
    return (float)(i < count ? nasty[i] : i * 2654435761u >> 8) * 0x1p-24f;
}

static void device_has_the_same_bits(void **state) {
    (void)state;
    static float in[FILTER_KNOTS + CASES], out[CASES];
    for (size_t f = 0; f < FILTER_COUNT; f++) {
        struct filter_table table = table_of(f);
        memcpy(in, table.knots, sizeof table.knots);
        for (uint32_t i = 0; i < CASES; i++) in[FILTER_KNOTS + i] = number(i);
        fixture_run(&(struct fixture_job){
            FIXTURE_KERNEL(twin_filter), .in = in, .in_bytes = sizeof in, .out = out, .out_bytes = sizeof out, .count = CASES});
        uint32_t rounded = 0;
        for (uint32_t i = 0; i < CASES; i++) {
            float right = offset_of(&table, number(i));
            if (memcmp(&out[i], &right, sizeof right) != 0) fail_msg("%s at %a: %a, expected %a", FILTERS[f].name, number(i), out[i], right);
            rounded += (double)right != 0.5 + FILTERS[f].radius * (2 * (double)number(i) - 1);
        }
        assert_true(f == 0 ? rounded == 0 : rounded > CASES / 4); // the control: where roundings matter, they are the same ones
    }
}

// Every number, and the identity: the box of the pixel is what pictures have without a filter.
static void pixel_box_is_the_identity(void **state) {
    (void)state;
    struct filter_table table = table_of(0), wide = table_of(1);
    uint32_t other = 0;
    for (uint32_t i = 0; i < 1u << 24; i += i < 4096 ? 1 : 37) {
        float u = (float)i * 0x1p-24f;
        if (offset_of(&table, u) != u) fail_msg("%a becomes %a", u, offset_of(&table, u));
        other += offset_of(&wide, u) != u;
    }
    assert_true(other > 400000);
}

static void offsets_are_symmetric_and_within(void **state) {
    (void)state;
    for (size_t f = 0; f < FILTER_COUNT; f++) {
        struct filter_table table = table_of(f);
        const float low = (float)(0.5 - FILTERS[f].radius), high = (float)(0.5 + FILTERS[f].radius);
        float before = low;
        for (uint32_t i = 0; i < 1u << 24; i += i < 4096 ? 1 : 997) {
            float u = (float)i * 0x1p-24f, x = offset_of(&table, u);
            if (!(x >= before && x <= high)) fail_msg("%s at %a: %a after %a", FILTERS[f].name, u, x, before);
            if (i > 0 && !(fabs((double)x + offset_of(&table, 1 - u) - 1) <= 1.2e-7 * fmax(1, FILTERS[f].radius)))
                fail_msg("%s at %a: %a is no mirror image", FILTERS[f].name, u, x);
            before = x;
        }
        assert_true(offset_of(&table, 0) == low);
    }
}

// Variance and fourth moment of what is drawn, in units of the radius, from all cells.
static void drawn_moments(double moments[2], const struct filter_table *table, double radius) {
    const uint32_t count = 1u << 18;
    moments[0] = moments[1] = 0;
    for (uint32_t i = 0; i < count; i++) {
        double x = ((double)offset_of(table, ((float)i + 0.5f) / (float)count) - 0.5) / radius;
        moments[0] += x * x / count;
        moments[1] += x * x * x * x / count;
    }
}

static void true_moments(double moments[2], enum film_filter type) {
    double sum = 0;
    moments[0] = moments[1] = 0;
    for (int i = 0; i < STEPS; i++) {
        double x = (i + 0.5) / STEPS, w = weight(type, x);
        sum += w;
        moments[0] += w * x * x;
        moments[1] += w * x * x * x * x;
    }
    moments[0] /= sum;
    moments[1] /= sum;
}

// A filter that is piecewise constant has a little more variance than the smooth one.
static void moments_are_the_filters(void **state) {
    (void)state;
    const double limit = 1e-3;
    for (size_t f = 0; f < FILTER_COUNT; f++) {
        struct filter_table table = table_of(f);
        double drawn[2], right[2], other[2];
        drawn_moments(drawn, &table, FILTERS[f].radius);
        true_moments(right, FILTERS[f].type);
        true_moments(other, (enum film_filter)((FILTERS[f].type + 1) % 4));
        for (int k = 0; k < 2; k++) {
            double off = fabs(drawn[k] / right[k] - 1);
            if (!(off <= limit)) fail_msg("%s: moment %d is %g, expected %g", FILTERS[f].name, 2 * k + 2, drawn[k], right[k]);
            assert_false(fabs(drawn[k] / other[k] - 1) <= limit);
        }
    }
}

// The largest distance between the distribution functions, of numbers drawn and of the formula (Kolmogorov and Smirnov).
static double distance(const struct filter_table *table, double radius, enum film_filter type) {
    static double share[2 * STEPS + 1];
    double worst = 0;
    for (int i = 0; i < 2 * STEPS; i++) share[i + 1] = share[i] + weight(type, (i + 0.5) / STEPS - 1);
    for (uint32_t i = 0; i < 1u << 16; i++) {
        float u = (float)i * 0x1p-16f;
        double at = fmin(fmax(((double)offset_of(table, u) - 0.5) / radius + 1, 0) * STEPS, 2 * STEPS), whole = fmin(floor(at), 2 * STEPS - 1);
        double below = share[(int)whole] + (at - whole) * (share[(int)whole + 1] - share[(int)whole]);
        worst = fmax(worst, fabs(below / share[2 * STEPS] - u));
    }
    return worst;
}

static void distribution_is_the_filters(void **state) {
    (void)state;
    const double limit = 2e-4;
    for (size_t f = 0; f < FILTER_COUNT; f++) {
        struct filter_table table = table_of(f);
        double off = distance(&table, FILTERS[f].radius, FILTERS[f].type);
        if (!(off <= limit)) fail_msg("%s: the distribution function is off by %g", FILTERS[f].name, off);
        assert_false(distance(&table, FILTERS[f].radius * 1.01, FILTERS[f].type) <= limit);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(device_has_the_same_bits),
        cmocka_unit_test(pixel_box_is_the_identity),
        cmocka_unit_test(offsets_are_symmetric_and_within),
        cmocka_unit_test(moments_are_the_filters),
        cmocka_unit_test(distribution_is_the_filters),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
