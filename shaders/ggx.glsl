// The metallic-roughness material of glTF 2.0 (Khronos, "glTF 2.0 specification", appendix B): GGX facets with Smith's height-correlated
// masking and Schlick's Fresnel term, over a diffuse base. Light that bounces between facets is lost, as there: a rough white metal sends
// back 1 - ln 2 of what comes head-on.
//
// B. Walter et al., "Microfacet models for refraction through rough surfaces", 2007; E. Heitz, "Understanding the masking-shadowing
// function in microfacet-based BRDFs", JCGT 3(2), 2014. With A(x) = √(α² + (1-α²)x²): G2/(4 cos_o cos_i) = ½/(cos_i A(cos_o) + cos_o
// A(cos_i)), G1/(4 cos_o) = ½/(cos_o + A(cos_o)).
#ifndef GGX_GLSL
#define GGX_GLSL
#include "hemisphere.glsl"
#include "tier_robust.glsl"

// α = roughness², but not below 2^-10, which already looks like a mirror: an fp32 half vector lies within a few 10^-7 of the right one, and
// of its sine there should be some digits left. The highlight's peak is 1/πα².
real ggx_alpha(real roughness) { return max(roughness * roughness, 0.0009765625); }

// Schlick's approximation: from f0 head-on to 1 along the horizon, by (1 - cos)^5.
real schlick_rise(real cosine) {
    real x = 1.0 - clamp(cosine, 0.0, 1.0), x2 = x * x;
    return x2 * x2 * x;
}
real3 schlick(real3 f0, real cosine) { return f0 + (1.0 - f0) * schlick_rise(cosine); }

// The share of the diffuse base's light that gets out through the layer above it. The specification's own term, 1 - F at the half vector,
// gives the base light that the layer has sent back already: up to 1.7 times what came, near the horizon. This one is 1 - F for the way in
// and for the way out, over its mean, so that base and layer share what there is (C. Kelemen and L. Szirmay-Kalos, "A microfacet based
// coupled specular-matte BRDF model", 2001); head-on both are the same.
real3 matte_share(real3 f0, real cos_o, real cos_i) {
    return (1.0 - f0) * ((1.0 - schlick_rise(cos_o)) * (1.0 - schlick_rise(cos_i)) * 21.0 / 20.0);
}

// Of a pair of directions: π·D·G2/(4 cos_o), to be multiplied with the Fresnel term at cos_h; and π times the density with which ggx_half
// below leads from wo to wi. Both 0 unless both directions are above the surface.
struct ggx_pair { real value, density, cos_h; };

ggx_pair ggx_at(real3 n, real3 wo, real3 wi, real alpha) {
    real cos_o = dot(n, wo), cos_i = dot(n, wi), a2 = alpha * alpha;
    real3 h = normalize_robust(wo + wi), across = cross(n, h);
    real cos_n = dot(n, h);
    real root = alpha / max(a2 * cos_n * cos_n + dot(across, across), a2); // of πD; the cross product's sine has digits near the peak
    real from = sqrt(a2 + (1.0 - a2) * cos_o * cos_o), to = sqrt(a2 + (1.0 - a2) * cos_i * cos_i);
    bool above = cos_o > 0.0 && cos_i > 0.0;
    real value = root * root * 0.5 * cos_i / max(cos_i * from + cos_o * to, REAL_TINY);
    real density = root * root * 0.5 / (cos_o + from);
    return ggx_pair(above ? value : 0.0, above ? density : 0.0, dot(wo, h));
}

// A facet's normal that is seen from wo, as often as it is seen; both in the frame of n. J. Dupuy and A. Benyoub, "Sampling visible GGX
// normals with spherical caps", 2023: the same distribution as E. Heitz's of 2018.
real3 ggx_half(real3 wo, real alpha, real u, real2 turn) {
    real3 w = normalize_robust(real3(alpha * wo.xy, wo.z));
    real depth = u * (1.0 + w.z);       // of the cap below its pole, so that 1 - z loses nothing
    real s = sqrt(max(depth * (2.0 - depth), 0.0));
    real3 h = real3(s * turn.y, s * turn.x, 1.0 - depth) + w;
    return normalize_robust(real3(alpha * h.xy, max(h.z, 0.0)));
}

#endif
