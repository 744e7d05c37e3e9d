// In: turns, y, x, exponent, number (as bits). Out: sine and cosine of the turns, the arc of (x, y) in turns, e^exponent, the logarithm of
// the number.
#ifndef TWIN_MATH_GLSL
#define TWIN_MATH_GLSL
#include "cases.glsl"
#include "math.glsl"

void main() {
    uint number = gl_GlobalInvocationID.x, from = 5u * number, to = from;
    if (number >= case_count) return;
    real2 sincos = sincos_turns(number_of(given[from]));
    results[to] = word_of(sincos.x);
    results[to + 1u] = word_of(sincos.y);
    results[to + 2u] = word_of(atan2_turns(number_of(given[from + 1u]), number_of(given[from + 2u])));
    results[to + 3u] = word_of(exponential(number_of(given[from + 3u])));
    results[to + 4u] = word_of(logarithm(number_of(given[from + 4u])));
}

#endif
