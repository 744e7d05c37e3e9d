// Smooth glass in fp64, from Snell's and Fresnel's laws as they are taught; what absorbs; what overlaps. shaders/dielectric.glsl,
// absorption.glsl and nested.glsl say the rules.
#ifndef REFERENCE_DIELECTRIC_H
#define REFERENCE_DIELECTRIC_H

#include "reference/bsdf.h"

// The share of unpolarised light that is sent back, by the cosine and the indices on both sides; 1 at the critical angle and beyond.
double ref_fresnel(double cosine, double here, double beyond);

// How a path goes on: sent back if choice < ref_fresnel, else refracted.
void ref_dielectric_sample(struct ref_sample *out, const double n[3], const double ng[3], const double wo[3], double here, double beyond,
                           const double tint[3], float choice);

// A thin sheet: sent back, or straight on.
void ref_dielectric_sheet_sample(struct ref_sample *out, const double n[3], const double ng[3], const double wo[3], double ior,
                                 const double tint[3], float choice);

// exp(-sigma·way); 1 where sigma is 0, even if the way is infinite.
double ref_absorb(double sigma, double way);

// The dielectrics that a ray is inside of, in the order in which it entered them. Zeroed is vacuum.
#define REF_MEDIA 4
struct ref_medium {
    uint32_t priority, number;
}; // number: material + 1
struct ref_media {
    struct ref_medium entries[REF_MEDIA];
    uint32_t count;
};

// What a ray meets at a surface. `here` and `beyond`: material + 1, or 0 for vacuum.
struct ref_media_change {
    bool counts; // else the ray goes straight on, in `after`
    uint32_t here, beyond;
    struct ref_media after;
};
struct ref_media_change ref_media_cross(const struct ref_media *media, uint32_t material, uint32_t priority, bool entering);

// The material + 1 of the medium that the ray is in; 0 for vacuum.
uint32_t ref_media_top(const struct ref_media *media);

#endif
