// Phong shading in fp64, as the interface contract's light model says, with shadow rays that are decided exactly.
#ifndef REFERENCE_SHADE_H
#define REFERENCE_SHADE_H

#include "reference/traverse.h"

// A point of a surface that a ray has hit.
struct surface {
    struct crossing crossing;
    double p[3];  // the point
    double n[3];  // unit shading normal, on the viewer's side
    double wo[3]; // unit, towards the viewer
};

// The surface where `ray` crosses. The geometric normal is turned to the viewer, the shading normal to the side of the geometric one. The
// point is a double that fits the exact predicates.
struct surface surface_at(const struct ref_world *world, const struct ref_ray *ray, const struct crossing *crossing);

// The light that the surface sends back along wo; adds the shadow rays shot to *rays.
void shade(double color[3], uint64_t *rays, const struct ref_world *world, const struct surface *surface);

#endif
