// Lights of every kind in fp64: a sample of one, seen from a point, and how likely that was. What shaders/light.glsl does, in scene units.
#ifndef REFERENCE_LIGHTS_H
#define REFERENCE_LIGHTS_H

#include "reference/predicates.h"
#include "render/light_table.h"

// Zeroed is empty; ref_lights_finish accepts a half-made one.
struct ref_lights {
    const struct scene *scene;
    struct light_table table;
};

// What a light sends to p from one of its points, if nothing is in the way.
struct ref_light_sample {
    double way[3];            // from p to that point; unit and endless where `infinite`
    double radiance[3];       // with pdf 0 an intensity, which adds radiance·eval, eval being π·f·cos; else a radiance, which adds radiance·eval/(π·pdf)
    double pdf;               // of the way, per solid angle; 0: the light has no size, and nothing else finds it
    struct ref_target target; // what the way ends on, which is not in the way
    bool infinite;
};

// `effects`: EFFECT_* bits that run. The scene stays.
bool ref_lights_init(struct ref_lights *out, struct context *ctx, const struct scene *scene, uint32_t effects);
void ref_lights_finish(struct ref_lights *lights);

// A sample of a light for u and choice in [0, 1). False, with zeros in *out, where it sends nothing to p.
bool ref_light_sample(struct ref_light_sample *out, const struct ref_lights *lights, uint32_t light, const double p[3], const float u[2], float choice);

// The density with which a light samples, from p, the way to triangle `primitive` (or the sphere) of its shape, which that way meets.
double ref_light_pdf(const struct ref_lights *lights, uint32_t light, const double p[3], uint32_t primitive);

#endif
