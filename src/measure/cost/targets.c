// The targets: the reference's pictures, on lattices as dense as the time allows.
//
// How dense is found by trial: a coarse lattice is rendered by the reference, and by the robust tier once more after it has been compiled.
#include <math.h>

#include "measure/cost/cost.h"
#include "measure/sample.h"
#include "render/render.h"

#define TRIAL_PIXELS 1024
#define DEVICE_TRIAL_PIXELS 16384 // so many that the fixed cost of a dispatch does not matter
#define ENOUGH_PIXELS 2048        // for a further rung of samples

static const double LEAST_PIXELS[COST_TARGETS] = {[COST_CENTRES] = 16384, [COST_SAMPLES] = 1024};

#define TIER_WEIGHT 1.6 // the mean run's time in units of the robust tier's

static struct sample sample_of(const struct cost *cost, const struct cost_bench *bench, const struct lattice *lattice) {
    return (struct sample){.scene = bench->scene,
                           .bvh = bench->bvh,
                           .width = cost->params.width,
                           .height = cost->params.height,
                           .effects = cost->params.effects,
                           .lattice = *lattice};
}

static bool try_reference(struct cost *cost, const struct cost_bench *bench) {
    const struct lattice lattice = sample_lattice(cost->params.width, cost->params.height, TRIAL_PIXELS);
    const struct sample sample = sample_of(cost, bench, &lattice);
    struct image unused;
    double seconds;
    if (!sample_reference(&unused, &seconds, bench->ctx, &sample, 1, 0)) return false;
    cost->reference_speed = seconds / sample_pixels(&sample);
    image_finish(&unused);
    return true;
}

static bool try_device(struct cost *cost, const struct cost_bench *bench) {
    const struct lattice lattice = sample_lattice(cost->params.width, cost->params.height, DEVICE_TRIAL_PIXELS);
    const struct sample sample = sample_of(cost, bench, &lattice);
    const struct render_params params = {.width = sample.width,
                                         .height = sample.height,
                                         .spp = 1,
                                         .tier = TIER_ROBUST,
                                         .effects = sample.effects,
                                         .lattice = lattice};
    struct render_film film;
    if (!render_picture(&film, bench->ctx, bench->device, bench->scene, bench->bvh, &params)) return false;
    cost->device_speed = 1e-3 * film.trace_ms / sample_pixels(&sample);
    render_film_finish(&film);
    return true;
}

// Samples per pixel that all runs of a target take in one round, weighted with what their tiers cost.
static double samples_of_round(const struct cost *cost, enum cost_target_name target) {
    double sum = 0;
    for (uint32_t i = 0; i < cost->run_count; i++)
        if (cost->runs[i].config.target == target) sum += TIER_WEIGHT * cost->runs[i].config.spp;
    return sum;
}

static void aim(struct cost *cost, enum cost_target_name name, double reference_share, double device_share) {
    struct cost_target *target = &cost->targets[name];
    double seconds = cost->params.seconds, rounds = cost->params.rounds + 1;
    double by_reference = reference_share * seconds / (target->spp * cost->reference_speed);
    double by_device = device_share * seconds / (rounds * samples_of_round(cost, name) * cost->device_speed);
    target->lattice = sample_lattice(cost->params.width, cost->params.height, fmax(fmin(by_reference, by_device), LEAST_PIXELS[name]));
}

static bool render_target(struct cost_target *target, const struct cost *cost, const struct cost_bench *bench) {
    const struct sample sample = sample_of(cost, bench, &target->lattice);
    double seconds;
    if (!sample_reference(&target->color, &seconds, bench->ctx, &sample, target->spp, target->seed)) return false;
    target->ms = 1e3 * seconds;
    return true;
}

bool cost_try(struct cost *cost, const struct cost_bench *bench) {
    if (!try_reference(cost, bench)) return false;
    for (int turn = 0; turn < 2; turn++) // the first one compiles
        if (!try_device(cost, bench)) return false;
    double samples = COST_SHARE_SAMPLES * cost->params.seconds / cost->reference_speed / ENOUGH_PIXELS;
    cost->rungs = 2;
    while (cost->rungs < COST_LADDER && COST_REFERENCE_SAMPLES * cost_rung(cost->rungs) <= samples) cost->rungs++;
    return true;
}

bool cost_aim(struct cost *cost, const struct cost_bench *bench) {
    aim(cost, COST_CENTRES, COST_SHARE_CENTRES, 0.35 * COST_SHARE_ROUNDS);
    aim(cost, COST_SAMPLES, COST_SHARE_SAMPLES, 0.65 * COST_SHARE_ROUNDS);
    for (int i = 0; i < COST_TARGETS; i++)
        if (!progress(bench->whole, "reference", (double)i / COST_TARGETS, -1) || !render_target(&cost->targets[i], cost, bench)) return false;
    return true;
}
