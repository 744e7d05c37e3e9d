// A list to look through: a process makes some tens of pipelines, and the key of each is mostly its SPIR-V.
#include "device/pipeline.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "device/float_controls.h"

VkDescriptorType binding_type(const struct kernel_binding *binding) {
    if (binding->image) return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    return binding->buffer->kind == BUFFER_TEXELS ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

bool kernel_fail(const char *name, struct context *ctx, struct device *device, const char *call, VkResult result) {
    char text[160];
    snprintf(text, sizeof text, "kernel '%.64s': %s", name, call);
    return device_fail(device, ctx, GN_SHADER, text, result);
}

// ------------------------------------------------------------------------------------------------------------------- keys

// Bytes to push, declarations, numbers of bindings and their kinds, constants, SPIR-V. To be freed.
static unsigned char *make_key(size_t *size, struct context *ctx, const struct kernel_params *params) {
    const size_t words = 4 + 2 * params->binding_count + 2 * params->constant_count;
    *size = words * sizeof(uint32_t) + params->spirv_size;
    unsigned char *key = array_alloc(ctx, *size, 1, "a pipeline's key");
    if (!key) return NULL;
    uint32_t *word = (uint32_t *)(void *)key;
    *word++ = params->push_size;
    *word++ = params->float_controls;
    *word++ = (uint32_t)params->binding_count;
    *word++ = (uint32_t)params->constant_count;
    for (size_t i = 0; i < params->binding_count; ++i) {
        *word++ = params->bindings[i].binding;
        *word++ = (uint32_t)binding_type(params->bindings + i);
    }
    for (size_t i = 0; i < params->constant_count; ++i) {
        *word++ = params->constants[i].id;
        *word++ = params->constants[i].value;
    }
    memcpy(word, params->spirv, params->spirv_size);
    return key;
}

static struct pipeline *find(const struct device *device, const unsigned char *key, size_t size) {
    for (struct pipeline *p = device->pipelines; p; p = p->next) {
        if (p->key_size == size && memcmp(p->key, key, size) == 0) return p;
    }
    return NULL;
}

// ----------------------------------------------------------------------------------------------------------------- making

static bool init_layout(struct pipeline *out, struct context *ctx, struct device *device, const struct kernel_params *params) {
    VkDescriptorSetLayoutBinding bindings[KERNEL_BINDINGS];
    for (size_t i = 0; i < params->binding_count; ++i) {
        bindings[i] = (VkDescriptorSetLayoutBinding){.binding = params->bindings[i].binding,
                                                     .descriptorType = binding_type(params->bindings + i),
                                                     .descriptorCount = 1,
                                                     .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    }
    const VkDescriptorSetLayoutCreateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                 .bindingCount = (uint32_t)params->binding_count,
                                                 .pBindings = bindings};
    VkResult result = vkCreateDescriptorSetLayout(device->handle, &set, NULL, &out->set_layout);
    if (result != VK_SUCCESS) return kernel_fail(params->name, ctx, device, "vkCreateDescriptorSetLayout", result);
    const VkPushConstantRange push = {.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = params->push_size};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 1,
                                             .pSetLayouts = &out->set_layout,
                                             .pushConstantRangeCount = params->push_size ? 1 : 0,
                                             .pPushConstantRanges = &push};
    result = vkCreatePipelineLayout(device->handle, &info, NULL, &out->layout);
    return result == VK_SUCCESS || kernel_fail(params->name, ctx, device, "vkCreatePipelineLayout", result);
}

static bool init_module(struct pipeline *out, struct context *ctx, struct device *device, const struct kernel_params *params) {
    const uint32_t controls = params->float_controls & float_controls_accepted(&device->float_controls);
    const size_t size = float_controls_declare(NULL, params->spirv, params->spirv_size, controls);
    if (!size) return fail(ctx, GN_SHADER, "kernel '%s': its SPIR-V has no entry point", params->name);
    uint32_t *words = array_alloc(ctx, 1, size, "a kernel's SPIR-V");
    if (!words) return false;
    float_controls_declare(words, params->spirv, params->spirv_size, controls);
    const VkShaderModuleCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = words};
    const VkResult result = vkCreateShaderModule(device->handle, &info, NULL, &out->module);
    free(words);
    return result == VK_SUCCESS || kernel_fail(params->name, ctx, device, "vkCreateShaderModule", result);
}

static bool init_handle(struct pipeline *out, struct context *ctx, struct device *device, const struct kernel_params *params) {
    VkSpecializationMapEntry entries[KERNEL_CONSTANTS];
    for (size_t i = 0; i < params->constant_count; ++i) {
        const size_t offset = i * sizeof *params->constants + offsetof(struct kernel_constant, value);
        entries[i] = (VkSpecializationMapEntry){params->constants[i].id, (uint32_t)offset, sizeof params->constants->value};
    }
    const VkSpecializationInfo constants = {.mapEntryCount = (uint32_t)params->constant_count,
                                            .pMapEntries = entries,
                                            .dataSize = params->constant_count * sizeof *params->constants,
                                            .pData = params->constants};
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = out->module,
                  .pName = "main",
                  .pSpecializationInfo = &constants},
        .layout = out->layout,
    };
    const VkResult result = vkCreateComputePipelines(device->handle, device->pipeline_cache, 1, &info, NULL, &out->handle);
    if (result != VK_SUCCESS) return kernel_fail(params->name, ctx, device, "vkCreateComputePipelines", result);
    device_label(device, VK_OBJECT_TYPE_PIPELINE, (uint64_t)out->handle, params->name);
    return true;
}

static void destroy(struct pipeline *pipeline, struct device *device) {
    if (!device->lost) {
        vkDestroyPipeline(device->handle, pipeline->handle, NULL);
        vkDestroyShaderModule(device->handle, pipeline->module, NULL);
        vkDestroyPipelineLayout(device->handle, pipeline->layout, NULL);
        vkDestroyDescriptorSetLayout(device->handle, pipeline->set_layout, NULL);
    }
    free(pipeline->key);
    free(pipeline);
}

// Takes over `key`.
static struct pipeline *make(struct context *ctx, struct device *device, const struct kernel_params *params, unsigned char *key, size_t size) {
    struct pipeline *pipeline = array_alloc(ctx, 1, sizeof *pipeline, "a pipeline");
    if (!pipeline) {
        free(key);
        return NULL;
    }
    pipeline->key = key;
    pipeline->key_size = size;
    if (init_layout(pipeline, ctx, device, params) && init_module(pipeline, ctx, device, params) &&
        init_handle(pipeline, ctx, device, params))
        return pipeline;
    destroy(pipeline, device);
    return NULL;
}

// --------------------------------------------------------------------------------------------------------------- the list

bool pipeline_acquire(struct pipeline **out, struct context *ctx, struct device *device, const struct kernel_params *params) {
    size_t size;
    unsigned char *key = make_key(&size, ctx, params);
    *out = key ? find(device, key, size) : NULL;
    if (*out) {
        free(key);
    } else {
        if (!key || !(*out = make(ctx, device, params, key, size))) return false;
        (*out)->next = device->pipelines;
        device->pipelines = *out;
        device->pipeline_count++;
    }
    (*out)->users++;
    return true;
}

void pipeline_release(struct pipeline *pipeline, struct device *device) {
    if (!pipeline || --pipeline->users > 0 || device->pipeline_count <= PIPELINES_KEPT) return;
    struct pipeline **link = &device->pipelines;
    while (*link != pipeline) link = &(*link)->next;
    *link = pipeline->next;
    device->pipeline_count--;
    destroy(pipeline, device);
}

void pipelines_finish(struct device *device) {
    while (device->pipelines) {
        struct pipeline *first = device->pipelines;
        device->pipelines = first->next;
        destroy(first, device);
    }
    device->pipeline_count = 0;
}
