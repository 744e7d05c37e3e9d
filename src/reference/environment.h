// Light from the environment, in fp64.
#ifndef REFERENCE_ENVIRONMENT_H
#define REFERENCE_ENVIRONMENT_H

#include "scene/sky.h"

// The radiance that comes from a direction of any length but 0: interpolated bilinearly between the centers of texels, around the horizon
// without an end; what is within 2^-23 of the picture from a center is there.
void environment_radiance(double rgb[3], const struct sky *sky, const double way[3]);

// A direction for random numbers u, unit, and its density per solid angle.
void environment_sample(double way[3], double *pdf, const struct sky *sky, const float u[2]);

// That density at any direction.
double environment_pdf(const struct sky *sky, const double way[3]);

#endif
