#include "measure/pick.h"

#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "render/render.h"

#define SAMPLE_PIXELS 1024     // on which errors are measured
#define TIME_PIXELS 16384      // on which times are: so many that the fixed cost of a dispatch does not matter
#define MOST_SPP (1u << 16)    // tried
#define MORE_SAMPLES 4         // of the reference, for one of a candidate
#define LEAST_SECONDS 4.0      // that a reference may always take
#define REFERENCE_SHARE 0.2    // and as much of what rendering would
#define MOST_SECONDS 30.0      // up to this
#define EXTRAPOLATED 3         // powers of two beyond those measured
#define PICKING_SHARE 0.3      // of the time there is: no tier is tried after that
#define RENDERING_SHARE 0.75   // of the time left after picking: the rest is for checking and writing
#define OTHER_SEED 0x9e3779b9u // samples at other places

static const char *const TIER_NAMES[] = {
#define X(number, id, name, text) [TIER_##id] = name,
    TIERS(X)
#undef X
};

struct picking {
    struct context *ctx;
    struct device *device;
    const struct pick_params *params;
    struct pick *out;
    struct sample sample;     // for errors
    struct image reference;   // of the sample
    uint32_t reference_spp;   // 0: there is none yet
    double speed[TIER_COUNT]; // seconds for one sample of one pixel; 0: not tried
    double started;
};

static double whole_pixels(const struct picking *p) { return (double)p->params->what.width * p->params->what.height; }

// ------------------------------------------------------------------------------------------------------------- measuring

static bool render_sample(struct render_film *film, const struct picking *p, const struct lattice *lattice, uint32_t tier, uint32_t spp) {
    const struct render_params params = {
        .width = p->sample.width,
        .height = p->sample.height,
        .spp = spp,
        .seed = p->params->seed,
        .tier = tier,
        .effects = p->sample.effects,
        .lattice = *lattice,
    };
    return render_picture(film, p->ctx, p->device, p->sample.scene, p->sample.bvh, &params);
}

// How fast a tier is: the better of two turns after the one that compiles.
static bool time_tier(struct picking *p, uint32_t tier) {
    const struct lattice lattice = sample_lattice(p->sample.width, p->sample.height, TIME_PIXELS);
    struct sample timed = p->sample;
    timed.lattice = lattice;
    double best = INFINITY;
    for (int turn = 0; turn < 3; turn++) {
        struct render_film film;
        if (!render_sample(&film, p, &lattice, tier, 1)) return false;
        if (turn > 0) best = fmin(best, 1e-3 * film.trace_ms);
        render_film_finish(&film);
    }
    p->speed[tier] = fmax(best / sample_pixels(&timed), 1e-12);
    return true;
}

static bool time_is_up(const struct picking *p) {
    return p->params->max_seconds > 0 && clock_seconds() - p->started > PICKING_SHARE * p->params->max_seconds;
}

// The default tier first: where time is short it is the only one.
static bool time_tiers(struct picking *p) {
    static const uint32_t order[TIER_COUNT] = {TIER_ROBUST, TIER_FAST, TIER_EXACT, TIER_FP64};
    bool any = false;
    for (int i = 0; i < TIER_COUNT; i++) {
        if (!(p->params->tiers >> order[i] & 1) || (any && time_is_up(p))) continue;
        if (!progress(p->ctx, "picking", -1, -1) || !time_tier(p, order[i])) return false;
        any = true;
    }
    return any || fail(p->ctx, GN_NO_DEVICE, "this device has no tier to pick from");
}

static double fastest_speed(const struct picking *p) {
    double fastest = INFINITY;
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        if (p->speed[tier] > 0) fastest = fmin(fastest, p->speed[tier]);
    return fastest;
}

// A reference that will do for candidates of `spp` samples; *enough is false where it would take too long.
static bool reach(struct picking *p, uint32_t spp, bool *enough) {
    bool same = p->params->spp > 0;
    *enough = true;
    if (same ? p->reference_spp == spp : p->reference_spp >= MORE_SAMPLES * spp) return true;
    uint32_t wanted = same ? spp : MORE_SAMPLES * MORE_SAMPLES * spp; // serves for the next candidates, too
    double rendering = whole_pixels(p) * spp * fastest_speed(p),
           limit = fmin(fmax(LEAST_SECONDS, REFERENCE_SHARE * rendering), MOST_SECONDS);
    if (p->params->max_seconds > 0) limit = fmin(limit, 0.5 * PICKING_SHARE * p->params->max_seconds);
    double one = sample_pixels(&p->sample) * p->out->reference_speed;
    if (wanted * one > limit && !same) wanted = MORE_SAMPLES * spp;
    *enough = p->reference_spp == 0 || (wanted * one <= limit && !time_is_up(p));
    if (!*enough) return true;
    image_finish(&p->reference);
    p->reference_spp = wanted;
    return sample_reference(&p->reference, NULL, p->ctx, &p->sample, wanted, same ? p->params->seed : p->params->seed ^ OTHER_SEED);
}

static void add(struct picking *p, uint32_t tier, uint32_t spp, double error, bool measured) {
    if (p->out->count == PICK_MOST_CANDIDATES) return;
    p->out->candidates[p->out->count++] = (struct pick_candidate){
        .tier = tier, .spp = spp, .error = error, .seconds = whole_pixels(p) * spp * p->speed[tier], .measured = measured};
}

static bool measure(struct picking *p, uint32_t tier, uint32_t spp) {
    struct render_film film;
    if (!progress(p->ctx, "picking", -1, -1) || !render_sample(&film, p, &p->sample.lattice, tier, spp)) return false;
    add(p, tier, spp, sample_rmse(&film.color, &p->reference), true);
    render_film_finish(&film);
    return true;
}

static bool measure_rung(struct picking *p, uint32_t spp) {
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        if (p->speed[tier] > 0 && !measure(p, tier, spp)) return false;
    return true;
}

// Seconds there are for rendering.
static double seconds_left(const struct picking *p) {
    if (!(p->params->max_seconds > 0)) return INFINITY;
    return fmax(RENDERING_SHARE * (p->params->max_seconds - (clock_seconds() - p->started)), 0);
}

// Whether more samples than `spp` could be of use: they take longer than what is good enough, or than there is time.
static bool is_far_enough(const struct picking *p, uint32_t spp) {
    double next = 2.0 * spp * whole_pixels(p) * fastest_speed(p);
    bool met;
    uint32_t best = pick_best(p->out->candidates, p->out->count, p->params->max_error / PICK_MARGIN, 0, &met);
    return next > seconds_left(p) || (p->params->max_error > 0 && met && next >= p->out->candidates[best].seconds);
}

static void extrapolate(struct picking *p, uint32_t measured_spp) {
    uint32_t measured = p->out->count;
    for (uint32_t power = 1; power <= EXTRAPOLATED; power++)
        for (uint32_t i = 0; i < measured; i++) {
            const struct pick_candidate *from = &p->out->candidates[i];
            if (from->spp == measured_spp) add(p, from->tier, from->spp << power, from->error / sqrt((double)(1u << power)), false);
        }
}

static bool climb(struct picking *p) {
    uint32_t spp = p->params->spp ? p->params->spp : 1, last = 0;
    for (; spp <= MOST_SPP; spp *= 2) {
        bool enough;
        if (!reach(p, spp, &enough)) return false;
        if (!enough) break;
        if (!measure_rung(p, spp)) return false;
        last = spp;
        if (p->params->spp || is_far_enough(p, spp)) return true;
    }
    extrapolate(p, last);
    return true;
}

// -------------------------------------------------------------------------------------------------------------- choosing

static bool is_better(const struct pick_candidate *a, const struct pick_candidate *b, bool by_time) {
    return by_time ? a->seconds < b->seconds : a->error < b->error || (a->error == b->error && a->seconds < b->seconds);
}

// The best of those within both limits, or `count` where there is none.
static uint32_t best_within(const struct pick_candidate *candidates, uint32_t count, double max_error, double max_seconds, bool by_time) {
    uint32_t best = count;
    for (uint32_t i = 0; i < count; i++) {
        const struct pick_candidate *candidate = &candidates[i];
        if ((max_error > 0 && !(candidate->error <= max_error)) || (max_seconds > 0 && !(candidate->seconds <= max_seconds))) continue;
        if (best == count || is_better(candidate, &candidates[best], by_time)) best = i;
    }
    return best;
}

uint32_t pick_best(const struct pick_candidate *candidates, uint32_t count, double max_error, double max_seconds, bool *met) {
    uint32_t best = best_within(candidates, count, max_error, max_seconds, max_error > 0);
    *met = best < count;
    if (best == count) best = best_within(candidates, count, 0, max_seconds, false);
    if (best == count) best = best_within(candidates, count, 0, 0, true);
    return best;
}

static void explain(struct pick *out, const struct pick_params *params, double left) {
    const struct pick_candidate *picked = &out->candidates[out->picked];
    char asked[160] = "", what[96];
    int used = 0;
    if (params->max_error > 0) used = snprintf(asked, sizeof asked, "an error of %.3g", params->max_error);
    if (params->max_seconds > 0)
        snprintf(asked + used, sizeof asked - (size_t)used, "%s%.3g s, of which %.3g for rendering", used ? " within " : "",
                 params->max_seconds, left);
    const char *samples = picked->spp == 1 ? "" : "s";
    snprintf(what, sizeof what, "%s with %u sample%s per pixel", TIER_NAMES[picked->tier], picked->spp, samples);
    if (!out->met && params->max_error > 0)
        snprintf(out->because, sizeof out->because, "no setting of %u tried has %s; %s is what there was time for", out->count, asked,
                 what);
    else if (!out->met)
        snprintf(out->because, sizeof out->because,
                 "no setting of %u tried renders in the time that choosing left, %.3g s; %s is the fastest", out->count, left, what);
    else if (params->max_error > 0)
        snprintf(out->because, sizeof out->because, "of %u settings %s is the fastest with %s", out->count, what, asked);
    else
        snprintf(out->because, sizeof out->because, "of %u settings %s has the least error in %s", out->count, what, asked);
}

// With a margin if that can be had, without it if not. Where an error alone is asked for and cannot be had, no more time is spent on a
// picture than finding that out took.
static void choose(struct picking *p) {
    struct pick *out = p->out;
    double max_error = p->params->max_error, left = seconds_left(p), within = p->params->max_seconds > 0 ? fmax(left, 1e-9) : 0;
    out->picked = pick_best(out->candidates, out->count, max_error / PICK_MARGIN, within, &out->met);
    if (!out->met && max_error > 0) out->picked = pick_best(out->candidates, out->count, max_error, within, &out->met);
    bool met = out->met;
    if (!met && within == 0) out->picked = pick_best(out->candidates, out->count, 0, clock_seconds() - p->started, &met);
    explain(out, p->params, left);
}

static bool try_reference(struct picking *p) {
    struct image unused;
    double seconds;
    if (!sample_reference(&unused, &seconds, p->ctx, &p->sample, 1, 0)) return false;
    image_finish(&unused);
    p->out->reference_speed = fmax(seconds / sample_pixels(&p->sample), 1e-12);
    return true;
}

bool pick_setting(struct pick *out, struct context *ctx, struct device *device, const struct pick_params *params) {
    *out = (struct pick){.count = 0};
    struct picking p = {.ctx = ctx, .device = device, .params = params, .out = out, .sample = params->what, .started = clock_seconds()};
    p.sample.lattice = sample_lattice(p.sample.width, p.sample.height, SAMPLE_PIXELS);
    if (params->spp > MOST_SPP)
        return fail(ctx, GN_USAGE, "%u samples per pixel are too many to pick a setting for: at most %u are tried", params->spp, MOST_SPP);
    bool done = time_tiers(&p) && try_reference(&p) && climb(&p);
    image_finish(&p.reference);
    if (!done) return false;
    choose(&p);
    return true;
}

// -------------------------------------------------------------------------------------------------------------- checking

bool pick_check(double *error, uint64_t *pixels, struct context *ctx, const struct pick_params *params, uint32_t spp,
                double reference_speed, const struct image *picture, double seconds) {
    struct sample sample = params->what;
    uint32_t reference_spp = params->spp ? spp : MORE_SAMPLES * spp;
    double fit = seconds / (reference_speed * reference_spp);
    // Another stride, beginning elsewhere.
    sample.lattice = sample_lattice(sample.width, sample.height, fmin(fmax(fit, 64), 4.3 * SAMPLE_PIXELS));
    struct lattice *lattice = &sample.lattice;
    const struct lattice seen = sample_lattice(sample.width, sample.height, SAMPLE_PIXELS);
    if (lattice->stride == seen.stride && lattice->stride > 1) lattice->stride--;
    lattice->x = lattice->stride / 3, lattice->y = lattice->stride - 1 - lattice->stride / 3;

    struct image right = {0}, ours = {0};
    uint32_t seed = params->spp ? params->seed : params->seed ^ (OTHER_SEED << 1);
    bool done = sample_gather(&ours, ctx, &sample, picture) && sample_reference(&right, NULL, ctx, &sample, reference_spp, seed);
    if (done) {
        *error = sample_rmse(&ours, &right);
        *pixels = (uint64_t)sample_pixels(&sample);
    }
    image_finish(&right);
    image_finish(&ours);
    return done;
}
