// Buffers: made, filled, read back.
#include <string.h>

#include "device/commands.h"
#include "device/memory.h"
#include "device/staging.h"

// Bytes of a word: a texel, and what sizes are rounded up to.
enum { WORD = 16 };

static VkBufferUsageFlags usage(enum buffer_kind kind) {
    const VkBufferUsageFlags transfer = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    switch (kind) {
    case BUFFER_TEXELS:
        return transfer | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    case BUFFER_STORAGE:
        return transfer | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    default:
        return transfer;
    }
}

static bool check_size(struct context *ctx, struct device *device, const struct buffer_params *params) {
    const VkPhysicalDeviceLimits *limits = &device->properties.limits;
    const VkDeviceSize texels = (VkDeviceSize)limits->maxTexelBufferElements * WORD;
    const VkDeviceSize range = limits->maxStorageBufferRange / WORD * WORD;
    if (params->kind == BUFFER_TEXELS && params->size > texels) {
        return limit_fail(ctx, "buffer", params->name, params->size, texels, "maxTexelBufferElements");
    }
    if (params->kind == BUFFER_STORAGE && params->size > range) {
        return limit_fail(ctx, "buffer", params->name, params->size, range, "maxStorageBufferRange");
    }
    return allocation_check(ctx, device, "buffer", params->name, params->size);
}

// Never a power of two for texel buffers: llvmpipe compiles a kernel once more when one was none before, or the other way round.
static VkDeviceSize size_to_make(const struct buffer *buffer) {
    const bool power_of_two = (buffer->size & (buffer->size - 1)) == 0;
    if (buffer->kind != BUFFER_TEXELS || !power_of_two) return buffer->size;
    return buffer->size + (buffer->size == WORD ? 2 * WORD : WORD);
}

static bool init_handle(struct buffer *out, struct context *ctx, struct device *device) {
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size_to_make(out), .usage = usage(out->kind)};
    const VkResult result = vkCreateBuffer(device->handle, &info, NULL, &out->handle);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_LIMIT, "vkCreateBuffer", result);
    device_label(device, VK_OBJECT_TYPE_BUFFER, (uint64_t)out->handle, out->name);
    return true;
}

static bool init_memory(struct buffer *out, struct context *ctx, struct device *device, const struct buffer_params *params) {
    struct allocation_params memory = {
        .what = "buffer", .name = params->name, .host_writes = params->host_writes, .host_reads = params->host_reads};
    vkGetBufferMemoryRequirements(device->handle, out->handle, &memory.requirements);
    if (!allocation_init(&out->memory, ctx, device, &memory)) return false;
    out->map = out->memory.map;
    const VkResult result = vkBindBufferMemory(device->handle, out->handle, out->memory.memory, 0);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_LIMIT, "vkBindBufferMemory", result);
}

static bool init_view(struct buffer *out, struct context *ctx, struct device *device) {
    if (out->kind != BUFFER_TEXELS) return true;
    const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                         .buffer = out->handle,
                                         .format = VK_FORMAT_R32G32B32A32_UINT,
                                         .range = VK_WHOLE_SIZE};
    const VkResult result = vkCreateBufferView(device->handle, &info, NULL, &out->view);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_LIMIT, "vkCreateBufferView", result);
}

bool buffer_init(struct buffer *out, struct context *ctx, struct device *device, const struct buffer_params *params) {
    memset(out, 0, sizeof *out);
    if (!device_alive(device, ctx) || !check_size(ctx, device, params)) return false;
    out->name = params->name;
    out->kind = params->kind;
    out->size = params->size ? (params->size + WORD - 1) / WORD * WORD : WORD;
    if (!init_handle(out, ctx, device) || !init_memory(out, ctx, device, params) || !init_view(out, ctx, device)) goto fail;
    return true;
fail:
    buffer_finish(out, device);
    return false;
}

void buffer_finish(struct buffer *buffer, struct device *device) {
    if (buffer->handle && !device->lost) {
        vkDestroyBufferView(device->handle, buffer->view, NULL);
        vkDestroyBuffer(device->handle, buffer->handle, NULL);
        allocation_finish(&buffer->memory, device);
    }
    memset(buffer, 0, sizeof *buffer);
}

static bool copy(struct buffer *to, VkDeviceSize to_offset, struct buffer *from, VkDeviceSize from_offset, VkDeviceSize size,
                 struct context *ctx, struct device *device) {
    if (!commands_begin(device, ctx)) return false;
    vkCmdCopyBuffer(device->commands, from->handle, to->handle, 1, &(VkBufferCopy){from_offset, to_offset, size});
    commands_barrier(device, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    return commands_run(device, ctx, "buffer", to->kind == BUFFER_STAGING ? from->name : to->name, device->dispatch_limit);
}

// Bytes of a piece: as many as the staging buffer holds of `granularity` each.
static VkDeviceSize piece_size(size_t granularity) { return STAGING_BYTES - STAGING_BYTES % granularity; }

static VkDeviceSize smaller(VkDeviceSize a, VkDeviceSize b) { return a < b ? a : b; }

static bool fill_pieces(struct buffer *buffer, struct context *ctx, struct device *device, VkDeviceSize end, size_t granularity,
                        bool (*fill)(void *data, void *to, uint64_t offset, uint64_t size), void *data) {
    struct buffer *staging = buffer->map ? NULL : staging_buffer(device, ctx);
    if (!buffer->map && !staging) return false;
    const VkDeviceSize piece = piece_size(granularity);
    for (VkDeviceSize offset = 0; offset < end; offset += piece) {
        const VkDeviceSize size = smaller(piece, end - offset);
        if (offset && !progress(ctx, "upload", (double)offset / (double)end, -1)) return false;
        if (!fill(data, staging ? staging->map : (char *)buffer->map + offset, offset, size)) return false;
        if (staging && !copy(buffer, offset, staging, 0, size, ctx, device)) return false;
    }
    return true;
}

bool buffer_fill(struct buffer *buffer, struct context *ctx, struct device *device, size_t granularity,
                 bool (*fill)(void *data, void *to, uint64_t offset, uint64_t size), void *data) {
    if (!device_alive(device, ctx)) return false;
    if (granularity == 0 || granularity > STAGING_BYTES) {
        return fail(ctx, GN_INTERNAL, "buffer '%s': it cannot be filled in pieces of %zu bytes", buffer->name, granularity);
    }
    return fill_pieces(buffer, ctx, device, buffer->size, granularity, fill, data);
}

static bool check_range(struct buffer *buffer, struct context *ctx, struct device *device, size_t size) {
    if (size > buffer->size) return fail(ctx, GN_INTERNAL, "buffer '%s': %zu bytes are more than it has", buffer->name, size);
    return device_alive(device, ctx);
}

static bool fill_from_memory(void *data, void *to, uint64_t offset, uint64_t size) {
    memcpy(to, (const char *)data + offset, size);
    return true;
}

bool buffer_upload(struct buffer *buffer, struct context *ctx, struct device *device, const void *from, size_t size) {
    return check_range(buffer, ctx, device, size) && fill_pieces(buffer, ctx, device, size, 1, fill_from_memory, (void *)from);
}

bool buffer_download(struct buffer *buffer, struct context *ctx, struct device *device, void *to, size_t size) {
    if (!check_range(buffer, ctx, device, size)) return false;
    struct buffer *staging = buffer->map ? NULL : staging_buffer(device, ctx);
    if (!buffer->map && !staging) return false;
    const VkDeviceSize piece = piece_size(1);
    for (VkDeviceSize offset = 0; offset < size; offset += piece) {
        const VkDeviceSize bytes = smaller(piece, size - offset);
        if (staging && !copy(staging, 0, buffer, offset, bytes, ctx, device)) return false;
        memcpy((char *)to + offset, staging ? staging->map : (char *)buffer->map + offset, bytes);
    }
    return true;
}
