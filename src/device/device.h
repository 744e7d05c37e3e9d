// A Vulkan device for compute: chosen, opened, described. Knows no scene.
//
// Everything here needs Vulkan 1.1 and a compute queue, nothing more; what else a device can do is a flag in `struct device`.
// A failing Vulkan call is reported once, with its name and result (device_fail). The validation layer's messages are errors.
// All work is submitted and waited for at once (device/commands.h), so a device is idle whenever no function of this room runs.
#ifndef DEVICE_DEVICE_H
#define DEVICE_DEVICE_H

#include <vulkan/vulkan.h>

#include "base/context.h"

// Seconds a submission may take before the device counts as hung; the first dispatch of a kernel, which may compile, gets more.
#define DISPATCH_LIMIT_SECONDS 20.0
#define FIRST_DISPATCH_LIMIT_SECONDS 120.0

struct buffer;
struct pipeline;

// What a check of the device's arithmetic found, of fp32 or of fp64 (render/arithmetic.h).
struct device_arithmetic {
    bool checked;
    uint32_t faults; // FAULT_*
};

// An open device. It must stay where it is: the validation layer's messenger knows its address.
struct device {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice handle;
    VkQueue queue;                      // one compute queue
    uint32_t queue_family;
    uint32_t timestamp_bits;            // of the queue's timestamps that count; 0: it has none, the host's clock is used
    VkDebugUtilsMessengerEXT messenger; // with validation only
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    VkDeviceSize max_allocation;        // bytes, maxMemoryAllocationSize
    VkPhysicalDeviceFloatControlsProperties float_controls; // what may be declared of floats (device/float_controls.h); else zero
    uint32_t subgroup_size;
    VkCommandPool command_pool;
    VkCommandBuffer commands;           // recorded anew for every submission
    VkFence fence;
    VkPipelineCache pipeline_cache;     // in memory only
    struct pipeline *pipelines;         // compiled kernels, kept until the device is closed (device/pipeline.h)
    uint32_t pipeline_count;
    VkQueryPool queries;                // two timestamps, or VK_NULL_HANDLE where the queue has none
    struct buffer *staging;             // for data on its way to or from memory that the host cannot see; made when first needed
    struct gn_device_info info;
    bool has_fp64, has_int64;           // enabled on the device
    struct device_arithmetic arithmetic[2]; // of fp32 and of fp64
    bool has_memory_budget;             // VK_EXT_memory_budget is enabled
    bool software;                      // a CPU device: memory is shared with this process
    bool lost;                          // the driver said so, or a wait was given up while work was running. Nothing more is submitted,
                                        // waited for or destroyed: a hung driver would block for ever. What is left is leaked on purpose.
                                        // A program must leave with _Exit then: exit() ends the driver's libraries under its running
                                        // threads (measured: 7 of 12 crashed that left so while lavapipe was compiling)
    uint32_t max_loop_steps;            // loop iterations one invocation may spend: 60000 on lavapipe before Mesa 23.1, which silently
                                        // ends loops past 65535; 1 << 22 elsewhere
    double dispatch_limit;              // DISPATCH_LIMIT_SECONDS; tests make it shorter
    double first_dispatch_limit;        // FIRST_DISPATCH_LIMIT_SECONDS
    uint64_t memory_used;               // bytes of device memory allocated by us
    uint64_t memory_budget;             // bytes that may be used, memory_used included: of the largest device-local heap; on a software
                                        // device, of the machine's free memory. Looked up when the device is opened; on a software device
                                        // also before every larger allocation
    bool validating;                    // the validation layer is at work; false where it is asked for but not installed
    uint32_t validation_errors;         // messages of the validation layer so far: errors and warnings
    char validation_message[1024];      // the first of them
};

// Opens a device. On failure reports why (GN_NO_DEVICE; for a selector that names none, listing what there is).
bool device_init(struct device *out, struct context *ctx, const struct gn_device_params *params);
// Closes it; accepts a half-made or zeroed one.
void device_finish(struct device *device);

// Lists devices as gn_device_list does.
bool device_list(struct context *ctx, const struct gn_device_params *params, struct gn_device_info *infos, uint32_t capacity,
                 uint32_t *count, int *selected);

// Reports a failed Vulkan call: "vkFoo: VK_ERROR_BAR". Device loss is GN_DEVICE_LOST, out of memory GN_LIMIT, else `status`. Returns false.
bool device_fail(struct device *device, struct context *ctx, enum gn_status status, const char *call, VkResult result);

// False, with GN_DEVICE_LOST reported, if the device was lost before.
bool device_alive(const struct device *device, struct context *ctx);

// False, with GN_INTERNAL and the layer's first message reported, if validation said anything so far.
bool device_validated(struct device *device, struct context *ctx);

// Names an object for the validation layer and debuggers; does nothing without validation. Non-dispatchable handles are passed as they are,
// cast to uint64_t.
void device_label(struct device *device, VkObjectType type, uint64_t handle, const char *name);

#endif
