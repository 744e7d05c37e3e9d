#include "scene/area_lights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct scene_material *scene_material_of(const struct scene *scene, const struct scene_shape *shape, uint32_t primitive) {
    return &scene->materials[shape->mesh.materials ? shape->mesh.materials[primitive] : shape->material];
}

static double luminance(const float rgb[3]) { return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2]; }

// What a material sends out from every point that it covers: a texture makes that, and where there is a surface at all, differ from point to point.
static double even_emission(const struct scene_material *material) {
    return material->emission_map.texture == NO_TEXTURE && material->alpha_mode == ALPHA_OPAQUE ? luminance(material->emission) : 0;
}

static const float *corner(const struct scene_mesh *mesh, uint32_t primitive, size_t k) {
    return mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)primitive + k];
}

static double triangle_area(const struct scene_mesh *mesh, uint32_t primitive) {
    const float *v[3] = {corner(mesh, primitive, 0), corner(mesh, primitive, 1), corner(mesh, primitive, 2)};
    double square = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double normal = ((double)v[1][j] - v[0][j]) * ((double)v[2][k] - v[0][k]) - ((double)v[1][k] - v[0][k]) * ((double)v[2][j] - v[0][j]);
        square += normal * normal;
    }
    return 0.5 * sqrt(square);
}

double scene_triangle_power(const struct scene *scene, const struct scene_shape *shape, uint32_t primitive) {
    const double emission = even_emission(scene_material_of(scene, shape, primitive));
    return emission > 0 ? emission * triangle_area(&shape->mesh, primitive) : 0;
}

static void note_emission(struct scene_light *light, const struct scene_material *material) {
    for (int i = 0; i < 3; i++) light->intensity[i] = fmaxf(light->intensity[i], material->emission[i]);
}

// The light that a mesh is; false if it is none.
static bool mesh_light(struct scene_light *out, const struct scene *scene, const struct scene_shape *shape) {
    bool shines = false;
    for (uint32_t i = 0; i < shape->mesh.triangle_count; i++) {
        if (!(scene_triangle_power(scene, shape, i) > 0)) continue;
        for (int k = 0; k < 3 && !shines; k++) {
            const double sum = (double)corner(&shape->mesh, i, 0)[k] + corner(&shape->mesh, i, 1)[k] + corner(&shape->mesh, i, 2)[k];
            out->position[k] = (float)(sum / 3);
        }
        note_emission(out, scene_material_of(scene, shape, i));
        shines = true;
    }
    return shines;
}

static bool shape_light(struct scene_light *out, const struct scene *scene, uint32_t object) {
    const struct scene_shape *shape = &scene->shapes[object];
    *out = (struct scene_light){.type = LIGHT_AREA, .shape = object};
    if (shape->moves || shape->type == SHAPE_INSTANCE) return false;
    if (shape->type != SHAPE_SPHERE) return mesh_light(out, scene, shape);
    memcpy(out->position, shape->center, sizeof out->position);
    note_emission(out, scene_material_of(scene, shape, 0));
    return even_emission(scene_material_of(scene, shape, 0)) > 0;
}

bool scene_area_lights(struct scene *scene, struct context *ctx) {
    struct scene_light light;
    uint32_t added = 0;
    for (uint32_t i = 0; i < scene->shape_count; i++) added += shape_light(&light, scene, i);
    if (added == 0) return true;
    if (added > UINT32_MAX - scene->light_count) return fail(ctx, GN_LIMIT, "%s: the scene has too many lights", scene->path);
    struct scene_light *lights = array_alloc(ctx, (size_t)scene->light_count + added, sizeof *lights, "lights");
    if (!lights) return false;
    if (scene->light_count) memcpy(lights, scene->lights, scene->light_count * sizeof *lights);
    free(scene->lights);
    scene->lights = lights;
    for (uint32_t i = 0; i < scene->shape_count; i++)
        if (shape_light(&light, scene, i)) scene->lights[scene->light_count++] = light;
    return true;
}

// Area lights are the last ones, in the order of their shapes.
uint32_t scene_light_of(const struct scene *scene, uint32_t object) {
    uint32_t low = 0, high = scene->light_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->lights[middle].type == LIGHT_AREA && scene->lights[middle].shape >= object) high = middle;
        else low = middle + 1;
    }
    return low < scene->light_count && scene->lights[low].shape == object ? low : NO_LIGHT_NUMBER;
}
