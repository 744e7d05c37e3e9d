// In: texture, 1 for sRGB, u, v. Out: red, green, blue, alpha.
#ifndef TWIN_TEXTURE_GLSL
#define TWIN_TEXTURE_GLSL
#include "cases.glsl"
#include "texture.glsl"

void main() {
    uint number = gl_GlobalInvocationID.x, from = 4u * number;
    if (number >= case_count) return;
    bool srgb = number_of(given[from + 1u]) == 1.0;
    real4 color = texture_lookup(uint(number_of(given[from])), real2(number_of(given[from + 2u]), number_of(given[from + 3u])), srgb);
    for (uint k = 0u; k < 4u; k++) results[from + k] = word_of(color[k]);
}

#endif
