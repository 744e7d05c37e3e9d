// Material libraries of OBJ files: Ka, Kd, Ks and Ns; textures and everything else are ignored.
#ifndef SCENE_MTL_H
#define SCENE_MTL_H

#include "scene/material.h"

// Reads a library and fills those materials of the table that it names; defined[number] becomes true for them. Ka defaults to Kd.
bool mtl_load(struct material_table *table, bool *defined, struct context *ctx, const char *path);

#endif
