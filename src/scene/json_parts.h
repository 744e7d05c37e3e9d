// The parts of a scene file (scene_json.c), by what they describe. Each function reads one member of the document, or leaves the defaults
// where the member is missing.
#ifndef SCENE_JSON_PARTS_H
#define SCENE_JSON_PARTS_H

#include "scene/build.h"
#include "scene/json_read.h"

// json_view.c. *found: whether there is a camera.
bool part_camera(struct scene_camera *out, const struct json_at *root, bool *found);
bool part_film(struct scene_film *out, const struct json_at *root);
bool part_paths(struct scene_paths *out, const struct json_at *root);

// json_material.c
bool part_materials(struct scene_build *build, const struct json_at *root);

// json_light.c
bool part_lights(struct scene_build *build, const struct json_at *root);
bool part_environment(struct scene_build *build, const struct json_at *root);
bool part_fog(struct scene_fog *out, const struct json_at *root);

// json_shape.c
bool part_shapes(struct scene_build *build, const struct json_at *root);

#endif
