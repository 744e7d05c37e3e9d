// Source: Khronos Group, "glTF 2.0 Specification", 2.0.1, 2021; 3.6 (binary data), 5.
#include "scene/gltf_document.h"

#include <string.h>

bool gltf_list(struct json_at *out, const struct gltf *gltf, const char *key, uint32_t *count) {
    *count = 0;
    if (!at_member(out, &gltf->root, key)) return true;
    if (!at_list(out, 0, UINT32_MAX - 1, "a list")) return false;
    *count = (uint32_t)json_array_size(out->value);
    for (uint32_t i = 0; i < *count; i++) {
        const struct json_at at = at_item(out, i);
        if (!json_is_object(at.value)) return at_expected(&at, "an object");
    }
    return true;
}

bool gltf_get_index(const struct gltf *gltf, const struct json_at *object, const char *key, const char *list, uint32_t *index) {
    struct json_at member;
    const size_t count = json_array_size(json_object_get(gltf->root.value, list));
    *index = GLTF_NONE;
    if (!at_member(&member, object, key)) return true;
    if (count == 0) return at_fail(&member, "refers to '%s', of which there are none", list);
    return at_get_count(object, key, 0, (uint32_t)(count - 1), index);
}

bool gltf_get_item(struct gltf_item *out, const struct gltf *gltf, const char *list, uint32_t index) {
    at_member(&out->list, &gltf->root, list);
    out->at = at_item(&out->list, index);
    return json_is_object(out->at.value) || at_expected(&out->at, "an object");
}

bool gltf_get_extension(struct gltf_extension *out, const struct json_at *object, const char *name) {
    out->found = false;
    if (!at_member(&out->extensions, object, "extensions")) return true;
    if (!json_is_object(out->extensions.value)) return at_expected(&out->extensions, "an object");
    out->found = at_member(&out->at, &out->extensions, name);
    return !out->found || json_is_object(out->at.value) || at_expected(&out->at, "an object");
}

// ---------------------------------------------------------------------------------------------------------------- accessors

static unsigned component_size(uint32_t component) { return component == 5126 || component == 5125 ? 4 : component == 5123 ? 2 : 1; }

static bool need_count(const struct json_at *at, const char *key, uint32_t least, uint32_t most, uint32_t *out) {
    return at_require(at, key, "an integer") && at_get_count(at, key, least, most, out);
}

// Where a view is, and its stride, 0 if it has none.
static bool check_view(struct gltf_span *out, size_t *offset, uint32_t *stride, const struct gltf *gltf, const struct json_at *view) {
    uint32_t buffer, skip = 0, length;
    *stride = 0;
    if (!at_require(view, "buffer", "the number of a buffer") || !gltf_get_index(gltf, view, "buffer", "buffers", &buffer) ||
        !at_get_count(view, "byteOffset", 0, UINT32_MAX, &skip) || !need_count(view, "byteLength", 1, UINT32_MAX, &length) ||
        !at_get_count(view, "byteStride", 4, 252, stride))
        return false;
    const struct gltf_place *place = (const struct gltf_place *)gltf->buffers.places.items + buffer;
    if ((uint64_t)skip + length > place->size) return at_fail(view, "ends behind its buffer of %zu bytes", place->size);
    *offset = place->offset + skip;
    *out = (struct gltf_span){(const char *)gltf->buffers.bytes.items + *offset, length};
    return true;
}

bool gltf_get_view(struct gltf_span *out, const struct gltf *gltf, uint32_t number) {
    struct gltf_item view;
    size_t offset;
    uint32_t stride;
    return gltf_get_item(&view, gltf, "bufferViews", number) && check_view(out, &offset, &stride, gltf, &view.at);
}

// The place of an accessor's elements, of `element` bytes each: that they all fit.
static bool place_accessor(struct gltf_accessor *out, const struct gltf *gltf, const struct json_at *accessor, unsigned element) {
    struct gltf_item view;
    struct gltf_span span;
    uint32_t number, stride, skip = 0;
    size_t offset;
    if (!gltf_get_index(gltf, accessor, "bufferView", "bufferViews", &number)) return false;
    if (number == GLTF_NONE) return at_fail(accessor, "has no 'bufferView', expected one: accessors without data are not supported");
    if (!gltf_get_item(&view, gltf, "bufferViews", number) || !check_view(&span, &offset, &stride, gltf, &view.at) ||
        !at_get_count(accessor, "byteOffset", 0, UINT32_MAX, &skip))
        return false;
    out->stride = stride ? stride : element;
    if (skip + out->stride * (uint64_t)(out->count - 1) + element > span.size)
        return at_fail(accessor, "has %u elements, which end behind its buffer view of %zu bytes", out->count, span.size);
    out->offset = offset + skip;
    return true;
}

static bool check_component(const struct json_at *accessor, uint32_t component, enum gltf_components allowed, const char *key) {
    static const char *const names[] = {[GLTF_FLOATS] = "5126 (floats)",
                                        [GLTF_INTEGERS] = "5121, 5123 or 5125 (unsigned integers)",
                                        [GLTF_UNITS] = "5126 (floats), 5121 or 5123 (normalized integers)"};
    const bool integer = component == 5121 || component == 5123;
    const bool fits = allowed == GLTF_FLOATS     ? component == 5126
                      : allowed == GLTF_INTEGERS ? integer || component == 5125
                                                 : integer || component == 5126;
    return fits || at_fail(accessor, "has componentType %u, expected %s for %s", component, names[allowed], key);
}

bool gltf_get_accessor(struct gltf_accessor *out, struct gltf *gltf, const struct json_at *object, const char *key, unsigned width,
                       enum gltf_components components) {
    static const char *const types[] = {NULL, "SCALAR", "VEC2", "VEC3"};
    struct gltf_item item;
    struct json_at sparse;
    uint32_t number;
    const char *type = types[width], *actual = "";
    *out = (struct gltf_accessor){.width = width};
    if (!gltf_get_index(gltf, object, key, "accessors", &number)) return false;
    if (number == GLTF_NONE) return true;
    if (!gltf_get_item(&item, gltf, "accessors", number) || !at_require(&item.at, "type", type) ||
        !at_get_text(&item.at, "type", type, &actual) || !need_count(&item.at, "componentType", 5120, 5126, &out->component) ||
        !need_count(&item.at, "count", 1, UINT32_MAX, &out->count))
        return false;
    if (strcmp(actual, type) != 0) return at_fail(&item.at, "is of type %s, expected %s for %s", actual, type, key);
    if (!check_component(&item.at, out->component, components, key)) return false;
    if (at_member(&sparse, &item.at, "sparse")) return at_fail(&sparse, "is there, but sparse accessors are not supported");
    gltf->elements += out->count;
    if (gltf->elements > 4 * (uint64_t)MOST_PRIMITIVES) return fail(gltf->ctx, GN_LIMIT, "%s: has too many vertices", gltf->json.path);
    return place_accessor(out, gltf, &item.at, component_size(out->component) * width);
}

uint32_t gltf_integer(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t element) {
    const char *at = (const char *)gltf->buffers.bytes.items + accessor->offset + accessor->stride * element;
    uint32_t value = 0;
    for (unsigned k = 0; k < component_size(accessor->component); k++) value |= (uint32_t)(unsigned char)at[k] << (8 * k);
    return value;
}

float gltf_float(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t element, unsigned component) {
    struct gltf_accessor one = *accessor;
    one.offset += (size_t)component * component_size(accessor->component);
    const uint32_t bits = gltf_integer(gltf, &one, element);
    float value;
    if (accessor->component == 5121) return (float)(bits / 255.0);
    if (accessor->component == 5123) return (float)(bits / 65535.0);
    memcpy(&value, &bits, sizeof value);
    return value;
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

bool gltf_init(struct gltf *out, struct file_bytes *file, struct context *ctx, const char *path) {
    struct gltf_span json, binary;
    *out = (struct gltf){.ctx = ctx};
    if (!file_read(file, ctx, path, GN_SCENE)) return false;
    bool done = gltf_container(&json, &binary, ctx, path, file) && json_text_init(&out->json, ctx, path, json.data, json.size);
    out->root = at_root(&out->json);
    done = done && check_asset(out) && gltf_buffers_init(&out->buffers, &out->root, binary);
    if (!done) gltf_finish(out);
    return done;
}

void gltf_finish(struct gltf *gltf) {
    gltf_buffers_finish(&gltf->buffers);
    json_file_finish(&gltf->json);
    *gltf = (struct gltf){0};
}
