// A model file as a scene of its own: the file's camera and lights if it has them, else a view and lights that show the model well.
#include "scene/build.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/frame.h"
#include "scene/mesh.h"

// A warm grey with a faint highlight stands in where the file names no material.
static bool add_clay(struct scene_build *build, uint32_t *number) {
    static const float color[3] = {0.72f, 0.65f, 0.58f}, highlight[3] = {0.12f, 0.12f, 0.12f};
    *number = (uint32_t)build->materials.items.count;
    struct scene_material *material = material_add(&build->materials, build->ctx, DEFAULT_MATERIAL);
    if (!material) return false;
    memcpy(material->ambient, color, sizeof color);
    memcpy(material->diffuse, color, sizeof color);
    memcpy(material->specular, highlight, sizeof highlight);
    material->shininess = 40;
    return true;
}

static bool take_shape(struct scene_build *build, struct model *model) {
    struct scene *scene = build->scene;
    uint32_t material;
    scene->shapes = array_alloc(build->ctx, 1, sizeof *scene->shapes, "shapes");
    if (!scene->shapes) return false;
    scene->shape_count = 1;
    if (model->material_count == 0 && !add_clay(build, &material)) return false;
    return shape_take_model(&scene->shapes[0], build, model, model->material_count == 0 ? &material : NULL) &&
           (scene->shapes[0].mesh.normals || mesh_smooth(&scene->shapes[0].mesh, build->ctx, CREASE_DEG));
}

static bool take_lights(struct scene_build *build, struct model *model, const struct scene_ball *ball) {
    struct scene *scene = build->scene;
    if (model->light_count > 0) {
        scene->lights = model->lights, scene->light_count = model->light_count;
        model->lights = NULL, model->light_count = 0;
        frame_exposure(scene->lights, scene->light_count, ball);
        return true;
    }
    scene->lights = array_alloc(build->ctx, 2, sizeof *scene->lights, "lights");
    if (!scene->lights) return false;
    scene->light_count = 2;
    frame_lights(scene->lights, &scene->camera, ball);
    return true;
}

static bool take_model(struct scene_build *build, struct model *model, int up_axis) {
    struct scene *scene = build->scene;
    if (!take_shape(build, model) || !scene_derive(scene, build->ctx)) return false;
    const struct scene_ball ball = scene_ball(scene);
    if (model->camera_count > 0)
        scene->camera = model->cameras[0];
    else if (!frame_camera(&scene->camera, build->ctx, &ball, up_axis))
        return false;
    for (int i = 0; i < 3; i++) scene->background[i] = 0.2f, scene->ambient[i] = 0.09f;
    return take_lights(build, model, &ball);
}

bool scene_load_model(struct scene_build *build, const char *path) {
    const char *trouble = path_unreadable(path);
    if (trouble) return fail(build->ctx, GN_IO, "%s: cannot be read: %s", path, trouble);
    char suffix[16];
    path_suffix(path, suffix, sizeof suffix);
    const int up_axis = strcmp(suffix, "stl") == 0 ? 2 : 1; // STL comes from printing and machining, where z is up
    struct model model;
    const bool done = model_load(&model, build->ctx, path) && take_model(build, &model, up_axis);
    model_finish(&model);
    return done;
}
