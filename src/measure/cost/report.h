// The report of what accuracy costs: one HTML file, complete in itself.
#ifndef MEASURE_COST_REPORT_H
#define MEASURE_COST_REPORT_H

#include "measure/cost/cost.h"

// Where it was measured.
struct cost_place {
    char scene[256]; // file name
    uint64_t triangles, spheres, lights;
    enum transfer transfer; // of the film
    struct gn_device_info device;
    struct gn_probe_row probe[GN_PROBE_ROWS]; // what its arithmetic does
    struct gn_probe_tier tiers[GN_ACCURACY_COUNT];
    uint32_t probe_count;
};

bool cost_report(const struct cost *cost, struct context *ctx, const struct cost_place *place, const char *path);

#endif
