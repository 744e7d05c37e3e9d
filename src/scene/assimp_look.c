// Materials, cameras and lights of an Assimp scene.
#include "scene/assimp_look.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <assimp/material.h>

#include "scene/frame.h"

static const double PI = 3.14159265358979323846;

// ---------------------------------------------------------------------------------------------------------------- materials

void look_material_name(const struct aiMaterial *material, char *name, size_t capacity) {
    struct aiString string;
    name[0] = '\0';
    if (aiGetMaterialString(material, AI_MATKEY_NAME, &string) != AI_SUCCESS) return;
    if (strcmp(string.data, AI_DEFAULT_MATERIAL_NAME) != 0) snprintf(name, capacity, "%s", string.data);
}

// A value between 0 and `most`; NaN becomes 0.
static float limit(float value, float most) { return value > 0 ? fminf(value, most) : 0; }

static bool get_number(const struct aiMaterial *material, const char *key, float *out) {
    ai_real value;
    unsigned count = 1;
    if (aiGetMaterialFloatArray(material, key, 0, 0, &value, &count) != AI_SUCCESS || count != 1) return false;
    *out = limit((float)value, FLT_MAX);
    return true;
}

static bool get_color(const struct aiMaterial *material, const char *key, float out[3]) {
    struct aiColor4D color;
    if (aiGetMaterialColor(material, key, 0, 0, &color) != AI_SUCCESS) return false;
    out[0] = limit(color.r, FLT_MAX), out[1] = limit(color.g, FLT_MAX), out[2] = limit(color.b, FLT_MAX);
    return true;
}

// Metal and roughness as Phong terms. With a = roughness², Blinn-Phong's exponent that resembles a microfacet lobe of width a is 2/a² - 2
// (B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, 5.2); Phong's is a quarter of it. The peak grows with
// it as the normalised lobe's does, up to 1. Reflectance at normal incidence is 0.04, or the base color for metals. We have no surroundings
// for a metal to reflect: the rougher it is, the more it is drawn as a diffuse surface of its color instead.
static void look_metal(struct scene_material *out, const float base[3], float metallic, float roughness) {
    const float a = fmaxf(roughness * roughness, 0.02f), exponent = 2 / (a * a) - 2;
    const float metal = metallic * (1 - a), peak = (1 - a) * (exponent + 8) / 8;
    out->shininess = fmaxf(exponent / 4, 1);
    for (int i = 0; i < 3; i++) {
        out->diffuse[i] = base[i] * (1 - metal);
        out->specular[i] = fminf(peak * (0.04f + (base[i] - 0.04f) * metallic), 1);
    }
}

void look_material(struct scene_material *out, const struct aiMaterial *material) {
    float base[3], metallic = 0, roughness = 1, strength = 1;
    const bool rough = get_number(material, "$mat.roughnessFactor", &roughness);
    const bool metal = get_number(material, "$mat.metallicFactor", &metallic);
    const bool based = get_color(material, "$clr.base", base);
    if ((rough || metal) && based) {
        look_metal(out, base, fminf(metallic, 1), fminf(roughness, 1));
    } else {
        get_color(material, "$clr.diffuse", out->diffuse);
        get_color(material, "$clr.specular", out->specular);
        get_number(material, "$mat.shininess", &out->shininess);
        get_number(material, "$mat.shinpercent", &strength);
        // Without an exponent to speak of a highlight is none.
        for (int i = 0; i < 3; i++) out->specular[i] = out->shininess > 1 ? limit(out->specular[i] * strength, FLT_MAX) : 0;
    }
    memcpy(out->ambient, out->diffuse, sizeof out->ambient);
}

// ------------------------------------------------------------------------------------------------------- cameras and lights

static void transform_vector(double out[3], const struct transform *t, struct aiVector3D v, double w) {
    for (int i = 0; i < 3; i++) out[i] = t->m[i][0] * v.x + t->m[i][1] * v.y + t->m[i][2] * v.z + t->m[i][3] * w;
}

static bool store(float to[3], const double from[3]) {
    for (int i = 0; i < 3; i++) {
        if (!(fabs(from[i]) <= FLT_MAX)) return false;
        to[i] = (float)from[i];
    }
    return true;
}

bool look_camera(struct scene_camera *out, const struct aiCamera *camera, const struct transform *node) {
    double position[3], view[3], up[3];
    transform_vector(position, node, camera->mPosition, 1);
    transform_vector(view, node, camera->mLookAt, 0);
    transform_vector(up, node, camera->mUp, 0);
    const double aspect = camera->mAspect > 0 ? camera->mAspect : 1;
    return frame_view(out, position, view, up, 2 * atan(tan(0.5 * camera->mHorizontalFOV) / aspect) * (180 / PI));
}

bool look_light(struct scene_light *out, const struct aiLight *light, const struct transform *node) {
    double position[3], intensity[3] = {light->mColorDiffuse.r, light->mColorDiffuse.g, light->mColorDiffuse.b};
    if (light->mType != aiLightSource_POINT) return false;
    transform_vector(position, node, light->mPosition, 1);
    *out = (struct scene_light){.type = LIGHT_POINT};
    out->falloff = light->mAttenuationQuadratic > 0 ? FALLOFF_INVERSE_SQUARE : FALLOFF_NONE;
    const double attenuation = out->falloff == FALLOFF_NONE ? light->mAttenuationConstant : light->mAttenuationQuadratic;
    for (int i = 0; i < 3; i++) intensity[i] = fmax(0, attenuation > 0 ? intensity[i] / attenuation : intensity[i]);
    return store(out->position, position) && store(out->intensity, intensity);
}
