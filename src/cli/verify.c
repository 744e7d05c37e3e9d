// gnomon verify: the device against the fp64 reference, pixel by pixel.
#include <inttypes.h>
#include <stdio.h>

#include "cli/report.h"

static json_t *as_json(const struct run *run, const struct gn_verify_result *result, const struct gn_device *device) {
    const struct json_member times[] = {
        {"total", json_ms(run_ms(run))},
        {"device", json_ms(result->device.time_ms.trace)},
        {"reference", json_ms(result->reference.time_ms.trace)},
    };
    const struct json_member members[] = {
        {"pass", json_boolean(result->pass)},
        {"pixels", json_integer((json_int_t)result->pixels)},
        {"pixels_differing", json_integer((json_int_t)result->pixels_differing)},
        {"max_abs", json_number(result->max_abs)},
        {"rmse", json_number(result->rmse)},
        {"wrong_hits", json_integer((json_int_t)result->wrong_hits)},
        {"ties", json_integer((json_int_t)result->ties)},
        {"nonfinite_pixels", json_integer((json_int_t)result->nonfinite_pixels)},
        {"pixels_allowed", json_integer((json_int_t)result->pixels_allowed)},
        {"hits_allowed", json_integer((json_int_t)result->hits_allowed)},
        {"tolerance", json_number(result->tolerance)},
        {"worst_x", json_integer(result->worst_x)},
        {"worst_y", json_integer(result->worst_y)},
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"accuracy", json_words(result->device.accuracy)},
        {"time_ms", JSON_MEMBERS(times)},
    };
    return JSON_MEMBERS(members);
}

static bool judge(struct run *run, const struct gn_verify_result *result) {
    char counts[256];
    snprintf(counts, sizeof counts,
             "of %" PRIu64 " pixels %" PRIu64 " differ by more than %.3g (%" PRIu64 " may), %" PRIu64 " hit something elsewhere (%" PRIu64
             " may), %" PRIu64 " are ties, %" PRIu64 " not finite",
             result->pixels, result->pixels_differing, result->tolerance, result->pixels_allowed, result->wrong_hits - result->ties,
             result->hits_allowed, result->ties, result->nonfinite_pixels);
    if (!result->pass)
        return run_fail(run, GN_CHECK_FAILED, "not the same: %s; largest difference %.3g at (%" PRIu32 ", %" PRIu32 "), RMSE %.3g", counts,
                        result->max_abs, result->worst_x, result->worst_y, result->rmse);
    run_say(run, "the same: %s; largest difference %.3g, RMSE %.3g", counts, result->max_abs, result->rmse);
    return true;
}

bool command_verify(struct run *run) {
    const struct settings *settings = &run->settings;
    if (settings->output && !run_check_output(run, settings->output, PICTURE_SUFFIXES)) return false;

    struct gn_device *device = NULL;
    struct gn_picture *difference = NULL;
    struct gn_verify_result result;
    const struct gn_verify_params params = {.render = run_render_params(run), .tolerance = settings->tolerance};
    struct gn_scene *scene = gn_scene_load(settings->positionals[0], &run->host, &run->error);
    bool done = scene && (device = run_device(run)) &&
                gn_verify(device, scene, &params, &result, settings->output ? &difference : NULL, &run->error) &&
                (!difference || run_save(run, difference, settings->output)) &&
                (!settings->json || run_result(run, as_json(run, &result, device))) && judge(run, &result);
    gn_picture_destroy(difference);
    gn_device_destroy(device);
    gn_scene_destroy(scene);
    return done;
}
