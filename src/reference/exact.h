// Exact numbers: integers times a power of two, as wide as it takes, for decisions that fp64 cannot make.
//
// A number is sign × Σ limb[i]·2^(32·(exponent + i)). Sums, differences and products are exact. Only as many limbs are touched as the
// number needs, so ordinary cases are cheap; the capacity covers the worst.
//
// Capacity: what enters is a double that is a multiple of 2^-233 and below 2^131 (exact_holds): every fp32 number, the half-way cases
// between two, and the origins and directions of shadow rays. Differences of two are below 2^132. A homogeneous expression of degree n in
// such differences is a multiple of 2^(-233·n) and smaller than (number of terms)·2^(132·n). The highest degree is 10 (a sphere's t against
// a triangle's, fraction.h) with fewer than 2^16 terms: bits -2330 to 1336, limbs -73 to 41, 115 in all; a product before its zeros are
// trimmed may have one more at either end.
#ifndef REFERENCE_EXACT_H
#define REFERENCE_EXACT_H

#include <stdbool.h>
#include <stdint.h>

#include "reference/interval.h"

#define EXACT_LIMBS 128

// Zeroed is zero.
struct exact {
    int sign;       // -1, 0 or 1
    int exponent;   // of limb[0], in limbs
    unsigned count; // limbs in use; the first and the last of them are not 0
    uint32_t limb[EXACT_LIMBS];
};

// Whether x may enter: finite, a multiple of 2^-233, below 2^131 in magnitude.
bool exact_holds(double x);

// A coordinate made one that may enter: what is below 2^-180, a 2^-31th of the smallest fp32 number, counts as 0.
static inline double exact_snap(double x) { return fabs(x) < 0x1p-180 ? 0 : x; }

// In all of these `out` may be one of the operands.
void exact_set(struct exact *out, double x); // x as exact_holds says
void exact_add(struct exact *out, const struct exact *a, const struct exact *b);
void exact_sub(struct exact *out, const struct exact *a, const struct exact *b);
void exact_mul(struct exact *out, const struct exact *a, const struct exact *b);
void exact_negate(struct exact *out);

// The sign of a - b.
int exact_compare(const struct exact *a, const struct exact *b);

// Two neighbouring doubles around a, or a twice. For |a| between 2^-1021 and 2^1023: expressions of degree 4 at most.
struct interval exact_interval(const struct exact *a);

// Vectors; `out` must not be an operand.
void exact_set3(struct exact out[3], const double x[3]);
void exact_sub3(struct exact out[3], const struct exact a[3], const struct exact b[3]);
void exact_cross(struct exact out[3], const struct exact a[3], const struct exact b[3]);
void exact_dot(struct exact *out, const struct exact a[3], const struct exact b[3]);

#endif
