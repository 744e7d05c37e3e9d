// The runs: a first turn each, whose pictures are judged; then turns for the time, round by round.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "measure/compare.h"
#include "measure/cost/cost.h"
#include "render/render.h"

#define LEAST_ROUNDS 3

static struct render_params params_of(const struct cost *cost, const struct cost_run *run) {
    const struct cost_target *target = &cost->targets[run->config.target];
    struct render_params params = {
        .width = cost->params.width,
        .height = cost->params.height,
        .spp = run->config.spp,
        .seed = run->config.same_samples ? target->seed : target->seed + 1,
        .tier = run->config.tier,
        .effects = cost->params.effects,
        .lattice = target->lattice,
    };
    memcpy(params.knobs, run->config.knobs, sizeof params.knobs);
    return params;
}

// A turn: the film, and the time it took; where codes are the output, with the time of encoding them.
static bool take_turn(struct render_film *film, double *ms, const struct cost *cost, const struct cost_run *run, const struct cost_bench *bench) {
    const struct render_params params = params_of(cost, run);
    if (!render_picture(film, bench->ctx, bench->device, bench->scene, bench->bvh, &params)) return false;
    *ms = film->trace_ms;
    if (!run->config.codes) return true;
    struct file_bytes png;
    double start = clock_seconds();
    if (!image_encode_png(&png, bench->ctx, &film->color, bench->scene->film.transfer)) {
        render_film_finish(film);
        return false;
    }
    *ms += clock_ms_since(start);
    file_bytes_finish(&png);
    return true;
}

// --------------------------------------------------------------------------------------------------------------- errors

static void quantise(struct image *image, enum transfer transfer) {
    size_t count = (size_t)image->width * image->height * image->channels;
    for (size_t i = 0; i < count; i++) image->pixels[i] = transfer_decode(transfer, transfer_encode(transfer, image->pixels[i]));
}

static bool judge(struct cost_run *run, const struct cost *cost, const struct cost_bench *bench) {
    struct gn_compare_result result;
    if (!compare_images(&result, NULL, bench->ctx, &run->color, &cost->targets[run->config.target].color, 1.0 / 255)) return false;
    run->rmse = result.rmse;
    run->max_abs = result.max_abs;
    run->flip = result.flip;
    run->differing_pixels = result.pixels_differing;
    return true;
}

static bool first_turn(struct cost_run *run, const struct cost *cost, const struct cost_bench *bench) {
    struct render_film film;
    double unused;
    if (!take_turn(&film, &unused, cost, run, bench)) return false;
    run->color = film.color;
    film.color = (struct image){0};
    run->nonfinite_pixels = film.nonfinite_pixels;
    run->rays = film.rays;
    run->undecided_rays = film.undecided_rays;
    render_film_finish(&film);
    if (run->config.codes) quantise(&run->color, bench->scene->film.transfer);
    return judge(run, cost, bench);
}

// ---------------------------------------------------------------------------------------------------------------- times

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// A quantile of sorted values, between which it is interpolated.
static double quantile(const double *sorted, uint32_t count, double share) {
    double at = share * (count - 1);
    uint32_t below = (uint32_t)at;
    return below + 1 < count ? sorted[below] + (at - below) * (sorted[below + 1] - sorted[below]) : sorted[count - 1];
}

static void summarise(struct cost_run *run, uint32_t rounds) {
    double sorted[COST_MOST_ROUNDS];
    memcpy(sorted, run->times, rounds * sizeof *sorted);
    qsort(sorted, rounds, sizeof *sorted, by_value);
    run->median = quantile(sorted, rounds, 0.5);
    run->low = quantile(sorted, rounds, 0.25);
    run->high = quantile(sorted, rounds, 0.75);
}

static bool time_round(struct cost *cost, const struct cost_bench *bench) {
    for (uint32_t i = 0; i < cost->run_count; i++) {
        struct render_film film;
        struct cost_run *run = &cost->runs[(i + cost->rounds) % cost->run_count]; // each round begins with another
        if (!take_turn(&film, &run->times[cost->rounds], cost, run, bench)) return false;
        render_film_finish(&film);
        double done = cost->rounds + (i + 1.0) / cost->run_count;
        if (!progress(bench->whole, "rounds", done / cost->params.rounds, -1)) return false;
    }
    cost->rounds++;
    return true;
}

bool cost_run_all(struct cost *cost, const struct cost_bench *bench) {
    uint32_t least = cost->params.rounds < LEAST_ROUNDS ? cost->params.rounds : LEAST_ROUNDS;
    for (uint32_t i = 0; i < cost->run_count; i++) {
        if (!progress(bench->whole, "first turns", (double)i / cost->run_count, -1)) return false;
        if (!first_turn(&cost->runs[i], cost, bench)) return false;
    }
    double start = clock_seconds(), most = COST_SHARE_ROUNDS * cost->params.seconds;
    while (cost->rounds < cost->params.rounds && (cost->rounds < least || clock_seconds() - start < most))
        if (!time_round(cost, bench)) return false;
    for (uint32_t i = 0; i < cost->run_count; i++) summarise(&cost->runs[i], cost->rounds);
    return true;
}
