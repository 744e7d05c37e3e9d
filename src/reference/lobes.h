// The lobes of ref_bsdf.c, one by one: the values π·f·cos, without their color, and the samples.
#ifndef REFERENCE_LOBES_H
#define REFERENCE_LOBES_H

#define REF_PI 3.14159265358979323846

// (r·v)^exponent and (n·h)^exponent, 0 where the cosine is not positive; x^0 is 1, but 0 where there is no half vector.
double lobe_phong(const double n[3], const double wo[3], const double wi[3], double exponent);
double lobe_blinn(const double n[3], const double wo[3], const double wi[3], double exponent);

// Densities of their samples, whatever side they are on.
double lobe_phong_pdf(const double n[3], const double wo[3], const double wi[3], double exponent);
double lobe_blinn_pdf(const double n[3], const double wo[3], const double wi[3], double exponent);

// GGX, without the Fresnel term, and the density of its samples; 0 unless both directions are above the surface.
double lobe_ggx(const double n[3], const double wo[3], const double wi[3], double alpha);
double lobe_ggx_pdf(const double n[3], const double wo[3], const double wi[3], double alpha);
double lobe_ggx_alpha(double roughness);

// Schlick's Fresnel term for one color channel.
double lobe_schlick(double f0, double cosine);

// What of a diffuse base's light gets in and out through a layer with that term (Kelemen and Szirmay-Kalos 2001).
double lobe_matte(double f0, double cos_o, double cos_i);

// Directions for u in [0, 1)²; zero where there is none.
void lobe_cosine_sample(double wi[3], const double n[3], const float u[2]);
void lobe_phong_sample(double wi[3], const double n[3], const double wo[3], double exponent, const float u[2]);
void lobe_blinn_sample(double wi[3], const double n[3], const double wo[3], double exponent, const float u[2]);
void lobe_ggx_sample(double wi[3], const double n[3], const double wo[3], double alpha, const float u[2]);

#endif
