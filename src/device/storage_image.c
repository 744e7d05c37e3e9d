// Storage images: made, zeroed, read back. They stay in layout GENERAL.
#include <stdio.h>
#include <string.h>

#include "device/commands.h"
#include "device/memory.h"
#include "device/staging.h"

static const VkImageSubresourceRange WHOLE = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .levelCount = 1, .layerCount = 1};
static const VkImageUsageFlags USAGE = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

static VkDeviceSize pixel_bytes(VkFormat format) { return format == VK_FORMAT_R32G32_SINT ? 8 : 16; }

static VkDeviceSize row_bytes(const struct storage_image *image) { return image->width * pixel_bytes(image->format); }

// Width, height and bytes; each against its limit.
static bool check_size(struct context *ctx, struct device *device, const struct storage_image *image) {
    VkImageFormatProperties limits;
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(device->physical, image->format, VK_IMAGE_TYPE_2D,
                                                                     VK_IMAGE_TILING_OPTIMAL, USAGE, 0, &limits);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_INTERNAL, "vkGetPhysicalDeviceImageFormatProperties", result);
    if (image->width == 0 || image->height == 0) return fail(ctx, GN_INTERNAL, "image '%s' has no pixels", image->name);
    if (image->width > limits.maxExtent.width || image->height > limits.maxExtent.height) {
        return fail(ctx, GN_LIMIT, "image '%s' is %u x %u pixels, but the device allows %u x %u (maxImageDimension2D)", image->name,
                    image->width, image->height, limits.maxExtent.width, limits.maxExtent.height);
    }
    const VkDeviceSize bytes = row_bytes(image) * image->height;
    if (bytes > limits.maxResourceSize) return limit_fail(ctx, "image", image->name, bytes, limits.maxResourceSize, "maxResourceSize");
    return allocation_check(ctx, device, "image", image->name, bytes);
}

static bool init_handle(struct storage_image *out, struct context *ctx, struct device *device) {
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = out->format,
        .extent = {out->width, out->height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = USAGE,
    };
    const VkResult result = vkCreateImage(device->handle, &info, NULL, &out->handle);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_LIMIT, "vkCreateImage", result);
    device_label(device, VK_OBJECT_TYPE_IMAGE, (uint64_t)out->handle, out->name);
    return true;
}

static bool init_memory(struct storage_image *out, struct context *ctx, struct device *device) {
    struct allocation_params memory = {.what = "image", .name = out->name};
    vkGetImageMemoryRequirements(device->handle, out->handle, &memory.requirements);
    if (!allocation_init(&out->memory, ctx, device, &memory)) return false;
    const VkResult result = vkBindImageMemory(device->handle, out->handle, out->memory.memory, 0);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_LIMIT, "vkBindImageMemory", result);
}

static bool init_view(struct storage_image *out, struct context *ctx, struct device *device) {
    const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = out->handle,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = out->format,
                                        .subresourceRange = WHOLE};
    const VkResult result = vkCreateImageView(device->handle, &info, NULL, &out->view);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_LIMIT, "vkCreateImageView", result);
}

static void record_transition(struct storage_image *image, struct device *device) {
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->handle,
        .subresourceRange = WHOLE,
    };
    vkCmdPipelineBarrier(device->commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1,
                         &barrier);
}

static bool zero(struct storage_image *image, struct context *ctx, struct device *device, bool is_new) {
    if (!commands_begin(device, ctx)) return false;
    if (is_new) record_transition(image, device);
    vkCmdClearColorImage(device->commands, image->handle, VK_IMAGE_LAYOUT_GENERAL, &(VkClearColorValue){{0}}, 1, &WHOLE);
    commands_barrier(device, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    return commands_run(device, ctx, "image", image->name, device->dispatch_limit);
}

bool storage_image_init(struct storage_image *out, struct context *ctx, struct device *device, const char *name, VkFormat format,
                        uint32_t width, uint32_t height) {
    *out = (struct storage_image){.name = name, .format = format, .width = width, .height = height};
    if (!device_alive(device, ctx) || !check_size(ctx, device, out)) goto fail;
    if (!init_handle(out, ctx, device) || !init_memory(out, ctx, device) || !init_view(out, ctx, device)) goto fail;
    if (!zero(out, ctx, device, true)) goto fail;
    return true;
fail:
    storage_image_finish(out, device);
    return false;
}

void storage_image_finish(struct storage_image *image, struct device *device) {
    if (image->handle && !device->lost) {
        vkDestroyImageView(device->handle, image->view, NULL);
        vkDestroyImage(device->handle, image->handle, NULL);
        allocation_finish(&image->memory, device);
    }
    memset(image, 0, sizeof *image);
}

bool storage_image_clear(struct storage_image *image, struct context *ctx, struct device *device) {
    return zero(image, ctx, device, false);
}

static bool download_rows(struct storage_image *image, struct context *ctx, struct device *device, uint32_t first, uint32_t rows,
                          struct buffer *staging) {
    if (!commands_begin(device, ctx)) return false;
    const VkBufferImageCopy region = {
        .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
        .imageOffset = {0, (int32_t)first, 0},
        .imageExtent = {image->width, rows, 1},
    };
    vkCmdCopyImageToBuffer(device->commands, image->handle, VK_IMAGE_LAYOUT_GENERAL, staging->handle, 1, &region);
    commands_barrier(device, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    return commands_run(device, ctx, "image", image->name, device->dispatch_limit);
}

bool storage_image_download(struct storage_image *image, struct context *ctx, struct device *device, uint32_t rows, void *to) {
    if (rows > image->height) return fail(ctx, GN_INTERNAL, "image '%s': %u rows are more than it has", image->name, rows);
    struct buffer *staging = device_alive(device, ctx) ? staging_buffer(device, ctx) : NULL;
    if (!staging) return false;
    const VkDeviceSize row = row_bytes(image);
    const uint32_t most = (uint32_t)(STAGING_BYTES / row);
    for (uint32_t first = 0; first < rows; first += most) {
        const uint32_t count = rows - first < most ? rows - first : most;
        if (!download_rows(image, ctx, device, first, count, staging)) return false;
        memcpy((char *)to + first * row, staging->map, count * row);
    }
    return true;
}
