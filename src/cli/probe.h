// What the probe found, as a table for people and as JSON: for gnomon probe, and beside what gnomon cost measures.
#ifndef CLI_PROBE_H
#define CLI_PROBE_H

#include "cli/command.h"

struct findings {
    struct gn_probe_row rows[GN_PROBE_ROWS];
    uint32_t count;
    struct gn_probe_tier tiers[GN_ACCURACY_COUNT];
};

// {"device", "driver", "rows", "tiers", "because"}
json_t *findings_json(const struct findings *findings, const struct gn_device *device);

// To standard output.
void findings_print(const struct run *run, const struct findings *findings, const struct gn_device *device);

#endif
