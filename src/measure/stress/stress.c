// Runs the rows of the table and holds each tier against its bounds.
#include "measure/stress/stress.h"

#include <fnmatch.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/stress/row.h"
#include "render/kernels.h"

static const char *const tier_names[TIER_COUNT] = {
#define X(number, id, name, text) [TIER_##id] = name,
    TIERS(X)
#undef X
};

#define COPIES 8 // shots at one question: a ray and its variants that are not fuzzed

uint32_t stress_row_count(void) { return row_count; }
const char *stress_row_id(uint32_t row) { return row < row_count ? rows[row].id : NULL; }

// ---------------------------------------------------------------------------------------------------------------- tallies

void tally_wrong(struct tally *tally, const char *format, ...) {
    if (tally->wrong++ > 0) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(tally->first, sizeof tally->first, format, arguments);
    va_end(arguments);
}

void tally_every(struct stress *s, const struct tally *tally) {
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        if (s->judged[tier]) s->tally[tier] = *tally;
}

// How many of `count` may be wrong at `per_million`: the mean, four standard deviations of as many rays as there are that have nothing
// to do with each other, and one such for good measure; none where none may.
static uint64_t allowance(uint32_t per_million, uint64_t count) {
    if (per_million == 0) return 0;
    double mean = 1e-6 * per_million * (double)count;
    return (uint64_t)fmin(mean + 4 * sqrt(COPIES * mean) + COPIES, (double)count);
}

// --------------------------------------------------------------------------------------------------------------- one row

static void add_note(struct gn_stress_result *result, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add_note(struct gn_stress_result *result, const char *format, ...) {
    size_t used = strlen(result->note);
    if (used) used += (size_t)snprintf(result->note + used, sizeof result->note - used, "; ");
    if (used >= sizeof result->note) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(result->note + used, sizeof result->note - used, format, arguments);
    va_end(arguments);
}

static bool as_known(const struct row *row, const struct tally *tally, uint32_t tier) {
    return tally->wrong <= allowance(row->limit[tier], tally->rays) && tally->leaks <= allowance(row->leaks[tier], tally->rays) &&
           tally->shaken <= allowance(row->shaken[tier], tally->rays);
}

static void conclude(struct gn_stress_result *result, const struct row *row, const struct tally *tally, uint32_t tier, bool strict) {
    result->rays = tally->rays, result->wrong = tally->wrong, result->leaks = tally->leaks, result->ms = tally->ms;
    result->allowed = strict ? 0 : allowance(row->limit[tier], tally->rays);
    result->pass = tally->scaled == 0 && (strict ? tally->wrong + tally->shaken == 0 : as_known(row, tally, tier));
    if (*tally->note) add_note(result, "%s", tally->note);
    if (tally->leaks) add_note(result, "leaks %llu", (unsigned long long)tally->leaks);
    if (tally->scaled) add_note(result, "%llu changed with the scale", (unsigned long long)tally->scaled);
    if (tally->shaken) add_note(result, "%llu changed with the hierarchy", (unsigned long long)tally->shaken);
    if (tally->error > 1e-6) add_note(result, "off by up to %.3g, relative", tally->error);
    if (tally->ulps > 1) add_note(result, "t off by up to %.3g ulp", tally->ulps);
    if (!result->pass && *tally->first) add_note(result, "first: %s", tally->first);
}

static void wait(struct gn_stress_result *result, const char *before, const char *what) {
    result->waits = true;
    snprintf(result->note, sizeof result->note, "%s%.200s", before, what);
}

static uint64_t hash_of(const char *id) {
    uint64_t hash = 0xcbf29ce484222325u; // FNV-1a
    for (; *id; id++) hash = (hash ^ (unsigned char)*id) * 0x100000001b3u;
    return hash;
}

static bool wanted(const struct stress_params *params, uint32_t tier) { return !params->tiers || params->tiers >> tier & 1; }

// Whether the device has the tier; else *why says what it lacks.
static bool tier_runs(struct gn_error *why, struct device *device, uint32_t tier) {
    struct context own = context_make(NULL, why);
    return tier_available(&own, device, tier);
}

// Fills results[0 … TIER_COUNT): the row at every tier.
static bool run_row(struct gn_stress_result *results, struct context *ctx, struct device *device, const struct row *row,
                    const struct stress_params *params) {
    struct stress s = {
        .ctx = ctx, .device = device, .row = row, .random = random_make(params->seed, hash_of(row->id)), .rays = params->rays};
    if (s.rays == 0) s.rays = STRESS_RAYS;
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++) {
        struct gn_error why;
        bool runs = tier_runs(&why, device, tier);
        results[tier] = (struct gn_stress_result){.id = row->id, .text = row->text, .accuracy = tier_names[tier], .pass = true};
        s.judged[tier] = runs && wanted(params, tier);
        if (row->waits)
            wait(&results[tier], "waiting for ", row->waits);
        else if (!runs)
            wait(&results[tier], "", why.message);
    }
    if (!row->waits && (!row->run(&s) || (row->also && !row->also(&s)))) return false;
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        if (!row->waits && s.judged[tier]) conclude(&results[tier], row, &s.tally[tier], tier, params->strict);
    return true;
}

// -------------------------------------------------------------------------------------------------------------- all of them

static bool chosen(const struct row *row, const struct stress_params *params) {
    return !params->pattern || fnmatch(params->pattern, row->id, 0) == 0;
}

// Takes out the tiers that were not asked for.
static void keep_wanted(struct stress_report *out, const struct stress_params *params) {
    uint32_t kept = 0, tiers = 0;
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++) tiers += wanted(params, tier);
    for (uint32_t i = 0; i < out->count; i++)
        if (wanted(params, i % TIER_COUNT)) out->results[kept++] = out->results[i];
    out->count = kept;
    out->tier_count = tiers;
}

// A run as seen from inside a row: what the row's parts report of their own progress is of no interest, but they may be cancelled.
struct watch {
    struct context *ctx;
    double fraction; // of the run
};

static bool ask_on(void *user, const struct gn_progress *part) {
    (void)part;
    const struct watch *watch = user;
    return progress(watch->ctx, "stress", watch->fraction, -1);
}

static void pass_on(void *user, enum gn_level level, const char *text) { notify(((const struct watch *)user)->ctx, level, "%s", text); }

static bool run_rows(struct stress_report *out, struct context *ctx, struct device *device, const struct stress_params *params,
                     uint32_t total) {
    struct watch watch = {.ctx = ctx};
    struct context inner = *ctx;
    inner.host = (struct gn_host){.user = &watch, .progress = ask_on, .message = pass_on, .threads = ctx->host.threads};
    for (uint32_t i = 0; i < row_count; i++) {
        if (!chosen(&rows[i], params)) continue;
        watch.fraction = (double)out->count / TIER_COUNT / total;
        if (!progress(ctx, "stress", watch.fraction, -1)) return false;
        if (!run_row(out->results + out->count, &inner, device, &rows[i], params) || !device_validated(device, ctx)) return false;
        out->count += TIER_COUNT;
    }
    return true;
}

bool stress_run(struct stress_report *out, struct context *ctx, struct device *device, const struct stress_params *params) {
    *out = (struct stress_report){.pass = true, .tier_count = TIER_COUNT};
    uint32_t total = 0;
    for (uint32_t i = 0; i < row_count; i++) total += chosen(&rows[i], params);
    if (total == 0)
        return fail(ctx, GN_USAGE, "no case is called '%s'; cases are T01 to T33, S01 to S15, B, O, H, R, C, X, U, A, V and W",
                    params->pattern);
    out->results = array_alloc(ctx, (size_t)total * TIER_COUNT, sizeof *out->results, "the results");
    if (!out->results) return false;
    if (!run_rows(out, ctx, device, params, total)) {
        stress_report_finish(out);
        return false;
    }
    keep_wanted(out, params);
    for (uint32_t i = 0; i < out->count; i++) out->pass = out->pass && out->results[i].pass;
    return true;
}

void stress_report_finish(struct stress_report *report) {
    free(report->results);
    *report = (struct stress_report){0};
}
