// A scene on a device: the arrays of shared.h, filled from scene and hierarchy.
//
// Device units are scene units times a power of two that brings the largest coordinate of the geometry to [1, 2): exact, and the kernels' products stay
// far from overflow and underflow whatever the scene's units.
#ifndef RENDER_UPLOAD_H
#define RENDER_UPLOAD_H

#include "bvh/bvh.h"
#include "device/kernel.h"
#include "scene/scene.h"
#include "shaders/shared.h"

// Zeroed is empty; device_scene_finish accepts a half-made one. Arrays that the effects do not call for hold a single word.
struct device_scene {
    struct buffer nodes, triangles, spheres, objects, materials, lights, indices, normals, globals;
    float scale;            // device units per scene unit
    uint32_t root;          // reference of the root, as in shared.h
    uint32_t light_count;   // lights that any effect reads
};

// `effects`: EFFECT_* bits in force. `shading` false leaves out what only pictures need.
bool device_scene_init(struct device_scene *out, struct context *ctx, struct device *device, const struct scene *scene,
                       const struct bvh *bvh, uint32_t effects, bool shading);
void device_scene_finish(struct device_scene *ds, struct device *device);

// Writes the bindings of the scene's arrays to bindings[0 …), at most `capacity`; returns how many.
size_t device_scene_bindings(struct device_scene *ds, struct kernel_binding *bindings, bool shading);
#define DEVICE_SCENE_BINDINGS 9

#endif
