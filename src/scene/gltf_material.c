// Source: Khronos Group, "glTF 2.0 Specification", 2.0.1, 2021; 3.8, 3.9, appendix B; and the extensions KHR_materials_emissive_strength,
// KHR_materials_ior, KHR_materials_transmission, KHR_materials_unlit, KHR_materials_volume, KHR_texture_transform.
#include "scene/gltf_material.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/material.h"
#include "scene/words.h"

// A material being read.
struct reading {
    const struct gltf *gltf;
    struct gltf_material *out;
    bool has_uv_set;
};

// ---------------------------------------------------------------------------------------------------------------- textures

// Scales, then turns counterclockwise as one sees it where v goes down, then moves.
static bool read_transform(float out[6], uint32_t *uv_set, const struct json_at *info) {
    struct gltf_extension transform;
    float offset[2] = {0}, scale[2] = {1, 1}, rotation = 0;
    if (!gltf_get_extension(&transform, info, "KHR_texture_transform") || !transform.found) return !transform.found;
    if (!at_get_floats(&transform.at, "offset", RANGE_ANY, 2, offset) || !at_get_floats(&transform.at, "scale", RANGE_ANY, 2, scale) ||
        !at_get_float(&transform.at, "rotation", RANGE_ANY, &rotation) || !at_get_count(&transform.at, "texCoord", 0, 255, uv_set))
        return false;
    const double c = cos(rotation), s = sin(rotation);
    out[0] = (float)(c * scale[0]), out[1] = (float)(s * scale[1]), out[2] = offset[0];
    out[3] = (float)(-s * scale[0]), out[4] = (float)(c * scale[1]), out[5] = offset[1];
    return true;
}

// A member that is a texture and how to look it up. Vertices have one set of texture coordinates in a scene: maps that use another are left
// out.
static bool read_map(struct scene_map *out, struct reading *reading, const struct json_at *object, const char *key, bool srgb) {
    struct json_at info;
    uint32_t texture, uv_set = 0;
    if (!at_member(&info, object, key)) return true;
    if (!json_is_object(info.value)) return at_expected(&info, "an object");
    if (!at_require(&info, "index", "the number of a texture") || !gltf_get_index(reading->gltf, &info, "index", "textures", &texture) ||
        !at_get_count(&info, "texCoord", 0, 255, &uv_set) || !read_transform(out->transform, &uv_set, &info))
        return false;
    if (reading->has_uv_set && uv_set != reading->out->uv_set) {
        notify(reading->gltf->ctx, GN_LEVEL_WARNING, "%s: the %s of material '%s' has texture coordinates of its own; it is left out",
               reading->gltf->json.path, key, excerpt_word(reading->out->name).text);
        return true;
    }
    reading->has_uv_set = true;
    reading->out->uv_set = uv_set;
    out->texture = texture + 1;
    out->srgb = srgb;
    return true;
}

static bool read_wrap(enum texture_wrap *out, const struct json_at *sampler, const char *key) {
    uint32_t code = 10497;
    struct json_at member;
    if (!at_get_count(sampler, key, 0, UINT32_MAX, &code)) return false;
    if (code != 10497 && code != 33071 && code != 33648 && at_member(&member, sampler, key))
        return at_expected(&member, "10497 (repeat), 33071 (clamp) or 33648 (mirror)");
    *out = code == 33071 ? WRAP_CLAMP : code == 33648 ? WRAP_MIRROR : WRAP_REPEAT;
    return true;
}

static bool read_sampler(struct texture_source *out, const struct gltf *gltf, const struct json_at *texture) {
    struct gltf_item sampler;
    uint32_t number, filter = 9729;
    if (!gltf_get_index(gltf, texture, "sampler", "samplers", &number)) return false;
    if (number == GLTF_NONE) return true;
    if (!gltf_get_item(&sampler, gltf, "samplers", number) || !read_wrap(&out->wrap_u, &sampler.at, "wrapS") ||
        !read_wrap(&out->wrap_v, &sampler.at, "wrapT") || !at_get_count(&sampler.at, "magFilter", 0, UINT32_MAX, &filter))
        return false;
    out->nearest = filter == 9728;
    return true;
}

// What to call the picture of an image that is no file of its own.
static char *embedded_name(const struct gltf *gltf, size_t number) {
    const size_t size = strlen(gltf->json.path) + 32;
    char *name = malloc(size);
    if (name) snprintf(name, size, "%s: image %zu", gltf->json.path, number);
    return name;
}

static bool copy_bytes(struct file_bytes *out, struct context *ctx, struct gltf_span span) {
    out->data = array_alloc(ctx, span.size + 1, 1, "a picture");
    if (!out->data) return false;
    memcpy(out->data, span.data, span.size);
    out->size = span.size;
    return true;
}

static bool read_image(struct texture_source *out, const struct gltf *gltf, const struct json_at *image) {
    struct json_at uri;
    struct gltf_span span;
    uint32_t view;
    const char *text = "";
    if (!gltf_get_index(gltf, image, "bufferView", "bufferViews", &view)) return false;
    if (view == GLTF_NONE && (!at_require(image, "uri", "a URI or a bufferView") || !at_get_text(image, "uri", "a URI", &text)))
        return false;
    at_member(&uri, image, "uri");
    if (view == GLTF_NONE && strncmp(text, "data:", 5) != 0) {
        out->name = gltf_uri_path(&uri, text);
        return out->name != NULL;
    }
    out->name = embedded_name(gltf, image->index);
    if (!out->name) return fail(gltf->ctx, GN_LIMIT, "no memory for a name");
    if (view == GLTF_NONE) return gltf_uri_data(&out->bytes, &uri, text);
    return gltf_get_view(&span, gltf, view) && copy_bytes(&out->bytes, gltf->ctx, span);
}

bool gltf_texture_source(struct texture_source *out, const struct gltf *gltf, uint32_t number, bool srgb) {
    struct gltf_item texture, image;
    uint32_t source;
    *out = (struct texture_source){.srgb = srgb};
    if (!gltf_get_item(&texture, gltf, "textures", number) || !gltf_get_index(gltf, &texture.at, "source", "images", &source)) return false;
    if (source == GLTF_NONE) {
        notify(gltf->ctx, GN_LEVEL_WARNING, "%s: texture %u has no picture, or one of an unknown kind; it is left out", gltf->json.path,
               number);
        return true;
    }
    if (read_sampler(out, gltf, &texture.at) && gltf_get_item(&image, gltf, "images", source) && read_image(out, gltf, &image.at))
        return true;
    texture_source_finish(out);
    return false;
}

// ---------------------------------------------------------------------------------------------------------------- materials

static bool read_base(struct reading *reading, const struct json_at *at) {
    struct scene_material *look = &reading->out->look;
    struct json_at pbr;
    float color[4] = {1, 1, 1, 1};
    look->metallic = look->roughness = 1;
    if (at_member(&pbr, at, "pbrMetallicRoughness")) {
        if (!json_is_object(pbr.value)) return at_expected(&pbr, "an object");
        if (!at_get_floats(&pbr, "baseColorFactor", RANGE_NOT_NEGATIVE, 4, color) ||
            !at_get_float(&pbr, "metallicFactor", RANGE_NOT_NEGATIVE, &look->metallic) ||
            !at_get_float(&pbr, "roughnessFactor", RANGE_NOT_NEGATIVE, &look->roughness) ||
            !read_map(&look->diffuse_map, reading, &pbr, "baseColorTexture", true) ||
            !read_map(&look->roughness_map, reading, &pbr, "metallicRoughnessTexture", false))
            return false;
    }
    look->metallic = fminf(look->metallic, 1), look->roughness = fminf(look->roughness, 1), look->alpha = fminf(color[3], 1);
    for (int i = 0; i < 3; i++) look->diffuse[i] = look->ambient[i] = color[i];
    return true;
}

static bool read_normal(struct reading *reading, const struct json_at *at) {
    struct json_at info;
    return read_map(&reading->out->look.normal_map, reading, at, "normalTexture", false) &&
           (!at_member(&info, at, "normalTexture") || at_get_float(&info, "scale", RANGE_ANY, &reading->out->look.normal_scale));
}

static bool read_emission(struct reading *reading, const struct json_at *at) {
    struct scene_material *look = &reading->out->look;
    struct gltf_extension strength;
    float factor = 1;
    if (!at_get_float3(at, "emissiveFactor", RANGE_NOT_NEGATIVE, look->emission) ||
        !read_map(&look->emission_map, reading, at, "emissiveTexture", true) ||
        !gltf_get_extension(&strength, at, "KHR_materials_emissive_strength") ||
        (strength.found && !at_get_float(&strength.at, "emissiveStrength", RANGE_NOT_NEGATIVE, &factor)))
        return false;
    for (int i = 0; i < 3; i++) look->emission[i] = fminf(look->emission[i] * factor, 1e30f);
    return true;
}

static bool read_alpha(struct reading *reading, const struct json_at *at) {
    static const char *const modes[] = {[ALPHA_OPAQUE] = "OPAQUE", [ALPHA_MASK] = "MASK", [ALPHA_BLEND] = "BLEND", NULL};
    int mode = ALPHA_OPAQUE;
    struct scene_material *look = &reading->out->look;
    if (!at_get_choice(at, "alphaMode", modes, &mode) || !at_get_float(at, "alphaCutoff", RANGE_NOT_NEGATIVE, &look->alpha_cutoff))
        return false;
    look->alpha_mode = (enum alpha_mode)mode;
    return true;
}

// What is lost on the way: -ln(color) over the distance at which light has that color. A color of 0 takes all but one part in ten thousand.
static bool read_volume(struct scene_material *look, const struct json_at *at) {
    struct gltf_extension volume;
    float thickness = 0, color[3] = {1, 1, 1}, distance = INFINITY;
    if (!gltf_get_extension(&volume, at, "KHR_materials_volume")) return false;
    if (volume.found && (!at_get_float(&volume.at, "thicknessFactor", RANGE_NOT_NEGATIVE, &thickness) ||
                         !at_get_float3(&volume.at, "attenuationColor", RANGE_SHARE, color) ||
                         !at_get_float(&volume.at, "attenuationDistance", RANGE_POSITIVE, &distance)))
        return false;
    look->thin = thickness == 0;
    for (int i = 0; i < 3; i++) look->absorption[i] = fminf(fabsf(logf(fmaxf(color[i], 1e-4f))) / distance, 1e30f);
    return true;
}

// What lets at least half of the light through is glass of ours; less counts as nothing.
static bool read_transmission(struct scene_material *look, const struct json_at *at) {
    struct gltf_extension transmission, ior;
    float share = 0;
    if (!gltf_get_extension(&ior, at, "KHR_materials_ior") || (ior.found && !at_get_float(&ior.at, "ior", RANGE_NOT_NEGATIVE, &look->ior)))
        return false;
    if (look->ior < 1) look->ior = 1; // 0 stands for a mirror's, which no material of ours has
    if (!gltf_get_extension(&transmission, at, "KHR_materials_transmission") ||
        (transmission.found && !at_get_float(&transmission.at, "transmissionFactor", RANGE_SHARE, &share)))
        return false;
    if (share < 0.5f || look->metallic >= 0.5f) return true;
    look->model = MODEL_DIELECTRIC;
    for (int i = 0; i < 3; i++) look->ambient[i] = 0;
    return read_volume(look, at);
}

// What no light changes glows by itself.
static bool read_unlit(struct scene_material *look, const struct json_at *at) {
    struct gltf_extension unlit;
    if (!gltf_get_extension(&unlit, at, "KHR_materials_unlit") || !unlit.found) return !unlit.found;
    look->model = MODEL_LAMBERT;
    look->emission_map = look->diffuse_map;
    for (int i = 0; i < 3; i++) look->emission[i] = look->diffuse[i], look->diffuse[i] = look->ambient[i] = 0;
    return true;
}

static bool read_material(struct gltf_material *out, const struct gltf *gltf, const struct json_at *at) {
    struct reading reading = {.gltf = gltf, .out = out};
    const char *name = "";
    *out = (struct gltf_material){.look = material_default()};
    out->look.model = MODEL_METALLIC_ROUGHNESS;
    if (!at_get_text(at, "name", "a string", &name)) return false;
    if (*name)
        snprintf(out->name, sizeof out->name, "%s", name);
    else
        snprintf(out->name, sizeof out->name, "material %zu", at->index);
    return read_base(&reading, at) && read_normal(&reading, at) && read_emission(&reading, at) && read_alpha(&reading, at) &&
           read_transmission(&out->look, at) && read_unlit(&out->look, at);
}

bool gltf_read_materials(struct gltf_material **out, uint32_t *count, const struct gltf *gltf) {
    struct json_at list;
    *out = NULL;
    if (!gltf_list(&list, gltf, "materials", count)) return false;
    *out = array_alloc(gltf->ctx, *count, sizeof **out, "materials");
    for (uint32_t i = 0; *out && i < *count; i++) {
        const struct json_at at = at_item(&list, i);
        if (!read_material(&(*out)[i], gltf, &at)) return false;
    }
    return *out != NULL;
}
