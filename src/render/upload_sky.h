// The environment on a device: the arrays SKY and SKY_ROWS of shared.h.
#ifndef RENDER_UPLOAD_SKY_H
#define RENDER_UPLOAD_SKY_H

#include "device/kernel.h"
#include "scene/scene.h"

// Zeroed is empty; device_sky_finish accepts a half-made one.
struct device_sky {
    struct buffer texels, rows;
};

// `effects`: EFFECT_* bits in force. Single words where none of them reads it. GN_LIMIT when it is more than the device takes.
bool device_sky_init(struct device_sky *out, struct context *ctx, struct device *device, const struct scene *scene, uint32_t effects);
void device_sky_finish(struct device_sky *sky, struct device *device);

#define DEVICE_SKY_BINDINGS 2
// Writes the bindings of the arrays to bindings[0 …).
void device_sky_bindings(struct device_sky *sky, struct kernel_binding bindings[DEVICE_SKY_BINDINGS]);

#endif
