#include "render/upload_instances.h"

#include <math.h>
#include <string.h>

#include "scene/instances.h"

// Beyond these no box of the part is missed, and none is left out: a placement that devices cannot turn around well enough.
#define LARGEST_INVERSE 0x1p60
#define LARGEST_SLACK 0x1p40
#define OPEN_SLACK 0x1p100f

static uint32_t float_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static struct word4 word4_of(double x, double y, double z, uint32_t last) {
    return (struct word4){{float_bits((float)x), float_bits((float)y), float_bits((float)z), last}};
}

struct part_frame part_frame_of(const struct scene_part *part) {
    struct part_frame frame = {.scale = 1};
    double half = 0;
    int exponent;
    for (int i = 0; i < 3; i++) {
        frame.center[i] = 0.5 * ((double)part->min[i] + part->max[i]);
        half = fmax(half, 0.5 * ((double)part->max[i] - part->min[i]));
    }
    frexp(half, &exponent); // half < 2^exponent
    if (half > 0) frame.scale = ldexp(1, -exponent);
    return frame;
}

// The placement as numbers, and what is derived from it; in the names of shaders/instance.glsl.
struct turned {
    double b[3][3], c[3], slack[3];
};

// What a vertex may be off by, in scene units: three products, three sums, product and sum of the motion, each 2^-24 of something that is at most the sum of all
// absolute values; and what underflow takes.
static double vertex_error(const struct scene_shape *shape, const struct scene_part *part, const float placement[12], int i) {
    double sum = fabs((double)placement[4 * i + 3]) + (shape->moves ? fabs((double)shape->motion[i]) : 0);
    for (int k = 0; k < 3; k++) sum += fabs((double)placement[4 * i + k]) * fmax(fabs((double)part->min[k]), fabs((double)part->max[k]));
    return sum * 0x1p-21 + 0x1p-140;
}

// False where boxes would be padded beyond use.
static bool turn(struct turned *out, const struct scene_shape *shape, const struct scene_part *part, const float placement[12], const float base[3], double scale) {
    const struct part_frame frame = part_frame_of(part);
    double inverse[9], error[3], largest = 0;
    if (!placement_inverse(inverse, placement)) return false;
    for (int i = 0; i < 3; i++) {
        double c = (double)placement[4 * i + 3] - base[i], size = fabs((double)placement[4 * i + 3]) + fabs((double)base[i]);
        for (int k = 0; k < 3; k++) {
            c += (double)placement[4 * i + k] * frame.center[k];
            size += fabs((double)placement[4 * i + k] * frame.center[k]);
        }
        out->c[i] = c * scale;
        error[i] = scale * (vertex_error(shape, part, placement, i) + size * 0x1p-48) + fabs(out->c[i]) * 0x1p-23;
    }
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        out->slack[i] = 0x1p-22; // boxes are rounded to the nearest
        for (int k = 0; k < 3; k++) {
            out->b[i][k] = inverse[3 * i + k] * (frame.scale / scale);
            sum += fabs(out->b[i][k]);
            out->slack[i] += fabs(out->b[i][k]) * error[k] * 1.001;
        }
        largest = fmax(largest, sum);
        if (!(out->slack[i] <= LARGEST_SLACK)) return false;
    }
    return largest >= 1 / LARGEST_INVERSE && largest <= LARGEST_INVERSE;
}

static void write_place(struct word4 *to, const struct scene_shape *shape, const float base[3], float scale) {
    const bool moves = shape->moves;
    to[INSTANCE_MOTION] = word4_of(moves ? shape->motion[0] : 0, moves ? shape->motion[1] : 0, moves ? shape->motion[2] : 0, 0);
    to[INSTANCE_BASE] = word4_of(base[0], base[1], base[2], float_bits(scale));
}

void write_instance(struct word4 to[INSTANCE_WORDS], const struct scene *scene, const struct scene_instance *instance, const float base[3], float scale,
                    uint32_t root, uint32_t offset) {
    static const float home[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const struct scene_shape *shape = &scene->shapes[instance->shape];
    const bool placed = shape->type == SHAPE_INSTANCE;
    const float *m = placed ? shape->placement : home;
    struct turned turned;
    if (!turn(&turned, shape, &scene->parts[instance->part], m, base, scale))
        turned = (struct turned){.b = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .slack = {OPEN_SLACK, OPEN_SLACK, OPEN_SLACK}};
    to[0] = word4_of(m[0], m[4], m[8], instance->shape);
    to[1] = word4_of(m[1], m[5], m[9], offset);
    const bool own = !scene->parts[instance->part].mesh->materials || (placed && shape->own_material);
    to[2] = word4_of(m[2], m[6], m[10], own ? shape->material : NO_MATERIAL);
    to[3] = word4_of(m[3], m[7], m[11], root);
    write_place(to, shape, base, scale);
    for (int i = 0; i < 3; i++)
        to[INSTANCE_INVERSE + i] = word4_of(turned.b[i][0], turned.b[i][1], turned.b[i][2], float_bits((float)(turned.slack[i] * 1.001)));
    to[INSTANCE_CENTER] = word4_of(turned.c[0], turned.c[1], turned.c[2], 0);
}

void write_moving_sphere(struct word4 to[INSTANCE_WORDS], const struct scene_shape *shape, const float base[3], float scale) {
    memset(to, 0, INSTANCE_WORDS * sizeof *to);
    to[3] = word4_of(shape->center[0], shape->center[1], shape->center[2], 0);
    write_place(to, shape, base, scale);
}
