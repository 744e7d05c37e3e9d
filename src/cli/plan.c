// gnomon plan: which effects a scene calls for, and why.
#include <stdio.h>

#include "cli/command.h"

#define MOST_EFFECTS 64

static json_t *as_json(const struct gn_effect *effects, uint32_t count) {
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        const struct json_member members[] = {
            {"name", json_words(effects[i].name)},
            {"state", json_words(effects[i].on ? "on" : "pruned")},
            {"because", json_words(effects[i].because)},
        };
        json_array_append_new(list, JSON_MEMBERS(members));
    }
    const struct json_member members[] = {{"effects", list}};
    return JSON_MEMBERS(members);
}

static void print(const struct gn_effect *effects, uint32_t count) {
    printf("%-18s %-7s %s\n", "EFFECT", "STATE", "BECAUSE");
    for (uint32_t i = 0; i < count; i++) printf("%-18s %-7s %s\n", effects[i].name, effects[i].on ? "on" : "pruned", effects[i].because);
}

bool command_plan(struct run *run) {
    struct gn_effect effects[MOST_EFFECTS];
    uint32_t count;
    const struct gn_render_params params = run_render_params(run);
    struct gn_scene *scene = gn_scene_load(run->settings.positionals[0], &run->host, &run->error);
    bool done = scene && gn_plan(scene, &params, effects, MOST_EFFECTS, &count, &run->error);
    gn_scene_destroy(scene);
    if (!done) return false;
    if (run->settings.json) return run_result(run, as_json(effects, count));
    print(effects, count);
    return true;
}
