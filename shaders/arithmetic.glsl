// What a device makes of the operations that the exact and fp64 tiers stand on. Included by arithmetic.comp, and with FP64 defined by
// arithmetic_fp64.comp.
#ifndef ARITHMETIC_GLSL
#define ARITHMETIC_GLSL
#include "cases.glsl"
#include "tier_robust.glsl"

// 2^12 + 1 and 2^27 + 1 halve 24 and 53 bits.
#ifdef FP64
#define SPLITTER 134217729.0lf
#else
#define SPLITTER 4097.0
#endif

// D. E. Knuth, The Art of Computer Programming, vol. 2, 4.2.2, theorem B.
real sum_error(real a, real b) {
    precise real sum = a + b;
    precise real b_there = sum - a;
    precise real a_there = sum - b_there;
    precise real error = (a - a_there) + (b - b_there);
    return error;
}

// T. J. Dekker, "A floating-point technique for extending the available precision", Numerische Mathematik 18, 1971: no fused multiply,
// which on some devices is none.
real product_error(real a, real b) {
    precise real a_scaled = SPLITTER * a, b_scaled = SPLITTER * b;
    precise real a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
    precise real a_low = a - a_high, b_low = b - b_high;
    precise real product = a * b;
    precise real error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return error;
}

real compared(real a, real b) {
    uint bits = (a < b ? COMPARED_LESS : 0u) | (a <= b ? COMPARED_LESS_EQUAL : 0u) | (a > b ? COMPARED_GREATER : 0u) |
                (a >= b ? COMPARED_GREATER_EQUAL : 0u) | (a == b ? COMPARED_EQUAL : 0u) | (a != b ? COMPARED_NOT_EQUAL : 0u) |
                (!(a < b) ? COMPARED_NOT_LESS : 0u) | (!(a >= b) ? COMPARED_NOT_GREATER_EQUAL : 0u);
    return real(bits);
}

void main() {
    uint number = gl_GlobalInvocationID.x, at = number * ARITHMETIC_COUNT;
    if (number >= case_count) return;
    real a = number_of(given[4u * number]), b = number_of(given[4u * number + 1u]);
    real c = number_of(given[4u * number + 2u]), d = number_of(given[4u * number + 3u]);
    precise real sum = a + b, difference = a - b, product = a * b, quotient = a / b, root = sqrt(abs(a)), other = c * d;
    results[at + RESULT_SUM] = word_of(sum);
    results[at + RESULT_DIFFERENCE] = word_of(difference);
    results[at + RESULT_PRODUCT] = word_of(product);
    results[at + RESULT_QUOTIENT] = word_of(quotient);
    results[at + RESULT_ROOT] = word_of(root);
    results[at + RESULT_AREA] = word_of(edge_function(real2(a, b), real2(c, d)));
    results[at + RESULT_SUM_ERROR] = word_of(sum_error(a, b));
    results[at + RESULT_PRODUCT_ERROR] = word_of(product_error(a, b));
    results[at + RESULT_COMPARED] = word_of(compared(a, b));
    results[at + RESULT_PRODUCT_COMPARED] = word_of(compared(other, a));
}

#endif
