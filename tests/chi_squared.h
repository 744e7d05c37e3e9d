// Whether counts are what a distribution makes one expect: Pearson's chi-squared test.
#ifndef TESTS_CHI_SQUARED_H
#define TESTS_CHI_SQUARED_H

#include <math.h>
#include <stddef.h>

// The chance that chi-squared with this many degrees of freedom is at least x: the regularized upper incomplete gamma function at
// (freedom/2, x/2); Press et al., Numerical Recipes, 6.2.
static inline double chi_squared_tail(double x, double freedom) {
    double a = freedom / 2, front;
    x /= 2;
    if (!(x > 0)) return 1;
    front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1) { // the series of the lower one
        double term = 1 / a, sum = term;
        for (int i = 1; i < 2000; i++) sum += term *= x / (a + i);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d; // Lentz's continued fraction
    for (int i = 1; i < 2000; i++) {
        double step = -i * (i - a);
        b += 2;
        d = 1 / (step * d + b);
        c = b + step / c;
        fraction *= d * c;
    }
    return front * fraction;
}

// The chance of counts that fit no better than these. Cells with an expectation below 5 are taken together.
static inline double chi_squared_chance(const double *counts, const double *expected, size_t cells) {
    double rest_count = 0, rest = 0, sum = 0;
    size_t used = 0;
    for (size_t i = 0; i < cells; i++) {
        if (expected[i] < 5) {
            rest_count += counts[i];
            rest += expected[i];
        } else {
            sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
            used++;
        }
    }
    if (rest >= 5) {
        sum += (rest_count - rest) * (rest_count - rest) / rest;
        used++;
    } else if (rest_count > 5 + rest + 6 * sqrt(rest)) {
        return 0; // where there should be next to nothing
    }
    return used > 1 ? chi_squared_tail(sum, (double)used - 1) : 1;
}

#endif
