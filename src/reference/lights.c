#include "reference/lights.h"

#include <math.h>
#include <string.h>

#include "reference/light_shapes.h"
#include "scene/area_lights.h"
#include "shaders/shared.h"

#define DEGREE 0.017453292519943295

bool ref_lights_init(struct ref_lights *out, struct context *ctx, const struct scene *scene, uint32_t effects) {
    *out = (struct ref_lights){.scene = scene};
    return light_table_init(&out->table, ctx, scene, effects);
}

void ref_lights_finish(struct ref_lights *lights) {
    light_table_finish(&lights->table);
    *lights = (struct ref_lights){0};
}

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// ------------------------------------------------------------------------------------------------------ without a size

// The cosine between a spot's axis and the way from it, from the two as unit vectors.
static double spot_cosine(const struct scene_light *light, const double way[3]) {
    const double axis[3] = {light->direction[0], light->direction[1], light->direction[2]}, size = length(axis) * length(way);
    return size > 0 ? -(axis[0] * way[0] + axis[1] * way[1] + axis[2] * way[2]) / size : 0;
}

// KHR_lights_punctual's cone: the square of how far the cosine has come from that of the outer cone to that of the inner one.
static double spot_share(const struct scene_light *light, const double way[3]) {
    const double outer = cos(light->outer_deg * DEGREE), inner = cos(light->inner_deg * DEGREE), cosine = spot_cosine(light, way);
    if (!(inner > outer)) return cosine > outer ? 1 : 0;
    const double share = fmin(1, fmax(0, (cosine - outer) / (inner - outer)));
    return share * share;
}

static void sample_point(struct ref_light_sample *out, const struct scene_light *light, const double p[3]) {
    for (int i = 0; i < 3; i++) out->way[i] = light->position[i] - p[i];
    const double distance = length(out->way);
    if (!(distance > 0)) return;
    double share = light->type == LIGHT_SPOT ? spot_share(light, out->way) : 1;
    if (light->falloff == FALLOFF_INVERSE_SQUARE) share /= distance * distance;
    for (int i = 0; i < 3; i++) out->radiance[i] = light->intensity[i] * share;
}

static void sample_direction(struct ref_light_sample *out, const struct scene_light *light) {
    const double direction[3] = {light->direction[0], light->direction[1], light->direction[2]}, by = length(direction);
    out->infinite = true;
    for (int i = 0; i < 3 && by > 0; i++) {
        out->way[i] = -direction[i] / by;
        out->radiance[i] = light->intensity[i];
    }
}

// --------------------------------------------------------------------------------------------------------- with a size

static void widen(double out[3], const float v[3]) {
    for (int i = 0; i < 3; i++) out[i] = v[i];
}

// Three corners, of a triangle or of a rectangle.
static void corners(double out[3][3], const struct scene_shape *shape, uint32_t kind, uint32_t primitive) {
    for (size_t k = 0; k < 3; k++) {
        const size_t vertex = kind == RECTANGLE_LIGHT ? k : shape->mesh.indices[3 * (size_t)primitive + k];
        widen(out[k], shape->mesh.positions + 3 * vertex);
    }
}

static bool sample_shape(struct ref_light_sample *out, const struct scene_shape *shape, uint32_t kind, const double p[3], const float u[2], uint32_t primitive) {
    double center[3], v[3][3];
    if (kind == SPHERE_LIGHT) {
        widen(center, shape->center);
        return ref_sphere_light_sample(out->way, &out->pdf, p, center, shape->radius, u);
    }
    corners(v, shape, kind, primitive);
    const double(*const at)[3] = (const double(*)[3])v;
    return kind == RECTANGLE_LIGHT ? ref_rectangle_light_sample(out->way, &out->pdf, p, at, u) : ref_triangle_light_sample(out->way, &out->pdf, p, at, u);
}

static void sample_area(struct ref_light_sample *out, const struct ref_lights *lights, uint32_t light, const double p[3], const float u[2], float choice) {
    const uint32_t kind = lights->table.kind[light], object = lights->scene->lights[light].shape;
    const struct scene_shape *shape = &lights->scene->shapes[object];
    const struct emitter *emitter = kind == MESH_LIGHT ? emitter_chosen(&lights->table, light, choice) : NULL;
    const uint32_t primitive = emitter ? emitter->primitive : 0;
    if (!sample_shape(out, shape, kind, p, u, primitive)) return;
    if (emitter) out->pdf *= (double)emitter->probability;
    widen(out->radiance, scene_material_of(lights->scene, shape, primitive)->emission);
    out->target = (struct ref_target){.there = true, .object = object, .index = emitter ? (int32_t)primitive : -1};
}

bool ref_light_sample(struct ref_light_sample *out, const struct ref_lights *lights, uint32_t light, const double p[3], const float u[2], float choice) {
    const struct scene_light *from = &lights->scene->lights[light];
    const uint32_t kind = lights->table.kind[light];
    *out = (struct ref_light_sample){0};
    if (kind == DIRECTIONAL_LIGHT) sample_direction(out, from);
    else if (kind == POINT_LIGHT || kind == SPOT_LIGHT) sample_point(out, from, p);
    else if (kind != ABSENT_LIGHT) sample_area(out, lights, light, p, u, choice);
    if (out->radiance[0] > 0 || out->radiance[1] > 0 || out->radiance[2] > 0) return true;
    *out = (struct ref_light_sample){0};
    return false;
}

double ref_light_pdf(const struct ref_lights *lights, uint32_t light, const double p[3], uint32_t primitive) {
    const uint32_t kind = lights->table.kind[light];
    if (kind < SPHERE_LIGHT) return 0;
    const struct scene_shape *shape = &lights->scene->shapes[lights->scene->lights[light].shape];
    double center[3], v[3][3];
    if (kind == SPHERE_LIGHT) {
        widen(center, shape->center);
        return ref_sphere_light_pdf(p, center, shape->radius);
    }
    const struct emitter *emitter = kind == MESH_LIGHT ? emitter_of(&lights->table, light, primitive) : NULL;
    if (kind == MESH_LIGHT && !emitter) return 0;
    corners(v, shape, kind, emitter ? primitive : 0);
    const double(*const at)[3] = (const double(*)[3])v;
    if (kind == RECTANGLE_LIGHT) return ref_rectangle_light_pdf(p, at);
    return ref_triangle_light_pdf(p, at) * (emitter ? (double)emitter->probability : 1);
}
