#include "measure/probe_samples.h"

#include <float.h>
#include <math.h>

#include "render/arithmetic.h"

// -------------------------------------------------------------------------------------------------------------- random numbers

static uint64_t random_bits(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return *state ^ *state >> 33;
}

static double random_unit(uint64_t *state) { return (double)(random_bits(state) >> 11) * 0x1p-53; }
static double random_in(uint64_t *state, double low, double high) { return low + (high - low) * random_unit(state); }
static double random_sign(uint64_t *state) { return random_bits(state) >> 40 & 1 ? 1 : -1; }

// ±[1, 2) · 2^[-range, range].
static double random_number(uint64_t *state, int range) {
    const int exponent = (int)(random_bits(state) >> 20 & 0xffff) % (2 * range + 1) - range;
    return random_sign(state) * ldexp(random_in(state, 1, 2), exponent);
}

// An odd whole number of `bits` bits.
static double random_odd(uint64_t *state, int bits) { return ldexp(1, bits - 1) + 2 * floor(random_unit(state) * ldexp(1, bits - 2)) + 1; }

// ----------------------------------------------------------------------------------------------------------------- operands

static int digits_of(const struct cases *cases) { return cases->fp64 ? DBL_MANT_DIG : FLT_MANT_DIG; }

// The number a for which a / b, or without b its root, is near the middle of two numbers of the type: the best of some. With doubles the
// result is near a number: the host has no digit left for the middle.
static double near_tie(struct cases *cases, uint64_t *state, double b) {
    enum { TRIES = 16 };
    const int digits = digits_of(cases) + !cases->fp64;
    double best = 1, best_distance = INFINITY;
    for (int i = 0; i < TRIES; ++i) {
        const double result = ldexp(random_odd(state, digits), 1 - digits), factor = b != 0 ? b : result;
        const double a = round_to(cases->fp64, result * factor), distance = fabs(fma(result, factor, -a));
        if (distance < best_distance) best = a, best_distance = distance;
    }
    return best;
}

static void add_operands(struct cases *cases, uint64_t *state, uint32_t kind) {
    const bool fp64 = cases->fp64;
    const int digits = digits_of(cases);
    double a = round_to(fp64, random_number(state, 20)), b = round_to(fp64, random_number(state, 20));
    const double unit = ulp_of(fp64, a);
    switch (kind) {
    case 0: // sums: nearly equal
        b = -a * (1 + ldexp(random_in(state, -1, 1), -(int)(random_bits(state) >> 40 & 15)));
        break;
    case 1: // sums: a tie, or a little beside it
        b = random_sign(state) * unit * (0.5 + floor(random_in(state, 0, 4))) *
            (1 + (double)(random_bits(state) >> 40 & 1) * ldexp(1, 1 - digits));
        break;
    case 2: // sums: b vanishes
        b = random_sign(state) * unit * random_in(state, 0.001, 0.2);
        break;
    case 3: // products: one digit too many, and it is 1
        a = random_odd(state, digits / 2 + 1), b = random_sign(state) * random_odd(state, digits - digits / 2);
        break;
    case 4:
        b = round_to(fp64, random_in(state, 1, 2)), a = near_tie(cases, state, b);
        break;
    case 5:
        a = near_tie(cases, state, 0);
        break;
    case 6: // powers of two, and their neighbours
        a = ldexp(1, (int)(random_bits(state) >> 40 & 15)), a += ulp_of(fp64, a) * (double)((int)(random_bits(state) >> 40 & 3) - 1);
        break;
    default:
        break;
    }
    cases_add(cases, a, b, a, b);
}

// ------------------------------------------------------------------------------------------------------------------ special

static void fill_special(struct cases *cases) {
    const double special[] = {NAN, INFINITY, -INFINITY, 0.0, -0.0, 1.0, -2.0, 3.5, 0x1p100};
    const int count = sizeof special / sizeof *special;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            for (int k = 0; k < count; ++k) cases_add(cases, special[i], special[j], special[k], special[(i + k) % count]);
}

static void fill_signed_zeros(struct cases *cases) {
    const double values[] = {0.0, -0.0, 1.0, -1.0};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) cases_add(cases, values[i], values[k], 0, 0);
}

// ----------------------------------------------------------------------------------------------------------------- functions

static void add_random(struct cases *cases, uint64_t *state, enum probe_samples samples, double low, double high) {
    const double least = cases->fp64 ? DBL_MIN : FLT_MIN, most = cases->fp64 ? DBL_MAX : FLT_MAX;
    const double one = round_to(cases->fp64, random_in(state, 1, 2)), other = round_to(cases->fp64, random_in(state, 1, 2));
    double v[3];
    for (int i = 0; i < 3; ++i) v[i] = random_in(state, low, high);
    switch (samples) {
    case SAMPLES_EQUAL_PRODUCTS:
        cases_add(cases, one, other, one, other);
        break;
    case SAMPLES_PRODUCT_ERRORS:
        cases_add(cases, one, other, -(one * other), 0);
        break;
    case SAMPLES_HIDDEN:
        cases_add(cases, one, ldexp(other, 8 + (int)(random_bits(state) >> 40) % (digits_of(cases) - 6)), 0, 0);
        break;
    case SAMPLES_DENORMAL:
        cases_add(cases, least * random_unit(state), 0x1p30, 0, 0);
        break;
    case SAMPLES_UNDERFLOW:
        cases_add(cases, least * one, 0.5 * random_unit(state), 0, 0);
        break;
    case SAMPLES_OVERFLOW:
        cases_add(cases, random_sign(state) * most / one, 4 * other, 0, 0);
        break;
    case SAMPLES_LOGARITHMIC:
        cases_add(cases, exp2(v[0]), exp2(v[1]), exp2(v[2]), 0);
        break;
    case SAMPLES_VECTORS:
        cases_add(cases, random_sign(state) * exp2(v[0]), random_sign(state) * exp2(v[1]), random_sign(state) * exp2(v[2]), 0);
        break;
    case SAMPLES_POWERS:
        // The result is between 2^-100 and 1, and half of the bases are next to 1, as cosines of highlights are.
        cases_add(cases, exp2(-fmin(100, exp2(random_in(state, -20, 7))) * random_unit(state) / v[0]), v[0], 0, 0);
        break;
    default:
        cases_add(cases, v[0], v[1], v[2], 0);
        break;
    }
}

void probe_samples_fill(struct cases *cases, enum probe_samples samples, double low, double high) {
    uint64_t state = (uint64_t)samples + 1;
    cases->count = 0;
    if (samples == SAMPLES_SPECIAL) fill_special(cases);
    if (samples == SAMPLES_SIGNED_ZEROS) fill_signed_zeros(cases);
    if (samples == SAMPLES_SINGLE) cases_add(cases, low, low, low, low);
    if (cases->count > 0) return;
    while (cases->count < cases->capacity) {
        if (samples == SAMPLES_OPERANDS)
            add_operands(cases, &state, cases->count % 8);
        else
            add_random(cases, &state, samples, low, high);
    }
}
