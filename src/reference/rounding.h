// Exact numbers to the nearest fp32, ties to even, overflow to infinity: what a hit reports.
#ifndef REFERENCE_ROUNDING_H
#define REFERENCE_ROUNDING_H

#include "gnomon.h"
#include "reference/predicates.h"

// The fp32 nearest to an exact number within `bounds`.
float round_fraction(const struct fraction *exact, struct interval bounds);

// Fills t, u and v of a hit; u and v of a sphere are 0.
void crossing_round(struct gn_hit *hit, const struct ref_ray *ray, const struct crossing *crossing);

#endif
