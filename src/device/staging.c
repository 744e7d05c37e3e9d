// A buffer through which data travels to and from memory that the host cannot see.
#include "device/staging.h"

#include <stdlib.h>

struct buffer *staging_buffer(struct device *device, struct context *ctx) {
    if (device->staging) return device->staging;
    struct buffer *staging = array_alloc(ctx, 1, sizeof *staging, "the staging buffer");
    const struct buffer_params params = {.name = "staging", .kind = BUFFER_STAGING, .size = STAGING_BYTES, .host_reads = true};
    if (staging && buffer_init(staging, ctx, device, &params)) return device->staging = staging;
    free(staging);
    return NULL;
}

void staging_finish(struct device *device) {
    if (device->staging) buffer_finish(device->staging, device);
    free(device->staging);
    device->staging = NULL;
}
