// A triangle as a light, sampled evenly over the solid angle that it covers: J. Arvo, "Stratified sampling of spherical triangles", SIGGRAPH 1995.
//
// Arvo's formulas take the area from the sum of the angles, which in fp32 leaves nothing of a triangle that is seen small. Here the corners are unit vectors a, b, c that are
// known by a and by the small differences b - a, c - a, computed without cancellation; everything else is made of these, so that all holds from a
// triangle next to p to one that is seen as 1e-15, and no second way of sampling is needed. The solid angle Ω: A. van Oosterom and J. Strackee, "The solid
// angle of a plane triangle", IEEE Trans. Biomed. Eng. 30, 1983: tan(Ω/2) = V/D, V = a·(b×c), D = 1 + a·b + b·c + c·a.
#ifndef LIGHT_TRIANGLE_GLSL
#define LIGHT_TRIANGLE_GLSL
#include "math.glsl"

// A triangle seen from a point.
struct triangle_view {
    real3 corner, e1, e2;       // from the point to v0; the edges from there to v1 and v2
    real3 a, to_b, to_c;        // unit vector to v0; what is added to it for those to v1 and v2
    real3 inverse;              // 1/distance of v0, v1, v2
    real volume;                // V; its sign says on which side the point is
    real turns;                 // Ω/4π; 0 where the triangle is seen from the side, or has no area
};

// q/|q| - p/|p| for q = p + e, p = |p|·a: |q| - |p| is e·(p + q)/(|p| + |q|).
real3 unit_difference(real3 a, real3 p, real3 q, real3 e, real length_p, real length_q) {
    return (e - a * (dot(e, p + q) / (length_p + length_q))) / length_q;
}

// Seen as nothing: what is too small for squares of fp32, and whatever has a corner at the point.
triangle_view triangle_view_of(real3 corner, real3 e1, real3 e2) {
    real3 second = corner + e1, third = corner + e2;
    real3 lengths = real3(sqrt(dot(corner, corner)), sqrt(dot(second, second)), sqrt(dot(third, third)));
    triangle_view t;
    t.corner = corner;
    t.e1 = e1;
    t.e2 = e2;
    t.inverse = 1.0 / lengths;
    t.a = corner * t.inverse.x;
    t.to_b = unit_difference(t.a, corner, second, e1, lengths.x, lengths.y);
    t.to_c = unit_difference(t.a, corner, third, e2, lengths.x, lengths.z);
    t.volume = dot(t.a, cross(t.to_b, t.to_c));
    real3 b_to_c = t.to_c - t.to_b;
    real d = 4.0 - 0.5 * (dot(t.to_b, t.to_b) + dot(t.to_c, t.to_c) + dot(b_to_c, b_to_c));
    real size = abs(t.volume);
    t.turns = size > REAL_TINY || d < 0.0 ? atan2_turns(size, d) : real(0.0); // d < 0: a point over the triangle and so near that V is lost
    return t;
}

// The way to a point of the triangle, for t.turns > 0; NaN from a point of its edge. First the arc from b to a point c' of the side from a to c that cuts off the share u.x of the area, Ω': the formula
// above for a, b, c' = a·cos s + t·sin s, solved for tan s/2 = y/x. Then 1 - cos of the way along that arc is the share u.y of the whole.
real3 triangle_view_sample(triangle_view t, real2 u) {
    real b2 = dot(t.to_b, t.to_b), c2 = dot(t.to_c, t.to_c);
    real3 b = t.a + t.to_b;
    real3 across = t.to_c + 0.5 * c2 * t.a;
    real sine_c = sqrt(dot(across, across));
    across /= sine_c;
    real2 half_area = sincos_turns(u.x * t.turns); // sin, cos of Ω'/2
    real x = half_area.y * abs(t.volume) / sine_c - half_area.x * dot(t.to_b, across);
    real y = half_area.x * (2.0 - 0.5 * b2);
    real3 chord = 2.0 * y / (x * x + y * y) * (x * across - y * t.a) - t.to_b; // from b to c'
    real chord2 = dot(chord, chord);
    real h = 0.5 * chord2 * u.y;
    real3 along = chord + 0.5 * chord2 * b;
    real3 to_p = t.to_b - h * b + sqrt(h * (2.0 - h) / dot(along, along)) * along;
    // The weights of a, b, c in a + to_p, then those of the corners; the first from the product with a.
    real wb = dot(t.a, cross(to_p, t.to_c)), wc = dot(t.a, cross(t.to_b, to_p));
    real wa = t.volume * (1.0 - 0.5 * dot(to_p, to_p)) - wb * (1.0 - 0.5 * b2) - wc * (1.0 - 0.5 * c2);
    real3 w = max(t.volume < 0.0 ? -real3(wa, wb, wc) : real3(wa, wb, wc), real3(0.0)) * t.inverse;
    w /= max(w.x + w.y + w.z, REAL_TINY);
    return t.corner + (w.y * t.e1 + w.z * t.e2);
}

// The way from p to a point of the triangle; pdf per solid angle. False: it is not seen.
bool triangle_light_sample(real3 p, real3 v0, real3 v1, real3 v2, vec2 u, out real3 way, out real pdf) {
    triangle_view t = triangle_view_of(v0 - p, v1 - v0, v2 - v0);
    way = triangle_view_sample(t, real2(u));
    pdf = t.turns > 0.0 ? 0.5 * ARC / t.turns : 0.0;
    return pdf > 0.0 && dot(way, way) > 0.0;
}

// The density with which a direction is sampled that meets the triangle.
real triangle_light_pdf(real3 p, real3 v0, real3 v1, real3 v2) {
    triangle_view t = triangle_view_of(v0 - p, v1 - v0, v2 - v0);
    return t.turns > 0.0 ? 0.5 * ARC / t.turns : 0.0;
}

#endif
