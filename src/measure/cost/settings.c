// The rows: every position of every axis that this scene and device call for, and the runs behind them.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/cost/cost.h"
#include "render/kernels.h"

static const char *const TIER_NAMES[] = {
#define X(number, id, name, text) [TIER_##id] = name,
    TIERS(X)
#undef X
};

static const struct {
    const char *name, *positions; // separated by |
} KNOB_NAMES[] = {
#define X(number, id, name, positions) [KNOB_##id] = {name, positions},
    KNOBS(X)
#undef X
};

// The position that the robust tier comes to, on which these knobs are turned: a run of its own would measure the same kernel again.
static const uint32_t ROBUST_POSITION[KNOB_COUNT] = {
    [KNOB_OFFSET] = OFFSET_BOUND_SELF, [KNOB_NORMALIZE] = NORMALIZE_ROOT, [KNOB_POWER] = POWER_BUILT_IN};

const char *cost_tier_name(uint32_t tier) { return TIER_NAMES[tier]; }
const char *cost_knob_name(enum knob knob) { return KNOB_NAMES[knob].name; }

bool cost_position_name(char *text, size_t capacity, enum knob knob, uint32_t position) {
    const char *at = KNOB_NAMES[knob].positions;
    for (; position > 0 && at; position--) {
        at = strchr(at, '|');
        if (at) at++;
    }
    if (at) snprintf(text, capacity, "%.*s", (int)strcspn(at, "|"), at);
    return at != NULL;
}

// ----------------------------------------------------------------------------------------------------------------- rows

static bool same_config(const struct cost_config *a, const struct cost_config *b) {
    return a->tier == b->tier && memcmp(a->knobs, b->knobs, sizeof a->knobs) == 0 && a->spp == b->spp && a->target == b->target &&
           a->same_samples == b->same_samples && a->codes == b->codes;
}

static uint32_t run_for(struct cost *cost, const struct cost_config *config) {
    for (uint32_t i = 0; i < cost->run_count; i++)
        if (same_config(&cost->runs[i].config, config)) return i;
    cost->runs[cost->run_count].config = *config;
    return cost->run_count++;
}

// Adds a row. There is room for all: the axes are few, and written down below.
static void add(struct cost *cost, const char *axis, const char *setting, enum cost_front front, bool base, struct cost_config config) {
    struct cost_row *row = &cost->rows[cost->row_count++];
    *row = (struct cost_row){.front = front, .base = base, .run = run_for(cost, &config)};
    snprintf(row->axis, sizeof row->axis, "%s", axis);
    snprintf(row->setting, sizeof row->setting, "%s", setting);
}

static void skip(struct cost *cost, const char *axis, const char *setting, const char *because) {
    struct cost_skipped *skipped = &cost->skipped[cost->skipped_count++];
    snprintf(skipped->axis, sizeof skipped->axis, "%s", axis);
    snprintf(skipped->setting, sizeof skipped->setting, "%s", setting);
    snprintf(skipped->because, sizeof skipped->because, "%.*s", (int)sizeof skipped->because - 1, because);
}

static struct cost_config centres(uint32_t tier) {
    return (struct cost_config){.tier = tier, .spp = 1, .target = COST_CENTRES, .same_samples = true};
}

// Whether the device has a tier; else *why says what is missing.
static bool has_tier(struct gn_error *why, const struct cost_bench *bench, uint32_t tier) {
    struct context ctx = context_make(NULL, why);
    return tier_available(&ctx, bench->device, tier);
}

static bool is_there(const struct cost_bench *bench, uint32_t tier) {
    struct gn_error unused;
    return has_tier(&unused, bench, tier);
}

static void list_tiers(struct cost *cost, const struct cost_bench *bench) {
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++) {
        struct gn_error why;
        if (has_tier(&why, bench, tier))
            add(cost, "tier", TIER_NAMES[tier], COST_FRONT_ARITHMETIC, tier == TIER_ROBUST, centres(tier));
        else
            skip(cost, "tier", TIER_NAMES[tier], why.message);
    }
}

static void list_positions(struct cost *cost, enum knob knob, enum cost_front front, const struct cost_config *base) {
    char name[48];
    bool from_tier = cost_position_name(name, sizeof name, knob, 0) && strcmp(name, "tier") == 0;
    for (uint32_t position = from_tier; cost_position_name(name, sizeof name, knob, position); position++) {
        struct cost_config config = *base;
        bool robust = position == ROBUST_POSITION[knob];
        config.knobs[knob] = robust ? 0 : position;
        add(cost, KNOB_NAMES[knob].name, name, front, robust, config);
    }
}

// Knobs that change one ray's arithmetic, where the scene has something that they act on.
static void list_arithmetic(struct cost *cost) {
    static const struct {
        enum knob knob;
        uint32_t effects;
        const char *because;
    } rows[] = {
        {KNOB_OFFSET, EFFECT_SHADOWS, "no ray leaves a surface in this scene"},
        {KNOB_NORMALIZE, EFFECT_DIFFUSE | EFFECT_SPECULAR, "nothing is shaded in this scene"},
        {KNOB_POWER, EFFECT_SPECULAR, "no material has a specular colour in this scene"},
    };
    const struct cost_config base = centres(TIER_ROBUST);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (cost->params.effects & rows[i].effects)
            list_positions(cost, rows[i].knob, COST_FRONT_ARITHMETIC, &base);
        else
            skip(cost, KNOB_NAMES[rows[i].knob].name, "", rows[i].because);
    }
}

static void list_output(struct cost *cost) {
    struct cost_config config = centres(TIER_ROBUST);
    add(cost, "output", "32-bit float", COST_FRONT_ARITHMETIC, true, config);
    config.codes = true;
    add(cost, "output", "8-bit code", COST_FRONT_ARITHMETIC, false, config);
}

// In fp64 where there is that, so that nothing but the sum is in error.
static void list_sum(struct cost *cost, const struct cost_bench *bench) {
    struct cost_config base = {
        .tier = is_there(bench, TIER_FP64) ? TIER_FP64 : TIER_ROBUST,
        .spp = cost->targets[COST_SAMPLES].spp,
        .target = COST_SAMPLES,
        .same_samples = true,
    };
    list_positions(cost, KNOB_SUM, COST_FRONT_SUM, &base);
}

static struct cost_config sampled(uint32_t tier, uint32_t spp) {
    return (struct cost_config){.tier = tier, .spp = spp, .target = COST_SAMPLES};
}

static void list_samples(struct cost *cost) {
    char name[48];
    for (uint32_t i = 0; i < cost->rungs; i++) {
        snprintf(name, sizeof name, "%u per pixel", cost_rung(i));
        add(cost, "samples", name, COST_FRONT_SAMPLING, i == 0, sampled(TIER_ROBUST, cost_rung(i)));
    }
}

// One sample stands in the middle, whatever the sampler.
static void list_sampler(struct cost *cost) {
    char position_name[24], name[48];
    for (uint32_t i = 1; i < cost->rungs; i++)
        for (uint32_t position = 0; cost_position_name(position_name, sizeof position_name, KNOB_SAMPLER, position); position++) {
            struct cost_config config = sampled(TIER_ROBUST, cost_rung(i));
            config.knobs[KNOB_SAMPLER] = position;
            snprintf(name, sizeof name, "%s, %u per pixel", position_name, cost_rung(i));
            add(cost, "sampler", name, COST_FRONT_SAMPLING, i == 1 && position == 0, config);
        }
}

static void list_together(struct cost *cost, const struct cost_bench *bench) {
    char name[48];
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        for (uint32_t i = 0; i < cost->rungs && is_there(bench, tier); i++) {
            snprintf(name, sizeof name, "%s, %u per pixel", TIER_NAMES[tier], cost_rung(i));
            add(cost, "together", name, COST_FRONT_SAMPLING, tier == TIER_ROBUST && i == 0, sampled(tier, cost_rung(i)));
        }
}

bool cost_list(struct cost *cost, const struct cost_bench *bench) {
    cost->rows = array_alloc(bench->ctx, COST_MOST_ROWS, sizeof *cost->rows, "the rows of costs");
    cost->runs = array_alloc(bench->ctx, COST_MOST_ROWS, sizeof *cost->runs, "the runs of costs");
    if (!cost->rows || !cost->runs) return false;
    cost->targets[COST_CENTRES] = (struct cost_target){.spp = 1, .seed = cost->params.seed};
    cost->targets[COST_SAMPLES] = (struct cost_target){.seed = cost->params.seed};
    cost->targets[COST_SAMPLES].spp = COST_REFERENCE_SAMPLES * cost_rung(cost->rungs - 1);
    list_tiers(cost, bench);
    list_arithmetic(cost);
    list_output(cost);
    list_sum(cost, bench);
    list_samples(cost);
    list_sampler(cost);
    list_together(cost, bench);
    skip(cost, "path depth", "", "there is one depth until reflection or indirect light is there");
    return true;
}
