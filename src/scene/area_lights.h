// Shapes that send out light, as lights.
#ifndef SCENE_AREA_LIGHTS_H
#define SCENE_AREA_LIGHTS_H

#include "scene/scene.h"

// Appends to scene->lights one LIGHT_AREA for each shape that can be sampled as a light: it stands still, is no instance, and some of its surface has an area, is
// opaque and emits by itself, not by a texture. What emits otherwise glows, but nobody looks for it. Wants the derived fields.
bool scene_area_lights(struct scene *scene, struct context *ctx);

// The number of the light that shape `object` is, or NO_LIGHT_NUMBER.
#define NO_LIGHT_NUMBER UINT32_MAX
uint32_t scene_light_of(const struct scene *scene, uint32_t object);

// How much light triangle `primitive` of a shape gives to a light that is the shape: area × luminance, and 0 where it gives none.
double scene_triangle_power(const struct scene *scene, const struct scene_shape *shape, uint32_t primitive);

// The material of triangle `primitive` of a shape that is no instance, or of a sphere, whatever `primitive` is.
const struct scene_material *scene_material_of(const struct scene *scene, const struct scene_shape *shape, uint32_t primitive);

#endif
