// The header of a PLY file: what elements follow, and of what properties.
// Source: G. Turk, "The PLY Polygon File Format", 1994.
#ifndef SCENE_PLY_HEADER_H
#define SCENE_PLY_HEADER_H

#include "scene/array.h"
#include "scene/text.h"

enum ply_format { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN };

enum ply_type { PLY_INT8, PLY_UINT8, PLY_INT16, PLY_UINT16, PLY_INT32, PLY_UINT32, PLY_FLOAT32, PLY_FLOAT64, PLY_TYPE_COUNT };

// Bytes of a value in a binary file.
unsigned ply_type_size(enum ply_type type);

// A word of the header, in place.
struct ply_word {
    const char *at;
    size_t size;
};
bool ply_word_is(struct ply_word word, const char *name);

struct ply_property {
    struct ply_word name;
    enum ply_type type; // of the value, or of a list's items
    bool is_list;
    enum ply_type count_type; // of a list's length
};

struct ply_element {
    struct ply_word name;
    uint64_t count;               // rows
    size_t first, property_count; // its properties are first … first + property_count - 1
};

// Words point into the text. Zeroed is empty.
struct ply_header {
    enum ply_format format;
    struct array elements;   // struct ply_element
    struct array properties; // struct ply_property
};

// Reads the header and leaves text->at at the first byte of the data.
bool ply_header_init(struct ply_header *out, struct text *text);
void ply_header_finish(struct ply_header *header);

const struct ply_element *ply_element_at(const struct ply_header *header, size_t number);
const struct ply_property *ply_property_at(const struct ply_header *header, size_t number);

// The only element of this name, or NULL.
const struct ply_element *ply_element_find(const struct ply_header *header, const char *name);

// Fewest bytes that a row can take.
uint64_t ply_row_size(const struct ply_header *header, const struct ply_element *element);

#endif
