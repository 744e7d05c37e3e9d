// The camera words of shared.h: what the effects of the camera read.
#ifndef RENDER_UPLOAD_CAMERA_H
#define RENDER_UPLOAD_CAMERA_H

#include "device/kernel.h"
#include "render/camera.h"
#include "scene/scene.h"

struct upload_camera_params {
    const struct camera_rays *rays;
    const struct scene_film *film;
    float scale;            // device units per scene unit
    uint32_t effects;       // EFFECT_* bits in force
};

// A single word where none of the effects reads any.
bool upload_camera(struct buffer *out, struct context *ctx, struct device *device, const struct upload_camera_params *params);

#endif
