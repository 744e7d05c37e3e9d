// Decimal numbers to fp32: the nearest, ties to even, whatever the locale. strtof does the same, but slowly and with the locale's point.
#ifndef SCENE_NUMBER_H
#define SCENE_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

// Reads the decimal number that starts at `at` (sign, digits with a point, exponent) and rounds it once. Returns the first byte behind it,
// or NULL when there is no number. "nan" and "inf" are numbers; what is beyond the range of fp32 becomes infinite. The text must end with a
// byte that is no part of a number, such as 0.
const char *number_f32(float *out, const char *at);

// Reads a decimal integer; what does not fit is cut to INT64_MIN or INT64_MAX. NULL when there is none.
const char *number_i64(int64_t *out, const char *at);

// Whether a double stands exactly midway between two neighbouring floats, or beyond them: the rounding of a decimal to fp64 may then have
// hidden on which side of the midpoint it was, and rounding again may go wrong.
bool number_is_midway(double value);

#endif
