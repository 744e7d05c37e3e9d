// Ray against axis-aligned box, conservative: a box that the exact ray touches is never missed.
//
// Slabs as (plane - origin) * inverse. The interval's far end is padded by 2^-20 relative: Vulkan's division may be off by 2.5 ulp, and
// the difference and the product add 1 ulp (cf. T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, for correctly rounded division).
// A direction component of zero has the inverse 2^120: a slab that contains the origin then gives (-huge, +huge), or 0 at its face, one that does
// not gives an interval beyond everything; with no infinity there is no NaN.
#ifndef BOX_GLSL
#define BOX_GLSL
#include "ray.glsl"

float safe_inverse(float d) {
    const float smallest = 7.52316385e-37; // 2^-120
    return abs(d) < smallest ? (floatBitsToInt(d) < 0 ? -1.32922800e36 : 1.32922800e36) : 1.0 / d;
}

vec3 safe_inverse(vec3 d) { return vec3(safe_inverse(d.x), safe_inverse(d.y), safe_inverse(d.z)); }

// Where the ray enters the box, or +inf if it misses it within [tmin, tmax]; tmax is padded, too.
float box_enter(vec3 box_min, vec3 box_max, vec3 o, vec3 inverse, float tmin, float tmax) {
    vec3 a = (box_min - o) * inverse;
    vec3 b = (box_max - o) * inverse;
    vec3 lower = min(a, b);
    vec3 upper = max(a, b);
    float enter = max(max(lower.x, lower.y), max(lower.z, tmin));
    float leave = min(min(upper.x, upper.y), min(upper.z, tmax));
    return enter <= leave + abs(leave) * 9.5367431640625e-7 ? enter : INFINITY;
}

#endif
