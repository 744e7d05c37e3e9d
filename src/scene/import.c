// Model files: which reader takes which.
#include "scene/import.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/material.h"
#include "scene/mesh.h"

bool model_load(struct model *out, struct context *ctx, const char *path) {
    static const struct {
        const char *suffix;
        bool (*load)(struct model *, struct context *, const char *);
    } readers[] = {
        {"ply", model_load_ply}, {"obj", model_load_obj}, {"stl", model_load_stl}, {"gltf", model_load_gltf}, {"glb", model_load_gltf}};
    char suffix[16];
    path_suffix(path, suffix, sizeof suffix);
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
        if (strcmp(suffix, readers[i].suffix) == 0) return readers[i].load(out, ctx, path);
    return model_load_assimp(out, ctx, path);
}

void model_finish(struct model *model) {
    mesh_finish(&model->mesh);
    materials_free(model->materials, model->material_count);
    texture_sources_finish(model->textures, model->texture_count);
    free(model->cameras);
    free(model->lights);
    *model = (struct model){0};
}
