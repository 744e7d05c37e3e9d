// In: density, way, cosine, g, u (two numbers), direction. Out: transmittance, distance, phase, a scattered direction and its density.
#ifndef TWIN_FOG_GLSL
#define TWIN_FOG_GLSL
#include "cases.glsl"
#include "fog.glsl"

void main() {
    uint number = gl_GlobalInvocationID.x, from = 9u * number, to = 7u * number;
    if (number >= case_count) return;
    real x[9];
    for (int i = 0; i < 9; i++) x[i] = number_of(given[from + i]);
    real pdf;
    real3 scattered = fog_sample(real3(x[6], x[7], x[8]), x[3], vec2(x[4], x[5]), pdf);
    results[to] = word_of(fog_transmittance(x[0], x[1]));
    results[to + 1u] = word_of(fog_distance(x[0], float(x[4])));
    results[to + 2u] = word_of(fog_phase(x[2], x[3]));
    for (int i = 0; i < 3; i++) results[to + 3u + i] = word_of(scattered[i]);
    results[to + 6u] = word_of(pdf);
}

#endif
