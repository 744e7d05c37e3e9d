// Tells a driver, in SPIR-V, what floats are to do: round to nearest, and keep NaN, infinities and the sign of zero
// (SPV_KHR_float_controls).
//
// GLSL has no words for this, and what may be declared differs by device. So it is inserted into the compiled module when a kernel is made.
// Knows no Vulkan call.
#ifndef DEVICE_FLOAT_CONTROLS_H
#define DEVICE_FLOAT_CONTROLS_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

// What can be declared, for floats of 32 and of 64 bits.
enum {
    FLOAT_NEAREST_32 = 1 << 0, // RoundingModeRTE: + - × and conversions are rounded to nearest, ties to even
    FLOAT_NEAREST_64 = 1 << 1,
    FLOAT_SPECIAL_32 = 1 << 2, // SignedZeroInfNanPreserve: the compiler may not assume that there are no such values
    FLOAT_SPECIAL_64 = 1 << 3,
    FLOAT_ALL = (1 << 4) - 1,
};

// FLOAT_* that a device accepts.
uint32_t float_controls_accepted(const VkPhysicalDeviceFloatControlsProperties *properties);

// Writes the module of `size` bytes at `words` to `out` with the declarations FLOAT_* added to each of its entry points; those for 64 bits
// only where the module uses doubles, none that it makes itself. Returns the new size in bytes, with `out` NULL as well; 0 if this is no
// module.
size_t float_controls_declare(uint32_t *out, const uint32_t *words, size_t size, uint32_t controls);

#endif
