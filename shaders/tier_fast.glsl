// Tier "fast": what a good plain renderer does. No absolute epsilons.
#ifndef TIER_FAST_GLSL
#define TIER_FAST_GLSL
#include "ray.glsl"

// T. Möller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997. Two-sided; a determinant of 0 is a miss, any other is divided by.
// Returns (t, u, v); t = +inf for a miss. NaN anywhere is a miss.
vec3 triangle_fast(vec3 o, vec3 d, vec3 v0, vec3 v1, vec3 v2) {
    vec3 e1 = v1 - v0, e2 = v2 - v0;
    vec3 p = cross(d, e2);
    float det = dot(e1, p);
    vec3 s = o - v0;
    vec3 q = cross(s, e1);
    float inverse = 1.0 / det;
    float u = dot(s, p) * inverse;
    float v = dot(d, q) * inverse;
    float t = dot(e2, q) * inverse;
    bool inside = det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    return inside ? vec3(t, u, v) : vec3(INFINITY, 0.0, 0.0);
}

// Geometric form: the closest point of the line, then the half chord. Returns both t, smaller first; (+inf, +inf) for a miss.
vec2 sphere_fast(vec3 o, vec3 d, vec3 center, float radius) {
    vec3 l = center - o;
    float inverse = 1.0 / dot(d, d);
    float middle = dot(l, d) * inverse;
    vec3 across = l - middle * d;
    float rest = radius * radius - dot(across, across);
    float chord = sqrt(max(rest, 0.0) * inverse);
    return rest >= 0.0 ? vec2(middle - chord, middle + chord) : vec2(INFINITY);
}

// The start of a ray that leaves p along the side of n (unit): a fixed share of the scene's size, which is 1 to 2 in device units.
vec3 leave_fast(vec3 p, vec3 n) { return p + n * 1e-4; }

vec3 normalize_fast(vec3 v) { return v * inversesqrt(dot(v, v)); }

#endif
