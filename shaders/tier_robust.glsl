// Tier "robust": watertight at edges and vertices, spheres decided without cancellation, offsets from an error bound.
#ifndef TIER_ROBUST_GLSL
#define TIER_ROBUST_GLSL
#include "ray.glsl"

// The shear that makes the ray the z axis, as three rows: x' = x·v, y' = y·v, z' = z·v for v relative to the origin. Each vertex is mapped alone,
// the same way whatever its triangle. Rows hold 1 and 0 beside the shear, so that products with them are exact and no axis is permuted.
// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
struct shear { real3 x, y, z; };

shear shear_make(real3 d) {
    real3 a = abs(d);
    if (a.z >= a.x && a.z >= a.y) {
        real inverse = 1.0 / d.z;
        return shear(real3(1.0, 0.0, -d.x * inverse), real3(0.0, 1.0, -d.y * inverse), real3(0.0, 0.0, inverse));
    }
    if (a.x >= a.y) {
        real inverse = 1.0 / d.x;
        return shear(real3(-d.y * inverse, 1.0, 0.0), real3(-d.z * inverse, 0.0, 1.0), real3(inverse, 0.0, 0.0));
    }
    real inverse = 1.0 / d.y;
    return shear(real3(0.0, -d.z * inverse, 1.0), real3(1.0, -d.x * inverse, 0.0), real3(0.0, inverse, 0.0));
}

real sheared(real3 row, real3 v) {
    precise real value = (row.x * v.x + row.y * v.y) + row.z * v.z;
    return value;
}

// Twice the signed area of the origin, p, q in the plane: the difference of two rounded products. Rounding is monotone, so its sign is never
// wrong; it can only be 0 where it should not be, and 0 counts as inside: neighbours may both be hit, never neither.
real edge_function(real2 p, real2 q) {
    precise real a = p.x * q.y;
    precise real b = p.y * q.x;
    precise real value = a - b;
    return value;
}

// Returns (t, u, v); t = +inf for a miss. NaN anywhere is a miss.
real3 triangle_robust(real3 o, shear s, real3 v0, real3 v1, real3 v2) {
    precise real3 a = v0 - o, b = v1 - o, c = v2 - o;
    real2 pa = real2(sheared(s.x, a), sheared(s.y, a));
    real2 pb = real2(sheared(s.x, b), sheared(s.y, b));
    real2 pc = real2(sheared(s.x, c), sheared(s.y, c));
    real u = edge_function(pc, pb);
    real v = edge_function(pa, pc);
    real w = edge_function(pb, pa);
    precise real det = (u + v) + w;
    bool one_sign = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    precise real depth = (u * sheared(s.z, a) + v * sheared(s.z, b)) + w * sheared(s.z, c);
    real inverse = 1.0 / det;
    return one_sign && det != 0.0 ? real3(depth * inverse, v * inverse, w * inverse) : real3(INFINITY, 0.0, 0.0);
}

real3 cross_precise(real3 a, real3 b) {
    precise real3 left = real3(a.y * b.z, a.z * b.x, a.x * b.y);
    precise real3 right = real3(a.z * b.y, a.x * b.z, a.y * b.x);
    precise real3 value = left - right;
    return value;
}

real dot_precise(real3 a, real3 b) {
    precise real value = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return value;
}

// F = r²(d·d) - |l×d|² decides: l×d is small near the silhouette, so nothing large cancels (E. Haines et al., "Precision improvements for ray/sphere
// intersection", Ray Tracing Gems, 2019, have the same idea). Roots as q/a and c/q (Numerical Recipes 5.6). Returns both t, smaller first;
// (+inf, +inf) for a miss.
real2 sphere_robust(real3 o, real3 d, real3 center, real radius) {
    precise real3 l = center - o;
    real3 x = cross_precise(l, d);
    real a = dot_precise(d, d);
    precise real f = radius * radius * a - dot_precise(x, x);
    real b = dot_precise(l, d);
    real root = sqrt(max(f, 0.0));
    real q = b + (b < 0.0 ? -root : root);
    // |l|² - r² as a product, so that an origin near the surface keeps its digits.
    real length_l = sqrt(dot_precise(l, l));
    precise real c = (length_l - radius) * (length_l + radius);
    real far = q / a;
    real near = q != 0.0 ? c / q : far;
    return f >= 0.0 ? real2(min(near, far), max(near, far)) : real2(INFINITY);
}

// The start of a ray that leaves p along the side of n (unit), where each component of p is off by at most `error`: p moved along n until its
// error box is on that side, then each component rounded away. After M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., 6.8.
real3 leave_robust(real3 p, real3 error, real3 n) {
    precise real distance = dot(abs(n), error) * 1.0001;
    precise real3 start = p + n * distance;
    // One ulp away from the surface; a component of n that is 0 moves nothing.
    real3 ulp = abs(start) * (2.0 * REAL_UNIT);
    precise real3 away = start + sign(n) * ulp;
    return away;
}

// sqrt and divide; scaled by the largest component, so that nothing over- or underflows. A zero vector stays zero.
real3 normalize_robust(real3 v) {
    real largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(largest > 0.0) || !is_finite(largest)) return real3(0.0);
    real3 scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

#endif
