// Materials: defaults, and the table of a scene's or a model's while it grows.
#ifndef SCENE_MATERIAL_H
#define SCENE_MATERIAL_H

#include "scene/array.h"
#include "scene/scene.h"

// The name of the material of whatever has none.
#define DEFAULT_MATERIAL "default"

// Zeroed but for what array.h wants is empty: MATERIAL_TABLE.
struct material_table {
    struct array items;     // struct scene_material
    struct json_t *numbers; // jansson serves as the dictionary: from names to numbers
};
#define MATERIAL_TABLE                                                                                                                     \
    {                                                                                                                                      \
        .items = {.item_size = sizeof(struct scene_material), .what = "materials" }                                                        \
    }

// Whether there is a material of this name; *number is set if so.
bool material_find(const struct material_table *table, const char *name, uint32_t *number);

// A material without a name: diffuse and ambient 0.8, no highlight, shininess 32; opaque, without textures.
struct scene_material material_default(void);

// Adds a material with the default values. A name that is there already keeps
// leading to its first material. NULL when memory is missing.
struct scene_material *material_add(struct material_table *table, struct context *ctx, const char *name);

// The number of the material of this name, which is added if it is missing.
bool material_need(struct material_table *table, struct context *ctx, const char *name, uint32_t *number);

// Gives the materials away and leaves the table empty.
void material_table_take(struct material_table *table, struct scene_material **materials, uint32_t *count);
void material_table_finish(struct material_table *table);

void materials_free(struct scene_material *materials, uint32_t count);

#endif
