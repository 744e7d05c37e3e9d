// A Vulkan device for compute: chosen, opened, described. Knows no scene.
//
// Everything here needs Vulkan 1.1 and a compute queue, nothing more; what else a device can do is a flag in `struct device`.
// A failing Vulkan call is reported once, with its name and result (device_fail). The validation layer's messages are errors.
#ifndef DEVICE_DEVICE_H
#define DEVICE_DEVICE_H

#include <vulkan/vulkan.h>

#include "base/context.h"

struct device {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice handle;
    VkQueue queue;                      // one compute queue
    uint32_t queue_family;
    VkDebugUtilsMessengerEXT messenger; // with validation only
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    VkCommandPool command_pool;
    VkPipelineCache pipeline_cache;
    VkQueryPool queries;                // two timestamps, or VK_NULL_HANDLE where the queue has none
    struct gn_device_info info;
    bool has_fp64, has_int64;           // enabled on the device
    bool software;                      // a CPU device: memory is shared with this process
    bool lost;                          // a wait timed out or the driver said so: nothing more is submitted
    uint32_t max_loop_steps;            // loop iterations one invocation may spend: 60000 on lavapipe before Mesa 23.1, which silently
                                        // ends loops past 65535; 1 << 22 elsewhere
    uint64_t memory_used;               // bytes of device memory allocated by us
    uint64_t memory_budget;             // bytes that may be used: of the largest heap; on a software device, of the machine's free memory
    uint32_t validation_errors;         // messages of the validation layer so far
    char validation_message[1024];      // the first of them
    struct gn_error startup_error;
};

// Opens a device. On failure reports why (GN_NO_DEVICE; GN_USAGE for a selector that names none, listing what there is).
bool device_init(struct device *out, struct context *ctx, const struct gn_device_params *params);
void device_finish(struct device *device);

// Lists devices as gn_device_list does.
bool device_list(struct context *ctx, const struct gn_device_params *params, struct gn_device_info *infos, uint32_t capacity,
                 uint32_t *count, int *selected);

// Reports a failed Vulkan call: "vkFoo: VK_ERROR_BAR". Device loss is GN_DEVICE_LOST, out of memory GN_LIMIT, else `status`. Returns false.
bool device_fail(struct device *device, struct context *ctx, enum gn_status status, const char *call, VkResult result);

// False, with GN_INTERNAL and the layer's first message reported, if validation said anything so far.
bool device_validated(struct device *device, struct context *ctx);

#endif
