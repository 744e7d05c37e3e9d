// The text is walked alongside jansson's tree: its objects keep the order of their keys, so both meet the same values in the same order.
#include "scene/json_file.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "scene/number.h"
#include "scene/text.h"

// ------------------------------------------------------------------------------------------------------------------ the walk

// What a walk looks for, and what it found.
struct walk {
    const char *at;          // in the text
    const json_t *container; // of the value looked for
    const char *key;
    size_t index;
    const char *key_at, *value_at; // found, or NULL
    bool settle;                   // settle roundings on the way
};

static void skip_space(struct walk *walk) { walk->at += strspn(walk->at, " \t\r\n"); }

static void skip_byte(struct walk *walk) {
    skip_space(walk);
    if (*walk->at) walk->at++;
}

static void skip_string(struct walk *walk) {
    skip_byte(walk);
    while (*walk->at && *walk->at != '"') walk->at += walk->at[0] == '\\' && walk->at[1] ? 2 : 1;
    skip_byte(walk);
}

// jansson rounds a decimal to fp64, we then to fp32: twice, which goes wrong where the first rounding hit a midpoint between two floats.
// The number is then moved by its last place to the side where the decimal was.
static void settle_rounding(const char *text, json_t *number) {
    const double value = json_real_value(number);
    float nearest;
    if (!number_is_midway(value) || fabs(value) > FLT_MAX + 0x1p103 || !number_f32(&nearest, text) || nearest == (float)value) return;
    json_real_set(number, nextafter(value, (double)nearest));
}

static void walk_value(struct walk *walk, json_t *value);

static void walk_object(struct walk *walk, json_t *object) {
    const char *key;
    json_t *value;
    skip_byte(walk);
    json_object_foreach(object, key, value) {
        skip_space(walk);
        const bool wanted = object == walk->container && walk->key && strcmp(key, walk->key) == 0;
        if (wanted) walk->key_at = walk->at;
        skip_string(walk);
        skip_byte(walk); // ':'
        skip_space(walk);
        if (wanted) walk->value_at = walk->at;
        walk_value(walk, value);
        skip_byte(walk); // ',' or '}'
    }
    if (json_object_size(object) == 0) skip_byte(walk);
}

static void walk_list(struct walk *walk, json_t *list) {
    size_t index;
    json_t *value;
    skip_byte(walk);
    json_array_foreach(list, index, value) {
        skip_space(walk);
        if (list == walk->container && !walk->key && index == walk->index) walk->value_at = walk->at;
        walk_value(walk, value);
        skip_byte(walk); // ',' or ']'
    }
    if (json_array_size(list) == 0) skip_byte(walk);
}

static void walk_value(struct walk *walk, json_t *value) {
    skip_space(walk);
    if (walk->value_at && !walk->settle) return; // found
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        walk_object(walk, value);
        break;
    case JSON_ARRAY:
        walk_list(walk, value);
        break;
    case JSON_STRING:
        skip_string(walk);
        break;
    default:
        if (walk->settle && json_is_real(value)) settle_rounding(walk->at, value);
        walk->at += strcspn(walk->at, " \t\r\n,]}");
    }
}

const char *json_locate(const struct json_file *file, const json_t *container, const char *key, size_t index, const char **key_at) {
    struct walk walk = {.at = file->text, .container = container, .key = key, .index = index};
    skip_space(&walk);
    const char *root = walk.at;
    if (container) walk_value(&walk, file->root);
    if (key_at) *key_at = walk.key_at ? walk.key_at : root;
    return walk.value_at ? walk.value_at : root;
}

// ------------------------------------------------------------------------------------------------------------------ parsing

static bool parse_failed(const struct json_file *file, const json_error_t *error) {
    const size_t position = error->position > 0 && (size_t)error->position <= file->size ? (size_t)error->position : 0;
    if (strspn(file->text, " \t\r\n") >= file->size)
        return fail(file->ctx, GN_SCENE, "%s:1:1: the file is empty, expected JSON", file->path);
    // jansson's position is behind what it complains of, which it quotes where it is short.
    const char *quoted = strstr(error->text, " near '");
    const size_t back = quoted ? strlen(quoted) - strlen(" near ''") : position > 0;
    const struct text_place place = text_place(file->text, file->text + position - (back < position ? back : position));
    return fail(file->ctx, GN_SCENE, "%s:%zu:%zu: not valid JSON: %s", file->path, place.line, place.column, error->text);
}

static bool parse(struct json_file *file, size_t flags) {
    json_error_t error;
    file->root = json_loadb(file->text, file->size, flags | JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &error);
    if (file->root) return true;
    parse_failed(file, &error);
    json_file_finish(file);
    return false;
}

bool json_text_init(struct json_file *out, struct context *ctx, const char *path, const char *text, size_t size) {
    *out = (struct json_file){.ctx = ctx, .path = path, .text = text, .size = size};
    return parse(out, 0);
}

bool json_file_init(struct json_file *out, struct context *ctx, const char *path) {
    *out = (struct json_file){.ctx = ctx, .path = path};
    if (!file_read(&out->bytes, ctx, path, GN_IO)) return false;
    const char *data = out->bytes.data;
    const size_t mark = strncmp(data, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    out->text = data + mark, out->size = out->bytes.size - mark;
    if (strncmp(data, "\xff\xfe", 2) == 0 || strncmp(data, "\xfe\xff", 2) == 0) {
        fail(ctx, GN_SCENE, "%s:1:1: the file is UTF-16, expected UTF-8", path);
        json_file_finish(out);
        return false;
    }
    if (!parse(out, JSON_DECODE_INT_AS_REAL)) return false;
    struct walk walk = {.at = out->text, .settle = true};
    walk_value(&walk, out->root);
    return true;
}

void json_file_finish(struct json_file *file) {
    json_decref(file->root);
    file_bytes_finish(&file->bytes);
    *file = (struct json_file){0};
}
