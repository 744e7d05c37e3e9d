// The material at a point of a surface, in fp64, with what its maps say there.
#ifndef REFERENCE_MATERIAL_H
#define REFERENCE_MATERIAL_H

#include "reference/bsdf.h"
#include "reference/surface.h"

struct ref_material {
    struct ref_bsdf bsdf;
    double ambient[3], emission[3], absorption[3];
    uint32_t number, priority;
    bool thin;
};

// Bends the surface's shading normal, too, where there is a normal map.
void ref_material_at(struct ref_material *out, const struct ref_world *world, struct surface *surface);

// How much of the surface is there: 1, 0, or between them the chance of it.
double ref_material_alpha(const struct ref_world *world, const struct surface *surface);

#endif
