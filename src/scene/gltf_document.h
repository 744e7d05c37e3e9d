// A glTF document: its JSON and its buffers, and what refers to what in them, checked. Shared by the parts of the reader (gltf.c).
#ifndef SCENE_GLTF_DOCUMENT_H
#define SCENE_GLTF_DOCUMENT_H

#include "scene/gltf_buffers.h"
#include "scene/mesh.h"

#define GLTF_NONE UINT32_MAX // no material, no light, …

struct gltf {
    struct context *ctx;
    struct json_file json;
    struct json_at root;
    struct gltf_buffers buffers;
    uint64_t elements; // of all accessors so far
};

// Reads a file, its JSON and its buffers. *file must be kept as long as the document.
bool gltf_init(struct gltf *out, struct file_bytes *file, struct context *ctx, const char *path);
void gltf_finish(struct gltf *gltf);

// A list of the root whose items are objects; missing, it is empty. Count in *count.
bool gltf_list(struct json_at *out, const struct gltf *gltf, const char *key, uint32_t *count);

// A member that is the number of an item in a list of the root; GLTF_NONE where the member is missing.
bool gltf_get_index(const struct gltf *gltf, const struct json_at *object, const char *key, const char *list, uint32_t *index);

// An item of a list of the root, which must be an object.
struct gltf_item {
    struct json_at list, at;
};
bool gltf_get_item(struct gltf_item *out, const struct gltf *gltf, const char *list, uint32_t index);

// The member of an object's "extensions", if it is there; *found says.
struct gltf_extension {
    struct json_at extensions, at;
    bool found;
};
bool gltf_get_extension(struct gltf_extension *out, const struct json_at *object, const char *name);

// Numbers in a buffer. A missing accessor has count 0.
struct gltf_accessor {
    size_t offset, stride; // in the buffers, bytes
    uint32_t count;
    uint32_t component; // componentType
    unsigned width;     // components of an element
};

// What the components of an accessor may be.
enum gltf_components { GLTF_FLOATS, GLTF_INTEGERS, GLTF_UNITS }; // GLTF_UNITS: floats, or normalized unsigned integers of 1 or 2 bytes

// The accessor that member `key` of an object names, all of whose elements are there.
bool gltf_get_accessor(struct gltf_accessor *out, struct gltf *gltf, const struct json_at *object, const char *key, unsigned width,
                       enum gltf_components components);

// A component of an element.
float gltf_float(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t element, unsigned component);
uint32_t gltf_integer(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t element);

// A span of the buffers that a view names.
bool gltf_get_view(struct gltf_span *out, const struct gltf *gltf, uint32_t number);

#endif
