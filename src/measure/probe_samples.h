// Numbers for the probe to calculate with: those that are hard to round, and those that functions are used for.
#ifndef MEASURE_PROBE_SAMPLES_H
#define MEASURE_PROBE_SAMPLES_H

#include "render/cases.h"

#define PROBE_CASES 65536

enum probe_samples {
    SAMPLES_OPERANDS, // a, b: random, near each other, and such that sums, products, quotients, roots fall on or near a tie; c, d the same
    SAMPLES_EQUAL_PRODUCTS, // a, b, and a, b again
    SAMPLES_PRODUCT_ERRORS, // a, b in [1, 2), c = -(a b), rounded
    SAMPLES_HIDDEN,         // a in [1, 2), b so large that (a + b) - b is not a
    SAMPLES_SPECIAL,        // all triples of NaN, infinities, zeros and a few numbers
    SAMPLES_SIGNED_ZEROS,   // all pairs of zeros and ones of either sign
    SAMPLES_DENORMAL,       // a denormal, b a power of two that lifts it
    SAMPLES_UNDERFLOW,      // a b is denormal
    SAMPLES_OVERFLOW,       // a b is beyond the type
    SAMPLES_UNIFORM,        // a, b, c in [low, high]
    SAMPLES_LOGARITHMIC,    // a, b, c in 2^[low, high]
    SAMPLES_VECTORS,        // a, b, c of either sign, each 2^[low, high]
    SAMPLES_POWERS,         // a in (0, 1], b in [low, high], a^b a normal number
    SAMPLES_SINGLE,         // a = low, and no more
};

// Fills `cases` anew: PROBE_CASES of them, or as many as there are. Always the same.
void probe_samples_fill(struct cases *cases, enum probe_samples samples, double low, double high);

#endif
