// gnomon plan: which effects a scene calls for, and why; with --measure, what each of them costs.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/report.h"

#define MOST_EFFECTS 64

// What is known: the cost is there with --measure only.
struct plan_result {
    struct gn_effect effects[MOST_EFFECTS];
    uint32_t count;
    struct gn_plan_cost *cost;
};

// --------------------------------------------------------------------------------------------------------------- as JSON

static json_t *effects_json(const struct plan_result *r) {
    json_t *list = json_array();
    for (uint32_t i = 0; i < r->count; i++) {
        const struct json_member members[] = {
            {"name", json_words(r->effects[i].name)},
            {"state", json_words(r->effects[i].on ? "on" : "pruned")},
            {"because", json_words(r->effects[i].because)},
        };
        json_t *effect = JSON_MEMBERS(members);
        if (effect && r->cost && r->cost->without[i].measured) {
            json_object_set_new(effect, "pipeline_ms", json_ms(r->cost->pruned.pipeline_ms - r->cost->without[i].side.pipeline_ms));
            json_object_set_new(effect, "trace_ms", json_ms(r->cost->pruned.trace_ms - r->cost->without[i].side.trace_ms));
        }
        json_array_append_new(list, effect);
    }
    return list;
}

static json_t *side_json(const struct gn_plan_side *side) {
    const struct json_member members[] = {
        {"pipeline_ms", json_ms(side->pipeline_ms)},
        {"trace_ms", json_ms(side->trace_ms)},
        {"rays", json_integer((json_int_t)side->rays)},
        {"device_bytes", json_integer((json_int_t)side->device_bytes)},
    };
    return JSON_MEMBERS(members);
}

static json_t *buffers_json(const struct gn_plan_cost *cost) {
    json_t *list = json_array();
    for (uint32_t i = 0; i < cost->buffer_count; i++) {
        const struct gn_plan_buffer *buffer = &cost->buffers[i];
        const struct json_member members[] = {
            {"name", json_words(buffer->name)},
            {"bytes", json_integer((json_int_t)buffer->bytes)},
            {"limit", buffer->limit ? json_integer((json_int_t)buffer->limit) : json_null()},
        };
        json_array_append_new(list, JSON_MEMBERS(members));
    }
    return list;
}

static json_t *as_json(const struct plan_result *r, const struct gn_device *device) {
    if (!r->cost) {
        const struct json_member members[] = {{"effects", effects_json(r)}};
        return JSON_MEMBERS(members);
    }
    const struct json_member members[] = {
        {"effects", effects_json(r)},
        {"device", json_words(device_name(device))},
        {"driver", json_words(device_driver(device))},
        {"rounds", json_integer(r->cost->rounds)},
        {"pruned", side_json(&r->cost->pruned)},
        {"full", side_json(&r->cost->full)},
        {"buffers", buffers_json(r->cost)},
    };
    return JSON_MEMBERS(members);
}

// ------------------------------------------------------------------------------------------------------------ for people

static void print_effects(const struct plan_result *r) {
    printf(r->cost ? "%-18s %-7s %10s %10s  %s\n" : "%-18s %-7s %.0s%.0s%s\n", "EFFECT", "STATE", "COMPILE", "TRACE", "BECAUSE");
    for (uint32_t i = 0; i < r->count; i++) {
        const struct gn_effect *effect = &r->effects[i];
        printf("%-18s %-7s ", effect->name, effect->on ? "on" : "pruned");
        if (r->cost && r->cost->without[i].measured)
            printf("%+7.0f ms %+7.1f ms  ", r->cost->pruned.pipeline_ms - r->cost->without[i].side.pipeline_ms,
                   r->cost->pruned.trace_ms - r->cost->without[i].side.trace_ms);
        else if (r->cost)
            printf("%10s %10s  ", "", "");
        printf("%s\n", effect->because);
    }
}

static void print_side(const char *name, const struct gn_plan_side *side) {
    printf("%-8s %10.0f ms %10.1f ms %12" PRIu64 " %10.1f KiB\n", name, side->pipeline_ms, side->trace_ms, side->rays,
           (double)side->device_bytes / 1024);
}

static void print_cost(const struct gn_plan_cost *cost) {
    printf("\n%-8s %13s %13s %12s %14s\n", "KERNEL", "COMPILE", "TRACE", "RAYS", "MEMORY");
    print_side("pruned", &cost->pruned);
    print_side("full", &cost->full);
    printf("\n%-24s %14s  %s\n", "BUFFER", "BYTES", "OF WHAT THE DEVICE ALLOWS");
    for (uint32_t i = 0; i < cost->buffer_count; i++) {
        const struct gn_plan_buffer *buffer = &cost->buffers[i];
        printf("%-24s %14" PRIu64, buffer->name, buffer->bytes);
        if (buffer->limit) printf("  %.2g %%", 100 * (double)buffer->bytes / (double)buffer->limit);
        printf("\n");
    }
}

// ---------------------------------------------------------------------------------------------------------------- command

// A driver's cache would hide what compiling takes.
static bool measure(struct run *run, struct plan_result *r, struct gn_device **device, struct gn_scene *scene,
                    const struct gn_render_params *params) {
    r->cost = calloc(1, sizeof *r->cost);
    if (!r->cost) return run_fail(run, GN_LIMIT, "no memory for the result");
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    return (*device = run_device(run)) && gn_plan_measure(*device, scene, params, r->cost, &run->error);
}

static bool report(struct run *run, const struct plan_result *r, const struct gn_device *device) {
    if (run->settings.json) return run_result(run, as_json(r, device));
    print_effects(r);
    if (r->cost) print_cost(r->cost);
    return true;
}

bool command_plan(struct run *run) {
    struct plan_result result = {.count = 0};
    struct gn_device *device = NULL;
    const struct gn_render_params params = run_render_params(run);
    struct gn_scene *scene = gn_scene_load(run->settings.positionals[0], &run->host, &run->error);
    bool done = scene && gn_plan(scene, &params, result.effects, MOST_EFFECTS, &result.count, &run->error) &&
                (!run->settings.measure || measure(run, &result, &device, scene, &params)) && report(run, &result, device);
    free(result.cost);
    gn_device_destroy(device);
    gn_scene_destroy(scene);
    return done;
}
