// The camera words of shared.h: what the effects of the camera read.
#ifndef RENDER_UPLOAD_CAMERA_H
#define RENDER_UPLOAD_CAMERA_H

#include "device/kernel.h"
#include "scene/scene.h"

// `effects`: EFFECT_* bits in force. A single word where none of them reads any.
bool upload_camera(struct buffer *out, struct context *ctx, struct device *device, const struct scene *scene, uint32_t effects);

#endif
