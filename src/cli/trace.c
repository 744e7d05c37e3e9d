// gnomon trace: hits for a batch of rays, .npy to .npy.
#include <inttypes.h>
#include <stdlib.h>

#include "base/npy.h"
#include "cli/interrupt.h"
#include "cli/report.h"

_Static_assert(sizeof(struct gn_ray) == 8 * sizeof(float), "a row of the rays file is a gn_ray");

struct batch {
    struct gn_ray *rays;
    struct gn_hit *hits;
    size_t count;
};

static bool read_batch(struct batch *out, struct run *run) {
    struct context ctx = run_context(run);
    float *rows;
    *out = (struct batch){0};
    if (!npy_read_f32(&rows, &out->count, &ctx, run->settings.rays, 8)) return false;
    out->rays = (struct gn_ray *)(void *)rows;
    return (out->hits = array_alloc(&ctx, out->count, sizeof *out->hits, "the hits")) != NULL;
}

static bool write_batch(const struct batch *batch, struct run *run) {
    struct context ctx = run_context(run);
    interrupt_hold();
    bool written = npy_write_hits(batch->hits, batch->count, &ctx, run->settings.output);
    interrupt_release();
    return written;
}

static json_t *as_json(const struct gn_trace_stats *stats, const struct gn_device *device, const struct gn_time *time) {
    const struct json_member members[] = {
        {"rays", json_integer((json_int_t)stats->rays)},
        {"hits", json_integer((json_int_t)stats->hits)},
        {"accuracy", json_words(stats->accuracy)},
        {"undecided_rays", json_integer((json_int_t)stats->undecided_rays)},
        {"second_stage_rays", json_integer((json_int_t)stats->second_stage_rays)},
        {"host_rays", json_integer((json_int_t)stats->host_rays)},
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"time_ms", json_times(time, false)},
        {"mrays_per_s", json_number(stats->mrays_per_s)},
    };
    return JSON_MEMBERS(members);
}

static bool report(struct run *run, const struct gn_trace_stats *stats, const struct gn_device *device) {
    struct gn_time time = stats->time_ms;
    time.total = run_ms(run);
    run_say(run, "%s: %" PRIu64 " rays, %" PRIu64 " %s; %s, %s", run->settings.output, stats->rays, stats->hits,
            run->settings.any ? "occluded" : "hits", stats->accuracy, device_name(device));
    run_say(run, "%.3g million rays a second; %.2f s in all", stats->mrays_per_s, 1e-3 * time.total);
    if (run->settings.stats) {
        say_times(run, &time, false);
        say_undecided(run, stats->undecided_rays, stats->second_stage_rays, stats->host_rays);
    }
    return !run->settings.json || run_result(run, as_json(stats, device, &time));
}

bool command_trace(struct run *run) {
    const struct settings *settings = &run->settings;
    if (!settings->rays) return run_fail(run, GN_USAGE, "which rays? --rays IN.npy is missing");
    if (!settings->output) return run_fail(run, GN_USAGE, "where to? -o OUT.npy is missing");
    if (!run_check_output(run, settings->output, "npy")) return false;

    struct gn_device *device = NULL;
    struct gn_scene *scene = NULL;
    struct batch batch;
    struct gn_trace_stats stats;
    const struct gn_trace_params params = {
        .accuracy = run_accuracy(run), .any = settings->any, .repeat = settings->repeat, .host = &run->host};
    bool done = read_batch(&batch, run) && (scene = gn_scene_load(settings->positionals[0], &run->host, &run->error)) &&
                (settings->reference || (device = run_device(run))) &&
                gn_trace(device, scene, &params, batch.rays, batch.hits, batch.count, &stats, &run->error) && write_batch(&batch, run) &&
                report(run, &stats, device);
    gn_device_destroy(device);
    gn_scene_destroy(scene);
    free(batch.hits);
    free(batch.rays);
    return done;
}
