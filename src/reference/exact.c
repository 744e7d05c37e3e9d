#include "reference/exact.h"

#include <assert.h>
#include <string.h>

// A number in the domain is a whole multiple of this.
#define LOWEST 0x1p-233
#define HIGHEST 0x1p131

bool exact_holds(double x) {
    double scaled = x * (1 / LOWEST); // exact, as nothing overflows or loses bits
    return fabs(x) < HIGHEST && floor(scaled) == scaled;
}

// Limb number `at` of the magnitude, counted from 2^0.
static uint32_t limb_at(const struct exact *a, int at) {
    return at >= a->exponent && at < a->exponent + (int)a->count ? a->limb[at - a->exponent] : 0;
}

// Drops zero limbs at both ends; without limbs the number is zero.
static void trim(struct exact *a) {
    while (a->count > 0 && a->limb[a->count - 1] == 0) a->count--;
    unsigned zeros = 0;
    while (zeros < a->count && a->limb[zeros] == 0) zeros++;
    a->count -= zeros;
    if (a->count == 0) {
        a->sign = a->exponent = 0;
    } else if (zeros > 0) {
        a->exponent += (int)zeros;
        memmove(a->limb, a->limb + zeros, a->count * sizeof a->limb[0]);
    }
}

static void copy(struct exact *out, const struct exact *a) {
    if (out == a) return;
    out->sign = a->sign;
    out->exponent = a->exponent;
    out->count = a->count;
    memcpy(out->limb, a->limb, a->count * sizeof a->limb[0]);
}

static int floor_div(int a, int b) { return (a >= 0 ? a : a - b + 1) / b; }

void exact_set(struct exact *out, double x) {
    assert(exact_holds(x));
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int power = (int)(bits >> 52 & 0x7ff) - 1075; // IEEE 754 binary64, normal: the domain has no denormals
    bits = (bits & 0xfffffffffffffu) | 0x10000000000000u;
    out->sign = (x > 0) - (x < 0);
    out->exponent = floor_div(power, 32);
    unsigned shift = (unsigned)(power - 32 * out->exponent);
    uint64_t low = (bits & 0xffffffffu) << shift, high = (bits >> 32) << shift;
    high += low >> 32;
    out->limb[0] = (uint32_t)low;
    out->limb[1] = (uint32_t)high;
    out->limb[2] = (uint32_t)(high >> 32);
    out->count = x == 0 ? 0 : 3;
    trim(out);
}

static int compare_magnitudes(const struct exact *a, const struct exact *b) {
    int top_a = a->exponent + (int)a->count, top_b = b->exponent + (int)b->count;
    if (a->count == 0 || b->count == 0) return (a->count > 0) - (b->count > 0);
    if (top_a != top_b) return top_a > top_b ? 1 : -1;
    int bottom = a->exponent < b->exponent ? a->exponent : b->exponent;
    for (int at = top_a - 1; at >= bottom; at--) {
        uint32_t x = limb_at(a, at), y = limb_at(b, at);
        if (x != y) return x > y ? 1 : -1;
    }
    return 0;
}

// |a| + |b|, or |a| - |b| for |a| >= |b|, both not zero.
static void combine_magnitudes(struct exact *out, const struct exact *a, const struct exact *b, bool subtract) {
    int top_a = a->exponent + (int)a->count, top_b = b->exponent + (int)b->count;
    int bottom = a->exponent < b->exponent ? a->exponent : b->exponent;
    int top = (top_a > top_b ? top_a : top_b) + 1;
    assert(top - bottom <= EXACT_LIMBS);
    struct exact sum;
    sum.exponent = bottom;
    sum.count = (unsigned)(top - bottom);
    int64_t carry = 0; // 0 or 1, or in a difference 0 or -1
    for (int at = bottom; at < top; at++) {
        int64_t y = limb_at(b, at);
        carry += (int64_t)limb_at(a, at) + (subtract ? -y : y);
        sum.limb[at - bottom] = (uint32_t)((uint64_t)carry & 0xffffffffu);
        carry = carry < 0 ? -1 : carry >> 32;
    }
    sum.sign = 1;
    trim(&sum);
    copy(out, &sum);
}

// a + sign·|b|.
static void add_signed(struct exact *out, const struct exact *a, const struct exact *b, int sign) {
    if (sign == 0) {
        copy(out, a);
    } else if (a->sign == 0) {
        copy(out, b);
        out->sign = sign;
    } else {
        int result = a->sign, order = compare_magnitudes(a, b);
        bool subtract = a->sign != sign;
        if (subtract && order < 0) {
            combine_magnitudes(out, b, a, true);
            result = sign;
        } else {
            combine_magnitudes(out, a, b, subtract);
        }
        out->sign *= result;
    }
}

void exact_add(struct exact *out, const struct exact *a, const struct exact *b) { add_signed(out, a, b, b->sign); }
void exact_sub(struct exact *out, const struct exact *a, const struct exact *b) { add_signed(out, a, b, -b->sign); }
void exact_negate(struct exact *out) { out->sign = -out->sign; }

void exact_mul(struct exact *out, const struct exact *a, const struct exact *b) {
    assert(a->count + b->count <= EXACT_LIMBS);
    struct exact product;
    product.sign = a->sign * b->sign;
    product.exponent = a->exponent + b->exponent;
    product.count = a->count + b->count;
    memset(product.limb, 0, product.count * sizeof product.limb[0]);
    for (unsigned i = 0; i < a->count; i++) {
        uint64_t carry = 0; // (2^32-1)² + 2·(2^32-1) = 2^64-1: never overflows
        for (unsigned j = 0; j < b->count; j++) {
            carry += (uint64_t)a->limb[i] * b->limb[j] + product.limb[i + j];
            product.limb[i + j] = (uint32_t)carry;
            carry >>= 32;
        }
        product.limb[i + b->count] = (uint32_t)carry;
    }
    trim(&product);
    copy(out, &product);
}

int exact_compare(const struct exact *a, const struct exact *b) {
    if (a->sign != b->sign) return a->sign > b->sign ? 1 : -1;
    return a->sign * compare_magnitudes(a, b);
}

struct interval exact_interval(const struct exact *a) {
    if (a->sign == 0) return (struct interval){0, 0};
    int top = a->exponent + (int)a->count;
    uint64_t bits = (uint64_t)limb_at(a, top - 1) << 32 | limb_at(a, top - 2);
    uint32_t next = limb_at(a, top - 3);
    int power = 32 * (top - 2);
    for (; !(bits >> 63); power--, next <<= 1) bits = bits << 1 | next >> 31;
    bool whole = a->count <= 3 && next == 0 && (bits & 0x7ff) == 0;
    double lo = ldexp((double)(bits >> 11), power + 11);
    double hi = whole ? lo : ldexp((double)((bits >> 11) + 1), power + 11);
    return a->sign > 0 ? (struct interval){lo, hi} : (struct interval){-hi, -lo};
}

void exact_set3(struct exact out[3], const double x[3]) {
    for (int i = 0; i < 3; i++) exact_set(&out[i], x[i]);
}

void exact_sub3(struct exact out[3], const struct exact a[3], const struct exact b[3]) {
    for (int i = 0; i < 3; i++) exact_sub(&out[i], &a[i], &b[i]);
}

void exact_cross(struct exact out[3], const struct exact a[3], const struct exact b[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        struct exact right;
        exact_mul(&out[i], &a[j], &b[k]);
        exact_mul(&right, &a[k], &b[j]);
        exact_sub(&out[i], &out[i], &right);
    }
}

void exact_dot(struct exact *out, const struct exact a[3], const struct exact b[3]) {
    struct exact term;
    exact_mul(out, &a[0], &b[0]);
    for (int i = 1; i < 3; i++) {
        exact_mul(&term, &a[i], &b[i]);
        exact_add(out, out, &term);
    }
}
