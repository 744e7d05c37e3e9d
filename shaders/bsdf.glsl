// What a surface does to light, of all models but glass (dielectric.glsl): a diffuse part, a highlight, a share of a mirror.
//
// Values are π·f·cos, f the BRDF: a point light of intensity I adds I times the value, a light of radiance L that is sampled with a density
// p adds L·value/(π·p). With Kd·cos + Ks·(r·v)^n that is the contract's light model, as it stands; it sends back 2Ks/(n+1) of the light at
// most and is not reciprocal in f, but in f·cos. Weights of samples are f·cos/density.
//
// Sides. n is the shading normal, ng the geometric one, both on the viewer's side. A light below n gives nothing, whatever ng says. Light
// that comes from below ng would shine through the surface: samples never go there, and a caller that adds a light with a size must ask
// `through_surface`, so that both ways of finding it agree; the contract's point lights follow n alone. Where n looks away from the viewer,
// metallic-roughness sends back nothing, and other models do not care.
//
// A lobe without its HAS_ constant is not there: no code, no value, no samples.
#ifndef BSDF_GLSL
#define BSDF_GLSL
#include "blinn_phong.glsl"
#include "ggx.glsl"
#include "hemisphere.glsl"
#include "mirror.glsl"
#include "phong.glsl"

const bool HAS_POWER = HAS_SPECULAR || HAS_BLINN;
const bool HAS_HIGHLIGHT = HAS_POWER || HAS_GGX;

struct bsdf {
    uint model;         // PHONG_MODEL and so on
    real3 diffuse;      // Kd
    real3 specular;     // Ks; of metallic-roughness what is sent back head-on
    real3 reflection;   // a mirror's share
    real shininess;     // exponent; of metallic-roughness α
};

// From a material, with the textures already in it. Of glass nothing is left: dielectric.glsl does it all.
bsdf bsdf_make(uint model, real3 diffuse, real3 specular, real shininess, real3 reflection, real metallic, real roughness, real ior) {
    bool has_highlight = (HAS_SPECULAR && model == PHONG_MODEL) || (HAS_BLINN && model == BLINN_PHONG_MODEL);
    bsdf b = bsdf(model, diffuse, has_highlight ? specular : real3(0.0), reflection, shininess);
    if (HAS_GGX && model == METALLIC_ROUGHNESS_MODEL) {
        real root = (ior - 1.0) / (ior + 1.0);
        b.specular = mix(real3(root * root), diffuse, metallic);
        b.diffuse = diffuse * (1.0 - metallic);
        b.shininess = ggx_alpha(roughness);
    }
    if (model == MIRROR_MODEL) b.reflection = diffuse;
    if (model == MIRROR_MODEL || model == DIELECTRIC_MODEL) b.diffuse = real3(0.0);
    return b;
}

bool is_ggx(bsdf b) { return HAS_GGX && b.model == METALLIC_ROUGHNESS_MODEL; }
bool is_blinn(bsdf b) { return HAS_BLINN && (!HAS_SPECULAR || b.model == BLINN_PHONG_MODEL); }

bool through_surface(real3 ng, real3 wi) { return !(dot(ng, wi) > 0.0); }

real total(real3 v) { return v.x + v.y + v.z; }

// How often a path goes on by the mirror, the highlight, the diffuse part, by what each sends back; all 0 for black. Without INDIRECT only
// a mirror goes on.
real3 bsdf_chances(bsdf b, real cos_o) {
    real mirror = HAS_REFLECTION ? total(b.reflection) : 0.0;
    if (!HAS_INDIRECT) return real3(mirror > 0.0 ? 1.0 : 0.0, 0.0, 0.0);
    real highlight = 0.0;
    if (HAS_POWER) highlight = total(b.specular) * 2.0 / (b.shininess + 1.0);
    if (is_ggx(b)) highlight = cos_o > 0.0 ? total(schlick(b.specular, cos_o)) : 0.0;
    real diffuse = HAS_DIFFUSE ? total(b.diffuse) : 0.0;
    real sum = mirror + highlight + diffuse;
    return sum > 0.0 ? real3(mirror, highlight, diffuse) / sum : real3(0.0);
}

// The highlight of Phong and of Blinn and Phong, without Ks.
real bsdf_gloss(bsdf b, real3 n, real3 wo, real3 wi) {
    if (!HAS_POWER) return 0.0;
    real cosine = HAS_SPECULAR ? phong_cosine(n, wi, wo) : 0.0;
    if (is_blinn(b)) cosine = blinn_cosine(n, wi, wo);
    return cosine < 0.0 ? 0.0 : power(cosine, b.shininess);
}

// The value, and π times the density of samples that are not a mirror's. The gloss is given, since a sample knows its own better than the
// direction that came of it.
real3 bsdf_lobes(bsdf b, real3 n, real3 wo, real3 wi, real gloss, out real density) {
    real cos_i = dot(n, wi), cos_o = dot(n, wo);
    real3 chance = bsdf_chances(b, cos_o);
    real3 kd = b.diffuse, ks = b.specular;
    real value = gloss, spread = 0.5 * (b.shininess + 1.0) * gloss;
    if (is_blinn(b)) spread *= blinn_spread(wi, wo);
    if (is_ggx(b)) {
        ggx_pair g = ggx_at(n, wo, wi, b.shininess);
        ks = schlick(b.specular, g.cos_h);
        kd *= matte_share(b.specular, cos_o, cos_i);
        value = g.value;
        spread = g.density;
    }
    real3 sum = real3(0.0);
    density = 0.0;
    if (HAS_DIFFUSE) {
        sum += kd * cos_i;
        density += chance.z * cos_i;
    }
    if (HAS_HIGHLIGHT) {
        sum += ks * value;
        density += chance.y * spread;
    }
    if (!(cos_i > 0.0)) density = 0.0;
    return cos_i > 0.0 ? sum : real3(0.0);
}

// π·f·cos for light from wi that goes to wo. All directions are unit and point away from the surface. pdf: the density of bsdf_sample at wi, per solid angle; its
// integral is what is left for other than mirrors, less the samples that are refused. 0 without INDIRECT.
real3 bsdf_eval(bsdf b, real3 n, real3 wo, real3 wi, out real pdf) {
    real3 value = bsdf_lobes(b, n, wo, wi, bsdf_gloss(b, n, wo, wi), pdf);
    pdf *= 2.0 * ARC;
    return value;
}

// A direction from one of the lobes; zero where there is none.
real3 bsdf_direction(bsdf b, real3 n, real3 wo, vec2 u, bool highlight) {
    real2 turn = sincos_turns(real(u.y));
    real3 axis = n, local = cosine_direction(real(u.x), turn);
    bool by_half = highlight && (is_blinn(b) || is_ggx(b));
    if (HAS_POWER && highlight) {
        local = power_cosine_direction(real(u.x), turn, b.shininess);
        if (HAS_SPECULAR && !by_half && b.shininess > 0.0) axis = 2.0 * dot(n, wo) * n - wo; // exponent 0: the same everywhere above n
    }
    if (highlight && is_ggx(b)) local = ggx_half(to_frame(n, wo), b.shininess, real(u.x), turn);
    real3 w = from_frame(axis, local);
    if (HAS_BLINN || HAS_GGX) {
        real cosine = dot(wo, w);
        if (by_half) w = cosine > 0.0 ? 2.0 * cosine * w - wo : real3(0.0);
    }
    return normalize_robust(w);
}

// The way for a path to go on that has mirrors only. False: the path ends here.
bool bsdf_sample_mirror(bsdf b, real3 n, real3 ng, real3 wo, out real3 wi, out real3 weight) {
    wi = HAS_REFLECTION ? mirror_direction(n, ng, wo) : real3(0.0);
    weight = HAS_REFLECTION ? b.reflection : real3(0.0);
    return total(weight) > 0.0 && !through_surface(ng, wi);
}

// A way for a path to go on: `choice` picks the lobe, u the direction in it. pdf is the density per solid angle, 0 for a mirror. False: the
// path ends here.
bool bsdf_sample(bsdf b, real3 n, real3 ng, real3 wo, vec2 u, float choice, out real3 wi, out real3 weight, out real pdf) {
    real3 chance = bsdf_chances(b, dot(n, wo));
    wi = weight = real3(0.0);
    pdf = 0.0;
    if (HAS_REFLECTION && choice < chance.x) {
        wi = mirror_direction(n, ng, wo);
        weight = b.reflection / chance.x;
        return !through_surface(ng, wi);
    }
    if (!HAS_INDIRECT) return false;
    bool highlight = HAS_HIGHLIGHT && (!HAS_DIFFUSE || choice < chance.x + chance.y);
    wi = bsdf_direction(b, n, wo, u, highlight);
    real gloss = HAS_POWER && highlight ? power(1.0 - real(u.x), b.shininess / (b.shininess + 1.0)) : bsdf_gloss(b, n, wo, wi);
    real density;
    real3 value = bsdf_lobes(b, n, wo, wi, gloss, density);
    bool drawn = density > 0.0 && is_finite(density) && !through_surface(ng, wi);
    weight = drawn ? value / density : real3(0.0);
    pdf = density * (2.0 * ARC);
    return drawn;
}

#endif
