// The kernels of shaders/, by name, with what specializes them.
#ifndef RENDER_KERNELS_H
#define RENDER_KERNELS_H

#include "device/kernel.h"
#include "shaders/shared.h"

enum kernel_name {
    KERNEL_RENDER,
    KERNEL_TRACE,
    KERNEL_STRESS_FILM,     // pieces of the shaders alone, for the stress cases
    KERNEL_STRESS_BOX,
    KERNEL_STRESS_LEAVE,
    KERNEL_STRESS_NUMBERS,
    KERNEL_STRESS_SHADING,
    // These need a device with doubles.
    KERNEL_RENDER_FP64,
    KERNEL_TRACE_FP64,
    KERNEL_TRACE_REFINE,    // fp32, with the exact tier's hits brought to 1 ulp in fp64
    KERNEL_TRACE_AGAIN,     // the exact tier's second stage
    KERNEL_PENDING_AGAIN,   // the same for pending samples of a picture
    KERNEL_STRESS_BOX_FP64,
    KERNEL_STRESS_LEAVE_FP64,
    KERNEL_STRESS_NUMBERS_FP64,
    KERNEL_STRESS_SHADING_FP64,
};

struct kernel_specialization {
    uint32_t tier;          // TIER_*
    uint32_t effects;       // EFFECT_* bits; what is absent is compiled out
    uint32_t aovs;          // GN_AOV_* bits
    bool any_hit;           // trace kernel: occlusion only
    bool resolve;           // render kernel: over the pending samples of the exact tier
    uint32_t knobs[KNOB_COUNT]; // positions; 0 is the default
};

// Whether the device has what a tier needs, and calculates as it assumes; else GN_NO_DEVICE, with what is missing or wrong.
bool tier_available(struct context *ctx, struct device *device, uint32_t tier);

// What the kernels of a tier declare of floats (device/float_controls.h): rounding, from robust on; NaN and infinities, where bounds of
// errors pass them on. The latter not on software devices: Mesa 25.0's runs 12 % more instructions for it in exact and 25 % more in fp64, for
// the same hits, and how it compares is seen by the check before these tiers and by the tests. (Rounding costs nothing there, and neither
// costs with Mesa 22.3.)
uint32_t tier_float_controls(const struct device *device, uint32_t tier);

bool render_kernel_init(struct kernel *out, struct context *ctx, struct device *device, enum kernel_name name,
                        const struct kernel_specialization *specialization, const struct kernel_binding *bindings, size_t binding_count,
                        uint32_t push_size);

#endif
