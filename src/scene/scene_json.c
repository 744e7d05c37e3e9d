// The scene file, format version 1: each function reads one kind of object of the format.
#include "scene/build.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/frame.h"
#include "scene/json_read.h"
#include "scene/mesh.h"
#include "scene/words.h"

static bool same3(const float a[3], const float b[3]) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

// Whether `up` is along the view, as far as fp64 can tell (render/camera.c).
static bool is_along_view(const struct scene_camera *camera) {
    double view[3], side = 0, view2 = 0, up2 = 0;
    for (int i = 0; i < 3; i++) view[i] = (double)camera->look_at[i] - camera->position[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double across = view[j] * camera->up[k] - view[k] * camera->up[j];
        side += across * across;
        view2 += view[i] * view[i];
        up2 += (double)camera->up[i] * camera->up[i];
    }
    return !(side > 1e-24 * view2 * up2);
}

static bool read_camera(struct scene_camera *out, const struct json_at *at) {
    static const char *const keys[] = {"position", "look_at", "up", "fov_y_deg", NULL};
    static const float zero[3] = {0};
    *out = (struct scene_camera){.up = {0, 1, 0}, .look_at = {0, 0, -1}, .fov_y_deg = 40};
    if (!at_object(at, keys) || !at_require(at, "position", "3 numbers") || !at_require(at, "look_at", "3 numbers")) return false;
    if (!at_get_float3(at, "position", RANGE_ANY, out->position) || !at_get_float3(at, "look_at", RANGE_ANY, out->look_at) ||
        !at_get_float3(at, "up", RANGE_ANY, out->up) || !at_get_float(at, "fov_y_deg", RANGE_FIELD_OF_VIEW, &out->fov_y_deg))
        return false;
    struct json_at member;
    if (same3(out->position, out->look_at) && at_member(&member, at, "look_at"))
        return at_fail(&member, "is the camera's position, expected a point to look at elsewhere");
    if (same3(out->up, zero) && at_member(&member, at, "up")) return at_fail(&member, "is zero, expected a direction such as [0,1,0]");
    if (at_member(&member, at, "up") && is_along_view(out)) return at_fail(&member, "is along the view, expected a direction across it");
    return true;
}

static bool read_film(struct scene_film *out, const struct json_at *at) {
    static const char *const keys[] = {"width", "height", "spp", "transfer", NULL};
    static const char *const transfers[] = {[TRANSFER_SRGB] = "srgb", [TRANSFER_LINEAR] = "linear", NULL};
    int transfer = out->transfer;
    if (!at_object(at, keys) || !at_get_count(at, "width", 1, 65535, &out->width) || !at_get_count(at, "height", 1, 65535, &out->height) ||
        !at_get_count(at, "spp", 1, 16777216, &out->spp) || !at_get_choice(at, "transfer", transfers, &transfer))
        return false;
    out->transfer = (enum transfer)transfer;
    return true;
}

static bool read_material(struct scene_material *out, const struct json_at *at) {
    static const char *const keys[] = {"ambient", "diffuse", "specular", "shininess", NULL};
    if (!at_object(at, keys) || !at_get_float3(at, "diffuse", RANGE_NOT_NEGATIVE, out->diffuse)) return false;
    memcpy(out->ambient, out->diffuse, sizeof out->ambient);
    return at_get_float3(at, "ambient", RANGE_NOT_NEGATIVE, out->ambient) &&
           at_get_float3(at, "specular", RANGE_NOT_NEGATIVE, out->specular) &&
           at_get_float(at, "shininess", RANGE_NOT_NEGATIVE, &out->shininess);
}

static bool read_materials(struct scene_build *build, const struct json_at *root) {
    struct json_at materials;
    if (!at_member(&materials, root, "materials")) return true;
    if (!json_is_object(materials.value)) return at_expected(&materials, "an object of materials by name");
    const char *name;
    json_t *value;
    json_object_foreach(materials.value, name, value) {
        struct json_at at;
        struct scene_material *material = material_add(&build->materials, build->ctx, name);
        if (!material || !at_member(&at, &materials, name) || !read_material(material, &at)) return false;
    }
    return true;
}

static bool read_light(struct scene_light *out, const struct json_at *at) {
    static const char *const keys[] = {"type", "position", "intensity", "falloff", NULL};
    static const char *const types[] = {[LIGHT_POINT] = "point", NULL};
    static const char *const falloffs[] = {[FALLOFF_NONE] = "none", [FALLOFF_INVERSE_SQUARE] = "inverse_square", NULL};
    int type = LIGHT_POINT, falloff = FALLOFF_NONE;
    *out = (struct scene_light){.intensity = {1, 1, 1}};
    if (!at_object(at, keys) || !at_require(at, "type", "\"point\"") || !at_get_choice(at, "type", types, &type) ||
        !at_require(at, "position", "3 numbers") || !at_get_float3(at, "position", RANGE_ANY, out->position) ||
        !at_get_float3(at, "intensity", RANGE_NOT_NEGATIVE, out->intensity) || !at_get_choice(at, "falloff", falloffs, &falloff))
        return false;
    out->type = (enum light_type)type, out->falloff = (enum light_falloff)falloff;
    return true;
}

static bool read_lights(struct scene_build *build, const struct json_at *root) {
    struct scene *scene = build->scene;
    struct json_at lights;
    if (!at_member(&lights, root, "lights")) return true;
    if (!at_list(&lights, 0, UINT32_MAX, "a list of lights")) return false;
    const uint32_t count = (uint32_t)json_array_size(lights.value);
    scene->lights = array_alloc(build->ctx, count, sizeof *scene->lights, "lights");
    if (!scene->lights) return false;
    for (scene->light_count = 0; scene->light_count < count; scene->light_count++) {
        const struct json_at at = at_item(&lights, scene->light_count);
        if (!read_light(&scene->lights[scene->light_count], &at)) return false;
    }
    return true;
}

// ------------------------------------------------------------------------------------------------------------------- shapes

// Finds the material that a shape names; *out stays NULL when it names none.
static bool find_material(const uint32_t **out, uint32_t *number, const struct scene_build *build, const struct json_at *shape) {
    struct json_at member;
    const char *name;
    *out = NULL;
    if (!at_member(&member, shape, "material")) return true;
    if (!at_text(&member, "the name of a material", &name)) return false;
    if (material_find(&build->materials, name, number)) {
        *out = number;
        return true;
    }
    struct nearest nearest = nearest_to(name);
    const struct scene_material *materials = build->materials.items.items;
    for (size_t i = 0; i < build->materials.items.count; i++) nearest_offer(&nearest, materials[i].name);
    return at_fail(&member, "is \"%s\", expected the name of one of the %zu materials in \"materials\"%s", excerpt_word(name).text,
                   build->materials.items.count, nearest_hint(&nearest).text);
}

static bool set_material(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    const uint32_t *named;
    if (!find_material(&named, &out->material, build, at)) return false;
    return named || material_need(&build->materials, build->ctx, DEFAULT_MATERIAL, &out->material);
}

static bool read_sphere(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    static const char *const keys[] = {"type", "center", "radius", "material", NULL};
    out->type = SHAPE_SPHERE;
    return at_object(at, keys) && at_require(at, "center", "3 numbers") && at_get_float3(at, "center", RANGE_ANY, out->center) &&
           at_require(at, "radius", "a number greater than 0") && at_get_float(at, "radius", RANGE_POSITIVE, &out->radius) &&
           set_material(out, build, at);
}

static bool read_triangle(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    static const char *const keys[] = {"type", "vertices", "material", NULL};
    struct json_at vertices;
    out->type = SHAPE_TRIANGLE;
    if (!at_object(at, keys) || !at_require(at, "vertices", "3 points")) return false;
    if (!at_member(&vertices, at, "vertices") || !at_list(&vertices, 3, 3, "a list of 3 points")) return false;
    if (!mesh_init(&out->mesh, build->ctx, 3, 1, false)) return false;
    for (uint32_t i = 0; i < 3; i++) {
        const struct json_at vertex = at_item(&vertices, i);
        if (!at_float3(&vertex, RANGE_ANY, out->mesh.positions + 3 * i)) return false;
        out->mesh.indices[i] = i;
    }
    return set_material(out, build, at);
}

// 4 rows of 4 numbers, or the 16 numbers in one list.
static bool read_transform(struct transform *out, const struct json_at *at) {
    static const char expected[] = "4 rows of 4 numbers";
    const bool flat = json_array_size(at->value) == 16;
    if (!flat && !at_list(at, 4, 4, expected)) return false;
    for (size_t i = 0; i < 4; i++) {
        const struct json_at row = flat ? *at : at_item(at, i);
        if (!flat && !at_list(&row, 4, 4, "a row of 4 numbers")) return false;
        for (size_t j = 0; j < 4; j++) {
            const struct json_at item = at_item(&row, flat ? 4 * i + j : j);
            if (!at_double(&item, &out->m[i][j])) return false;
            if (i == 3 && out->m[i][j] != (j == 3))
                return at_expected(&item, j == 3 ? "1: the last row must be 0 0 0 1" : "0: the last row must be 0 0 0 1");
        }
    }
    const double condition = transform_condition(out);
    if (condition < WORST_CONDITION) return true;
    return at_fail(at, "is singular or nearly so (condition number %.3g), expected a transform that can be undone", condition);
}

static bool apply_transform(struct scene_mesh *mesh, const struct json_at *shape) {
    struct json_at at;
    struct transform transform;
    uint32_t bad;
    if (!at_member(&at, shape, "transform")) return true;
    if (!read_transform(&transform, &at)) return false;
    return mesh_transform(mesh, &transform, 0, mesh->vertex_count, &bad) ||
           at_fail(&at, "takes vertex %u of the mesh out of the range of fp32, expected smaller numbers", bad);
}

enum normals { NORMALS_FILE, NORMALS_FLAT, NORMALS_SMOOTH };

static bool load_model(struct model *out, struct scene_build *build, const struct json_at *shape) {
    struct json_at at;
    const char *name;
    if (!at_require(shape, "file", "the path of a mesh") || !at_member(&at, shape, "file") || !at_text(&at, "the path of a mesh", &name))
        return false;
    char *path = path_beside(build->scene->path, name);
    if (!path) return fail(build->ctx, GN_LIMIT, "no memory for a path");
    const char *trouble = path_unreadable(path);
    const bool done = trouble ? at_fail(&at, "is \"%s\", expected a file that can be read: %s", excerpt_word(name).text, trouble)
                              : model_load(out, build->ctx, path);
    free(path);
    return done;
}

static bool read_mesh(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    static const char *const keys[] = {"type", "file", "transform", "normals", "material", NULL};
    static const char *const policies[] = {[NORMALS_FILE] = "file", [NORMALS_FLAT] = "flat", [NORMALS_SMOOTH] = "smooth", NULL};
    int normals = NORMALS_FILE;
    const uint32_t *material;
    uint32_t number;
    struct model model = {0};
    bool done = at_object(at, keys) && at_get_choice(at, "normals", policies, &normals) && find_material(&material, &number, build, at) &&
                load_model(&model, build, at) && shape_take_model(out, build, &model, material);
    model_finish(&model);
    if (done && normals != NORMALS_FILE) {
        free(out->mesh.normals);
        out->mesh.normals = NULL;
    }
    return done && apply_transform(&out->mesh, at) && (normals != NORMALS_SMOOTH || mesh_smooth(&out->mesh, build->ctx, CREASE_DEG));
}

static bool read_shape(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    static const char *const types[] = {[SHAPE_SPHERE] = "sphere", [SHAPE_TRIANGLE] = "triangle", [SHAPE_MESH] = "mesh", NULL};
    static bool (*const readers[])(struct scene_shape *, struct scene_build *, const struct json_at *) = {
        [SHAPE_SPHERE] = read_sphere, [SHAPE_TRIANGLE] = read_triangle, [SHAPE_MESH] = read_mesh};
    int type = SHAPE_SPHERE;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    return at_require(at, "type", "\"sphere\", \"triangle\" or \"mesh\"") && at_get_choice(at, "type", types, &type) &&
           readers[type](out, build, at);
}

static bool read_shapes(struct scene_build *build, const struct json_at *root) {
    struct scene *scene = build->scene;
    struct json_at shapes;
    if (!at_member(&shapes, root, "shapes")) return true;
    if (!at_list(&shapes, 0, INT32_MAX, "a list of shapes")) return false;
    const uint32_t count = (uint32_t)json_array_size(shapes.value);
    scene->shapes = array_alloc(build->ctx, count, sizeof *scene->shapes, "shapes");
    if (!scene->shapes) return false;
    scene->shape_count = count;
    for (uint32_t i = 0; i < count; i++) {
        const struct json_at at = at_item(&shapes, i);
        if (!read_shape(&scene->shapes[i], build, &at)) return false;
        if (i % 256 == 0 && !progress(build->ctx, "scene", (double)i / count, -1)) return false;
    }
    return true;
}

// -------------------------------------------------------------------------------------------------------------- the document

static bool read_version(const struct json_at *root) {
    struct json_at version;
    if (!at_require(root, "version", "\"version\": 1") || !at_member(&version, root, "version")) return false;
    return (json_is_number(version.value) && json_number_value(version.value) == 1) ||
           at_expected(&version, "1, the only version there is");
}

static bool read_scene(struct scene_build *build, const struct json_at *root) {
    static const char *const keys[] = {"version",   "camera", "film",   "background", "ambient",
                                       "materials", "lights", "shapes", "shadows",    NULL};
    struct scene *scene = build->scene;
    struct json_at at;
    if (!json_is_object(root->value)) return at_expected(root, "an object");
    if (!read_version(root) || !at_object(root, keys)) return false;
    if (at_member(&at, root, "film") && !read_film(&scene->film, &at)) return false;
    if (!at_get_float3(root, "background", RANGE_NOT_NEGATIVE, scene->background) ||
        !at_get_float3(root, "ambient", RANGE_NOT_NEGATIVE, scene->ambient) || !at_get_bool(root, "shadows", &scene->shadows))
        return false;
    const bool has_camera = at_member(&at, root, "camera");
    if (has_camera && !read_camera(&scene->camera, &at)) return false;
    if (!read_materials(build, root) || !read_lights(build, root) || !read_shapes(build, root) || !scene_derive(scene, build->ctx))
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
