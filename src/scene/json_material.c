// The materials of a scene file.
#include <string.h>

#include "scene/json_parts.h"

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
    {NULL, 0},
};

// What the model's terms are where the file says nothing. The diffuse color of glass and mirrors is what they let pass and send back:
// white, and no light comes from all around to them but by rays.
static void set_defaults(struct scene_material *out) {
    if (out->model != MODEL_DIELECTRIC && out->model != MODEL_MIRROR) return;
    for (int i = 0; i < 3; i++) out->diffuse[i] = 1;
}

static bool read_colors(struct scene_material *out, const struct json_at *at) {
    if (!at_get_float3(at, "diffuse", RANGE_NOT_NEGATIVE, out->diffuse)) return false;
    const bool specular = out->model == MODEL_DIELECTRIC || out->model == MODEL_MIRROR;
    for (int i = 0; i < 3; i++) out->ambient[i] = specular ? 0 : out->diffuse[i];
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
    struct json_at member;
    int mode = at_member(&member, at, "alpha_cutoff") ? ALPHA_MASK : at_member(&member, at, "alpha") ? ALPHA_BLEND : ALPHA_OPAQUE;
    if (!at_get_choice(at, "alpha_mode", modes, &mode) || !at_get_float(at, "alpha", RANGE_SHARE, &out->alpha) ||
        !at_get_float(at, "alpha_cutoff", RANGE_SHARE, &out->alpha_cutoff))
        return false;
    out->alpha_mode = (enum alpha_mode)mode;
    return true;
}

static bool read_material(struct scene_material *out, const struct json_at *at) {
    int model = MODEL_PHONG;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_get_choice(at, "model", models, &model) || !at_object_of_kind(at, keys, models, model)) return false;
    out->model = (enum material_model)model;
    set_defaults(out);
    return read_colors(out, at) && read_physics(out, at) && read_alpha(out, at);
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
        if (!material || !at_member(&at, &materials, name) || !read_material(material, &at)) return false;
    }
    return true;
}
