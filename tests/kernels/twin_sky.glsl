// In: a direction, two random numbers. Out: the sky's radiance from the direction, its density; a sampled direction, its density as
// returned, and as looked up.
#ifndef TWIN_SKY_GLSL
#define TWIN_SKY_GLSL
#include "cases.glsl"
#include "environment.glsl"

void main() {
    uint number = gl_GlobalInvocationID.x, from = 5u * number, to = 9u * number;
    if (number >= case_count) return;
    real3 way = real3(number_of(given[from]), number_of(given[from + 1u]), number_of(given[from + 2u]));
    vec2 u = vec2(float(number_of(given[from + 3u])), float(number_of(given[from + 4u])));
    real pdf;
    real3 radiance = sky_radiance(way), sampled = sky_sample(u, pdf);
    for (uint k = 0u; k < 3u; k++) {
        results[to + k] = word_of(radiance[k]);
        results[to + 4u + k] = word_of(sampled[k]);
    }
    results[to + 3u] = word_of(sky_pdf(way));
    results[to + 7u] = word_of(pdf);
    results[to + 8u] = word_of(sky_pdf(sampled));
}

#endif
