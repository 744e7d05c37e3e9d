// What was hit: the point, how far it may be off, its normals, its material. Reads the scene's shading arrays.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL
#include "phong.glsl"
#include "tier_fast.glsl"
#include "tier_robust.glsl"
#include "constants.glsl"
#include "instance.glsl"

layout(set = 0, binding = BINDING_OBJECTS) uniform usamplerBuffer object_words;
layout(set = 0, binding = BINDING_MATERIALS) uniform usamplerBuffer material_words;
layout(set = 0, binding = BINDING_INDICES) uniform usamplerBuffer index_words;
layout(set = 0, binding = BINDING_NORMALS) uniform usamplerBuffer normal_words;

struct surface {
    real3 p;         // device units
    real3 error;     // bound of the error of each component of p
    real3 ng, n;     // unit geometric and shading normal, on the viewer's side
    uint material;
    uint primitive; // as a hit has it
};

// How vectors become unit ones, as the knob says, else the tier; and those that may vanish, which every tier normalizes accurately.
real3 normalize_tier(real3 v) {
    bool inverse = CHOSEN_NORMALIZE == 0u ? TIER == TIER_FAST : CHOSEN_NORMALIZE == NORMALIZE_INVERSE_ROOT;
    return inverse ? normalize_fast(v) : normalize_robust(v);
}
real3 normalize_any(real3 v) { return CHOSEN_NORMALIZE == NORMALIZE_INVERSE_ROOT ? normalize_fast(v) : normalize_robust(v); }

// Where a ray that leaves s starts, and the primitive that it does not hit again, by the offset rule that the knob says, else the tier's.
const uint OFFSET = CHOSEN_OFFSET != 0u ? CHOSEN_OFFSET : TIER == TIER_FAST ? OFFSET_SHARE : OFFSET_BOUND_SELF;
real3 leave_surface(surface s) { return OFFSET == OFFSET_SHARE ? leave_fast(s.p, s.ng) : leave_robust(s.p, s.error, s.ng); }
uint leave_self(surface s) { return OFFSET == OFFSET_BOUND_SELF ? s.primitive : SELF_NONE; }

// The interpolated vertex normal, or ng where the mesh has none or the sum vanishes.
real3 smooth_normal(hit h, real3 ng) {
    uint first = texelFetch(object_words, h.object * OBJECT_WORDS).x;
    if (first == NO_ATTRIBUTES) return ng;
    uvec4 vertex = texelFetch(index_words, int(first) + h.index);
    real3 n0 = real3(uintBitsToFloat(texelFetch(normal_words, int(vertex.x)).xyz));
    real3 n1 = real3(uintBitsToFloat(texelFetch(normal_words, int(vertex.y)).xyz));
    real3 n2 = real3(uintBitsToFloat(texelFetch(normal_words, int(vertex.z)).xyz));
    real3 n = normalize_any(placed_normal((1.0 - h.u - h.v) * n0 + h.u * n1 + h.v * n2, h.object));
    return dot(n, n) > 0.5 ? n : ng;
}

// The point from the barycentrics, the base added last: four roundings of the offset, two of the sum.
surface triangle_surface(hit h, float time) {
    real3 v0, v1, v2;
    uint material = triangle_vertices(h, time, v0, v1, v2);
    precise real3 e1 = v1 - v0;
    precise real3 e2 = v2 - v0;
    precise real3 p = v0 + (h.u * e1 + h.v * e2);
    real3 error = (abs(h.u * e1) + abs(h.v * e2)) * (4.0 * REAL_UNIT) + abs(p) * (2.0 * REAL_UNIT);
    real3 ng = normalize_tier(cross_precise(e1, e2));
    real3 n = HAS_SMOOTH_NORMALS ? smooth_normal(h, ng) : ng;
    return surface(p, error, ng, n, material, h.primitive);
}

// The point is put back on the sphere along its radius, so that the distance travelled does not count in its error.
surface sphere_surface(ray r, hit h) {
    uint number = h.primitive & ~SELF_SPHERE;
    uvec4 w0 = sphere_word(SPHERE_WORDS * number);
    uvec4 w1 = sphere_word(SPHERE_WORDS * number + 1u);
    real3 center = sphere_center(w0, w1, r.time);
    real radius = real(uintBitsToFloat(w0.w));
    real3 n = normalize_tier((r.o - center) + h.t * r.d);
    precise real3 p = center + radius * n;
    real3 error = real3(radius * (8.0 * REAL_UNIT)) + abs(p) * (2.0 * REAL_UNIT);
    return surface(p, error, n, n, w1.y, h.primitive);
}

// Normals turned: ng to the viewer's side, n to ng's.
surface surface_at(ray r, hit h) {
    bool on_sphere = HAS_SPHERES && (!HAS_TRIANGLES || (h.primitive & SELF_SPHERE) != 0u);
    surface s;
    if (on_sphere) s = sphere_surface(r, h);
    else s = triangle_surface(h, r.time);
    if (dot(s.ng, r.d) > 0.0) s.ng = -s.ng;
    if (dot(s.n, s.ng) < 0.0) s.n = -s.n;
    return s;
}

phong_material material_at(uint number) {
    uvec4 w0 = texelFetch(material_words, int(MATERIAL_WORDS * number));
    uvec4 w1 = texelFetch(material_words, int(MATERIAL_WORDS * number + 1u));
    uvec4 w2 = texelFetch(material_words, int(MATERIAL_WORDS * number + 2u));
    return phong_material(real3(uintBitsToFloat(w0.xyz)), real3(uintBitsToFloat(w1.xyz)), real3(uintBitsToFloat(w2.xyz)), real(uintBitsToFloat(w0.w)));
}

#endif
