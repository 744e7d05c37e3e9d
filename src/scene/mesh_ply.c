// Meshes from PLY files: ascii, or binary in either byte order. Elements and properties that we have no use for are skipped, whatever they
// are. Source: G. Turk, "The PLY Polygon File Format", 1994.
#include "scene/import.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/mesh.h"
#include "scene/ply_header.h"
#include "scene/text.h"

// A file being read.
struct ply {
    struct text text;
    struct ply_header header;
    const struct ply_element *element; // being read
    uint64_t row;
    struct scene_mesh *mesh;
    struct array triangles; // 3 vertex numbers each
};

// Reports a fault at `at`: "file:line:column" in a text, "file: byte N" in a binary file.
static bool ply_fail(const struct ply *ply, const char *at, const char *message) {
    char where[160];
    snprintf(where, sizeof where, "%.*s %llu of %llu: %s", (int)(ply->element->name.size < 40 ? ply->element->name.size : 40),
             ply->element->name.at, (unsigned long long)ply->row, (unsigned long long)ply->element->count, message);
    if (ply->header.format == PLY_ASCII) return text_fail(&ply->text, at, "%s", where);
    return fail(ply->text.ctx, GN_SCENE, "%s: byte %zu: %s", ply->text.path, (size_t)(at - ply->text.begin), where);
}

// ------------------------------------------------------------------------------------------------------------------- values

// The next `size` bytes of a binary file, as the bits of a little-endian number.
static bool next_bits(struct ply *ply, unsigned size, uint64_t *bits) {
    if ((size_t)(ply->text.end - ply->text.at) < size) return ply_fail(ply, ply->text.end, "the file ends here, expected more data");
    const unsigned char *bytes = (const unsigned char *)ply->text.at;
    *bits = 0;
    for (unsigned i = 0; i < size; i++) {
        const unsigned shift = ply->header.format == PLY_BIG_ENDIAN ? size - 1 - i : i;
        *bits |= (uint64_t)bytes[i] << (8 * shift);
    }
    ply->text.at += size;
    return true;
}

static double value_of_bits(enum ply_type type, uint64_t bits) {
    float single;
    double real;
    const uint32_t low = (uint32_t)bits;
    switch (type) {
    case PLY_INT8:
        return (double)((int64_t)(bits ^ 0x80) - 0x80); // the sign bit counts negative
    case PLY_INT16:
        return (double)((int64_t)(bits ^ 0x8000) - 0x8000);
    case PLY_INT32:
        return (double)((int64_t)(bits ^ 0x80000000u) - INT64_C(0x80000000));
    case PLY_FLOAT32:
        memcpy(&single, &low, sizeof single);
        return single;
    case PLY_FLOAT64:
        memcpy(&real, &bits, sizeof real);
        return real;
    default:
        return (double)bits;
    }
}

// The next value, a coordinate.
static bool next_float(struct ply *ply, enum ply_type type, float *out, const char *what) {
    uint64_t bits;
    if (ply->header.format == PLY_ASCII) {
        text_skip_space(&ply->text);
        return text_float(&ply->text, out, what);
    }
    const char *start = ply->text.at;
    if (!next_bits(ply, ply_type_size(type), &bits)) return false;
    const double value = value_of_bits(type, bits);
    if (!(fabs(value) < FLT_MAX + 0x1p103)) { // from here on rounding gives infinity
        char message[96];
        snprintf(message, sizeof message, "%s is %g, expected a finite number within the range of fp32", what, value);
        return ply_fail(ply, start, message);
    }
    *out = (float)value;
    return true;
}

// The next value, of an integer type.
static bool next_integer(struct ply *ply, enum ply_type type, int64_t *out, const char *what) {
    uint64_t bits;
    if (ply->header.format == PLY_ASCII) {
        text_skip_space(&ply->text);
        return text_integer(&ply->text, out, what);
    }
    if (!next_bits(ply, ply_type_size(type), &bits)) return false;
    *out = (int64_t)value_of_bits(type, bits);
    return true;
}

static bool skip_values(struct ply *ply, enum ply_type type, uint64_t count) {
    if (ply->header.format != PLY_ASCII) {
        const uint64_t left = (uint64_t)(ply->text.end - ply->text.at);
        if (count > left / ply_type_size(type)) return ply_fail(ply, ply->text.end, "the file ends here, expected more data");
        ply->text.at += count * ply_type_size(type);
        return true;
    }
    for (; count > 0; count--) {
        text_skip_space(&ply->text);
        const size_t length = text_word(&ply->text);
        if (length == 0) return ply_fail(ply, ply->text.end, "the file ends here, expected more data");
        ply->text.at += length;
    }
    return true;
}

static bool skip_property(struct ply *ply, const struct ply_property *property) {
    int64_t count = 1;
    if (property->is_list) {
        const char *start = ply->text.at;
        if (!next_integer(ply, property->count_type, &count, "length of a list")) return false;
        if (count < 0) return ply_fail(ply, start, "a list of negative length, expected 0 or more");
    }
    return skip_values(ply, property->type, (uint64_t)count);
}

// ----------------------------------------------------------------------------------------------------------------- elements

// What a property of a vertex can be to us. Programs do not agree on the names of texture coordinates.
enum role { ROLE_POSITION, ROLE_NORMAL = 3, ROLE_UV = 6, NO_ROLE = 8 };

static const struct {
    const char *name;
    unsigned char role;
} vertex_names[] = {{"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3},        {"ny", 4},        {"nz", 5},        {"s", 6},
                    {"t", 7}, {"u", 6}, {"v", 7}, {"texture_u", 6}, {"texture_v", 7}, {"texture_s", 6}, {"texture_t", 7}};

static unsigned char find_role(const struct ply_property *property) {
    for (size_t i = 0; i < sizeof vertex_names / sizeof *vertex_names; i++)
        if (ply_word_is(property->name, vertex_names[i].name)) return vertex_names[i].role;
    return NO_ROLE;
}

// The role of each of the element's properties; normals and texture coordinates count only if they are whole.
static bool find_roles(unsigned char *roles, bool has[NO_ROLE], const struct ply *ply, const struct ply_element *element) {
    for (int k = 0; k < NO_ROLE; k++) has[k] = false;
    for (size_t i = 0; i < element->property_count; i++) {
        const struct ply_property *property = ply_property_at(&ply->header, element->first + i);
        roles[i] = find_role(property);
        if (roles[i] < ROLE_UV && property->is_list)
            return text_fail(&ply->text, property->name.at, "property %s is a list, expected a number", vertex_names[roles[i]].name);
        if (property->is_list || (roles[i] < NO_ROLE && has[roles[i]])) roles[i] = NO_ROLE; // "s" and "u" both: the first counts
        if (roles[i] < NO_ROLE) has[roles[i]] = true;
    }
    has[ROLE_NORMAL] = has[ROLE_NORMAL] && has[ROLE_NORMAL + 1] && has[ROLE_NORMAL + 2];
    has[ROLE_UV] = has[ROLE_UV] && has[ROLE_UV + 1];
    for (size_t i = 0; i < element->property_count; i++)
        if ((roles[i] >= ROLE_NORMAL && roles[i] < ROLE_UV && !has[ROLE_NORMAL]) || (roles[i] >= ROLE_UV && !has[ROLE_UV]))
            roles[i] = NO_ROLE;
    for (int k = 0; k < 3; k++)
        if (!has[k])
            return text_fail(&ply->text, element->name.at, "the vertices have no property %s, expected x, y and z", vertex_names[k].name);
    return true;
}

static bool read_vertex(struct ply *ply, const unsigned char *roles) {
    float values[NO_ROLE] = {0};
    for (size_t i = 0; i < ply->element->property_count; i++) {
        const struct ply_property *property = ply_property_at(&ply->header, ply->element->first + i);
        if (roles[i] == NO_ROLE ? !skip_property(ply, property)
                                : !next_float(ply, property->type, &values[roles[i]], vertex_names[roles[i]].name))
            return false;
    }
    memcpy(ply->mesh->positions + 3 * ply->row, values, 3 * sizeof(float));
    if (ply->mesh->normals) memcpy(ply->mesh->normals + 3 * ply->row, values + ROLE_NORMAL, 3 * sizeof(float));
    if (ply->mesh->uvs) {
        float *uv = ply->mesh->uvs + 2 * ply->row;
        uv[0] = values[ROLE_UV], uv[1] = 1 - values[ROLE_UV + 1]; // the file's v goes up
    }
    return true;
}

static bool read_vertices(struct ply *ply) {
    bool has[NO_ROLE];
    unsigned char *roles = array_alloc(ply->text.ctx, ply->element->property_count, 1, "PLY properties");
    bool done = roles && find_roles(roles, has, ply, ply->element);
    done = done && mesh_init(ply->mesh, ply->text.ctx, ply->element->count, 0, has[ROLE_NORMAL]);
    done = done && (!has[ROLE_UV] || mesh_add_uvs(ply->mesh, ply->text.ctx));
    for (ply->row = 0; done && ply->row < ply->element->count; ply->row++) {
        if (ply->row % 65536 == 0) done = text_progress(&ply->text);
        done = done && read_vertex(ply, roles);
    }
    free(roles);
    return done;
}

static bool is_face_list(const struct ply_property *property) {
    return ply_word_is(property->name, "vertex_indices") || ply_word_is(property->name, "vertex_index");
}

// Reads a polygon and fans it around its first vertex.
static bool read_polygon(struct ply *ply, const struct ply_property *list, uint64_t vertex_count) {
    int64_t count, index;
    uint32_t first = 0, last = 0;
    char message[128];
    const char *start = ply->text.at;
    if (!next_integer(ply, list->count_type, &count, "number of vertices")) return false;
    if (count < 3) {
        snprintf(message, sizeof message, "a face of %lld vertices, expected at least 3", (long long)count);
        return ply_fail(ply, start, message);
    }
    for (int64_t i = 0; i < count; i++) {
        if (ply->header.format == PLY_ASCII) text_skip_space(&ply->text);
        start = ply->text.at;
        if (!next_integer(ply, list->type, &index, "number of a vertex")) return false;
        if (index < 0 || (uint64_t)index >= vertex_count) {
            snprintf(message, sizeof message, "there is no vertex %lld, expected 0 to %llu", (long long)index,
                     (unsigned long long)vertex_count - 1);
            return ply_fail(ply, start, message);
        }
        if (i >= 2) {
            uint32_t *triangle = array_push(&ply->triangles, ply->text.ctx);
            if (!triangle) return false;
            triangle[0] = first, triangle[1] = last, triangle[2] = (uint32_t)index;
        }
        if (i == 0) first = (uint32_t)index;
        last = (uint32_t)index;
    }
    return true;
}

static bool read_faces(struct ply *ply, uint64_t vertex_count) {
    struct context *ctx = ply->text.ctx;
    const struct ply_element *element = ply->element;
    const struct ply_property *list = NULL;
    for (size_t i = 0; i < element->property_count && !list; i++)
        if (is_face_list(ply_property_at(&ply->header, element->first + i))) list = ply_property_at(&ply->header, element->first + i);
    if (!list) return text_fail(&ply->text, element->name.at, "the faces have no property vertex_indices, expected a list of that name");
    if (!list->is_list || list->type >= PLY_FLOAT32)
        return text_fail(&ply->text, list->name.at, "the vertices of a face are no list of integers, expected one");
    if (!mesh_count_allowed(ctx, ply->text.path, element->count) || !array_reserve(&ply->triangles, ctx, element->count)) return false;
    for (ply->row = 0; ply->row < element->count; ply->row++) {
        if (ply->row % 65536 == 0 && !text_progress(&ply->text)) return false;
        for (size_t i = 0; i < element->property_count; i++) {
            const struct ply_property *property = ply_property_at(&ply->header, element->first + i);
            if (property == list ? !read_polygon(ply, list, vertex_count) : !skip_property(ply, property)) return false;
        }
        if (!mesh_count_allowed(ctx, ply->text.path, ply->triangles.count)) return false;
    }
    return true;
}

static bool skip_element(struct ply *ply) {
    if (ply->element->property_count == 0) return true;
    for (ply->row = 0; ply->row < ply->element->count; ply->row++) {
        if (ply->row % 65536 == 0 && !text_progress(&ply->text)) return false;
        for (size_t i = 0; i < ply->element->property_count; i++)
            if (!skip_property(ply, ply_property_at(&ply->header, ply->element->first + i))) return false;
    }
    return true;
}

// Elements behind the last one that matters are not looked at.
static bool read_elements(struct ply *ply) {
    const struct ply_header *header = &ply->header;
    const struct ply_element *vertices = ply_element_find(header, "vertex"), *faces = ply_element_find(header, "face");
    if (!vertices) return text_fail(&ply->text, ply->text.begin, "the file has no vertices, expected an element 'vertex'");
    if (!faces && ply_element_find(header, "tristrips"))
        return text_fail(&ply->text, ply_element_find(header, "tristrips")->name.at,
                         "triangle strips are not supported, expected an element 'face'");
    if (!faces || faces->count == 0 || vertices->count == 0)
        return text_fail(&ply->text, faces ? faces->name.at : ply->text.begin, "the file has no triangles, expected faces and vertices");
    const struct ply_element *last = vertices > faces ? vertices : faces;
    for (ply->element = ply_element_at(header, 0); ply->element <= last; ply->element++) {
        const bool done = ply->element == vertices ? read_vertices(ply)
                          : ply->element == faces  ? read_faces(ply, vertices->count)
                                                   : skip_element(ply);
        if (!done) return false;
    }
    return true;
}

bool model_load_ply(struct model *out, struct context *ctx, const char *path) {
    *out = (struct model){0};
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_SCENE)) return false;
    struct ply ply = {
        .text = {.ctx = ctx, .path = path, .begin = bytes.data, .at = bytes.data, .end = bytes.data + bytes.size},
        .mesh = &out->mesh,
        .triangles = {.item_size = 3 * sizeof(uint32_t), .what = "triangles"},
    };
    const bool done = ply_header_init(&ply.header, &ply.text) && read_elements(&ply);
    if (done) {
        free(out->mesh.indices);
        out->mesh.triangle_count = (uint32_t)ply.triangles.count;
        out->mesh.indices = array_take(&ply.triangles);
    }
    array_finish(&ply.triangles);
    ply_header_finish(&ply.header);
    file_bytes_finish(&bytes);
    if (!done) model_finish(out);
    return done;
}
