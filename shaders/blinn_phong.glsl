// The highlight from the half vector. J. F. Blinn, "Models of light reflection for computer synthesized pictures", 1977.
#ifndef BLINN_PHONG_GLSL
#define BLINN_PHONG_GLSL
#include "tier_robust.glsl"

// max(0, n·h), at most 1; or -1 where there is no half vector, because l is -v.
real blinn_cosine(real3 n, real3 l, real3 v) {
    real3 h = normalize_robust(l + v);
    return dot(h, h) > 0.5 ? clamp(dot(n, h), 0.0, 1.0) : -1.0;
}

// How much denser half vectors lie than the directions that they turn v into: 1/(4 v·h); 0 where there is no half vector.
real blinn_spread(real3 l, real3 v) {
    real cosine = dot(v, normalize_robust(l + v));
    return cosine > 0.0 ? 0.25 / cosine : 0.0;
}

#endif
