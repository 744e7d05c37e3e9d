// Points of surfaces in fp64.
#ifndef REFERENCE_SURFACE_H
#define REFERENCE_SURFACE_H

#include "reference/traverse.h"

// A point of a surface that a ray has hit.
struct surface {
    struct crossing crossing;
    double p[3];  // the point
    double ng[3]; // unit geometric normal, on the viewer's side
    double n[3];  // unit shading normal, on the viewer's side
    double wo[3]; // unit, towards the viewer
    bool front;   // seen from the side of its own geometric normal
    double uv[2]; // texture coordinates; 0 where there are none
    double du[3], dv[3]; // how the point moves with u and v, each up to a positive factor; 0 where nobody knows
};

// The surface where `ray` crosses. The geometric normal is turned to the viewer, the shading normal to the side of the geometric one. The
// point is a double that fits the exact predicates.
struct surface surface_at(const struct ref_world *world, const struct ref_ray *ray, const struct crossing *crossing);

#endif
