// gnomon render: a scene to a picture file.
#include <inttypes.h>

#include "cli/pick.h"
#include "cli/report.h"

static json_t *as_json(const struct run *run, const struct gn_picture *picture, const struct gn_device *device, uint32_t spp,
                       const struct gn_time *time) {
    const struct gn_render_stats *stats = gn_picture_stats(picture);
    const struct json_member members[] = {
        {"image", json_words(run->settings.output)},
        {"width", json_integer(gn_picture_width(picture))},
        {"height", json_integer(gn_picture_height(picture))},
        {"spp", json_integer(spp)},
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"accuracy", json_words(stats->accuracy)},
        {"effects", json_names(stats->effects)},
        {"rays", json_integer((json_int_t)stats->rays)},
        {"nonfinite_pixels", json_integer((json_int_t)stats->nonfinite_pixels)},
        {"undecided_rays", json_integer((json_int_t)stats->undecided_rays)},
        {"second_stage_rays", json_integer((json_int_t)stats->second_stage_rays)},
        {"host_rays", json_integer((json_int_t)stats->host_rays)},
        {"time_ms", json_times(time, true)},
        {"mrays_per_s", json_number(stats->mrays_per_s)},
    };
    return JSON_MEMBERS(members);
}

static void tell(struct run *run, const struct gn_picture *picture, const struct gn_device *device, uint32_t spp,
                 const struct gn_time *time) {
    const struct gn_render_stats *stats = gn_picture_stats(picture);
    run_say(run, "%s: %" PRIu32 " × %" PRIu32 " pixels, %" PRIu32 " sample%s each; %s, %s", run->settings.output, gn_picture_width(picture),
            gn_picture_height(picture), spp, spp == 1 ? "" : "s", stats->accuracy, device_name(device));
    run_say(run, "%.3g million rays at %.3g million a second; %.2f s in all", 1e-6 * (double)stats->rays, stats->mrays_per_s,
            1e-3 * time->total);
    if (!run->settings.stats) return;
    say_times(run, time, true);
    run_say(run, "  rays       %12" PRIu64, stats->rays);
    say_undecided(run, stats->undecided_rays, stats->second_stage_rays, stats->host_rays);
    run_say(run, "  nonfinite  %12" PRIu64 "  pixels with samples that came out NaN or infinite", stats->nonfinite_pixels);
    run_say(run, "  effects    %s", stats->effects);
}

static bool report(struct run *run, const struct gn_picture *picture, const struct gn_device *device, uint32_t spp,
                   const struct picking *picking) {
    const struct gn_render_stats *stats = gn_picture_stats(picture);
    struct gn_time time = stats->time_ms;
    time.total = run_ms(run);
    if (stats->nonfinite_pixels)
        run_say(run, "gnomon: warning: in %" PRIu64 " pixels samples came out NaN or infinite, and were left out", stats->nonfinite_pixels);
    tell(run, picture, device, spp, &time);
    if (!run->settings.json) return true;
    return run_result(run, as_json(run, picture, device, spp, &time)) &&
           (picking_add_json(picking, run->result) || run_fail(run, GN_LIMIT, "no memory for the result"));
}

// Picks, renders, saves, checks, reports.
static bool render(struct run *run, struct gn_picture **picture, struct gn_device *device, struct gn_scene *scene) {
    struct gn_render_params params = run_render_params(run);
    struct picking picking;
    if (!picking_start(&picking, run, device, scene, &params)) return false;
    if (!(*picture = gn_render(device, scene, &params, &run->error)) || !run_save(run, *picture, run->settings.output)) return false;
    if (!picking_check(&picking, run, scene, *picture)) return false;
    struct gn_scene_info info;
    gn_scene_info(scene, &info);
    return report(run, *picture, device, params.spp ? params.spp : info.spp, &picking) && picking_judge(&picking, run);
}

bool command_render(struct run *run) {
    const struct settings *settings = &run->settings;
    if (!settings->output) return run_fail(run, GN_USAGE, "where to? -o FILE is missing (.png, .exr or .pfm)");
    if (settings->reference && (settings->max_error > 0 || settings->max_time > 0))
        return run_fail(run, GN_USAGE, "--reference leaves nothing to pick: --max-error and --max-time are for devices");
    if (!run_check_output(run, settings->output, PICTURE_SUFFIXES)) return false;

    struct gn_device *device = NULL;
    struct gn_picture *picture = NULL;
    struct gn_scene *scene = gn_scene_load(settings->positionals[0], &run->host, &run->error);
    bool done = scene && (settings->reference || (device = run_device(run))) && render(run, &picture, device, scene);
    gn_picture_destroy(picture);
    gn_device_destroy(device);
    gn_scene_destroy(scene);
    return done;
}
