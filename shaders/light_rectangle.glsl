// A rectangle as a light, sampled evenly over the solid angle that it covers: as two triangles, one of which is chosen by its share. The map is continuous across their
// common side. (C. Ureña et al., "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013, do without triangles, but by the sum of the
// angles, which fp32 does not bear; cf. light_triangle.glsl. And these may be parallelograms.)
#ifndef LIGHT_RECTANGLE_GLSL
#define LIGHT_RECTANGLE_GLSL
#include "light_triangle.glsl"

// A rectangle seen from a point, or a triangle, whose other half is not there.
struct rectangle_view {
    triangle_view near_half, far_half;
    real turns;     // the solid angle / 4π
};

// `corner`: from the point to the corner between the edges e1 and e2.
rectangle_view rectangle_view_of(real3 corner, real3 e1, real3 e2, bool whole) {
    rectangle_view r;
    r.near_half = triangle_view_of(corner, e1, e2);
    r.far_half = triangle_view_of(corner + e2, e1 - e2, e1);
    if (!whole) r.far_half.turns = 0.0;
    r.turns = r.near_half.turns + r.far_half.turns;
    return r;
}

real rectangle_view_pdf(rectangle_view r) { return r.turns > 0.0 ? 0.5 * ARC / r.turns : 0.0; }

real3 rectangle_view_sample(rectangle_view r, vec2 u) {
    real at = real(u.x) * r.turns, before = r.near_half.turns;
    triangle_view t = r.near_half;
    bool is_far = at >= before;
    if (is_far) t = r.far_half;
    real share = (is_far ? at - before : at) / t.turns;
    return triangle_view_sample(t, real2(min(share, 1.0), real(u.y)));
}

// The way from p to a point of the rectangle with the corners v0, v1, v2, v1 + v2 - v0; pdf per solid angle. False: it is not seen.
bool rectangle_light_sample(real3 p, real3 v0, real3 v1, real3 v2, vec2 u, out real3 way, out real pdf) {
    rectangle_view r = rectangle_view_of(v0 - p, v1 - v0, v2 - v0, true);
    way = rectangle_view_sample(r, u);
    pdf = rectangle_view_pdf(r);
    return pdf > 0.0 && dot(way, way) > 0.0;
}

real rectangle_light_pdf(real3 p, real3 v0, real3 v1, real3 v2) { return rectangle_view_pdf(rectangle_view_of(v0 - p, v1 - v0, v2 - v0, true)); }

#endif
