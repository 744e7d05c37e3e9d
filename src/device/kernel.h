// A kernel: SPIR-V, specialized and bound to buffers and images; and its dispatch, waited for with a limit.
#ifndef DEVICE_KERNEL_H
#define DEVICE_KERNEL_H

#include "device/memory.h"

// What stands at one binding of set 0: exactly one of buffer and image.
struct kernel_binding {
    uint32_t binding;
    struct buffer *buffer;
    struct storage_image *image;
};

struct kernel_constant { uint32_t id, value; };    // specialization; bools are 0 or 1

// How to make a kernel. Arrays are borrowed for the call.
struct kernel_params {
    const char *name;                       // for messages and debug labels
    const uint32_t *spirv;
    size_t spirv_size;                      // bytes
    const struct kernel_constant *constants;
    size_t constant_count;                  // at most 64
    const struct kernel_binding *bindings;
    size_t binding_count;                   // at most 32
    uint32_t push_size;                     // bytes of push constants, at most 128
};

// Zeroed is absent; kernel_finish accepts half-made ones.
struct kernel {
    VkShaderModule module;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkCommandBuffer commands;
    VkFence fence;
    uint32_t push_size;
    bool warm;                  // has been dispatched: the driver has compiled it
    const char *name;
};

// GN_SHADER with the kernel's name and what the driver said.
bool kernel_init(struct kernel *out, struct context *ctx, struct device *device, const struct kernel_params *params);
void kernel_finish(struct kernel *kernel, struct device *device);

// Seconds a dispatch may take before the device counts as hung; the first of a kernel, which may compile, gets more.
#define DISPATCH_LIMIT_SECONDS 20.0
#define FIRST_DISPATCH_LIMIT_SECONDS 120.0

// Runs `groups` workgroups (split over y by the kernel's own means is not needed: at most 65535) and waits. *seconds, if asked for, is the
// time from submission to completion: the device's timestamps if it has them, else the host's clock.
// Results written by the kernel are visible to the host and to later dispatches. Polls every 100 ms, so that progress(ctx, …) can cancel the
// caller between dispatches. GN_DEVICE_LOST on time-out, saying what may help (a smaller tile, another MESA_SHADER_CACHE_DIR, an update of the driver);
// the device is then marked lost and its objects are not waited for again.
bool kernel_run(struct kernel *kernel, struct context *ctx, struct device *device, const void *push, uint32_t groups, double *seconds);

#endif
