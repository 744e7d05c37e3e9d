// The exact tier's pending samples on the host: rays that the kernel left undecided are decided by exact arithmetic, and the kernel goes on with the answers.
#ifndef RENDER_PENDING_H
#define RENDER_PENDING_H

#include "render/kernels.h"
#include "render/upload.h"

// Zeroed is absent: the other tiers have none, but for the buffer.
struct pending {
    struct buffer buffer;           // BINDING_PENDING; tiny where the tier is not exact
    struct kernel kernel;           // the render kernel over the records; made when the first question comes
    struct kernel again;            // the second stage, on devices with doubles; made with it
    uint32_t *slot_of;              // by primitive of the BVH: its number in leaf order, of its kind
    uint32_t *primitive_at[2];      // by number in leaf order, triangles and spheres: the primitive of the BVH
    uint32_t *place_of;             // by triangle of all parts: its place in the order of its part's BVH
};

// What the samples are part of; borrowed.
struct pending_work {
    struct context *ctx;
    struct device *device;
    const struct scene *scene;
    const struct bvh *bvh;
    const struct device_scene *ds;
    const struct kernel_specialization *specialization; // of the render kernel
    const struct kernel_binding *bindings;
    size_t binding_count;
    const struct render_args *args;
    struct status *status;          // mapped; holds the last dispatch's sums
};

bool pending_init(struct pending *out, struct context *ctx, struct device *device, bool exact);
void pending_finish(struct pending *pending, struct device *device);

// Before a dispatch of the render kernel: no records.
void pending_clear(struct pending *pending);

// After it: whether some samples found no record; they ask again in the next dispatch.
bool pending_overflowed(const struct pending *pending);

// After it: answers what was asked until every sample that has a record is done. *sums grows by what that took.
bool pending_resolve(struct pending *pending, const struct pending_work *work, struct status *sums);

#endif
