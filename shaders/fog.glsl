// A homogeneous medium: how much comes through it, where it scatters, and into which directions.
//
// The phase function is that of L. G. Henyey and J. L. Greenstein, "Diffuse Radiation in the Galaxy", 1941, for an anisotropy g between -1 and 1; cosines are
// between the ways of the light before and after. All is written in 1 - |g| and in sums of numbers of one sign, so that nothing cancels for g near 0 and near ±1.
#ifndef FOG_GLSL
#define FOG_GLSL
#include "hemisphere.glsl"
#include "math.glsl"

// The share that comes through on a way of this length, which may be infinite. Without a medium that is all.
real fog_transmittance(real density, real way) { return density > 0.0 ? exponential(-density * way) : real(1.0); }

// How far light comes before it is scattered; infinite without a medium.
real fog_distance(real density, float u) { return density > 0.0 ? -logarithm(real(1.0 - u)) / density : INFINITY; }

// |g|, below 1.
real fog_sharpness(real g) { return min(abs(g), real(0.99999994)); }

// The density of scattered directions, per solid angle. 1 + g² - 2g·cos = (1 - |g|)² + 2|g|·(1 ∓ cos).
real fog_phase(real cosine, real g) {
    real a = fog_sharpness(g), off = 1.0 - a;
    real aside = clamp(1.0 - (g < 0.0 ? -cosine : cosine), real(0.0), real(2.0));
    real d = off * off + 2.0 * a * aside;
    return off * (1.0 + a) / (2.0 * TAU * d * sqrt(d));
}

// A scattered direction of light that goes along the unit vector `way`, and its density. For g > 0 and with n = 1 - g + 2g·u, the distribution's inverse
// 2g·cos = 1 + g² - (1 - g²)²/n² is 1 - cos = 2·((1 - g)/n)²·(1 - u)·(1 + g·u) and 1 + cos = 2·((1 + g)/n)²·u·(1 - g·(1 - u)).
real3 fog_sample(real3 way, real g, vec2 u, out real pdf) {
    real a = fog_sharpness(g), off = 1.0 - a;
    real v = g < 0.0 ? real(1.0 - u.x) : real(u.x);
    real n = off + 2.0 * a * v, less = off / n, more = (1.0 + a) / n;
    real to_one = 2.0 * less * less * (1.0 - v) * (1.0 + a * v), to_minus_one = 2.0 * more * more * v * (off + a * v);
    real cosine = 1.0 - to_one, sine = sqrt(to_one * to_minus_one);
    real2 turn = sincos_turns(real(u.y));
    real whole = off * (1.0 + a);
    pdf = n * n * n / (2.0 * TAU * whole * whole);
    return from_frame(way, real3(sine * turn.y, sine * turn.x, g < 0.0 ? -cosine : cosine));
}

#endif
