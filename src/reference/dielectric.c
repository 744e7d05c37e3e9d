// Glass: Snell, Fresnel, Beer and Lambert.
#include "reference/dielectric.h"

#include <math.h>

#include "reference/vector.h"

// The cosine beyond the surface by Snell's law; false where there is none, or it is 0.
static bool snell(double *beyond_cosine, double cosine, double here, double beyond) {
    double sine2 = here * here * (1 - cosine * cosine) / (beyond * beyond);
    *beyond_cosine = sqrt(fmax(1 - sine2, 0));
    return *beyond_cosine > 0;
}

double ref_fresnel(double cosine, double here, double beyond) {
    double other;
    if (here == beyond) return 0;
    if (!snell(&other, cosine, here, beyond)) return 1;
    double s = (here * cosine - beyond * other) / (here * cosine + beyond * other);
    double p = (beyond * cosine - here * other) / (beyond * cosine + here * other);
    return (s * s + p * p) / 2;
}

// Sent back or refracted about n. What lies along the surface is kept, but for the indices; the rest is as long as Snell says.
static void pass(struct ref_sample *out, const double n[3], const double wo[3], double here, double beyond, float choice) {
    double cosine = fmax(vector_dot(n, wo), 0), other = cosine;
    out->transmitted = !(choice < ref_fresnel(cosine, here, beyond));
    if (!out->transmitted) {
        vector_mirror(out->wi, n, wo);
        return;
    }
    if (here != beyond) snell(&other, cosine, here, beyond);
    for (int i = 0; i < 3; i++) out->wi[i] = here == beyond ? -wo[i] : (cosine * n[i] - wo[i]) * here / beyond - other * n[i];
    if (here != beyond) vector_normalize(out->wi);
}

static bool leaves_rightly(const struct ref_sample *s, const double ng[3]) {
    double side = vector_dot(ng, s->wi);
    return s->transmitted ? side < 0 : side > 0;
}

static void weigh(struct ref_sample *out, const double tint[3]) {
    for (int i = 0; i < 3; i++) out->weight[i] = out->transmitted ? tint[i] : 1;
}

void ref_dielectric_sample(struct ref_sample *out, const double n[3], const double ng[3], const double wo[3], double here, double beyond,
                           const double tint[3], float choice) {
    *out = (struct ref_sample){.pdf = 0};
    pass(out, n, wo, here, beyond, choice);
    if (!(vector_dot(n, wo) > 0) || !leaves_rightly(out, ng)) pass(out, ng, wo, here, beyond, choice);
    weigh(out, tint);
}

void ref_dielectric_sheet_sample(struct ref_sample *out, const double n[3], const double ng[3], const double wo[3], double ior,
                                 const double tint[3], float choice) {
    *out = (struct ref_sample){.pdf = 0};
    double once = ref_fresnel(fmax(vector_dot(n, wo), 0), 1, ior);
    out->transmitted = !(choice < once + (1 - once) * once / (1 + once)); // R + T²R/(1 - R²)
    if (out->transmitted)
        for (int i = 0; i < 3; i++) out->wi[i] = -wo[i];
    else
        ref_mirror(out->wi, n, ng, wo);
    weigh(out, tint);
}

double ref_absorb(double sigma, double way) { return sigma > 0 ? exp(-sigma * way) : 1; }
