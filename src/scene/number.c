// Decimal to fp32, rounded once. Based on W. D. Clinger, "How to read floating point numbers accurately", 1990: where digits and power of
// ten are both exact in fp64, one operation gives the nearest fp64; and the fp32 nearest to that is right unless it stood midway between
// two floats. Whatever is not that easy goes to strtof, as integer digits with an exponent, so that no locale has a say.
#include "scene/number.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Digits that decide a rounding to fp32: a midpoint between two floats has at most 113 of them. One more says "and something after".
#define MOST_DIGITS 120

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

// ±mantissa × 10^exponent. `cut`: digits other than 0 were left out of the mantissa.
struct decimal {
    bool negative, cut;
    uint64_t mantissa; // the first 19 digits or so
    int64_t exponent;
    const char *digits; // first digit or point
};

// The exponent behind the digits, if one is there; "1e" and "1e+" are the number 1 and a rest.
static const char *exponent_scan(int64_t *exponent, const char *at) {
    if (*at != 'e' && *at != 'E') return at;
    const char *p = at + 1;
    bool negative = *p == '-';
    if (*p == '-' || *p == '+') p++;
    if (!is_digit(*p)) return at;
    int64_t value = 0;
    for (; is_digit(*p); p++)
        if (value < INT64_C(1000000000000)) value = value * 10 + (*p - '0');
    *exponent += negative ? -value : value;
    return p;
}

static const char *decimal_scan(struct decimal *out, const char *at) {
    *out = (struct decimal){.negative = *at == '-'};
    if (*at == '-' || *at == '+') at++;
    out->digits = at;
    bool point = false, any = false;
    for (;; at++) {
        if (is_digit(*at)) {
            any = true;
            if (out->mantissa < UINT64_C(1000000000000000000)) {
                out->mantissa = out->mantissa * 10 + (uint64_t)(*at - '0');
                out->exponent -= point;
            } else {
                out->cut |= *at != '0';
                out->exponent += !point;
            }
        } else if (*at == '.' && !point) {
            point = true;
        } else {
            break;
        }
    }
    return any ? exponent_scan(&out->exponent, at) : NULL;
}

bool number_is_midway(double value) {
    double size = fabs(value);
    if (size == 0) return false;
    if (!(size >= FLT_MIN && size <= FLT_MAX)) return true;
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits & 0x1fffffff) == 0x10000000; // the 29 bits that fp64 has and fp32 has not
}

static bool decimal_round_fast(float *out, const struct decimal *decimal) {
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (FLT_EVAL_METHOD != 0 || decimal->cut || decimal->mantissa > UINT64_C(1) << 53) return false;
    if (decimal->exponent < -22 || decimal->exponent > 22) return false;
    double value = (double)decimal->mantissa;
    value = decimal->exponent < 0 ? value / powers[-decimal->exponent] : value * powers[decimal->exponent];
    if (number_is_midway(value)) return false;
    *out = (float)value;
    return true;
}

static float decimal_round_slowly(const struct decimal *decimal) {
    char text[MOST_DIGITS + 32];
    size_t length = 0;
    int64_t exponent = decimal->exponent, kept = 0;
    bool more = false;
    for (const char *p = decimal->digits; is_digit(*p) || *p == '.'; p++) {
        if (*p == '.' || (length == 0 && *p == '0')) continue;
        if (length < MOST_DIGITS)
            text[length++] = *p;
        else
            more |= *p != '0';
    }
    if (length == 0) return 0;
    for (uint64_t m = decimal->mantissa; m; m /= 10) kept++;
    exponent -= (int64_t)length - kept; // decimal->exponent belongs to the digits in the mantissa
    if (more) {
        text[length++] = '1';
        exponent--;
    }
    int reach = exponent > 100000 ? 100000 : exponent < -100000 ? -100000 : (int)exponent;
    snprintf(text + length, sizeof text - length, "e%d", reach);
    return strtof(text, NULL);
}

// Whether `word` (lower case) stands at `at`, in any case.
static bool word_at(const char *at, const char *word) {
    while (*word && (*at | 0x20) == *word) at++, word++;
    return *word == '\0';
}

static const char *special_scan(float *out, const char *at) {
    bool negative = *at == '-';
    if (*at == '-' || *at == '+') at++;
    if (word_at(at, "nan")) {
        *out = NAN;
        return at + 3;
    }
    if (!word_at(at, "inf")) return NULL;
    *out = negative ? -INFINITY : INFINITY;
    return at + (word_at(at, "infinity") ? 8 : 3);
}

const char *number_f32(float *out, const char *at) {
    struct decimal decimal;
    const char *end = decimal_scan(&decimal, at);
    if (!end) return special_scan(out, at);
    if (!decimal_round_fast(out, &decimal)) *out = decimal_round_slowly(&decimal);
    if (decimal.negative) *out = -*out;
    return end;
}

const char *number_i64(int64_t *out, const char *at) {
    bool negative = *at == '-';
    if (*at == '-' || *at == '+') at++;
    if (!is_digit(*at)) return NULL;
    const uint64_t limit = (uint64_t)INT64_MAX + negative;
    uint64_t value = 0;
    for (; is_digit(*at); at++) {
        uint64_t digit = (uint64_t)(*at - '0');
        value = value > (limit - digit) / 10 ? limit : value * 10 + digit;
    }
    *out = !negative ? (int64_t)value : value == limit ? INT64_MIN : -(int64_t)value;
    return at;
}
