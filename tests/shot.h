// Shoots rays that batches do not have, with a target and a time, on the device (tests/kernels/shoot.comp).
#ifndef TESTS_SHOT_H
#define TESTS_SHOT_H

#include "fixture.h"

#include "bvh/bvh.h"
#include "render/upload.h"
#include "shoot.h"

struct shoot_ray {
    float origin[3], tmin, direction[3], tmax;
    int32_t target_object, target_index; // object -1: none; index -1: all of it
    uint32_t self;
    float time;
};
#define SHOOT_NO_SELF 0xffffffffu

struct shoot_hit {
    int32_t object, primitive;
    float t;
    uint32_t undecided;
};

struct shoot_params {
    uint32_t tier, effects;
    bool any;
};

// Shoots rays[0 … count) at a scene; the tier's first stage only.
static inline void shoot(struct shoot_hit *hits, const struct scene *scene, const struct bvh *bvh, const struct shoot_params *params,
                         const struct shoot_ray *rays, uint32_t count) {
    struct device *device = fixture_device();
    struct device_scene ds;
    struct buffer in, out;
    struct kernel kernel;
    struct kernel_binding bindings[KERNEL_BINDINGS];
    struct kernel_constant constants[EFFECT_COUNT + 3];
    fixture_assert(device_scene_init(&ds, fixture_context(), device, scene, bvh, params->effects, NULL, false));
    size_t bound = device_scene_bindings(&ds, bindings, false);
    bindings[bound++] = (struct kernel_binding){BINDING_RAYS, &in, NULL};
    bindings[bound++] = (struct kernel_binding){BINDING_HITS, &out, NULL};
    for (uint32_t i = 0; i < EFFECT_COUNT; i++) constants[i] = (struct kernel_constant){i, params->effects >> i & 1};
    constants[EFFECT_COUNT] = (struct kernel_constant){CONSTANT_TIER, params->tier};
    constants[EFFECT_COUNT + 1] = (struct kernel_constant){CONSTANT_ANY_HIT, params->any};
    constants[EFFECT_COUNT + 2] = (struct kernel_constant){CONSTANT_MAX_STEPS, device->max_loop_steps};
    const struct kernel_params how = {FIXTURE_KERNEL(shoot), .constants = constants, .constant_count = EFFECT_COUNT + 3,
                                      .bindings = bindings, .binding_count = bound, .push_size = sizeof(struct trace_args)};
    const struct buffer_params in_params = {.name = "rays", .kind = BUFFER_TEXELS, .size = count * sizeof *rays, .host_writes = true};
    const struct buffer_params out_params = {.name = "hits", .kind = BUFFER_STORAGE, .size = count * sizeof *hits, .host_reads = true};
    fixture_assert(buffer_init(&in, fixture_context(), device, &in_params));
    fixture_assert(buffer_init(&out, fixture_context(), device, &out_params));
    fixture_assert(buffer_upload(&in, fixture_context(), device, rays, count * sizeof *rays));
    fixture_assert(kernel_init(&kernel, fixture_context(), device, &how));
    const struct trace_args args = {.base = {ds.base[0], ds.base[1], ds.base[2], ds.scale}, .count = count, .root = ds.root};
    fixture_assert(kernel_run(&kernel, fixture_context(), device, &args, (count + GROUP_SIZE - 1) / GROUP_SIZE, NULL));
    fixture_assert(buffer_download(&out, fixture_context(), device, hits, count * sizeof *hits));
    kernel_finish(&kernel, device);
    buffer_finish(&out, device);
    buffer_finish(&in, device);
    device_scene_finish(&ds, device);
    fixture_assert(device_validated(device, fixture_context()));
}

#endif
