// What the exact and fp64 tiers ask of a device before they run: the device at hand keeps it; every way not to is noticed, and the tier
// says so instead of being wrong.
#include "fixture.h"

#include <math.h>

#include "render/arithmetic.h"
#include "render/kernels.h"
#include "shaders/shared.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static void test_device(void **state) {
    (void)state;
    struct device *device = fixture_device();
    for (int fp64 = 0; fp64 <= (int)device->has_fp64; ++fp64) {
        struct cases cases;
        fixture_assert(arithmetic_cases_init(&cases, fixture_context(), fp64));
        fixture_assert(cases_run_arithmetic(&cases, fixture_context(), device));
        const char *fault = arithmetic_fault_text(arithmetic_faults(&cases));
        if (fault) fail_msg("fp%d: %s", fp64 ? 64 : 32, fault);
        cases_finish(&cases);
    }
}

// ------------------------------------------------------------------------------------------------------------ pretended devices

// A device of our own, with one habit.
enum habit {
    SOUND,
    FUSES,          // a d - b c as fma(a, d, -(b c))
    TRUNCATES,      // sums and products towards zero
    SIMPLIFIES,     // (a + b) - a is b
    DIVIDES_BADLY,  // 4 ulp
    DIVIDES_FAIRLY, // 2 ulp, as Vulkan allows
    ROOTS_BADLY,    // 8 ulp
    ROOTS_FAIRLY,   // 4 ulp
    NO_NAN,         // a comparison is the negation of its opposite
};

static double off_by(bool fp64, double x, double ulps) { return round_to(fp64, x + ulps * ulp_of(fp64, x)); }

// `exact` as head + tail, rounded to the type.
static double rounded(bool fp64, enum habit habit, double head, double tail) {
    const double nearest = round_to(fp64, head);
    if (!isfinite(nearest)) return nearest;
    const double beyond = (nearest - head) - tail;
    const bool away = nearest > 0 ? beyond > 0 : beyond < 0;
    if (habit == TRUNCATES && away && fp64) return nextafter(nearest, 0);
    if (habit == TRUNCATES && away) return nextafterf((float)nearest, 0);
    return nearest;
}

static double times(bool fp64, enum habit habit, double a, double b) { return rounded(fp64, habit, a * b, fma(a, b, -(a * b))); }

static double plus(bool fp64, enum habit habit, double a, double b) {
    const double sum = a + b, there = sum - a, tail = (a - (sum - there)) + (b - there);
    return rounded(fp64, habit, sum, isfinite(sum) ? tail : 0);
}

static double area(bool fp64, enum habit habit, const double given[4]) {
    const double right = times(fp64, habit, given[1], given[2]);
    if (habit == FUSES) return round_to(fp64, fma(given[0], given[3], -right));
    return plus(fp64, habit, times(fp64, habit, given[0], given[3]), -right);
}

static double sum_error(bool fp64, enum habit habit, double a, double b) {
    if (habit == SIMPLIFIES) return 0;
    const double sum = plus(fp64, habit, a, b), b_there = plus(fp64, habit, sum, -a), a_there = plus(fp64, habit, sum, -b_there);
    return plus(fp64, habit, plus(fp64, habit, a, -a_there), plus(fp64, habit, b, -b_there));
}

static double comparison(enum habit habit, double a, double b) {
    if (habit != NO_NAN) return compared(a, b);
    return (a < b ? COMPARED_LESS : 0u) | (!(a > b) ? COMPARED_LESS_EQUAL : 0u) | (a > b ? COMPARED_GREATER : 0u) |
           (!(a < b) ? COMPARED_GREATER_EQUAL : 0u) | (a == b ? COMPARED_EQUAL : 0u) | (a != b ? COMPARED_NOT_EQUAL : 0u) |
           (!(a < b) ? COMPARED_NOT_LESS : 0u) | (a < b ? COMPARED_NOT_GREATER_EQUAL : 0u);
}

static void put(struct cases *cases, uint32_t i, uint32_t which, double value) {
    const size_t at = (size_t)i * cases->result_count + which;
    if (cases->fp64)
        ((double *)cases->results)[at] = value;
    else
        ((float *)cases->results)[at] = (float)value;
}

static void pretend(struct cases *cases, enum habit habit) {
    const bool fp64 = cases->fp64;
    cases->result_count = ARITHMETIC_COUNT;
    for (uint32_t i = 0; i < cases->count; ++i) {
        const double *given = cases->given[i], a = given[0], b = given[1];
        const double quotient = round_to(fp64, a / b), root = round_to(fp64, sqrt(fabs(a)));
        const double quotient_off = habit == DIVIDES_BADLY ? 4 : habit == DIVIDES_FAIRLY ? 2 : 0;
        put(cases, i, RESULT_SUM, plus(fp64, habit, a, b));
        put(cases, i, RESULT_DIFFERENCE, plus(fp64, habit, a, -b));
        put(cases, i, RESULT_PRODUCT, times(fp64, habit, a, b));
        put(cases, i, RESULT_QUOTIENT, off_by(fp64, quotient, quotient_off));
        put(cases, i, RESULT_ROOT, off_by(fp64, root, habit == ROOTS_BADLY ? 8 : habit == ROOTS_FAIRLY ? 4 : 0));
        put(cases, i, RESULT_AREA, area(fp64, habit, given));
        put(cases, i, RESULT_SUM_ERROR, sum_error(fp64, habit, a, b));
        put(cases, i, RESULT_PRODUCT_ERROR, 0);
        put(cases, i, RESULT_COMPARED, comparison(habit, a, b));
        put(cases, i, RESULT_PRODUCT_COMPARED, comparison(habit, times(fp64, habit, given[2], given[3]), a));
    }
}

static void test_habits(void **state) {
    (void)state;
    const struct {
        const char *name;
        enum habit habit;
        uint32_t fault;
    } cases[] = {
        {"sound", SOUND, 0},
        {"fuses", FUSES, FAULT_CONTRACTS},
        {"truncates", TRUNCATES, FAULT_ROUNDS},
        {"simplifies", SIMPLIFIES, FAULT_REORDERS},
        {"divides badly", DIVIDES_BADLY, FAULT_DIVIDES},
        {"divides fairly", DIVIDES_FAIRLY, 0},
        {"takes roots badly", ROOTS_BADLY, FAULT_ROOTS},
        {"takes roots fairly", ROOTS_FAIRLY, 0},
        {"knows no NaN", NO_NAN, FAULT_COMPARES},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        for (int fp64 = 0; fp64 < 2; ++fp64) {
            struct cases numbers;
            fixture_assert(arithmetic_cases_init(&numbers, fixture_context(), fp64));
            pretend(&numbers, cases[i].habit);
            const uint32_t faults = arithmetic_faults(&numbers);
            if (faults != cases[i].fault) fail_msg("%s, fp%d: faults %x", cases[i].name, fp64 ? 64 : 32, faults);
            assert_true(!faults == !arithmetic_fault_text(faults));
            cases_finish(&numbers);
        }
    }
}

// A result of NaN everywhere fails everything that is a number.
static void test_nan(void **state) {
    (void)state;
    struct cases numbers;
    fixture_assert(arithmetic_cases_init(&numbers, fixture_context(), false));
    numbers.result_count = ARITHMETIC_COUNT;
    memset(numbers.results, 0xff, (size_t)numbers.count * ARITHMETIC_COUNT * sizeof(float));
    assert_int_equal(arithmetic_faults(&numbers), FAULT_ROUNDS | FAULT_CONTRACTS | FAULT_DIVIDES | FAULT_ROOTS | FAULT_COMPARES);
    cases_finish(&numbers);
}

// ------------------------------------------------------------------------------------------------------------------- verdicts

static unsigned warnings;

static void count_message(void *user, enum gn_level level, const char *text) {
    (void)user;
    warnings += level == GN_LEVEL_WARNING && strstr(text, "doubles");
}

static void test_verdicts(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const struct {
        uint32_t tier, single, doubles;
        bool available, keeps_doubles;
        const char *says;
        bool hardware; // pretended
    } cases[] = {
        {TIER_EXACT, 0, 0, true, true, NULL, false},
        {TIER_FP64, 0, 0, true, true, NULL, false},
        {TIER_EXACT, FAULT_CONTRACTS, 0, false, true, "accuracy 'exact' would be wrong with the fp32 arithmetic of", false},
        {TIER_EXACT, FAULT_COMPARES, 0, false, true, "NaN", false},
        {TIER_EXACT, 0, FAULT_ROUNDS, true, false, NULL, false},
        {TIER_EXACT, FAULT_ROUNDS, FAULT_ROUNDS, false, true, "nearest", false},
        {TIER_FP64, 0, FAULT_DIVIDES, false, true, "accuracy 'fp64' would be wrong with the fp64 arithmetic of", false},
        {TIER_FP64, FAULT_CONTRACTS, 0, true, true, NULL, false},
        {TIER_ROBUST, FAULT_CONTRACTS, FAULT_ROUNDS, true, true, NULL, false},
        {TIER_ROBUST, FAULT_CONTRACTS, 0, false, true, "accuracy 'robust' would be wrong with the fp32 arithmetic of", true},
        {TIER_ROBUST, FAULT_ROUNDS | FAULT_DIVIDES, 0, false, true, "quotients", true},
        {TIER_ROBUST, FAULT_ROUNDS, FAULT_CONTRACTS, true, true, NULL, true},
        {TIER_FAST, FAULT_CONTRACTS, FAULT_ROUNDS, true, true, NULL, false},
    };
    const bool has_fp64 = device->has_fp64, software = device->software;
    for (size_t i = 0; has_fp64 && i < COUNT(cases); ++i) {
        struct context *ctx = fixture_context();
        ctx->host.message = count_message;
        warnings = 0;
        device->software = !cases[i].hardware;
        device->arithmetic[0] = (struct device_arithmetic){.checked = true, .faults = cases[i].single};
        device->arithmetic[1] = (struct device_arithmetic){.checked = true, .faults = cases[i].doubles};
        assert_int_equal(tier_available(ctx, device, cases[i].tier), cases[i].available);
        assert_int_equal(ctx->error->status, cases[i].available ? GN_OK : GN_NO_DEVICE);
        if (cases[i].says && !strstr(ctx->error->message, cases[i].says)) fail_msg("case %zu: %s", i, ctx->error->message);
        assert_int_equal(device->has_fp64, cases[i].keeps_doubles);
        assert_int_equal(warnings, cases[i].keeps_doubles ? 0 : 1);
        // Once the doubles are taken away, fp64 says why it is gone.
        if (!cases[i].keeps_doubles) assert_false(tier_available(fixture_context(), device, TIER_FP64));
        if (!cases[i].keeps_doubles) assert_non_null(strstr(fixture_state()->error.message, "would be wrong"));
        device->has_fp64 = has_fp64;
    }
    memset(device->arithmetic, 0, sizeof device->arithmetic);
    device->software = software;
}

static void test_checks_once(void **state) {
    (void)state;
    struct device *device = fixture_device();
    assert_true(tier_available(fixture_context(), device, TIER_FAST));
    assert_true(!device->software || tier_available(fixture_context(), device, TIER_ROBUST));
    assert_false(device->arithmetic[0].checked || device->arithmetic[1].checked);
    fixture_assert(tier_available(fixture_context(), device, TIER_EXACT));
    assert_true(device->arithmetic[0].checked && device->arithmetic[1].checked == device->has_fp64);
    const uint32_t pipelines = device->pipeline_count;
    fixture_assert(tier_available(fixture_context(), device, TIER_EXACT));
    assert_int_equal(device->pipeline_count, pipelines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device),   cmocka_unit_test(test_habits),      cmocka_unit_test(test_nan),
        cmocka_unit_test(test_verdicts), cmocka_unit_test(test_checks_once), cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
