// Material libraries of OBJ files.
// Source: Alias|Wavefront, "MTL material format", 1995.
#include "scene/mtl.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/text.h"
#include "scene/words.h"

struct mtl {
    struct text text;
    struct scene_material *material; // being read; NULL before the first, and for those that nobody uses
    bool has_ambient;
    struct material_table *table;
    bool *defined;
};

static void finish_material(struct mtl *mtl) {
    if (mtl->material && !mtl->has_ambient) memcpy(mtl->material->ambient, mtl->material->diffuse, sizeof mtl->material->ambient);
    mtl->material = NULL;
    mtl->has_ambient = false;
}

static bool begin_material(struct mtl *mtl) {
    char *name = text_rest(&mtl->text);
    if (!name) return false;
    finish_material(mtl);
    uint32_t number;
    if (material_find(mtl->table, name, &number)) {
        mtl->material = (struct scene_material *)mtl->table->items.items + number;
        mtl->defined[number] = true;
    }
    free(name);
    return true;
}

// "r g b", or "r" for a grey.
static bool read_color(struct mtl *mtl, float *color) {
    static const char *const names[3] = {"red", "green", "blue"};
    float values[3] = {0};
    text_skip_blanks(&mtl->text);
    const char *start = mtl->text.at;
    if (text_accept(&mtl->text, "spectral") || text_accept(&mtl->text, "xyz")) {
        text_warn(&mtl->text, start, "colors as spectra or in XYZ are not supported, this one is left out");
        return true;
    }
    for (int i = 0; i < 3; i++) {
        text_skip_blanks(&mtl->text);
        start = mtl->text.at;
        if (i > 0 && text_line_ends(&mtl->text))
            values[i] = values[0];
        else if (!text_float(&mtl->text, &values[i], names[i]))
            return false;
        if (values[i] < 0) return text_fail(&mtl->text, start, "%s is %g, expected at least 0", names[i], (double)values[i]);
    }
    if (mtl->material) memcpy(color, values, sizeof values);
    return true;
}

// Some programs write negative exponents for no highlight at all.
static bool read_shininess(struct mtl *mtl) {
    float value;
    text_skip_blanks(&mtl->text);
    if (!text_float(&mtl->text, &value, "shininess")) return false;
    if (mtl->material) mtl->material->shininess = value < 0 ? 0 : value;
    return true;
}

static bool read_statement(struct mtl *mtl) {
    struct scene_material ignored, *material = mtl->material ? mtl->material : &ignored;
    struct text *text = &mtl->text;
    if (text_accept(text, "newmtl")) return begin_material(mtl);
    if (text_accept(text, "Ns")) return read_shininess(mtl);
    if (text_accept(text, "Kd")) return read_color(mtl, material->diffuse);
    if (text_accept(text, "Ks")) return read_color(mtl, material->specular);
    if (!text_accept(text, "Ka")) return true;
    mtl->has_ambient = true;
    return read_color(mtl, material->ambient);
}

bool mtl_load(struct material_table *table, bool *defined, struct context *ctx, const char *path) {
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_SCENE)) return false;
    struct mtl mtl = {
        .text = {.ctx = ctx, .path = path, .begin = bytes.data, .at = bytes.data, .end = bytes.data + bytes.size},
        .table = table,
        .defined = defined,
    };
    bool done = true;
    while (done && mtl.text.at < mtl.text.end) {
        text_skip_blanks(&mtl.text);
        done = read_statement(&mtl);
        text_next_line(&mtl.text, false);
    }
    finish_material(&mtl);
    file_bytes_finish(&bytes);
    return done;
}
