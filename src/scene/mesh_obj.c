// Meshes from Wavefront OBJ files: vertices, normals, texture coordinates, polygons, and materials by MTL libraries. Groups, lines and
// points are ignored; free-form surfaces are not supported.
//
// A file numbers positions, normals and texture coordinates separately. Where it has more than positions, each combination of the three
// that occurs becomes a vertex; a corner without normal gets a zero normal, which counts as none. Source: Alias|Wavefront, "Object Files
// (.obj)", Advanced Visualizer manual, appendix B1, 1995.
#include "scene/import.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/build.h"
#include "scene/mesh.h"
#include "scene/mtl.h"
#include "scene/number.h"
#include "scene/text.h"
#include "scene/unique.h"
#include "scene/words.h"

#define NONE UINT32_MAX

struct corner {
    uint32_t position, normal, uv;
}; // numbers from 0; normal and uv may be NONE

// From this triangle on, faces have this material.
struct material_switch {
    uint32_t triangle, material;
};

// The largest number that a face used so far: whether there is such a vertex is known at the end only.
struct reach {
    int64_t number;
    const char *at;
};

struct obj {
    struct text text;
    struct array positions, normals; // 3 floats each
    struct array uvs;                // 2 floats each
    struct array corners;            // 3 struct corner for each triangle
    struct array switches;           // struct material_switch
    struct array libraries;          // char *, paths
    struct array textures;           // struct texture_source
    struct material_table materials;
    struct reach position_reach, normal_reach, uv_reach;
    bool has_normals, has_uvs; // a face uses one
    bool warned;               // of an unknown statement
};

// ------------------------------------------------------------------------------------------------------------------ geometry

static bool read_point(struct array *points, struct text *text, const char *const names[3], bool more) {
    float *point = array_push(points, text->ctx), ignored;
    if (!point) return false;
    for (int i = 0; i < 3; i++) {
        text_skip_blanks(text);
        if (!text_float(text, &point[i], names[i])) return false;
    }
    // A weight and colors may follow a position.
    for (text_skip_blanks(text); !text_line_ends(text); text_skip_blanks(text)) {
        if (!more) return text_expected(text, text->at, "the end of the line");
        if (!text_float(text, &ignored, "weight or color of a vertex")) return false;
    }
    return true;
}

// "u v w": our v goes down, the file's goes up.
static bool read_uv(struct obj *obj) {
    static const char *const names[3] = {"u of a texture coordinate", "v of a texture coordinate", "w of a texture coordinate"};
    struct text *text = &obj->text;
    float values[3] = {0};
    int count = 0;
    for (text_skip_blanks(text); !text_line_ends(text) && count < 3; text_skip_blanks(text), count++)
        if (!text_float(text, &values[count], names[count])) return false;
    if (count == 0) return text_expected(text, text->at, "a number (u of a texture coordinate)");
    float *uv = array_push(&obj->uvs, text->ctx);
    if (uv) uv[0] = values[0], uv[1] = 1 - values[1];
    return uv != NULL;
}

// Turns a number of the file, from 1 or from the end when negative, into one from 0.
static bool resolve(uint32_t *out, struct obj *obj, const char *at, int64_t number, size_t count, struct reach *reach, const char *what) {
    const int64_t index = number < 0 ? (int64_t)count + number : number - 1;
    if (number == 0) return text_fail(&obj->text, at, "%s 0, expected numbers from 1 or, from the end, below 0", what);
    if (index < 0) return text_fail(&obj->text, at, "%s %lld, but only %zu are above", what, (long long)number, count);
    if (index > INT32_MAX) return text_fail(&obj->text, at, "%s %lld, expected at most 2^31", what, (long long)number);
    if (number > reach->number) *reach = (struct reach){number, at};
    *out = (uint32_t)index;
    return true;
}

// "v", "v/vt", "v//vn" or "v/vt/vn".
static bool read_corner(struct corner *out, struct obj *obj) {
    struct text *text = &obj->text;
    const char *at = text->at, *end = at + text_word(text), *vertex_at = at, *uv_at = NULL, *normal_at = NULL;
    int64_t position, uv, normal;
    at = number_i64(&position, at);
    if (at && *at == '/') {
        const char *next = number_i64(&uv, ++at);
        if (next) uv_at = at, at = next;
        if (*at == '/')
            at = number_i64(&normal, normal_at = at + 1);
        else if (!next)
            at = NULL;
    }
    if (at != end) return text_expected(text, text->at, "a vertex: v, v/vt, v//vn or v/vt/vn");
    text->at = end;
    out->normal = out->uv = NONE;
    obj->has_normals |= normal_at != NULL, obj->has_uvs |= uv_at != NULL;
    return resolve(&out->position, obj, vertex_at, position, obj->positions.count, &obj->position_reach, "vertex") &&
           (!uv_at || resolve(&out->uv, obj, uv_at, uv, obj->uvs.count, &obj->uv_reach, "texture coordinate")) &&
           (!normal_at || resolve(&out->normal, obj, normal_at, normal, obj->normals.count, &obj->normal_reach, "normal"));
}

// A polygon, fanned around its first corner.
static bool read_face(struct obj *obj) {
    struct text *text = &obj->text;
    struct corner first = {0}, last = {0}, corner;
    const char *start = text->at - 1; // the 'f'
    size_t count = 0;
    for (text_skip_blanks(text); !text_line_ends(text); text_skip_blanks(text)) {
        if (!read_corner(&corner, obj)) return false;
        if (count >= 2) {
            struct corner *triangle = array_push(&obj->corners, text->ctx);
            if (!triangle) return false;
            triangle[0] = first, triangle[1] = last, triangle[2] = corner;
        }
        if (count++ == 0) first = corner;
        last = corner;
    }
    if (count < 3) return text_fail(text, start, "a face of %zu vertices, expected at least 3", count);
    return mesh_count_allowed(text->ctx, text->path, obj->corners.count);
}

// ---------------------------------------------------------------------------------------------------------------- statements

static bool read_usemtl(struct obj *obj) {
    char *name = text_rest(&obj->text);
    struct material_switch *change = array_push(&obj->switches, obj->text.ctx);
    const bool done = name && change && material_need(&obj->materials, obj->text.ctx, name, &change->material);
    if (done) change->triangle = (uint32_t)obj->corners.count;
    free(name);
    return done;
}

static bool add_library(struct obj *obj, const char *name, const char *at) {
    char *path = path_beside(obj->text.path, name);
    if (!path) return fail(obj->text.ctx, GN_LIMIT, "no memory for a path");
    const char *trouble = path_unreadable(path);
    if (trouble) text_warn(&obj->text, at, "material library %s cannot be read: %s; default materials are used", path, trouble);
    char **library = trouble ? NULL : array_push(&obj->libraries, obj->text.ctx);
    if (library)
        *library = path;
    else
        free(path);
    return trouble || library;
}

// Names of libraries, parted by white space; but a single name may have white space in it, too.
static bool read_mtllib(struct obj *obj) {
    struct text *text = &obj->text;
    text_skip_blanks(text);
    const char *start = text->at;
    char *rest = text_rest(text), *path = rest ? path_beside(text->path, rest) : NULL;
    bool done = path || fail(text->ctx, GN_LIMIT, "no memory for a path");
    if (done && !path_unreadable(path)) {
        done = add_library(obj, rest, start);
    } else {
        for (char *word = rest ? rest + strspn(rest, " \t") : NULL; done && word && *word;) {
            const size_t length = strcspn(word, " \t");
            char *next = word + length + strspn(word + length, " \t");
            word[length] = '\0';
            done = add_library(obj, word, start);
            word = next;
        }
    }
    free(path);
    free(rest);
    return done;
}

// Statements without a bearing on the picture.
static bool is_ignored(struct text *text) {
    static const char *const words[] = {"g",        "o",        "s",   "l",      "p",      "vp",         "mg",       "bevel",
                                        "c_interp", "d_interp", "lod", "usemap", "maplib", "shadow_obj", "trace_obj"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (text_accept(text, words[i])) return true;
    return false;
}

static bool read_statement(struct obj *obj) {
    static const char *const position_names[3] = {"x of a vertex", "y of a vertex", "z of a vertex"};
    static const char *const normal_names[3] = {"x of a normal", "y of a normal", "z of a normal"};
    struct text *text = &obj->text;
    if (text_accept(text, "v")) return read_point(&obj->positions, text, position_names, true);
    if (text_accept(text, "f") || text_accept(text, "fo")) return read_face(obj);
    if (text_accept(text, "vt")) return read_uv(obj);
    if (text_accept(text, "vn")) return read_point(&obj->normals, text, normal_names, false);
    if (text_accept(text, "usemtl")) return read_usemtl(obj);
    if (text_accept(text, "mtllib")) return read_mtllib(obj);
    if (text_line_ends(text) || is_ignored(text) || obj->warned) return true;
    obj->warned = true;
    text_warn(text, text->at, "statement '%s' is not known; it and others like it are skipped",
              excerpt_make(text->at, text_word(text)).text);
    return true;
}

static bool check_reach(const struct obj *obj, const struct reach *reach, size_t count, const char *what) {
    return reach->number <= (int64_t)count ||
           text_fail(&obj->text, reach->at, "%s %lld, but the file has only %zu", what, (long long)reach->number, count);
}

static bool read_statements(struct obj *obj) {
    struct text *text = &obj->text;
    if (strncmp(text->at, "\xef\xbb\xbf", 3) == 0) text->at += 3; // a byte order mark
    for (size_t lines = 0; text->at < text->end; lines++) {
        if (lines % 65536 == 0 && !text_progress(text)) return false;
        text_skip_blanks(text);
        const bool comment = *text->at == '#';
        if (!comment && !read_statement(obj)) return false;
        text_next_line(text, !comment);
    }
    if (!check_reach(obj, &obj->position_reach, obj->positions.count, "vertex") ||
        !check_reach(obj, &obj->normal_reach, obj->normals.count, "normal") ||
        !check_reach(obj, &obj->uv_reach, obj->uvs.count, "texture coordinate"))
        return false;
    if (obj->positions.count > UINT32_MAX) return fail(text->ctx, GN_LIMIT, "%s: has 2^32 vertices or more", text->path);
    return obj->corners.count > 0 || fail(text->ctx, GN_SCENE, "%s: has no triangles, expected at least one face ('f')", text->path);
}

// ------------------------------------------------------------------------------------------------------------------- results

// With nothing else a vertex is a position.
static bool take_positions(struct scene_mesh *mesh, struct obj *obj) {
    const struct corner *corners = obj->corners.items;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) mesh->indices[i] = corners[i].position;
    mesh->vertex_count = (uint32_t)obj->positions.count;
    mesh->positions = array_take(&obj->positions);
    return true;
}

// Else a vertex is a combination.
static bool take_combinations(struct scene_mesh *mesh, struct obj *obj) {
    struct context *ctx = obj->text.ctx;
    const struct corner *corners = obj->corners.items;
    const uint32_t corner_count = 3 * mesh->triangle_count;
    const float *positions = obj->positions.items, *normals = obj->normals.items, *uvs = obj->uvs.items;
    if (!unique_rows(mesh->indices, &mesh->vertex_count, ctx, corners, corner_count, 3)) return false;
    mesh->positions = array_alloc(ctx, mesh->vertex_count, 3 * sizeof *mesh->positions, "vertices");
    if (obj->has_normals) mesh->normals = array_alloc(ctx, mesh->vertex_count, 3 * sizeof *mesh->normals, "normals");
    if (!mesh->positions || (obj->has_normals && !mesh->normals) || (obj->has_uvs && !mesh_add_uvs(mesh, ctx))) return false;
    for (uint32_t i = 0; i < corner_count; i++) {
        const size_t vertex = mesh->indices[i];
        const struct corner *corner = &corners[i];
        memcpy(mesh->positions + 3 * vertex, positions + 3 * (size_t)corner->position, 3 * sizeof(float));
        if (corner->normal != NONE) memcpy(mesh->normals + 3 * vertex, normals + 3 * (size_t)corner->normal, 3 * sizeof(float));
        if (corner->uv != NONE) memcpy(mesh->uvs + 2 * vertex, uvs + 2 * (size_t)corner->uv, 2 * sizeof(float));
    }
    return true;
}

static bool take_mesh(struct scene_mesh *mesh, struct obj *obj) {
    mesh->triangle_count = (uint32_t)obj->corners.count;
    mesh->indices = array_alloc(obj->text.ctx, mesh->triangle_count, 3 * sizeof *mesh->indices, "triangles");
    if (!mesh->indices) return false;
    return obj->has_normals || obj->has_uvs ? take_combinations(mesh, obj) : take_positions(mesh, obj);
}

static bool read_libraries(struct obj *obj) {
    struct context *ctx = obj->text.ctx;
    const size_t count = obj->materials.items.count;
    const struct scene_material *materials = obj->materials.items.items;
    char **libraries = obj->libraries.items;
    bool *defined = array_alloc(ctx, count, sizeof *defined, "materials"), done = defined != NULL;
    for (size_t i = 0; done && i < obj->libraries.count; i++) done = mtl_load(&obj->materials, defined, &obj->textures, ctx, libraries[i]);
    for (size_t i = 0; done && obj->libraries.count > 0 && i < count; i++)
        if (!defined[i] && strcmp(materials[i].name, DEFAULT_MATERIAL) != 0)
            notify(ctx, GN_LEVEL_WARNING, "%s: material '%s' is in no material library; a default is used", obj->text.path,
                   excerpt_word(materials[i].name).text);
    free(defined);
    return done;
}

// Spreads the switches over the triangles. A single material for all needs no list.
static bool take_materials(struct model *out, struct obj *obj) {
    const struct material_switch *switches = obj->switches.items;
    const size_t count = obj->switches.count;
    if (count == 0) return true;
    uint32_t material = 0;
    if (switches[0].triangle > 0 && !material_need(&obj->materials, obj->text.ctx, DEFAULT_MATERIAL, &material)) return false;
    if (!read_libraries(obj)) return false;
    if (obj->materials.items.count > 1) {
        out->mesh.materials = array_alloc(obj->text.ctx, out->mesh.triangle_count, sizeof *out->mesh.materials, "materials of triangles");
        if (!out->mesh.materials) return false;
        for (size_t next = 0, i = 0; i < out->mesh.triangle_count; i++) {
            while (next < count && switches[next].triangle <= i) material = switches[next++].material;
            out->mesh.materials[i] = material;
        }
    }
    material_table_take(&obj->materials, &out->materials, &out->material_count);
    out->texture_count = (uint32_t)obj->textures.count;
    out->textures = array_take(&obj->textures);
    return true;
}

bool model_load_obj(struct model *out, struct context *ctx, const char *path) {
    *out = (struct model){0};
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_SCENE)) return false;
    struct obj obj = {
        .text = {.ctx = ctx, .path = path, .begin = bytes.data, .at = bytes.data, .end = bytes.data + bytes.size},
        .positions = {.item_size = 3 * sizeof(float), .what = "vertices"},
        .normals = {.item_size = 3 * sizeof(float), .what = "normals"},
        .uvs = {.item_size = 2 * sizeof(float), .what = "texture coordinates"},
        .corners = {.item_size = 3 * sizeof(struct corner), .what = "triangles"},
        .switches = {.item_size = sizeof(struct material_switch), .what = "materials"},
        .libraries = {.item_size = sizeof(char *), .what = "material libraries"},
        .textures = {.item_size = sizeof(struct texture_source), .what = "textures"},
        .materials = MATERIAL_TABLE,
    };
    bool done = read_statements(&obj);
    file_bytes_finish(&bytes); // before more memory is taken; from here on no message names a place
    done = done && take_mesh(&out->mesh, &obj) && take_materials(out, &obj);
    for (size_t i = 0; i < obj.libraries.count; i++) free(((char **)obj.libraries.items)[i]);
    array_finish(&obj.positions);
    array_finish(&obj.normals);
    array_finish(&obj.uvs);
    array_finish(&obj.corners);
    array_finish(&obj.switches);
    array_finish(&obj.libraries);
    texture_sources_finish(obj.textures.items, (uint32_t)obj.textures.count);
    material_table_finish(&obj.materials);
    if (!done) model_finish(out);
    return done;
}
