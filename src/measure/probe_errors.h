// How far off a result is: the errors that the probe's table names, one of a case. Negative: this case says nothing.
//
// Right answers: sums, products, quotients and roots exactly (render/arithmetic.h); functions of fp32 by the C library's doubles, 29 bits
// beyond.
#ifndef MEASURE_PROBE_ERRORS_H
#define MEASURE_PROBE_ERRORS_H

#include "render/cases.h"

// Of a RESULT_* of arithmetic.comp, or of a result of a FUNCTION_*.
struct probe_result {
    uint32_t function; // FUNCTION_*, or PROBE_ARITHMETIC
    uint32_t which;
};
#define PROBE_ARITHMETIC 0xffffffffu

typedef double probe_error(const struct cases *cases, uint32_t i, struct probe_result result);

// In ulp.
probe_error probe_error_rounding;     // of the first five RESULT_*
probe_error probe_error_ulp;          // of a function of fp32
probe_error probe_error_inverse_root; // of fp32 and fp64
probe_error probe_error_narrow;       // of fp64 to fp32, in ulp of that

// Absolute.
probe_error probe_error_absolute;
probe_error probe_error_none; // the result itself

// 1 where it is wrong, 0 where not.
probe_error probe_error_area;        // the difference of equal products is not 0
probe_error probe_error_order;       // a sum that hides b: the error is not b
probe_error probe_error_two_sum;     // sum and error are not a + b
probe_error probe_error_two_product; // product and error are not a b
probe_error probe_error_compared;
probe_error probe_error_flushed;       // the product is 0, and should not be
probe_error probe_error_not_infinite;  // the product is not infinite
probe_error probe_error_zero_quotient; // a / ±0 is not infinite, or of the wrong sign
probe_error probe_error_zero_sign;     // a zero sum or product of the wrong sign
probe_error probe_error_fused;         // a b + c is not what is left of two roundings
probe_error probe_error_simplified;    // (a + b) - b is a
probe_error probe_error_nan_extreme;   // the minimum or maximum of a number and NaN is NaN
probe_error probe_error_nan_clamp;     // of NaN to two numbers: not one of them
probe_error probe_error_class;
probe_error probe_error_integer; // not the nearest number that there is, NaN not 0

// The right result of a function of fp32.
double probe_right(const double given[4], struct probe_result result);

#endif
