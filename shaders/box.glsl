// Ray against axis-aligned box, conservative: a box that the exact ray touches is never missed.
//
// Slabs as (plane - origin) * inverse: the difference is off by 1 u (2^-24), Vulkan's division by 5 u (2.5 ulp), the product by 1 u: both ends
// of the interval by less than 7.1 u, so that padding the far end by 16 u, relative, holds with the rounding of the padding itself.
// (Cf. T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, for a division that is correctly rounded.)
// A direction component that is next to nothing gets the inverse 2^120 and an origin moved outward for each plane: a slab that contains the
// origin, faces included, is then passed from -huge to +huge, any other is entered beyond everything; with no infinity there is no NaN.
#ifndef BOX_GLSL
#define BOX_GLSL
#include "ray.glsl"

struct slabs {
    vec3 origin_min, origin_max;    // for the box's lower and upper planes
    vec3 inverse;
};

slabs slabs_make(vec3 o, vec3 d) {
    bvec3 flat_axis = lessThan(abs(d), vec3(7.52316385e-37)); // 2^-120
    vec3 nudge = max(abs(o), vec3(1.0)) * 2.3841858e-7;
    slabs s;
    s.origin_min = mix(o, o + nudge, flat_axis);
    s.origin_max = mix(o, o - nudge, flat_axis);
    s.inverse = mix(1.0 / d, vec3(1.32922800e36), flat_axis);
    return s;
}

// Where the ray enters the box, or +inf if it misses it within [tmin, tmax]; tmax is padded, too.
float box_enter(vec3 box_min, vec3 box_max, slabs s, float tmin, float tmax) {
    vec3 a = (box_min - s.origin_min) * s.inverse;
    vec3 b = (box_max - s.origin_max) * s.inverse;
    vec3 lower = min(a, b);
    vec3 upper = max(a, b);
    float enter = max(max(lower.x, lower.y), max(lower.z, tmin));
    float leave = min(min(upper.x, upper.y), min(upper.z, tmax));
    return enter <= leave + abs(leave) * 9.5367431640625e-7 ? enter : INFINITY;
}

#endif
