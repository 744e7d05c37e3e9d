#include "render/kernels.h"

#include "device/float_controls.h"
#include "kernels/pending_again.h"
#include "kernels/render.h"
#include "kernels/render_fp64.h"
#include "kernels/stress_box.h"
#include "kernels/stress_box_fp64.h"
#include "kernels/stress_film.h"
#include "kernels/stress_leave.h"
#include "kernels/stress_leave_fp64.h"
#include "kernels/stress_numbers.h"
#include "kernels/stress_numbers_fp64.h"
#include "kernels/stress_shading.h"
#include "kernels/stress_shading_fp64.h"
#include "kernels/trace.h"
#include "kernels/trace_again.h"
#include "kernels/trace_fp64.h"
#include "kernels/trace_refine.h"
#include "render/arithmetic.h"

struct embedded { const char *name; const uint32_t *spirv; size_t size; };

static const struct embedded KERNELS[] = {
    [KERNEL_RENDER] = {"render", kernel_render, sizeof kernel_render},
    [KERNEL_TRACE] = {"trace", kernel_trace, sizeof kernel_trace},
    [KERNEL_RENDER_FP64] = {"render_fp64", kernel_render_fp64, sizeof kernel_render_fp64},
    [KERNEL_TRACE_FP64] = {"trace_fp64", kernel_trace_fp64, sizeof kernel_trace_fp64},
    [KERNEL_TRACE_REFINE] = {"trace_refine", kernel_trace_refine, sizeof kernel_trace_refine},
    [KERNEL_TRACE_AGAIN] = {"trace_again", kernel_trace_again, sizeof kernel_trace_again},
    [KERNEL_STRESS_FILM] = {"stress_film", kernel_stress_film, sizeof kernel_stress_film},
    [KERNEL_STRESS_BOX] = {"stress_box", kernel_stress_box, sizeof kernel_stress_box},
    [KERNEL_STRESS_LEAVE] = {"stress_leave", kernel_stress_leave, sizeof kernel_stress_leave},
    [KERNEL_STRESS_NUMBERS] = {"stress_numbers", kernel_stress_numbers, sizeof kernel_stress_numbers},
    [KERNEL_STRESS_SHADING] = {"stress_shading", kernel_stress_shading, sizeof kernel_stress_shading},
    [KERNEL_STRESS_BOX_FP64] = {"stress_box_fp64", kernel_stress_box_fp64, sizeof kernel_stress_box_fp64},
    [KERNEL_STRESS_LEAVE_FP64] = {"stress_leave_fp64", kernel_stress_leave_fp64, sizeof kernel_stress_leave_fp64},
    [KERNEL_STRESS_NUMBERS_FP64] = {"stress_numbers_fp64", kernel_stress_numbers_fp64, sizeof kernel_stress_numbers_fp64},
    [KERNEL_STRESS_SHADING_FP64] = {"stress_shading_fp64", kernel_stress_shading_fp64, sizeof kernel_stress_shading_fp64},
    [KERNEL_PENDING_AGAIN] = {"pending_again", kernel_pending_again, sizeof kernel_pending_again},
};

static const uint32_t KNOB_CONSTANTS[] = {
#define X(number, id, name, positions) [KNOB_##id] = CONSTANT_##id,
    KNOBS(X)
#undef X
};

bool tier_available(struct context *ctx, struct device *device, uint32_t tier) {
    if (tier == TIER_FP64 && !device->info.has_fp64)
        return fail(ctx, GN_NO_DEVICE, "accuracy 'fp64' needs a device with doubles (shaderFloat64), and %s has none; 'exact' needs none",
                    device->info.name);
    return arithmetic_suffices(ctx, device, tier);
}

uint32_t tier_float_controls(const struct device *device, uint32_t tier) {
    const bool special = (tier == TIER_EXACT || tier == TIER_FP64) && !device->software;
    if (tier == TIER_FAST) return 0;
    return FLOAT_NEAREST_32 | FLOAT_NEAREST_64 | (special ? FLOAT_SPECIAL_32 | FLOAT_SPECIAL_64 : 0);
}

bool render_kernel_init(struct kernel *out, struct context *ctx, struct device *device, enum kernel_name name,
                        const struct kernel_specialization *specialization, const struct kernel_binding *bindings, size_t binding_count,
                        uint32_t push_size) {
    struct kernel_constant constants[EFFECT_COUNT + KNOB_COUNT + 5];
    size_t count = 0;
    for (uint32_t i = 0; i < EFFECT_COUNT; i++) constants[count++] = (struct kernel_constant){i, specialization->effects >> i & 1};
    for (uint32_t i = 0; i < KNOB_COUNT; i++) constants[count++] = (struct kernel_constant){KNOB_CONSTANTS[i], specialization->knobs[i]};
    constants[count++] = (struct kernel_constant){CONSTANT_TIER, specialization->tier};
    constants[count++] = (struct kernel_constant){CONSTANT_AOVS, specialization->aovs};
    constants[count++] = (struct kernel_constant){CONSTANT_MAX_STEPS, device->max_loop_steps};
    constants[count++] = (struct kernel_constant){CONSTANT_ANY_HIT, specialization->any_hit};
    constants[count++] = (struct kernel_constant){CONSTANT_RESOLVE, specialization->resolve};
    struct kernel_params params = {
        .name = KERNELS[name].name, .spirv = KERNELS[name].spirv, .spirv_size = KERNELS[name].size,
        .constants = constants, .constant_count = count, .bindings = bindings, .binding_count = binding_count, .push_size = push_size,
        .float_controls = tier_float_controls(device, specialization->tier),
    };
    return kernel_init(out, ctx, device, &params);
}
