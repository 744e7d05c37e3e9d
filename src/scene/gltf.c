// Models from glTF 2.0 files (.gltf, .glb): the geometry, materials, cameras and lights of one scene. All of a file is checked before
// anything is made of it, and what is wrong is told with its place in the file's JSON. Meshes of all nodes become one, depth first, each in
// the order of its primitives. Source: Khronos Group, "glTF 2.0 Specification", 2.0.1, 2021, and the extension KHR_lights_punctual.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/frame.h"
#include "scene/gltf_material.h"
#include "scene/import.h"
#include "scene/material.h"
#include "scene/words.h"

#define LIGHTS "KHR_lights_punctual"
#define MOST_DEPTH 500 // of the tree of nodes, which is walked by recursion

static const double PI = 3.14159265358979323846;

// How a primitive's corners become triangles; below are points and lines.
enum { MODE_TRIANGLES = 4, MODE_STRIP, MODE_FAN };

struct primitive {
    struct gltf_accessor positions, normals, uvs, indices; // count 0: there are none
    uint32_t mode, corners, triangles;
    uint32_t material; // of the file, or GLTF_NONE
};

struct node {
    struct transform local;
    uint32_t mesh, camera, light; // or GLTF_NONE
    uint32_t parent;              // 1 + its number, 0 for none, UINT32_MAX for the scene
};

struct import {
    struct gltf gltf;
    struct model *model;
    struct gltf_material *looks; // the file's materials
    uint32_t look_count;
    uint32_t *numbers; // of each of them, and of "none" at the end, the model's, or GLTF_NONE while it has none
    struct material_table materials;
    struct array textures;        // struct texture_source, of the model
    struct array primitives;      // struct primitive, of all meshes
    uint32_t *first_primitive;    // of each mesh, and the end of the last
    struct scene_camera *cameras; // the file's, where the node is the identity; fov 0: none of ours
    struct scene_light *lights;   // the file's, at the origin
    struct json_at extensions, lights_extension, light_list;
    uint32_t camera_count, light_count;
    struct node *nodes;
    uint32_t node_count;
    bool filling; // the second walk: the first one counts
    uint64_t vertices, triangles;
    bool has_normals, has_uvs;
};

// ------------------------------------------------------------------------------------------------------- cameras and lights

static bool is_kind(const json_t *object, const char *type) {
    const char *actual = json_string_value(json_object_get(object, "type"));
    return actual && strcmp(actual, type) == 0;
}

static bool read_camera(struct scene_camera *out, struct import *import, const struct json_at *at) {
    struct json_at perspective;
    float fov = 0;
    if (is_kind(at->value, "perspective")) {
        if (!at_require(at, "perspective", "an object") || !at_member(&perspective, at, "perspective")) return false;
        if (!json_is_object(perspective.value)) return at_expected(&perspective, "an object");
        if (!at_require(&perspective, "yfov", "an angle") || !at_get_float(&perspective, "yfov", RANGE_POSITIVE, &fov)) return false;
        if (fov > 3.1415f) return at_fail(&perspective, "has a yfov of %g, expected less than 3.1415", (double)fov);
    } else {
        notify(import->gltf.ctx, GN_LEVEL_WARNING, "%s: camera %zu is not perspective; it is left out", import->gltf.json.path, at->index);
    }
    *out = (struct scene_camera){.fov_y_deg = (float)(fov * (180 / PI))};
    return true;
}

static bool read_cameras(struct import *import) {
    struct json_at list;
    if (!gltf_list(&list, &import->gltf, "cameras", &import->camera_count)) return false;
    import->cameras = array_alloc(import->gltf.ctx, import->camera_count, sizeof *import->cameras, "cameras");
    for (uint32_t i = 0; import->cameras && i < import->camera_count; i++) {
        const struct json_at at = at_item(&list, i);
        if (!read_camera(&import->cameras[i], import, &at)) return false;
    }
    return import->cameras != NULL;
}

static bool read_cone(struct scene_light *out, const struct json_at *at) {
    struct json_at spot;
    float inner = 0, outer = (float)(PI / 4);
    if (at_member(&spot, at, "spot")) {
        if (!json_is_object(spot.value)) return at_expected(&spot, "an object");
        if (!at_get_float(&spot, "innerConeAngle", RANGE_NOT_NEGATIVE, &inner) ||
            !at_get_float(&spot, "outerConeAngle", RANGE_POSITIVE, &outer))
            return false;
        if (outer > 1.5708f || !(inner < outer))
            return at_fail(&spot, "has cone angles of %g and %g, expected an inner one below the outer one, and that up to pi/2",
                           (double)inner, (double)outer);
    }
    out->inner_deg = (float)(inner * (180 / PI)), out->outer_deg = fminf((float)(outer * (180 / PI)), 90);
    return true;
}

// Intensities are candela, and lux of a directional light: a surface sends back 1/π of that.
static bool read_light(struct scene_light *out, const struct json_at *at) {
    static const char *const types[] = {[LIGHT_POINT] = "point", [LIGHT_DIRECTIONAL] = "directional", [LIGHT_SPOT] = "spot", NULL};
    float color[3] = {1, 1, 1}, intensity = 1;
    int type = LIGHT_POINT;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_require(at, "type", "\"point\", \"directional\" or \"spot\"") || !at_get_choice(at, "type", types, &type) ||
        !at_get_float3(at, "color", RANGE_NOT_NEGATIVE, color) || !at_get_float(at, "intensity", RANGE_NOT_NEGATIVE, &intensity))
        return false;
    *out =
        (struct scene_light){.type = (enum light_type)type, .falloff = type == LIGHT_DIRECTIONAL ? FALLOFF_NONE : FALLOFF_INVERSE_SQUARE};
    for (int i = 0; i < 3; i++) out->intensity[i] = (float)fmin(color[i] * (double)intensity / PI, 1e30);
    return type != LIGHT_SPOT || read_cone(out, at);
}

static bool read_lights(struct import *import) {
    const struct gltf *gltf = &import->gltf;
    if (!at_member(&import->extensions, &gltf->root, "extensions") || !at_member(&import->lights_extension, &import->extensions, LIGHTS) ||
        !at_member(&import->light_list, &import->lights_extension, "lights"))
        return true;
    if (!at_list(&import->light_list, 0, UINT32_MAX, "a list of lights")) return false;
    const uint32_t count = (uint32_t)json_array_size(import->light_list.value);
    import->lights = array_alloc(gltf->ctx, count, sizeof *import->lights, "lights");
    if (!import->lights) return false;
    for (import->light_count = 0; import->light_count < count; import->light_count++) {
        const struct json_at at = at_item(&import->light_list, import->light_count);
        if (!read_light(&import->lights[import->light_count], &at)) return false;
    }
    return true;
}

// ------------------------------------------------------------------------------------------------------------------- meshes

// Whether every index is that of a vertex.
static bool check_indices(const struct gltf *gltf, const struct json_at *at, const struct primitive *primitive) {
    for (uint32_t i = 0; i < primitive->indices.count; i++) {
        const uint32_t index = gltf_integer(gltf, &primitive->indices, i);
        if (index >= primitive->positions.count)
            return at_fail(at, "has index %u at %u, expected at most %u", index, i, primitive->positions.count - 1);
    }
    return true;
}

// The texture coordinates that the primitive's material uses.
static bool read_uvs(struct primitive *out, struct import *import, const struct json_at *attributes) {
    char key[24];
    snprintf(key, sizeof key, "TEXCOORD_%u", out->material == GLTF_NONE ? 0 : import->looks[out->material].uv_set);
    if (!gltf_get_accessor(&out->uvs, &import->gltf, attributes, key, 2, GLTF_UNITS)) return false;
    return out->uvs.count == 0 || out->uvs.count == out->positions.count ||
           at_fail(attributes, "has %u positions and %u texture coordinates, expected as many", out->positions.count, out->uvs.count);
}

static bool read_primitive(struct import *import, const struct json_at *at) {
    struct gltf *gltf = &import->gltf;
    struct json_at attributes;
    struct primitive p = {.mode = MODE_TRIANGLES};
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_get_count(at, "mode", 0, MODE_FAN, &p.mode)) return false;
    if (p.mode < MODE_TRIANGLES) return true;
    if (!at_require(at, "attributes", "an object") || !at_member(&attributes, at, "attributes")) return false;
    if (!json_is_object(attributes.value)) return at_expected(&attributes, "an object");
    if (!gltf_get_accessor(&p.positions, gltf, &attributes, "POSITION", 3, GLTF_FLOATS) ||
        !gltf_get_accessor(&p.normals, gltf, &attributes, "NORMAL", 3, GLTF_FLOATS) ||
        !gltf_get_accessor(&p.indices, gltf, at, "indices", 1, GLTF_INTEGERS) ||
        !gltf_get_index(gltf, at, "material", "materials", &p.material))
        return false;
    if (p.positions.count == 0) return at_fail(&attributes, "has no 'POSITION', expected one");
    if (p.normals.count > 0 && p.normals.count != p.positions.count)
        return at_fail(&attributes, "has %u positions and %u normals, expected as many", p.positions.count, p.normals.count);
    if (!read_uvs(&p, import, &attributes) || !check_indices(gltf, at, &p)) return false;
    p.corners = p.indices.count > 0 ? p.indices.count : p.positions.count;
    if (p.corners < 3) return at_fail(at, "has %u corners, expected at least 3 for triangles", p.corners);
    p.triangles = p.mode == MODE_TRIANGLES ? p.corners / 3 : p.corners - 2;
    struct primitive *added = array_push(&import->primitives, gltf->ctx);
    if (added) *added = p;
    return added != NULL;
}

static bool read_mesh(struct import *import, const struct json_at *at) {
    struct json_at primitives;
    if (!at_require(at, "primitives", "a list") || !at_member(&primitives, at, "primitives") ||
        !at_list(&primitives, 0, UINT32_MAX, "a list of primitives"))
        return false;
    for (size_t i = 0; i < json_array_size(primitives.value); i++) {
        const struct json_at primitive = at_item(&primitives, i);
        if (!read_primitive(import, &primitive)) return false;
    }
    return true;
}

static bool read_meshes(struct import *import) {
    struct json_at list;
    uint32_t count;
    if (!gltf_list(&list, &import->gltf, "meshes", &count)) return false;
    import->first_primitive = array_alloc(import->gltf.ctx, (size_t)count + 1, sizeof *import->first_primitive, "meshes");
    for (uint32_t i = 0; import->first_primitive && i < count; i++) {
        const struct json_at at = at_item(&list, i);
        if (!read_mesh(import, &at)) return false;
        import->first_primitive[i + 1] = (uint32_t)import->primitives.count;
    }
    return import->first_primitive != NULL;
}

// -------------------------------------------------------------------------------------------------------------------- nodes

static bool read_numbers(double *out, const struct json_at *node, const char *key, size_t count) {
    struct json_at list;
    char expected[32];
    snprintf(expected, sizeof expected, "a list of %zu numbers", count);
    if (!at_member(&list, node, key)) return true;
    if (!at_list(&list, count, count, expected)) return false;
    for (size_t i = 0; i < count; i++) {
        const struct json_at item = at_item(&list, i);
        if (!at_double(&item, &out[i])) return false;
    }
    return true;
}

// The matrix of a quaternion x, y, z, w, which need not be quite unit, with its columns scaled.
static void set_rotation(struct transform *out, const double q[4], const double scale[3]) {
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], f = square > 0 ? 2 / square : 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out->m[i][i] = scale[i] * (1 - f * (q[j] * q[j] + q[k] * q[k]));
        out->m[i][j] = scale[j] * f * (q[i] * q[j] - q[k] * q[3]);
        out->m[i][k] = scale[k] * f * (q[i] * q[k] + q[j] * q[3]);
    }
}

// A matrix by columns, or translation · rotation · scale.
static bool read_local(struct transform *out, const struct json_at *node) {
    struct json_at member;
    double matrix[16], translation[3] = {0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    *out = transform_identity;
    if (!read_numbers(matrix, node, "matrix", 16) || !read_numbers(translation, node, "translation", 3) ||
        !read_numbers(rotation, node, "rotation", 4) || !read_numbers(scale, node, "scale", 3))
        return false;
    if (at_member(&member, node, "matrix")) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 4; j++) out->m[i][j] = matrix[4 * j + i];
        return true;
    }
    set_rotation(out, rotation, scale);
    for (int i = 0; i < 3; i++) out->m[i][3] = translation[i];
    return true;
}

static bool read_children(struct import *import, const struct json_at *node) {
    struct json_at children;
    if (!at_member(&children, node, "children")) return true;
    if (!at_list(&children, 0, import->node_count, "a list of nodes")) return false;
    for (size_t i = 0; i < json_array_size(children.value); i++) {
        const struct json_at item = at_item(&children, i);
        const json_int_t child = json_is_integer(item.value) ? json_integer_value(item.value) : -1;
        if (child < 0 || child >= import->node_count) return at_expected(&item, "the number of a node");
        if (import->nodes[child].parent) return at_fail(&item, "is node %d, which has a parent already, expected a tree", (int)child);
        import->nodes[child].parent = (uint32_t)node->index + 1;
    }
    return true;
}

static bool read_node_light(uint32_t *out, const struct import *import, const struct json_at *node) {
    struct gltf_extension extension;
    struct json_at light;
    *out = GLTF_NONE;
    if (!gltf_get_extension(&extension, node, LIGHTS)) return false;
    if (!extension.found || !at_member(&light, &extension.at, "light")) return true;
    const json_int_t number = json_is_integer(light.value) ? json_integer_value(light.value) : -1;
    if (number < 0 || number >= import->light_count) return at_expected(&light, "the number of a light");
    *out = (uint32_t)number;
    return true;
}

static bool read_node(struct import *import, const struct json_at *at) {
    struct node *out = &import->nodes[at->index];
    return read_local(&out->local, at) && read_children(import, at) && read_node_light(&out->light, import, at) &&
           gltf_get_index(&import->gltf, at, "mesh", "meshes", &out->mesh) &&
           gltf_get_index(&import->gltf, at, "camera", "cameras", &out->camera);
}

// Nodes with a parent each make a forest, unless some go round in a circle.
static bool check_depth(const struct import *import, const struct json_at *list) {
    for (uint32_t i = 0; i < import->node_count; i++) {
        unsigned depth = 0;
        for (uint32_t up = import->nodes[i].parent; up; up = import->nodes[up - 1].parent) {
            if (++depth <= MOST_DEPTH) continue;
            const struct json_at at = at_item(list, i);
            return at_fail(&at, "is its own parent or has more than %d above it, expected a tree", MOST_DEPTH);
        }
    }
    return true;
}

static bool read_nodes(struct import *import) {
    struct json_at list;
    if (!gltf_list(&list, &import->gltf, "nodes", &import->node_count)) return false;
    import->nodes = array_alloc(import->gltf.ctx, import->node_count, sizeof *import->nodes, "glTF nodes");
    for (uint32_t i = 0; import->nodes && i < import->node_count; i++) {
        const struct json_at at = at_item(&list, i);
        if (!read_node(import, &at)) return false;
    }
    return import->nodes && check_depth(import, &list);
}

// -------------------------------------------------------------------------------------------------------------- one mesh

// The model's number for a material of the file, or for "none"; it is added when it is new, and its textures are.
static bool find_material(uint32_t *number, struct import *import, uint32_t index) {
    uint32_t *known = &import->numbers[index == GLTF_NONE ? import->look_count : index];
    if (*known != GLTF_NONE) {
        *number = *known;
        return true;
    }
    *number = *known = (uint32_t)import->materials.items.count;
    const struct gltf_material *from = index == GLTF_NONE ? NULL : &import->looks[index];
    struct scene_material *material = material_add(&import->materials, import->gltf.ctx, from ? from->name : DEFAULT_MATERIAL);
    if (!material) return false;
    if (!from) return true;
    char *name = material->name;
    *material = from->look;
    material->name = name;
    struct scene_map *const maps[] = {&material->diffuse_map, &material->normal_map, &material->roughness_map, &material->emission_map};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        struct texture_source source;
        if (maps[i]->texture == NO_TEXTURE) continue;
        if (!gltf_texture_source(&source, &import->gltf, maps[i]->texture - 1, maps[i]->srgb)) return false;
        maps[i]->texture = NO_TEXTURE;
        if (source.name && !texture_source_add(&import->textures, import->gltf.ctx, &source, &maps[i]->texture)) return false;
    }
    return true;
}

// Copies the vertices as they are. A normal that is no number counts as none, as do texture coordinates.
static bool fill_vertices(struct import *import, const struct primitive *primitive, uint32_t mesh) {
    const struct gltf *gltf = &import->gltf;
    struct scene_mesh *to = &import->model->mesh;
    for (uint32_t i = 0; i < primitive->positions.count; i++) {
        const size_t vertex = import->vertices + i;
        float *p = to->positions + 3 * vertex, n[3], uv[2];
        for (unsigned k = 0; k < 3; k++) p[k] = gltf_float(gltf, &primitive->positions, i, k);
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            return fail(gltf->ctx, GN_SCENE, "%s: vertex %u of meshes[%u] is (%g, %g, %g), expected finite numbers", gltf->json.path, i,
                        mesh, (double)p[0], (double)p[1], (double)p[2]);
        for (unsigned k = 0; k < 3 && primitive->normals.count; k++) n[k] = gltf_float(gltf, &primitive->normals, i, k);
        if (primitive->normals.count && isfinite(n[0]) && isfinite(n[1]) && isfinite(n[2])) memcpy(to->normals + 3 * vertex, n, sizeof n);
        for (unsigned k = 0; k < 2 && primitive->uvs.count; k++) uv[k] = gltf_float(gltf, &primitive->uvs, i, k);
        if (primitive->uvs.count && isfinite(uv[0]) && isfinite(uv[1])) memcpy(to->uvs + 2 * vertex, uv, sizeof uv);
    }
    return true;
}

// Which corner of the primitive is corner k of triangle i (3.7.2.1). In a strip every other triangle is turned round.
static uint32_t corner_of(const struct primitive *primitive, uint32_t i, uint32_t k) {
    if (primitive->mode == MODE_TRIANGLES) return 3 * i + k;
    if (primitive->mode == MODE_FAN) return k == 0 ? 0 : i + k;
    return k == 0 ? i : i % 2 == 0 ? i + k : i + 3 - k;
}

static void fill_triangles(struct import *import, const struct primitive *primitive, uint32_t material) {
    struct scene_mesh *to = &import->model->mesh;
    for (uint32_t i = 0; i < primitive->triangles; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t corner = corner_of(primitive, i, k);
            const uint32_t vertex = primitive->indices.count ? gltf_integer(&import->gltf, &primitive->indices, corner) : corner;
            to->indices[3 * import->triangles + k] = (uint32_t)import->vertices + vertex;
        }
        to->materials[import->triangles++] = material;
    }
}

static bool fill_primitive(struct import *import, const struct primitive *primitive, const struct transform *to_world, uint32_t mesh) {
    uint32_t material, bad;
    const uint32_t first = (uint32_t)import->vertices, count = primitive->positions.count;
    if (!find_material(&material, import, primitive->material) || !fill_vertices(import, primitive, mesh)) return false;
    fill_triangles(import, primitive, material);
    import->vertices += count;
    if (memcmp(to_world, &transform_identity, sizeof *to_world) == 0) return true;
    return mesh_transform(&import->model->mesh, to_world, first, count, &bad) ||
           fail(import->gltf.ctx, GN_SCENE, "%s: the node of meshes[%u] takes vertex %u out of the range of fp32, expected smaller numbers",
                import->gltf.json.path, mesh, bad - first);
}

static bool count_primitive(struct import *import, const struct primitive *primitive) {
    import->vertices += primitive->positions.count;
    import->triangles += primitive->triangles;
    import->has_normals |= primitive->normals.count > 0;
    import->has_uvs |= primitive->uvs.count > 0;
    return mesh_count_allowed(import->gltf.ctx, import->gltf.json.path, import->triangles);
}

// ----------------------------------------------------------------------------------------------------------------- the walk

static void set_column(double out[3], const struct transform *transform, int column, double sign) {
    for (int i = 0; i < 3; i++) out[i] = sign * transform->m[i][column];
}

static bool place_camera(struct import *import, const struct transform *to_world, uint32_t number) {
    double position[3], view[3], up[3];
    struct scene_camera *out = &import->model->cameras[import->model->camera_count];
    const float fov = import->cameras[number].fov_y_deg;
    if (fov == 0) return true;
    set_column(position, to_world, 3, 1), set_column(view, to_world, 2, -1), set_column(up, to_world, 1, 1);
    if (frame_view(out, position, view, up, fov))
        import->model->camera_count++;
    else
        notify(import->gltf.ctx, GN_LEVEL_WARNING, "%s: camera %u cannot be used; it is left out", import->gltf.json.path, number);
    return true;
}

static bool place_light(struct import *import, const struct transform *to_world, uint32_t number) {
    struct scene_light *out = &import->model->lights[import->model->light_count];
    double direction[3], largest = 0;
    bool fits = true;
    *out = import->lights[number];
    set_column(direction, to_world, 2, -1);
    for (int i = 0; i < 3; i++) largest = fmax(largest, fabs(direction[i]));
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float)to_world->m[i][3], out->direction[i] = (float)(direction[i] / largest);
        fits = fits && isfinite(out->position[i]) && (out->type == LIGHT_POINT || isfinite(out->direction[i]));
    }
    if (fits)
        import->model->light_count++;
    else
        notify(import->gltf.ctx, GN_LEVEL_WARNING, "%s: light %u cannot be used; it is left out", import->gltf.json.path, number);
    return true;
}

static bool visit(struct import *import, const struct node *node, const struct transform *to_world) {
    const struct primitive *primitives = import->primitives.items;
    if (node->mesh != GLTF_NONE)
        for (uint32_t i = import->first_primitive[node->mesh]; i < import->first_primitive[node->mesh + 1]; i++)
            if (!(import->filling ? fill_primitive(import, &primitives[i], to_world, node->mesh) : count_primitive(import, &primitives[i])))
                return false;
    return !import->filling || ((node->camera == GLTF_NONE || place_camera(import, to_world, node->camera)) &&
                                (node->light == GLTF_NONE || place_light(import, to_world, node->light)));
}

static bool walk(struct import *import, uint32_t number, const struct transform *parent) {
    struct gltf_item node;
    struct json_at children;
    const struct transform to_world = transform_product(parent, &import->nodes[number].local);
    if (!gltf_get_item(&node, &import->gltf, "nodes", number) || !visit(import, &import->nodes[number], &to_world)) return false;
    if (!at_member(&children, &node.at, "children")) return true;
    for (size_t i = 0; i < json_array_size(children.value); i++)
        if (!walk(import, (uint32_t)json_integer_value(json_array_get(children.value, i)), &to_world)) return false;
    return true;
}

// The roots of the file's scene, or where it has none, all nodes that have no parent.
static bool find_roots(struct import *import, struct array *roots) {
    struct gltf_item scene;
    struct json_at list;
    uint32_t number;
    const bool has_scenes = json_array_size(json_object_get(import->gltf.root.value, "scenes")) > 0;
    if (!gltf_get_index(&import->gltf, &import->gltf.root, "scene", "scenes", &number)) return false;
    if (!has_scenes)
        for (uint32_t i = 0; i < import->node_count; i++) {
            uint32_t *root = import->nodes[i].parent ? NULL : array_push(roots, import->gltf.ctx);
            if (root) *root = i;
            if (!root && !import->nodes[i].parent) return false;
        }
    if (!has_scenes) return true;
    if (!gltf_get_item(&scene, &import->gltf, "scenes", number == GLTF_NONE ? 0 : number)) return false;
    if (!at_member(&list, &scene.at, "nodes")) return true;
    if (!at_list(&list, 0, import->node_count, "a list of nodes")) return false;
    for (size_t i = 0; i < json_array_size(list.value); i++) {
        const struct json_at item = at_item(&list, i);
        const json_int_t root = json_is_integer(item.value) ? json_integer_value(item.value) : -1;
        if (root < 0 || root >= import->node_count) return at_expected(&item, "the number of a node");
        if (import->nodes[root].parent)
            return at_fail(&item, "is node %d, which has a parent or is listed before, expected a root", (int)root);
        import->nodes[root].parent = UINT32_MAX;
        uint32_t *added = array_push(roots, import->gltf.ctx);
        if (!added) return false;
        *added = (uint32_t)root;
    }
    return true;
}

static bool walk_roots(struct import *import, const struct array *roots) {
    const uint32_t *numbers = roots->items;
    for (size_t i = 0; i < roots->count; i++)
        if (!walk(import, numbers[i], &transform_identity)) return false;
    return true;
}

// ---------------------------------------------------------------------------------------------------------------- the model

static bool alloc_model(struct import *import) {
    struct context *ctx = import->gltf.ctx;
    struct model *model = import->model;
    uint32_t cameras = 0, lights = 0;
    for (uint32_t i = 0; i < import->node_count; i++)
        cameras += import->nodes[i].camera != GLTF_NONE, lights += import->nodes[i].light != GLTF_NONE;
    if (!mesh_init(&model->mesh, ctx, import->vertices, import->triangles, import->has_normals)) return false;
    model->mesh.materials = array_alloc(ctx, import->triangles, sizeof *model->mesh.materials, "materials of triangles");
    model->cameras = array_alloc(ctx, cameras, sizeof *model->cameras, "cameras");
    model->lights = array_alloc(ctx, lights, sizeof *model->lights, "lights");
    import->numbers = array_alloc(ctx, (size_t)import->look_count + 1, sizeof *import->numbers, "materials");
    if (!model->mesh.materials || !model->cameras || !model->lights || !import->numbers) return false;
    for (uint32_t i = 0; i <= import->look_count; i++) import->numbers[i] = GLTF_NONE;
    return !import->has_uvs || mesh_add_uvs(&model->mesh, ctx);
}

// A single material for all needs no list; if it is the made-up one, the file has none.
static void take_materials(struct import *import) {
    struct model *model = import->model;
    const size_t count = import->materials.items.count;
    if (count <= 1) {
        free(model->mesh.materials);
        model->mesh.materials = NULL;
    }
    if (count == 1 && import->numbers[import->look_count] == 0) return;
    material_table_take(&import->materials, &model->materials, &model->material_count);
    model->texture_count = (uint32_t)import->textures.count;
    model->textures = array_take(&import->textures);
}

// What is lost without harm to the rest.
static void warn_of_losses(const struct gltf *gltf) {
    static const char *const lost[] = {"skins", "animations"};
    for (size_t i = 0; i < sizeof lost / sizeof *lost; i++)
        if (json_array_size(json_object_get(gltf->root.value, lost[i])) > 0)
            notify(gltf->ctx, GN_LEVEL_WARNING, "%s: %s are not supported; they are left out", gltf->json.path, lost[i]);
}

static bool take_model(struct import *import, const struct array *roots) {
    struct context *ctx = import->gltf.ctx;
    if (!walk_roots(import, roots)) return false;
    if (import->triangles == 0) return fail(ctx, GN_SCENE, "%s: has no triangles, expected at least one", import->gltf.json.path);
    if (!alloc_model(import)) return false;
    import->filling = true;
    import->vertices = import->triangles = 0;
    if (!progress(ctx, "scene", 0.5, -1) || !walk_roots(import, roots)) return false;
    take_materials(import);
    warn_of_losses(&import->gltf);
    return true;
}

static bool read_document(struct import *import) {
    struct array roots = {.item_size = sizeof(uint32_t), .what = "glTF nodes"};
    const bool done = read_lights(import) && read_cameras(import) &&
                      gltf_read_materials(&import->looks, &import->look_count, &import->gltf) && read_meshes(import) &&
                      read_nodes(import) && find_roots(import, &roots) && take_model(import, &roots);
    array_finish(&roots);
    return done;
}

bool model_load_gltf(struct model *out, struct context *ctx, const char *path) {
    struct file_bytes file;
    struct import import = {
        .model = out,
        .materials = MATERIAL_TABLE,
        .textures = {.item_size = sizeof(struct texture_source), .what = "textures"},
        .primitives = {.item_size = sizeof(struct primitive), .what = "glTF meshes"},
    };
    *out = (struct model){0};
    const bool done = gltf_init(&import.gltf, &file, ctx, path) && read_document(&import);
    gltf_finish(&import.gltf);
    texture_sources_finish(import.textures.items, (uint32_t)import.textures.count);
    material_table_finish(&import.materials);
    array_finish(&import.primitives);
    free(import.looks);
    free(import.numbers);
    free(import.first_primitive);
    free(import.cameras);
    free(import.lights);
    free(import.nodes);
    file_bytes_finish(&file);
    if (!done) model_finish(out);
    return done;
}
