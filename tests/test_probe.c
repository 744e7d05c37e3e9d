// The probe: its right answers against MPFR, its numbers are as nasty as they claim, every error that it looks for is found when it is put
// there, and what it says of the device at hand.
#include "fixture.h"
#include "program.h"

#include <float.h>
#include <math.h>
#include <mpfr.h>

#include "measure/probe.h"
#include "measure/probe_tests.h"
#include "render/arithmetic.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define BITS 200
#define NUMBERS 4096

static double random_in(uint64_t *state, double low, double high) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*state >> 11) * 0x1p-53;
}

static void put(struct cases *cases, uint32_t i, uint32_t which, double value) {
    const size_t at = (size_t)i * cases->result_count + which;
    if (cases->fp64)
        ((double *)cases->results)[at] = value;
    else
        ((float *)cases->results)[at] = (float)value;
}

// --------------------------------------------------------------------------------------------------------------- right answers

static void set_length(mpfr_t out, const double given[4]) {
    mpfr_t square;
    mpfr_init2(square, BITS);
    mpfr_set_zero(out, 1);
    for (int i = 0; i < 3; ++i) {
        mpfr_set_d(square, given[i], MPFR_RNDN);
        mpfr_sqr(square, square, MPFR_RNDN);
        mpfr_add(out, out, square, MPFR_RNDN);
    }
    mpfr_sqrt(out, out, MPFR_RNDN);
    mpfr_clear(square);
}

// The right result in 200 bits.
static void set_right(mpfr_t out, const double given[4], struct probe_result result) {
    mpfr_t a, b;
    mpfr_inits2(BITS, a, b, (mpfr_ptr)0);
    mpfr_set_d(a, given[0], MPFR_RNDN), mpfr_set_d(b, given[1], MPFR_RNDN);
    const bool first = result.which == 0;
    switch (result.function) {
    case FUNCTION_FRACT:
        mpfr_floor(b, a), mpfr_sub(out, a, b, MPFR_RNDN);
        break;
    case FUNCTION_LENGTH:
        set_length(out, given);
        break;
    case FUNCTION_NORMALIZE:
        set_length(out, given), mpfr_div(out, a, out, MPFR_RNDN);
        break;
    case FUNCTION_EXP:
        (first ? mpfr_exp2 : mpfr_exp)(out, a, MPFR_RNDN);
        break;
    case FUNCTION_LOG:
        (first ? mpfr_log2 : mpfr_log)(out, a, MPFR_RNDN);
        break;
    case FUNCTION_POW:
        mpfr_pow(out, a, b, MPFR_RNDN);
        break;
    case FUNCTION_SIN:
        (first ? mpfr_sin : mpfr_cos)(out, a, MPFR_RNDN);
        break;
    case FUNCTION_ATAN:
        if (first)
            mpfr_atan(out, a, MPFR_RNDN);
        else
            mpfr_atan2(out, a, b, MPFR_RNDN);
        break;
    case FUNCTION_ACOS:
        (first ? mpfr_acos : mpfr_asin)(out, a, MPFR_RNDN);
        break;
    default:
        fail_msg("no right answer for function %u", result.function);
    }
    mpfr_clears(a, b, (mpfr_ptr)0);
}

// The functions of fp32 whose right answers are the C library's doubles: off by less than 2^-20 ulp of fp32.
static void test_functions(void **state) {
    (void)state;
    struct cases cases;
    mpfr_t right;
    mpfr_init2(right, BITS);
    fixture_assert(cases_init(&cases, fixture_context(), false, NUMBERS));
    size_t tested = 0;
    for (size_t t = 0; t < PROBE_TEST_COUNT; ++t) {
        const struct probe_test *test = &PROBE_TESTS[t];
        if (test->error != probe_error_ulp && test->error != probe_error_absolute) continue;
        ++tested;
        probe_samples_fill(&cases, test->samples, test->low, test->high);
        for (uint32_t i = 0; i < cases.count; ++i) {
            const double ours = probe_right(cases.given[i], test->result);
            set_right(right, cases.given[i], test->result);
            mpfr_sub_d(right, right, ours, MPFR_RNDN);
            const double off = fabs(mpfr_get_d(right, MPFR_RNDN)) / ulp_of(false, ours);
            if (!(off <= 0x1p-20)) fail_msg("%s of %.17g, %.17g: off by %g ulp", test->name, cases.given[i][0], cases.given[i][1], off);
        }
    }
    assert_true(tested >= 15);
    cases_finish(&cases);
    mpfr_clear(right);
}

static void set_operation(mpfr_t out, const double given[4], uint32_t result) {
    mpfr_t b;
    mpfr_init2(b, BITS);
    mpfr_set_d(out, given[0], MPFR_RNDN), mpfr_set_d(b, given[1], MPFR_RNDN);
    if (result == RESULT_SUM) mpfr_add(out, out, b, MPFR_RNDN);
    if (result == RESULT_DIFFERENCE) mpfr_sub(out, out, b, MPFR_RNDN);
    if (result == RESULT_PRODUCT) mpfr_mul(out, out, b, MPFR_RNDN);
    if (result == RESULT_QUOTIENT) mpfr_div(out, out, b, MPFR_RNDN);
    if (result == RESULT_ROOT) mpfr_abs(out, out, MPFR_RNDN), mpfr_sqrt(out, out, MPFR_RNDN);
    mpfr_clear(b);
}

// Errors of results that are up to 3 ulp off, and the right results themselves.
static void test_operations(void **state) {
    (void)state;
    mpfr_t right, off;
    mpfr_inits2(BITS, right, off, (mpfr_ptr)0);
    for (int fp64 = 0; fp64 < 2; ++fp64) {
        struct cases cases;
        uint64_t random = 3;
        fixture_assert(cases_init(&cases, fixture_context(), fp64, NUMBERS));
        probe_samples_fill(&cases, SAMPLES_OPERANDS, 0, 0);
        cases.result_count = ARITHMETIC_COUNT;
        for (uint32_t i = 0; i < cases.count; ++i) {
            for (uint32_t result = RESULT_SUM; result <= RESULT_ROOT; ++result) {
                set_operation(right, cases.given[i], result);
                const double nearest = fp64 ? mpfr_get_d(right, MPFR_RNDN) : (double)mpfr_get_flt(right, MPFR_RNDN);
                assert_true(arithmetic_rounded(&cases, i, result) == nearest);
                put(&cases, i, result, round_to(fp64, nearest + ulp_of(fp64, nearest) * floor(random_in(&random, -3, 4))));
                mpfr_sub_d(off, right, cases_result(&cases, i, result), MPFR_RNDN);
                const double error = fabs(mpfr_get_d(off, MPFR_RNDN)) / ulp_of(fp64, mpfr_get_d(right, MPFR_RNDN));
                const double ours = arithmetic_error(&cases, i, result);
                if (nearest != 0 && !(fabs(ours - error) <= 1e-6))
                    fail_msg("%g, %g, result %u: %g ulp, not %g", cases.given[i][0], cases.given[i][1], result, ours, error);
            }
        }
        cases_finish(&cases);
    }
    mpfr_clears(right, off, (mpfr_ptr)0);
}

static void test_inverse_root(void **state) {
    (void)state;
    mpfr_t right;
    mpfr_init2(right, BITS);
    for (int fp64 = 0; fp64 < 2; ++fp64) {
        struct cases cases;
        uint64_t random = 4;
        fixture_assert(cases_init(&cases, fixture_context(), fp64, NUMBERS));
        probe_samples_fill(&cases, SAMPLES_LOGARITHMIC, -100, 100);
        cases.result_count = 2;
        for (uint32_t i = 0; i < cases.count; ++i) {
            mpfr_set_d(right, cases.given[i][0], MPFR_RNDN);
            mpfr_rec_sqrt(right, right, MPFR_RNDN);
            const double near = mpfr_get_d(right, MPFR_RNDN), ulp = ulp_of(fp64, near);
            put(&cases, i, 0, round_to(fp64, near + ulp * floor(random_in(&random, -3, 4))));
            mpfr_sub_d(right, right, cases_result(&cases, i, 0), MPFR_RNDN);
            const double error = fabs(mpfr_get_d(right, MPFR_RNDN)) / ulp;
            const double ours = probe_error_inverse_root(&cases, i, (struct probe_result){FUNCTION_INVERSE_ROOT, 0});
            if (!(fabs(ours - error) <= 1e-5)) fail_msg("1/sqrt(%g): %g ulp, not %g", cases.given[i][0], ours, error);
        }
        cases_finish(&cases);
    }
    mpfr_clear(right);
}

// ------------------------------------------------------------------------------------------------------------------- numbers

// How many exact results lie in the middle of two numbers, or within a 32nd of an ulp of it.
static void test_ties(void **state) {
    (void)state;
    struct cases cases;
    const struct {
        uint32_t result;
        double within;
        uint32_t least;
    } kinds[] = {{RESULT_SUM, 0, 1000},
                 {RESULT_DIFFERENCE, 0, 1000},
                 {RESULT_PRODUCT, 0, 1000},
                 {RESULT_QUOTIENT, 0.04, 7000},
                 {RESULT_ROOT, 0.04, 7000}};
    fixture_assert(cases_init(&cases, fixture_context(), false, PROBE_CASES));
    probe_samples_fill(&cases, SAMPLES_OPERANDS, 0, 0);
    assert_int_equal(cases.count, PROBE_CASES);
    cases.result_count = ARITHMETIC_COUNT;
    for (size_t k = 0; k < COUNT(kinds); ++k) {
        uint32_t ties = 0;
        for (uint32_t i = 0; i < cases.count; ++i) {
            put(&cases, i, kinds[k].result, arithmetic_rounded(&cases, i, kinds[k].result));
            ties += arithmetic_error(&cases, i, kinds[k].result) >= 0.5 - kinds[k].within;
        }
        if (ties < kinds[k].least) fail_msg("result %u: %u ties", kinds[k].result, ties);
    }
    cases_finish(&cases);
}

// ------------------------------------------------------------------------------------------------------- errors that are put there

// What is made of a result; the case must then be wrong.
static double spoil(const struct probe_test *test, const struct cases *cases, uint32_t i, double result) {
    const double *given = cases->given[i];
    if (test->error == probe_error_area || test->error == probe_error_fused) return 0x1p-40;
    if (test->error == probe_error_compared) return (double)((uint32_t)result ^ COMPARED_LESS_EQUAL);
    if (test->error == probe_error_flushed || test->error == probe_error_not_infinite) return 0;
    if (test->error == probe_error_simplified) return given[0];
    if (test->error == probe_error_zero_quotient || test->error == probe_error_zero_sign) return -result;
    if (test->error == probe_error_nan_extreme || test->error == probe_error_nan_clamp) return NAN;
    if (test->error == probe_error_class || test->error == probe_error_integer) return result == 0 ? 1 : 0;
    if (test->error == probe_error_absolute) return result + 0.01;
    if (test->error == probe_error_none) return 2;
    if (test->error == probe_error_narrow) return 0;
    return result + (test->limit + 2) * ulp_of(cases->fp64, result != 0 ? result : given[1]);
}

static double least_error(const struct probe_test *test) {
    if (test->value == PROBE_LARGEST && test->needed_by) return test->limit;
    return test->error == probe_error_absolute ? 0.005 : 0.5;
}

// Every test of the table, on every type: a result of the device that is spoiled is found.
static void test_spoiled(void **state) {
    (void)state;
    struct device *device = fixture_device();
    for (size_t t = 0; t < PROBE_TEST_COUNT; ++t) {
        const struct probe_test *test = &PROBE_TESTS[t];
        for (int fp64 = 0; fp64 <= (int)device->has_fp64; ++fp64) {
            struct cases cases;
            uint32_t judged = 0, found = 0;
            if (!(test->types & (fp64 ? PROBE_DOUBLE : PROBE_SINGLE))) continue;
            fixture_assert(cases_init(&cases, fixture_context(), fp64, 1024));
            probe_samples_fill(&cases, test->samples, test->low, test->high);
            if (test->result.function == PROBE_ARITHMETIC)
                fixture_assert(cases_run_arithmetic(&cases, fixture_context(), device));
            else
                fixture_assert(cases_run_function(&cases, fixture_context(), device, test->result.function));
            for (uint32_t i = 0; i < cases.count; ++i) {
                const double result = cases_result(&cases, i, test->result.which), before = test->error(&cases, i, test->result);
                if (before < 0 || isnan(result)) continue;
                put(&cases, i, test->result.which, spoil(test, &cases, i, result));
                const double after = test->error(&cases, i, test->result);
                ++judged;
                found += after > least_error(test);
            }
            if (judged == 0 || found < judged - judged / 8) fail_msg("%s, fp%d: %u of %u", test->name, fp64 ? 64 : 32, found, judged);
            cases_finish(&cases);
        }
    }
}

// ------------------------------------------------------------------------------------------------------------------- verdicts

static void test_judge(void **state) {
    (void)state;
    struct gn_probe_tier tiers[GN_ACCURACY_COUNT];
    const struct gn_probe_row rows[] = {
        {.name = "fp32 this", .value = 1, .needed_by = PROBE_FAST | PROBE_EXACT},
        {.name = "fp32 quotient",
         .value = 7.5,
         .limit = 2.5,
         .unit = "ulp",
         .needed_by = PROBE_ROBUST | PROBE_EXACT,
         .breaks = PROBE_ROBUST},
        {.name = "fp64 sum", .value = 1.5, .limit = 0.5, .unit = "ulp", .needed_by = PROBE_FP64, .breaks = PROBE_FP64},
    };
    const struct {
        uint32_t rows;
        bool has_fp64;
        uint32_t available, ok;
    } cases[] = {
        {0, true, 15, 15},
        {1, true, 15, 15},
        {2, true, 15, 15 & ~PROBE_ROBUST},
        {3, true, 15, PROBE_FAST | PROBE_EXACT},
        {3, false, 15 & ~PROBE_FP64, PROBE_FAST | PROBE_EXACT},
        {0, false, 15 & ~PROBE_FP64, 15 & ~PROBE_FP64},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        probe_judge(tiers, rows, cases[i].rows, cases[i].has_fp64);
        for (int t = 0; t < GN_ACCURACY_COUNT; ++t) {
            assert_int_equal(tiers[t].available, cases[i].available >> t & 1);
            assert_int_equal(tiers[t].ok, cases[i].ok >> t & 1);
            assert_true(*tiers[t].because);
        }
        if (cases[i].rows > 1) assert_string_equal(tiers[GN_ROBUST].because, "fp32 quotient: 7.5 ulp, and may be 2.5 at most");
    }
}

// Stops at the second question.
static bool stop(void *user, const struct gn_progress *progress) {
    (void)progress;
    return ++*(int *)user < 2;
}

static void test_device(void **state) {
    (void)state;
    static struct gn_probe_row rows[GN_PROBE_ROWS], few[5];
    struct device *device = fixture_device();
    uint32_t count = 0, few_count = 0;
    fixture_assert(probe_measure(rows, GN_PROBE_ROWS, &count, fixture_context(), device));
    assert_true(count > 30 && count < GN_PROBE_ROWS);
    for (uint32_t i = 0; i < count; ++i) {
        assert_true(*rows[i].name && *rows[i].meaning && !isnan(rows[i].value));
        for (uint32_t k = 0; k < i; ++k) assert_string_not_equal(rows[i].name, rows[k].name);
        if (rows[i].breaks) fail_msg("%s: %g %s, %s", rows[i].name, rows[i].value, rows[i].unit, rows[i].detail);
    }
    fixture_assert(probe_measure(few, COUNT(few), &few_count, fixture_context(), device));
    assert_int_equal(few_count, COUNT(few));
    assert_memory_equal(few, rows, sizeof few);

    int asked = 0;
    struct context *ctx = fixture_context();
    ctx->host.user = &asked, ctx->host.progress = stop;
    assert_false(probe_measure(rows, GN_PROBE_ROWS, &count, ctx, device));
    assert_int_equal(ctx->error->status, GN_CANCELLED);
    assert_int_equal(count, 0);
}

// ------------------------------------------------------------------------------------------------------------------ the program

static void test_program(void **state) {
    (void)state;
    fixture_device();
    for (int hidden = 0; hidden < 2; ++hidden) {
        const char *words = hidden ? "probe --json --hide-fp64" : "probe --json";
        struct program_result result = program_expect(words, 0, "");
        json_t *object = program_json(words, &result), *row;
        const bool doubles = !hidden && fixture_device()->has_fp64;
        size_t i, wide = 0;
        json_array_foreach(json_object_get(object, "rows"), i, row) {
            const char *keys[] = {"name", "unit", "meaning", "detail"};
            for (size_t k = 0; k < COUNT(keys); ++k) assert_true(json_is_string(json_object_get(row, keys[k])));
            assert_true(json_object_get(row, "value") && json_is_array(json_object_get(row, "needed_by")));
            assert_true(json_is_true(json_object_get(row, "ok")));
            wide += strncmp(json_string_value(json_object_get(row, "name")), "fp64", 4) == 0;
        }
        assert_true(i > 30 && doubles == (wide > 0));
        const json_t *tiers = json_object_get(object, "tiers");
        assert_true(json_is_true(json_object_get(tiers, "fast")) && json_is_true(json_object_get(tiers, "robust")));
        assert_true(json_is_true(json_object_get(tiers, "exact")) && json_boolean_value(json_object_get(tiers, "fp64")) == doubles);
        assert_true(json_is_string(json_object_get(object, "device")) && json_is_string(json_object_get(object, "driver")));
        json_decref(object);
        program_free(&result);
    }
    struct program_result table = program_expect("probe --hide-fp64 -q", 0, "");
    const char *says[] = {"WHAT", "quotient", "\nfast    ok", "\nrobust  ok", "\nexact   ok", "\nfp64    absent the device has no doubles"};
    for (size_t i = 0; i < COUNT(says); ++i)
        if (!strstr(table.out, says[i])) fail_msg("no '%s' in\n%s", says[i], table.out);
    program_free(&table);
    table = program_expect("probe scene.json", 2, "takes none");
    program_free(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_functions), cmocka_unit_test(test_operations), cmocka_unit_test(test_inverse_root),
        cmocka_unit_test(test_ties),      cmocka_unit_test(test_spoiled),    cmocka_unit_test(test_judge),
        cmocka_unit_test(test_device),    cmocka_unit_test(test_program),    cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
