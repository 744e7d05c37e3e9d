// The Vulkan instance: extensions and layers asked for, and the messages of the validation layer.
#ifndef DEVICE_INSTANCE_H
#define DEVICE_INSTANCE_H

#include "device/device.h"

// Fills device->instance, and with `validate` the messenger, whose messages are counted in *device. A validation layer that is not
// installed is a warning. Fails with GN_NO_DEVICE, saying what to install.
bool instance_init(struct device *device, struct context *ctx, bool validate);
void instance_finish(struct device *device);

// The message where no device is found at all.
#define NO_DRIVER_HINT "install one: a GPU's own, or the software driver of Mesa (package mesa-vulkan-drivers)"

#endif
