// Material libraries of OBJ files: colors, highlight, emission, transparency, and textures of these.
#ifndef SCENE_MTL_H
#define SCENE_MTL_H

#include "scene/material.h"
#include "scene/texture.h"

// Reads a library and fills those materials of the table that it names; defined[number] becomes true for them. Ka defaults to Kd. Maps
// number `textures` (struct texture_source); those whose file is missing are left out with a warning.
bool mtl_load(struct material_table *table, bool *defined, struct array *textures, struct context *ctx, const char *path);

#endif
