// gn_probe: the public face of measure/probe.h.
#include "api/handles.h"
#include "measure/probe.h"

bool gn_probe(struct gn_device *device, const struct gn_host *host, struct gn_probe_row *rows, uint32_t capacity, uint32_t *count,
              struct gn_probe_tier tiers[GN_ACCURACY_COUNT], struct gn_error *error) {
    struct context ctx = context_make(host, error);
    *count = 0;
    if (!device) return fail(&ctx, GN_USAGE, "the probe asks a device: one is needed");
    if (!probe_measure(rows, capacity, count, &ctx, &device->device)) return false;
    probe_judge(tiers, rows, *count, device->device.has_fp64);
    return true;
}
