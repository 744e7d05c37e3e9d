// A homogeneous medium in fp64, from its definition: Beer and Lambert's law and the phase function of Henyey and Greenstein. As shaders/fog.glsl, and with the ball
// that the medium fills.
#ifndef REFERENCE_FOG_H
#define REFERENCE_FOG_H

#include <stdbool.h>

#include "scene/fog.h"

struct ref_fog {
    struct fog_ball ball;   // scene units
    double density;         // per scene unit
};

struct ref_fog ref_fog_make(const struct scene *scene);

// The share that comes through on a way of this length; how far light comes before it is scattered, INFINITY without a medium.
double ref_fog_transmittance(double density, double way);
double ref_fog_distance(double density, float u);

// The part of a ray (`way` is unit) within the ball, before `end`: from span[0] to span[1], as distances; empty where span[0] >= span[1].
void ref_fog_span(double span[2], const struct ref_fog *fog, const double origin[3], const double way[3], double end);

// What of the light between the ray's origin and `end` (INFINITY: from beyond the ball) comes through.
double ref_fog_lets_through(const struct ref_fog *fog, const double origin[3], const double way[3], double end);

// Whether the medium scatters before `end`, and how far from the origin.
bool ref_fog_scatters(double *distance, const struct ref_fog *fog, const double origin[3], const double way[3], double end, float u);

// The density of scattered directions, per solid angle; and a scattered direction of light that goes along the unit vector `way`, with its density.
double ref_fog_phase(double cosine, double g);
void ref_fog_sample(double scattered[3], double *pdf, const double way[3], double g, const float u[2]);

#endif
