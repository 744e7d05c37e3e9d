// What was hit: the point, how far it may be off, its normals, its material. Reads the scene's shading arrays.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL
#include "tier_fast.glsl"
#include "tier_robust.glsl"
#include "constants.glsl"
#include "instance.glsl"
#include "texture.glsl"

layout(set = 0, binding = BINDING_OBJECTS) uniform usamplerBuffer object_words;
layout(set = 0, binding = BINDING_INDICES) uniform usamplerBuffer index_words;
layout(set = 0, binding = BINDING_NORMALS) uniform usamplerBuffer normal_words;
layout(set = 0, binding = BINDING_UVS) uniform usamplerBuffer uv_words;

const bool HAS_UVS = HAS_TEXTURES || HAS_NORMAL_MAPS || HAS_ALPHA;

struct surface {
    real3 p;         // device units
    real3 error;     // bound of the error of each component of p
    real3 ng, n;     // unit geometric and shading normal, on the viewer's side
    uint material;
    uint primitive; // as a hit has it
    bool front;     // seen from the side of its own geometric normal
    real2 uv;       // texture coordinates
    real3 du, dv;   // how the point moves with u and v, each up to a common factor; 0 where nobody knows
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

// The three vertices' place in the arrays of attributes; false where the mesh has none.
bool find_attributes(hit h, out uvec4 vertex) {
    uint first = texelFetch(object_words, h.object * OBJECT_WORDS).x;
    vertex = uvec4(0u);
    if (first == NO_ATTRIBUTES) return false;
    vertex = texelFetch(index_words, int(first) + h.index);
    return true;
}

// The interpolated vertex normal, or ng where a vertex has none or the sum vanishes.
real3 smooth_normal(hit h, uvec4 vertex, real3 ng) {
    real3 n0 = real3(uintBitsToFloat(texelFetch(normal_words, int(vertex.x)).xyz));
    real3 n1 = real3(uintBitsToFloat(texelFetch(normal_words, int(vertex.y)).xyz));
    real3 n2 = real3(uintBitsToFloat(texelFetch(normal_words, int(vertex.z)).xyz));
    real3 n = normalize_any(placed_normal((1.0 - h.u - h.v) * n0 + h.u * n1 + h.v * n2, h.object));
    return dot(n, n) > 0.5 ? n : ng;
}

// Texture coordinates, and how they run over the triangle with the edges e1 and e2: the edges are du1·P + dv1·Q and du2·P + dv2·Q, solved for P and Q up to
// the determinant.
void find_uv(hit h, uvec4 vertex, real3 e1, real3 e2, inout surface s) {
    real2 uv0 = real2(uintBitsToFloat(texelFetch(uv_words, int(vertex.x)).xy));
    real2 d1 = real2(uintBitsToFloat(texelFetch(uv_words, int(vertex.y)).xy)) - uv0;
    real2 d2 = real2(uintBitsToFloat(texelFetch(uv_words, int(vertex.z)).xy)) - uv0;
    s.uv = uv0 + (h.u * d1 + h.v * d2);
    real side = d1.x * d2.y - d1.y * d2.x < 0.0 ? -1.0 : 1.0;
    s.du = side * (d2.y * e1 - d1.y * e2);
    s.dv = side * (d1.x * e2 - d2.x * e1);
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
    surface s = surface(p, error, ng, ng, material, h.primitive, true, real2(0.0), real3(0.0), real3(0.0));
    uvec4 vertex;
    if ((HAS_SMOOTH_NORMALS || HAS_UVS) && find_attributes(h, vertex)) {
        if (HAS_SMOOTH_NORMALS) s.n = smooth_normal(h, vertex, ng);
        if (HAS_UVS) find_uv(h, vertex, e1, e2, s);
    }
    return s;
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
    surface s = surface(p, error, n, n, w1.y, h.primitive, true, real2(0.0), real3(0.0), real3(0.0));
    if (HAS_UVS) {
        s.uv = sphere_uv(n);
        s.du = real3(n.z, 0.0, -n.x);
        s.dv = real3(n.x * n.y, n.y * n.y - 1.0, n.y * n.z);
    }
    return s;
}

// Normals turned: ng to the viewer's side, n to ng's.
surface surface_at(ray r, hit h) {
    bool on_sphere = HAS_SPHERES && (!HAS_TRIANGLES || (h.primitive & SELF_SPHERE) != 0u);
    surface s;
    if (on_sphere) s = sphere_surface(r, h);
    else s = triangle_surface(h, r.time);
    s.front = dot(s.ng, r.d) <= 0.0;
    if (!s.front) s.ng = -s.ng;
    if (dot(s.n, s.ng) < 0.0) s.n = -s.n;
    return s;
}

#endif
