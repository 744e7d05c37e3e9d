// One function of shading, sampling or texturing at a time, for the stress cases: each is compiled where its effect is on. Included by
// stress_shading.comp and, with FP64 defined, by stress_shading_fp64.comp.
#ifndef STRESS_SHADING_GLSL
#define STRESS_SHADING_GLSL
#include "absorption.glsl"
#include "bsdf.glsl"
#include "dielectric.glsl"
#include "environment.glsl"
#include "fog.glsl"
#include "light_sphere.glsl"
#include "normal_map.glsl"
#include "stress.glsl"
#include "texture.glsl"

uint from, to; // of the numbers given, and of the results
vec2 given2(uint at) { return vec2(given[at], given[at + 1u]); }

void frame() {
    real3 t, b;
    tangents(given3(from), t, b);
    put3(to, t);
    put3(to + 3u, b);
}

// From mirror to mirror, two in turn.
void mirrors() {
    real3 n[2] = {given3(from), given3(from + 3u)}, d = given3(from + 6u);
    for (int i = 0; i < int(given[from + 9u]); i++) d = mirror_direction(n[i & 1], n[i & 1], -d);
    put3(to, d);
}

void facets() {
    real alpha = ggx_alpha(given1(from + 9u));
    ggx_pair g = ggx_at(given3(from), given3(from + 3u), given3(from + 6u), alpha);
    put3(to, real3(g.value, g.density, g.cos_h));
}

void sample_lobe() {
    real gloss = given1(from + 1u);
    real3 n = given3(from + 2u), wi, weight;
    real3 kd = real3(given1(from + 11u)), ks = real3(given1(from + 12u)), mirrored = real3(given1(from + 13u));
    bsdf b = bsdf_make(uint(given[from]), kd, ks, gloss, mirrored, 0.5, gloss, 1.5);
    real pdf;
    bool drawn = bsdf_sample(b, n, n, given3(from + 5u), given2(from + 8u), given[from + 10u], wi, weight, pdf);
    put3(to, wi);
    put3(to + 3u, real3(total(weight), pdf, drawn ? 1.0 : 0.0));
}

void glass() {
    real3 n = given3(from), wo = given3(from + 6u), wi, weight;
    real here = given1(from + 9u), beyond = given1(from + 10u);
    bool transmitted;
    dielectric_sample(n, given3(from + 3u), wo, here, beyond, real3(1.0), given[from + 11u], wi, weight, transmitted);
    put3(to, wi);
    put3(to + 3u, real3(weight.x, transmitted ? 1.0 : 0.0, fresnel_at(max(dot(n, wo), 0.0), here, beyond).reflected));
}

// From wall to wall of a unit sphere of glass, from inside.
void inside_sphere() {
    real3 p = given3(from), d = given3(from + 3u);
    real passed = 0.0;
    for (int i = 0; i < int(given[from + 6u]); i++) {
        p = normalize_robust(p - 2.0 * dot(p, d) * d);
        passage way = dielectric_about(-p, -d, 1.5, 1.0, 0.99999994);
        d = way.wi;
        passed += way.transmitted ? 1.0 : 0.0;
    }
    put3(to, p);
    put3(to + 3u, d);
    result[to + 6u] = float(passed);
}

void sphere_light() {
    real3 way;
    real pdf;
    bool seen = sphere_light_sample(real3(0.0), given3(from), given1(from + 3u), given2(from + 4u), way, pdf);
    put3(to, way);
    result[to + 3u] = float(pdf);
    result[to + 4u] = seen ? 1.0 : 0.0;
}

void texels() {
    taps t = taps_of(given1(from), uint(given[from + 1u]), uint(given[from + 2u]), given[from + 3u] != 0.0);
    put3(to, real3(t.first, t.second, t.weight));
}

void bend_normal() {
    real2 duv1 = real2(given2(from + 9u)), duv2 = real2(given2(from + 11u));
    put3(to, map_normal(given3(from), given3(from + 3u), given3(from + 6u), duv1, duv2, given3(from + 13u), 1.0));
}

// In: STRESS_SHADING_IN numbers, of which each function takes the first few. Out: STRESS_SHADING_OUT.
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.count) return;
    from = STRESS_SHADING_IN * i;
    to = STRESS_SHADING_OUT * i;
    if (HAS_INDIRECT && args.what == SHADING_FRAME) frame();
    if (HAS_INDIRECT && args.what == SHADING_LOBE) sample_lobe();
    if (HAS_INDIRECT && args.what == SHADING_COSINE) put3(to, cosine_direction(given1(from), sincos_turns(given1(from + 1u))));
    if (HAS_REFLECTION && args.what == SHADING_MIRRORS) mirrors();
    if (HAS_GGX && args.what == SHADING_FACETS) facets();
    if (HAS_GGX && args.what == SHADING_SCHLICK) put3(to, schlick(given3(from), given1(from + 3u)));
    if (HAS_REFRACTION && args.what == SHADING_GLASS) glass();
    if (HAS_REFRACTION && args.what == SHADING_INSIDE) inside_sphere();
    if (HAS_ABSORPTION && args.what == SHADING_LEFT)
        put3(to, real3(absorb(given3(from), given1(from + 3u)).xy, fog_transmittance(given1(from), given1(from + 3u))));
    if (HAS_SOFT_SHADOWS && args.what == SHADING_SPHERE_LIGHT) sphere_light();
    if (HAS_TEXTURES && args.what == SHADING_TEXELS) texels();
    if (HAS_TEXTURES && args.what == SHADING_SPHERE_UV) put3(to, real3(sphere_uv(given3(from)), 0.0));
    if (HAS_ENVIRONMENT && args.what == SHADING_SKY_UV) put3(to, real3(sky_uv(sky_header(1u, 1u, 0.0), given3(from)), 0.0));
    if (HAS_NORMAL_MAPS && args.what == SHADING_BEND) bend_normal();
}

#endif
