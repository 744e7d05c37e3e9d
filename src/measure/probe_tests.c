// Limits come from the error bounds of shaders/tier_exact.glsl and box.glsl, or are Vulkan's ("Precision and Operation of SPIR-V
// Instructions").
#include "measure/probe_tests.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "render/arithmetic.h"

#define PI 3.14159265358979323846

// Short, for the table.
enum {
    FAST = PROBE_FAST,
    ROBUST = PROBE_ROBUST,
    EXACT = PROBE_EXACT,
    FP64 = PROBE_FP64,
    ALL = FAST | ROBUST | EXACT,
    SINGLE = PROBE_SINGLE,
    DOUBLE = PROBE_DOUBLE,
    BOTH = SINGLE | DOUBLE,
};
#define LARGEST PROBE_LARGEST
#define COUNT PROBE_COUNT
#define PRECISE(which)                                                                                                                     \
    { PROBE_ARITHMETIC, RESULT_##which }
#define PLAIN(function, which)                                                                                                             \
    { FUNCTION_##function, which }

// --------------------------------------------------------------------------------------------------------------- descriptions

static void describe_rounding(char *out, size_t capacity, const struct cases *cases, struct probe_result result) {
    uint32_t other = 0;
    for (uint32_t i = 0; i < cases->count; ++i) other += cases_result(cases, i, result.which) != arithmetic_rounded(cases, i, result.which);
    if (other)
        snprintf(out, capacity, "%u of %u are not the nearest number, ties to even", other, cases->count);
    else
        snprintf(out, capacity, "all of %u are the nearest number, ties to even", cases->count);
}

// Result `which` of the case that begins with a, b.
static double result_of(const struct cases *cases, double a, double b, uint32_t which) {
    for (uint32_t i = 0; i < cases->count; ++i) {
        const double *given = cases->given[i];
        if (!memcmp(&given[0], &a, sizeof a) && !memcmp(&given[1], &b, sizeof b)) return cases_result(cases, i, which);
    }
    return 0;
}

static void describe_number(char *out, size_t capacity, const struct cases *cases, struct probe_result result) {
    snprintf(out, capacity, "%.9g", cases_result(cases, 0, result.which));
}

static void describe_extremes(char *out, size_t capacity, const struct cases *cases, struct probe_result result) {
    (void)result;
    snprintf(out, capacity, "min(NaN, 1) = %g, min(1, NaN) = %g, max(NaN, 1) = %g, max(1, NaN) = %g", result_of(cases, NAN, 1, 0),
             result_of(cases, 1, NAN, 0), result_of(cases, NAN, 1, 1), result_of(cases, 1, NAN, 1));
}

static void describe_clamp(char *out, size_t capacity, const struct cases *cases, struct probe_result result) {
    for (uint32_t i = 0; i < cases->count; ++i) {
        const double *given = cases->given[i];
        if (isnan(given[0]) && given[1] == -2 && given[2] == 1)
            snprintf(out, capacity, "clamp(NaN, -2, 1) = %g", cases_result(cases, i, result.which));
    }
}

static void describe_integers(char *out, size_t capacity, const struct cases *cases, struct probe_result result) {
    const double given[] = {NAN, INFINITY, 0x1p100, -2};
    const char *names[] = {"NaN", "inf", "2^100", "-2"};
    (void)result;
    for (size_t i = 0, used = 0; i < sizeof given / sizeof *given && used < capacity; ++i) {
        uint32_t at = 0;
        while (at + 1 < cases->count && memcmp(&cases->given[at][0], &given[i], sizeof *given)) ++at;
        const int added = snprintf(out + used, capacity - used, "%s%s: int %d, uint %u", i ? "; " : "", names[i],
                                   (int)(int32_t)(uint32_t)cases_bits(cases, at, 0), (unsigned)cases_bits(cases, at, 1));
        used += added > 0 ? (size_t)added : 0;
    }
}

// ------------------------------------------------------------------------------------------------------------------ the table

const struct probe_test PROBE_TESTS[] = {
    // What decisions stand on.
    {"contraction of precise", BOTH, PRECISE(AREA), SAMPLES_EQUAL_PRODUCTS, 0, 0, probe_error_area, COUNT, "", 0, ROBUST | EXACT, FP64,
     "equal products differ: an edge has two looks", NULL},
    {"reordering of precise", BOTH, PRECISE(SUM_ERROR), SAMPLES_OPERANDS, 0, 0, probe_error_order, COUNT, "", 0, ROBUST | EXACT, FP64,
     "(a + b) - a is taken for b", NULL},
    {"sum", BOTH, PRECISE(SUM), SAMPLES_OPERANDS, 0, 0, probe_error_rounding, LARGEST, "ulp", ROUNDED_ULP, EXACT, FP64,
     "bounds of errors assume rounding to nearest", describe_rounding},
    {"difference", BOTH, PRECISE(DIFFERENCE), SAMPLES_OPERANDS, 0, 0, probe_error_rounding, LARGEST, "ulp", ROUNDED_ULP, EXACT, FP64,
     "the same", describe_rounding},
    {"product", BOTH, PRECISE(PRODUCT), SAMPLES_OPERANDS, 0, 0, probe_error_rounding, LARGEST, "ulp", ROUNDED_ULP, EXACT, FP64, "the same",
     describe_rounding},
    {"quotient", BOTH, PRECISE(QUOTIENT), SAMPLES_OPERANDS, 0, 0, probe_error_rounding, LARGEST, "ulp", QUOTIENT_ULP, ALL, FP64,
     "pads of boxes, bounds of errors: for Vulkan's 2.5 ulp", describe_rounding},
    {"square root", BOTH, PRECISE(ROOT), SAMPLES_OPERANDS, 0, 0, probe_error_rounding, LARGEST, "ulp", ROOT_ULP, ALL, FP64,
     "Vulkan: by inversesqrt and ÷, 4.5 ulp", describe_rounding},
    {"comparison", BOTH, PRECISE(COMPARED), SAMPLES_SPECIAL, 0, 0, probe_error_compared, COUNT, "", 0, ALL, FP64,
     "of NaN, too: if it does not fail, nonsense is a hit", NULL},
    {"rounding to fp32", DOUBLE, PLAIN(NARROW, 0), SAMPLES_UNIFORM, -100, 100, probe_error_narrow, LARGEST, "ulp", 0.87, 0, EXACT | FP64,
     "of t, u, v, right to an eighth of an ulp before it", NULL},
    {"two-sum", BOTH, PRECISE(SUM_ERROR), SAMPLES_OPERANDS, 0, 0, probe_error_two_sum, COUNT, "", 0, EXACT, 0,
     "what a + b is off by, wrong: origins that lose bits", NULL},
    // What could be built on, or compilers may do.
    {"two-product", BOTH, PRECISE(PRODUCT_ERROR), SAMPLES_OPERANDS, 0, 0, probe_error_two_product, COUNT, "", 0, 0, 0,
     "what a b is off by, by splitting, is found wrong", NULL},
    {"fma", BOTH, PLAIN(FMA, 0), SAMPLES_PRODUCT_ERRORS, 0, 0, probe_error_fused, COUNT, "", 0, 0, 0,
     "fma() is rounded once; gnomon never uses it", NULL},
    {"contraction", BOTH, PLAIN(MULTIPLY_ADD, 0), SAMPLES_PRODUCT_ERRORS, 0, 0, probe_error_fused, COUNT, "", 0, 0, 0,
     "a b + c without precise is rounded once", NULL},
    {"reordering", BOTH, PLAIN(CANCEL, 0), SAMPLES_HIDDEN, 0, 0, probe_error_simplified, COUNT, "", 0, 0, 0,
     "(a + b) - b without precise is taken for a", NULL},
    // Numbers at the edge.
    {"denormal operands flushed", BOTH, PRECISE(PRODUCT), SAMPLES_DENORMAL, 0, 0, probe_error_flushed, COUNT, "", 0, 0, 0,
     "allowed: exact decides rays with them elsewhere", NULL},
    {"denormal results flushed", BOTH, PRECISE(PRODUCT), SAMPLES_UNDERFLOW, 0, 0, probe_error_flushed, COUNT, "", 0, 0, 0,
     "allowed: every bound has room for it", NULL},
    {"overflow not infinite", BOTH, PRECISE(PRODUCT), SAMPLES_OVERFLOW, 0, 0, probe_error_not_infinite, COUNT, "", 0, 0, 0,
     "a b beyond the type", NULL},
    {"1/0 not infinite", BOTH, PRECISE(QUOTIENT), SAMPLES_SIGNED_ZEROS, 0, 0, probe_error_zero_quotient, COUNT, "", 0, 0, 0,
     "with its sign", NULL},
    {"signed zero", BOTH, PRECISE(SUM), SAMPLES_SIGNED_ZEROS, 0, 0, probe_error_zero_sign, COUNT, "", 0, 0, 0,
     "sums, products of zeros and ones: a wrong sign", NULL},
    {"min, max of NaN", BOTH, PLAIN(EXTREMES, 0), SAMPLES_SPECIAL, 0, 0, probe_error_nan_extreme, COUNT, "", 0, 0, 0,
     "is NaN; undefined in Vulkan, not asked by gnomon", describe_extremes},
    {"clamp of NaN", BOTH, PLAIN(CLAMP, 0), SAMPLES_SPECIAL, 0, 0, probe_error_nan_clamp, COUNT, "", 0, 0, 0,
     "is none of the limits; undefined in Vulkan", describe_clamp},
    {"isnan, isinf", BOTH, PLAIN(CLASS, 0), SAMPLES_SPECIAL, 0, 0, probe_error_class, COUNT, "", 0, 0, 0,
     "wrong answers; gnomon looks at the bits", NULL},
    {"to integer", SINGLE, PLAIN(TO_INTEGER, 0), SAMPLES_SPECIAL, 0, 0, probe_error_integer, COUNT, "", 0, 0, 0,
     "not the nearest there is, NaN not 0; undefined", describe_integers},
    // Functions. Those of sampling and shading need no more than Vulkan asks for.
    {"inversesqrt", BOTH, PLAIN(INVERSE_ROOT, 0), SAMPLES_LOGARITHMIC, -100, 100, probe_error_inverse_root, LARGEST, "ulp", 2.0001, FAST, 0,
     "fast normalizes by it; Vulkan: 2 ulp", NULL},
    {"length", SINGLE, PLAIN(LENGTH, 0), SAMPLES_VECTORS, -20, 20, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "ordinary vectors", NULL},
    {"length, tiny", SINGLE, PLAIN(LENGTH, 0), SAMPLES_VECTORS, -76, -74, probe_error_ulp, LARGEST, "ulp", 0, 0, 0,
     "vectors of 3e-23: squares are denormal", NULL},
    {"normalize", SINGLE, PLAIN(NORMALIZE, 0), SAMPLES_VECTORS, -20, 20, probe_error_ulp, LARGEST, "ulp", 0, 0, 0,
     "robust and exact scale and divide instead", NULL},
    {"normalize, tiny", SINGLE, PLAIN(NORMALIZE, 0), SAMPLES_VECTORS, -76, -74, probe_error_ulp, LARGEST, "ulp", 0, 0, 0,
     "vectors of 3e-23: squares are denormal", NULL},
    {"fract(-1e-9)", SINGLE, PLAIN(FRACT, 0), SAMPLES_SINGLE, -1e-9, 0, probe_error_none, LARGEST, "", 0, 0, 0, "1 is outside of [0, 1)",
     describe_number},
    {"exp2", SINGLE, PLAIN(EXP, 0), SAMPLES_UNIFORM, -125, 127, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "Vulkan: 3 + 2|x| ulp", NULL},
    {"exp", SINGLE, PLAIN(EXP, 1), SAMPLES_UNIFORM, -87, 88, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "Vulkan: 3 + 2|x| ulp", NULL},
    {"log2", SINGLE, PLAIN(LOG, 0), SAMPLES_LOGARITHMIC, 1, 100, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "from 2; Vulkan: 3 ulp", NULL},
    {"log2 near 1", SINGLE, PLAIN(LOG, 0), SAMPLES_UNIFORM, 0.5, 2, probe_error_absolute, LARGEST, "absolute", 0, 0, 0,
     "from ½ to 2; Vulkan: 2^-21 = 4.8e-7", NULL},
    {"log", SINGLE, PLAIN(LOG, 1), SAMPLES_LOGARITHMIC, 1, 100, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "from 2; Vulkan: 3 ulp", NULL},
    {"pow", SINGLE, PLAIN(POW, 0), SAMPLES_POWERS, 0.5, 1000, probe_error_ulp, LARGEST, "ulp", 0, 0, 0,
     "exponents to 1000; Vulkan: exp2 of a product with log2", NULL},
    {"pow, absolute", SINGLE, PLAIN(POW, 0), SAMPLES_POWERS, 0.5, 1000, probe_error_absolute, LARGEST, "absolute", 0x1p-10, ALL, 0,
     "of highlights; a quarter of an 8-bit step is allowed", NULL},
    {"sin", SINGLE, PLAIN(SIN, 0), SAMPLES_UNIFORM, -PI / 4, PI / 4, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "from -π/4 to π/4", NULL},
    {"sin, absolute", SINGLE, PLAIN(SIN, 0), SAMPLES_UNIFORM, -PI, PI, probe_error_absolute, LARGEST, "absolute", 0, 0, 0,
     "from -π to π; Vulkan: 2^-11 = 4.9e-4", NULL},
    {"cos, absolute", SINGLE, PLAIN(SIN, 1), SAMPLES_UNIFORM, -PI, PI, probe_error_absolute, LARGEST, "absolute", 0, 0, 0,
     "from -π to π; Vulkan: 2^-11", NULL},
    {"atan", SINGLE, PLAIN(ATAN, 0), SAMPLES_VECTORS, -20, 20, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "Vulkan: 4096 ulp", NULL},
    {"atan2", SINGLE, PLAIN(ATAN, 1), SAMPLES_VECTORS, -20, 20, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "Vulkan: 4096 ulp", NULL},
    {"acos", SINGLE, PLAIN(ACOS, 0), SAMPLES_UNIFORM, -1, 1, probe_error_ulp, LARGEST, "ulp", 0, 0, 0, "Vulkan: by atan2", NULL},
    {"acos, absolute", SINGLE, PLAIN(ACOS, 0), SAMPLES_UNIFORM, -1, 1, probe_error_absolute, LARGEST, "absolute", 0, 0, 0,
     "Vulkan: by atan2", NULL},
    {"asin, absolute", SINGLE, PLAIN(ACOS, 1), SAMPLES_UNIFORM, -1, 1, probe_error_absolute, LARGEST, "absolute", 0, 0, 0,
     "Vulkan: by atan2", NULL},
};

const size_t PROBE_TEST_COUNT = sizeof PROBE_TESTS / sizeof *PROBE_TESTS;
