// Maps of materials.
#include "scene/json_map.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/words.h"

#define COLOR (1u << MAP_COLOR)
#define NORMAL (1u << MAP_NORMAL)
#define DATA (1u << MAP_DATA)

static const char *const kinds[] = {[MAP_COLOR] = "color map", [MAP_NORMAL] = "normal map", [MAP_DATA] = "roughness map", NULL};

static const struct json_key keys[] = {
    {"file", COLOR | NORMAL | DATA},
    {"wrap", COLOR | NORMAL | DATA},
    {"filter", COLOR | NORMAL | DATA},
    {"transform", COLOR | NORMAL | DATA},
    {"encoding", COLOR},
    {"scale", NORMAL},
    {NULL, 0},
};

static const char *const wraps[] = {[WRAP_REPEAT] = "repeat", [WRAP_CLAMP] = "clamp", [WRAP_MIRROR] = "mirror", NULL};

char *map_path(struct json_at *named, const struct json_at *at, const struct scene_build *build, const char *expected) {
    const char *name;
    *named = *at;
    if (!json_is_string(at->value) && (!at_require(at, "file", expected) || !at_member(named, at, "file"))) return NULL;
    if (!at_text(named, expected, &name)) return NULL;
    char *path = path_beside(build->scene->path, name);
    const char *trouble = path ? path_unreadable(path) : NULL;
    if (path && !trouble) return path;
    if (trouble)
        at_fail(named, "is \"%s\", expected a file that can be read: %s", excerpt_word(name).text, trouble);
    else
        fail(build->ctx, GN_LIMIT, "no memory for a path");
    free(path);
    return NULL;
}

// "clamp", or one for each direction: ["repeat", "clamp"].
static bool read_wrap(struct texture_source *out, const struct json_at *map) {
    struct json_at at;
    int u = WRAP_REPEAT, v = WRAP_REPEAT;
    if (!at_member(&at, map, "wrap")) return true;
    if (json_is_string(at.value)) {
        if (!at_get_choice(map, "wrap", wraps, &u)) return false;
        v = u;
    } else if (!at_list(&at, 2, 2, "\"repeat\", \"clamp\" or \"mirror\", or a list of 2 of these")) {
        return false;
    } else {
        const struct json_at first = at_item(&at, 0), second = at_item(&at, 1);
        if (!at_choice(&first, wraps, &u) || !at_choice(&second, wraps, &v)) return false;
    }
    out->wrap_u = (enum texture_wrap)u, out->wrap_v = (enum texture_wrap)v;
    return true;
}

// Two rows of three numbers.
static bool read_transform(float out[6], const struct json_at *map) {
    struct json_at at;
    if (!at_member(&at, map, "transform")) return true;
    if (!at_list(&at, 2, 2, "2 rows of 3 numbers")) return false;
    const struct json_at first = at_item(&at, 0), second = at_item(&at, 1);
    return at_floats(&first, RANGE_ANY, 3, out) && at_floats(&second, RANGE_ANY, 3, out + 3);
}

static bool read_object(struct scene_map *out, float *scale, struct texture_source *source, const struct json_at *at, enum map_kind kind) {
    static const char *const filters[] = {"linear", "nearest", NULL}, *const encodings[] = {"linear", "srgb", NULL};
    int filter = 0, encoding = out->srgb;
    if (!at_object_of_kind(at, keys, kinds, kind) || !read_wrap(source, at) || !at_get_choice(at, "filter", filters, &filter) ||
        !at_get_choice(at, "encoding", encodings, &encoding) || !read_transform(out->transform, at))
        return false;
    source->nearest = filter == 1;
    out->srgb = encoding == 1;
    return !scale || at_get_float(at, "scale", RANGE_ANY, scale);
}

// The texture's fault, with the place that names it.
static bool need_texture(uint32_t *number, struct scene_build *build, const struct texture_source *source, const struct json_at *named) {
    struct gn_error error;
    struct context inner = context_make(&build->ctx->host, &error);
    return texture_need(&build->textures, &inner, source, number) || at_fail_as(named, &error);
}

bool map_read(struct scene_map *out, float *scale, struct scene_build *build, const struct json_at *material, const char *key,
              enum map_kind kind) {
    struct json_at at, named;
    if (!at_member(&at, material, key)) return true;
    if (!json_is_string(at.value) && !json_is_object(at.value)) return at_expected(&at, "the path of an image, or an object");
    struct texture_source source = {0};
    out->srgb = kind == MAP_COLOR;
    if (json_is_object(at.value) && !read_object(out, scale, &source, &at, kind)) return false;
    source.name = map_path(&named, &at, build, "the path of an image");
    source.srgb = out->srgb;
    const bool done = source.name && need_texture(&out->texture, build, &source, &named);
    texture_source_finish(&source);
    return done;
}
