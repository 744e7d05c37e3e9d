// A scene on a device: the arrays of shared.h, filled from scene and hierarchy.
//
// Device coordinates are (scene coordinate - base)·scale, both steps exact for all geometry. The base is where the scene is, if that is far from the
// origin compared with its size: what a kernel computes, a hit point say, is then rounded on the scene's own scale. The scale is the power of two that brings the
// largest coordinate to [1, 2): products stay far from overflow and underflow whatever the scene's units.
#ifndef RENDER_UPLOAD_H
#define RENDER_UPLOAD_H

#include "bvh/bvh.h"
#include "device/kernel.h"
#include "scene/scene.h"
#include "shaders/shared.h"

// Zeroed is empty; device_scene_finish accepts a half-made one. Arrays that the effects do not call for hold a single word.
struct device_scene {
    struct buffer nodes, triangles, spheres, instances, objects, materials, lights, indices, normals, uvs, globals, emitters;
    float base[3];          // scene units
    float scale;            // device units per scene unit
    uint32_t root;          // reference of the root, as in shared.h
    uint32_t light_count;   // lights that any effect reads
};

// `effects`: EFFECT_* bits in force. `eye`: a point (scene units) that must have exact device coordinates, too, or NULL for none. `shading` false leaves out
// what only pictures need.
bool device_scene_init(struct device_scene *out, struct context *ctx, struct device *device, const struct scene *scene,
                       const struct bvh *bvh, uint32_t effects, const float *eye, bool shading);

// A point of the scene in device coordinates, rounded once.
void device_point(float out[3], const struct device_scene *ds, const float point[3]);
void device_scene_finish(struct device_scene *ds, struct device *device);

// Writes the bindings of the scene's arrays to bindings[0 …), at most `capacity`; returns how many.
size_t device_scene_bindings(struct device_scene *ds, struct kernel_binding *bindings, bool shading);
#define DEVICE_SCENE_BINDINGS 12

#endif
