// What a scene file says of a picture: the maps of a material, the environment.
#ifndef SCENE_JSON_MAP_H
#define SCENE_JSON_MAP_H

#include "scene/json_parts.h"

// How a map's texels are meant.
enum map_kind { MAP_COLOR, MAP_NORMAL, MAP_DATA };

// Reads member `key` of a material, if it is there: "brick.png", or an object. `scale`: of MAP_NORMAL; else NULL.
bool map_read(struct scene_map *out, float *scale, struct scene_build *build, const struct json_at *material, const char *key,
              enum map_kind kind);

// The path that member "file" of `at` names, or the string that `at` is; to be freed. A fault when it cannot be read. *named: the string.
char *map_path(struct json_at *named, const struct json_at *at, const struct scene_build *build, const char *expected);

#endif
