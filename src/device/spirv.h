// A look at SPIR-V before a driver sees it.
#ifndef DEVICE_SPIRV_H
#define DEVICE_SPIRV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// NULL if `size` bytes at `words` look like a whole module that Vulkan 1.1 reads (up to SPIR-V 1.3), else what is wrong. Drivers may crash
// on less. The meaning of the instructions is for spirv-val to judge.
const char *spirv_fault(const uint32_t *words, size_t size);

#endif
