// What can be known of a Vulkan device without opening it, and whether it will do.
#ifndef DEVICE_CANDIDATE_H
#define DEVICE_CANDIDATE_H

#include "device/device.h"

// Devices that are looked at; more are ignored.
#define MAX_CANDIDATES 32

struct candidate {
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features;      // offered
    VkDeviceSize max_allocation;            // bytes, maxMemoryAllocationSize
    VkDriverId driver;                      // 0 where the driver does not tell
    char driver_info[VK_MAX_DRIVER_INFO_SIZE];
    uint32_t queue_family, timestamp_bits;  // of the first family with compute
    VkPhysicalDeviceFloatControlsProperties float_controls; // zeroed where the device does not tell
    uint32_t subgroup_size;
    bool float_controls_extension;          // offers VK_KHR_shader_float_controls, which must be enabled before Vulkan 1.2
    bool has_memory_budget;                 // offers VK_EXT_memory_budget
    bool portability_subset;                // offers VK_KHR_portability_subset, which must then be enabled
    struct gn_device_info info;
};

// Describes the devices of device->instance in *out, an array of `*count` to be freed. No device at all is count 0.
bool candidates_init(struct candidate **out, uint32_t *count, struct context *ctx, struct device *device);

// Loop iterations one invocation may spend, for a driver (0: unknown), what it says of itself, the device's name and driverVersion.
uint32_t max_loop_steps(VkDriverId driver, const char *driver_info, const char *name, uint32_t driver_version);

#endif
