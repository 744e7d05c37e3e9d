// Which device `--device` means. Knows no Vulkan: it reads descriptions.
#ifndef DEVICE_SELECT_H
#define DEVICE_SELECT_H

#include "gnomon.h"

// The place in infos[0 … count) that `selector` names, or -1. NULL or "": a usable device, discrete GPU before integrated before virtual
// before CPU before the rest. "cpu", "gpu": a usable one of that type, in the same order. "uuid:…": its first digits, dashes or not. A
// number: the device at that place. Anything else: part of the name, in either case; a usable one is preferred. A device that is named may
// be unusable.
int device_select(const struct gn_device_info *infos, uint32_t count, const char *selector);

#endif
