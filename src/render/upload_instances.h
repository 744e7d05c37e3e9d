// The records of BINDING_INSTANCES: how rays and vertices go between device units and what an instance draws (shaders/instance.glsl).
#ifndef RENDER_UPLOAD_INSTANCES_H
#define RENDER_UPLOAD_INSTANCES_H

#include "scene/scene.h"
#include "shaders/shared.h"

// What the boxes of a part's hierarchy are measured in: a vertex v is at (v - center)·scale, each coordinate in [-1, 1].
struct part_frame {
    double center[3], scale;
};
struct part_frame part_frame_of(const struct scene_part *part);

// The record of an instance. `base` and `scale` as in struct device_scene; `root` of its part, `offset` as shared.h has it.
void write_instance(struct word4 to[INSTANCE_WORDS], const struct scene *scene, const struct scene_instance *instance, const float base[3], float scale,
                    uint32_t root, uint32_t offset);

// The record of a sphere that moves.
void write_moving_sphere(struct word4 to[INSTANCE_WORDS], const struct scene_shape *shape, const float base[3], float scale);

#endif
