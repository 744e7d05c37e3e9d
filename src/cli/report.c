#include "cli/report.h"

#include <inttypes.h>

const char *device_name(const struct gn_device *device) { return device ? gn_device_info(device)->name : "reference (CPU, fp64)"; }

const char *device_driver(const struct gn_device *device) { return device ? gn_device_info(device)->driver : "none"; }

json_t *json_times(const struct gn_time *time, bool output) {
    const struct json_member members[] = {
        {"total", json_ms(time->total)}, {"startup", json_ms(time->startup)},   {"scene", json_ms(time->scene)},
        {"bvh", json_ms(time->bvh)},     {"pipeline", json_ms(time->pipeline)}, {"upload", json_ms(time->upload)},
        {"trace", json_ms(time->trace)},
    };
    json_t *times = JSON_MEMBERS(members);
    if (times && output) {
        json_object_set_new(times, "reference", json_ms(time->reference));
        json_object_set_new(times, "output", json_ms(time->output));
    }
    return times;
}

void say_times(struct run *run, const struct gn_time *time, bool output) {
    run_say(run, "  startup    %12.1f ms  opening the device", time->startup);
    run_say(run, "  scene      %12.1f ms  reading files", time->scene);
    run_say(run, "  bvh        %12.1f ms  building the hierarchy", time->bvh);
    run_say(run, "  pipeline   %12.1f ms  making kernels", time->pipeline);
    run_say(run, "  upload     %12.1f ms  filling the device's memory", time->upload);
    run_say(run, "  trace      %12.1f ms  shooting", time->trace);
    if (time->reference > 0) run_say(run, "  reference  %12.1f ms  rendering once more, to compare", time->reference);
    if (output) run_say(run, "  output     %12.1f ms  writing files", time->output);
    run_say(run, "  total      %12.1f ms  since the program began", time->total);
}

void say_undecided(struct run *run, uint64_t undecided, uint64_t second_stage, uint64_t host) {
    run_say(run, "  undecided  %12" PRIu64 "  rays that needed more than the tier's first stage", undecided);
    if (undecided == 0) return;
    run_say(run, "    fp64     %12" PRIu64 "  of them decided by the second stage on the device", second_stage);
    run_say(run, "    exact    %12" PRIu64 "  of them by exact arithmetic on the host", host);
}
