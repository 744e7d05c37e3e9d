// What is left of light on its way through a medium: exp(-σt) (Beer and Lambert).
#ifndef ABSORPTION_GLSL
#define ABSORPTION_GLSL
#include "math.glsl"

// σ per unit of `way`, which may be infinite; a channel that is not absorbed stays as it is, however long the way.
real3 absorb(real3 sigma, real way) {
    real3 left;
    for (int i = 0; i < 3; i++) left[i] = sigma[i] > 0.0 ? exponential(-min(sigma[i] * way, 1000.0)) : real(1.0);
    return left;
}

#endif
