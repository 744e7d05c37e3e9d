// What the lights of a scene are, and what those that are meshes are made of: found once, read by the device's arrays and by the reference alike, so that both
// choose the same triangle for the same random number.
#ifndef RENDER_LIGHT_TABLE_H
#define RENDER_LIGHT_TABLE_H

#include "scene/scene.h"

// A triangle that emits. A number x in [0, 1) of 24 bits chooses the first emitter of its light with x < cdf, which has exactly the given probability: all are multiples
// of 2^-24, none is 0, and they are nearly as area × luminance is.
struct emitter {
    uint32_t object, primitive;
    float cdf, probability;
};

// Zeroed is empty; light_table_finish accepts a half-made one.
struct light_table {
    uint32_t *kind;          // by light: POINT_LIGHT and so on, of shared.h
    uint32_t *first;         // by light, and one more: emitters of the lights before it
    struct emitter *emitters; // of a light, in the order of its shape's triangles
};

// `effects`: EFFECT_* bits that run; what they lack makes an ABSENT_LIGHT. GN_LIMIT when a mesh has more than 2^24 triangles that emit.
bool light_table_init(struct light_table *out, struct context *ctx, const struct scene *scene, uint32_t effects);
void light_table_finish(struct light_table *table);

// The emitter of a light that number x chooses; the one that is triangle `primitive`, or NULL.
const struct emitter *emitter_chosen(const struct light_table *table, uint32_t light, float x);
const struct emitter *emitter_of(const struct light_table *table, uint32_t light, uint32_t primitive);

#endif
