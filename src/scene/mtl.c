// Material libraries of OBJ files.
// Source: Alias|Wavefront, "MTL material format", 1995.
#include "scene/mtl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/build.h"
#include "scene/number.h"
#include "scene/text.h"
#include "scene/words.h"

// A texture that a material names; without a name there is none.
struct mtl_map {
    struct texture_source source;
    float transform[6];
};

struct mtl {
    struct text text;
    struct scene_material *material; // being read; NULL before the first, and for those that nobody uses
    bool has_ambient, has_diffuse, has_emission;
    int64_t illumination;                            // "illum", 0 if there is none
    float filter[3];                                 // "Tf"
    struct mtl_map diffuse, alpha, emission, normal; // "map_Kd", "map_d", "map_Ke", "norm"
    struct material_table *table;
    bool *defined;
    struct array *textures;
};

// ------------------------------------------------------------------------------------------------------------ a material's end

// What "illum" adds. 3, 5: a mirror beside the rest; 6, 7: refraction. 4 and 9 are glass in name only: where programs write them, "d" does
// it.
static void set_illumination(struct mtl *mtl, struct scene_material *material) {
    const bool mirror = mtl->illumination == 3 || mtl->illumination == 5, glass = mtl->illumination == 6 || mtl->illumination == 7;
    for (int i = 0; i < 3; i++) {
        if (mirror) material->reflection[i] = fminf(material->specular[i], 1);
        if (glass) material->diffuse[i] = mtl->filter[i], material->ambient[i] = 0;
    }
    if (glass) material->model = MODEL_DIELECTRIC;
}

static bool set_map(struct scene_map *out, struct mtl *mtl, struct mtl_map *map, bool color) {
    if (!map->source.name) return true;
    map->source.srgb = out->srgb = color;
    memcpy(out->transform, map->transform, sizeof out->transform);
    return texture_source_add(mtl->textures, mtl->text.ctx, &map->source, &out->texture);
}

// Alpha joins the color in one texture: by the color's own if both are one file. Without color, that of the alpha's file serves, which is
// white where there is something to see.
static bool join_alpha(struct mtl *mtl, struct scene_material *material) {
    struct texture_source *color = &mtl->diffuse.source, *alpha = &mtl->alpha.source;
    if (!alpha->name) return true;
    material->alpha_mode = ALPHA_BLEND;
    if (!color->name) {
        mtl->diffuse = mtl->alpha;
        color->alpha_name = strdup(alpha->name);
        *alpha = (struct texture_source){0};
        return color->alpha_name || fail(mtl->text.ctx, GN_LIMIT, "no memory for a name");
    }
    if (strcmp(color->name, alpha->name) == 0) return true;
    color->alpha_name = alpha->name;
    alpha->name = NULL;
    return true;
}

static bool set_maps(struct mtl *mtl, struct scene_material *material) {
    for (int i = 0; i < 3; i++) {
        if (mtl->diffuse.source.name && !mtl->has_diffuse) material->diffuse[i] = 1;
        if (mtl->emission.source.name && !mtl->has_emission) material->emission[i] = 1;
    }
    return join_alpha(mtl, material) && set_map(&material->diffuse_map, mtl, &mtl->diffuse, true) &&
           set_map(&material->emission_map, mtl, &mtl->emission, true) && set_map(&material->normal_map, mtl, &mtl->normal, false);
}

static bool finish_material(struct mtl *mtl) {
    struct scene_material *material = mtl->material;
    bool done = true;
    if (material) {
        done = set_maps(mtl, material);
        if (!mtl->has_ambient) memcpy(material->ambient, material->diffuse, sizeof material->ambient);
        set_illumination(mtl, material);
    }
    struct mtl_map *const maps[] = {&mtl->diffuse, &mtl->alpha, &mtl->emission, &mtl->normal};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) texture_source_finish(&maps[i]->source);
    mtl->material = NULL;
    mtl->has_ambient = mtl->has_diffuse = mtl->has_emission = false;
    mtl->illumination = 0;
    for (int i = 0; i < 3; i++) mtl->filter[i] = 1;
    return done;
}

// --------------------------------------------------------------------------------------------------------------- statements

static bool begin_material(struct mtl *mtl) {
    char *name = text_rest(&mtl->text);
    if (!name || !finish_material(mtl)) {
        free(name);
        return false;
    }
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

// A number between two blanks, if there is one.
static bool next_number(struct text *text, float *out) {
    text_skip_blanks(text);
    const char *end = number_f32(out, text->at);
    if (!end || (*end != ' ' && *end != '\t') || !isfinite(*out)) return false;
    text->at = end;
    return true;
}

static void skip_word(struct text *text) {
    text_skip_blanks(text);
    text->at += text_word(text);
}

// "-s u v w" scales the file's texture coordinates, "-o u v w" moves them, of which fewer may be given. Other options are skipped.
static void read_options(struct mtl_map *out, struct text *text) {
    static const char *const words[] = {"-blendu", "-blendv", "-boost", "-texres", "-bm", "-imfchan", "-type", "-cc"};
    float scale[3] = {1, 1, 1}, offset[3] = {0}, ignored;
    for (bool option = true; option;) {
        text_skip_blanks(text);
        option = false;
        for (size_t i = 0; i < sizeof words / sizeof *words && !option; i++) option = text_accept(text, words[i]);
        if (option) {
            skip_word(text);
        } else if (text_accept(text, "-clamp")) {
            text_skip_blanks(text);
            if (text_accept(text, "on"))
                out->source.wrap_u = out->source.wrap_v = WRAP_CLAMP;
            else
                skip_word(text);
            option = true;
        } else if (text_accept(text, "-s")) {
            for (int i = 0; i < 3 && next_number(text, &scale[i]); i++) option = true;
        } else if (text_accept(text, "-o")) {
            for (int i = 0; i < 3 && next_number(text, &offset[i]); i++) option = true;
        } else if (text_accept(text, "-t") || text_accept(text, "-mm")) {
            for (int i = 0; i < 3 && next_number(text, &ignored); i++) option = true;
        }
    }
    // Ours go down from 1: v' = 1 - (scale (1 - v) + offset).
    const float transform[6] = {scale[0], 0, offset[0], 0, scale[1], 1 - scale[1] - offset[1]};
    memcpy(out->transform, transform, sizeof transform);
}

// Some programs write paths as Windows has them.
static void turn_slashes(char *path) {
    for (; *path; path++)
        if (*path == '\\') *path = '/';
}

// "[options] file"
static bool read_map(struct mtl *mtl, struct mtl_map *out) {
    struct text *text = &mtl->text;
    texture_source_finish(&out->source);
    read_options(out, text);
    text_skip_blanks(text);
    const char *start = text->at;
    char *name = text_rest(text), *path = name ? path_beside(text->path, name) : NULL;
    const bool done = path || fail(text->ctx, GN_LIMIT, "no memory for a path");
    if (done && path_unreadable(path)) turn_slashes(path);
    const char *trouble = done ? path_unreadable(path) : NULL;
    if (trouble) text_warn(text, start, "texture %s cannot be read: %s; it is left out", path, trouble);
    if (done && !trouble)
        out->source.name = path;
    else
        free(path);
    free(name);
    return done;
}

static bool read_number(struct mtl *mtl, float *out, const char *what, float least, float most) {
    float value;
    text_skip_blanks(&mtl->text);
    if (!text_float(&mtl->text, &value, what)) return false;
    *out = fminf(fmaxf(value, least), most);
    return true;
}

static bool read_illumination(struct mtl *mtl) {
    text_skip_blanks(&mtl->text);
    return text_integer(&mtl->text, &mtl->illumination, "model of illumination");
}

// How much of a surface is there. Halos are not supported.
static bool read_dissolve(struct mtl *mtl, struct scene_material *material) {
    text_skip_blanks(&mtl->text);
    if (text_accept(&mtl->text, "-halo")) return true;
    if (!read_number(mtl, &material->alpha, "dissolve", 0, 1)) return false;
    if (material->alpha < 1) material->alpha_mode = ALPHA_BLEND;
    return true;
}

static bool read_statement(struct mtl *mtl) {
    struct scene_material ignored = {0}, *material = mtl->material ? mtl->material : &ignored;
    struct text *text = &mtl->text;
    if (text_accept(text, "newmtl")) return begin_material(mtl);
    if (text_accept(text, "Ns")) return read_shininess(mtl);
    if (text_accept(text, "Kd")) return mtl->has_diffuse = true, read_color(mtl, material->diffuse);
    if (text_accept(text, "Ks")) return read_color(mtl, material->specular);
    if (text_accept(text, "Ka")) return mtl->has_ambient = true, read_color(mtl, material->ambient);
    if (text_accept(text, "Ke")) return mtl->has_emission = true, read_color(mtl, material->emission);
    if (text_accept(text, "Tf")) return read_color(mtl, mtl->filter);
    if (text_accept(text, "Ni")) return read_number(mtl, &material->ior, "index of refraction", 0.001f, 1000);
    if (text_accept(text, "d")) return read_dissolve(mtl, material);
    if (text_accept(text, "illum")) return read_illumination(mtl);
    if (text_accept(text, "map_Kd")) return read_map(mtl, &mtl->diffuse);
    if (text_accept(text, "map_d")) return read_map(mtl, &mtl->alpha);
    if (text_accept(text, "map_Ke")) return read_map(mtl, &mtl->emission);
    if (text_accept(text, "norm")) return read_map(mtl, &mtl->normal);
    return true;
}

bool mtl_load(struct material_table *table, bool *defined, struct array *textures, struct context *ctx, const char *path) {
    struct file_bytes bytes;
    if (!file_read(&bytes, ctx, path, GN_SCENE)) return false;
    struct mtl mtl = {
        .text = {.ctx = ctx, .path = path, .begin = bytes.data, .at = bytes.data, .end = bytes.data + bytes.size},
        .table = table,
        .defined = defined,
        .textures = textures,
        .filter = {1, 1, 1},
    };
    bool done = true;
    while (done && mtl.text.at < mtl.text.end) {
        text_skip_blanks(&mtl.text);
        done = read_statement(&mtl);
        text_next_line(&mtl.text, false);
    }
    done = finish_material(&mtl) && done;
    file_bytes_finish(&bytes);
    return done;
}
