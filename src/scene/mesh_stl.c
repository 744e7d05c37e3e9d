// Meshes from STL files, binary or ascii. Every facet has its own three vertices; its normal, and what colours some programs hide in
// the attribute bytes, are ignored.
// Source: 3D Systems, "StereoLithography Interface Specification", 1988.
#include "scene/import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/array.h"
#include "scene/mesh.h"
#include "scene/text.h"

#define HEADER_SIZE 84 // 80 bytes of anything, then the number of facets
#define FACET_SIZE 50  // normal, three vertices, two bytes of attributes

static uint32_t little_endian(const char *bytes) {
    const unsigned char *b = (const unsigned char *)bytes;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

// A binary file's size follows from its number of facets. Its header may begin with "solid", too, as every ascii file does.
static bool is_binary(const struct text *text) {
    const uint64_t size = (uint64_t)(text->end - text->begin);
    if (size >= HEADER_SIZE && size == HEADER_SIZE + FACET_SIZE * (uint64_t)little_endian(text->begin + 80)) return true;
    struct text start = *text;
    text_skip_space(&start);
    return !text_accept(&start, "solid");
}

static void number_vertices(struct scene_mesh *mesh) {
    for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++) mesh->indices[i] = i;
}

static bool read_binary(struct model *out, struct text *text) {
    const uint64_t size = (uint64_t)(text->end - text->begin);
    if (size < HEADER_SIZE)
        return fail(text->ctx, GN_SCENE, "%s: is no STL file: %llu bytes, expected at least 84", text->path, (unsigned long long)size);
    const uint64_t count = little_endian(text->begin + 80);
    if (size < HEADER_SIZE + FACET_SIZE * count)
        return fail(text->ctx, GN_SCENE, "%s: byte 80: %llu facets take %llu bytes, but the file has %llu", text->path,
                    (unsigned long long)count, (unsigned long long)(HEADER_SIZE + FACET_SIZE * count), (unsigned long long)size);
    if (!mesh_count_allowed(text->ctx, text->path, count) || !mesh_init(&out->mesh, text->ctx, 3 * count, count, false)) return false;
    for (uint64_t i = 0; i < count; i++) {
        text->at = text->begin + HEADER_SIZE + FACET_SIZE * i;
        if (i % 65536 == 0 && !text_progress(text)) return false;
        for (int k = 0; k < 9; k++) {
            const char *at = text->at + 12 + 4 * k;
            const uint32_t bits = little_endian(at);
            float *value = &out->mesh.positions[9 * i + (uint64_t)k];
            memcpy(value, &bits, sizeof bits);
            if (!isfinite(*value))
                return fail(text->ctx, GN_SCENE, "%s: byte %zu: facet %llu has a vertex with %g, expected a finite number", text->path,
                            (size_t)(at - text->begin), (unsigned long long)i, (double)*value);
        }
    }
    number_vertices(&out->mesh);
    return true;
}

// Skips white space and then `word`, which must be there.
static bool need(struct text *text, const char *word) {
    text_skip_space(text);
    if (text_accept(text, word)) return true;
    char expected[32];
    snprintf(expected, sizeof expected, "'%s'", word);
    return text_expected(text, text->at, expected);
}

// One facet behind the word "facet".
static bool read_facet(struct array *positions, struct text *text) {
    static const char *const axes[3] = {"x of a vertex", "y of a vertex", "z of a vertex"};
    if (!need(text, "normal")) return false;
    for (int i = 0; i < 3; i++) {
        text_skip_space(text);
        text->at += text_word(text);
    }
    if (!need(text, "outer") || !need(text, "loop")) return false;
    for (int i = 0; i < 3; i++) {
        float *position = array_push(positions, text->ctx);
        if (!position || !need(text, "vertex")) return false;
        for (int k = 0; k < 3; k++) {
            text_skip_space(text);
            if (!text_float(text, &position[k], axes[k])) return false;
        }
    }
    return need(text, "endloop") && need(text, "endfacet");
}

// A file may have several solids; the triangles are those of all.
static bool read_facets(struct array *positions, struct text *text) {
    while (text_skip_space(text), text->at < text->end) {
        if (!need(text, "solid")) return false;
        text_next_line(text, false); // the rest of the line is a name
        for (text_skip_space(text); text_accept(text, "facet"); text_skip_space(text)) {
            if (!read_facet(positions, text)) return false;
            if (positions->count % 65536 < 3 && !text_progress(text)) return false;
            if (!mesh_count_allowed(text->ctx, text->path, positions->count / 3)) return false;
        }
        if (!text_accept(text, "endsolid")) return text_expected(text, text->at, "'facet' or 'endsolid'");
        text_next_line(text, false);
    }
    return true;
}

static bool read_ascii(struct model *out, struct text *text) {
    struct array positions = {.item_size = 3 * sizeof(float), .what = "vertices"};
    bool done = read_facets(&positions, text);
    const uint64_t count = positions.count / 3;
    done = done && mesh_init(&out->mesh, text->ctx, 0, count, false);
    if (done) {
        free(out->mesh.positions);
        out->mesh.vertex_count = (uint32_t)positions.count;
        out->mesh.positions = array_take(&positions);
        number_vertices(&out->mesh);
    }
    array_finish(&positions);
    return done;
}

bool model_load_stl(struct model *out, struct context *ctx, const char *path) {
    *out = (struct model){0};
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_SCENE)) return false;
    struct text text = {.ctx = ctx, .path = path, .begin = bytes.data, .at = bytes.data, .end = bytes.data + bytes.size};
    bool done = is_binary(&text) ? read_binary(out, &text) : read_ascii(out, &text);
    if (done && out->mesh.triangle_count == 0) done = fail(ctx, GN_SCENE, "%s: has no triangles, expected at least one", path);
    file_bytes_finish(&bytes);
    if (!done) model_finish(out);
    return done;
}
