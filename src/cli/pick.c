#include "cli/pick.h"

#include <inttypes.h>
#include <math.h>

// Seconds that the reference may take to check: of those that rendering took, but not too few, and of those that are left.
#define CHECK_SHARE 0.1
#define CHECK_LEAST 2.0
#define CHECK_OF_REST 0.5

bool picking_start(struct picking *out, struct run *run, struct gn_device *device, struct gn_scene *scene, struct gn_render_params *render) {
    const struct settings *settings = &run->settings;
    *out = (struct picking){.wanted = settings->max_error > 0 || settings->max_time > 0};
    if (!out->wanted) return true;
    out->params = (struct gn_pick_params){.render = *render, .keep_accuracy = settings->accuracy >= 0, .max_error = settings->max_error};
    if (settings->max_time > 0) out->params.max_seconds = fmax(settings->max_time - 1e-3 * run_ms(run), 1e-6);
    if (!gn_pick(device, scene, &out->params, &out->pick, &run->error)) return false;
    const struct gn_pick_candidate *picked = &out->pick.picked;
    render->accuracy = picked->accuracy;
    render->spp = picked->spp;
    run_say(run, "picked %s with %" PRIu32 " sample%s per pixel: expected an error of %.3g, %s, in %.3g s", gn_accuracy_name(picked->accuracy),
            picked->spp, picked->spp == 1 ? "" : "s", picked->error, picked->measured ? "measured on a sample" : "extrapolated", picked->seconds);
    run_say(run, "why: %s", out->pick.because);
    return true;
}

bool picking_check(struct picking *picking, struct run *run, struct gn_scene *scene, const struct gn_picture *picture) {
    if (!picking->wanted) return true;
    picking->seconds = 1e-3 * run_ms(run);
    double seconds = fmax(CHECK_LEAST, CHECK_SHARE * 1e-3 * gn_picture_stats(picture)->time_ms.trace);
    if (run->settings.max_time > 0) seconds = fmin(seconds, CHECK_OF_REST * fmax(run->settings.max_time - picking->seconds, 0));
    return gn_pick_check(scene, &picking->params, &picking->pick, picture, seconds, &picking->measured_error, &picking->checked_pixels,
                         &run->error);
}

// ------------------------------------------------------------------------------------------------------------------ JSON

static json_t *candidate_json(const struct gn_pick_candidate *candidate) {
    const struct json_member members[] = {
        {"accuracy", json_words(gn_accuracy_name(candidate->accuracy))},
        {"spp", json_integer(candidate->spp)},
        {"error", json_number(candidate->error)},
        {"time_ms", json_ms(1e3 * candidate->seconds)},
        {"measured", json_boolean(candidate->measured)},
    };
    return JSON_MEMBERS(members);
}

static json_t *picked_json(const struct gn_pick *pick) {
    json_t *candidates = json_array();
    for (uint32_t i = 0; i < pick->count; i++) json_array_append_new(candidates, candidate_json(&pick->candidates[i]));
    const struct json_member members[] = {
        {"accuracy", json_words(gn_accuracy_name(pick->picked.accuracy))},
        {"spp", json_integer(pick->picked.spp)},
        {"time_ms", json_ms(1e3 * pick->picked.seconds)},
        {"met", json_boolean(pick->met)},
        {"because", json_words(pick->because)},
        {"candidates", candidates},
    };
    return JSON_MEMBERS(members);
}

bool picking_add_json(const struct picking *picking, json_t *result) {
    if (!picking->wanted || !result) return true;
    const struct gn_pick_params *params = &picking->params;
    return json_object_set_new(result, "picked", picked_json(&picking->pick)) == 0 &&
           json_object_set_new(result, "max_error", params->max_error > 0 ? json_number(params->max_error) : json_null()) == 0 &&
           json_object_set_new(result, "expected_error", json_number(picking->pick.picked.error)) == 0 &&
           json_object_set_new(result, "measured_error", json_number(picking->measured_error)) == 0 &&
           json_object_set_new(result, "checked_pixels", json_integer((json_int_t)picking->checked_pixels)) == 0;
}

// --------------------------------------------------------------------------------------------------------------- judging

bool picking_judge(const struct picking *picking, struct run *run) {
    if (!picking->wanted) return true;
    const struct gn_pick *pick = &picking->pick;
    double max_error = run->settings.max_error, max_time = run->settings.max_time;
    run_say(run, "checked on %" PRIu64 " other pixels: an error of %.3g, expected %.3g", picking->checked_pixels, picking->measured_error,
            pick->picked.error);
    if (max_time > 0 && !(picking->seconds <= max_time))
        return run_fail(run, GN_CHECK_FAILED, "the picture took %.3g s, not %.3g; %s", picking->seconds, max_time, pick->because);
    if (max_error > 0 && !(picking->measured_error <= max_error))
        return run_fail(run, GN_CHECK_FAILED, "the error is %.3g, not %.3g; the picture is there all the same; %s", picking->measured_error,
                        max_error, pick->because);
    return pick->met || run_fail(run, GN_CHECK_FAILED, "%s; the picture is there all the same", pick->because);
}
