// What a device's arithmetic really does, measured: every operation on many numbers against the right results, and what each tier makes of
// it.
//
// The work is a table (probe_tests.h): a kernel, numbers, an error, what the errors come to, and how large that may be for which tier.
#ifndef MEASURE_PROBE_H
#define MEASURE_PROBE_H

#include "device/device.h"
#include "gnomon.h"

// Measures rows[0 … *count), at most `capacity`. Rows that need doubles are left out where there are none.
bool probe_measure(struct gn_probe_row *rows, uint32_t capacity, uint32_t *count, struct context *ctx, struct device *device);

// What the rows come to for each tier, in the order of enum gn_accuracy.
void probe_judge(struct gn_probe_tier tiers[GN_ACCURACY_COUNT], const struct gn_probe_row *rows, uint32_t count, bool has_fp64);

#endif
