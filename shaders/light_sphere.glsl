// A sphere as a light. From outside it is sampled evenly over the cone of directions that see it; from inside all directions do, and it is sampled evenly over
// those. Either way each direction is as likely as any other, so that the density per solid angle is one number.
//
// With x = r/d, 1 - cos of the cone's half angle is x²/(1 + √(1 - x²)): nothing cancels where the sphere is small or far. C. Wang, "Physically correct direct lighting
// for distribution ray tracing", Graphics Gems III, 1992, has the sampling.
#ifndef LIGHT_SPHERE_GLSL
#define LIGHT_SPHERE_GLSL
#include "hemisphere.glsl"
#include "tier_robust.glsl"

// A sphere seen from a point.
struct sphere_view {
    real3 axis;     // unit, to the center
    real distance;  // to the center
    real rest;      // |d² - r²|
    real q;         // √(1 - x²), the cosine of the cone's half angle
    real versine;   // 1 - q; 2 from inside
    bool outside;
};

sphere_view sphere_view_of(real3 p, real3 center, real radius) {
    sphere_view s;
    s.axis = normalize_robust(center - p);
    s.distance = dot(center - p, s.axis);
    s.outside = s.distance > radius;
    s.rest = abs(s.distance - radius) * (s.distance + radius);
    real x = radius / s.distance;
    s.q = sqrt(s.rest) / s.distance;
    s.versine = s.outside ? x * x / (1.0 + s.q) : 2.0;
    return s;
}

real sphere_view_pdf(sphere_view s) { return s.versine > REAL_TINY ? ARC / s.versine : 0.0; }

// The way from p to a point of the sphere; pdf per solid angle. False: too small to be seen.
bool sphere_light_sample(real3 p, real3 center, real radius, vec2 u, out real3 way, out real pdf) {
    sphere_view s = sphere_view_of(p, center, radius);
    real h = real(u.x) * s.versine; // 1 - cos of the angle with the axis
    real sine = sqrt(h * (2.0 - h));
    real2 turn = sincos_turns(real(u.y));
    real3 axis = s.outside ? s.axis : real3(0.0, 0.0, 1.0);
    real3 direction = normalize_robust(from_frame(axis, real3(sine * turn.y, sine * turn.x, 1.0 - h)));
    // Outside, sin² is h (2 - h) = u x² (2 - h)/(1 + q), and the root of the nearer crossing d·cos - r·√(1 - sin²/x²) is taken as the quotient of the product of
    // both and the farther one. Inside, the farther one is b + √(b² + r² - d²), or for b < 0 the quotient.
    real chord = radius * sqrt(max(1.0 - real(u.x) * (2.0 - h) / (1.0 + s.q), 0.0));
    real b = s.outside ? s.distance * (1.0 - h) : dot(center - p, direction);
    real root = s.outside ? chord : sqrt(b * b + s.rest);
    bool quotient = s.outside || b < 0.0;
    real t = quotient ? s.rest / (s.outside ? b + root : root - b) : b + root;
    way = t * direction;
    pdf = sphere_view_pdf(s);
    return pdf > 0.0 && t > 0.0;
}

// The density with which a direction is sampled that meets the sphere.
real sphere_light_pdf(real3 p, real3 center, real radius) { return sphere_view_pdf(sphere_view_of(p, center, radius)); }

#endif
