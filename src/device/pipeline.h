// Compiled kernels that stay: every kernel of the same code, constants and kinds of bindings uses one pipeline, as long as the device is open.
//
// Drivers compile when a pipeline is made, software ones at its first dispatch; both take far longer than the work of a small batch of rays.
#ifndef DEVICE_PIPELINE_H
#define DEVICE_PIPELINE_H

#include "device/kernel.h"

#define PIPELINES_KEPT 128  // of those that no kernel uses

struct pipeline {
    struct pipeline *next;      // in the device's list
    unsigned char *key;         // all that the pipeline depends on
    size_t key_size;            // bytes
    uint32_t users;             // kernels
    VkShaderModule module;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline handle;
};

// The pipeline for these parameters, which have been checked: one that is there, else a new one. GN_SHADER when the driver refuses it.
bool pipeline_acquire(struct pipeline **out, struct context *ctx, struct device *device, const struct kernel_params *params);
// A kernel that had acquired it goes; accepts NULL.
void pipeline_release(struct pipeline *pipeline, struct device *device);
// All go, with the device. Of a lost one the driver's objects are leaked.
void pipelines_finish(struct device *device);

// What stands at a binding.
VkDescriptorType binding_type(const struct kernel_binding *binding);

// Reports a failed call as device_fail does, with the kernel's name.
bool kernel_fail(const char *name, struct context *ctx, struct device *device, const char *call, VkResult result);

#endif
