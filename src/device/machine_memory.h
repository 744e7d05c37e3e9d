// How much memory this machine has left for this process. Knows no Vulkan.
#ifndef DEVICE_MACHINE_MEMORY_H
#define DEVICE_MACHINE_MEMORY_H

#include <stdint.h>

// Bytes that can still be taken without swapping, failing or being killed: the least of what the kernel calls available, what the control
// group allows, and what RLIMIT_AS leaves; less a sixteenth, for everybody else. UINT64_MAX where nothing is known.
uint64_t machine_memory_free(void);

#endif
