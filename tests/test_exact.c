// Exact numbers against GMP: random and extreme operands, the longest expressions, brackets, rounding.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include "oracle.h"
#include "reference/exact.h"
#include "reference/fraction.h"
#include "reference/rounding.h"

#include <cmocka.h>

// Beyond the lowest bit of any product of ten numbers.
#define SHIFT 4096

static void to_gmp(mpz_t out, const struct exact *a) {
    mpz_import(out, a->count, -1, sizeof a->limb[0], 0, 0, a->limb);
    mpz_mul_2exp(out, out, (unsigned long)(SHIFT + 32 * a->exponent));
    if (a->sign < 0) mpz_neg(out, out);
}

static void set_gmp(mpz_t out, double x) {
    int power;
    mpz_set_d(out, ldexp(frexp(x, &power), 53));
    power += SHIFT - 53;
    mpz_mul_2exp(out, out, (unsigned long)power);
}

static void multiply_gmp(mpz_t out, const mpz_t a, const mpz_t b) {
    mpz_mul(out, a, b);
    mpz_fdiv_q_2exp(out, out, SHIFT);
}

static void check_equal(const struct exact *a, const mpz_t expected) {
    mpz_t found;
    mpz_init(found);
    to_gmp(found, a);
    assert_int_equal(mpz_cmp(found, expected), 0);
    assert_int_equal(a->sign, mpz_sgn(expected));
    if (a->count > 0) assert_true(a->limb[0] != 0 && a->limb[a->count - 1] != 0);
    mpz_clear(found);
}

// A double of the domain: few or many bits, any exponent, or an edge of the domain.
static double random_number(uint64_t *state) {
    static const double edges[] = {
        0, 1, -1, 0x1p-233, -0x1p-233, 0x1.fffffffffffffp130, -0x1.fffffffffffffp130, 0x1p130, 0x1p-149, 0x1.fffffep127};
    uint32_t kind = oracle_random(state) % 4;
    if (kind == 0) return edges[oracle_random(state) % (sizeof edges / sizeof edges[0])];
    int exponent = (int)(oracle_random(state) % 300) - 176;
    double x =
        kind == 1 ? (double)(oracle_random(state) % 16) : (double)oracle_random(state) * 0x1p-31 + (double)oracle_random(state) * 0x1p-52;
    if (kind == 3) exponent = (int)(oracle_random(state) % 4);
    x = ldexp(x, exponent - 4);
    return oracle_random(state) % 2 ? x : -x;
}

static void test_operations(void **unused) {
    (void)unused;
    uint64_t state = 1;
    mpz_t x, y, z;
    mpz_inits(x, y, z, (mpz_ptr)0);
    for (int i = 0; i < 40000; i++) {
        double p = random_number(&state), q = i % 7 == 0 ? p : i % 7 == 1 ? -p : random_number(&state);
        struct exact a, b, c;
        assert_true(exact_holds(p) && exact_holds(q));
        exact_set(&a, p), exact_set(&b, q);
        set_gmp(x, p), set_gmp(y, q);
        check_equal(&a, x);
        exact_add(&c, &a, &b), mpz_add(z, x, y);
        check_equal(&c, z);
        exact_sub(&c, &a, &b), mpz_sub(z, x, y);
        check_equal(&c, z);
        exact_mul(&c, &a, &b), multiply_gmp(z, x, y);
        check_equal(&c, z);
        assert_int_equal(exact_compare(&a, &b), (p > q) - (p < q));
        exact_sub(&a, &a, &b), mpz_sub(x, x, y); // in place
        check_equal(&a, x);
        exact_mul(&a, &a, &a), multiply_gmp(x, x, x);
        check_equal(&a, x);
    }
    mpz_clears(x, y, z, (mpz_ptr)0);
}

// Π of ten differences, plus and minus the product of ten others: the highest degree, from the highest bit to the lowest.
static void test_longest(void **unused) {
    (void)unused;
    uint64_t state = 2;
    mpz_t gmp[2], x, y;
    mpz_inits(gmp[0], gmp[1], x, y, (mpz_ptr)0);
    for (int i = 0; i < 2000; i++) {
        struct exact product[2], sum;
        for (int k = 0; k < 2; k++) {
            exact_set(&product[k], 1), set_gmp(gmp[k], 1);
            for (int n = 0; n < 10; n++) {
                bool extreme = i % 2 == 0;
                double p = extreme ? (k ? 0x1.fffffffffffffp130 : 0x1p-233) : random_number(&state);
                double q = extreme ? (oracle_random(&state) % 2 ? -0x1.fffffffffffffp130 : 0x1.8p-232) : random_number(&state);
                struct exact a, b;
                exact_set(&a, p), exact_set(&b, q), exact_sub(&a, &a, &b), exact_mul(&product[k], &product[k], &a);
                set_gmp(x, p), set_gmp(y, q), mpz_sub(x, x, y), multiply_gmp(gmp[k], gmp[k], x);
            }
        }
        exact_add(&sum, &product[0], &product[1]), mpz_add(x, gmp[0], gmp[1]);
        check_equal(&sum, x);
        exact_sub(&sum, &product[0], &product[1]), mpz_sub(x, gmp[0], gmp[1]);
        check_equal(&sum, x);
    }
    mpz_clears(gmp[0], gmp[1], x, y, (mpz_ptr)0);
}

static void test_holds(void **unused) {
    (void)unused;
    static const struct {
        double x;
        bool holds;
    } cases[] = {
        {0, true},           {0x1p-149, true},   {0x1p-150, true},
        {0x1p128, true},     {0x1p-233, true},   {0x1.8p-233, false},
        {0x1.1p-230, false}, {0x1p-234, false},  {0x1.fffffffffffffp130, true},
        {0x1p131, false},    {-0x1p131, false},  {0x1p-1074, false},
        {INFINITY, false},   {-INFINITY, false}, {NAN, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) assert_int_equal(exact_holds(cases[i].x), cases[i].holds);
}

// The bracket of a·b·c + d·e·f: contains it, and its ends are neighbours, or equal where a double is enough.
static void test_interval(void **unused) {
    (void)unused;
    uint64_t state = 3;
    mpfr_t exact, lo, hi;
    mpz_t z;
    mpfr_inits2(ORACLE_BITS, exact, lo, hi, (mpfr_ptr)0);
    mpz_init(z);
    for (int i = 0; i < 20000; i++) {
        struct exact product[2], a;
        for (int k = 0; k < 2; k++) {
            exact_set(&product[k], 1);
            for (int n = 0; n < 3; n++) exact_set(&a, random_number(&state)), exact_mul(&product[k], &product[k], &a);
        }
        exact_add(&a, &product[0], &product[1]);
        struct interval bracket = exact_interval(&a);
        to_gmp(z, &a);
        mpfr_set_z_2exp(exact, z, -SHIFT, MPFR_RNDN);
        double down = mpfr_get_d(exact, MPFR_RNDD), up = mpfr_get_d(exact, MPFR_RNDU);
        assert_true(bracket.lo <= down && up <= bracket.hi);
        assert_true(bracket.hi <= nextafter(bracket.lo, INFINITY));
        if (down == up) assert_true(bracket.lo == bracket.hi || a.count > 3);
    }
    mpz_clear(z);
    mpfr_clears(exact, lo, hi, (mpfr_ptr)0);
}

// (p + root·√f) / m to the nearest fp32, from a bracket that says nothing; among them ties, overflow, and numbers below the smallest
// denormal.
static void test_rounding(void **unused) {
    (void)unused;
    static const struct {
        double p, m, f;
        int root;
        float expected;
    } cases[] = {
        {1, 3, 0, 0, 1.0f / 3.0f},
        {0x1.000001p0, 1, 0, 0, 1}, // half-way: to even
        {0x1.000003p0, 1, 0, 0, 0x1.000004p0f},
        {0x1.0000010000001p0, 1, 0, 0, 0x1.000002p0f},       // just above
        {0x1.0000010000001p0, 0x1.0000000000001p0, 0, 0, 1}, // just below
        {-0x1.000003p0, 1, 0, 0, -0x1.000004p0f},
        {0x1.fffffep127, 1, 0, 0, 0x1.fffffep127f},
        {0x1.ffffffp127, 1, 0, 0, INFINITY}, // half-way to 2^128
        {0x1.fffffefffffffp127, 1, 0, 0, 0x1.fffffep127f},
        {-0x1p130, 0x1p-100, 0, 0, -INFINITY},
        {0x1p-150, 1, 0, 0, 0},
        {0x1.8p-149, 1, 0, 0, 0x1p-148f},
        {0x1.0000000000001p-150, 1, 0, 0, 0x1p-149f},
        {1, 0x1p130, 0, 0, 0x1p-130f},
        {0, 1, 0, 0, 0},
        {0, 1, 2, 1, 1.41421356237309504880f},
        {0, 1, 2, -1, -1.41421356237309504880f},
        {3, 1, 9, -1, 0},
        {1, 2, 5, 1, 1.61803398874989484820f},
        {0x1p24, 1, 0x1p48 - 1, -1, 0x1p-25f}, // 2^24 - √(2^48-1), a little more than 2^-25
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct fraction fraction = {.root = cases[i].root};
        exact_set(&fraction.p, cases[i].p);
        exact_set(&fraction.m, cases[i].m);
        exact_set(&fraction.f, cases[i].f);
        float found = round_fraction(&fraction, (struct interval){-INFINITY, INFINITY});
        if (found != cases[i].expected) fail_msg("case %zu: %a, expected %a", i, (double)found, (double)cases[i].expected);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_operations), cmocka_unit_test(test_longest),  cmocka_unit_test(test_holds),
        cmocka_unit_test(test_interval),   cmocka_unit_test(test_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
