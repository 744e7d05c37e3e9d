// The steps of making a scene that its two sources, a scene file and a model file, share.
#ifndef SCENE_BUILD_H
#define SCENE_BUILD_H

#include "scene/import.h"
#include "scene/material.h"
#include "scene/texture.h"

// A scene under construction: what is not yet in plain arrays.
struct scene_build {
    struct scene *scene;
    struct context *ctx;
    struct material_table materials;
    struct texture_table textures;
};

// The two sources. Each fills all of the scene but the derived fields; on failure it is half made.
bool scene_load_json(struct scene_build *build, const char *path);
bool scene_load_model(struct scene_build *build, const char *path);

// Moves a model's mesh into a shape, with the model's materials if it has any and `material` is NULL; else with *material, or with the
// default.
bool shape_take_model(struct scene_shape *shape, struct scene_build *build, struct model *model, const uint32_t *material);

// Fills first_triangle, first_sphere and the bounds. GN_LIMIT when there are too many primitives.
bool scene_derive(struct scene *scene, struct context *ctx);

// Why a path is no readable regular file, or NULL if it is.
const char *path_unreadable(const char *path);

#endif
