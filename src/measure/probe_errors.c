#include "measure/probe_errors.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "render/arithmetic.h"

// In ulp of `right`; a NaN is as wrong as can be.
static double ulps(bool fp64, double got, double right) {
    if (got == right || (isnan(got) && isnan(right))) return 0;
    const double error = fabs(got - right) / ulp_of(fp64, right);
    return isnan(error) ? INFINITY : error;
}

// ---------------------------------------------------------------------------------------------------------------- arithmetic

double probe_error_rounding(const struct cases *cases, uint32_t i, struct probe_result result) {
    return arithmetic_error(cases, i, result.which);
}

double probe_error_area(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    return cases_result(cases, i, RESULT_AREA) != 0;
}

double probe_error_order(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double *given = cases->given[i];
    if (cases_result(cases, i, RESULT_SUM) != given[0] || given[1] == 0) return -1;
    return cases_result(cases, i, RESULT_SUM_ERROR) != given[1];
}

double probe_error_two_sum(const struct cases *cases, uint32_t i, struct probe_result result) {
    return cases_result(cases, i, result.which) != arithmetic_sum_error(cases, i);
}

double probe_error_two_product(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double error = fma(cases->given[i][0], cases->given[i][1], -cases_result(cases, i, RESULT_PRODUCT));
    return cases_result(cases, i, result.which) != error;
}

double probe_error_compared(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double *given = cases->given[i], product = round_to(cases->fp64, given[2] * given[3]);
    return cases_result(cases, i, RESULT_COMPARED) != compared(given[0], given[1]) ||
           cases_result(cases, i, RESULT_PRODUCT_COMPARED) != compared(product, given[0]);
}

double probe_error_flushed(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double *given = cases->given[i];
    return round_to(cases->fp64, given[0] * given[1]) == 0 ? -1 : cases_result(cases, i, RESULT_PRODUCT) == 0;
}

double probe_error_not_infinite(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    return cases_result(cases, i, RESULT_PRODUCT) != round_to(cases->fp64, cases->given[i][0] * cases->given[i][1]);
}

double probe_error_zero_quotient(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double a = cases->given[i][0], b = cases->given[i][1];
    return a == 0 || b != 0 ? -1 : cases_result(cases, i, RESULT_QUOTIENT) != a * copysign(INFINITY, b);
}

static bool wrong_sign(double got, double right) { return got != right || signbit(got) != signbit(right); }

double probe_error_zero_sign(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double a = cases->given[i][0], b = cases->given[i][1];
    return wrong_sign(cases_result(cases, i, RESULT_SUM), a + b) || wrong_sign(cases_result(cases, i, RESULT_PRODUCT), a * b);
}

// ------------------------------------------------------------------------------------------- expressions that may be rearranged

double probe_error_fused(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double *given = cases->given[i];
    if (fma(given[0], given[1], given[2]) == 0) return -1;
    return cases_result(cases, i, result.which) != 0;
}

double probe_error_simplified(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double a = cases->given[i][0], b = cases->given[i][1];
    if (round_to(cases->fp64, round_to(cases->fp64, a + b) - b) == a) return -1;
    return cases_result(cases, i, result.which) == a;
}

// --------------------------------------------------------------------------------------------------------------- NaN and kinds

double probe_error_nan_extreme(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double a = cases->given[i][0], b = cases->given[i][1];
    if (isnan(a) == isnan(b)) return -1;
    return isnan(cases_result(cases, i, 0)) || isnan(cases_result(cases, i, 1));
}

double probe_error_nan_clamp(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double *given = cases->given[i], got = cases_result(cases, i, result.which);
    if (!isnan(given[0]) || !(given[1] <= given[2])) return -1;
    return got != given[1] && got != given[2];
}

double probe_error_class(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double a = cases->given[i][0];
    return cases_result(cases, i, 0) != (isnan(a) ? 1 : 0) || cases_result(cases, i, 1) != (isinf(a) ? 1 : 0);
}

static double saturated(double x, double low, double high) { return isnan(x) ? 0 : x < low ? low : x > high ? high : trunc(x); }

double probe_error_integer(const struct cases *cases, uint32_t i, struct probe_result result) {
    (void)result;
    const double a = cases->given[i][0];
    const bool whole = cases_bits(cases, i, 0) == (uint32_t)(int32_t)saturated(a, INT32_MIN, INT32_MAX);
    return !whole || cases_bits(cases, i, 1) != (uint32_t)saturated(a, 0, UINT32_MAX);
}

// ----------------------------------------------------------------------------------------------------------------- functions

static double first_or_second(uint32_t which, double first, double second) { return which == 0 ? first : second; }

double probe_right(const double given[4], struct probe_result result) {
    const double a = given[0], b = given[1], c = given[2], length = sqrt(a * a + b * b + c * c);
    switch (result.function) {
    case FUNCTION_FRACT:
        return a - floor(a);
    case FUNCTION_LENGTH:
        return length;
    case FUNCTION_NORMALIZE:
        return a / length;
    case FUNCTION_EXP:
        return first_or_second(result.which, exp2(a), exp(a));
    case FUNCTION_LOG:
        return first_or_second(result.which, log2(a), log(a));
    case FUNCTION_POW:
        return pow(a, b);
    case FUNCTION_SIN:
        return first_or_second(result.which, sin(a), cos(a));
    case FUNCTION_ATAN:
        return first_or_second(result.which, atan(a), atan2(a, b));
    case FUNCTION_ACOS:
        return first_or_second(result.which, acos(a), asin(a));
    default:
        return NAN;
    }
}

double probe_error_ulp(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double right = probe_right(cases->given[i], result);
    return right != 0 && fabs(right) < FLT_MIN ? -1 : ulps(false, cases_result(cases, i, result.which), right);
}

double probe_error_absolute(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double error = fabs(cases_result(cases, i, result.which) - probe_right(cases->given[i], result));
    return isnan(error) ? INFINITY : error;
}

double probe_error_none(const struct cases *cases, uint32_t i, struct probe_result result) { return cases_result(cases, i, result.which); }

// y = 1/√a (1 + e) has a y² - 1 = 2 e + e², and a y² in two doubles has digits enough for that.
double probe_error_inverse_root(const struct cases *cases, uint32_t i, struct probe_result result) {
    const double a = cases->given[i][0], y = cases_result(cases, i, result.which), square = y * y, rest = fma(y, y, -square);
    const double excess = fma(a, square, -1) + a * rest,
                 error = fabs(0.5 * excess / (1 + 0.25 * excess) * y) / ulp_of(cases->fp64, 1 / sqrt(a));
    return isnan(error) ? INFINITY : error;
}

double probe_error_narrow(const struct cases *cases, uint32_t i, struct probe_result result) {
    const uint32_t bits = (uint32_t)cases_bits(cases, i, result.which);
    float narrow;
    memcpy(&narrow, &bits, sizeof narrow);
    return ulps(false, narrow, cases->given[i][0]);
}
