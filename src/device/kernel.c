// A kernel: SPIR-V, specialized and bound to buffers and images; and its dispatch.
#include "device/kernel.h"

#include <string.h>

#include "base/clock.h"
#include "device/commands.h"
#include "device/pipeline.h"
#include "device/spirv.h"

enum { MAX_PUSH = 128, TYPE_COUNT = 3 };

static const VkDescriptorType TYPES[TYPE_COUNT] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
};

static bool check_binding(struct context *ctx, const char *name, const struct kernel_binding *binding) {
    const bool one = !binding->buffer != !binding->image;
    if (one && (binding->image || binding->buffer->kind != BUFFER_STAGING)) return true;
    return fail(ctx, GN_INTERNAL, "kernel '%s': binding %u needs one buffer or one image", name, binding->binding);
}

static bool check_params(struct context *ctx, struct device *device, const struct kernel_params *params) {
    if (!device_alive(device, ctx)) return false;
    if (params->constant_count > KERNEL_CONSTANTS || params->binding_count > KERNEL_BINDINGS || params->push_size > MAX_PUSH ||
        params->push_size % 4) {
        return fail(ctx, GN_INTERNAL, "kernel '%s': too many constants (%zu), bindings (%zu) or bytes to push (%u)", params->name,
                    params->constant_count, params->binding_count, params->push_size);
    }
    for (size_t i = 0; i < params->binding_count; ++i) {
        if (!check_binding(ctx, params->name, params->bindings + i)) return false;
    }
    const char *fault = spirv_fault(params->spirv, params->spirv_size);
    return !fault || fail(ctx, GN_SHADER, "kernel '%s': this is not SPIR-V that Vulkan 1.1 reads: %s", params->name, fault);
}

// A pool for this one set: as many descriptors of each type as there are bindings of it.
static bool init_set(struct kernel *out, struct context *ctx, struct device *device, const struct kernel_params *params) {
    VkDescriptorPoolSize sizes[TYPE_COUNT];
    uint32_t used = 0;
    for (int type = 0; type < TYPE_COUNT; ++type) {
        uint32_t count = 0;
        for (size_t i = 0; i < params->binding_count; ++i) count += binding_type(params->bindings + i) == TYPES[type];
        if (count) sizes[used++] = (VkDescriptorPoolSize){TYPES[type], count};
    }
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = used, .pPoolSizes = sizes};
    VkResult result = vkCreateDescriptorPool(device->handle, &pool, NULL, &out->pool);
    if (result != VK_SUCCESS) return kernel_fail(out->name, ctx, device, "vkCreateDescriptorPool", result);
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = out->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &out->pipeline->set_layout};
    result = vkAllocateDescriptorSets(device->handle, &info, &out->set);
    return result == VK_SUCCESS || kernel_fail(out->name, ctx, device, "vkAllocateDescriptorSets", result);
}

static void bind(struct kernel *kernel, struct device *device, const struct kernel_binding *binding) {
    VkDescriptorBufferInfo buffer = {.range = VK_WHOLE_SIZE};
    VkDescriptorImageInfo image = {.imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = kernel->set,
                                  .dstBinding = binding->binding,
                                  .descriptorCount = 1,
                                  .descriptorType = binding_type(binding),
                                  .pImageInfo = &image,
                                  .pBufferInfo = &buffer};
    if (binding->image) image.imageView = binding->image->view;
    if (binding->buffer) buffer.buffer = binding->buffer->handle;
    if (binding->buffer) write.pTexelBufferView = &binding->buffer->view;
    vkUpdateDescriptorSets(device->handle, 1, &write, 0, NULL);
}

bool kernel_init(struct kernel *out, struct context *ctx, struct device *device, const struct kernel_params *params) {
    memset(out, 0, sizeof *out);
    if (!check_params(ctx, device, params)) return false;
    out->name = params->name;
    out->push_size = params->push_size;
    if (!pipeline_acquire(&out->pipeline, ctx, device, params) || !init_set(out, ctx, device, params)) goto fail;
    for (size_t i = 0; i < params->binding_count; ++i) bind(out, device, params->bindings + i);
    return true;
fail:
    kernel_finish(out, device);
    return false;
}

void kernel_finish(struct kernel *kernel, struct device *device) {
    if (kernel->pool && !device->lost) vkDestroyDescriptorPool(device->handle, kernel->pool, NULL);
    pipeline_release(kernel->pipeline, device);
    memset(kernel, 0, sizeof *kernel);
}

static void record_time(struct device *device, VkPipelineStageFlagBits stage, uint32_t query) {
    if (!device->queries) return;
    if (query == 0) vkCmdResetQueryPool(device->commands, device->queries, 0, 2);
    vkCmdWriteTimestamp(device->commands, stage, device->queries, query);
}

static void record(struct kernel *kernel, struct device *device, const void *push, uint32_t groups) {
    VkCommandBuffer commands = device->commands;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel->pipeline->handle);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel->pipeline->layout, 0, 1, &kernel->set, 0, NULL);
    if (kernel->push_size) vkCmdPushConstants(commands, kernel->pipeline->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, kernel->push_size, push);
    record_time(device, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0);
    vkCmdDispatch(commands, groups, 1, 1);
    record_time(device, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 1);
    commands_barrier(device, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
}

// Seconds between the two timestamps. `clock`, what the host measured, where there are none or they claim more than can be.
static double elapsed(struct device *device, double clock) {
    uint64_t stamps[2];
    if (!device->queries) return clock;
    const VkResult result =
        vkGetQueryPoolResults(device->handle, device->queries, 0, 2, sizeof stamps, stamps, sizeof *stamps, VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS) return clock;
    const uint64_t mask = device->timestamp_bits < 64 ? (UINT64_C(1) << device->timestamp_bits) - 1 : UINT64_MAX;
    const double seconds = (double)((stamps[1] - stamps[0]) & mask) * device->properties.limits.timestampPeriod * 1e-9;
    return seconds > 0 && seconds <= clock ? seconds : clock;
}

bool kernel_run(struct kernel *kernel, struct context *ctx, struct device *device, const void *push, uint32_t groups, double *seconds) {
    if (seconds) *seconds = 0;
    const uint32_t most = device->properties.limits.maxComputeWorkGroupCount[0];
    if (groups > most) return fail(ctx, GN_INTERNAL, "kernel '%s': %u workgroups are more than %u", kernel->name, groups, most);
    if (!commands_begin(device, ctx)) return false;
    record(kernel, device, push, groups);
    const double start = clock_seconds();
    // llvmpipe compiles a pipeline again for what is bound to it: the first dispatch of each kernel may take as long as the pipeline's first.
    if (!commands_run(device, ctx, "kernel", kernel->name, kernel->warm ? device->dispatch_limit : device->first_dispatch_limit))
        return false;
    if (seconds) *seconds = elapsed(device, clock_seconds() - start);
    if (groups) kernel->warm = true;
    return true;
}
