// Materials by number and by name.
#include "scene/material.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

bool material_find(const struct material_table *table, const char *name, uint32_t *number) {
    const json_t *found = json_object_get(table->numbers, name);
    if (found) *number = (uint32_t)json_integer_value(found);
    return found != NULL;
}

struct scene_material material_default(void) {
    static const struct scene_map none = {.texture = NO_TEXTURE, .transform = {1, 0, 0, 0, 1, 0}};
    return (struct scene_material){
        .ambient = {0.8f, 0.8f, 0.8f}, .diffuse = {0.8f, 0.8f, 0.8f}, .shininess = 32, .roughness = 1, .ior = 1.5f, .alpha = 1, .alpha_cutoff = 0.5f,
        .diffuse_map = none, .normal_map = none, .normal_scale = 1, .roughness_map = none, .emission_map = none,
    };
}

struct scene_material *material_add(struct material_table *table, struct context *ctx, const char *name) {
    if (!table->numbers) table->numbers = json_object();
    struct scene_material *material = array_push(&table->items, ctx);
    if (!material) return NULL;
    *material = material_default();
    material->name = strdup(name);
    const bool known = json_object_get(table->numbers, name) != NULL;
    // "nocheck": names in OBJ files need not be UTF-8.
    const json_int_t number = (json_int_t)table->items.count - 1;
    if (material->name && (known || json_object_set_new_nocheck(table->numbers, name, json_integer(number)) == 0)) return material;
    fail(ctx, GN_LIMIT, "no memory for a material");
    return NULL;
}

bool material_need(struct material_table *table, struct context *ctx, const char *name, uint32_t *number) {
    if (material_find(table, name, number)) return true;
    *number = (uint32_t)table->items.count;
    return material_add(table, ctx, name) != NULL;
}

void material_table_take(struct material_table *table, struct scene_material **materials, uint32_t *count) {
    *count = (uint32_t)table->items.count;
    *materials = array_take(&table->items);
    material_table_finish(table);
}

void material_table_finish(struct material_table *table) {
    materials_free(table->items.items, (uint32_t)table->items.count);
    json_decref(table->numbers);
    table->items.items = NULL;
    table->items.count = table->items.capacity = 0;
    table->numbers = NULL;
}

void materials_free(struct scene_material *materials, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) free(materials[i].name);
    free(materials);
}
