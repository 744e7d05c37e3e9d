#include "measure/pruning.h"

#include <stdlib.h>

#include "base/clock.h"

#define ALL_EFFECTS ((1u << EFFECT_COUNT) - 1)
#define MOST_SIDES (2 + EFFECT_COUNT)

// Without these there is another scene, not another picture of this one.
#define EFFECTS_OF_GEOMETRY (uint32_t)(EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_BVH | EFFECT_INSTANCES)

struct bench {
    struct pruning *out;
    struct context *ctx;
    struct device *device;
    const struct scene *scene;
    const struct bvh *bvh;
    const struct render_params *params;
    struct pruning_side *sides[MOST_SIDES];
    double times[MOST_SIDES][PRUNING_ROUNDS];
    uint32_t side_count;
};

static void add_side(struct bench *bench, struct pruning_side *side, uint32_t effects) {
    side->effects = effects;
    bench->sides[bench->side_count++] = side;
}

static void list_sides(struct bench *bench) {
    const uint32_t effects = bench->params->effects;
    add_side(bench, &bench->out->pruned, effects);
    add_side(bench, &bench->out->full, ALL_EFFECTS);
    for (uint32_t i = 0; i < EFFECT_COUNT; i++)
        if (effects & ~EFFECTS_OF_GEOMETRY & 1u << i) add_side(bench, &bench->out->without[i], effects & ~(1u << i));
}

static uint64_t memory_of(const struct render_film *film) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < film->place_count; i++) sum += film->places[i].bytes;
    return sum;
}

static void note_places(struct pruning *out, const struct render_film *film) {
    out->place_count = film->place_count;
    for (uint32_t i = 0; i < film->place_count; i++) out->places[i] = film->places[i];
}

// The first turn makes the kernel, and does not count otherwise.
static bool take_turn(struct bench *bench, uint32_t number, double *ms, bool first) {
    struct pruning_side *side = bench->sides[number];
    struct render_params params = *bench->params;
    struct render_film film;
    params.effects = side->effects;
    if (!render_picture(&film, bench->ctx, bench->device, bench->scene, bench->bvh, &params)) return false;
    *ms = film.trace_ms;
    if (first) {
        side->pipeline_ms = film.pipeline_ms;
        side->rays = film.rays;
        side->memory = memory_of(&film);
        if (number == 0) note_places(bench->out, &film);
    }
    render_film_finish(&film);
    return true;
}

static int by_value(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool take_turns(struct bench *bench) {
    double unused;
    for (uint32_t i = 0; i < bench->side_count; i++)
        if (!take_turn(bench, i, &unused, true)) return false;
    const double start = clock_seconds();
    uint32_t *rounds = &bench->out->rounds;
    for (*rounds = 0; *rounds < PRUNING_ROUNDS && (*rounds == 0 || clock_seconds() - start < PRUNING_SECONDS); ++*rounds)
        for (uint32_t i = 0; i < bench->side_count; i++)
            if (!take_turn(bench, i, &bench->times[i][*rounds], false)) return false;
    return true;
}

bool pruning_measure(struct pruning *out, struct context *ctx, struct device *device, const struct scene *scene, const struct bvh *bvh,
                     const struct render_params *params) {
    *out = (struct pruning){0};
    struct bench bench = {.out = out, .ctx = ctx, .device = device, .scene = scene, .bvh = bvh, .params = params};
    list_sides(&bench);
    if (!take_turns(&bench)) return false;
    for (uint32_t i = 0; i < bench.side_count; i++) {
        qsort(bench.times[i], out->rounds, sizeof(double), by_value);
        bench.sides[i]->trace_ms = bench.times[i][out->rounds / 2];
    }
    return true;
}
