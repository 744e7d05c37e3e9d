// gnomon probe: what this device's arithmetic really does, and which tiers can live with it.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/probe.h"
#include "cli/report.h"

// How tiers are listed: the cheapest first.
static const enum gn_accuracy ORDER[GN_ACCURACY_COUNT] = {GN_FAST, GN_ROBUST, GN_EXACT, GN_FP64};

// ------------------------------------------------------------------------------------------------------------------- results

static json_t *tier_names(const struct findings *findings, uint32_t tiers) {
    json_t *names = json_array();
    for (int i = 0; i < GN_ACCURACY_COUNT; i++)
        if (tiers >> ORDER[i] & 1) json_array_append_new(names, json_words(findings->tiers[ORDER[i]].name));
    return names;
}

static json_t *row_json(const struct findings *findings, const struct gn_probe_row *row) {
    const struct json_member members[] = {
        {"name", json_words(row->name)},
        {"value", json_number(row->value)},
        {"unit", json_words(row->unit)},
        {"limit", row->needed_by ? json_number(row->limit) : json_null()},
        {"needed_by", tier_names(findings, row->needed_by)},
        {"ok", json_boolean(row->breaks == 0)},
        {"meaning", json_words(row->meaning)},
        {"detail", json_words(row->detail)},
    };
    return JSON_MEMBERS(members);
}

json_t *findings_json(const struct findings *findings, const struct gn_device *device) {
    json_t *rows = json_array(), *tiers = json_object(), *because = json_object();
    for (uint32_t i = 0; i < findings->count; i++) json_array_append_new(rows, row_json(findings, &findings->rows[i]));
    for (int i = 0; i < GN_ACCURACY_COUNT; i++) {
        const struct gn_probe_tier *tier = &findings->tiers[ORDER[i]];
        json_object_set_new(tiers, tier->name, json_boolean(tier->ok));
        json_object_set_new(because, tier->name, json_words(tier->because));
    }
    const struct json_member members[] = {
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"rows", rows},
        {"tiers", tiers},
        {"because", because},
    };
    return JSON_MEMBERS(members);
}

// --------------------------------------------------------------------------------------------------------------------- table

// "0.5 ulp", "0 of 65536".
static void print_value(const struct gn_probe_row *row) {
    char text[64] = "";
    if (row)
        snprintf(text, sizeof text, row->value == floor(row->value) && row->value < 1e6 ? "%.0f %s" : "%.3g %s", row->value, row->unit);
    printf(" %-18s", text);
}

static void print_tiers(const struct findings *findings, uint32_t tiers) {
    int column = 0;
    for (int i = 0; i < GN_ACCURACY_COUNT; i++)
        if (tiers >> ORDER[i] & 1) column += printf(" %s", findings->tiers[ORDER[i]].name);
    printf("%*s", 24 - column, "");
}

// A row of fp32 and the one of fp64 that goes with it, or NULL.
static void print_rows(const struct run *run, const struct findings *findings, const struct gn_probe_row *row,
                       const struct gn_probe_row *doubles) {
    const bool typed = strncmp(row->name, "fp", 2) == 0, only_doubles = strncmp(row->name, "fp64 ", 5) == 0;
    const uint32_t needed = row->needed_by | (doubles ? doubles->needed_by : 0), broken = row->breaks | (doubles ? doubles->breaks : 0);
    printf("%-26s", row->name + (typed ? 5 : 0));
    print_value(only_doubles ? NULL : row);
    print_value(only_doubles ? row : doubles);
    print_tiers(findings, needed);
    printf("%-6s %s\n", broken ? "WRONG" : needed ? "ok" : "", row->meaning);
    if (run->settings.verbose && *row->detail) printf("  %s\n", row->detail);
    if (run->settings.verbose && doubles && *doubles->detail) printf("  fp64: %s\n", doubles->detail);
}

static bool go_together(const struct gn_probe_row *row, const struct gn_probe_row *next) {
    return strncmp(row->name, "fp32 ", 5) == 0 && strncmp(next->name, "fp64 ", 5) == 0 && strcmp(row->name + 5, next->name + 5) == 0;
}

void findings_print(const struct run *run, const struct findings *findings, const struct gn_device *device) {
    printf("%s, %s\n\n%-26s %-18s %-18s %-23s\n", device_name(device), device_driver(device), "WHAT", "FP32", "FP64", "NEEDED BY");
    for (uint32_t i = 0; i < findings->count; i++) {
        const struct gn_probe_row *row = &findings->rows[i];
        const bool pair = i + 1 < findings->count && go_together(row, row + 1);
        print_rows(run, findings, row, pair ? row + 1 : NULL);
        i += pair;
    }
    printf("\n");
    for (int i = 0; i < GN_ACCURACY_COUNT; i++) {
        const struct gn_probe_tier *tier = &findings->tiers[ORDER[i]];
        printf("%-7s %-6s %s\n", tier->name, tier->ok ? "ok" : tier->available ? "WRONG" : "absent", tier->because);
    }
}

// A tier that the device claims and would be wrong on.
static bool judge(struct run *run, const struct findings *findings) {
    for (int i = 0; i < GN_ACCURACY_COUNT; i++) {
        const struct gn_probe_tier *tier = &findings->tiers[ORDER[i]];
        if (tier->available && !tier->ok)
            return run_fail(run, GN_CHECK_FAILED, "accuracy '%s' would be wrong here: %s", tier->name, tier->because);
    }
    return true;
}

bool command_probe(struct run *run) {
    struct context ctx = run_context(run);
    struct gn_device *device = NULL;
    struct findings *findings = array_alloc(&ctx, 1, sizeof *findings, "what the probe finds");
    bool done = findings && (device = run_device(run)) &&
                gn_probe(device, &run->host, findings->rows, GN_PROBE_ROWS, &findings->count, findings->tiers, &run->error);
    if (done && run->settings.json)
        done = run_result(run, findings_json(findings, device));
    else if (done)
        progress_clear(&run->view), findings_print(run, findings, device);
    done = done && judge(run, findings);
    gn_device_destroy(device);
    free(findings);
    return done;
}
