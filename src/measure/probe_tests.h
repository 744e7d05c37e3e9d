// The probe's table: what is calculated with which numbers, how errors are counted, and how large they may be for which tier.
#ifndef MEASURE_PROBE_TESTS_H
#define MEASURE_PROBE_TESTS_H

#include "gnomon.h"
#include "measure/probe_errors.h"
#include "measure/probe_samples.h"

// Tiers as bits, types as bits.
enum {
    PROBE_FAST = 1 << GN_FAST,
    PROBE_ROBUST = 1 << GN_ROBUST,
    PROBE_EXACT = 1 << GN_EXACT,
    PROBE_FP64 = 1 << GN_FP64,
    PROBE_SINGLE = 1,
    PROBE_DOUBLE = 2,
};

// What the errors of the cases come to.
enum probe_value {
    PROBE_LARGEST,
    PROBE_COUNT, // of those that are not 0
};

// One row of the result, or two: "fp32 sum", "fp64 sum".
struct probe_test {
    const char *name;
    uint32_t types; // PROBE_SINGLE, PROBE_DOUBLE
    struct probe_result result;
    enum probe_samples samples;
    double low, high; // of the samples
    probe_error *error;
    enum probe_value value;
    const char *unit;                 // of PROBE_LARGEST
    double limit;                     // the value may not be more for the tiers …
    uint32_t needed_by, needed_by_64; // … that need it in fp32, in fp64; 0: it is told, and no more
    const char *meaning;
    // Says more of the results, if it is not NULL.
    void (*describe)(char *out, size_t capacity, const struct cases *cases, struct probe_result result);
};

extern const struct probe_test PROBE_TESTS[];
extern const size_t PROBE_TEST_COUNT;

#endif
