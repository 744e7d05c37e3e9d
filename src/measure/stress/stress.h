// The numerically hard cases, each accuracy tier against exact arithmetic: what `gnomon stress` runs.
//
// A row is one case: a construction with its numbers, or a family of them, and a right answer that does not come from the code that is
// judged (GMP, MPFR). Rows without a test yet, or of what does not exist, are listed as waiting. The table is in cases.c.
#ifndef MEASURE_STRESS_STRESS_H
#define MEASURE_STRESS_STRESS_H

#include "device/device.h"
#include "shaders/shared.h"

struct stress_params {
    const char *pattern; // shell pattern that a row's id matches, e.g. "T0*" [every row]
    uint32_t tiers;      // bits 1 << TIER_* of those to judge [all of them]
    uint32_t rays;       // what each row shoots at each tier, about [STRESS_RAYS]
    uint32_t seed;       // of the random numbers
    bool strict;         // nothing may be wrong in any tier, whatever is known of it
};

#define STRESS_RAYS 10000u

// Zeroed is empty.
struct stress_report {
    struct gn_stress_result *results; // row by row, tiers in the order of the table
    uint32_t count, tier_count;       // results; of them for each row
    bool pass;
};

// Runs the rows. False when that was not possible: no row of that name (GN_USAGE), a fault of the device, cancelled. A row that is
// wrong is no failure.
bool stress_run(struct stress_report *out, struct context *ctx, struct device *device, const struct stress_params *params);
void stress_report_finish(struct stress_report *report);

// The number of rows there are, and the id of each.
uint32_t stress_row_count(void);
const char *stress_row_id(uint32_t row);

#endif
