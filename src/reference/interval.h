// Intervals of doubles that contain an exact number: what fp64 knows of it. Every operation rounds outward.
#ifndef REFERENCE_INTERVAL_H
#define REFERENCE_INTERVAL_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

struct interval {
    double lo, hi;
};

// The sum of a number rounded to nearest and its possible error: a double certainly below, or above. One rounding is at most 2^-53·|x|, or
// half the smallest denormal.
static inline double interval_down(double x) { return x - (fabs(x) * DBL_EPSILON + 0x1p-1074); }
static inline double interval_up(double x) { return x + (fabs(x) * DBL_EPSILON + 0x1p-1074); }

static inline struct interval interval_around(double x, double error) {
    return (struct interval){interval_down(x - error), interval_up(x + error)};
}

// 1 or -1 where all of the interval has that sign, else 0.
static inline int interval_sign(struct interval a) { return (a.lo > 0) - (a.hi < 0); }

static inline struct interval interval_negate(struct interval a) { return (struct interval){-a.hi, -a.lo}; }

static inline struct interval interval_add(struct interval a, struct interval b) {
    return (struct interval){interval_down(a.lo + b.lo), interval_up(a.hi + b.hi)};
}

// a / b where b has a sign; everything where it has none.
static inline struct interval interval_div(struct interval a, struct interval b) {
    if (interval_sign(b) == 0) return (struct interval){-INFINITY, INFINITY};
    if (b.hi < 0) return interval_div(interval_negate(a), interval_negate(b));
    double lo = a.lo / (a.lo < 0 ? b.lo : b.hi), hi = a.hi / (a.hi < 0 ? b.hi : b.lo);
    return (struct interval){interval_down(lo), interval_up(hi)};
}

// The root of what is known not to be negative.
static inline struct interval interval_sqrt(struct interval a) {
    return (struct interval){a.lo > 0 ? interval_down(sqrt(a.lo)) : 0, interval_up(sqrt(a.hi > 0 ? a.hi : 0))};
}

static inline double interval_mid(struct interval a) { return 0.5 * a.lo + 0.5 * a.hi; }

// Whether it says about 36 bits of the number, or, for small ones, `scale`·2^-36.
static inline bool interval_narrow(struct interval a, double scale) {
    double width = a.hi - a.lo;
    return width < INFINITY && width <= 0x1p-36 * fmax(scale, fmax(fabs(a.lo), fabs(a.hi)));
}

#endif
