// In: a light's number, p, scene units per device unit, u, choice, a triangle. Out: 1 where the light is seen, its sample (the way, the radiance, the density, what it
// ends on, 1 where it is endless), the density for the triangle.
#ifndef TWIN_LIGHT_TABLE_GLSL
#define TWIN_LIGHT_TABLE_GLSL
#include "cases.glsl"
#include "light.glsl"

void main() {
    uint number = gl_GlobalInvocationID.x, from = 9u * number, to = 12u * number;
    if (number >= case_count) return;
    uint light = uint(number_of(given[from]));
    real3 p = real3(number_of(given[from + 1u]), number_of(given[from + 2u]), number_of(given[from + 3u]));
    vec2 u = vec2(float(number_of(given[from + 5u])), float(number_of(given[from + 6u])));
    int steps = 1000;
    light_sample s;
    bool seen = light_sample_at(light, p, number_of(given[from + 4u]), u, float(number_of(given[from + 7u])), steps, s);
    hit h = hit_none();
    h.index = int(number_of(given[from + 8u]));
    results[to] = word_of(seen ? real(1.0) : real(0.0));
    for (int i = 0; i < 3; i++) {
        results[to + 1u + i] = word_of(s.way[i]);
        results[to + 4u + i] = word_of(s.radiance[i]);
    }
    results[to + 7u] = word_of(s.pdf);
    results[to + 8u] = word_of(real(s.target_object));
    results[to + 9u] = word_of(real(s.target_index));
    results[to + 10u] = word_of(s.infinite ? real(1.0) : real(0.0));
    results[to + 11u] = word_of(light_pdf_of(light, p, h, steps));
}

#endif
