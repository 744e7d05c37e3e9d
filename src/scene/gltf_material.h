// Materials of a glTF document, with their textures.
#ifndef SCENE_GLTF_MATERIAL_H
#define SCENE_GLTF_MATERIAL_H

#include "scene/gltf_document.h"
#include "scene/texture.h"

// A material as the file has it; the maps number the file's list of textures, from 1.
struct gltf_material {
    struct scene_material look; // without a name
    char name[256];             // the file's, or one that says its number
    uint32_t uv_set;            // which of the vertices' texture coordinates its maps use
};

// Reads all materials: *out to be freed, *count of them.
bool gltf_read_materials(struct gltf_material **out, uint32_t *count, const struct gltf *gltf);

// Where a texture of the file comes from; source->name stays NULL where it has no picture that we know.
bool gltf_texture_source(struct texture_source *out, const struct gltf *gltf, uint32_t number, bool srgb);

#endif
