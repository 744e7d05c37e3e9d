// GLB chunks (glTF 2.0, 4.4), buffers and their URIs (3.6.1, 2.8).
#include "scene/gltf_buffers.h"

#include <stdlib.h>
#include <string.h>

#include "scene/build.h"
#include "scene/words.h"

#define CHUNK_JSON 0x4e4f534au
#define CHUNK_BIN 0x004e4942u
#define MOST_BYTES UINT32_MAX // of a GLB

static uint32_t little_endian(const char *bytes) {
    const unsigned char *b = (const unsigned char *)bytes;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

// The chunk at `offset`; false when it does not fit.
static bool chunk_at(struct gltf_span *out, const struct file_bytes *file, size_t offset, uint32_t type) {
    if (file->size < 8 || offset > file->size - 8 || little_endian(file->data + offset + 4) != type) return false;
    *out = (struct gltf_span){file->data + offset + 8, little_endian(file->data + offset)};
    return out->size <= file->size - offset - 8;
}

bool gltf_container(struct gltf_span *json, struct gltf_span *binary, struct context *ctx, const char *path,
                    const struct file_bytes *file) {
    *binary = (struct gltf_span){0};
    if (file->size < 4 || memcmp(file->data, "glTF", 4) != 0) {
        const size_t mark = strncmp(file->data, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
        *json = (struct gltf_span){file->data + mark, file->size - mark};
        return true;
    }
    if (file->size < 12 || little_endian(file->data + 4) != 2)
        return fail(ctx, GN_SCENE, "%s: byte 4: is no GLB of version 2, expected one", path);
    if (little_endian(file->data + 8) > file->size)
        return fail(ctx, GN_SCENE, "%s: byte 8: the file is to have %u bytes, but it has %zu", path, little_endian(file->data + 8),
                    file->size);
    if (!chunk_at(json, file, 12, CHUNK_JSON)) return fail(ctx, GN_SCENE, "%s: byte 12: no whole JSON chunk, expected one", path);
    const size_t next = 20 + (json->size + 3) / 4 * 4;
    if (next >= little_endian(file->data + 8)) return true;
    return chunk_at(binary, file, next, CHUNK_BIN) || fail(ctx, GN_SCENE, "%s: byte %zu: no whole binary chunk, expected one", path, next);
}

// ---------------------------------------------------------------------------------------------------------------------- URIs

static int base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

// Decodes into to[0 … capacity); the number of bytes decoded, which ends before the first character that is no base64.
static size_t base64_decode(char *to, size_t capacity, const char *from) {
    uint32_t bits = 0;
    size_t count = 0;
    for (int held = 0; count < capacity && base64_value(*from) >= 0; from++) {
        bits = bits << 6 | (uint32_t)base64_value(*from);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        to[count++] = (char)(bits >> held & 0xff);
    }
    return count;
}

static int hex_value(char c) {
    const char *digits = "0123456789abcdef", *found = c ? strchr(digits, c >= 'A' && c <= 'F' ? c + ('a' - 'A') : c) : NULL;
    return found ? (int)(found - digits) : -1;
}

// Replaces %20 and the like, in place.
static void percent_decode(char *text) {
    char *to = text;
    for (; *text; text++) {
        const int high = *text == '%' ? hex_value(text[1]) : -1, low = high >= 0 ? hex_value(text[2]) : -1;
        *to++ = low >= 0 ? (char)(16 * high + low) : *text;
        if (low >= 0) text += 2;
    }
    *to = '\0';
}

// ------------------------------------------------------------------------------------------------------------------- buffers

// Makes room for `size` bytes of zeros at the end.
static char *append(struct gltf_buffers *buffers, struct context *ctx, size_t size) {
    struct array *bytes = &buffers->bytes;
    const size_t padded = (size + 3) / 4 * 4;
    if (padded > MOST_BYTES - bytes->count) {
        fail(ctx, GN_LIMIT, "the buffers of a glTF file have more than 4 GiB");
        return NULL;
    }
    if (!array_reserve(bytes, ctx, bytes->count + padded)) return NULL;
    char *room = (char *)bytes->items + bytes->count;
    memset(room, 0, padded);
    bytes->count += padded;
    return room;
}

char *gltf_uri_path(const struct json_at *at, const char *uri) {
    char *path = path_beside(at->file->path, uri);
    if (!path) {
        fail(at->file->ctx, GN_LIMIT, "no memory for a path");
        return NULL;
    }
    percent_decode(path + (strlen(path) - strlen(uri)));
    const char *trouble = path_unreadable(path);
    if (!trouble) return path;
    at_fail(at, "is \"%s\", expected a file that can be read: %s", excerpt_word(uri).text, trouble);
    free(path);
    return NULL;
}

bool gltf_uri_data(struct file_bytes *out, const struct json_at *at, const char *uri) {
    const char *base64 = strstr(uri, ";base64,");
    if (!base64) return at_fail(at, "is a data URI of another kind, expected base64");
    base64 += strlen(";base64,");
    out->data = array_alloc(at->file->ctx, strlen(base64) * 3 / 4 + 1, 1, "a data URI");
    if (out->data) out->size = base64_decode(out->data, strlen(base64) * 3 / 4, base64);
    return out->data != NULL;
}

static bool load_file(struct gltf_buffers *out, const struct json_at *at, const char *uri, size_t size) {
    struct context *ctx = at->file->ctx;
    char *path = gltf_uri_path(at, uri);
    struct file_bytes file = {0};
    bool done = path && file_read(&file, ctx, path, GN_SCENE);
    if (done && file.size < size) done = at_fail(at, "is \"%s\" of %zu bytes, expected %zu", excerpt_word(uri).text, file.size, size);
    char *room = done ? append(out, ctx, size) : NULL;
    if (room) memcpy(room, file.data, size);
    file_bytes_finish(&file);
    free(path);
    return room != NULL;
}

static bool load_data(struct gltf_buffers *out, const struct json_at *at, const char *uri, size_t size) {
    const char *base64 = strstr(uri, ";base64,");
    if (!base64) return at_fail(at, "is a data URI of another kind, expected base64");
    // Not before it is known that so much is there.
    if (size > strlen(base64) * 3 / 4) return at_fail(at, "holds less than the %zu bytes that byteLength says", size);
    char *room = append(out, at->file->ctx, size);
    if (!room) return false;
    const size_t decoded = base64_decode(room, size, base64 + strlen(";base64,"));
    return decoded == size || at_fail(at, "holds %zu bytes, expected %zu", decoded, size);
}

static bool load_binary(struct gltf_buffers *out, const struct json_at *at, struct gltf_span binary, size_t size) {
    if (at->index > 0 || !binary.data) return at_fail(at, "has no 'uri', expected one: there is no binary chunk for it");
    if (size > binary.size) return at_fail(at, "has %zu bytes, but the binary chunk has %zu", size, binary.size);
    char *room = append(out, at->file->ctx, size);
    if (room) memcpy(room, binary.data, size);
    return room != NULL;
}

static bool load_buffer(struct gltf_buffers *out, const struct json_at *at, struct gltf_span binary) {
    uint32_t size = 0;
    const char *uri = NULL;
    struct json_at uri_at;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_require(at, "byteLength", "a number of bytes") || !at_get_count(at, "byteLength", 1, UINT32_MAX - 3, &size)) return false;
    const bool has_uri = at_member(&uri_at, at, "uri");
    if (has_uri && !at_text(&uri_at, "a URI", &uri)) return false;
    struct gltf_place *place = array_push(&out->places, at->file->ctx);
    if (!place) return false;
    *place = (struct gltf_place){out->bytes.count, size};
    if (!has_uri) return load_binary(out, at, binary, size);
    return strncmp(uri, "data:", 5) == 0 ? load_data(out, &uri_at, uri, size) : load_file(out, &uri_at, uri, size);
}

bool gltf_buffers_init(struct gltf_buffers *out, const struct json_at *root, struct gltf_span binary) {
    *out = (struct gltf_buffers){
        .bytes = {.item_size = 1, .what = "glTF buffers"},
        .places = {.item_size = sizeof(struct gltf_place), .what = "glTF buffers"},
    };
    struct json_at buffers;
    if (!at_member(&buffers, root, "buffers")) return true;
    bool done = at_list(&buffers, 0, 65536, "a list of at most 65536 buffers");
    for (size_t i = 0; done && i < json_array_size(buffers.value); i++) {
        const struct json_at at = at_item(&buffers, i);
        done = load_buffer(out, &at, binary);
    }
    if (!done) gltf_buffers_finish(out);
    return done;
}

void gltf_buffers_finish(struct gltf_buffers *buffers) {
    array_finish(&buffers->bytes);
    array_finish(&buffers->places);
}
