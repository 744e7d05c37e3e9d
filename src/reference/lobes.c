// Lobes from their textbook definitions: GGX by tangents and Smith's Λ (B. Walter et al. 2007; E. Heitz 2014), where the shader has
// rewritten both.
#include "reference/lobes.h"

#include "reference/vector.h"

// --------------------------------------------------------------------------------------------------------------- values

double lobe_phong(const double n[3], const double wo[3], const double wi[3], double exponent) {
    double cosine = 2 * vector_dot(n, wi) * vector_dot(n, wo) - vector_dot(wi, wo);
    return pow(fmin(fmax(cosine, 0), 1), exponent);
}

double lobe_phong_pdf(const double n[3], const double wo[3], const double wi[3], double exponent) {
    return (exponent + 1) / (2 * REF_PI) * lobe_phong(n, wo, wi, exponent);
}

double lobe_blinn(const double n[3], const double wo[3], const double wi[3], double exponent) {
    double h[3];
    vector_half(h, wo, wi);
    if (!(vector_dot(h, h) > 0)) return 0;
    return pow(fmin(fmax(vector_dot(n, h), 0), 1), exponent);
}

double lobe_blinn_pdf(const double n[3], const double wo[3], const double wi[3], double exponent) {
    double h[3];
    vector_half(h, wo, wi);
    double cosine = vector_dot(wo, h);
    return cosine > 0 ? (exponent + 1) / (2 * REF_PI) * lobe_blinn(n, wo, wi, exponent) / (4 * cosine) : 0;
}

double lobe_ggx_alpha(double roughness) { return fmax(roughness * roughness, 0x1p-10); }

static double tan2(double cosine) { return fmax(1 - cosine * cosine, 0) / (cosine * cosine); }

// Facets per solid angle of their normals.
static double ggx_distribution(double cosine, double alpha) {
    double a2 = alpha * alpha, c2 = cosine * cosine, spread = 1 + tan2(cosine) / a2;
    return 1 / (REF_PI * a2 * c2 * c2 * spread * spread);
}

static double ggx_lambda(double cosine, double alpha) { return (sqrt(1 + alpha * alpha * tan2(cosine)) - 1) / 2; }

double lobe_ggx(const double n[3], const double wo[3], const double wi[3], double alpha) {
    double h[3], cos_o = vector_dot(n, wo), cos_i = vector_dot(n, wi);
    if (!(cos_o > 0) || !(cos_i > 0)) return 0;
    vector_half(h, wo, wi);
    double seen = 1 / (1 + ggx_lambda(cos_o, alpha) + ggx_lambda(cos_i, alpha));
    return REF_PI * ggx_distribution(vector_dot(n, h), alpha) * seen / (4 * cos_o);
}

double lobe_ggx_pdf(const double n[3], const double wo[3], const double wi[3], double alpha) {
    double h[3], cos_o = vector_dot(n, wo);
    if (!(cos_o > 0) || !(vector_dot(n, wi) > 0)) return 0;
    vector_half(h, wo, wi);
    double seen = 1 / (1 + ggx_lambda(cos_o, alpha));
    return seen * ggx_distribution(vector_dot(n, h), alpha) / (4 * cos_o);
}

double lobe_schlick(double f0, double cosine) { return f0 + (1 - f0) * pow(1 - fmin(fmax(cosine, 0), 1), 5); }

double lobe_matte(double f0, double cos_o, double cos_i) {
    double mean = f0 + (1 - f0) / 21; // of lobe_schlick over the hemisphere
    return f0 < 1 ? (1 - lobe_schlick(f0, cos_o)) * (1 - lobe_schlick(f0, cos_i)) / (1 - mean) : 0;
}

// -------------------------------------------------------------------------------------------------------------- samples

// The direction that a facet with normal h turns wo into; none where it is seen from behind.
static void turn_by(double wi[3], const double h[3], const double wo[3]) {
    vector_mirror(wi, h, wo);
    for (int i = 0; i < 3; i++) wi[i] = vector_dot(wo, h) > 0 ? wi[i] : 0;
}

void lobe_cosine_sample(double wi[3], const double n[3], const float u[2]) { vector_around(wi, n, sqrt(u[0]), sqrt(1 - (double)u[0]), u[1]); }

static void power_sample(double w[3], const double axis[3], double exponent, const float u[2]) {
    double x = log1p(-(double)u[0]) / (exponent + 1);
    vector_around(w, axis, sqrt(-expm1(2 * x)), exp(x), u[1]);
}

void lobe_phong_sample(double wi[3], const double n[3], const double wo[3], double exponent, const float u[2]) {
    double r[3];
    vector_mirror(r, n, wo);
    power_sample(wi, exponent > 0 ? r : n, exponent, u);
}

void lobe_blinn_sample(double wi[3], const double n[3], const double wo[3], double exponent, const float u[2]) {
    double h[3];
    power_sample(h, n, exponent, u);
    turn_by(wi, h, wo);
}

// J. Dupuy and A. Benyoub, "Sampling visible GGX normals with spherical caps", 2023: a point of the cap of the unit sphere around the
// stretched direction's horizon, plus that direction.
void lobe_ggx_sample(double wi[3], const double n[3], const double wo[3], double alpha, const float u[2]) {
    double t[3], b[3], h[3];
    vector_tangents(t, b, n);
    double w[3] = {alpha * vector_dot(t, wo), alpha * vector_dot(b, wo), vector_dot(n, wo)};
    vector_normalize(w);
    double z = (1 - (double)u[0]) * (1 + w[2]) - w[2], sine = sqrt(fmax((1 - z) * (1 + z), 0));
    double x = alpha * (sine * cos(2 * REF_PI * u[1]) + w[0]), y = alpha * (sine * sin(2 * REF_PI * u[1]) + w[1]);
    for (int i = 0; i < 3; i++) h[i] = x * t[i] + y * b[i] + fmax(z + w[2], 0) * n[i];
    vector_normalize(h);
    turn_by(wi, h, wo);
}
