// Paths of light, from the camera on: what a path has gathered, which shadow ray comes next, and where it goes on.
//
// At every point all lights are asked, one sample and one shadow ray each; then the path goes on by a mirror, through glass, or, with indirect light, where
// the material sends light. Where both a light sample and a material sample could have found the same light they are weighted by the power heuristic:
// E. Veach and L. Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995.
#ifndef PATH_GLSL
#define PATH_GLSL
#include "absorption.glsl"
#include "dielectric.glsl"
#include "environment.glsl"
#include "fog.glsl"
#include "light.glsl"
#include "material.glsl"
#include "nested.glsl"
#include "sampler.glsl"

layout(set = 0, binding = BINDING_GLOBALS) uniform usamplerBuffer global_words;

uvec4 global_word(int word) { return texelFetch(global_words, word); }
real3 background() { return real3(uintBitsToFloat(global_word(0).xyz)); }
real3 ambient() { return real3(uintBitsToFloat(global_word(1).xyz)); }
uint most_rays() { return global_word(0).w; }
uint roulette_begin() { return global_word(1).w; }

bool scene_has(uint switch_bit) { return (global_word(4).y & switch_bit) != 0u; }
bool has_sky() { return HAS_ENVIRONMENT && scene_has(SWITCH_ENVIRONMENT); }
bool has_shadows() { return HAS_SHADOWS && scene_has(SWITCH_SHADOWS); }
bool has_indirect() { return HAS_INDIRECT && scene_has(SWITCH_INDIRECT); }

const bool HAS_LIGHT = HAS_DIFFUSE || HAS_SPECULAR || HAS_BLINN || HAS_GGX || HAS_FOG;
#define LIGHTS_DONE 0xffffffffu    // of path.light: no light is asked here
const bool GOES_ON = HAS_REFLECTION || HAS_REFRACTION || HAS_INDIRECT;

const real PI = 0.5 / ARC;

// Where a path is: on a surface, or in fog.
struct vertex {
    surface s;
    material m;
    real3 v;        // unit, to where the path came from
    bool in_fog;
};

struct path {
    real3 throughput, radiance;
    real pdf;       // per solid angle, of the sample that the ray was made from; 0: no light sample could have been in its place
    uint depth;     // rays after the camera's
    uint light;     // the next one to look at
    real3 adds;     // what the shadow ray under way adds where nothing is in its way
    float time;     // of the sample
    media inside;   // the dielectrics around the path
};

path path_begin(ray camera) { return path(real3(1.0), real3(0.0), 0.0, 0u, 0u, real3(0.0), camera.time, media_none()); }

// The weight of a sample of density a, where the other way to find it has density b.
real mis_weight(real a, real b) {
    real ratio = b / a;
    return 1.0 / (1.0 + ratio * ratio);
}

// Surfaces that send light back in one direction only: no light is asked there.
bool is_specular(material m) { return m.b.model == DIELECTRIC_MODEL || m.b.model == MIRROR_MODEL; }

// Whether paths of this length still go on from here by a sample of the material.
bool goes_on(path p) { return has_indirect() && p.depth < most_rays(); }

// --------------------------------------------------------------------------------------------------------------- fog
real fog_density() { return real(uintBitsToFloat(global_word(2).w)); }
real fog_anisotropy() { return real(uintBitsToFloat(global_word(4).x)); }

// The part of a ray, direction unit, that lies in the ball of fog: from x to y; empty where x >= y.
real2 fog_span(real3 o, real3 direction, real end) {
    uvec4 w3 = global_word(3);
    real3 l = real3(uintBitsToFloat(w3.xyz)) - o;
    real radius = real(uintBitsToFloat(w3.w)), middle = dot(l, direction);
    real3 across = l - middle * direction;
    real half2 = radius * radius - dot(across, across);
    real half_length = sqrt(max(half2, 0.0));
    return half2 > 0.0 ? real2(max(middle - half_length, 0.0), min(middle + half_length, end)) : real2(0.0);
}

// The share of light that comes through the fog on a way of this length.
real fog_lets_through(real3 o, real3 direction, real end) {
    real2 span = fog_span(o, direction, end);
    return fog_transmittance(fog_density(), max(span.y - span.x, 0.0));
}

// Whether fog scatters a path before its ray ends at t (units of r.d); if so at becomes that point.
bool fog_scatters(ray r, real t, float u, inout vertex at) {
    real3 direction = normalize_any(r.d);
    real2 span = fog_span(r.o, direction, t == INFINITY ? INFINITY : t * length_of(r.d));
    real far = fog_distance(fog_density(), u);
    if (!(far < span.y - span.x)) return false;
    at.s.p = r.o + (span.x + far) * direction;
    at.v = -direction;
    at.in_fog = true;
    return true;
}

// ------------------------------------------------------------------------------------------------------------- light
// What a light sample adds if nothing is in its way.
real3 light_adds(path p, vertex at, light_sample ls) {
    real3 l = normalize_any(ls.way);
    real3 sent;
    real other; // density of the other way to find this light
    if (HAS_FOG && at.in_fog) {
        other = fog_phase(dot(-at.v, l), fog_anisotropy());
        sent = real3(PI * other);
    } else {
        sent = bsdf_eval(at.m.b, at.s.n, at.v, l, other);
        if (ls.pdf > 0.0 && through_surface(at.s.ng, l)) sent = real3(0.0);
    }
    real3 adds = ls.radiance * sent;
    if ((HAS_SOFT_SHADOWS || HAS_ENVIRONMENT) && ls.pdf > 0.0) {
        adds /= PI * ls.pdf;
        if (goes_on(p)) adds *= mis_weight(ls.pdf, other);
    }
    if (HAS_FOG) adds *= fog_lets_through(at.s.p, l, ls.infinite ? INFINITY : length_of(ls.way));
    return p.throughput * adds;
}

bool sample_light(path p, vertex at, draws d, uint light, inout int steps, out light_sample ls) {
    vec2 u = vec2(0.5);
    float choice = 0.5;
    if (HAS_SOFT_SHADOWS || HAS_ENVIRONMENT) {
        u = draw_of_ray(d, p.depth, PAIR_LIGHTS + 2u * light);
        choice = draw_of_ray(d, p.depth, PAIR_LIGHTS + 2u * light + 1u).x;
    }
    if (HAS_ENVIRONMENT && light == args.light_count) {
        ls = light_sample(real3(0.0), real3(0.0), 0.0, -1, -1, true);
        ls.way = sky_sample(u, ls.pdf);
        ls.radiance = sky_radiance(ls.way);
        return ls.pdf > 0.0;
    }
    return light_sample_at(light, at.s.p, args.corner.w, u, choice, steps, ls);
}

// Goes through the lights from p.light on, up to the first that a shadow ray must be shot to; false when there are no more.
bool shadow_ray(inout path p, vertex at, draws d, inout int steps, out ray r) {
    uint end = args.light_count + (has_sky() ? 1u : 0u);
    bool more = false;
    while (HAS_LIGHT && !more && p.light < end && steps > 0) {
        steps--;
        light_sample ls;
        bool any = sample_light(p, at, d, p.light, steps, ls);
        p.light++;
        p.adds = any ? light_adds(p, at, ls) : real3(0.0);
        if (has_shadows()) {
            more = p.adds != real3(0.0);
            real3 start = HAS_FOG && at.in_fog ? at.s.p : leave_surface(at.s);
            uint self = HAS_FOG && at.in_fog ? SELF_NONE : leave_self(at.s);
            r = ray_make(start, ls.infinite ? ls.way : ls.way + (at.s.p - start), 0.0, ls.infinite ? INFINITY : 1.0, self);
            r.target_object = ls.target_object;
            r.target_index = ls.target_index;
            r.time = p.time;
        } else {
            p.radiance += p.adds;
        }
    }
    if (HAS_LIGHT && !more && p.light < end) steps = 0;
    return more;
}

// ----------------------------------------------------------------------------------------------------------- arrivals
// The radiance of what a path's ray meets that shines by itself, weighted where a light sample could have found it, too.
void add_sky(inout path p, ray r) {
    real3 sent = background();
    if (has_sky()) {
        real3 direction = normalize_any(r.d);
        sent = sky_radiance(direction);
        if (HAS_INDIRECT && p.pdf > 0.0) sent *= mis_weight(p.pdf, sky_pdf(direction));
    }
    p.radiance += p.throughput * sent;
}

void add_emission(inout path p, surface s, material m, ray r, hit h, inout int steps) {
    real3 sent = m.emission;
    if (HAS_SOFT_SHADOWS && HAS_INDIRECT && p.pdf > 0.0) {
        uint light = texelFetch(object_words, int(OBJECT_WORDS) * h.object).y;
        if (light != NO_LIGHT) sent *= mis_weight(p.pdf, light_pdf_of(light, r.o, h, steps));
    }
    p.radiance += p.throughput * sent;
}

// ------------------------------------------------------------------------------------------------------------ going on
// The index of refraction of a material + 1, or of vacuum.
real ior_of(uint number) { return number > 0u ? last_of(material_word(number - 1u, 4u)) : real(1.0); }

// What the path's way through the medium around it leaves of light.
real3 absorb_on_the_way(path p, real distance) {
    uint number = p.inside.number.x;
    return number > 0u ? absorb(real3_of(material_word(number - 1u, 5u)), distance) : real3(1.0);
}

// Through a dielectric's surface, or back from it.
void go_through_glass(inout path p, vertex at, float choice, out real3 way, out real3 weight, out bool through) {
    surface s = at.s;
    if (at.m.thin) {
        dielectric_sheet_sample(s.n, s.ng, at.v, at.m.ior, at.m.tint, choice, way, weight, through);
        return;
    }
    media_change change = media_cross(p.inside, at.m.number, at.m.priority, s.front);
    way = -at.v;
    weight = real3(1.0);
    through = true;
    if (change.counts) dielectric_sample(s.n, s.ng, at.v, ior_of(change.here), ior_of(change.beyond), at.m.tint, choice, way, weight, through);
    if (through) p.inside = change.after;
}

// The next ray of the path; false where it ends.
bool next_ray(inout path p, vertex at, draws d, out ray r) {
    if (p.depth >= most_rays()) return false;
    vec2 choice = draw_of_ray(d, p.depth, PAIR_CHOICE);
    real3 way = at.v, weight = real3(1.0);
    bool through = false, more = false;
    p.pdf = 0.0;
    if (HAS_FOG && at.in_fog) {
        more = has_indirect();
        if (more) way = fog_sample(-at.v, fog_anisotropy(), draw_of_ray(d, p.depth, PAIR_DIRECTION), p.pdf);
    } else if (HAS_REFRACTION && at.m.b.model == DIELECTRIC_MODEL) {
        go_through_glass(p, at, choice.x, way, weight, through);
        more = true;
    } else if (!has_indirect()) {
        more = bsdf_sample_mirror(at.m.b, at.s.n, at.s.ng, at.v, way, weight);
    } else {
        more = bsdf_sample(at.m.b, at.s.n, at.s.ng, at.v, draw_of_ray(d, p.depth, PAIR_DIRECTION), choice.x, way, weight, p.pdf);
    }
    if (!more) return false;
    p.throughput *= weight;
    p.depth++;
    if (p.depth >= roulette_begin()) {
        real stay = min(0.95, max(p.throughput.x, max(p.throughput.y, p.throughput.z)));
        if (!(real(choice.y) < stay)) return false;
        p.throughput /= stay;
    }
    if (p.throughput == real3(0.0)) return false;
    surface s = at.s;
    if (through) s.ng = -s.ng;
    bool in_fog = HAS_FOG && at.in_fog;
    r = ray_make(in_fog ? s.p : leave_surface(s), way, 0.0, INFINITY, in_fog ? SELF_NONE : leave_self(s));
    r.time = p.time;
    return true;
}

#endif
