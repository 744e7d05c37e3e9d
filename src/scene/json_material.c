// The materials of a scene file.
#include <string.h>

#include "scene/json_map.h"

#define PHONG (1u << MODEL_PHONG)
#define BLINN (1u << MODEL_BLINN_PHONG)
#define LAMBERT (1u << MODEL_LAMBERT)
#define METAL (1u << MODEL_METALLIC_ROUGHNESS)
#define GLASS (1u << MODEL_DIELECTRIC)
#define MIRROR (1u << MODEL_MIRROR)
#define ALL (PHONG | BLINN | LAMBERT | METAL | GLASS | MIRROR)

static const char *const models[] = {[MODEL_PHONG] = "phong",
                                     [MODEL_BLINN_PHONG] = "blinn_phong",
                                     [MODEL_LAMBERT] = "lambert",
                                     [MODEL_METALLIC_ROUGHNESS] = "metallic_roughness",
                                     [MODEL_DIELECTRIC] = "dielectric",
                                     [MODEL_MIRROR] = "mirror",
                                     NULL};

static const struct json_key keys[] = {
    {"model", ALL},
    {"ambient", PHONG | BLINN | LAMBERT | METAL},
    {"diffuse", ALL},
    {"specular", PHONG | BLINN},
    {"shininess", PHONG | BLINN},
    {"reflection", PHONG | BLINN | LAMBERT},
    {"metallic", METAL},
    {"roughness", METAL},
    {"ior", METAL | GLASS},
    {"absorption", GLASS},
    {"priority", GLASS},
    {"thin", GLASS},
    {"emission", ALL},
    {"alpha", ALL},
    {"alpha_mode", ALL},
    {"alpha_cutoff", ALL},
    {"diffuse_map", ALL},
    {"normal_map", ALL},
    {"roughness_map", METAL},
    {"emission_map", ALL},
    {NULL, 0},
};

static void set3(float out[3], float value) { out[0] = out[1] = out[2] = value; }

static bool has(const struct json_at *object, const char *key) {
    struct json_at member;
    return at_member(&member, object, key);
}

// What the model's terms are where the file says nothing. What a map is to color, is white; so is what glass and mirrors do to light.
static void set_defaults(struct scene_material *out, const struct json_at *at) {
    if (out->model == MODEL_DIELECTRIC || out->model == MODEL_MIRROR || has(at, "diffuse_map")) set3(out->diffuse, 1);
    if (has(at, "emission_map")) set3(out->emission, 1);
    if (has(at, "roughness_map")) out->metallic = 1;
}

static bool read_colors(struct scene_material *out, const struct json_at *at) {
    if (!at_get_float3(at, "diffuse", RANGE_NOT_NEGATIVE, out->diffuse)) return false;
    // Light from all around comes to glass and mirrors by rays, not as a term.
    memcpy(out->ambient, out->diffuse, sizeof out->ambient);
    if (out->model == MODEL_DIELECTRIC || out->model == MODEL_MIRROR) set3(out->ambient, 0);
    return at_get_float3(at, "ambient", RANGE_NOT_NEGATIVE, out->ambient) &&
           at_get_float3(at, "specular", RANGE_NOT_NEGATIVE, out->specular) &&
           at_get_float(at, "shininess", RANGE_NOT_NEGATIVE, &out->shininess) &&
           at_get_float3(at, "reflection", RANGE_SHARE, out->reflection) &&
           at_get_float3(at, "emission", RANGE_NOT_NEGATIVE, out->emission);
}

static bool read_physics(struct scene_material *out, const struct json_at *at) {
    return at_get_float(at, "metallic", RANGE_SHARE, &out->metallic) && at_get_float(at, "roughness", RANGE_SHARE, &out->roughness) &&
           at_get_float(at, "ior", RANGE_POSITIVE, &out->ior) && at_get_float3(at, "absorption", RANGE_NOT_NEGATIVE, out->absorption) &&
           at_get_count(at, "priority", 0, 65535, &out->priority) && at_get_bool(at, "thin", &out->thin);
}

// Without a mode, a cutoff asks for a mask, and alpha for blending.
static bool read_alpha(struct scene_material *out, const struct json_at *at) {
    static const char *const modes[] = {[ALPHA_OPAQUE] = "opaque", [ALPHA_MASK] = "mask", [ALPHA_BLEND] = "blend", NULL};
    int mode = has(at, "alpha_cutoff") ? ALPHA_MASK : has(at, "alpha") ? ALPHA_BLEND : ALPHA_OPAQUE;
    if (!at_get_choice(at, "alpha_mode", modes, &mode) || !at_get_float(at, "alpha", RANGE_SHARE, &out->alpha) ||
        !at_get_float(at, "alpha_cutoff", RANGE_SHARE, &out->alpha_cutoff))
        return false;
    out->alpha_mode = (enum alpha_mode)mode;
    return true;
}

static bool read_maps(struct scene_material *out, struct scene_build *build, const struct json_at *at) {
    return map_read(&out->diffuse_map, NULL, build, at, "diffuse_map", MAP_COLOR) &&
           map_read(&out->normal_map, &out->normal_scale, build, at, "normal_map", MAP_NORMAL) &&
           map_read(&out->roughness_map, NULL, build, at, "roughness_map", MAP_DATA) &&
           map_read(&out->emission_map, NULL, build, at, "emission_map", MAP_COLOR);
}

static bool read_material(struct scene_material *out, struct scene_build *build, const struct json_at *at) {
    int model = MODEL_PHONG;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_get_choice(at, "model", models, &model) || !at_object_of_kind(at, keys, models, model)) return false;
    out->model = (enum material_model)model;
    set_defaults(out, at);
    return read_colors(out, at) && read_physics(out, at) && read_alpha(out, at) && read_maps(out, build, at);
}

bool part_materials(struct scene_build *build, const struct json_at *root) {
    struct json_at materials;
    if (!at_member(&materials, root, "materials")) return true;
    if (!json_is_object(materials.value)) return at_expected(&materials, "an object of materials by name");
    const char *name;
    json_t *value;
    json_object_foreach(materials.value, name, value) {
        struct json_at at;
        struct scene_material *material = material_add(&build->materials, build->ctx, name);
        if (!material || !at_member(&at, &materials, name) || !read_material(material, build, &at)) return false;
    }
    return true;
}
