// What several commands say alike: times, device names.
#ifndef CLI_REPORT_H
#define CLI_REPORT_H

#include "cli/command.h"

// Of a device; NULL is the reference.
const char *device_name(const struct gn_device *device);
const char *device_driver(const struct gn_device *device);

// The contract's "time_ms"; `output`: with the time of writing files.
json_t *json_times(const struct gn_time *time, bool output);

// The same as a table for people.
void say_times(struct run *run, const struct gn_time *time, bool output);

// How many rays were undecided, and what decided them.
void say_undecided(struct run *run, uint64_t undecided, uint64_t second_stage, uint64_t host);

#endif
