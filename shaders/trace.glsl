// Shoots a batch of rays: each invocation one. Included by trace.comp; with REFINE defined by trace_refine.comp, which also brings the exact tier's t, u and v
// to within 1 ulp (without it the host does that); with FP64 by trace_fp64.comp; with
// both and LISTED by trace_again.comp, the exact tier's second stage.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "shared.h"
#include "constants.glsl"
#include "ray.glsl"
#ifdef REFINE
#include "refine_fp64.glsl"
#endif
#include "traverse.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { trace_args args; };
layout(set = 0, binding = BINDING_RAYS) uniform usamplerBuffer ray_words;
layout(set = 0, binding = BINDING_HITS) writeonly buffer hit_buffer { uint hit_words[]; };
layout(set = 0, binding = BINDING_LIST) buffer list_buffer { uint undecided_rays[]; };
layout(set = 0, binding = BINDING_STATUS) buffer status_buffer { status dispatch_status; };

// Flags of a ray that this stage decides.
#ifdef LISTED
const uint EARLIER = HIT_UNDECIDED;
#else
const uint EARLIER = 0u;
#endif

void store_hit(uint number, float t, hit h, uint flags) {
    uint at = 6u * number;
    hit_words[at] = floatBitsToUint(t);
    hit_words[at + 1u] = floatBitsToUint(float(h.u));
    hit_words[at + 2u] = floatBitsToUint(float(h.v));
    hit_words[at + 3u] = uint(h.object);
    hit_words[at + 4u] = uint(h.index);
    hit_words[at + 5u] = flags;
}

// Whether difference = a - b was rounded (two-sum: D. Knuth, TAOCP 2, 4.2.2, theorem B), or its product with a power of two.
bool loses_bits(real3 a, real3 b, real3 difference, float scale) {
    precise real3 part = difference - a;
    precise real3 rest = (a - (difference - part)) + (-b - part);
    precise real3 scaled = difference * scale;
    precise real3 unscaled = scaled / scale;
    return rest != real3(0.0) || unscaled != difference;
}

bool is_valid(vec3 o, vec3 d, float tmin, float tmax) {
    return is_finite(o) && is_finite(d) && (d.x != 0.0 || d.y != 0.0 || d.z != 0.0) && !is_nan(tmin) && !is_nan(tmax);
}

// Brings the hit's numbers to within 1 ulp; false if that takes more than fp64.
bool refine(ray r, inout hit h) {
#ifdef REFINE
    dvec3 tuv, o = dvec3(r.o), d = dvec3(r.d);
    bool on_sphere = HAS_SPHERES && (!HAS_TRIANGLES || (h.primitive & SELF_SPHERE) != 0u), fine;
    if (on_sphere) {
        uint at = SPHERE_WORDS * (h.primitive & ~SELF_SPHERE);
        uvec4 w0 = sphere_word(at), w1 = sphere_word(at + 1u);
        real3 center = sphere_center(w0, w1, r.time);
        fine = refine_sphere(o, d, vec3(center), uintBitsToFloat(w0.w), h.t * dot(r.d, r.d) > dot(center - r.o, r.d), tuv);
    } else {
        real3 v0, v1, v2;
        triangle_vertices(h, r.time, v0, v1, v2);
        fine = refine_triangle(o, d, vec3(v0), vec3(v1), vec3(v2), double(h.t), tuv);
    }
    h.t = real(tuv.x);
    h.u = real(tuv.y);
    h.v = real(tuv.z);
    return fine;
#else
    return false;
#endif
}

// The number of this invocation's ray; false if there is none. LISTED: of those that an earlier dispatch left undecided.
bool find_ray(out uint number) {
    uint i = gl_GlobalInvocationID.x;
#ifdef LISTED
    number = i < args.count ? undecided_rays[args.first + i] : 0u;
#else
    number = args.first + i;
#endif
    return i < args.count;
}

// Counts an undecided ray and writes its number down for the next stage.
void list_undecided(uint number) {
    uint place = atomicAdd(dispatch_status.undecided, 1u);
    if (TIER == TIER_EXACT) undecided_rays[args.list_first + place] = number;
}

void main() {
    uint number;
    if (!find_ray(number)) return;
    uvec4 w0 = texelFetch(ray_words, int(2u * number));
    uvec4 w1 = texelFetch(ray_words, int(2u * number + 1u));
    vec3 o = uintBitsToFloat(w0.xyz), d = uintBitsToFloat(w1.xyz);
    float tmin = uintBitsToFloat(w0.w), tmax = uintBitsToFloat(w1.w);
    bool valid = is_valid(o, d, tmin, tmax);
    bool shot = valid && tmin < tmax;

    int steps = int(MAX_STEPS);
    float scale = args.base.w;
    precise real3 from_base = real3(o) - real3(args.base.xyz);
    ray r = ray_make(from_base * scale, real3(valid ? d : vec3(1.0)), 0.0, 0.0, SELF_NONE);
    int t_exponent = r.exponent + exponent_of(scale); // t in units of r.d is t in units of d, times this power of two
    r.tmin = times_power_of_two(real(tmin), t_exponent);
    r.tmax = times_power_of_two(real(tmax), t_exponent);
    search q = traverse(r, ANY_HIT, shot ? args.root : REF_NONE, steps);
    // An origin that lost bits on its way to device coordinates is not the ray that was given.
    bool lossy = loses_bits(real3(o), real3(args.base.xyz), from_base, scale) || is_denormal(o) || is_denormal(d);
    bool undecided = shot && ((TIER == TIER_EXACT && lossy) || search_undecided(q, ANY_HIT));
    hit h = q.best;
    if (TIER == TIER_EXACT && !ANY_HIT && !undecided && h.object >= 0) undecided = !refine(r, h);
    float t = float(h.object < 0 ? INFINITY : times_power_of_two(h.t, -t_exponent));
    if (TIER == TIER_EXACT && !ANY_HIT && abs(t) < 1.2e-38) undecided = true; // denormal: rounded twice, or taken for zero
    if (undecided) {
        h = hit_none();
        t = float(INFINITY);
    }
    if (ANY_HIT && h.object >= 0) h.object = 0;
    store_hit(number, t, h, (valid ? 0u : HIT_INVALID) | (undecided ? HIT_UNDECIDED : EARLIER));
    if (undecided) list_undecided(number);
    if (h.object >= 0) atomicAdd(dispatch_status.hits, 1u);
    if (steps <= 0) atomicAdd(dispatch_status.stuck, 1u);
}

#endif
