// Device memory: looked for, checked against limits, counted.
//
// Every object has an allocation of its own: there are some twenty, and a device allows 4096 at least. A kind of memory is a row of wishes,
// the best first; a wish whose heap is full gives way to the next.
#include "device/allocation.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

#include "device/machine_memory.h"

// Smaller allocations do not look up anew how much is free.
#define LARGE_BYTES (1u << 20)

enum {
    DEVICE = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
    HOST = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
    CACHED = VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
    WISHES = 3,
};

static const VkMemoryPropertyFlags KERNEL_ONLY[WISHES] = {DEVICE, 0, 0};
static const VkMemoryPropertyFlags HOST_WRITES[WISHES] = {DEVICE | HOST, DEVICE, 0};
static const VkMemoryPropertyFlags HOST_READS[WISHES] = {HOST | CACHED, HOST, HOST};

// "3.20 GB (3200000000 bytes", to be followed by what the closing parenthesis is to hold.
static void format_bytes(char out[64], VkDeviceSize bytes) {
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
    double value = (double)bytes;
    int unit = 0;
    while (value >= 1000) {
        value /= 1000;
        ++unit;
    }
    snprintf(out, 64, "%.*f %s (%" PRIu64 " bytes", unit ? 2 : 0, value, units[unit], bytes);
}

bool limit_fail(struct context *ctx, const char *what, const char *name, VkDeviceSize bytes, VkDeviceSize limit, const char *limit_name) {
    char needed[64], allowed[64];
    format_bytes(needed, bytes);
    format_bytes(allowed, limit);
    return fail(ctx, GN_LIMIT, "%s '%s' needs %s), but the device allows %s, %s)", what, name, needed, allowed, limit_name);
}

static VkDeviceSize difference(VkDeviceSize limit, VkDeviceSize used) { return limit > used ? limit - used : 0; }

// Bytes free in a heap of a device with memory of its own.
static VkDeviceSize heap_free(const struct device *device, uint32_t heap) {
    if (!device->has_memory_budget) return difference(device->memory.memoryHeaps[heap].size, device->memory_used);
    VkPhysicalDeviceMemoryBudgetPropertiesEXT budget = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
    VkPhysicalDeviceMemoryProperties2 memory = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2, .pNext = &budget};
    vkGetPhysicalDeviceMemoryProperties2(device->physical, &memory);
    return difference(budget.heapBudget[heap], budget.heapUsage[heap]);
}

// The largest heap that has all of `flags`; heap 0 if there is none.
static uint32_t largest_heap(const struct device *device, VkMemoryHeapFlags flags) {
    uint32_t best = 0;
    VkDeviceSize size = 0;
    for (uint32_t i = 0; i < device->memory.memoryHeapCount; ++i) {
        const VkMemoryHeap *heap = device->memory.memoryHeaps + i;
        if ((heap->flags & flags) != flags || heap->size <= size) continue;
        size = heap->size;
        best = i;
    }
    return best;
}

void memory_budget_update(struct device *device) {
    const uint64_t free_bytes =
        device->software ? machine_memory_free() : heap_free(device, largest_heap(device, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT));
    device->memory_budget = free_bytes > UINT64_MAX - device->memory_used ? UINT64_MAX : device->memory_used + free_bytes;
}

bool allocation_check(struct context *ctx, struct device *device, const char *what, const char *name, VkDeviceSize bytes) {
    if (bytes > device->max_allocation) return limit_fail(ctx, what, name, bytes, device->max_allocation, "maxMemoryAllocationSize");
    const VkDeviceSize heap = device->memory.memoryHeaps[largest_heap(device, 0)].size;
    if (bytes > heap) return limit_fail(ctx, what, name, bytes, heap, "the size of its largest memory heap");
    if (!device->software) return true;
    if (bytes >= LARGE_BYTES) memory_budget_update(device);
    const VkDeviceSize left = difference(device->memory_budget, device->memory_used);
    return bytes <= left || limit_fail(ctx, what, name, bytes, left, "what is free of this machine's memory");
}

// The heap of a software device is only a number: the machine's memory counts, and has been checked.
static bool has_room(const struct device *device, uint32_t heap, VkDeviceSize bytes) {
    if (bytes > device->memory.memoryHeaps[heap].size) return false;
    return device->software || bytes < LARGE_BYTES || bytes <= heap_free(device, heap);
}

// Tries every memory type that has all of `wish`, and no property that would need a feature or a protected queue. *got: the type's
// properties.
static VkResult try_wish(struct allocation *out, struct device *device, const VkMemoryRequirements *needs, VkMemoryPropertyFlags wish,
                         VkMemoryPropertyFlags *got) {
    VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (uint32_t type = 0; type < device->memory.memoryTypeCount && result != VK_SUCCESS; ++type) {
        const VkMemoryType *candidate = device->memory.memoryTypes + type;
        if (!(needs->memoryTypeBits >> type & 1) || (candidate->propertyFlags & wish) != wish) continue;
        if (candidate->propertyFlags & ~(VkMemoryPropertyFlags)(DEVICE | HOST | CACHED)) continue;
        if (!has_room(device, candidate->heapIndex, needs->size)) continue;
        const VkMemoryAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs->size, .memoryTypeIndex = type};
        result = vkAllocateMemory(device->handle, &info, NULL, &out->memory);
        *got = candidate->propertyFlags;
    }
    return result;
}

static bool refuse(struct context *ctx, struct device *device, const struct allocation_params *params) {
    char needed[64], left[64];
    memory_budget_update(device);
    format_bytes(needed, params->requirements.size);
    format_bytes(left, difference(device->memory_budget, device->memory_used));
    return fail(ctx, GN_LIMIT, "%s '%s' needs %s), but vkAllocateMemory found no room for it; free are %s)", params->what, params->name,
                needed, left);
}

static bool sees(VkMemoryPropertyFlags flags) { return (flags & HOST) == HOST; }

// Maps the memory where the host is to see it. A software device's is always tried: Mesa 25.0 does not say so when the machine has none
// left, but maps it at MAP_FAILED, where kernels would then write.
static VkResult map(struct allocation *out, struct device *device, bool wanted, VkMemoryPropertyFlags got) {
    if (!wanted && !(device->software && sees(got))) return VK_SUCCESS;
    VkResult result = vkMapMemory(device->handle, out->memory, 0, VK_WHOLE_SIZE, 0, &out->map);
    if (result == VK_SUCCESS && out->map == MAP_FAILED) result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (!wanted) out->map = NULL;
    return result;
}

bool allocation_init(struct allocation *out, struct context *ctx, struct device *device, const struct allocation_params *params) {
    memset(out, 0, sizeof *out);
    const VkDeviceSize bytes = params->requirements.size;
    if (!allocation_check(ctx, device, params->what, params->name, bytes)) return false;
    const VkMemoryPropertyFlags *wishes = params->host_reads ? HOST_READS : params->host_writes ? HOST_WRITES : KERNEL_ONLY;
    VkMemoryPropertyFlags wish = 0, got = 0;
    VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (int i = 0; i < WISHES && result != VK_SUCCESS; ++i) {
        wish = wishes[i];
        result = try_wish(out, device, &params->requirements, wish, &got);
    }
    if (result != VK_SUCCESS) return refuse(ctx, device, params);
    out->bytes = bytes;
    device->memory_used += bytes;
    if (map(out, device, sees(wish), got) == VK_SUCCESS) return true;
    allocation_finish(out, device);
    return refuse(ctx, device, params);
}

void allocation_finish(struct allocation *allocation, struct device *device) {
    if (allocation->memory) vkFreeMemory(device->handle, allocation->memory, NULL);
    device->memory_used -= allocation->bytes;
    memset(allocation, 0, sizeof *allocation);
}
