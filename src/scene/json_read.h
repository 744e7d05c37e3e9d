// Reading the values of a JSON document, with messages that say where and what was expected.
//
// A `struct json_at` (functions at_…) is a value together with the way to it from the root; it lives on the reader's stack. Every function
// that can fail reports GN_SCENE "file:line:column: shapes[3].radius is -1, expected a number greater than 0". Members are named by the
// object they are in and their key; a missing optional member leaves *out as it is.
#ifndef SCENE_JSON_READ_H
#define SCENE_JSON_READ_H

#include "scene/json_file.h"

struct json_at {
    const struct json_file *file;
    const struct json_at *parent; // NULL: the root
    const char *key;              // in the parent, or NULL:
    size_t index;                 // in the parent, a list
    json_t *value;
};

struct json_at at_root(const struct json_file *file);
struct json_at at_item(const struct json_at *list, size_t index);

// Reports "file:line:column: <way to the value> …". Returns false.
bool at_fail(const struct json_at *at, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Passes on a fault of what the value names, as "… <way> cannot be used: …" if the scene is to blame. Returns false.
bool at_fail_as(const struct json_at *at, const struct gn_error *error);

// Reports "… <way> is <value>, expected …". Returns false.
bool at_expected(const struct json_at *at, const char *expected);

// Whether this is an object all of whose keys are known; `known` ends with NULL.
bool at_object(const struct json_at *at, const char *const *known);
// The same where keys depend on what kind of object it is: `kinds` has bit 1 << number of each kind that has the key, `names` the kinds'
// names; the last key is NULL. A key of another kind is an error that says which kinds have it.
struct json_key {
    const char *name;
    uint32_t kinds;
};
bool at_object_of_kind(const struct json_at *at, const struct json_key *known, const char *const *names, int kind);
// Whether this is a list of `least` to `most` items; expected: for the message.
bool at_list(const struct json_at *at, size_t least, size_t most, const char *expected);

// The member, if there is one.
bool at_member(struct json_at *out, const struct json_at *object, const char *key);
// Whether the member is there; reports that it is missing if not.
bool at_require(const struct json_at *object, const char *key, const char *expected);

// What a number must be.
enum json_range {
    RANGE_ANY,
    RANGE_NOT_NEGATIVE,
    RANGE_POSITIVE,
    RANGE_SHARE,         // 0 to 1
    RANGE_FIELD_OF_VIEW, // between 0 and 180
    RANGE_CONE,          // 0 to 90
    RANGE_ANISOTROPY,    // between -1 and 1
    RANGE_FILTER,        // above 0, up to 16
};

// The value as the nearest fp32.
bool at_float(const struct json_at *at, enum json_range range, float *out);
// The value as fp64.
bool at_double(const struct json_at *at, double *out);
// A list of `count` numbers as the nearest fp32.
bool at_floats(const struct json_at *at, enum json_range range, size_t count, float *out);
// A string without a zero in it; valid as long as the file.
bool at_text(const struct json_at *at, const char *expected, const char **out);

// Optional members.
bool at_get_text(const struct json_at *object, const char *key, const char *expected, const char **out);
bool at_get_float(const struct json_at *object, const char *key, enum json_range range, float *out);
bool at_get_float3(const struct json_at *object, const char *key, enum json_range range, float out[3]);
bool at_get_floats(const struct json_at *object, const char *key, enum json_range range, size_t count, float *out);
bool at_get_count(const struct json_at *object, const char *key, uint32_t least, uint32_t most, uint32_t *out);
bool at_get_bool(const struct json_at *object, const char *key, bool *out);
// One of names[0 …], which end with NULL, by number.
bool at_choice(const struct json_at *at, const char *const *names, int *out);
bool at_get_choice(const struct json_at *object, const char *key, const char *const *names, int *out);

#endif
