// What stands behind the opaque handles of gnomon.h. Seen by src/api/ only.
#ifndef API_HANDLES_H
#define API_HANDLES_H

#include "base/image.h"
#include "bvh/bvh.h"
#include "device/device.h"
#include "effects/plan.h"
#include "scene/scene.h"

struct gn_device {
    struct device device;
    double startup_ms;
};

struct gn_scene {
    struct scene scene;
    struct bvh bvh; // built at the first use; has_bvh says whether it was
    bool has_bvh;
    double load_ms, bvh_ms;
};

struct gn_picture {
    struct image color, depth, normal, id; // those that were not asked for are empty
    struct image error, ulp, undecided;    // likewise
    enum transfer transfer;                // for 8-bit files
    struct gn_render_stats stats;
};

// What a render job comes to when the scene's defaults are filled in.
struct job {
    uint32_t width, height, spp, seed, aovs, tile_pixels;
    uint32_t tier;        // TIER_*; without meaning for the reference
    const char *accuracy; // its name
    struct plan plan;
};

// Settles what `params` leave open and checks them. `reference`: the accuracy is not looked at.
bool job_make(struct job *out, struct context *ctx, const struct gn_scene *scene, const struct gn_render_params *params, bool reference);

// The tier of this accuracy. GN_USAGE where this version does not have it.
bool tier_of_accuracy(uint32_t *tier, const char **name, struct context *ctx, enum gn_accuracy accuracy);

// Makes the scene's BVH unless that was done before.
bool scene_bvh(struct gn_scene *scene, struct context *ctx);

#endif
