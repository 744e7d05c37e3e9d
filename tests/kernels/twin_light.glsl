// In: which function, p, a shape's nine numbers, u. Out: the way and its density, the density once more, 1 where the light is seen.
#ifndef TWIN_LIGHT_GLSL
#define TWIN_LIGHT_GLSL
#include "cases.glsl"
#include "light_point.glsl"
#include "light_rectangle.glsl"
#include "light_sphere.glsl"

real given1(uint at) { return number_of(given[at]); }
real3 given3(uint at) { return real3(given1(at), given1(at + 1u), given1(at + 2u)); }

void main() {
    uint number = gl_GlobalInvocationID.x, from = 15u * number, to = 6u * number;
    if (number >= case_count) return;
    int what = int(given1(from));
    real3 p = given3(from + 1u), a = given3(from + 4u), b = given3(from + 7u), c = given3(from + 10u), way = real3(0.0);
    vec2 u = vec2(float(given1(from + 13u)), float(given1(from + 14u)));
    real pdf = 0.0, again = 0.0;
    bool seen = false;
    if (what == 0) {
        seen = sphere_light_sample(p, a, b.x, u, way, pdf);
        again = sphere_light_pdf(p, a, b.x);
    } else if (what == 1) {
        seen = triangle_light_sample(p, a, b, c, u, way, pdf);
        again = triangle_light_pdf(p, a, b, c);
    } else if (what == 2) {
        seen = rectangle_light_sample(p, a, b, c, u, way, pdf);
        again = rectangle_light_pdf(p, a, b, c);
    } else {
        pdf = spot_share(p, a, b.x, b.y);
    }
    results[to] = word_of(way.x);
    results[to + 1u] = word_of(way.y);
    results[to + 2u] = word_of(way.z);
    results[to + 3u] = word_of(pdf);
    results[to + 4u] = word_of(again);
    results[to + 5u] = word_of(seen ? real(1.0) : real(0.0));
}

#endif
