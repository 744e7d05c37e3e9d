// The scene file, format version 1: the document. Its parts are in json_view.c, json_material.c, json_map.c, json_light.c and json_shape.c.
#include "scene/frame.h"
#include "scene/json_parts.h"

static bool read_version(const struct json_at *root) {
    struct json_at version;
    if (!at_require(root, "version", "\"version\": 1") || !at_member(&version, root, "version")) return false;
    return (json_is_number(version.value) && json_number_value(version.value) == 1) ||
           at_expected(&version, "1, the only version there is");
}

static bool read_scene(struct scene_build *build, const struct json_at *root) {
    static const char *const keys[] = {"$schema", "version", "camera",    "film",   "background", "environment", "ambient", "fog",
                                       "paths",   "shadows", "materials", "lights", "meshes",     "shapes",      NULL};
    struct scene *scene = build->scene;
    bool has_camera;
    const char *schema; // for editors
    if (!json_is_object(root->value)) return at_expected(root, "an object");
    if (!read_version(root) || !at_object(root, keys) || !at_get_text(root, "$schema", "the path of a JSON Schema", &schema) ||
        !part_film(&scene->film, root) || !part_paths(&scene->paths, root) || !part_fog(&scene->fog, root) ||
        !at_get_float3(root, "background", RANGE_NOT_NEGATIVE, scene->background) ||
        !at_get_float3(root, "ambient", RANGE_NOT_NEGATIVE, scene->ambient) || !at_get_bool(root, "shadows", &scene->shadows) ||
        !part_camera(&scene->camera, root, &has_camera))
        return false;
    if (!part_environment(build, root) || !part_materials(build, root) || !part_lights(build, root) || !part_shapes(build, root) ||
        !scene_derive(scene, build->ctx))
        return false;
    if (has_camera) return true;
    const struct scene_ball ball = scene_ball(scene);
    return frame_camera(&scene->camera, build->ctx, &ball, 1);
}

bool scene_load_json(struct scene_build *build, const char *path) {
    struct json_file file;
    if (!json_file_init(&file, build->ctx, path)) return false;
    const struct json_at root = at_root(&file);
    const bool done = read_scene(build, &root);
    json_file_finish(&file);
    return done;
}
