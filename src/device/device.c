// Opening, describing and closing a device.
#include "device/device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "device/allocation.h"
#include "device/candidate.h"
#include "device/commands.h"
#include "device/instance.h"
#include "device/pipeline.h"
#include "device/select.h"
#include "device/staging.h"

// "; there are: 0 'NVIDIA …' (discrete), 1 'llvmpipe …' (cpu, cannot be used: …)"
static void format_devices(char *out, size_t capacity, const struct candidate *candidates, uint32_t count) {
    size_t length = 0;
    *out = 0;
    for (uint32_t i = 0; i < count && length < capacity; ++i) {
        const struct gn_device_info *info = &candidates[i].info;
        const int added = snprintf(out + length, capacity - length, "%s%u '%s' (%s%s%s)", i ? ", " : "; there are: ", info->index,
                                   info->name, info->type, info->usable ? "" : ", cannot be used: ", info->usable ? "" : info->reason);
        length += added > 0 ? (size_t)added : 0;
    }
}

static int select_candidate(const struct candidate *candidates, uint32_t count, const char *selector) {
    struct gn_device_info infos[MAX_CANDIDATES];
    for (uint32_t i = 0; i < count; ++i) infos[i] = candidates[i].info;
    return device_select(infos, count, selector);
}

// The candidate that `selector` means, or NULL with the reason reported.
static const struct candidate *choose(struct context *ctx, const struct candidate *candidates, uint32_t count, const char *selector) {
    char list[1500];
    const int chosen = select_candidate(candidates, count, selector);
    if (chosen >= 0 && candidates[chosen].info.usable) return candidates + chosen;
    format_devices(list, sizeof list, candidates, count);
    if (count == 0) {
        fail(ctx, GN_NO_DEVICE, "no Vulkan device was found, only drivers for others; " NO_DRIVER_HINT);
    } else if (chosen >= 0) {
        fail(ctx, GN_NO_DEVICE, "the device '%s' cannot be used: %s", candidates[chosen].info.name, candidates[chosen].info.reason);
    } else if (!selector || !*selector) {
        fail(ctx, GN_NO_DEVICE, "no Vulkan device can be used%s; " NO_DRIVER_HINT, list);
    } else {
        fail(ctx, GN_NO_DEVICE, "no Vulkan device is called '%.100s'%s; a device is named by number, part of the name, uuid:…, cpu or gpu",
             selector, list);
    }
    return NULL;
}

static void adopt(struct device *device, const struct candidate *candidate) {
    device->physical = candidate->physical;
    device->properties = candidate->properties;
    device->max_allocation = candidate->max_allocation;
    device->float_controls = candidate->float_controls;
    device->subgroup_size = candidate->subgroup_size;
    device->queue_family = candidate->queue_family;
    device->timestamp_bits = candidate->timestamp_bits;
    device->info = candidate->info;
    device->has_fp64 = candidate->features.shaderFloat64;
    device->has_int64 = candidate->features.shaderInt64;
    device->has_memory_budget = candidate->has_memory_budget;
    device->software = candidate->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    device->max_loop_steps =
        max_loop_steps(candidate->driver, candidate->driver_info, candidate->info.name, candidate->properties.driverVersion);
    vkGetPhysicalDeviceMemoryProperties(candidate->physical, &device->memory);
}

static bool open_handle(struct device *device, struct context *ctx, const struct candidate *candidate) {
    const char *extensions[3];
    uint32_t extension_count = 0;
    if (candidate->has_memory_budget) extensions[extension_count++] = VK_EXT_MEMORY_BUDGET_EXTENSION_NAME;
    if (candidate->float_controls_extension) extensions[extension_count++] = VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME;
    if (candidate->portability_subset) extensions[extension_count++] = "VK_KHR_portability_subset";
    const VkPhysicalDeviceFeatures features = {
        .shaderFloat64 = device->has_fp64,
        .shaderInt64 = device->has_int64,
        .shaderStorageImageExtendedFormats = VK_TRUE,
    };
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &(VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                                        .queueFamilyIndex = device->queue_family,
                                                        .queueCount = 1,
                                                        .pQueuePriorities = &(float){1.0f}},
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
        .pEnabledFeatures = &features,
    };
    const VkResult result = vkCreateDevice(device->physical, &info, NULL, &device->handle);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_NO_DEVICE, "vkCreateDevice", result);
    vkGetDeviceQueue(device->handle, device->queue_family, 0, &device->queue);
    return true;
}

static bool open_device(struct device *device, struct context *ctx, const struct gn_device_params *params) {
    struct candidate *candidates = NULL;
    uint32_t count = 0;
    bool done = candidates_init(&candidates, &count, ctx, device);
    const struct candidate *candidate = done ? choose(ctx, candidates, count, params->select) : NULL;
    if (candidate) adopt(device, candidate);
    if (params->hide_fp64) device->has_fp64 = device->info.has_fp64 = false;
    done = candidate && open_handle(device, ctx, candidate) && commands_init(device, ctx);
    free(candidates);
    return done;
}

bool device_init(struct device *out, struct context *ctx, const struct gn_device_params *params) {
    memset(out, 0, sizeof *out);
    out->dispatch_limit = DISPATCH_LIMIT_SECONDS;
    out->first_dispatch_limit = FIRST_DISPATCH_LIMIT_SECONDS;
    if (!instance_init(out, ctx, params->validate) || !open_device(out, ctx, params)) goto fail;
    memory_budget_update(out);
    return true;
fail:
    device_finish(out);
    return false;
}

void device_finish(struct device *device) {
    pipelines_finish(device);
    if (!device->lost) {
        if (device->handle) {
            staging_finish(device);
            commands_finish(device);
            vkDestroyDevice(device->handle, NULL);
        }
        if (device->instance) instance_finish(device);
    }
    memset(device, 0, sizeof *device);
}

bool device_list(struct context *ctx, const struct gn_device_params *params, struct gn_device_info *infos, uint32_t capacity,
                 uint32_t *count, int *selected) {
    struct device device = {0};
    struct candidate *candidates = NULL;
    uint32_t found = 0;
    *count = 0;
    *selected = -1;
    const bool done = instance_init(&device, ctx, params->validate) && candidates_init(&candidates, &found, ctx, &device);
    if (done) {
        const int chosen = select_candidate(candidates, found, params->select);
        *selected = chosen >= 0 && candidates[chosen].info.usable ? chosen : -1;
        *count = found < capacity ? found : capacity;
        for (uint32_t i = 0; i < *count; ++i) infos[i] = candidates[i].info;
    }
    free(candidates);
    device_finish(&device);
    return done;
}

static const char *result_name(VkResult result) {
#define NAME(value)                                                                                                                        \
    case value:                                                                                                                            \
        return #value;
    switch (result) {
        NAME(VK_SUCCESS)
        NAME(VK_NOT_READY)
        NAME(VK_TIMEOUT)
        NAME(VK_INCOMPLETE)
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        NAME(VK_ERROR_INITIALIZATION_FAILED)
        NAME(VK_ERROR_DEVICE_LOST)
        NAME(VK_ERROR_MEMORY_MAP_FAILED)
        NAME(VK_ERROR_LAYER_NOT_PRESENT)
        NAME(VK_ERROR_EXTENSION_NOT_PRESENT)
        NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        NAME(VK_ERROR_INCOMPATIBLE_DRIVER)
        NAME(VK_ERROR_TOO_MANY_OBJECTS)
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED)
        NAME(VK_ERROR_FRAGMENTED_POOL)
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY)
        NAME(VK_ERROR_FRAGMENTATION)
        NAME(VK_ERROR_INVALID_SHADER_NV)
        NAME(VK_ERROR_UNKNOWN)
    default:
        return "an unknown result";
    }
#undef NAME
}

bool device_fail(struct device *device, struct context *ctx, enum gn_status status, const char *call, VkResult result) {
    if (result == VK_ERROR_DEVICE_LOST) {
        device->lost = true;
        status = GN_DEVICE_LOST;
    }
    const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return fail(ctx, memory ? GN_LIMIT : status, "%s: %s (%d)", call, result_name(result), result);
}

bool device_alive(const struct device *device, struct context *ctx) {
    return !device->lost || fail(ctx, GN_DEVICE_LOST, "the device '%s' was lost before; open it again", device->info.name);
}

bool device_validated(struct device *device, struct context *ctx) {
    if (device->validation_errors == 0) return true;
    return fail(ctx, GN_INTERNAL, "the Vulkan validation layer has %u messages; the first: %s", device->validation_errors,
                device->validation_message);
}

void device_label(struct device *device, VkObjectType type, uint64_t handle, const char *name) {
    if (!device->validating) return;
    PFN_vkSetDebugUtilsObjectNameEXT set_name =
        (PFN_vkSetDebugUtilsObjectNameEXT)vkGetInstanceProcAddr(device->instance, "vkSetDebugUtilsObjectNameEXT");
    if (!set_name) return;
    set_name(device->handle, &(VkDebugUtilsObjectNameInfoEXT){.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                              .objectType = type,
                                                              .objectHandle = handle,
                                                              .pObjectName = name});
}
