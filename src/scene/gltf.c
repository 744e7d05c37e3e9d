// Each pack_… function checks one kind of object of the file and gives back what goes into the GLB, or NULL with the fault reported.
#include "scene/gltf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/gltf_buffers.h"
#include "scene/mesh.h"

#define MODE_TRIANGLES 4 // modes below are points and lines
#define MOST_DEPTH 500   // of the tree of nodes: Assimp walks it by recursion
#define SLACK 256        // zeros behind the buffer: Assimp wants a whole stride for the last element, too
#define LIGHTS "KHR_lights_punctual"

struct gltf {
    struct context *ctx;
    struct json_file json;
    struct json_at root;
    struct gltf_buffers buffers;
    struct json_at extensions, lights_extension, lights; // lights.value is NULL when there are none
    json_t *accessors, *views;                           // of the GLB
    uint64_t elements;                                   // of all accessors so far
    uint32_t *parents;                                   // of each node its parent + 1, 0 for none
    bool no_memory;                                      // jansson had none: some value is missing
};

// Adds a member or an item, whose reference it takes over.
static void put(struct gltf *gltf, json_t *container, const char *key, json_t *value) {
    const int failed = key ? json_object_set_new(container, key, value) : json_array_append_new(container, value);
    if (failed) gltf->no_memory = true;
}

// A member that is the number of an item in a list of the root. *found is false when the member is missing.
static bool get_index(const struct gltf *gltf, const struct json_at *object, const char *key, const char *list, uint32_t *index,
                      bool *found) {
    struct json_at member;
    const size_t count = json_array_size(json_object_get(gltf->root.value, list));
    *found = at_member(&member, object, key);
    if (*found && count == 0) return at_fail(&member, "refers to '%s', of which there are none", list);
    return !*found || at_get_count(object, key, 0, (uint32_t)(count - 1), index);
}

// An item of a list of the root, which must be an object.
struct item {
    struct json_at list, at;
};
static bool get_item(struct item *out, const struct gltf *gltf, const char *list, uint32_t index) {
    at_member(&out->list, &gltf->root, list);
    out->at = at_item(&out->list, index);
    return json_is_object(out->at.value) || at_expected(&out->at, "an object");
}

// Packs every item of a list of the root. A list that is missing is empty.
static bool pack_list(json_t *out, struct gltf *gltf, const char *key, json_t *(*pack)(struct gltf *, const struct json_at *)) {
    struct json_at list;
    json_t *packed = json_array();
    put(gltf, out, key, packed);
    if (!at_member(&list, &gltf->root, key)) return true;
    if (!at_list(&list, 0, UINT32_MAX, "a list")) return false;
    for (size_t i = 0; i < json_array_size(list.value); i++) {
        const struct json_at at = at_item(&list, i);
        json_t *item = json_is_object(at.value) ? pack(gltf, &at) : NULL;
        if (!item && !json_is_object(at.value)) at_expected(&at, "an object");
        if (!item) return false;
        put(gltf, packed, NULL, item);
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------------- accessors

struct accessor {
    size_t offset, stride; // in the buffers, bytes
    uint32_t count;
    uint32_t component; // componentType
    const char *type;
};

static unsigned component_size(uint32_t component) { return component == 5126 || component == 5125 ? 4 : component == 5123 ? 2 : 1; }

static bool need_count(const struct json_at *at, const char *key, uint32_t least, uint32_t most, uint32_t *out) {
    return at_require(at, key, "an integer") && at_get_count(at, key, least, most, out);
}

// The view of an accessor: where its elements begin, and that they all fit.
static bool check_view(struct accessor *out, const struct gltf *gltf, const struct json_at *accessor, uint64_t element) {
    struct item view;
    uint32_t number, buffer, offset = 0, length, stride = 0, skip = 0;
    bool found;
    if (!get_index(gltf, accessor, "bufferView", "bufferViews", &number, &found)) return false;
    if (!found) return at_fail(accessor, "has no 'bufferView', expected one: accessors without data are not supported");
    if (!get_item(&view, gltf, "bufferViews", number) || !at_require(&view.at, "buffer", "the number of a buffer") ||
        !get_index(gltf, &view.at, "buffer", "buffers", &buffer, &found) || !at_get_count(&view.at, "byteOffset", 0, UINT32_MAX, &offset) ||
        !need_count(&view.at, "byteLength", 1, UINT32_MAX, &length) || !at_get_count(&view.at, "byteStride", 4, 252, &stride) ||
        !at_get_count(accessor, "byteOffset", 0, UINT32_MAX, &skip))
        return false;
    const struct gltf_place *place = (const struct gltf_place *)gltf->buffers.places.items + buffer;
    if ((uint64_t)offset + length > place->size) return at_fail(&view.at, "ends behind its buffer of %zu bytes", place->size);
    out->stride = stride ? stride : element;
    if (skip + out->stride * (uint64_t)(out->count - 1) + element > length)
        return at_fail(accessor, "has %u elements, which end behind its buffer view of %u bytes", out->count, length);
    out->offset = place->offset + offset + skip;
    return true;
}

// The accessor that attribute `key` of an object names. `components` of type `type`; integers allowed instead of floats or not.
static bool check_accessor(struct accessor *out, bool *found, struct gltf *gltf, const struct json_at *object, const char *key,
                           const char *type, bool integers) {
    struct item item;
    uint32_t number;
    struct json_at sparse;
    *out = (struct accessor){.type = type};
    if (!get_index(gltf, object, key, "accessors", &number, found) || !*found) return !*found;
    const char *actual = "";
    if (!get_item(&item, gltf, "accessors", number) || !at_require(&item.at, "type", type) ||
        !at_get_text(&item.at, "type", type, &actual) || !need_count(&item.at, "componentType", 5120, 5126, &out->component) ||
        !need_count(&item.at, "count", 1, UINT32_MAX, &out->count))
        return false;
    const uint32_t c = out->component;
    if (strcmp(actual, type) != 0) return at_fail(&item.at, "is of type %s, expected %s for %s", actual, type, key);
    if (integers ? c != 5121 && c != 5123 && c != 5125 : c != 5126)
        return at_fail(&item.at, "has componentType %u, expected %s for %s", c,
                       integers ? "5121, 5123 or 5125 (unsigned integers)" : "5126 (floats)", key);
    if (at_member(&sparse, &item.at, "sparse")) return at_fail(&sparse, "is there, but sparse accessors are not supported");
    gltf->elements += out->count;
    if (gltf->elements > 3 * (uint64_t)MOST_PRIMITIVES) return fail(gltf->ctx, GN_LIMIT, "%s: has too many vertices", gltf->json.path);
    return check_view(out, gltf, &item.at, component_size(c) * (integers ? 1u : 3u));
}

// The number of a new accessor of the GLB.
static json_t *pack_accessor(struct gltf *gltf, const struct accessor *accessor) {
    const size_t element = component_size(accessor->component) * (strcmp(accessor->type, "VEC3") == 0 ? 3u : 1u);
    json_t *view = json_object(), *packed = json_object();
    put(gltf, view, "buffer", json_integer(0));
    put(gltf, view, "byteOffset", json_integer((json_int_t)accessor->offset));
    put(gltf, view, "byteLength", json_integer((json_int_t)(accessor->stride * accessor->count)));
    if (accessor->stride != element) put(gltf, view, "byteStride", json_integer((json_int_t)accessor->stride));
    put(gltf, packed, "bufferView", json_integer((json_int_t)json_array_size(gltf->views)));
    put(gltf, packed, "componentType", json_integer(accessor->component));
    put(gltf, packed, "count", json_integer(accessor->count));
    put(gltf, packed, "type", json_string(accessor->type));
    put(gltf, gltf->views, NULL, view);
    put(gltf, gltf->accessors, NULL, packed);
    return json_integer((json_int_t)json_array_size(gltf->accessors) - 1);
}

// Whether every index is that of a vertex.
static bool check_indices(const struct gltf *gltf, const struct json_at *primitive, const struct accessor *indices, uint32_t vertices) {
    const unsigned size = component_size(indices->component);
    const unsigned char *at = (const unsigned char *)gltf->buffers.bytes.items + indices->offset;
    for (uint32_t i = 0; i < indices->count; i++, at += indices->stride) {
        uint32_t index = 0;
        for (unsigned k = 0; k < size; k++) index |= (uint32_t)at[k] << (8 * k);
        if (index >= vertices) return at_fail(primitive, "has index %u at %u, expected at most %u", index, i, vertices - 1);
    }
    return true;
}

// ------------------------------------------------------------------------------------------------------------------- meshes

// Packs a primitive into *out, which stays NULL for points and lines.
static bool pack_primitive(json_t **out, struct gltf *gltf, const struct json_at *at) {
    struct json_at attributes;
    struct accessor positions, normals, indices;
    bool has_positions, has_normals, has_indices, has_material;
    uint32_t mode = MODE_TRIANGLES, material;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_get_count(at, "mode", 0, 6, &mode)) return false;
    if (mode < MODE_TRIANGLES) return true;
    if (!at_require(at, "attributes", "an object") || !at_member(&attributes, at, "attributes")) return false;
    if (!json_is_object(attributes.value)) return at_expected(&attributes, "an object");
    if (!check_accessor(&positions, &has_positions, gltf, &attributes, "POSITION", "VEC3", false) ||
        !check_accessor(&normals, &has_normals, gltf, &attributes, "NORMAL", "VEC3", false) ||
        !check_accessor(&indices, &has_indices, gltf, at, "indices", "SCALAR", true) ||
        !get_index(gltf, at, "material", "materials", &material, &has_material))
        return false;
    if (!has_positions) return at_fail(&attributes, "has no 'POSITION', expected one");
    if (has_normals && normals.count != positions.count)
        return at_fail(&attributes, "has %u positions and %u normals, expected as many", positions.count, normals.count);
    if (has_indices && !check_indices(gltf, at, &indices, positions.count)) return false;
    const uint32_t corners = has_indices ? indices.count : positions.count;
    if (corners < 3) return at_fail(at, "has %u corners, expected at least 3 for triangles", corners);
    json_t *packed_attributes = json_object();
    put(gltf, packed_attributes, "POSITION", pack_accessor(gltf, &positions));
    if (has_normals) put(gltf, packed_attributes, "NORMAL", pack_accessor(gltf, &normals));
    *out = json_object();
    put(gltf, *out, "mode", json_integer(mode));
    put(gltf, *out, "attributes", packed_attributes);
    if (has_indices) put(gltf, *out, "indices", pack_accessor(gltf, &indices));
    if (has_material) put(gltf, *out, "material", json_integer(material));
    return true;
}

static json_t *pack_mesh(struct gltf *gltf, const struct json_at *at) {
    struct json_at primitives;
    if (!at_require(at, "primitives", "a list") || !at_member(&primitives, at, "primitives") ||
        !at_list(&primitives, 0, UINT32_MAX, "a list of primitives"))
        return NULL;
    json_t *packed = json_object(), *list = json_array();
    put(gltf, packed, "primitives", list);
    for (size_t i = 0; i < json_array_size(primitives.value); i++) {
        const struct json_at primitive = at_item(&primitives, i);
        json_t *item = NULL;
        if (!pack_primitive(&item, gltf, &primitive)) {
            json_decref(packed);
            return NULL;
        }
        if (item) put(gltf, list, NULL, item);
    }
    return packed;
}

static json_t *pack_material(struct gltf *gltf, const struct json_at *at) {
    struct json_at pbr;
    char number[32];
    snprintf(number, sizeof number, "material %zu", at->index);
    const char *name = number;
    float color[4] = {1, 1, 1, 1}, metallic = 1, roughness = 1;
    if (!at_get_text(at, "name", "a string", &name)) return NULL;
    if (at_member(&pbr, at, "pbrMetallicRoughness")) {
        struct json_at factor;
        if (!json_is_object(pbr.value)) return at_expected(&pbr, "an object"), NULL;
        if (!at_get_float(&pbr, "metallicFactor", RANGE_NOT_NEGATIVE, &metallic) ||
            !at_get_float(&pbr, "roughnessFactor", RANGE_NOT_NEGATIVE, &roughness))
            return NULL;
        if (at_member(&factor, &pbr, "baseColorFactor")) {
            if (!at_list(&factor, 4, 4, "a list of 4 numbers")) return NULL;
            for (size_t i = 0; i < 4; i++) {
                const struct json_at item = at_item(&factor, i);
                if (!at_float(&item, RANGE_NOT_NEGATIVE, &color[i])) return NULL;
            }
        }
    }
    json_t *packed = json_object(), *packed_pbr = json_object(), *packed_color = json_array();
    for (int i = 0; i < 4; i++) put(gltf, packed_color, NULL, json_real(color[i]));
    put(gltf, packed_pbr, "baseColorFactor", packed_color);
    put(gltf, packed_pbr, "metallicFactor", json_real(metallic));
    put(gltf, packed_pbr, "roughnessFactor", json_real(roughness));
    put(gltf, packed, "name", json_string(*name ? name : number));
    put(gltf, packed, "pbrMetallicRoughness", packed_pbr);
    return packed;
}

// -------------------------------------------------------------------------------------------------------- cameras and lights

static bool is_kind(const json_t *object, const char *type) {
    const char *actual = json_string_value(json_object_get(object, "type"));
    return actual && strcmp(actual, type) == 0;
}

// A camera that is not perspective keeps its place in the list, but no node gets it.
static json_t *pack_camera(struct gltf *gltf, const struct json_at *at) {
    struct json_at perspective;
    float fov = 1;
    if (is_kind(at->value, "perspective")) {
        if (!at_require(at, "perspective", "an object") || !at_member(&perspective, at, "perspective")) return NULL;
        if (!json_is_object(perspective.value)) return at_expected(&perspective, "an object"), NULL;
        if (!at_require(&perspective, "yfov", "an angle") || !at_get_float(&perspective, "yfov", RANGE_POSITIVE, &fov)) return NULL;
        if (fov > 3.1415f) return at_fail(&perspective, "has a yfov of %g, expected less than 3.1415", (double)fov), NULL;
    }
    json_t *packed = json_object(), *lens = json_object();
    put(gltf, lens, "yfov", json_real(fov));
    put(gltf, lens, "aspectRatio", json_real(1));
    put(gltf, lens, "znear", json_real(0.01));
    put(gltf, packed, "type", json_string("perspective"));
    put(gltf, packed, "perspective", lens);
    return packed;
}

static json_t *pack_light(struct gltf *gltf, const struct json_at *at) {
    float color[3] = {1, 1, 1}, intensity = 1;
    if (!json_is_object(at->value)) return at_expected(at, "an object"), NULL;
    if (!at_get_float3(at, "color", RANGE_NOT_NEGATIVE, color) || !at_get_float(at, "intensity", RANGE_NOT_NEGATIVE, &intensity))
        return NULL;
    json_t *packed = json_object(), *packed_color = json_array();
    for (int i = 0; i < 3; i++) put(gltf, packed_color, NULL, json_real(color[i]));
    put(gltf, packed, "type", json_string("point"));
    put(gltf, packed, "color", packed_color);
    put(gltf, packed, "intensity", json_real(intensity));
    return packed;
}

static bool pack_lights(json_t *out, struct gltf *gltf) {
    json_t *extensions = json_object(), *extension = json_object(), *lights = json_array(), *used = json_array();
    put(gltf, extension, "lights", lights);
    put(gltf, extensions, LIGHTS, extension);
    put(gltf, out, "extensions", extensions);
    put(gltf, used, NULL, json_string(LIGHTS));
    put(gltf, out, "extensionsUsed", used);
    if (!at_member(&gltf->extensions, &gltf->root, "extensions") || !at_member(&gltf->lights_extension, &gltf->extensions, LIGHTS) ||
        !at_member(&gltf->lights, &gltf->lights_extension, "lights"))
        return true;
    if (!at_list(&gltf->lights, 0, UINT32_MAX, "a list of lights")) return false;
    for (size_t i = 0; i < json_array_size(gltf->lights.value); i++) {
        const struct json_at at = at_item(&gltf->lights, i);
        json_t *light = pack_light(gltf, &at);
        if (!light) return false;
        put(gltf, lights, NULL, light);
    }
    return true;
}

// -------------------------------------------------------------------------------------------------------------------- nodes

static bool pack_numbers(json_t *out, struct gltf *gltf, const struct json_at *node, const char *key, size_t count) {
    struct json_at list;
    char expected[32];
    snprintf(expected, sizeof expected, "a list of %zu numbers", count);
    if (!at_member(&list, node, key)) return true;
    if (!at_list(&list, count, count, expected)) return false;
    json_t *numbers = json_array();
    put(gltf, out, key, numbers);
    for (size_t i = 0; i < count; i++) {
        const struct json_at item = at_item(&list, i);
        float value;
        if (!at_float(&item, RANGE_ANY, &value)) return false;
        put(gltf, numbers, NULL, json_real(value));
    }
    return true;
}

static bool pack_children(json_t *out, struct gltf *gltf, const struct json_at *node) {
    struct json_at children;
    const size_t count = json_array_size(json_object_get(gltf->root.value, "nodes"));
    if (!at_member(&children, node, "children")) return true;
    if (!at_list(&children, 0, count, "a list of nodes")) return false;
    json_t *packed = json_array();
    put(gltf, out, "children", packed);
    for (size_t i = 0; i < json_array_size(children.value); i++) {
        const struct json_at item = at_item(&children, i);
        const json_int_t child = json_is_integer(item.value) ? json_integer_value(item.value) : -1;
        if (child < 0 || (size_t)child >= count) return at_expected(&item, "the number of a node");
        if (gltf->parents[child]) return at_fail(&item, "is node %d, which has a parent already, expected a tree", (int)child);
        gltf->parents[child] = (uint32_t)node->index + 1;
        put(gltf, packed, NULL, json_integer(child));
    }
    return true;
}

// Only a point light is one of ours.
static bool pack_node_light(json_t *out, struct gltf *gltf, const struct json_at *node) {
    struct json_at extensions, extension, light;
    if (!at_member(&extensions, node, "extensions") || !at_member(&extension, &extensions, LIGHTS) ||
        !at_member(&light, &extension, "light"))
        return true;
    const json_int_t number = json_is_integer(light.value) ? json_integer_value(light.value) : -1;
    if (number < 0 || (size_t)number >= json_array_size(gltf->lights.value)) return at_expected(&light, "the number of a light");
    const json_t *kind = json_array_get(gltf->lights.value, (size_t)number);
    if (!is_kind(kind, "point")) {
        const char *type = json_string_value(json_object_get(kind, "type"));
        notify(gltf->ctx, GN_LEVEL_WARNING, "%s: light %d is of type '%.40s', only point lights are supported; it is left out",
               gltf->json.path, (int)number, type ? type : "?");
        return true;
    }
    json_t *packed_extensions = json_object(), *packed = json_object();
    put(gltf, packed, "light", json_integer(number));
    put(gltf, packed_extensions, LIGHTS, packed);
    put(gltf, out, "extensions", packed_extensions);
    return true;
}

static bool pack_node_parts(json_t *out, struct gltf *gltf, const struct json_at *node) {
    uint32_t mesh, camera;
    bool has_mesh, has_camera;
    char name[32];
    snprintf(name, sizeof name, "node %zu", node->index);
    put(gltf, out, "name", json_string(name));
    if (!pack_numbers(out, gltf, node, "matrix", 16) || !pack_numbers(out, gltf, node, "translation", 3) ||
        !pack_numbers(out, gltf, node, "rotation", 4) || !pack_numbers(out, gltf, node, "scale", 3) || !pack_children(out, gltf, node) ||
        !pack_node_light(out, gltf, node) || !get_index(gltf, node, "mesh", "meshes", &mesh, &has_mesh) ||
        !get_index(gltf, node, "camera", "cameras", &camera, &has_camera))
        return false;
    if (has_mesh) put(gltf, out, "mesh", json_integer(mesh));
    if (!has_camera) return true;
    if (is_kind(json_array_get(json_object_get(gltf->root.value, "cameras"), camera), "perspective"))
        put(gltf, out, "camera", json_integer(camera));
    else
        notify(gltf->ctx, GN_LEVEL_WARNING, "%s: camera %u is not perspective; it is left out", gltf->json.path, camera);
    return true;
}

static json_t *pack_node(struct gltf *gltf, const struct json_at *node) {
    json_t *packed = json_object();
    if (pack_node_parts(packed, gltf, node)) return packed;
    json_decref(packed);
    return NULL;
}

// Nodes with a parent each make a forest, unless some go round in a circle.
static bool check_depth(const struct gltf *gltf, size_t count) {
    for (size_t i = 0; i < count; i++) {
        unsigned depth = 0;
        for (uint32_t up = gltf->parents[i]; up; up = gltf->parents[up - 1]) {
            if (++depth <= MOST_DEPTH) continue;
            struct item item;
            return get_item(&item, gltf, "nodes", (uint32_t)i) &&
                   at_fail(&item.at, "is its own parent or has more than %d above it, expected a tree", MOST_DEPTH);
        }
    }
    return true;
}

// The nodes of the file's scene, or where it has none, all that have no parent.
static bool pack_scene(json_t *out, struct gltf *gltf, size_t node_count) {
    struct item scene;
    struct json_at list;
    uint32_t number = 0;
    bool found;
    json_t *roots = json_array(), *packed = json_object(), *scenes = json_array();
    put(gltf, packed, "nodes", roots);
    put(gltf, scenes, NULL, packed);
    put(gltf, out, "scenes", scenes);
    put(gltf, out, "scene", json_integer(0));
    if (!get_index(gltf, &gltf->root, "scene", "scenes", &number, &found)) return false;
    if (!found && json_array_size(json_object_get(gltf->root.value, "scenes")) == 0) {
        for (size_t i = 0; i < node_count; i++)
            if (!gltf->parents[i]) put(gltf, roots, NULL, json_integer((json_int_t)i));
        return true;
    }
    if (!get_item(&scene, gltf, "scenes", number)) return false;
    if (!at_member(&list, &scene.at, "nodes")) return true;
    if (!at_list(&list, 0, node_count, "a list of nodes")) return false;
    for (size_t i = 0; i < json_array_size(list.value); i++) {
        const struct json_at item = at_item(&list, i);
        const json_int_t root = json_is_integer(item.value) ? json_integer_value(item.value) : -1;
        if (root < 0 || (size_t)root >= node_count) return at_expected(&item, "the number of a node");
        if (gltf->parents[root]) return at_fail(&item, "is node %d, which has a parent or is listed before, expected a root", (int)root);
        gltf->parents[root] = UINT32_MAX;
        put(gltf, roots, NULL, json_integer(root));
    }
    return true;
}

// ----------------------------------------------------------------------------------------------------------------- the file

static bool check_asset(const struct gltf *gltf) {
    struct json_at asset, required;
    const char *version = "";
    if (!json_is_object(gltf->root.value)) return at_expected(&gltf->root, "an object");
    if (!at_require(&gltf->root, "asset", "an object") || !at_member(&asset, &gltf->root, "asset")) return false;
    if (!json_is_object(asset.value)) return at_expected(&asset, "an object");
    if (!at_require(&asset, "version", "\"2.0\"") || !at_get_text(&asset, "version", "\"2.0\"", &version)) return false;
    if (strncmp(version, "2.", 2) != 0) return at_fail(&asset, "is of version \"%.16s\", expected \"2.0\"", version);
    if (!at_member(&required, &gltf->root, "extensionsRequired")) return true;
    static const char *const geometry[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization"};
    for (size_t i = 0; i < json_array_size(required.value); i++) {
        const struct json_at item = at_item(&required, i);
        const char *name = json_string_value(item.value);
        for (size_t k = 0; name && k < sizeof geometry / sizeof *geometry; k++)
            if (strcmp(name, geometry[k]) == 0) return at_fail(&item, "is %s, which is not supported", name);
    }
    return true;
}

// What is lost without harm to the geometry.
static void warn_of_losses(const struct gltf *gltf) {
    static const char *const lost[] = {"textures", "skins", "animations"};
    for (size_t i = 0; i < sizeof lost / sizeof *lost; i++)
        if (json_array_size(json_object_get(gltf->root.value, lost[i])) > 0)
            notify(gltf->ctx, GN_LEVEL_WARNING, "%s: %s are not supported; they are left out", gltf->json.path, lost[i]);
}

static bool pack_document(json_t *out, struct gltf *gltf) {
    const size_t node_count = json_array_size(json_object_get(gltf->root.value, "nodes"));
    gltf->parents = array_alloc(gltf->ctx, node_count, sizeof *gltf->parents, "glTF nodes");
    json_t *asset = json_object(), *buffer = json_object(), *buffers = json_array();
    put(gltf, asset, "version", json_string("2.0"));
    put(gltf, out, "asset", asset);
    put(gltf, buffer, "byteLength", json_integer((json_int_t)(gltf->buffers.bytes.count + SLACK)));
    put(gltf, buffers, NULL, buffer);
    put(gltf, out, "buffers", buffers);
    put(gltf, out, "accessors", gltf->accessors = json_array());
    put(gltf, out, "bufferViews", gltf->views = json_array());
    return gltf->parents && pack_lights(out, gltf) && pack_list(out, gltf, "cameras", pack_camera) &&
           pack_list(out, gltf, "materials", pack_material) && pack_list(out, gltf, "meshes", pack_mesh) &&
           pack_list(out, gltf, "nodes", pack_node) && check_depth(gltf, node_count) && pack_scene(out, gltf, node_count);
}

static void store(char *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (char)(value >> (8 * i) & 0xff);
}

static bool write_glb(struct file_bytes *out, struct gltf *gltf, const json_t *document) {
    char *text = json_dumps(document, JSON_COMPACT);
    const size_t length = text ? strlen(text) : 0, padded = (length + 3) / 4 * 4, binary = gltf->buffers.bytes.count + SLACK;
    const size_t size = 12 + 8 + padded + 8 + binary;
    if (!text || gltf->no_memory || size > UINT32_MAX) {
        free(text);
        return fail(gltf->ctx, GN_LIMIT, "%s: is too large, or memory is too small", gltf->json.path);
    }
    out->data = array_alloc(gltf->ctx, size + 1, 1, "a glTF file");
    out->size = out->data ? size : 0;
    if (out->data) {
        char *to = out->data;
        memcpy(to, "glTF", 4), store(to + 4, 2), store(to + 8, (uint32_t)size);
        store(to + 12, (uint32_t)padded), memcpy(to + 16, "JSON", 4);
        memset(to + 20, ' ', padded), memcpy(to + 20, text, length);
        to += 20 + padded;
        store(to, (uint32_t)binary), memcpy(to + 4, "BIN", 4);
        if (gltf->buffers.bytes.count > 0) memcpy(to + 8, gltf->buffers.bytes.items, gltf->buffers.bytes.count);
    }
    free(text);
    return out->data != NULL;
}

static bool repack(struct file_bytes *out, struct gltf *gltf, struct gltf_span binary) {
    json_t *document = json_object();
    const bool done = check_asset(gltf) && gltf_buffers_init(&gltf->buffers, &gltf->root, binary) && pack_document(document, gltf) &&
                      write_glb(out, gltf, document);
    if (done) warn_of_losses(gltf);
    json_decref(document);
    gltf_buffers_finish(&gltf->buffers);
    free(gltf->parents);
    return done;
}

bool gltf_repack(struct file_bytes *out, struct context *ctx, const char *path) {
    *out = (struct file_bytes){0};
    struct file_bytes file;
    struct gltf gltf = {.ctx = ctx};
    struct gltf_span json, binary;
    if (!file_read(&file, ctx, path, GN_SCENE)) return false;
    bool done = gltf_container(&json, &binary, ctx, path, &file) && json_text_init(&gltf.json, ctx, path, json.data, json.size);
    if (done) {
        gltf.root = at_root(&gltf.json);
        done = repack(out, &gltf, binary);
    }
    json_file_finish(&gltf.json);
    file_bytes_finish(&file);
    return done;
}
