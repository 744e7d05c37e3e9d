// Ray against axis-aligned box, conservative: a box that the exact ray touches is never missed.
//
// Slabs as (plane - origin) * inverse: the difference is off by 1 u (the unit roundoff), Vulkan's division by 5 u (2.5 ulp), the product by 1 u: both ends
// of the interval by less than 7.1 u, so that padding the far end by 16 u, relative, holds with the rounding of the padding itself.
// (Cf. T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, for a division that is correctly rounded.)
// A direction component that is next to nothing gets the inverse 2^120 and an origin moved outward for each plane: a slab that contains the
// origin, faces included, is then passed from -huge to +huge, any other is entered beyond everything; with no infinity there is no NaN.
#ifndef BOX_GLSL
#define BOX_GLSL
#include "ray.glsl"

struct slabs {
    real3 origin_min, origin_max;    // for the box's lower and upper planes
    real3 inverse;
};

slabs slabs_make(real3 o, real3 d) {
    bvec3 flat_axis = lessThan(abs(d), real3(7.52316385e-37)); // 2^-120
    real3 nudge = max(abs(o), real3(1.0)) * (4.0 * REAL_UNIT);
    slabs s;
    s.origin_min = mix(o, o + nudge, flat_axis);
    s.origin_max = mix(o, o - nudge, flat_axis);
    s.inverse = mix(1.0 / d, real3(1.32922800e36), flat_axis);
    return s;
}

// Where the ray enters the box, or +inf if it misses it within [tmin, tmax]; tmax is padded, too.
real box_enter(real3 box_min, real3 box_max, slabs s, real tmin, real tmax) {
    real3 a = (box_min - s.origin_min) * s.inverse;
    real3 b = (box_max - s.origin_max) * s.inverse;
    real3 lower = min(a, b);
    real3 upper = max(a, b);
    real enter = max(max(lower.x, lower.y), max(lower.z, tmin));
    real leave = min(min(upper.x, upper.y), min(upper.z, tmax));
    return enter <= leave + abs(leave) * (16.0 * REAL_UNIT) ? enter : INFINITY;
}

#endif
