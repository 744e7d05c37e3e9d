// JSON values of results, made with jansson so that nothing can go wrong halfway.
#ifndef CLI_JSON_H
#define CLI_JSON_H

#include <jansson.h>
#include <stddef.h>

// A member of an object. The value is taken over; NULL stands for no memory.
struct json_member {
    const char *name;
    json_t *value;
};

// An object of these members, in this order; NULL, with all values released, when one of them is or memory runs out.
json_t *json_members(const struct json_member *members, size_t count);
#define JSON_MEMBERS(members) json_members(members, sizeof(members) / sizeof *(members))

// A text; where it is not UTF-8, as file names need not be, a question mark for each such byte.
json_t *json_words(const char *text);

// A number; null where it is not finite.
json_t *json_number(double value);

// Milliseconds, rounded to microseconds.
json_t *json_ms(double ms);

// ["a", "b"] of "a,b".
json_t *json_names(const char *list);

#endif
