// What can be known of a Vulkan device without opening it, and whether it will do.
#include "device/candidate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_EXTENSIONS 1024

static const char *type_name(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

static void format_uuid(char out[37], const uint8_t uuid[VK_UUID_SIZE]) {
    for (size_t i = 0; i < VK_UUID_SIZE; ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) *out++ = '-';
        out += sprintf(out, "%02x", uuid[i]);
    }
}

static bool reject(struct candidate *candidate, const char *reason) {
    snprintf(candidate->info.reason, sizeof candidate->info.reason, "%s", reason);
    return false;
}

// The first queue family that computes; transfers come with it.
static bool find_queue(struct candidate *candidate) {
    VkQueueFamilyProperties families[16];
    uint32_t count = sizeof families / sizeof families[0];
    vkGetPhysicalDeviceQueueFamilyProperties(candidate->physical, &count, families);
    for (uint32_t i = 0; i < count; ++i) {
        if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
        candidate->queue_family = i;
        candidate->timestamp_bits = families[i].timestampValidBits;
        return true;
    }
    return false;
}

static bool has_formats(const struct candidate *candidate) {
    VkFormatProperties texel, color, id;
    vkGetPhysicalDeviceFormatProperties(candidate->physical, VK_FORMAT_R32G32B32A32_UINT, &texel);
    vkGetPhysicalDeviceFormatProperties(candidate->physical, VK_FORMAT_R32G32B32A32_SFLOAT, &color);
    vkGetPhysicalDeviceFormatProperties(candidate->physical, VK_FORMAT_R32G32_SINT, &id);
    return (texel.bufferFeatures & VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT) &&
           (color.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) &&
           (id.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) && candidate->features.shaderStorageImageExtendedFormats;
}

// Which of the extensions that we have a use for the device offers; returns whether it can tell its driver (core in Vulkan 1.2, else
// VK_KHR_driver_properties). A software device of Vulkan 1.2 has no other that we use, and the list costs a millisecond of every start.
static bool find_extensions(struct candidate *candidate, VkExtensionProperties *scratch) {
    bool driver_properties = candidate->properties.apiVersion >= VK_API_VERSION_1_2;
    if (driver_properties && candidate->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) return true;
    uint32_t count = MAX_EXTENSIONS;
    VkResult result = vkEnumerateDeviceExtensionProperties(candidate->physical, NULL, &count, scratch);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return driver_properties;
    for (uint32_t i = 0; i < count; ++i) {
        const char *name = scratch[i].extensionName;
        if (!strcmp(name, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME)) driver_properties = true;
        if (!strcmp(name, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)) candidate->has_memory_budget = true;
        if (!strcmp(name, VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME)) {
            candidate->float_controls_extension = candidate->properties.apiVersion < VK_API_VERSION_1_2;
        }
        if (!strcmp(name, "VK_KHR_portability_subset")) candidate->portability_subset = true;
    }
    return driver_properties;
}

// What only a device of Vulkan 1.1 can be asked.
static void describe_further(struct candidate *candidate, bool driver_properties) {
    const bool float_controls = candidate->properties.apiVersion >= VK_API_VERSION_1_2 || candidate->float_controls_extension;
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceFloatControlsProperties floats = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES,
                                                      .pNext = driver_properties ? &driver : NULL};
    VkPhysicalDeviceMaintenance3Properties limits = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES,
                                                     .pNext = float_controls ? &floats : floats.pNext};
    VkPhysicalDeviceSubgroupProperties subgroup = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, .pNext = &limits};
    VkPhysicalDeviceIDProperties id = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES, .pNext = &subgroup};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &id};
    vkGetPhysicalDeviceProperties2(candidate->physical, &properties);
    floats.pNext = NULL;
    candidate->float_controls = floats;
    candidate->subgroup_size = subgroup.subgroupSize;
    candidate->max_allocation = limits.maxMemoryAllocationSize;
    candidate->driver = driver.driverID;
    memcpy(candidate->driver_info, driver.driverInfo, sizeof driver.driverInfo);
    format_uuid(candidate->info.uuid, id.deviceUUID);
    if (driver_properties) {
        snprintf(candidate->info.driver, sizeof candidate->info.driver, "%.127s %.127s", driver.driverName, driver.driverInfo);
    }
}

static bool check(struct candidate *candidate) {
    if (candidate->properties.apiVersion < VK_API_VERSION_1_1) return reject(candidate, "its driver is older than Vulkan 1.1");
    if (!find_queue(candidate)) return reject(candidate, "it has no compute queue");
    if (!has_formats(candidate)) {
        return reject(candidate, "it lacks R32G32B32A32_UINT texel buffers, or R32G32B32A32_SFLOAT or R32G32_SINT storage images");
    }
    return true;
}

static void describe(struct candidate *out, VkPhysicalDevice physical, uint32_t index, VkExtensionProperties *scratch) {
    struct gn_device_info *info = &out->info;
    out->physical = physical;
    vkGetPhysicalDeviceProperties(physical, &out->properties);
    vkGetPhysicalDeviceFeatures(physical, &out->features);
    const uint32_t api = out->properties.apiVersion, driver = out->properties.driverVersion;
    info->index = index;
    snprintf(info->name, sizeof info->name, "%s", out->properties.deviceName);
    snprintf(info->type, sizeof info->type, "%s", type_name(out->properties.deviceType));
    snprintf(info->driver, sizeof info->driver, "%u.%u.%u", VK_VERSION_MAJOR(driver), VK_VERSION_MINOR(driver), VK_VERSION_PATCH(driver));
    snprintf(info->api, sizeof info->api, "%u.%u.%u", VK_VERSION_MAJOR(api), VK_VERSION_MINOR(api), VK_VERSION_PATCH(api));
    if (api >= VK_API_VERSION_1_1) describe_further(out, find_extensions(out, scratch));
    info->has_fp64 = out->features.shaderFloat64;
    info->has_int64 = out->features.shaderInt64;
    info->usable = check(out);
}

bool candidates_init(struct candidate **out, uint32_t *count, struct context *ctx, struct device *device) {
    *out = NULL;
    *count = 0;
    VkPhysicalDevice physicals[MAX_CANDIDATES];
    uint32_t found = MAX_CANDIDATES;
    VkResult result = vkEnumeratePhysicalDevices(device->instance, &found, physicals);
    // Some loaders say so where drivers are installed, but none of them finds its device.
    if (result == VK_ERROR_INITIALIZATION_FAILED) return true;
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        return device_fail(device, ctx, GN_NO_DEVICE, "vkEnumeratePhysicalDevices", result);
    VkExtensionProperties *scratch = array_alloc(ctx, MAX_EXTENSIONS, sizeof *scratch, "the names of device extensions");
    if (scratch) *out = array_alloc(ctx, found, sizeof **out, "the list of devices");
    if (*out) {
        for (uint32_t i = 0; i < found; ++i) describe(*out + i, physicals[i], i, scratch);
        *count = found;
    }
    free(scratch);
    return *out;
}

// Mesa before 23.1 counts the iterations of all loops of an invocation in one counter and ends loops when it passes 65535
// (LP_MAX_TGSI_LOOP_ITERATIONS in gallivm). A driver that does not say how old it is counts as old.
uint32_t max_loop_steps(VkDriverId driver, const char *driver_info, const char *name, uint32_t driver_version) {
    const uint32_t few = 60000, many = 1u << 22;
    const bool lavapipe = driver == VK_DRIVER_ID_MESA_LLVMPIPE || (driver == 0 && strstr(name, "llvmpipe"));
    if (!lavapipe) return many;
    unsigned major = 0, minor = 0;
    if (sscanf(driver_info, "Mesa %u.%u", &major, &minor) != 2) {
        major = VK_VERSION_MAJOR(driver_version);
        minor = VK_VERSION_MINOR(driver_version);
    }
    return major > 23 || (major == 23 && minor >= 1) ? many : few;
}
