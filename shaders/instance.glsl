// Instances, and shapes that move: where their vertices are, and how a ray goes through a hierarchy that is in its part's own coordinates.
//
// Decisions are about vertices in device coordinates, as for any triangle: they are put where they are by the fp32 operations of scene_place (scene/instances.h), in
// every tier, fp64 too. Only boxes are tested in the part's coordinates, where the part's vertices v are at V = (v - c)k in [-1, 1], k a power of two. A vertex is,
// in device units, at X = A V + C + s·τ·motion + s·e, e being what its rounding does; so with B the inverse of A, a ray o + t·d passes V = o' + t·d' + B s e with
// o' = B (o - C - s·τ·motion), d' = B d.
//
// Boxes are padded by what all that may be off. u = 2^-24, the rounding of B, C and fp32; kernels in fp64 are better than that.
// - Slack, from the host: |B| times the bound of s·e and of the error of C, and the rounding of boxes.
// - o': entries of B are right to 1.1 u, o - C - s·τ·motion to 2 u of the sum of the absolute values, a dot product to 3 u: 7 u of |B| times that sum; 12 u with
//   the rounding of padded origins.
// - d': the same way 5 u of |B||d|, 8 u taken. It counts times the largest t at which the ray is within the part. d' is scaled so that its largest component
//   is in [1, 2); B's condition is at most 2^16, so that the component is off by less than 1/2, and |t| <= 2 (1 + |o'| + the above).
#ifndef INSTANCE_GLSL
#define INSTANCE_GLSL
#include "box.glsl"
#include "constants.glsl"
#include "words.glsl"

const real PLACED_UNIT = 5.9604644775390625e-8; // 2^-24, in fp64, too
const real T_SLACK = 7.7e-34;                   // 2^-110: what scaled bounds of t may lose to underflow

// One level of a traversal: the scene itself, or an instance.
struct level {
    slabs box;
    real t_scale, t_min;    // t of `box` is t of the ray times t_scale
    bool is_placed;
    vec3 column0, column1, column2, column3, moved, base;
    float scale;
    int object;
    uint offset;            // of the numbers of its triangles, as rays and hits have them, from those in leaf order
};

vec3 instance_vector(uint word) { return uintBitsToFloat(instance_word(word).xyz); }

level level_scene(ray r) {
    return level(slabs_make(r.o, r.d), 1.0, r.tmin, false, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 1.0, 0, 0u);
}

// How far an instance has moved, in scene units.
vec3 instance_moved(uint at, float time) {
    precise vec3 moved = time * instance_vector(at + INSTANCE_MOTION);
    return HAS_MOTION_BLUR ? moved : vec3(0.0);
}

// What puts the vertices of the instance whose record is at word `at` where they are.
void level_place(inout level l, uint at, float time) {
    uvec4 w0 = instance_word(at), w1 = instance_word(at + 1u), w5 = instance_word(at + INSTANCE_BASE);
    l.is_placed = true;
    l.column0 = uintBitsToFloat(w0.xyz);
    l.column1 = uintBitsToFloat(w1.xyz);
    l.column2 = instance_vector(at + 2u);
    l.column3 = instance_vector(at + 3u);
    l.moved = instance_moved(at, time);
    l.base = uintBitsToFloat(w5.xyz);
    l.scale = uintBitsToFloat(w5.w);
    l.object = int(w0.w);
    l.offset = w1.w;
}

// The level of an instance, and the root of its part.
level level_instance(ray r, uint at, out uint root) {
    level l;
    level_place(l, at, r.time);
    root = instance_word(at + 3u).w;
    vec4 b0 = uintBitsToFloat(instance_word(at + INSTANCE_INVERSE)), b1 = uintBitsToFloat(instance_word(at + INSTANCE_INVERSE + 1u));
    vec4 b2 = uintBitsToFloat(instance_word(at + INSTANCE_INVERSE + 2u));
    real3 row0 = real3(b0.xyz), row1 = real3(b1.xyz), row2 = real3(b2.xyz);
    real3 from_center = r.o - real3(instance_vector(at + INSTANCE_CENTER)), moved = real3(l.moved * l.scale);
    real3 y = from_center - moved, size = abs(from_center) + abs(moved), d_size = abs(r.d);
    real3 o = real3(dot(row0, y), dot(row1, y), dot(row2, y));
    real3 d = real3(dot(row0, r.d), dot(row1, r.d), dot(row2, r.d));
    real3 o_size = real3(dot(abs(row0), size), dot(abs(row1), size), dot(abs(row2), size));
    real3 spread = real3(dot(abs(row0), d_size), dot(abs(row1), d_size), dot(abs(row2), d_size));
    int exponent = clamp(exponent_of(float(max(abs(d.x), max(abs(d.y), abs(d.z))))), -100, 100);
    real down = power_of_two_real(-exponent);
    real3 error = real3(b0.w, b1.w, b2.w) + o_size * (12.0 * PLACED_UNIT);
    real3 reach = abs(o) + error;
    real travel = 2.0 + 2.0 * max(reach.x, max(reach.y, reach.z));
    real3 pad = error + spread * (down * travel * (8.0 * PLACED_UNIT));
    l.box = slabs_make(o, d * down);
    l.box.origin_min += pad;
    l.box.origin_max -= pad;
    l.t_scale = power_of_two_real(exponent);
    l.t_min = r.tmin * l.t_scale - T_SLACK;
    return l;
}

// A vertex of a level in device coordinates.
real3 level_vertex(level l, vec3 v) {
    precise vec3 placed = ((l.column0 * v.x + l.column1 * v.y) + l.column2 * v.z) + l.column3;
    precise vec3 there = HAS_MOTION_BLUR ? placed + l.moved : placed;
    precise vec3 device = (there - l.base) * l.scale;
    return real3(HAS_INSTANCES && l.is_placed ? device : v);
}

// The word of an object's record, 0 if it has none.
uint instance_of(int object) { return HAS_INSTANCES || HAS_MOTION_BLUR ? instance_word(uint(object) >> 2)[object & 3] : 0u; }

// The vertices of a triangle that was hit, in device coordinates; returns its material.
uint triangle_vertices(hit h, float time, out real3 v0, out real3 v1, out real3 v2) {
    uint at = instance_of(h.object);
    level l;
    l.is_placed = false;
    l.offset = 0u;
    if (HAS_INSTANCES && at != 0u) level_place(l, at, time);
    uint word = TRIANGLE_WORDS * (h.primitive - l.offset);
    uvec4 w2 = triangle_word(word + 2u);
    v0 = level_vertex(l, uintBitsToFloat(triangle_word(word).xyz));
    v1 = level_vertex(l, uintBitsToFloat(triangle_word(word + 1u).xyz));
    v2 = level_vertex(l, uintBitsToFloat(w2.xyz));
    uint own = HAS_INSTANCES && at != 0u ? instance_word(at + 2u).w : NO_MATERIAL;
    return own == NO_MATERIAL ? w2.w : own;
}

// The center of a sphere, given its two words.
real3 sphere_center(uvec4 w0, uvec4 w1, float time) {
    real3 center = real3(uintBitsToFloat(w0.xyz));
    if (!HAS_MOTION_BLUR) return center;
    uint at = w1.z;
    uvec4 base = instance_word(at + INSTANCE_BASE);
    precise vec3 there = instance_vector(at + 3u) + instance_moved(at, time);
    precise vec3 device = (there - uintBitsToFloat(base.xyz)) * uintBitsToFloat(base.w);
    return at != 0u ? real3(device) : center;
}

// A vertex normal of an object, up to a positive factor: by the inverse transpose, whose columns are cross products of the placement's over the determinant.
real3 placed_normal(real3 n, int object) {
    uint at = instance_of(object);
    if (!HAS_INSTANCES || at == 0u) return n;
    real3 a = real3(instance_vector(at)), b = real3(instance_vector(at + 1u)), c = real3(instance_vector(at + 2u));
    real3 sizes = max(abs(a), max(abs(b), abs(c)));
    real scale = 1.0 / max(sizes.x, max(sizes.y, sizes.z));
    a *= scale;
    b *= scale;
    c *= scale;
    real3 bc = cross(b, c);
    real3 sum = bc * n.x + cross(c, a) * n.y + cross(a, b) * n.z;
    return dot(a, bc) < 0.0 ? -sum : sum;
}

#endif
