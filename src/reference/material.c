#include "reference/material.h"

#include <string.h>

#include "reference/texture.h"
#include "shaders/shared.h"

static bool has(const struct ref_world *world, uint32_t effects) { return world->effects & effects; }

// What a map shows at the surface; `none` where there is no map.
static void map_at(double rgba[4], const struct ref_world *world, const struct scene_map *map, const struct surface *surface, const double none[4]) {
    for (int i = 0; i < 4; i++) rgba[i] = none[i];
    if (map->texture != NO_TEXTURE && map->texture <= world->scene->texture_count) {
        double uv[2];
        map_transform(uv, map, surface->uv);
        texture_at(rgba, &world->scene->textures[map->texture - 1], map->srgb, uv);
    }
}

static void apply_textures(struct ref_material *out, const struct ref_world *world, const struct scene_material *from, const struct surface *surface) {
    static const double white[4] = {1, 1, 1, 1};
    double color[4], rough[4], emission[4];
    map_at(color, world, &from->diffuse_map, surface, white);
    map_at(rough, world, &from->roughness_map, surface, white);
    map_at(emission, world, &from->emission_map, surface, white);
    for (int i = 0; i < 3; i++) {
        out->bsdf.diffuse[i] *= color[i];
        out->ambient[i] *= color[i];
        out->emission[i] *= emission[i];
    }
    out->bsdf.roughness *= rough[1];
    out->bsdf.metallic *= rough[2];
}

// A normal map is one of the front.
static void bend_normal(struct surface *surface, const struct ref_world *world, const struct scene_material *from) {
    static const double flat[4] = {0.5, 0.5, 1, 1};
    const struct scene_map *map = &from->normal_map;
    struct tangent_frame frame = {.duv1 = {1, 0}, .duv2 = {0, 1}};
    double texel[4], side = surface->front ? 1 : -1;
    if (map->texture == NO_TEXTURE || map->texture > world->scene->texture_count) return;
    memcpy(frame.e1, surface->du, sizeof frame.e1);
    memcpy(frame.e2, surface->dv, sizeof frame.e2);
    map_at(texel, world, map, surface, flat);
    for (int i = 0; i < 3; i++) surface->n[i] *= side;
    normal_map_apply(surface->n, &frame, texel, from->normal_scale);
    for (int i = 0; i < 3; i++) surface->n[i] *= side;
}

void ref_material_at(struct ref_material *out, const struct ref_world *world, struct surface *surface) {
    const struct scene_material *from = &world->scene->materials[surface->crossing.material];
    *out = (struct ref_material){
        .bsdf = ref_bsdf_make(from, world->effects), .number = surface->crossing.material, .priority = from->priority, .thin = from->thin};
    for (int i = 0; i < 3; i++) out->ambient[i] = from->ambient[i], out->emission[i] = from->emission[i], out->absorption[i] = from->absorption[i];
    if (has(world, EFFECT_TEXTURES)) apply_textures(out, world, from, surface);
    if (has(world, EFFECT_NORMAL_MAPS)) bend_normal(surface, world, from);
}

double ref_material_alpha(const struct ref_world *world, const struct surface *surface) {
    static const double white[4] = {1, 1, 1, 1};
    const struct scene_material *from = &world->scene->materials[surface->crossing.material];
    double color[4];
    if (from->alpha_mode == ALPHA_OPAQUE) return 1;
    map_at(color, world, &from->diffuse_map, surface, white);
    const double alpha = color[3] * from->alpha;
    return from->alpha_mode == ALPHA_BLEND ? alpha : alpha < from->alpha_cutoff ? 0 : 1;
}
