#include "measure/cost/cost.h"

#include <stdlib.h>

#include "reference/reference.h"

// The steps' own progress would jump to and fro: of it only the question whether to go on is passed on.
static bool ask_only(void *user, const struct gn_progress *step) {
    const struct gn_host *host = user;
    const struct gn_progress question = {.stage = step->stage, .fraction = -1, .seconds_left = -1};
    return !host->progress || host->progress(host->user, &question);
}

bool cost_measure(struct cost *out, struct context *ctx, struct device *device, const struct scene *scene, const struct bvh *bvh,
                  const struct cost_params *params) {
    *out = (struct cost){.params = *params};
    struct context step = *ctx;
    step.host.user = &ctx->host;
    step.host.progress = ask_only;
    step.host.message = NULL;
    const struct cost_bench one = {.ctx = &step, .whole = ctx, .device = device, .scene = scene, .bvh = bvh}, *bench = &one;
    // With it a kernel serves every number of samples; a single one still stands in the middle of its pixel.
    out->params.effects |= EFFECT_ANTIALIASING;
    if (cost_try(out, bench) && cost_list(out, bench) && cost_aim(out, bench) && cost_decide(out, bench) && cost_run_all(out, bench)) {
        cost_mark_pareto(out);
        return true;
    }
    cost_finish(out);
    return false;
}

void cost_finish(struct cost *cost) {
    for (int i = 0; i < COST_TARGETS; i++) image_finish(&cost->targets[i].color);
    for (uint32_t i = 0; i < cost->run_count; i++) image_finish(&cost->runs[i].color);
    free(cost->runs);
    free(cost->rows);
    *cost = (struct cost){.rounds = 0};
}
