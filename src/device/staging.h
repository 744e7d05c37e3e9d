// A buffer through which data travels to and from memory that the host cannot see.
#ifndef DEVICE_STAGING_H
#define DEVICE_STAGING_H

#include "device/memory.h"

#define STAGING_BYTES (32u << 20)

// The device's staging buffer, of STAGING_BYTES, made when first asked for; NULL with the reason reported.
struct buffer *staging_buffer(struct device *device, struct context *ctx);
void staging_finish(struct device *device);

#endif
