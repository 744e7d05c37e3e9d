// The functions of math.glsl against MPFR, in fp32 and in fp64: on arguments of every size, and on those next to where the work is divided.
#include "twins.h"

#include <math.h>
#include <mpfr.h>

#include "twin_math.h"
#include "twin_math_fp64.h"

#define CASES 65536
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

// Numbers in and out of an invocation.
enum { TURNS, Y, X, EXPONENT, NUMBER, IN };
enum { SINE, COSINE, ARC, EXPONENTIAL, LOGARITHM, OUT };

static const char *const NAMES[OUT] = {"sine", "cosine", "arc", "exponential", "logarithm"};
static const double LIMITS[OUT] = {2, 2, 4, 2, 2}; // ulp

static double given[CASES][IN], got[CASES][OUT];

// --------------------------------------------------------------------------------------------------------------- inputs

// A number of either sign and any size from 2^low to 2^high.
static double random_size(int low, int high) {
    double size = ldexp(random_in(1, 2), low + (int)(random_bits() % (uint32_t)(high - low)));
    return random_bits() & 1 ? size : -size;
}

// One that is a few ulp from x.
static double next_to(double x, bool fp64) { return x + ((int)(random_bits() % 7) - 3) * fabs(x) * (fp64 ? 0x1p-52 : 0x1p-23); }

// Three kinds in turn: everyday sizes, next to where a function changes its ways, any size.
static void make_case(double in[IN], int i, bool fp64) {
    int kind = i % 3, most = fp64 ? 1000 : 124;
    in[TURNS] = kind == 0   ? random_in(-2, 2)
                : kind == 1 ? next_to((int)(random_bits() % 65) / 8.0 - 4, fp64)
                            : random_size(-most, fp64 ? 60 : 30);
    in[X] = kind == 2 ? random_size(-most, most) : random_in(-1, 1);
    in[Y] = kind == 0   ? random_in(-1, 1)
            : kind == 1 ? next_to(in[X] * (i & 8 ? 0.41421356 : i & 16 ? -1 : 2.41421356), fp64)
                        : in[X] * random_size(-20, 20);
    in[EXPONENT] = kind == 0   ? random_in(-1, 1)
                   : kind == 1 ? next_to(((int)(random_bits() % 100) - 49.5) * 0.6931471805599453, fp64)
                               : random_in(fp64 ? -708 : -87, fp64 ? 709 : 88);
    in[NUMBER] = kind == 0   ? random_in(0, 4)
                 : kind == 1 ? next_to(i & 8 ? 1 : i & 16 ? 1.4142135623730951 : 0.7071067811865476, fp64)
                             : fabs(random_size(-most, most));
    for (int k = 0; k < IN && !fp64; k++) in[k] = (float)in[k];
}

// ------------------------------------------------------------------------------------------------------------------ judge

// What `which` of `in` is, to 200 bits.
static void right_answer(mpfr_t out, int which, const double in[IN]) {
    mpfr_t a, b;
    mpfr_inits2(200, a, b, (mpfr_ptr)0);
    mpfr_set_d(a, in[which == ARC ? Y : which == EXPONENTIAL ? EXPONENT : which == LOGARITHM ? NUMBER : TURNS], MPFR_RNDN);
    mpfr_set_d(b, in[X], MPFR_RNDN);
    switch (which) {
    case SINE: mpfr_sinu(out, a, 1, MPFR_RNDN); break;
    case COSINE: mpfr_cosu(out, a, 1, MPFR_RNDN); break;
    case ARC: mpfr_atan2u(out, a, b, 1, MPFR_RNDN); break;
    case EXPONENTIAL: mpfr_exp(out, a, MPFR_RNDN); break;
    default: mpfr_log(out, a, MPFR_RNDN);
    }
    mpfr_clears(a, b, (mpfr_ptr)0);
}

// How far `value` is from the right answer, in ulp of that; 0 for what is right to the last bit, and for less than the least normal number
// 0 will do.
static double error_in_ulp(double value, int which, const double in[IN], bool fp64) {
    mpfr_t right, off;
    mpfr_inits2(200, right, off, (mpfr_ptr)0);
    right_answer(right, which, in);
    int least = fp64 ? -1022 : -126;
    bool tiny = mpfr_zero_p(right) || mpfr_get_exp(right) - 1 < least;
    long exponent = tiny ? least : (long)mpfr_get_exp(right) - 1;
    mpfr_set_d(off, value, MPFR_RNDN);
    mpfr_sub(off, off, right, MPFR_RNDN);
    mpfr_mul_2si(off, off, (fp64 ? 52 : 23) - exponent, MPFR_RNDN);
    double ulps = fabs(mpfr_get_d(off, MPFR_RNDN));
    if (tiny && value == 0) ulps = 0;
    mpfr_clears(right, off, (mpfr_ptr)0);
    return ulps;
}

static const struct twins MATH = {TWINS(twin_math), .in = IN, .out = OUT};

// Every result within its limit; the control, results that are off by the limit and 2 ulp, is caught.
static void check_errors(bool fp64) {
    for (int i = 0; i < CASES; i++) make_case(given[i], i, fp64);
    twins_run(&MATH, fp64, given[0], got[0], CASES);
    for (int which = 0; which < OUT; which++) {
        double worst = 0;
        int caught = 0;
        for (int i = 0; i < CASES; i++) {
            double ulps = error_in_ulp(got[i][which], which, given[i], fp64);
            if (!(ulps <= LIMITS[which]))
                fail_msg("fp%d, turns %a, y %a, x %a, exponent %a, number %a: %s %a is off by %g ulp", fp64 ? 64 : 32, given[i][TURNS],
                         given[i][Y], given[i][X], given[i][EXPONENT], given[i][NUMBER], NAMES[which], got[i][which], ulps);
            worst = fmax(worst, ulps);
            if (i >= 256) continue;
            double wrong = got[i][which] * (1 + 2 * (LIMITS[which] + 2) * (fp64 ? 0x1p-52 : 0x1p-23));
            caught += error_in_ulp(wrong, which, given[i], fp64) > LIMITS[which];
        }
        print_message("fp%d %s: %.2f ulp at most\n", fp64 ? 64 : 32, NAMES[which], worst);
        assert_true(caught >= 240);
    }
}

static void errors_in_fp32(void **state) {
    (void)state;
    check_errors(false);
}

static void errors_in_fp64(void **state) {
    (void)state;
    if (!fixture_device()->has_fp64) skip();
    check_errors(true);
}

// ------------------------------------------------------------------------------------------------------------- special values

struct special {
    const char *name;
    double in[IN];  // those of its function
    int which;
    double right;
};

static const struct special SPECIALS[] = {
    {"sin 0", {[TURNS] = 0}, SINE, 0},
    {"cos 0", {[TURNS] = 0}, COSINE, 1},
    {"sin of a quarter", {[TURNS] = 0.25}, SINE, 1},
    {"cos of a quarter", {[TURNS] = 0.25}, COSINE, 0},
    {"sin of a half", {[TURNS] = 0.5}, SINE, 0},
    {"cos of minus a half", {[TURNS] = -0.5}, COSINE, -1},
    {"sin of minus a quarter", {[TURNS] = -0.25}, SINE, -1},
    {"cos of a million and three quarters", {[TURNS] = 1000000.75}, COSINE, 0},
    {"sin of a million and three quarters", {[TURNS] = 1000000.75}, SINE, -1},
    {"cos of 1e30 turns", {[TURNS] = 0x1p100}, COSINE, 1},
    {"no direction", {[Y] = 0, [X] = 0}, ARC, 0},
    {"arc of +x", {[Y] = 0, [X] = 2}, ARC, 0},
    {"arc of the diagonal", {[Y] = 3, [X] = 3}, ARC, 0.125},
    {"arc of +y", {[Y] = 1, [X] = 0}, ARC, 0.25},
    {"arc of -y", {[Y] = -1, [X] = 0}, ARC, -0.25},
    {"arc of -x", {[Y] = 0, [X] = -1}, ARC, 0.5},
    {"arc of -x from below", {[Y] = -0.0, [X] = -1}, ARC, 0.5},
    {"arc next to -x", {[Y] = -1e-30, [X] = -1}, ARC, -0.5},
    {"arc of large numbers", {[Y] = -0x1p127, [X] = -0x1p127}, ARC, -0.375},
    {"arc of small numbers", {[Y] = 0x1p-126, [X] = -0x1p-126}, ARC, 0.375},
    {"e^0", {[EXPONENT] = 0}, EXPONENTIAL, 1},
    {"e^-infinity", {[EXPONENT] = -INFINITY}, EXPONENTIAL, 0},
    {"e^infinity", {[EXPONENT] = INFINITY}, EXPONENTIAL, INFINITY},
    {"e^-1e30", {[EXPONENT] = -1e30}, EXPONENTIAL, 0},
    {"e^1e30", {[EXPONENT] = 1e30}, EXPONENTIAL, INFINITY},
    {"ln 1", {[NUMBER] = 1}, LOGARITHM, 0},
    {"ln 0", {[NUMBER] = 0}, LOGARITHM, -INFINITY},
    {"ln -1", {[NUMBER] = -1}, LOGARITHM, -INFINITY},
    {"ln infinity", {[NUMBER] = INFINITY}, LOGARITHM, INFINITY},
};

static void check_specials(bool fp64) {
    uint32_t count = COUNT(SPECIALS);
    for (uint32_t i = 0; i < count; i++) memcpy(given[i], SPECIALS[i].in, sizeof given[i]);
    twins_run(&MATH, fp64, given[0], got[0], count);
    for (uint32_t i = 0; i < count; i++) {
        const struct special *s = &SPECIALS[i];
        if (!(got[i][s->which] == s->right)) fail_msg("fp%d %s is %a", fp64 ? 64 : 32, s->name, got[i][s->which]);
    }
}

static void special_values(void **state) {
    (void)state;
    check_specials(false);
    if (fixture_device()->has_fp64) check_specials(true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_in_fp32),
        cmocka_unit_test(errors_in_fp64),
        cmocka_unit_test(special_values),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
