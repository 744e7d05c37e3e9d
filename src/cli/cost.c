// gnomon cost: what accuracy costs in time, on this scene and device.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/interrupt.h"
#include "cli/probe.h"
#include "cli/report.h"

static json_t *row_json(const struct gn_cost_row *row) {
    const struct json_member members[] = {
        {"axis", json_words(row->axis)},
        {"setting", json_words(row->setting)},
        {"accuracy", json_words(row->accuracy)},
        {"spp", json_integer(row->spp)},
        {"pixels", json_integer(row->pixels)},
        {"error_against", json_words(row->converged ? "converged" : "same samples")},
        {"time_ms", json_ms(row->time_ms)},
        {"time_low_ms", json_ms(row->time_low_ms)},
        {"time_high_ms", json_ms(row->time_high_ms)},
        {"picture_ms", json_ms(row->picture_ms)},
        {"wrong_per_million", json_number(row->wrong_per_million)},
        {"t_ulp_max", json_number(row->t_ulp_max)},
        {"t_ulp_mean", json_number(row->t_ulp_mean)},
        {"rmse", json_number(row->rmse)},
        {"max_abs", json_number(row->max_abs)},
        {"flip", json_number(row->flip)},
        {"differing_per_million", json_number(row->differing_per_million)},
        {"nonfinite_pixels", json_integer((json_int_t)row->nonfinite_pixels)},
        {"base", json_boolean(row->base)},
        {"pareto", json_boolean(row->pareto)},
    };
    return JSON_MEMBERS(members);
}

static json_t *rows_json(const struct gn_cost *cost) {
    uint32_t count;
    const struct gn_cost_row *rows = gn_cost_rows(cost, &count);
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) json_array_append_new(list, row_json(&rows[i]));
    return list;
}

static json_t *skipped_json(const struct gn_cost *cost) {
    uint32_t count;
    const struct gn_cost_skipped *skipped = gn_cost_skipped(cost, &count);
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        const struct json_member members[] = {
            {"axis", json_words(skipped[i].axis)},
            {"setting", *skipped[i].setting ? json_words(skipped[i].setting) : json_null()},
            {"because", json_words(skipped[i].because)},
        };
        json_array_append_new(list, JSON_MEMBERS(members));
    }
    return list;
}

static json_t *as_json(const struct run *run, const struct gn_cost *cost, const struct gn_device *device, const struct findings *findings) {
    struct gn_cost_summary summary;
    gn_cost_summary(cost, &summary);
    const struct json_member members[] = {
        {"scene", json_words(run->settings.positionals[0])},
        {"width", json_integer(summary.width)},
        {"height", json_integer(summary.height)},
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"rounds", json_integer(summary.rounds)},
        {"rays", json_integer((json_int_t)summary.rays)},
        {"reference_spp", json_integer(summary.reference_spp)},
        {"rows", rows_json(cost)},
        {"skipped", skipped_json(cost)},
        {"probe", findings_json(findings, device)},
        {"report", run->settings.output ? json_words(run->settings.output) : json_null()},
        {"time_ms", json_ms(run_ms(run))},
    };
    return JSON_MEMBERS(members);
}

// ------------------------------------------------------------------------------------------------------------ for people

// Characters that a text takes up: its bytes but for those that continue one.
static int text_width(const char *text) {
    int width = 0;
    for (; *text; text++) width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

static void print_head(const char *axis, bool converged) {
    printf("\n%s, error against %s\n", axis, converged ? "very many samples" : "the same samples");
    printf("  %-28s %10s %15s %7s %8s %9s %9s %8s\n", "SETTING", "TIME ms", "QUARTILES", "× BASE", "WRONG/M", "T ULP", "RMSE", "FLIP");
}

static void print_row(const struct gn_cost_row *row, const struct gn_cost_row *base) {
    char spread[40], ulp[24];
    snprintf(spread, sizeof spread, "%.4g…%.4g", row->time_low_ms, row->time_high_ms);
    snprintf(ulp, sizeof ulp, "%.4g", row->t_ulp_max);
    printf("%c %-28s %10.4g %*s%s %7.2f %8.4g %9s %9.2e %8.5f\n", row->pareto ? '*' : ' ', row->setting, row->time_ms,
           15 - text_width(spread), "", spread, row->time_ms / base->time_ms, row->wrong_per_million, ulp, row->rmse, row->flip);
    if (row->nonfinite_pixels) printf("    %" PRIu64 " pixels with samples that were NaN or infinite\n", row->nonfinite_pixels);
}

static const struct gn_cost_row *base_of(const struct gn_cost_row *rows, uint32_t count, const char *axis) {
    for (uint32_t i = 0; i < count; i++)
        if (rows[i].base && strcmp(rows[i].axis, axis) == 0) return &rows[i];
    return rows;
}

static void print(const struct gn_cost *cost) {
    struct gn_cost_summary summary;
    uint32_t count, skipped_count;
    const struct gn_cost_row *rows = gn_cost_rows(cost, &count);
    const struct gn_cost_skipped *skipped = gn_cost_skipped(cost, &skipped_count);
    gn_cost_summary(cost, &summary);
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || strcmp(rows[i].axis, rows[i - 1].axis) != 0) print_head(rows[i].axis, rows[i].converged);
        print_row(&rows[i], base_of(rows, count, rows[i].axis));
    }
    printf("\n* on the Pareto front of its kind of error: nothing else is as fast and as close, and better in one of the two.\n"
           "Of %" PRIu32 " × %" PRIu32 " pixels every %" PRIu32 ". in both directions (sampling: every %" PRIu32
           "., reference with %" PRIu32 " samples); %" PRIu32 " rounds.\nWRONG/M: wrong decisions per million of %" PRIu64
           " camera rays and rays to lights; T ULP: the "
           "largest error of t.\n",
           summary.width, summary.height, summary.stride[0], summary.stride[1], summary.reference_spp, summary.rounds, summary.rays);
    for (uint32_t i = 0; i < skipped_count; i++)
        printf("Not measured: %s%s%s: %s.\n", skipped[i].axis, *skipped[i].setting ? " " : "", skipped[i].setting, skipped[i].because);
}

static bool save(struct run *run, const struct gn_cost *cost) {
    if (!run->settings.output) return true;
    interrupt_hold();
    bool saved = gn_cost_save(cost, run->settings.output, &run->error);
    interrupt_release();
    return saved;
}

// What the probe found, in the form in which it is told.
static struct findings *take_findings(struct run *run, const struct gn_cost *cost) {
    struct context ctx = run_context(run);
    struct findings *findings = array_alloc(&ctx, 1, sizeof *findings, "what the probe found");
    const struct gn_probe_tier *tiers;
    if (!findings) return NULL;
    const struct gn_probe_row *rows = gn_cost_probe(cost, &findings->count, &tiers);
    memcpy(findings->rows, rows, findings->count * sizeof *rows);
    memcpy(findings->tiers, tiers, sizeof findings->tiers);
    return findings;
}

static bool report(struct run *run, const struct gn_cost *cost, const struct gn_device *device) {
    struct findings *findings = take_findings(run, cost);
    if (!findings) return false;
    bool done = true;
    if (run->settings.json) {
        done = run_result(run, as_json(run, cost, device, findings));
    } else {
        progress_clear(&run->view);
        print(cost);
        printf("\n");
        findings_print(run, findings, device);
    }
    free(findings);
    return done;
}

bool command_cost(struct run *run) {
    const struct settings *settings = &run->settings;
    if (settings->output && !run_check_output(run, settings->output, "html|htm")) return false;
    struct gn_device *device = NULL;
    struct gn_cost *cost = NULL;
    const struct gn_cost_params params = {.width = settings->size.width,
                                          .height = settings->size.height,
                                          .seed = settings->seed,
                                          .rounds = settings->rounds,
                                          .seconds = settings->seconds,
                                          .host = &run->host};
    struct gn_scene *scene = gn_scene_load(settings->positionals[0], &run->host, &run->error);
    bool done = scene && (device = run_device(run)) && (cost = gn_cost_measure(device, scene, &params, &run->error)) && save(run, cost) &&
                report(run, cost, device);
    gn_cost_destroy(cost);
    gn_device_destroy(device);
    gn_scene_destroy(scene);
    return done;
}
