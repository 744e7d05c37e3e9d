// A kernel: SPIR-V, specialized and bound to buffers and images; and its dispatch, waited for with a limit.
#ifndef DEVICE_KERNEL_H
#define DEVICE_KERNEL_H

#include "device/memory.h"

// What stands at one binding of set 0: exactly one of buffer and image. The same buffer may stand at several.
struct kernel_binding {
    uint32_t binding;
    struct buffer *buffer;
    struct storage_image *image;
};

struct kernel_constant { uint32_t id, value; };    // specialization; bools are 0 or 1

#define KERNEL_BINDINGS 32
#define KERNEL_CONSTANTS 64

// How to make a kernel. Arrays are borrowed for the call. Every binding that the shader declares and uses anywhere must be given, also
// where a specialization constant removes the code that uses it: Vulkan judges the module as it is written.
struct kernel_params {
    const char *name;                       // for messages and debug labels; outlives the kernel
    const uint32_t *spirv;
    size_t spirv_size;                      // bytes
    const struct kernel_constant *constants;
    size_t constant_count;                  // at most KERNEL_CONSTANTS
    const struct kernel_binding *bindings;
    size_t binding_count;                   // at most KERNEL_BINDINGS
    uint32_t push_size;                     // bytes of push constants, at most 128
    uint32_t float_controls;                // FLOAT_* to declare as far as the device accepts it (device/float_controls.h) [none]
};

// Zeroed is absent; kernel_finish accepts half-made ones.
struct kernel {
    struct pipeline *pipeline;  // kept by the device, and shared by kernels that differ in nothing but what is bound
    VkDescriptorPool pool;
    VkDescriptorSet set;
    uint32_t push_size;
    bool warm;                  // has done work
    const char *name;
};

// Makes a kernel. GN_SHADER, with its name, when the SPIR-V is no whole module of Vulkan 1.1 or the driver refuses it.
bool kernel_init(struct kernel *out, struct context *ctx, struct device *device, const struct kernel_params *params);
void kernel_finish(struct kernel *kernel, struct device *device);

// Runs `groups` workgroups (at most maxComputeWorkGroupCount[0], 65535 or more) with push_size bytes of push constants, and waits. With 0
// groups nothing runs, but lavapipe compiles. *seconds, if asked for, is the time from submission to completion: by the device's timestamps
// if it has them, else by the host's clock. What the kernel wrote is visible to the host, to later dispatches and transfers.
//
// While it waits it asks progress(ctx, "device", -1, -1) some ten times a second whether to go on, so that a first dispatch that compiles
// for seconds can be cancelled within one; -1 means that there is nothing new to show. GN_DEVICE_LOST on time-out (device->dispatch_limit,
// first_dispatch_limit), saying what may help.
bool kernel_run(struct kernel *kernel, struct context *ctx, struct device *device, const void *push, uint32_t groups, double *seconds);

#endif
