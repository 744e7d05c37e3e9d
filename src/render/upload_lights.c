#include "render/upload_lights.h"

#include <math.h>
#include <string.h>

#include "scene/area_lights.h"

#define DEGREE 0.017453292519943295

static uint32_t float_bits(double value) {
    float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    return bits;
}

static struct word4 word4_of(const float v[3], uint32_t last) { return (struct word4){{float_bits(v[0]), float_bits(v[1]), float_bits(v[2]), last}}; }

static struct word4 point_of(const struct light_frame *frame, const float v[3], uint32_t last) {
    float p[3];
    for (int i = 0; i < 3; i++) p[i] = (float)(((double)v[i] - frame->base[i]) * frame->scale);
    return word4_of(p, last);
}

// The unit vector along `sign` times v; zero for zero.
static struct word4 direction_of(const float v[3], double sign, uint32_t last) {
    double length = sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
    float unit[3];
    for (int i = 0; i < 3; i++) unit[i] = length > 0 ? (float)(sign * v[i] / length) : 0;
    return word4_of(unit, last);
}

// 1 - cos x, without loss for small x.
static double versine(double x) { return 2 * sin(0.5 * x) * sin(0.5 * x); }

// Where the cones are the same the light ends at once.
static void write_spot(struct word4 to[LIGHT_WORDS], const struct scene_light *light) {
    double outer = versine(light->outer_deg * DEGREE), slope = outer - versine(light->inner_deg * DEGREE);
    to[2] = direction_of(light->direction, 1, float_bits(outer));
    to[3].w[3] = float_bits(slope > 1e-30 ? 1 / slope : 1e30);
}

static const float *corner(const struct scene_shape *shape, uint32_t primitive, size_t k) {
    return shape->mesh.positions + 3 * (size_t)shape->mesh.indices[3 * (size_t)primitive + k];
}

static void write_shape(struct word4 to[LIGHT_WORDS], const struct light_frame *frame, uint32_t number) {
    const struct scene_light *light = &frame->scene->lights[number];
    const struct scene_shape *shape = &frame->scene->shapes[light->shape];
    const uint32_t kind = frame->table->kind[number], first = frame->table->first[number];
    to[0].w[3] = kind;
    to[1].w[3] = light->shape;
    if (kind == MESH_LIGHT) {
        to[2] = (struct word4){{first, frame->table->first[number + 1] - first, 0, 0}};
        return;
    }
    to[1] = word4_of(scene_material_of(frame->scene, shape, 0)->emission, light->shape);
    if (kind == SPHERE_LIGHT) {
        to[0] = point_of(frame, shape->center, kind);
        to[2].w[0] = float_bits(shape->radius * frame->scale);
        return;
    }
    const float *const positions = shape->mesh.positions;
    to[0] = point_of(frame, kind == TRIANGLE_LIGHT ? corner(shape, 0, 0) : positions, kind);
    to[2] = point_of(frame, kind == TRIANGLE_LIGHT ? corner(shape, 0, 1) : positions + 3, 0);
    to[3] = point_of(frame, kind == TRIANGLE_LIGHT ? corner(shape, 0, 2) : positions + 6, 0);
}

void write_light(struct word4 to[LIGHT_WORDS], const struct light_frame *frame, uint32_t number) {
    const struct scene_light *light = &frame->scene->lights[number];
    const uint32_t kind = frame->table->kind[number];
    memset(to, 0, LIGHT_WORDS * sizeof *to);
    if (kind == ABSENT_LIGHT) return;
    if (light->type == LIGHT_AREA) {
        write_shape(to, frame, number);
        return;
    }
    to[0] = point_of(frame, light->position, kind);
    to[1] = word4_of(light->intensity, float_bits(light->falloff == FALLOFF_INVERSE_SQUARE && kind != DIRECTIONAL_LIGHT));
    if (kind == SPOT_LIGHT) write_spot(to, light);
    if (kind == DIRECTIONAL_LIGHT) to[2] = direction_of(light->direction, -1, 0);
}

void write_emitter(struct word4 to[EMITTER_WORDS], const struct light_frame *frame, uint32_t number) {
    const struct emitter *emitter = &frame->table->emitters[number];
    const struct scene_shape *shape = &frame->scene->shapes[emitter->object];
    to[0] = point_of(frame, corner(shape, emitter->primitive, 0), float_bits(emitter->cdf));
    to[1] = point_of(frame, corner(shape, emitter->primitive, 1), emitter->object);
    to[2] = point_of(frame, corner(shape, emitter->primitive, 2), emitter->primitive);
    to[3] = word4_of(scene_material_of(frame->scene, shape, emitter->primitive)->emission, float_bits(emitter->probability));
}
