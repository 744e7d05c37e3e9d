// Loading a scene from either source, and the plain accessors.
#include "scene/scene.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "scene/area_lights.h"
#include "scene/bounds.h"
#include "scene/build.h"
#include "scene/instances.h"
#include "scene/mesh.h"

// What the camera of a model file leaves open: it has a pinhole and stands still.
static void complete_camera(struct scene_camera *camera) {
    if (camera->moves) return;
    memcpy(camera->position_end, camera->position, sizeof camera->position);
    memcpy(camera->look_at_end, camera->look_at, sizeof camera->look_at);
}

// Texture coordinates are for textures.
static void drop_uvs(struct scene *scene) {
    for (uint32_t i = 0; i < scene->shape_count + scene->prototype_count; i++) {
        struct scene_mesh *mesh = i < scene->shape_count ? &scene->shapes[i].mesh : &scene->prototypes[i - scene->shape_count];
        free(mesh->uvs);
        mesh->uvs = NULL;
    }
}

bool scene_load(struct scene *out, struct context *ctx, const char *path) {
    *out = (struct scene){
        .film = {.width = 512, .height = 512, .spp = 1, .transfer = TRANSFER_SRGB, .filter = FILTER_BOX, .filter_radius = 0.5f},
        .shadows = true,
        .paths = {.max_depth = 8, .roulette_depth = 3},
    };
    struct scene_build build = {.scene = out, .ctx = ctx, .materials = MATERIAL_TABLE, .textures = TEXTURE_TABLE};
    char suffix[16];
    path_suffix(path, suffix, sizeof suffix);
    out->path = strdup(path);
    bool done = out->path || fail(ctx, GN_LIMIT, "no memory for a path");
    done = done && progress(ctx, "scene", 0, -1) &&
           (strcmp(suffix, "json") == 0 ? scene_load_json(&build, path) : scene_load_model(&build, path));
    material_table_take(&build.materials, &out->materials, &out->material_count);
    texture_table_take(&build.textures, &out->textures, &out->texture_count);
    done = done && scene_area_lights(out, ctx) && progress(ctx, "scene", 1, 0);
    complete_camera(&out->camera);
    if (done && out->texture_count == 0) drop_uvs(out);
    if (!done) scene_finish(out);
    return done;
}

void scene_finish(struct scene *scene) {
    for (uint32_t i = 0; i < scene->shape_count; i++) mesh_finish(&scene->shapes[i].mesh);
    materials_free(scene->materials, scene->material_count);
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        free(scene->textures[i].name);
        free(scene->textures[i].texels);
    }
    for (uint32_t i = 0; i < scene->prototype_count; i++) mesh_finish(&scene->prototypes[i]);
    free(scene->environment.texels);
    free(scene->textures);
    free(scene->prototypes);
    free(scene->path);
    free(scene->lights);
    free(scene->shapes);
    free(scene->parts);
    free(scene->instances);
    free(scene->first_triangle);
    free(scene->first_sphere);
    *scene = (struct scene){0};
}

const char *path_unreadable(const char *path) {
    struct stat about;
    if (stat(path, &about) != 0) return strerror(errno);
    if (S_ISDIR(about.st_mode)) return "it is a directory";
    if (!S_ISREG(about.st_mode)) return "it is no regular file";
    return access(path, R_OK) == 0 ? NULL : strerror(errno);
}

// Adds a material of a model whose textures have these numbers in the scene; numbers[NO_TEXTURE] is NO_TEXTURE.
static bool take_material(struct scene_build *build, const struct scene_material *from, const uint32_t *numbers) {
    struct scene_material *to = material_add(&build->materials, build->ctx, from->name);
    if (!to) return false;
    char *name = to->name;
    *to = *from;
    to->name = name;
    struct scene_map *const maps[] = {&to->diffuse_map, &to->normal_map, &to->roughness_map, &to->emission_map};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) maps[i]->texture = numbers[maps[i]->texture];
    return true;
}

bool shape_take_model(struct scene_shape *shape, struct scene_build *build, struct model *model, const uint32_t *material) {
    shape->type = SHAPE_MESH;
    shape->mesh = model->mesh;
    model->mesh = (struct scene_mesh){0};
    if (material || model->material_count == 0) {
        free(shape->mesh.materials);
        shape->mesh.materials = NULL;
        if (!material) return material_need(&build->materials, build->ctx, DEFAULT_MATERIAL, &shape->material);
        shape->material = *material;
        return true;
    }
    shape->material = (uint32_t)build->materials.items.count;
    uint32_t *numbers = array_alloc(build->ctx, (size_t)model->texture_count + 1, sizeof *numbers, "textures");
    bool done = numbers != NULL;
    for (uint32_t i = 0; done && i < model->texture_count; i++)
        done = texture_need(&build->textures, build->ctx, &model->textures[i], &numbers[i + 1]);
    for (uint32_t i = 0; done && i < model->material_count; i++) done = take_material(build, &model->materials[i], numbers);
    free(numbers);
    if (!done) return false;
    for (size_t i = 0; shape->mesh.materials && i < shape->mesh.triangle_count; i++) shape->mesh.materials[i] += shape->material;
    return true;
}

bool scene_derive(struct scene *scene, struct context *ctx) {
    if (!scene_list_instances(scene, ctx)) return false;
    scene->first_triangle = array_alloc(ctx, (size_t)scene->shape_count + 1, sizeof *scene->first_triangle, "shapes");
    scene->first_sphere = array_alloc(ctx, (size_t)scene->shape_count + 1, sizeof *scene->first_sphere, "shapes");
    if (!scene->first_triangle || !scene->first_sphere) return false;
    uint64_t triangles = 0, spheres = 0;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        if (scene->shapes[i].type == SHAPE_SPHERE)
            spheres++;
        else if (!scene->shapes[i].instance)
            triangles += scene->shapes[i].mesh.triangle_count;
        if (triangles > MOST_PRIMITIVES || spheres > MOST_PRIMITIVES)
            return fail(ctx, GN_LIMIT, "%s: the scene has more than %u %s", scene->path, MOST_PRIMITIVES,
                        spheres > MOST_PRIMITIVES ? "spheres" : "triangles");
        scene->first_triangle[i + 1] = (uint32_t)triangles;
        scene->first_sphere[i + 1] = (uint32_t)spheres;
    }
    const struct scene_part *last = scene->part_count ? &scene->parts[scene->part_count - 1] : NULL;
    if (last && triangles + last->first + last->mesh->triangle_count > MOST_PRIMITIVES)
        return fail(ctx, GN_LIMIT, "%s: the scene and what its instances draw have more than %u triangles", scene->path, MOST_PRIMITIVES);
    scene_bounds(scene);
    return true;
}

uint32_t scene_triangle_count(const struct scene *scene) { return scene->shape_count ? scene->first_triangle[scene->shape_count] : 0; }
uint32_t scene_sphere_count(const struct scene *scene) { return scene->shape_count ? scene->first_sphere[scene->shape_count] : 0; }

uint64_t scene_instanced_count(const struct scene *scene) {
    if (scene->instance_count == 0) return 0;
    const struct scene_instance *last = &scene->instances[scene->instance_count - 1];
    return (uint64_t)last->first + scene->parts[last->part].mesh->triangle_count;
}

const struct scene_mesh *scene_mesh_of(const struct scene *scene, uint32_t object) {
    const struct scene_shape *shape = &scene->shapes[object];
    return shape->type == SHAPE_INSTANCE ? &scene->prototypes[shape->prototype] : &shape->mesh;
}

// The last shape whose number is at most `number`: the one that has it, as the others there are empty.
static uint32_t shape_of(const uint32_t *first, uint32_t shape_count, uint32_t number) {
    uint32_t low = 0, high = shape_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (first[middle] <= number)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Each has some triangles.
const struct scene_instance *scene_instance_at(const struct scene *scene, uint32_t number) {
    uint32_t low = 0, high = scene->instance_count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->instances[middle].first <= number)
            low = middle;
        else
            high = middle;
    }
    return &scene->instances[low];
}

struct scene_triangle scene_triangle_at(const struct scene *scene, uint32_t number) {
    const uint32_t triangles = scene_triangle_count(scene), others = triangles + scene_sphere_count(scene);
    struct scene_triangle triangle;
    if (number < triangles) {
        triangle.object = shape_of(scene->first_triangle, scene->shape_count, number);
        triangle.primitive = number - scene->first_triangle[triangle.object];
    } else {
        const struct scene_instance *instance = scene_instance_at(scene, number - others);
        triangle.object = instance->shape;
        triangle.primitive = number - others - instance->first;
    }
    const struct scene_shape *shape = &scene->shapes[triangle.object];
    const struct scene_mesh *mesh = scene_mesh_of(scene, triangle.object);
    for (int k = 0; k < 3; k++) {
        triangle.vertex[k] = mesh->indices[3 * (size_t)triangle.primitive + (size_t)k];
        triangle.v[k] = mesh->positions + 3 * (size_t)triangle.vertex[k];
    }
    const bool own = !mesh->materials || (shape->type == SHAPE_INSTANCE && shape->own_material);
    triangle.material = own ? shape->material : mesh->materials[triangle.primitive];
    return triangle;
}

uint32_t scene_sphere_object(const struct scene *scene, uint32_t number) {
    return shape_of(scene->first_sphere, scene->shape_count, number);
}
