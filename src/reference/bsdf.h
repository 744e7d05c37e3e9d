// What a surface does to light, in fp64: the definitions that shaders/bsdf.glsl is held to, in its units (π·f·cos) and with its rules about
// sides, but from other formulas where there are any. The map from random numbers to directions is part of the definition, so that both
// sides follow the same path.
//
// All directions are unit and point away from the surface; n is the shading normal, ng the geometric one, both on the viewer's side.
#ifndef REFERENCE_BSDF_H
#define REFERENCE_BSDF_H

#include "scene/scene.h"

// A material at a point. Fields mean what they mean in struct scene_material.
struct ref_bsdf {
    enum material_model model;
    double diffuse[3], specular[3], reflection[3];
    double shininess, metallic, roughness, ior;
    uint32_t effects; // EFFECT_* bits that run: a lobe whose bit is absent is not there
};

// How a path goes on.
struct ref_sample {
    double wi[3];
    double weight[3]; // f·cos/pdf
    double pdf;       // per solid angle; 0: a mirror's or glass's only direction
    bool transmitted; // to the other side
};

// As the material has it; what textures change is written over.
struct ref_bsdf ref_bsdf_make(const struct scene_material *material, uint32_t effects);

// π·f·cos for light from wi that goes to wo.
void ref_bsdf_eval(double value[3], const struct ref_bsdf *b, const double n[3], const double wo[3], const double wi[3]);

// The density of ref_bsdf_sample at wi, mirrors not counted; 0 without EFFECT_INDIRECT.
double ref_bsdf_pdf(const struct ref_bsdf *b, const double n[3], const double wo[3], const double wi[3]);

// `choice` picks the lobe, u the direction in it. False: the path ends.
bool ref_bsdf_sample(struct ref_sample *out, const struct ref_bsdf *b, const double n[3], const double ng[3], const double wo[3],
                     const float u[2], float choice);

// The mirror image of wo about n, or about ng where that would come out of the back.
void ref_mirror(double wi[3], const double n[3], const double ng[3], const double wo[3]);

#endif
