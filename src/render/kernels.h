// The kernels of shaders/, by name, with what specializes them.
#ifndef RENDER_KERNELS_H
#define RENDER_KERNELS_H

#include "device/kernel.h"

// KERNEL_TRACE_FP64 needs a device with doubles.
enum kernel_name { KERNEL_RENDER, KERNEL_TRACE, KERNEL_TRACE_FP64 };

struct kernel_specialization {
    uint32_t tier;          // TIER_*
    uint32_t effects;       // EFFECT_* bits; what is absent is compiled out
    uint32_t aovs;          // GN_AOV_* bits
    bool any_hit;           // trace kernel: occlusion only
    bool resolve;           // render kernel: over the pending samples of the exact tier
};

bool render_kernel_init(struct kernel *out, struct context *ctx, struct device *device, enum kernel_name name,
                        const struct kernel_specialization *specialization, const struct kernel_binding *bindings, size_t binding_count,
                        uint32_t push_size);

#endif
