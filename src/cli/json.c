#include "cli/json.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

json_t *json_members(const struct json_member *members, size_t count) {
    json_t *object = json_object();
    bool done = object != NULL;
    for (size_t i = 0; i < count; i++) done = json_object_set_new(object, members[i].name, members[i].value) == 0 && done;
    if (done) return object;
    json_decref(object);
    return NULL;
}

// The length of the UTF-8 character at `text`, or 0 if it is none. Overlong forms and surrogates are left to json_string.
static size_t character_length(const unsigned char *text) {
    size_t length = text[0] < 0x80 ? 1 : text[0] >> 5 == 6 ? 2 : text[0] >> 4 == 14 ? 3 : text[0] >> 3 == 30 ? 4 : 0;
    for (size_t i = 1; i < length; i++)
        if (text[i] >> 6 != 2) return 0;
    return length;
}

json_t *json_words(const char *text) {
    json_t *value = json_string(text);
    if (value) return value;
    char *copy = malloc(strlen(text) + 1), *to = copy;
    if (!copy) return NULL;
    while (*text) {
        char character[5] = "";
        size_t length = character_length((const unsigned char *)text);
        memcpy(character, text, length);
        json_t *valid = length ? json_string(character) : NULL;
        if (valid)
            memcpy(to, character, length);
        else
            *to = '?', length = 1;
        json_decref(valid);
        to += length, text += length;
    }
    *to = 0;
    value = json_string(copy);
    free(copy);
    return value;
}

json_t *json_number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

json_t *json_ms(double ms) { return json_number(round(1e3 * ms) / 1e3); }

json_t *json_names(const char *list) {
    json_t *names = json_array();
    while (*list) {
        size_t length = strcspn(list, ",");
        json_array_append_new(names, json_stringn(list, length));
        list += length + (list[length] != 0);
    }
    return names;
}
