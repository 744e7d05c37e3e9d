// The hinge and the passes: scene + plan + BVH become the arrays of shared.h on a device; kernels run over them in pieces; the film comes back.
#ifndef RENDER_RENDER_H
#define RENDER_RENDER_H

#include "base/image.h"
#include "bvh/bvh.h"
#include "device/device.h"
#include "effects/plan.h"
#include "render/lattice.h"
#include "scene/scene.h"

struct render_params {
    uint32_t width, height, spp, seed;
    uint32_t tier;                  // TIER_*
    uint32_t effects;               // EFFECT_* bits that run
    uint32_t aovs;                  // GN_AOV_* bits that a kernel can fill: not ERROR and ULP
    uint32_t tile_pixels;           // pixels of a piece of work; 0: measured
    struct lattice lattice;         // the pixels that are rendered; zeroed: all
    uint32_t knobs[KNOB_COUNT];     // positions; 0 is the default
};

// A buffer or an image that a picture took on the device.
struct render_place {
    const char *name;
    uint64_t bytes;
    uint64_t limit; // what the device lets one of its kind have; 0: it has no limit of its own
};
#define RENDER_PLACES 32

// As reference_film, plus what the device did.
struct render_film {
    struct image color, depth, normal, id;
    struct image undecided;         // rays of each pixel that the tier's first stage left undecided, 1 channel; empty when not asked for
    uint64_t rays, nonfinite_pixels, undecided_rays;
    uint64_t second_stage_rays;     // undecided rays that fp64 decided on the device; the rest took integers on the host
    double pipeline_ms, upload_ms, trace_ms;
    struct render_place places[RENDER_PLACES];
    uint32_t place_count;
};

bool render_picture(struct render_film *out, struct context *ctx, struct device *device, const struct scene *scene, const struct bvh *bvh,
                    const struct render_params *params);
void render_film_finish(struct render_film *film);

struct render_trace_params {
    uint32_t tier;
    uint32_t effects;
    bool any;
    uint32_t repeat;                // at least 1
};

struct render_trace_stats {
    uint64_t hits, undecided_rays;
    uint64_t second_stage_rays;                 // undecided rays that fp64 decided on the device; the rest took integers on the host
    double pipeline_ms, upload_ms, trace_ms;    // trace: median over the repeats
};

bool render_trace(struct gn_hit *hits, struct render_trace_stats *stats, struct context *ctx, struct device *device, const struct scene *scene,
                  const struct bvh *bvh, const struct render_trace_params *params, const struct gn_ray *rays, size_t count);

#endif
