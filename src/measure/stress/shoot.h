// Rays through the library's own path: plan, kernels, fallback.
#ifndef MEASURE_STRESS_SHOOT_H
#define MEASURE_STRESS_SHOOT_H

#include "measure/stress/row.h"

struct shot {
    const struct scene *scene;
    const struct bvh *bvh;
    const struct gn_ray *rays;
    uint32_t count, tier;
    bool any;
};

// hits[0 … count). Adds the milliseconds that the shooting took to *ms.
bool shoot(struct gn_hit *hits, double *ms, struct stress *s, const struct shot *shot);

#endif
