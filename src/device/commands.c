// Work for the device: recorded, submitted, and waited for with a limit.
//
// A fence that never comes must not hang the program, and Ctrl-C must work while a driver compiles for seconds. So a wait is made of
// slices, and may be given up. Work that is given up goes on running; the device is then marked lost, and nothing it may still use is
// freed.
#include "device/commands.h"

#include "base/clock.h"

#define SLICE_NANOSECONDS 80000000u
#define CANCEL_GRACE_SECONDS 0.5

static bool init_pool(struct device *device, struct context *ctx) {
    const VkCommandPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = device->queue_family};
    VkResult result = vkCreateCommandPool(device->handle, &info, NULL, &device->command_pool);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_NO_DEVICE, "vkCreateCommandPool", result);
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = device->command_pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    result = vkAllocateCommandBuffers(device->handle, &commands, &device->commands);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_NO_DEVICE, "vkAllocateCommandBuffers", result);
    return true;
}

static bool init_queries(struct device *device, struct context *ctx) {
    if (!device->timestamp_bits || !(device->properties.limits.timestampPeriod > 0)) return true;
    const VkQueryPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = 2};
    const VkResult result = vkCreateQueryPool(device->handle, &info, NULL, &device->queries);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_NO_DEVICE, "vkCreateQueryPool", result);
}

bool commands_init(struct device *device, struct context *ctx) {
    if (!init_pool(device, ctx) || !init_queries(device, ctx)) return false;
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkResult result = vkCreateFence(device->handle, &fence, NULL, &device->fence);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_NO_DEVICE, "vkCreateFence", result);
    const VkPipelineCacheCreateInfo cache = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    result = vkCreatePipelineCache(device->handle, &cache, NULL, &device->pipeline_cache);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_NO_DEVICE, "vkCreatePipelineCache", result);
}

void commands_finish(struct device *device) {
    vkDestroyPipelineCache(device->handle, device->pipeline_cache, NULL);
    vkDestroyFence(device->handle, device->fence, NULL);
    vkDestroyQueryPool(device->handle, device->queries, NULL);
    vkDestroyCommandPool(device->handle, device->command_pool, NULL);
}

bool commands_begin(struct device *device, struct context *ctx) {
    if (!device_alive(device, ctx)) return false;
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    const VkResult result = vkBeginCommandBuffer(device->commands, &info);
    return result == VK_SUCCESS || device_fail(device, ctx, GN_INTERNAL, "vkBeginCommandBuffer", result);
}

void commands_barrier(struct device *device, VkPipelineStageFlags stage, VkAccessFlags access) {
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = access,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                         VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(device->commands, stage,
                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier,
                         0, NULL, 0, NULL);
}

static bool give_up(struct device *device, struct context *ctx, const char *kind, const char *name, double limit) {
    device->lost = true;
    return fail(ctx, GN_DEVICE_LOST,
                "%s '%s': the device '%s' did not answer within %.3g s and is given up. What may help: smaller pieces of work (tiles), "
                "an empty shader cache (set MESA_SHADER_CACHE_DIR to a new folder), a newer driver (this one: %s)",
                kind, name, device->info.name, limit, device->info.driver);
}

static bool wait_for_fence(struct device *device, struct context *ctx, const char *kind, const char *name, double limit) {
    const double start = clock_seconds();
    double end = start + limit;
    bool cancelled = false;
    for (;;) {
        const VkResult result = vkWaitForFences(device->handle, 1, &device->fence, VK_TRUE, SLICE_NANOSECONDS);
        if (result == VK_SUCCESS) return !cancelled;
        if (result != VK_TIMEOUT) {
            device->lost = true;
            return device_fail(device, ctx, GN_DEVICE_LOST, "vkWaitForFences", result);
        }
        const double now = clock_seconds();
        if (!cancelled && !progress(ctx, "device", -1, -1)) {
            cancelled = true;
            end = now + CANCEL_GRACE_SECONDS < end ? now + CANCEL_GRACE_SECONDS : end;
        }
        if (now >= end) return give_up(device, ctx, kind, name, limit);
    }
}

bool commands_run(struct device *device, struct context *ctx, const char *kind, const char *name, double limit) {
    VkResult result = vkEndCommandBuffer(device->commands);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_INTERNAL, "vkEndCommandBuffer", result);
    result = vkResetFences(device->handle, 1, &device->fence);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_INTERNAL, "vkResetFences", result);
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &device->commands};
    result = vkQueueSubmit(device->queue, 1, &submit, device->fence);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_INTERNAL, "vkQueueSubmit", result);
    return wait_for_fence(device, ctx, kind, name, limit);
}
