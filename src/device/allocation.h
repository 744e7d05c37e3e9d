// Device memory: looked for, checked against limits, counted.
#ifndef DEVICE_ALLOCATION_H
#define DEVICE_ALLOCATION_H

#include "device/device.h"

// What asks for memory, and how it is used.
struct allocation_params {
    const char *what;           // "buffer" or "image"
    const char *name;           // "triangles"
    VkMemoryRequirements requirements;
    bool host_writes;           // visible to the host where the device's own memory can be
    bool host_reads;            // visible to the host, cached if possible
};

struct allocation {
    VkDeviceMemory memory;
    VkDeviceSize bytes;
    void *map;                  // NULL where the host does not see it
};

// Looks again how much memory is free, and sets device->memory_budget.
void memory_budget_update(struct device *device);

// Whether `bytes` of memory can be had at all, before the object is made; else GN_LIMIT naming it.
bool allocation_check(struct context *ctx, struct device *device, const char *what, const char *name, VkDeviceSize bytes);

// Allocates, and maps what the host is to see. GN_LIMIT when there is none left.
bool allocation_init(struct allocation *out, struct context *ctx, struct device *device, const struct allocation_params *params);
void allocation_finish(struct allocation *allocation, struct device *device);

// Reports GN_LIMIT: "buffer 'triangles' needs 3.20 GB (3200000000 bytes), but the device allows 2.15 GB (2147483648 bytes,
// maxTexelBufferElements)".
bool limit_fail(struct context *ctx, const char *what, const char *name, VkDeviceSize bytes, VkDeviceSize limit, const char *limit_name);

#endif
