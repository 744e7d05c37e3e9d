// Meshes from files: our own readers for PLY, OBJ, STL and glTF, whose numbers must become the nearest fp32 and whose faces must keep the
// file's order; Assimp for the rest.
//
// A polygon becomes a fan around its first vertex, in order, so that `primitive` counts triangles in file order. Bad content
// is GN_SCENE with file, line (or byte offset for binary files) and what was expected.
#ifndef SCENE_IMPORT_H
#define SCENE_IMPORT_H

#include "scene/texture.h"

// What a model file holds. Zeroed is empty; model_finish accepts a half-made one.
struct model {
    struct scene_mesh mesh; // one mesh of all faces, world space of the file; mesh.materials indexes `materials`, NULL: all have the first
    struct scene_material *materials; // their maps number `textures`
    uint32_t material_count;
    struct texture_source *textures; // not yet loaded
    uint32_t texture_count;
    struct scene_camera *cameras; // as far as the file has them
    uint32_t camera_count;
    struct scene_light *lights; // with the intensities of glTF in ours, of others in the file's unit
    uint32_t light_count;
};

bool model_load(struct model *out, struct context *ctx, const char *path);
void model_finish(struct model *model);

// One reader each; model_load chooses by suffix.
bool model_load_ply(struct model *out, struct context *ctx, const char *path);
bool model_load_obj(struct model *out, struct context *ctx, const char *path);
bool model_load_stl(struct model *out, struct context *ctx, const char *path);
bool model_load_gltf(struct model *out, struct context *ctx, const char *path);
bool model_load_assimp(struct model *out, struct context *ctx, const char *path);

#endif
