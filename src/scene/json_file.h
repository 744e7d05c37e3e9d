// A JSON document: jansson parses; what it does not keep, the place of each value in the text, is found again when it is needed.
#ifndef SCENE_JSON_FILE_H
#define SCENE_JSON_FILE_H

#include <jansson.h>

#include "base/file.h"

// A parsed document. Zeroed is absent; json_file_finish accepts that.
struct json_file {
    struct context *ctx;
    const char *path;
    struct file_bytes bytes; // of a file
    const char *text;        // bytes.data behind a byte order mark
    size_t size;             // of the text
    json_t *root;
};

// Reads and parses. GN_IO when the file cannot be read, GN_SCENE for what is no JSON: duplicate keys and what is not UTF-8, too.
bool json_file_init(struct json_file *out, struct context *ctx, const char *path);
// Parses text that the caller keeps; its end may be any byte. Integers stay integers.
bool json_text_init(struct json_file *out, struct context *ctx, const char *path, const char *text, size_t size);
void json_file_finish(struct json_file *file);

// Where member `key` of an object, or with key NULL item `index` of a list, stands in the text; container NULL: the root. *key_at, if
// asked for, is where the key stands. Takes time in proportion to the text.
const char *json_locate(const struct json_file *file, const json_t *container, const char *key, size_t index, const char **key_at);

#endif
