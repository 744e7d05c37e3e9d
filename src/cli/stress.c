// gnomon stress: the numerically hard cases, each accuracy tier against the exact answer.
#include <inttypes.h>
#include <stdio.h>

#include "cli/report.h"

static json_t *result_as_json(const struct gn_stress_result *result) {
    const struct json_member members[] = {
        {"id", json_words(result->id)},
        {"tier", json_words(result->accuracy)},
        {"rays", json_integer((json_int_t)result->rays)},
        {"wrong", json_integer((json_int_t)result->wrong)},
        {"note", json_words(result->note)},
        {"case", json_words(result->text)},
        {"waiting", json_boolean(result->waits)},
        {"pass", json_boolean(result->pass)},
        {"allowed", json_integer((json_int_t)result->allowed)},
        {"leaks", json_integer((json_int_t)result->leaks)},
        {"time_ms", json_ms(result->ms)},
    };
    return JSON_MEMBERS(members);
}

static json_t *as_json(struct run *run, const struct gn_stress *stress, const struct gn_device *device) {
    uint32_t count, tiers;
    const struct gn_stress_result *results = gn_stress_results(stress, &count, &tiers);
    json_t *cases = json_array();
    for (uint32_t i = 0; i < count; i++) json_array_append_new(cases, result_as_json(&results[i]));
    const struct json_member members[] = {
        {"cases", cases},
        {"pass", json_boolean(gn_stress_passed(stress))},
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"time_ms", json_ms(run_ms(run))},
    };
    return JSON_MEMBERS(members);
}

// ---------------------------------------------------------------------------------------------------------- for people

static void print_head(const struct gn_stress_result *row, uint32_t tiers) {
    printf("%-5s %9s", "CASE", "RAYS");
    for (uint32_t i = 0; i < tiers; i++) printf(" %9s", row[i].accuracy);
    printf(tiers > 1 ? "  TIMES AS LONG AS %s\n" : "\n", row[0].accuracy);
}

// "  1.0   1.1   5.2": the tiers' times as multiples of the first one's, where that was measured; as wide where it was not.
static void print_times(const struct gn_stress_result *row, uint32_t tiers) {
    for (uint32_t i = 1; i < tiers; i++) {
        if (row->ms > 0)
            printf(" %5.1f", row[i].ms / row->ms);
        else
            printf("      ");
    }
}

// One line for a case: what each tier got wrong. '!' marks what is more than is known of the tier; its note follows, with -v every note.
static void print_row(const struct run *run, const struct gn_stress_result *row, uint32_t tiers) {
    uint64_t rays = 0;
    bool waits = true;
    for (uint32_t i = 0; i < tiers; i++) rays = row[i].rays > rays ? row[i].rays : rays, waits = waits && row[i].waits;
    if (waits) {
        printf("%-5s %9s  %s: %s\n", row->id, "-", row->text, row->note);
        return;
    }
    printf("%-5s %9" PRIu64, row->id, rays);
    for (uint32_t i = 0; i < tiers; i++) {
        char count[24] = "-";
        if (row[i].rays) snprintf(count, sizeof count, "%s%" PRIu64, row[i].pass ? "" : "!", row[i].wrong);
        printf(" %9s", count);
    }
    print_times(row, tiers);
    printf("  %s\n", row->text);
    for (uint32_t i = 0; i < tiers; i++)
        if (*row[i].note && (!row[i].pass || run->settings.verbose > 0)) printf("      %s: %s\n", row[i].accuracy, row[i].note);
}

static void print_all(const struct run *run, const struct gn_stress *stress) {
    uint32_t count, tiers;
    const struct gn_stress_result *results = gn_stress_results(stress, &count, &tiers);
    print_head(results, tiers);
    for (uint32_t i = 0; i < count; i += tiers) print_row(run, &results[i], tiers);
}

// What is the matter with a result: too many wrong ones, or what its note says.
static bool fail_of(struct run *run, const struct gn_stress_result *result) {
    char wrong[96] = "";
    if (result->wrong > result->allowed)
        snprintf(wrong, sizeof wrong, " %" PRIu64 " of %" PRIu64 " wrong, %" PRIu64 " may be%s", result->wrong, result->rays,
                 result->allowed, *result->note ? ";" : "");
    return run_fail(run, GN_CHECK_FAILED, "%s at %s:%s%s%s", result->id, result->accuracy, wrong, *result->note ? " " : "", result->note);
}

static bool judge(struct run *run, const struct gn_stress *stress) {
    uint32_t count, tiers, waiting = 0;
    const struct gn_stress_result *results = gn_stress_results(stress, &count, &tiers);
    for (uint32_t i = 0; i < count; i++) {
        const struct gn_stress_result *result = &results[i];
        if (!result->pass) return fail_of(run, result);
        waiting += i % tiers == 0 && result->waits;
    }
    uint32_t done = count / tiers - waiting;
    run_say(run, "%" PRIu32 " case%s as %s should be, %" PRIu32 " waiting; %.1f s", done, done == 1 ? "" : "s", done == 1 ? "it" : "they",
            waiting, 1e-3 * run_ms(run));
    return true;
}

static bool report(struct run *run, const struct gn_stress *stress, const struct gn_device *device) {
    if (run->settings.json && !run_result(run, as_json(run, stress, device))) return false;
    if (!run->settings.json) print_all(run, stress);
    return judge(run, stress);
}

bool command_stress(struct run *run) {
    const struct settings *settings = &run->settings;
    const struct gn_stress_params params = {.cases = settings->only,
                                            .accuracies = settings->accuracy < 0 ? 0 : 1u << settings->accuracy,
                                            .rays = settings->ray_count,
                                            .seed = settings->seed,
                                            .host = &run->host};
    struct gn_stress *stress = NULL;
    struct gn_device *device = run_device(run);
    bool done = device && (stress = gn_stress_run(device, &params, &run->error)) && report(run, stress, device);
    gn_stress_destroy(stress);
    gn_device_destroy(device);
    return done;
}
