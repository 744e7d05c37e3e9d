// Tier "robust": watertight at edges and vertices, spheres decided without cancellation, offsets from an error bound.
#ifndef TIER_ROBUST_GLSL
#define TIER_ROBUST_GLSL
#include "ray.glsl"

// The shear that makes the ray the z axis, as three rows: x' = x·v, y' = y·v, z' = z·v for v relative to the origin. Each vertex is mapped alone,
// the same way whatever its triangle. Rows hold 1 and 0 beside the shear, so that products with them are exact and no axis is permuted.
// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
struct shear { vec3 x, y, z; };

shear shear_make(vec3 d) {
    vec3 a = abs(d);
    if (a.z >= a.x && a.z >= a.y) {
        float inverse = 1.0 / d.z;
        return shear(vec3(1.0, 0.0, -d.x * inverse), vec3(0.0, 1.0, -d.y * inverse), vec3(0.0, 0.0, inverse));
    }
    if (a.x >= a.y) {
        float inverse = 1.0 / d.x;
        return shear(vec3(-d.y * inverse, 1.0, 0.0), vec3(-d.z * inverse, 0.0, 1.0), vec3(inverse, 0.0, 0.0));
    }
    float inverse = 1.0 / d.y;
    return shear(vec3(0.0, -d.z * inverse, 1.0), vec3(1.0, -d.x * inverse, 0.0), vec3(0.0, inverse, 0.0));
}

float sheared(vec3 row, vec3 v) {
    precise float value = (row.x * v.x + row.y * v.y) + row.z * v.z;
    return value;
}

// Twice the signed area of the origin, p, q in the plane: the difference of two rounded products. Rounding is monotone, so its sign is never
// wrong; it can only be 0 where it should not be, and 0 counts as inside: neighbours may both be hit, never neither.
float edge_function(vec2 p, vec2 q) {
    precise float a = p.x * q.y;
    precise float b = p.y * q.x;
    precise float value = a - b;
    return value;
}

// Returns (t, u, v); t = +inf for a miss. NaN anywhere is a miss.
vec3 triangle_robust(vec3 o, shear s, vec3 v0, vec3 v1, vec3 v2) {
    precise vec3 a = v0 - o, b = v1 - o, c = v2 - o;
    vec2 pa = vec2(sheared(s.x, a), sheared(s.y, a));
    vec2 pb = vec2(sheared(s.x, b), sheared(s.y, b));
    vec2 pc = vec2(sheared(s.x, c), sheared(s.y, c));
    float u = edge_function(pc, pb);
    float v = edge_function(pa, pc);
    float w = edge_function(pb, pa);
    precise float det = (u + v) + w;
    bool one_sign = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    precise float depth = (u * sheared(s.z, a) + v * sheared(s.z, b)) + w * sheared(s.z, c);
    float inverse = 1.0 / det;
    return one_sign && det != 0.0 ? vec3(depth * inverse, v * inverse, w * inverse) : vec3(INFINITY, 0.0, 0.0);
}

vec3 cross_precise(vec3 a, vec3 b) {
    precise vec3 left = vec3(a.y * b.z, a.z * b.x, a.x * b.y);
    precise vec3 right = vec3(a.z * b.y, a.x * b.z, a.y * b.x);
    precise vec3 value = left - right;
    return value;
}

float dot_precise(vec3 a, vec3 b) {
    precise float value = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return value;
}

// F = r²(d·d) - |l×d|² decides: l×d is small near the silhouette, so nothing large cancels (E. Haines et al., "Precision improvements for ray/sphere
// intersection", Ray Tracing Gems, 2019, have the same idea). Roots as q/a and c/q (Numerical Recipes 5.6). Returns both t, smaller first;
// (+inf, +inf) for a miss.
vec2 sphere_robust(vec3 o, vec3 d, vec3 center, float radius) {
    precise vec3 l = center - o;
    vec3 x = cross_precise(l, d);
    float a = dot_precise(d, d);
    precise float f = radius * radius * a - dot_precise(x, x);
    float b = dot_precise(l, d);
    float root = sqrt(max(f, 0.0));
    float q = b + (b < 0.0 ? -root : root);
    // |l|² - r² as a product, so that an origin near the surface keeps its digits.
    float length_l = sqrt(dot_precise(l, l));
    precise float c = (length_l - radius) * (length_l + radius);
    float far = q / a;
    float near = q != 0.0 ? c / q : far;
    return f >= 0.0 ? vec2(min(near, far), max(near, far)) : vec2(INFINITY);
}

// The start of a ray that leaves p along the side of n (unit), where each component of p is off by at most `error`: p moved along n until its
// error box is on that side, then each component rounded away. After M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., 6.8.
vec3 leave_robust(vec3 p, vec3 error, vec3 n) {
    precise float distance = dot(abs(n), error) * 1.0001;
    precise vec3 start = p + n * distance;
    // One ulp away from the surface; a component of n that is 0 moves nothing.
    vec3 ulp = abs(start) * 1.1920929e-7;
    precise vec3 away = start + sign(n) * ulp;
    return away;
}

// sqrt and divide; scaled by the largest component, so that nothing over- or underflows. A zero vector stays zero.
vec3 normalize_robust(vec3 v) {
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(largest > 0.0) || !is_finite(largest)) return vec3(0.0);
    vec3 scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

#endif
