#include "render/light_table.h"

#include <math.h>
#include <stdlib.h>

#include "scene/area_lights.h"
#include "shaders/shared.h"

#define STEPS (1u << 24) // of a random number

static uint32_t shape_kind(const struct scene_shape *shape, uint32_t effects) {
    if (!(effects & (shape->type == SHAPE_SPHERE ? EFFECT_SPHERES : EFFECT_TRIANGLES)) || !(effects & EFFECT_SOFT_SHADOWS)) return ABSENT_LIGHT;
    if (shape->type == SHAPE_SPHERE) return SPHERE_LIGHT;
    if (shape->type == SHAPE_MESH || shape->mesh.materials) return MESH_LIGHT;
    return shape->type == SHAPE_TRIANGLE ? TRIANGLE_LIGHT : RECTANGLE_LIGHT;
}

static uint32_t kind_of(const struct scene *scene, const struct scene_light *light, uint32_t effects) {
    switch (light->type) {
    case LIGHT_POINT: return POINT_LIGHT;
    case LIGHT_DIRECTIONAL: return effects & EFFECT_DIRECTIONAL ? DIRECTIONAL_LIGHT : ABSENT_LIGHT;
    case LIGHT_SPOT: return effects & EFFECT_SPOT ? SPOT_LIGHT : ABSENT_LIGHT;
    case LIGHT_AREA: return shape_kind(&scene->shapes[light->shape], effects);
    }
    return ABSENT_LIGHT;
}

// Triangles that emit, and their power.
static uint32_t count_emitters(double *total, const struct scene *scene, const struct scene_shape *shape) {
    uint32_t count = 0;
    *total = 0;
    for (uint32_t i = 0; i < shape->mesh.triangle_count; i++) {
        const double power = scene_triangle_power(scene, shape, i);
        *total += power;
        count += power > 0;
    }
    return count;
}

// Each emitter has one step to itself; the others are shared out by power.
static void list_emitters(struct emitter *out, const struct scene *scene, uint32_t object, uint32_t count, double total) {
    const struct scene_shape *shape = &scene->shapes[object];
    double sum = 0;
    uint32_t n = 0, before = 0;
    for (uint32_t i = 0; n < count; i++) {
        const double power = scene_triangle_power(scene, shape, i);
        if (!(power > 0)) continue;
        sum += power;
        n++;
        const uint32_t steps = n == count ? STEPS : n + (uint32_t)((STEPS - count) * fmin(1, sum / total));
        *out++ = (struct emitter){object, i, (float)steps * 0x1p-24f, (float)(steps - before) * 0x1p-24f};
        before = steps;
    }
}

static bool fill_firsts(struct light_table *out, struct context *ctx, const struct scene *scene) {
    for (uint32_t i = 0; i < scene->light_count; i++) {
        double total;
        uint32_t count = out->kind[i] == MESH_LIGHT ? count_emitters(&total, scene, &scene->shapes[scene->lights[i].shape]) : 0;
        if (count > STEPS)
            return fail(ctx, GN_LIMIT, "%s: shape %u has %u triangles that emit, at most %u can be a light", scene->path, scene->lights[i].shape, count, STEPS);
        out->first[i + 1] = out->first[i] + count;
    }
    return true;
}

bool light_table_init(struct light_table *out, struct context *ctx, const struct scene *scene, uint32_t effects) {
    *out = (struct light_table){0};
    out->kind = array_alloc(ctx, scene->light_count, sizeof *out->kind, "lights");
    out->first = array_alloc(ctx, (size_t)scene->light_count + 1, sizeof *out->first, "lights");
    if (!out->kind || !out->first) goto fail;
    for (uint32_t i = 0; i < scene->light_count; i++) out->kind[i] = kind_of(scene, &scene->lights[i], effects);
    if (!fill_firsts(out, ctx, scene)) goto fail;
    out->emitters = array_alloc(ctx, out->first[scene->light_count], sizeof *out->emitters, "triangles that emit");
    if (!out->emitters) goto fail;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        if (out->kind[i] != MESH_LIGHT) continue;
        const uint32_t object = scene->lights[i].shape;
        double total;
        const uint32_t count = count_emitters(&total, scene, &scene->shapes[object]);
        list_emitters(out->emitters + out->first[i], scene, object, count, total);
    }
    return true;
fail:
    light_table_finish(out);
    return false;
}

void light_table_finish(struct light_table *table) {
    free(table->kind);
    free(table->first);
    free(table->emitters);
    *table = (struct light_table){0};
}

const struct emitter *emitter_chosen(const struct light_table *table, uint32_t light, float x) {
    uint32_t low = table->first[light], high = table->first[light + 1] - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (x < table->emitters[middle].cdf) high = middle;
        else low = middle + 1;
    }
    return &table->emitters[low];
}

const struct emitter *emitter_of(const struct light_table *table, uint32_t light, uint32_t primitive) {
    uint32_t low = table->first[light], high = table->first[light + 1];
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (table->emitters[middle].primitive >= primitive) high = middle;
        else low = middle + 1;
    }
    return low < table->first[light + 1] && table->emitters[low].primitive == primitive ? &table->emitters[low] : NULL;
}
