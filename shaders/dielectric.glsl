// Smooth glass: light is sent back or goes through by Fresnel's formulas for unpolarised light.
//
// With η = beyond/here, c the cosine on this side, c' beyond: w = η·c' = √(c² + η² - 1). What would cancel is multiplied out, with
// η² - 1 = (beyond - here)(beyond + here)/here²:
//   r_s = (c - w)/(c + w) = -(η² - 1)/(c + w)²        r_p = (η²c - w)/(η²c + w) = (η² - 1)((η² + 1)c² - 1)/(η²c + w)²
// and the refracted direction is -(wo + n·(η² - 1)/(c + w))/η, so that no sine is taken from a cosine. Where η² - 1 is 0 light goes
// straight on, to the bit. At the critical angle itself, and beyond it, all of it is sent back.
//
// Radiance is not multiplied by η² on the way: what paths carry is radiance over the square of the index of the medium that it is in, which
// refraction leaves as it is (F. E. Nicodemus, "Radiance", American Journal of Physics 31, 1963). Lights and cameras are in media of index
// 1, or as if they were.
#ifndef DIELECTRIC_GLSL
#define DIELECTRIC_GLSL
#include "mirror.glsl"

// Light that comes or goes with a cosine of c: the share that is sent back, η² - 1, and c + w.
struct fresnel_terms { real reflected, rise, sum; };

fresnel_terms fresnel_at(real c, real here, real beyond) {
    real rise = ((beyond - here) / here) * ((beyond + here) / here), square = c * c + rise;
    real w = sqrt(max(square, 0.0)), s = c + w, p = (rise + 1.0) * c + w;
    real rs = rise / max(s * s, REAL_TINY), rp = rise * ((rise + 2.0) * c * c - 1.0) / max(p * p, REAL_TINY);
    bool all_of_it = rise < 0.0 && !(square > 0.0);
    return fresnel_terms(all_of_it ? 1.0 : min(0.5 * (rs * rs + rp * rp), 1.0), rise, s);
}

struct passage { real3 wi; bool transmitted; };

passage dielectric_about(real3 n, real3 wo, real here, real beyond, float choice) {
    real c = max(dot(n, wo), 0.0);
    fresnel_terms f = fresnel_at(c, here, beyond);
    bool transmitted = !(choice < f.reflected);
    real3 back = 2.0 * c * n - wo, through = -(wo + (f.rise / max(f.sum, REAL_TINY)) * n);
    real3 wi = normalize_robust(transmitted ? through : back);
    return passage(transmitted && f.rise == 0.0 ? -wo : wi, transmitted);
}

// Where a path goes on that comes from wo, in a medium of index `here`, to one of index `beyond`: the weight is 1 or, through the surface,
// the tint. n and ng are on wo's side. A direction that would end on the wrong side of ng is taken about ng itself: no light is lost.
void dielectric_sample(real3 n, real3 ng, real3 wo, real here, real beyond, real3 tint, float choice, out real3 wi, out real3 weight,
                       out bool transmitted) {
    passage way = dielectric_about(n, wo, here, beyond, choice);
    if (HAS_BENT_NORMALS) {
        real side = dot(way.wi, ng) * (way.transmitted ? -1.0 : 1.0);
        if (!(side > 0.0) || !(dot(n, wo) > 0.0)) way = dielectric_about(ng, wo, here, beyond, choice);
    }
    wi = way.wi;
    transmitted = way.transmitted;
    weight = transmitted ? tint : real3(1.0);
}

// The same for a sheet that is thinner than what it bends: straight through, or back, after any number of bounces inside: R + T²R/(1 - R²)
// = 2R/(1 + R).
void dielectric_sheet_sample(real3 n, real3 ng, real3 wo, real ior, real3 tint, float choice, out real3 wi, out real3 weight,
                             out bool transmitted) {
    real once = fresnel_at(max(dot(n, wo), 0.0), 1.0, ior).reflected;
    transmitted = !(choice < 2.0 * once / (1.0 + once));
    wi = transmitted ? -wo : mirror_direction(n, ng, wo);
    weight = transmitted ? tint : real3(1.0);
}

#endif
