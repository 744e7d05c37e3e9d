// Where the light of a scene file comes from and what it meets on its way: lights, the environment, fog.
#include <stdlib.h>

#include "scene/json_map.h"

// ------------------------------------------------------------------------------------------------------------------- lights

#define POINT (1u << LIGHT_POINT)
#define DIRECTIONAL (1u << LIGHT_DIRECTIONAL)
#define SPOT (1u << LIGHT_SPOT)

static const char *const types[] = {[LIGHT_POINT] = "point", [LIGHT_DIRECTIONAL] = "directional", [LIGHT_SPOT] = "spot", NULL};

static const struct json_key keys[] = {
    {"type", POINT | DIRECTIONAL | SPOT},
    {"position", POINT | SPOT},
    {"direction", DIRECTIONAL | SPOT},
    {"intensity", POINT | DIRECTIONAL | SPOT},
    {"falloff", POINT | SPOT},
    {"inner_deg", SPOT},
    {"outer_deg", SPOT},
    {NULL, 0},
};

static bool read_position(struct scene_light *out, const struct json_at *at) {
    return out->type == LIGHT_DIRECTIONAL ||
           (at_require(at, "position", "3 numbers") && at_get_float3(at, "position", RANGE_ANY, out->position));
}

static bool read_direction(struct scene_light *out, const struct json_at *at) {
    struct json_at member;
    if (out->type == LIGHT_POINT) return true;
    if (!at_require(at, "direction", "3 numbers") || !at_get_float3(at, "direction", RANGE_ANY, out->direction)) return false;
    if (out->direction[0] != 0 || out->direction[1] != 0 || out->direction[2] != 0 || !at_member(&member, at, "direction")) return true;
    return at_fail(&member, "is zero, expected the way that the light shines, such as [0,-1,0]");
}

static bool read_cone(struct scene_light *out, const struct json_at *at) {
    if (out->type != LIGHT_SPOT) return true;
    out->outer_deg = 45;
    if (!at_get_float(at, "inner_deg", RANGE_CONE, &out->inner_deg) || !at_get_float(at, "outer_deg", RANGE_CONE, &out->outer_deg))
        return false;
    return out->inner_deg < out->outer_deg || at_fail(at, "has an inner angle of %g° and an outer one of %g°, expected a smaller inner one",
                                                      (double)out->inner_deg, (double)out->outer_deg);
}

static bool read_light(struct scene_light *out, const struct json_at *at) {
    static const char *const falloffs[] = {[FALLOFF_NONE] = "none", [FALLOFF_INVERSE_SQUARE] = "inverse_square", NULL};
    int type = LIGHT_POINT, falloff = FALLOFF_NONE;
    *out = (struct scene_light){.intensity = {1, 1, 1}};
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_require(at, "type", "\"point\", \"directional\" or \"spot\"") || !at_get_choice(at, "type", types, &type) ||
        !at_object_of_kind(at, keys, types, type))
        return false;
    out->type = (enum light_type)type;
    if (!read_position(out, at) || !read_direction(out, at) || !at_get_float3(at, "intensity", RANGE_NOT_NEGATIVE, out->intensity) ||
        !at_get_choice(at, "falloff", falloffs, &falloff))
        return false;
    out->falloff = (enum light_falloff)falloff;
    return read_cone(out, at);
}

bool part_lights(struct scene_build *build, const struct json_at *root) {
    struct scene *scene = build->scene;
    struct json_at lights;
    if (!at_member(&lights, root, "lights")) return true;
    if (!at_list(&lights, 0, UINT32_MAX, "a list of lights")) return false;
    const uint32_t count = (uint32_t)json_array_size(lights.value);
    scene->lights = array_alloc(build->ctx, count, sizeof *scene->lights, "lights");
    if (!scene->lights) return false;
    for (scene->light_count = 0; scene->light_count < count; scene->light_count++) {
        const struct json_at at = at_item(&lights, scene->light_count);
        if (!read_light(&scene->lights[scene->light_count], &at)) return false;
    }
    return true;
}

// -------------------------------------------------------------------------------------------------------------- environment

// "sky.hdr", or {"file": "sky.hdr", …}.
bool part_environment(struct scene_build *build, const struct json_at *root) {
    static const char *const environment_keys[] = {"file", "scale", "rotation_deg", NULL};
    struct scene_environment *out = &build->scene->environment;
    struct json_at at, named;
    if (!at_member(&at, root, "environment")) return true;
    out->scale = 1;
    if (!json_is_string(at.value) && (!at_object(&at, environment_keys) || !at_get_float(&at, "scale", RANGE_NOT_NEGATIVE, &out->scale) ||
                                      !at_get_float(&at, "rotation_deg", RANGE_ANY, &out->rotation_deg)))
        return false;
    char *path = map_path(&named, &at, build, "the path of an image");
    struct gn_error error;
    struct context inner = context_make(&build->ctx->host, &error);
    const bool done = path && environment_load(out, &inner, path);
    if (path && !done) at_fail_as(&named, &error);
    free(path);
    return done;
}

// ---------------------------------------------------------------------------------------------------------------------- fog

bool part_fog(struct scene_fog *out, const struct json_at *root) {
    static const char *const fog_keys[] = {"density", "albedo", "anisotropy", NULL};
    struct json_at at;
    if (!at_member(&at, root, "fog")) return true;
    for (int i = 0; i < 3; i++) out->albedo[i] = 1;
    return at_object(&at, fog_keys) && at_require(&at, "density", "a number of at least 0") &&
           at_get_float(&at, "density", RANGE_NOT_NEGATIVE, &out->density) && at_get_float3(&at, "albedo", RANGE_SHARE, out->albedo) &&
           at_get_float(&at, "anisotropy", RANGE_ANISOTROPY, &out->anisotropy);
}
