// What docs/right-answer.md says, word for word, in GMP integers and MPFR numbers of 8192 bits: the judge of the judge. Slow, and shares nothing
// with src/.
//
// Numbers enter times 2^300, which makes integers of them; all expressions are homogeneous, so that the factor cancels in t, u and v. Roots
// are MPFR's: two different t are further apart than 2^-4400 of their terms (their norm is a whole number of inputs of at most 440 bits,
// degree 10), so a difference below 2^-6000 is none.
#ifndef TESTS_ORACLE_H
#define TESTS_ORACLE_H

#include <gmp.h>
#include <math.h>
#include <mpfr.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#define ORACLE_BITS 8192
#define ORACLE_SCALE 300

struct oracle_ray {
    double o[3], d[3], tmin, tmax;
};

// A real number, and the size of what it is the difference of.
struct oracle_number {
    mpfr_t value, magnitude;
};

struct oracle_hit {
    bool hit;
    struct oracle_number t, u, v;
};

static inline void oracle_number_init(struct oracle_number *x) {
    mpfr_inits2(ORACLE_BITS, x->value, x->magnitude, (mpfr_ptr)0);
    mpfr_set_zero(x->value, 1);
    mpfr_set_zero(x->magnitude, 1);
}

static inline void oracle_hit_init(struct oracle_hit *hit) {
    hit->hit = false;
    oracle_number_init(&hit->t);
    oracle_number_init(&hit->u);
    oracle_number_init(&hit->v);
}

static inline void oracle_hit_clear(struct oracle_hit *hit) {
    mpfr_clears(hit->t.value, hit->t.magnitude, hit->u.value, hit->u.magnitude, hit->v.value, hit->v.magnitude, (mpfr_ptr)0);
}

// The sign of a - b.
static inline int oracle_compare(const struct oracle_number *a, const struct oracle_number *b) {
    mpfr_t difference, limit;
    mpfr_inits2(ORACLE_BITS, difference, limit, (mpfr_ptr)0);
    mpfr_sub(difference, a->value, b->value, MPFR_RNDN);
    mpfr_add(limit, a->magnitude, b->magnitude, MPFR_RNDN);
    mpfr_mul_2si(limit, limit, -6000, MPFR_RNDN);
    int sign = mpfr_cmpabs(difference, limit) <= 0 ? 0 : mpfr_sgn(difference);
    mpfr_clears(difference, limit, (mpfr_ptr)0);
    return sign;
}

static inline int oracle_compare_double(const struct oracle_number *a, double b) {
    struct oracle_number other;
    oracle_number_init(&other);
    mpfr_set_d(other.value, b, MPFR_RNDN);
    if (isfinite(b)) mpfr_abs(other.magnitude, other.value, MPFR_RNDN);
    int sign = isinf(b) ? (b > 0 ? -1 : 1) : oracle_compare(a, &other);
    mpfr_clears(other.value, other.magnitude, (mpfr_ptr)0);
    return sign;
}

// The nearest fp32.
static inline float oracle_round(const struct oracle_number *a) {
    return oracle_compare_double(a, 0) == 0 ? 0 : mpfr_get_flt(a->value, MPFR_RNDN);
}

typedef mpz_t oracle_vec[3];

static inline void oracle_vec_init(oracle_vec a) { mpz_inits(a[0], a[1], a[2], (mpz_ptr)0); }
static inline void oracle_vec_clear(oracle_vec a) { mpz_clears(a[0], a[1], a[2], (mpz_ptr)0); }

static inline void oracle_set(mpz_t out, double x) {
    int exponent;
    mpz_set_d(out, ldexp(frexp(x, &exponent), 53));
    exponent += ORACLE_SCALE - 53;
    if (exponent >= 0)
        mpz_mul_2exp(out, out, (unsigned long)exponent);
    else
        mpz_tdiv_q_2exp(out, out, (unsigned long)-exponent);
}

static inline void oracle_cross(oracle_vec out, const oracle_vec a, const oracle_vec b) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(out[i], a[j], b[k]);
        mpz_submul(out[i], a[k], b[j]);
    }
}

static inline void oracle_dot(mpz_t out, const oracle_vec a, const oracle_vec b) {
    mpz_mul(out, a[0], b[0]);
    mpz_addmul(out, a[1], b[1]);
    mpz_addmul(out, a[2], b[2]);
}

static inline void oracle_quotient(struct oracle_number *out, const mpz_t numerator, const mpz_t denominator) {
    mpfr_t divisor;
    mpfr_init2(divisor, ORACLE_BITS);
    mpfr_set_z(divisor, denominator, MPFR_RNDN);
    mpfr_set_z(out->value, numerator, MPFR_RNDN);
    mpfr_div(out->value, out->value, divisor, MPFR_RNDN);
    mpfr_abs(out->magnitude, out->value, MPFR_RNDN);
    mpfr_clear(divisor);
}

// f(p,q) = d · ((q-o) × (p-o)); b[] are vertices minus o. A zero is given the sign of the first non-zero component of (q-p) × d.
static inline int oracle_edge(mpz_t f, const oracle_vec d, const oracle_vec p, const oracle_vec q) {
    oracle_vec cross;
    oracle_vec_init(cross);
    oracle_cross(cross, q, p);
    oracle_dot(f, d, cross);
    int sign = mpz_sgn(f);
    if (sign == 0) {
        oracle_vec edge;
        oracle_vec_init(edge);
        for (int i = 0; i < 3; i++) mpz_sub(edge[i], q[i], p[i]);
        oracle_cross(cross, edge, d);
        for (int i = 0; i < 3 && sign == 0; i++) sign = mpz_sgn(cross[i]);
        oracle_vec_clear(edge);
    }
    oracle_vec_clear(cross);
    return sign;
}

static inline bool oracle_inside(const struct oracle_ray *ray, const struct oracle_number *t) {
    return oracle_compare_double(t, ray->tmin) > 0 && oracle_compare_double(t, ray->tmax) < 0;
}

// x·N with N = (v1-v0) × (v2-v0).
static inline void oracle_along_normal(mpz_t out, const oracle_vec x, const oracle_vec b[3]) {
    oracle_vec e1, e2, n;
    oracle_vec_init(e1), oracle_vec_init(e2), oracle_vec_init(n);
    for (int i = 0; i < 3; i++) {
        mpz_sub(e1[i], b[1][i], b[0][i]);
        mpz_sub(e2[i], b[2][i], b[0][i]);
    }
    oracle_cross(n, e1, e2);
    oracle_dot(out, x, n);
    oracle_vec_clear(e1), oracle_vec_clear(e2), oracle_vec_clear(n);
}

// Fills *out, which is initialised.
static inline void oracle_triangle(struct oracle_hit *out, const struct oracle_ray *ray, const float *const v[3]) {
    oracle_vec d, b[3];
    mpz_t f[3], sum, height, slope, origin;
    oracle_vec_init(d);
    mpz_inits(f[0], f[1], f[2], sum, height, slope, origin, (mpz_ptr)0);
    for (int i = 0; i < 3; i++) {
        oracle_vec_init(b[i]);
        oracle_set(d[i], ray->d[i]);
        for (int k = 0; k < 3; k++) {
            oracle_set(b[i][k], v[i][k]);
            oracle_set(origin, ray->o[k]);
            mpz_sub(b[i][k], b[i][k], origin);
        }
    }
    int u = oracle_edge(f[0], d, b[1], b[2]), w = oracle_edge(f[2], d, b[0], b[1]), v_ = oracle_edge(f[1], d, b[2], b[0]);
    mpz_add(sum, f[0], f[1]);
    mpz_add(sum, sum, f[2]);
    out->hit = mpz_sgn(sum) != 0 && u == v_ && v_ == w && u != 0;
    if (out->hit) {
        oracle_along_normal(height, b[0], (const oracle_vec *)b);
        oracle_along_normal(slope, d, (const oracle_vec *)b);
        oracle_quotient(&out->t, height, slope);
        oracle_quotient(&out->u, f[1], sum);
        oracle_quotient(&out->v, f[2], sum);
        out->hit = oracle_inside(ray, &out->t);
    }
    oracle_vec_clear(d);
    for (int i = 0; i < 3; i++) oracle_vec_clear(b[i]);
    mpz_clears(f[0], f[1], f[2], sum, height, slope, origin, (mpz_ptr)0);
}

// (b ± √F) / a.
static inline void oracle_root(struct oracle_number *out, const mpz_t a, const mpz_t b, const mpz_t f, int sign) {
    mpfr_t x, root;
    mpfr_inits2(ORACLE_BITS, x, root, (mpfr_ptr)0);
    mpfr_set_z(root, f, MPFR_RNDN);
    mpfr_sqrt(root, root, MPFR_RNDN);
    mpfr_set_z(x, b, MPFR_RNDN);
    if (sign > 0)
        mpfr_add(out->value, x, root, MPFR_RNDN);
    else
        mpfr_sub(out->value, x, root, MPFR_RNDN);
    mpfr_abs(x, x, MPFR_RNDN);
    mpfr_add(out->magnitude, x, root, MPFR_RNDN);
    mpfr_set_z(x, a, MPFR_RNDN);
    mpfr_div(out->value, out->value, x, MPFR_RNDN);
    mpfr_div(out->magnitude, out->magnitude, x, MPFR_RNDN);
    mpfr_clears(x, root, (mpfr_ptr)0);
}

static inline void oracle_sphere(struct oracle_hit *out, const struct oracle_ray *ray, const float center[3], float radius) {
    oracle_vec l, d, x;
    mpz_t a, b, f, r, square;
    oracle_vec_init(l), oracle_vec_init(d), oracle_vec_init(x);
    mpz_inits(a, b, f, r, square, (mpz_ptr)0);
    for (int i = 0; i < 3; i++) {
        oracle_set(l[i], center[i]);
        oracle_set(d[i], ray->o[i]);
        mpz_sub(l[i], l[i], d[i]);
        oracle_set(d[i], ray->d[i]);
    }
    oracle_set(r, radius);
    oracle_dot(a, d, d);
    oracle_dot(b, l, d);
    oracle_cross(x, l, d);
    oracle_dot(square, x, x);
    mpz_mul(f, r, r);
    mpz_mul(f, f, a);
    mpz_sub(f, f, square);
    out->hit = false;
    for (int sign = -1; sign <= 1 && mpz_sgn(f) >= 0 && !out->hit; sign += 2) {
        oracle_root(&out->t, a, b, f, sign);
        out->hit = oracle_inside(ray, &out->t);
    }
    oracle_vec_clear(l), oracle_vec_clear(d), oracle_vec_clear(x);
    mpz_clears(a, b, f, r, square, (mpz_ptr)0);
}

// A small random generator (xorshift64*, Marsaglia and Vigna).
static inline uint32_t oracle_random(uint64_t *state) {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (uint32_t)(*state * 0x2545f4914f6cdd1du >> 32);
}

// In [0, 1).
static inline double oracle_uniform(uint64_t *state) { return oracle_random(state) * 0x1p-32; }

#endif
