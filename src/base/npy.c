// NumPy's .npy files: a magic, a version, and a header that is a Python dictionary, then the raw array. After "A Simple File Format
// for NumPy Arrays" (NEP 1) and numpy.lib.format. The header is read by a scanner for just the literals that can stand in it; a value is
// compared with what is expected piece by piece, so that spaces, kinds of quotes and closing commas do not matter.
#include "base/npy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "arrays are written as they lie in memory");
_Static_assert(sizeof(struct gn_hit) == 24 && offsetof(struct gn_hit, v) == 8 && offsetof(struct gn_hit, object) == 12 &&
                   offsetof(struct gn_hit, primitive) == 16 && offsetof(struct gn_hit, flags) == 20,
               "a hit in memory is a record of the file");

#define MAGIC "\x93NUMPY"
#define MAGIC_SIZE 6
#define MOST_DIMENSIONS 32
#define FLOAT_TYPE "'<f4'"
#define HIT_TYPE "[('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('object', '<i4'), ('primitive', '<i4'), ('flags', '<u4')]"

// ---- scanning

// The header's text not yet read.
struct scan {
    const char *at, *end;
};

static void skip_space(struct scan *scan) {
    while (scan->at < scan->end && (*scan->at == ' ' || *scan->at == '\t' || *scan->at == '\n' || *scan->at == '\r')) scan->at++;
}

// The next character that is no space; 0 at the end.
static char peek(struct scan *scan) {
    skip_space(scan);
    return scan->at < scan->end ? *scan->at : '\0';
}

static bool accept(struct scan *scan, char wanted) {
    if (wanted == '\0' || peek(scan) != wanted) return false;
    scan->at++;
    return true;
}

// A string in either kind of quotes; *out is what is between them. Escapes do not occur in the headers that we know.
static bool scan_string(struct scan *scan, struct scan *out) {
    char quote = peek(scan);
    if (quote != '\'' && quote != '"') return false;
    const char *begin = ++scan->at;
    while (scan->at < scan->end && *scan->at != quote) scan->at++;
    if (scan->at == scan->end) return false;
    *out = (struct scan){begin, scan->at++};
    return true;
}

// Any literal, to the comma or bracket that ends it; *out is its text.
static bool scan_literal(struct scan *scan, struct scan *out) {
    unsigned depth = 0;
    char next = peek(scan);
    const char *begin = scan->at;
    for (; next != '\0'; next = peek(scan)) {
        bool opens = next == '[' || next == '(' || next == '{', closes = next == ']' || next == ')' || next == '}';
        if (depth == 0 && (closes || next == ',')) break;
        struct scan string;
        if (next == '\'' || next == '"') {
            if (!scan_string(scan, &string)) return false;
            continue;
        }
        depth += opens;
        depth -= closes;
        scan->at++;
    }
    *out = (struct scan){begin, scan->at};
    while (out->end > begin && strchr(" \t\r\n", out->end[-1])) out->end--; // for messages
    return depth == 0 && out->end > begin;
}

static bool spans_equal(struct scan a, struct scan b) {
    return a.end - a.at == b.end - b.at && memcmp(a.at, b.at, (size_t)(a.end - a.at)) == 0;
}

static struct scan scan_of(const char *text) { return (struct scan){text, text + strlen(text)}; }

// A comma before a closing bracket means nothing.
static void skip_last_comma(struct scan *scan) {
    struct scan ahead = *scan;
    if (accept(&ahead, ',') && (peek(&ahead) == ')' || peek(&ahead) == ']')) *scan = ahead;
}

static bool literal_is(struct scan found, const char *wanted_text) {
    struct scan wanted = scan_of(wanted_text);
    while (peek(&wanted) != '\0') {
        struct scan string, wanted_string;
        skip_last_comma(&found);
        if (scan_string(&wanted, &wanted_string)) {
            if (!scan_string(&found, &string) || !spans_equal(string, wanted_string)) return false;
        } else if (!accept(&found, *wanted.at++)) {
            return false;
        }
    }
    return peek(&found) == '\0';
}

// ---- the header

struct header {
    struct scan descr, order, shape; // texts of the three values; `at` is NULL for one that is missing
    size_t dimensions[MOST_DIMENSIONS], dimension_count;
};

// A number of at most 18 digits, perhaps with the L of Python 2.
static bool scan_size(struct scan *scan, size_t *out) {
    uint64_t value = 0;
    unsigned digits = 0;
    for (char digit = peek(scan); scan->at < scan->end && (digit = *scan->at) >= '0' && digit <= '9'; scan->at++, digits++) {
        if (digits == 18) return false;
        value = 10 * value + (uint64_t)(digit - '0');
    }
    if (scan->at < scan->end && *scan->at == 'L') scan->at++;
    *out = (size_t)value;
    return digits > 0 && value <= SIZE_MAX;
}

static bool parse_shape(struct header *header) {
    struct scan scan = header->shape;
    if (!accept(&scan, '(')) return false;
    while (peek(&scan) != ')') {
        if (header->dimension_count == MOST_DIMENSIONS) return false;
        if (!scan_size(&scan, &header->dimensions[header->dimension_count++])) return false;
        if (!accept(&scan, ',') && peek(&scan) != ')') return false;
    }
    return accept(&scan, ')') && peek(&scan) == '\0';
}

// Puts a value where its key says. False for a key that is unknown or stands there twice.
static bool header_set(struct header *header, struct scan key, struct scan value) {
    struct {
        const char *name;
        struct scan *place;
    } keys[] = {{"descr", &header->descr}, {"fortran_order", &header->order}, {"shape", &header->shape}};
    for (size_t i = 0; i < 3; i++) {
        if (!spans_equal(key, scan_of(keys[i].name))) continue;
        if (keys[i].place->at) return false;
        *keys[i].place = value;
        return true;
    }
    return false;
}

static bool parse_dictionary(struct header *header, struct scan scan) {
    if (!accept(&scan, '{')) return false;
    while (peek(&scan) != '}') {
        struct scan key, value;
        if (!scan_string(&scan, &key) || !accept(&scan, ':') || !scan_literal(&scan, &value)) return false;
        if (!header_set(header, key, value)) return false;
        if (!accept(&scan, ',') && peek(&scan) != '}') return false;
    }
    scan.at++;
    return peek(&scan) == '\0' && scan.at == scan.end && header->descr.at && header->order.at && header->shape.at;
}

// Finds the header's text and where the array begins.
static bool find_header(const struct file_bytes *bytes, struct context *ctx, const char *path, struct scan *text) {
    const unsigned char *data = (const unsigned char *)bytes->data;
    if (bytes->size < MAGIC_SIZE + 4 || memcmp(data, MAGIC, MAGIC_SIZE) != 0)
        return fail(ctx, GN_IO, "%s: is no .npy file: it does not begin with \\x93NUMPY and a version", path);
    unsigned version = data[6];
    if (version < 1 || version > 3) return fail(ctx, GN_IO, "%s: is .npy version %u.%u; 1, 2 and 3 are known", path, version, data[7]);
    size_t start = version == 1 ? 10 : 12, length = data[8] | (size_t)data[9] << 8;
    if (bytes->size >= start && version > 1) length |= (size_t)data[10] << 16 | (size_t)data[11] << 24;
    if (bytes->size < start || length > bytes->size - start)
        return fail(ctx, GN_IO, "%s: ends inside its header: %zu bytes of header after byte %zu, the file has %zu", path, length, start,
                    bytes->size);
    *text = (struct scan){bytes->data + start, bytes->data + start + length};
    return true;
}

static int printed_length(struct scan text) { return text.end - text.at < 200 ? (int)(text.end - text.at) : 200; }

// Checks that the array is of the type, in C order, and of shape (N,) when `columns` is 0, else (N, columns).
static bool check_header(struct header *header, struct context *ctx, const char *path, const char *type, size_t columns) {
    if (!literal_is(header->descr, type))
        return fail(ctx, GN_IO, "%s: has elements of type %.*s, expected %s", path, printed_length(header->descr), header->descr.at, type);
    if (literal_is(header->order, "True"))
        return fail(ctx, GN_IO, "%s: is in Fortran order; save it in C order (numpy.ascontiguousarray)", path);
    if (!literal_is(header->order, "False"))
        return fail(ctx, GN_IO, "%s: fortran_order is %.*s, expected False", path, printed_length(header->order), header->order.at);
    bool parsed = parse_shape(header);
    if (parsed && header->dimension_count == (columns ? 2 : 1) && (!columns || header->dimensions[1] == columns)) return true;
    char expected[64];
    snprintf(expected, sizeof expected, columns ? "(N, %zu)" : "(N,)", columns);
    return fail(ctx, GN_IO, "%s: has shape %.*s, expected %s", path, printed_length(header->shape), header->shape.at, expected);
}

// ---- reading and writing

// Reads an array of records of `columns` (or 1, when 0) elements of 4 or 24 bytes. The file's own memory becomes the array's.
static bool array_read(void **out, size_t *count, struct context *ctx, const char *path, const char *type, size_t columns, size_t record) {
    *out = NULL;
    *count = 0;
    struct file_bytes bytes;
    struct header header = {0};
    struct scan text = {0};
    if (!file_read(&bytes, ctx, path, GN_IO)) return false;
    if (!find_header(&bytes, ctx, path, &text)) goto fail;
    if (!parse_dictionary(&header, text)) {
        fail(ctx, GN_IO, "%s: its header is no dictionary of descr, fortran_order and shape: %.*s", path, printed_length(text), text.at);
        goto fail;
    }
    if (!check_header(&header, ctx, path, type, columns)) goto fail;
    size_t rows = header.dimensions[0], start = (size_t)(text.end - bytes.data), size = bytes.size - start;
    if (rows > SIZE_MAX / record || rows * record != size) {
        fail(ctx, GN_IO, "%s: has %zu bytes of data where its %zu rows of %zu bytes need %s", path, size, rows, record,
             rows > size / record ? "more: it is truncated" : "less");
        goto fail;
    }
    memmove(bytes.data, bytes.data + start, size);
    *out = bytes.data;
    *count = rows;
    return true;
fail:
    file_bytes_finish(&bytes);
    return false;
}

bool npy_read_f32(float **data, size_t *rows, struct context *ctx, const char *path, size_t columns) {
    void *memory;
    bool done = array_read(&memory, rows, ctx, path, FLOAT_TYPE, columns, columns * sizeof(float));
    *data = memory;
    return done;
}

bool npy_read_hits(struct gn_hit **hits, size_t *count, struct context *ctx, const char *path) {
    void *memory;
    bool done = array_read(&memory, count, ctx, path, HIT_TYPE, 0, sizeof(struct gn_hit));
    *hits = memory;
    return done;
}

// Version 1.0: magic, version, length of what follows (2 bytes), the dictionary, and spaces and a newline up to a multiple of 64 bytes.
static bool header_write(struct output_file *file, struct context *ctx, const char *type, const char *shape) {
    char header[512];
    memcpy(header, MAGIC "\x01\x00", MAGIC_SIZE + 2);
    int length = 10 + snprintf(header + 10, sizeof header - 10, "{'descr': %s, 'fortran_order': False, 'shape': %s, }", type, shape);
    int padded = (length + 1 + 63) / 64 * 64;
    memset(header + length, ' ', (size_t)(padded - length - 1));
    header[padded - 1] = '\n';
    header[8] = (char)((padded - 10) & 255);
    header[9] = (char)((padded - 10) >> 8);
    return output_write(file, ctx, header, (size_t)padded);
}

static bool array_write(const void *data, size_t size, const char *type, const char *shape, struct context *ctx, const char *path) {
    struct output_file file;
    if (!output_begin(&file, ctx, path)) return false;
    if (header_write(&file, ctx, type, shape) && output_write(&file, ctx, data, size)) return output_commit(&file, ctx);
    output_abort(&file);
    return false;
}

bool npy_write_f32(const float *data, size_t rows, size_t columns, struct context *ctx, const char *path) {
    char shape[64];
    snprintf(shape, sizeof shape, "(%zu, %zu)", rows, columns);
    return array_write(data, rows * columns * sizeof *data, FLOAT_TYPE, shape, ctx, path);
}

bool npy_write_hits(const struct gn_hit *hits, size_t count, struct context *ctx, const char *path) {
    char shape[32];
    snprintf(shape, sizeof shape, "(%zu,)", count);
    return array_write(hits, count * sizeof *hits, HIT_TYPE, shape, ctx, path);
}
