// Tier "fast": what a good plain renderer does. No absolute epsilons.
#ifndef TIER_FAST_GLSL
#define TIER_FAST_GLSL
#include "ray.glsl"

// T. Möller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997. Two-sided; a determinant of 0 is a miss, any other is divided by.
// Returns (t, u, v); t = +inf for a miss. NaN anywhere is a miss.
real3 triangle_fast(real3 o, real3 d, real3 v0, real3 v1, real3 v2) {
    real3 e1 = v1 - v0, e2 = v2 - v0;
    real3 p = cross(d, e2);
    real det = dot(e1, p);
    real3 s = o - v0;
    real3 q = cross(s, e1);
    real inverse = 1.0 / det;
    real u = dot(s, p) * inverse;
    real v = dot(d, q) * inverse;
    real t = dot(e2, q) * inverse;
    bool inside = det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    return inside ? real3(t, u, v) : real3(INFINITY, 0.0, 0.0);
}

// Geometric form: the closest point of the line, then the half chord. Returns both t, smaller first; (+inf, +inf) for a miss.
real2 sphere_fast(real3 o, real3 d, real3 center, real radius) {
    real3 l = center - o;
    real inverse = 1.0 / dot(d, d);
    real middle = dot(l, d) * inverse;
    real3 across = l - middle * d;
    real rest = radius * radius - dot(across, across);
    real chord = sqrt(max(rest, 0.0) * inverse);
    return rest >= 0.0 ? real2(middle - chord, middle + chord) : real2(INFINITY);
}

// The start of a ray that leaves p along the side of n (unit): a fixed share of the scene's size, which is 1 to 2 in device units.
real3 leave_fast(real3 p, real3 n) { return p + n * 4e-6; }

real3 normalize_fast(real3 v) { return v * inversesqrt(dot(v, v)); }

#endif
