// The bytes behind a glTF file: the container, and its buffers in one piece.
#ifndef SCENE_GLTF_BUFFERS_H
#define SCENE_GLTF_BUFFERS_H

#include "scene/array.h"
#include "scene/json_read.h"

struct gltf_span {
    const char *data;
    size_t size;
};

// Finds the JSON and the binary chunk of a GLB; a file that is none is all JSON.
bool gltf_container(struct gltf_span *json, struct gltf_span *binary, struct context *ctx, const char *path, const struct file_bytes *file);

// All buffers one after the other, each at a multiple of 4. Zeroed is empty.
struct gltf_buffers {
    struct array bytes;  // char
    struct array places; // struct gltf_place, one for each buffer
};
struct gltf_place {
    size_t offset, size;
};

// Loads the buffers of a document: the binary chunk, data URIs, files beside it.
bool gltf_buffers_init(struct gltf_buffers *out, const struct json_at *root, struct gltf_span binary);
// The path that a URI names, as seen from the document; to be freed. A fault when it cannot be read.
char *gltf_uri_path(const struct json_at *at, const char *uri);
// The bytes of a data URI.
bool gltf_uri_data(struct file_bytes *out, const struct json_at *at, const char *uri);
void gltf_buffers_finish(struct gltf_buffers *buffers);

#endif
