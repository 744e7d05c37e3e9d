// Lights without a size: what arrives of a point light's intensity, and of a spot's.
#ifndef LIGHT_POINT_GLSL
#define LIGHT_POINT_GLSL
#include "real.glsl"

// What arrives of a light's intensity: all of it, or the intensity over distance² where falloff is 1; nothing at the light itself. Divided twice, so that
// only a result that is too large or too small over- or underflows.
real3 light_arriving(real3 intensity, real falloff, real distance) {
    if (falloff == 0.0) return intensity;
    return distance > 0.0 ? (intensity / distance) / distance : real3(0.0);
}

// The share of a spot's intensity that goes along `way` when it shines along `axis`, both unit: 1 within the inner cone, 0 outside the outer one, between them
// the square of what the cosine has gone of the way (Khronos Group, "KHR_lights_punctual", 2018, "Inner and Outer Cone Angles"). Cosines as 1 - cos θ =
// |way - axis|²/2, which loses no digits where cones are narrow: `outer` is 1 - cos of the outer cone, `scale` 1/(cos inner - cos outer).
real spot_share(real3 way, real3 axis, real outer, real scale) {
    real3 apart = way - axis;
    real within = clamp((outer - 0.5 * dot(apart, apart)) * scale, 0.0, 1.0);
    return within * within;
}

#endif
