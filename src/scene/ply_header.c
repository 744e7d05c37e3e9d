// A header is lines of words. Each line is cut into words, and the first one says what it is.
#include "scene/ply_header.h"

#include <string.h>

#include "scene/number.h"
#include "scene/words.h"

static const struct {
    const char *name, *new_name;
    unsigned size;
} types[PLY_TYPE_COUNT] = {
    [PLY_INT8] = {"char", "int8", 1},        [PLY_UINT8] = {"uchar", "uint8", 1},      [PLY_INT16] = {"short", "int16", 2},
    [PLY_UINT16] = {"ushort", "uint16", 2},  [PLY_INT32] = {"int", "int32", 4},        [PLY_UINT32] = {"uint", "uint32", 4},
    [PLY_FLOAT32] = {"float", "float32", 4}, [PLY_FLOAT64] = {"double", "float64", 8},
};

unsigned ply_type_size(enum ply_type type) { return types[type].size; }

bool ply_word_is(struct ply_word word, const char *name) { return word.size == strlen(name) && memcmp(word.at, name, word.size) == 0; }

const struct ply_element *ply_element_at(const struct ply_header *header, size_t number) {
    return (const struct ply_element *)header->elements.items + number;
}

const struct ply_property *ply_property_at(const struct ply_header *header, size_t number) {
    return (const struct ply_property *)header->properties.items + number;
}

const struct ply_element *ply_element_find(const struct ply_header *header, const char *name) {
    for (size_t i = 0; i < header->elements.count; i++)
        if (ply_word_is(ply_element_at(header, i)->name, name)) return ply_element_at(header, i);
    return NULL;
}

uint64_t ply_row_size(const struct ply_header *header, const struct ply_element *element) {
    if (header->format == PLY_ASCII) return 2 * (uint64_t)element->property_count; // a digit and what parts it from the next
    uint64_t size = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const struct ply_property *property = ply_property_at(header, element->first + i);
        size += ply_type_size(property->is_list ? property->count_type : property->type);
    }
    return size;
}

// -------------------------------------------------------------------------------------------------------------------- lines

#define MOST_WORDS 6 // more on a line are not looked at
#define MOST_ELEMENTS 256
#define MOST_PROPERTIES 1024 // of all elements

struct line {
    struct ply_word words[MOST_WORDS]; // a missing one has size 0 and stands at the line's end
    size_t count;
};

// Cuts the line at text->at into words and moves behind its end. With `crlf`, "\r\n" ends lines; else a '\r' or a '\n' alone does: in a
// binary file the byte behind a lone '\r' is data.
static void line_read(struct line *out, struct text *text, bool crlf) {
    const char *end = text->at + strcspn(text->at, "\r\n");
    out->count = 0;
    for (const char *at = text->at;;) {
        at += strspn(at, " \t");
        if (at >= end || out->count == MOST_WORDS) break;
        const size_t size = strcspn(at, " \t\r\n");
        out->words[out->count++] = (struct ply_word){at, size};
        at += size;
    }
    for (size_t i = out->count; i < MOST_WORDS; i++) out->words[i] = (struct ply_word){end, 0};
    if (end[0] == '\r' && crlf && end[1] == '\n') end++;
    text->at = end < text->end ? end + 1 : text->end;
}

static bool word_expected(const struct text *text, struct ply_word word, const char *expected) {
    if (word.size == 0) return text_fail(text, word.at, "expected %s, found the end of the line", expected);
    return text_fail(text, word.at, "expected %s, found '%s'", expected, excerpt_make(word.at, word.size).text);
}

static bool read_format(struct ply_header *out, const struct text *text, const struct line *line) {
    static const char *const formats[] = {
        [PLY_ASCII] = "ascii", [PLY_LITTLE_ENDIAN] = "binary_little_endian", [PLY_BIG_ENDIAN] = "binary_big_endian"};
    if (!ply_word_is(line->words[2], "1.0")) return word_expected(text, line->words[2], "the version 1.0");
    for (int i = 0; i < 3; i++) {
        if (!ply_word_is(line->words[1], formats[i])) continue;
        out->format = (enum ply_format)i;
        return true;
    }
    return word_expected(text, line->words[1], "ascii, binary_little_endian or binary_big_endian");
}

static bool read_element(struct ply_header *out, const struct text *text, const struct line *line) {
    int64_t count;
    const char *end = number_i64(&count, line->words[2].at);
    if (line->words[1].size == 0) return word_expected(text, line->words[1], "the name of an element");
    if (end != line->words[2].at + line->words[2].size || count < 0) return word_expected(text, line->words[2], "a number of rows");
    if (out->elements.count == MOST_ELEMENTS)
        return text_fail(text, line->words[0].at, "more than %d elements, expected fewer", MOST_ELEMENTS);
    struct ply_element *element = array_push(&out->elements, text->ctx);
    if (!element) return false;
    *element = (struct ply_element){.name = line->words[1], .count = (uint64_t)count, .first = out->properties.count};
    return true;
}

static bool read_type(enum ply_type *out, const struct text *text, struct ply_word word) {
    for (int i = 0; i < PLY_TYPE_COUNT; i++) {
        if (!ply_word_is(word, types[i].name) && !ply_word_is(word, types[i].new_name)) continue;
        *out = (enum ply_type)i;
        return true;
    }
    return word_expected(text, word, "a type: char, uchar, short, ushort, int, uint, float or double");
}

static bool read_property(struct ply_header *out, const struct text *text, const struct line *line) {
    if (out->elements.count == 0) return text_fail(text, line->words[0].at, "a property before any element, expected an element first");
    struct ply_element *element = (struct ply_element *)out->elements.items + out->elements.count - 1;
    struct ply_property property = {.is_list = ply_word_is(line->words[1], "list")};
    const struct ply_word *words = line->words + (property.is_list ? 2 : 0);
    property.name = words[2];
    if (property.is_list && !read_type(&property.count_type, text, line->words[2])) return false;
    if (!read_type(&property.type, text, words[1])) return false;
    if (property.name.size == 0) return word_expected(text, property.name, "the name of a property");
    if (property.is_list && property.count_type >= PLY_FLOAT32)
        return text_fail(text, line->words[2].at, "a list with a length that is no integer, expected an integer type");
    for (size_t i = 0; i < element->property_count; i++) {
        const struct ply_word other = ply_property_at(out, element->first + i)->name;
        if (other.size == property.name.size && memcmp(other.at, property.name.at, other.size) == 0)
            return text_fail(text, property.name.at, "property '%s' is there twice, expected different names",
                             excerpt_make(other.at, other.size).text);
    }
    if (out->properties.count == MOST_PROPERTIES)
        return text_fail(text, property.name.at, "more than %d properties, expected fewer", MOST_PROPERTIES);
    struct ply_property *added = array_push(&out->properties, text->ctx);
    if (!added) return false;
    *added = property;
    element->property_count++;
    return true;
}

// Whether the data can hold what the header promises, before memory is asked for.
static bool check_sizes(const struct ply_header *header, const struct text *text) {
    const uint64_t left = (uint64_t)(text->end - text->at);
    for (size_t i = 0; i < header->elements.count; i++) {
        const struct ply_element *element = ply_element_at(header, i);
        const uint64_t size = ply_row_size(header, element);
        if (size > 0 && element->count > (left + 1) / size) // the last number of a text needs nothing behind it
            return text_fail(text, element->name.at, "%llu rows of at least %llu bytes are promised, but %llu bytes follow the header",
                             (unsigned long long)element->count, (unsigned long long)size, (unsigned long long)left);
        for (size_t k = 0; k < i; k++) {
            const struct ply_word other = ply_element_at(header, k)->name;
            if (other.size == element->name.size && memcmp(other.at, element->name.at, other.size) == 0)
                return text_fail(text, element->name.at, "element '%s' is there twice, expected different names",
                                 excerpt_make(other.at, other.size).text);
        }
    }
    return true;
}

static bool read_lines(struct ply_header *out, struct text *text) {
    struct line line;
    bool crlf = strncmp(text->at, "ply\r\n", 5) == 0, has_format = false;
    line_read(&line, text, crlf);
    if (line.count == 0 || !ply_word_is(line.words[0], "ply"))
        return text_fail(text, text->begin, "is no PLY file, expected 'ply' on the first line");
    while (text->at < text->end) {
        const char *start = text->at;
        line_read(&line, text, crlf);
        const struct ply_word first = line.words[0];
        bool good = true;
        if (ply_word_is(first, "end_header")) return has_format || text_fail(text, start, "the header ends without a format line");
        if (ply_word_is(first, "format"))
            good = has_format = read_format(out, text, &line);
        else if (ply_word_is(first, "element"))
            good = read_element(out, text, &line);
        else if (ply_word_is(first, "property"))
            good = read_property(out, text, &line);
        else if (first.size > 0 && !ply_word_is(first, "comment") && !ply_word_is(first, "obj_info"))
            good = word_expected(text, first, "format, element, property, comment or end_header");
        if (!good) return false;
        if (text->at <= start) break;
    }
    return text_fail(text, text->at, "the file ends within the header, expected 'end_header'");
}

bool ply_header_init(struct ply_header *out, struct text *text) {
    *out = (struct ply_header){
        .elements = {.item_size = sizeof(struct ply_element), .what = "PLY elements"},
        .properties = {.item_size = sizeof(struct ply_property), .what = "PLY properties"},
    };
    if (read_lines(out, text) && check_sizes(out, text)) return true;
    ply_header_finish(out);
    return false;
}

void ply_header_finish(struct ply_header *header) {
    array_finish(&header->elements);
    array_finish(&header->properties);
}
