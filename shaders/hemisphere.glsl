// Directions about an axis: a frame, and samples of the cosine and of its powers.
//
// Samples map u in [0, 1) to the angle with the axis, turn = (sin, cos) of the angle around it, so that neighbours in u stay neighbours.
#ifndef HEMISPHERE_GLSL
#define HEMISPHERE_GLSL
#include "math.glsl"
#include "power.glsl"

// Two unit vectors that make a frame with the unit vector n. T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017;
// -0 counts as 0.
void tangents(real3 n, out real3 t, out real3 b) {
    real side = n.z >= 0.0 ? 1.0 : -1.0;
    real a = -1.0 / (side + n.z), c = n.x * n.y * a;
    t = real3(1.0 + side * n.x * n.x * a, side * c, -side * n.x);
    b = real3(c, side + n.y * n.y * a, -n.y);
}

// Between the frame of n, whose third axis is n, and the world.
real3 from_frame(real3 n, real3 local) {
    real3 t, b;
    tangents(n, t, b);
    return local.x * t + local.y * b + local.z * n;
}
real3 to_frame(real3 n, real3 w) {
    real3 t, b;
    tangents(n, t, b);
    return real3(dot(t, w), dot(b, w), dot(n, w));
}

// With a density of cos/π.
real3 cosine_direction(real u, real2 turn) {
    real s = sqrt(u);
    return real3(s * turn.y, s * turn.x, sqrt(1.0 - u));
}

// 1 - e^x for x <= 0, without cancellation.
real exponential_rest(real x) { return x > -0.34 ? -(x + x * x * exponential_series(max(x, -0.34))) : 1.0 - exponential(x); }

// With a density of (exponent + 1)/2π · cos^exponent: cos = (1-u)^(1/(exponent + 1)). The sine is not taken from the cosine, which for a
// large exponent says nothing about it any more.
real3 power_cosine_direction(real u, real2 turn, real exponent) {
    real x = logarithm(1.0 - u) / (exponent + 1.0);
    real s = sqrt(exponential_rest(2.0 * x));
    return real3(s * turn.y, s * turn.x, exponential(x));
}

#endif
