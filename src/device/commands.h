// Work for the device: recorded, submitted, and waited for with a limit.
#ifndef DEVICE_COMMANDS_H
#define DEVICE_COMMANDS_H

#include "device/device.h"

// Command buffer, fence, timestamps and pipeline cache of an open device.
bool commands_init(struct device *device, struct context *ctx);
void commands_finish(struct device *device);

// Begins to record device->commands.
bool commands_begin(struct device *device, struct context *ctx);

// Makes what `stage` writes by `access` visible to all later kernels and transfers, and to the host.
void commands_barrier(struct device *device, VkPipelineStageFlags stage, VkAccessFlags access);

// Submits what is recorded for the object `kind` `name` ("kernel", "render"), and waits until it is done. Meanwhile progress(ctx, "device",
// -1, -1) is called some ten times a second (a fraction of -1 means: nothing new, only asking). Whoever cancels gets GN_CANCELLED within a
// second: work that is not done by then makes the device lost. After `limit` seconds: GN_DEVICE_LOST, naming the object.
bool commands_run(struct device *device, struct context *ctx, const char *kind, const char *name, double limit);

#endif
