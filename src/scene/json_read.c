// Values of a JSON document, and messages about them.
#include "scene/json_read.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/text.h"
#include "scene/words.h"

#define MOST_KEYS 32 // of an object of one kind

struct json_at at_root(const struct json_file *file) {
    return (struct json_at){.file = file, .value = file->root};
}

struct json_at at_item(const struct json_at *list, size_t index) {
    return (struct json_at){.file = list->file, .parent = list, .index = index, .value = json_array_get(list->value, index)};
}

// ----------------------------------------------------------------------------------------------------------------- messages

// The way from the root, e.g. "shapes[3].radius".
struct way {
    char text[320];
};

static void way_append(struct way *way, const struct json_at *at) {
    if (!at->parent) return;
    way_append(way, at->parent);
    const size_t used = strlen(way->text), room = sizeof way->text - used;
    if (at->key)
        snprintf(way->text + used, room, "%s%s", used ? "." : "", excerpt_word(at->key).text);
    else
        snprintf(way->text + used, room, "[%zu]", at->index);
}

static struct way way_to(const struct json_at *at) {
    struct way way = {""};
    way_append(&way, at);
    if (!way.text[0]) snprintf(way.text, sizeof way.text, "the scene");
    return way;
}

// Where a value stands in the text, and its key.
static const char *locate(const struct json_at *at, const char **key_at) {
    return json_locate(at->file, at->parent ? at->parent->value : NULL, at->key, at->index, key_at);
}

static bool fail_at(const struct json_at *at, const char *place_at, const char *message) {
    const struct text_place place = text_place(at->file->text, place_at);
    return fail(at->file->ctx, GN_SCENE, "%s:%zu:%zu: %s %s", at->file->path, place.line, place.column, way_to(at).text, message);
}

bool at_fail(const struct json_at *at, const char *format, ...) {
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail_at(at, locate(at, NULL), message);
}

bool at_fail_as(const struct json_at *at, const struct gn_error *error) {
    if (error->status == GN_SCENE) return at_fail(at, "cannot be used: %s", error->message);
    return fail(at->file->ctx, error->status, "%s", error->message);
}

bool at_expected(const struct json_at *at, const char *expected) {
    static const char *const kinds[] = {[JSON_OBJECT] = "an object", [JSON_ARRAY] = "a list", [JSON_STRING] = "a string",
                                        [JSON_TRUE] = "true",        [JSON_FALSE] = "false",  [JSON_NULL] = "null"};
    const char *text = locate(at, NULL);
    struct excerpt number = excerpt_make(text, strcspn(text, " \t\r\n,]}"));
    return at_fail(at, "is %s, expected %s", json_is_number(at->value) ? number.text : kinds[json_typeof(at->value)], expected);
}

// Names parted by commas, as many as fit.
struct names {
    char text[768];
};

static void names_append(struct names *names, const char *format, const char *name) {
    const size_t used = strlen(names->text);
    if (used > 0) snprintf(names->text + used, sizeof names->text - used, ", ");
    const size_t parted = strlen(names->text);
    snprintf(names->text + parted, sizeof names->text - parted, format, name);
}

// Reports a fault about a key of an object, at the key.
static bool fail_at_key(const struct json_at *object, const char *key, const char *message) {
    const struct json_at member = {.file = object->file, .parent = object, .key = key, .value = json_object_get(object->value, key)};
    const char *key_at;
    locate(&member, &key_at);
    return fail_at(object, key_at, message);
}

static bool unknown_key(const struct json_at *object, const char *key, const struct json_key *known, uint32_t kind) {
    struct names names = {""};
    struct nearest nearest = nearest_to(key);
    for (size_t i = 0; known[i].name; i++) {
        if (!(known[i].kinds & kind)) continue;
        names_append(&names, "%s", known[i].name);
        nearest_offer(&nearest, known[i].name);
    }
    char message[1024];
    snprintf(message, sizeof message, "has an unknown key '%s', expected one of: %s%s", excerpt_word(key).text, names.text,
             nearest_hint(&nearest).text);
    return fail_at_key(object, key, message);
}

static bool foreign_key(const struct json_at *object, const struct json_key *key, const char *const *kinds, int kind) {
    struct names names = {""};
    for (int i = 0; kinds[i]; i++)
        if (key->kinds >> i & 1) names_append(&names, "\"%s\"", kinds[i]);
    char message[1024];
    snprintf(message, sizeof message, "has a key '%s', which belongs to %s, not to \"%s\"", key->name, names.text, kinds[kind]);
    return fail_at_key(object, key->name, message);
}

// ------------------------------------------------------------------------------------------------------------------- values

bool at_object_of_kind(const struct json_at *at, const struct json_key *known, const char *const *names, int kind) {
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    const char *key;
    json_t *value;
    json_object_foreach(at->value, key, value) {
        size_t i = 0;
        while (known[i].name && strcmp(key, known[i].name) != 0) i++;
        if (!known[i].name) return unknown_key(at, key, known, 1u << kind);
        if (!(known[i].kinds >> kind & 1)) return foreign_key(at, &known[i], names, kind);
    }
    return true;
}

bool at_object(const struct json_at *at, const char *const *known) {
    struct json_key keys[MOST_KEYS + 1] = {{0}};
    for (size_t i = 0; known[i] && i < MOST_KEYS; i++) keys[i] = (struct json_key){known[i], 1};
    return at_object_of_kind(at, keys, NULL, 0);
}

bool at_list(const struct json_at *at, size_t least, size_t most, const char *expected) {
    if (!json_is_array(at->value)) return at_expected(at, expected);
    const size_t size = json_array_size(at->value);
    if (size >= least && size <= most) return true;
    return at_fail(at, "is a list of %zu, expected %s", size, expected);
}

bool at_member(struct json_at *out, const struct json_at *object, const char *key) {
    *out = (struct json_at){.file = object->file, .parent = object, .key = key, .value = json_object_get(object->value, key)};
    return out->value != NULL;
}

bool at_require(const struct json_at *object, const char *key, const char *expected) {
    struct json_at member;
    return at_member(&member, object, key) || at_fail(object, "has no '%s', expected %s", key, expected);
}

static const char *const range_texts[] = {
    [RANGE_ANY] = "a number",
    [RANGE_NOT_NEGATIVE] = "a number of at least 0",
    [RANGE_POSITIVE] = "a number greater than 0",
    [RANGE_SHARE] = "a number from 0 to 1",
    [RANGE_FIELD_OF_VIEW] = "a number greater than 0 and less than 180",
    [RANGE_CONE] = "a number from 0 to 90",
    [RANGE_ANISOTROPY] = "a number greater than -1 and less than 1",
    [RANGE_FILTER] = "a number greater than 0, at most 16",
};

static bool in_range(double value, enum json_range range) {
    switch (range) {
    case RANGE_NOT_NEGATIVE:
        return value >= 0;
    case RANGE_POSITIVE:
        return value > 0;
    case RANGE_SHARE:
        return value >= 0 && value <= 1;
    case RANGE_CONE:
        return value >= 0 && value <= 90;
    case RANGE_ANISOTROPY:
        return value > -1 && value < 1;
    case RANGE_FILTER:
        return value > 0 && value <= 16;
    case RANGE_FIELD_OF_VIEW:
        return value > 0 && value < 180;
    default:
        return true;
    }
}

bool at_double(const struct json_at *at, double *out) {
    if (!json_is_number(at->value)) return at_expected(at, "a number");
    *out = json_number_value(at->value);
    return true;
}

bool at_float(const struct json_at *at, enum json_range range, float *out) {
    if (!json_is_number(at->value)) return at_expected(at, range_texts[range]);
    const double value = json_number_value(at->value);
    if (!in_range(value, range)) return at_expected(at, range_texts[range]);
    char expected[128];
    if (!(fabs(value) < FLT_MAX + 0x1p103)) { // from here on rounding gives infinity
        snprintf(expected, sizeof expected, "%s within the range of fp32, ±3.4028235e38", range_texts[range]);
        return at_expected(at, expected);
    }
    const float rounded = (float)value;
    if (!in_range(rounded, range)) {
        snprintf(expected, sizeof expected, "%s; in fp32 this is %g", range_texts[range], (double)rounded);
        return at_expected(at, expected);
    }
    *out = rounded;
    return true;
}

bool at_floats(const struct json_at *at, enum json_range range, size_t count, float *out) {
    char expected[32];
    snprintf(expected, sizeof expected, "a list of %zu numbers", count);
    if (!at_list(at, count, count, expected)) return false;
    for (size_t i = 0; i < count; i++) {
        const struct json_at item = at_item(at, i);
        if (!at_float(&item, range, &out[i])) return false;
    }
    return true;
}

bool at_text(const struct json_at *at, const char *expected, const char **out) {
    if (!json_is_string(at->value)) return at_expected(at, expected);
    *out = json_string_value(at->value);
    return true;
}

bool at_get_text(const struct json_at *object, const char *key, const char *expected, const char **out) {
    struct json_at member;
    return !at_member(&member, object, key) || at_text(&member, expected, out);
}

bool at_get_float(const struct json_at *object, const char *key, enum json_range range, float *out) {
    struct json_at member;
    return !at_member(&member, object, key) || at_float(&member, range, out);
}

bool at_get_floats(const struct json_at *object, const char *key, enum json_range range, size_t count, float *out) {
    struct json_at member;
    return !at_member(&member, object, key) || at_floats(&member, range, count, out);
}

bool at_get_float3(const struct json_at *object, const char *key, enum json_range range, float out[3]) {
    return at_get_floats(object, key, range, 3, out);
}

bool at_get_count(const struct json_at *object, const char *key, uint32_t least, uint32_t most, uint32_t *out) {
    struct json_at member;
    if (!at_member(&member, object, key)) return true;
    const double value = json_number_value(member.value); // 0 for what is no number
    if (!json_is_number(member.value) || !(value >= least && value <= most) || value != floor(value)) {
        char expected[64];
        snprintf(expected, sizeof expected, "an integer from %u to %u", least, most);
        return at_expected(&member, expected);
    }
    *out = (uint32_t)value;
    return true;
}

bool at_get_bool(const struct json_at *object, const char *key, bool *out) {
    struct json_at member;
    if (!at_member(&member, object, key)) return true;
    if (!json_is_boolean(member.value)) return at_expected(&member, "true or false");
    *out = json_is_true(member.value);
    return true;
}

bool at_choice(const struct json_at *at, const char *const *names, int *out) {
    char expected[192] = "";
    for (size_t i = 0, used = 0; names[i]; i++)
        used += (size_t)snprintf(expected + used, sizeof expected - used, "%s\"%s\"", i == 0 ? "" : names[i + 1] ? ", " : " or ", names[i]);
    const char *name = "";
    if (!at_text(at, expected, &name)) return false;
    struct nearest nearest = nearest_to(name);
    for (int i = 0; names[i]; i++) {
        if (strcmp(names[i], name) == 0) {
            *out = i;
            return true;
        }
        nearest_offer(&nearest, names[i]);
    }
    return at_fail(at, "is \"%s\", expected %s%s", excerpt_word(name).text, expected, nearest_hint(&nearest).text);
}

bool at_get_choice(const struct json_at *object, const char *key, const char *const *names, int *out) {
    struct json_at member;
    return !at_member(&member, object, key) || at_choice(&member, names, out);
}
