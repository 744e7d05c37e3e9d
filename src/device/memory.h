// Buffers and storage images, each checked against the device's limits and memory before it is made.
#ifndef DEVICE_MEMORY_H
#define DEVICE_MEMORY_H

#include "device/allocation.h"

enum buffer_kind {
    BUFFER_TEXELS,      // read-only uniform texel buffer, R32G32B32A32_UINT: the fastest way to read on software devices
    BUFFER_STORAGE,     // storage buffer, read and written by kernels
    BUFFER_STAGING,     // for transfers only
};

// Zeroed is absent; buffer_finish accepts that.
struct buffer {
    VkBuffer handle;
    struct allocation memory;
    VkBufferView view;          // of texel buffers
    VkDeviceSize size;          // bytes, rounded up to a whole word of 16
    void *map;                  // mapped host memory (coherent); NULL for device-local memory that the host cannot see
    enum buffer_kind kind;
    const char *name;           // for messages, e.g. "triangles"
};

struct buffer_params {
    const char *name;           // for messages and debug labels
    enum buffer_kind kind;
    VkDeviceSize size;          // bytes; 0 becomes one word, so that a binding is never empty
    bool host_writes;           // the host fills it: mapped where device memory is host visible, else filled through a staging buffer
    bool host_reads;            // always mapped, cached if possible: small results, hits
};                              // neither: device-local memory that is not mapped, even where it could be

// Makes a buffer; its content is undefined. Fails with GN_LIMIT when it is larger than maxTexelBufferElements, maxStorageBufferRange,
// maxMemoryAllocationSize, or the memory that is left; see limit_fail for the message.
bool buffer_init(struct buffer *out, struct context *ctx, struct device *device, const struct buffer_params *params);
void buffer_finish(struct buffer *buffer, struct device *device);

// Fills a buffer in pieces: `fill` writes bytes [offset, offset + size) of the content to `to`; it reports why if it returns false.
// `granularity` divides every offset. Where the buffer is mapped it is called on the mapping, else on a staging buffer that is copied.
// Between the pieces progress(ctx, "upload", …) is called.
bool buffer_fill(struct buffer *buffer, struct context *ctx, struct device *device, size_t granularity,
                 bool (*fill)(void *data, void *to, uint64_t offset, uint64_t size), void *data);
// The same from plain memory: bytes [0, size).
bool buffer_upload(struct buffer *buffer, struct context *ctx, struct device *device, const void *from, size_t size);
// Copies bytes [0, size) to the host.
bool buffer_download(struct buffer *buffer, struct context *ctx, struct device *device, void *to, size_t size);

// A 2D storage image in layout GENERAL, zeroed when made. Zeroed struct is absent.
struct storage_image {
    VkImage handle;
    struct allocation memory;
    VkImageView view;
    VkFormat format;            // R32G32B32A32_SFLOAT or R32G32_SINT
    uint32_t width, height;     // pixels
    const char *name;
};

// Fails with GN_LIMIT when the device cannot have an image of this size; see limit_fail for the message.
bool storage_image_init(struct storage_image *out, struct context *ctx, struct device *device, const char *name,
                        VkFormat format, uint32_t width, uint32_t height);
void storage_image_finish(struct storage_image *image, struct device *device);
// Zeroes it again.
bool storage_image_clear(struct storage_image *image, struct context *ctx, struct device *device);
// Reads rows [0, rows) back, tightly packed.
bool storage_image_download(struct storage_image *image, struct context *ctx, struct device *device, uint32_t rows, void *to);

#endif
