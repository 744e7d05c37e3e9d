// The cases: random numbers, pairs of equal products (whose difference is 0, or else what a fused multiply leaves), ties of rounding,
// numbers that hide each other in a sum; and all pairs of what is special.
#include "render/arithmetic.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "shaders/shared.h"

// ---------------------------------------------------------------------------------------------------------------- right answers

double ulp_of(bool fp64, double x) {
    const int digits = fp64 ? DBL_MANT_DIG : FLT_MANT_DIG, least = fp64 ? DBL_MIN_EXP : FLT_MIN_EXP;
    int exponent;
    frexp(x, &exponent);
    return ldexp(1, (exponent > least ? exponent : least) - digits);
}

double round_to(bool fp64, double x) { return fp64 ? x : (double)(float)x; }

uint32_t compared(double a, double b) {
    return (a < b ? COMPARED_LESS : 0u) | (a <= b ? COMPARED_LESS_EQUAL : 0u) | (a > b ? COMPARED_GREATER : 0u) |
           (a >= b ? COMPARED_GREATER_EQUAL : 0u) | (a == b ? COMPARED_EQUAL : 0u) | (a != b ? COMPARED_NOT_EQUAL : 0u) |
           (!(a < b) ? COMPARED_NOT_LESS : 0u) | (!(a >= b) ? COMPARED_NOT_GREATER_EQUAL : 0u);
}

// A number as a double and what is missing in it: exact for sums and products, nearly so for quotients and roots.
struct long_number {
    double head, tail;
};

static struct long_number long_sum(double a, double b) {
    const double sum = a + b, there = sum - a;
    return (struct long_number){sum, (a - (sum - there)) + (b - there)};
}

static struct long_number right_result(const double given[4], uint32_t result) {
    const double a = given[0], b = given[1];
    switch (result) {
    case RESULT_SUM:
        return long_sum(a, b);
    case RESULT_DIFFERENCE:
        return long_sum(a, -b);
    case RESULT_PRODUCT:
        return (struct long_number){a * b, fma(a, b, -(a * b))};
    case RESULT_QUOTIENT:
        return (struct long_number){a / b, fma(-(a / b), b, a) / b};
    default: {
        const double root = sqrt(fabs(a));
        return (struct long_number){root, fma(-root, root, fabs(a)) / (2 * root)};
    }
    }
}

// A sum, product, quotient or root of fp32 that is rounded to fp64 first is rounded right all the same: 53 >= 2 · 24 + 2 (S. A. Figueroa,
// "When is double rounding innocuous?", 1995).
double arithmetic_rounded(const struct cases *cases, uint32_t i, uint32_t result) {
    return round_to(cases->fp64, right_result(cases->given[i], result).head);
}

double arithmetic_sum_error(const struct cases *cases, uint32_t i) {
    const struct long_number sum = right_result(cases->given[i], RESULT_SUM);
    return (sum.head - cases_result(cases, i, RESULT_SUM)) + sum.tail;
}

double arithmetic_error(const struct cases *cases, uint32_t i, uint32_t result) {
    const struct long_number right = right_result(cases->given[i], result);
    const double got = cases_result(cases, i, result), size = fabs(right.head);
    if (size == 0) return got == 0 ? 0 : INFINITY;
    const bool normal = cases->fp64 ? size >= DBL_MIN && size <= DBL_MAX / 2 : size >= FLT_MIN && size <= FLT_MAX / 2;
    if (!normal) return 0;
    const double error = fabs((got - right.head) - right.tail) / ulp_of(cases->fp64, right.head);
    return isnan(error) ? INFINITY : error;
}

// -------------------------------------------------------------------------------------------------------------------- judging

static uint32_t add_if(uint32_t fault, bool wrong) { return wrong ? fault : 0; }

// Of a case of ordinary numbers.
static uint32_t number_faults(const struct cases *cases, uint32_t i) {
    const double *given = cases->given[i], a = given[0], b = given[1];
    uint32_t faults = 0;
    for (uint32_t result = RESULT_SUM; result <= RESULT_PRODUCT; ++result)
        faults |= add_if(FAULT_ROUNDS, !(arithmetic_error(cases, i, result) <= ROUNDED_ULP));
    if (a == given[2] && b == given[3]) faults |= add_if(FAULT_CONTRACTS, cases_result(cases, i, RESULT_AREA) != 0);
    if (cases_result(cases, i, RESULT_SUM) == arithmetic_rounded(cases, i, RESULT_SUM))
        faults |= add_if(FAULT_REORDERS, cases_result(cases, i, RESULT_SUM_ERROR) != arithmetic_sum_error(cases, i));
    faults |= add_if(FAULT_DIVIDES, !(arithmetic_error(cases, i, RESULT_QUOTIENT) <= QUOTIENT_ULP));
    faults |= add_if(FAULT_ROOTS, !(arithmetic_error(cases, i, RESULT_ROOT) <= ROOT_ULP));
    return faults;
}

// Finite, and none of their products and quotients beyond the type.
static bool is_ordinary(const struct cases *cases, uint32_t i) {
    const double most = cases->fp64 ? 0x1p400 : 0x1p60;
    for (int k = 0; k < 4; ++k) {
        const double size = fabs(cases->given[i][k]);
        if (!(size >= 1 / most && size <= most)) return false;
    }
    return true;
}

static bool compares(const struct cases *cases, uint32_t i) {
    const double *given = cases->given[i], product = round_to(cases->fp64, given[2] * given[3]);
    return cases_result(cases, i, RESULT_COMPARED) == compared(given[0], given[1]) &&
           cases_result(cases, i, RESULT_PRODUCT_COMPARED) == compared(product, given[0]);
}

uint32_t arithmetic_faults(const struct cases *cases) {
    uint32_t faults = 0;
    for (uint32_t i = 0; i < cases->count; ++i) {
        faults |= is_ordinary(cases, i) ? number_faults(cases, i) : add_if(FAULT_COMPARES, !compares(cases, i));
    }
    return faults;
}

const char *arithmetic_fault_text(uint32_t faults) {
#define X(number, id, text)                                                                                                                \
    if (faults & FAULT_##id) return text;
    ARITHMETIC_FAULTS(X)
#undef X
    return NULL;
}

// ------------------------------------------------------------------------------------------------------------------- checking

enum { RANDOM_CASES = 64, SPECIAL_COUNT = 8, CHECK_CASES = 2 * RANDOM_CASES + SPECIAL_COUNT * SPECIAL_COUNT };

// A number with random digits, in ±[2^-16, 2^16).
static double random_number(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    const double digits = 1 + (double)(*state >> 12) * 0x1p-52;
    const int exponent = (int)(*state >> 33 & 31) - 16;
    return ldexp(*state >> 32 & 1 ? -digits : digits, exponent);
}

static void add_cases(struct cases *cases) {
    const double special[SPECIAL_COUNT] = {NAN, INFINITY, -INFINITY, 0.0, -0.0, 1.0, -2.0, 0x1p100};
    const double share[4] = {0.5, 1.5, 0.3, -0.1}; // of a unit in a's last place
    uint64_t state = 1;
    for (int i = 0; i < RANDOM_CASES; ++i) {
        const double a = random_number(&state), b = random_number(&state), c = random_number(&state), d = random_number(&state);
        cases_add(cases, a, b, a, b);
        cases_add(cases, c, share[i % 4] * ulp_of(cases->fp64, c), d, a);
    }
    for (int i = 0; i < SPECIAL_COUNT; ++i)
        for (int k = 0; k < SPECIAL_COUNT; ++k) cases_add(cases, special[i], special[k], special[k], special[(i + k) % SPECIAL_COUNT]);
}

bool arithmetic_cases_init(struct cases *out, struct context *ctx, bool fp64) {
    if (!cases_init(out, ctx, fp64, CHECK_CASES)) return false;
    add_cases(out);
    return true;
}

static bool check(uint32_t *faults, struct context *ctx, struct device *device, bool fp64) {
    struct cases cases;
    if (!arithmetic_cases_init(&cases, ctx, fp64)) return false;
    const bool done = cases_run_arithmetic(&cases, ctx, device);
    if (done) *faults = arithmetic_faults(&cases);
    cases_finish(&cases);
    return done;
}

static bool check_once(struct context *ctx, struct device *device, bool fp64) {
    struct device_arithmetic *known = &device->arithmetic[fp64];
    if (!known->checked && !check(&known->faults, ctx, device, fp64)) return false;
    known->checked = true;
    return true;
}

// Faults that a tier cannot live with. Rounding is monotone in any direction, and that is all that the robust tier asks of it.
static uint32_t fatal_faults(uint32_t tier) { return tier == TIER_ROBUST ? ~(uint32_t)FAULT_ROUNDS : ~0u; }

static bool accept(struct context *ctx, const struct device *device, uint32_t tier, const char *name, bool fp64) {
    const uint32_t faults = device->arithmetic[fp64].faults & fatal_faults(tier);
    if (!faults) return true;
    return fail(ctx, GN_NO_DEVICE,
                "accuracy '%s' would be wrong with the %s arithmetic of %s (%s): %s; the reference (--reference) is right everywhere", name,
                fp64 ? "fp64" : "fp32", device->info.name, device->info.driver, arithmetic_fault_text(faults));
}

static void take_doubles_away(struct context *ctx, struct device *device) {
    notify(ctx, GN_LEVEL_WARNING, "the doubles of %s are not used: %s", device->info.name,
           arithmetic_fault_text(device->arithmetic[true].faults));
    device->has_fp64 = false;
}

bool arithmetic_suffices(struct context *ctx, struct device *device, uint32_t tier) {
    const bool robust = tier == TIER_ROBUST && !device->software, exact = tier == TIER_EXACT, doubles = tier == TIER_FP64;
    if ((exact || doubles) && device->has_fp64 && !check_once(ctx, device, true)) return false;
    if ((exact || robust) && !check_once(ctx, device, false)) return false;
    if (doubles) return accept(ctx, device, tier, "fp64", true);
    if (robust) return accept(ctx, device, tier, "robust", false);
    if (!exact) return true;
    if (!accept(ctx, device, tier, "exact", false)) return false;
    if (device->has_fp64 && device->arithmetic[true].faults) take_doubles_away(ctx, device);
    return true;
}
