// The pictures of a scene: textures by what they come from, each loaded once, and the environment.
#ifndef SCENE_TEXTURE_H
#define SCENE_TEXTURE_H

#include "base/file.h"
#include "scene/array.h"
#include "scene/scene.h"

// Where a texture comes from and how it is looked up. Zeroed but for a name is a file, repeated, interpolated, of linear values.
struct texture_source {
    char *name;              // the path of a file, or what to call the picture that is embedded in one
    struct file_bytes bytes; // of an embedded picture; else empty
    char *alpha_name;        // the path of a file that has the alpha, or is it where it has none; or NULL
    bool srgb;               // a file of linear values becomes sRGB codes
    enum texture_wrap wrap_u, wrap_v;
    bool nearest;
};
void texture_source_finish(struct texture_source *source);

// Adds a source to a list of them (struct texture_source), unless an equal one is there, and gives the number for a scene_map, 1 + its
// index. Takes *source over in any case.
bool texture_source_add(struct array *sources, struct context *ctx, struct texture_source *source, uint32_t *number);
void texture_sources_finish(struct texture_source *sources, uint32_t count);

// The textures of a scene while it grows. Zeroed but for what array.h wants is empty: TEXTURE_TABLE.
struct texture_table {
    struct array textures; // struct scene_texture
    struct array sources;  // struct texture_source of each, without the bytes
};
#define TEXTURE_TABLE                                                                                                                      \
    {                                                                                                                                      \
        .textures = {.item_size = sizeof(struct scene_texture), .what = "textures"}, .sources = {                                          \
            .item_size = sizeof(struct texture_source),                                                                                    \
            .what = "textures"                                                                                                             \
        }                                                                                                                                  \
    }

// The number for a scene_map of the texture from this source, which is loaded if it is not yet there. Keeps a copy of *source.
// GN_SCENE with the picture's name when it cannot be used.
bool texture_need(struct texture_table *table, struct context *ctx, const struct texture_source *source, uint32_t *number);

// Gives the textures away and leaves the table empty.
void texture_table_take(struct texture_table *table, struct scene_texture **textures, uint32_t *count);

// Loads the picture of an environment; the rest of *out stays as it is. What is negative or NaN counts as 0, what is infinite as the
// largest finite value; a warning says how much of it there was. GN_SCENE.
bool environment_load(struct scene_environment *out, struct context *ctx, const char *path);

#endif
