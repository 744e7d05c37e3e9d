// gn_stress_…: the public face of measure/stress.
#include <stdlib.h>

#include "api/handles.h"
#include "measure/stress/stress.h"

struct gn_stress {
    struct stress_report report;
};

// The tiers of these accuracies, as bits.
static bool tiers_of(uint32_t *tiers, struct context *ctx, uint32_t accuracies) {
    const char *name;
    *tiers = 0;
    if (accuracies >> GN_ACCURACY_COUNT) return fail(ctx, GN_USAGE, "there are no accuracies 0x%x", accuracies);
    for (uint32_t i = 0; i < GN_ACCURACY_COUNT; i++) {
        uint32_t tier;
        if (!(accuracies >> i & 1)) continue;
        if (!tier_of_accuracy(&tier, &name, ctx, (enum gn_accuracy)i)) return false;
        *tiers |= 1u << tier;
    }
    return true;
}

struct gn_stress *gn_stress_run(struct gn_device *device, const struct gn_stress_params *params, struct gn_error *error) {
    static const struct gn_stress_params defaults;
    if (!params) params = &defaults;
    struct context ctx = context_make(params->host, error);
    struct stress_params own = {.pattern = params->cases, .rays = params->rays, .seed = params->seed};
    if (!device) return fail(&ctx, GN_USAGE, "the stress cases judge a device: one is needed"), NULL;
    struct gn_stress *stress = tiers_of(&own.tiers, &ctx, params->accuracies) ? array_alloc(&ctx, 1, sizeof *stress, "the results") : NULL;
    if (!stress || stress_run(&stress->report, &ctx, &device->device, &own)) return stress;
    gn_stress_destroy(stress);
    return NULL;
}

void gn_stress_destroy(struct gn_stress *stress) {
    if (!stress) return;
    stress_report_finish(&stress->report);
    free(stress);
}

const struct gn_stress_result *gn_stress_results(const struct gn_stress *stress, uint32_t *count, uint32_t *tiers) {
    *count = stress->report.count;
    *tiers = stress->report.tier_count;
    return stress->report.results;
}

bool gn_stress_passed(const struct gn_stress *stress) { return stress->report.pass; }
