// Textures on a device: the arrays TEXTURES and TEXELS of shared.h.
#ifndef RENDER_UPLOAD_TEXTURES_H
#define RENDER_UPLOAD_TEXTURES_H

#include "device/kernel.h"
#include "scene/scene.h"

// Zeroed is empty; device_textures_finish accepts a half-made one.
struct device_textures {
    struct buffer textures, texels;
};

// `effects`: EFFECT_* bits in force. Single words where none of them reads a texture. GN_LIMIT when the texels are more than the device
// takes.
bool device_textures_init(struct device_textures *out, struct context *ctx, struct device *device, const struct scene *scene,
                          uint32_t effects);
void device_textures_finish(struct device_textures *textures, struct device *device);

#define DEVICE_TEXTURES_BINDINGS 2
// Writes the bindings of the arrays to bindings[0 …).
void device_textures_bindings(struct device_textures *textures, struct kernel_binding bindings[DEVICE_TEXTURES_BINDINGS]);

#endif
