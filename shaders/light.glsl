// A light of any kind, as the light words have it: a sample of it, seen from a point.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL
#include "light_point.glsl"
#include "shared.h"
#include "tier_robust.glsl"

layout(set = 0, binding = BINDING_LIGHTS) uniform usamplerBuffer light_words;

// What a light sends to p from one of its points, if nothing is in the way.
struct light_sample {
    real3 way;          // from p to that point, device units; unit and endless where `infinite`
    real3 radiance;     // adds radiance·eval, eval being π·f·cos; of a light with a size it is divided by π and by the pdf
    real pdf;           // of the way, per solid angle; 0: the light has no size, and nothing else finds it
    int target_object;  // what the way ends on, which is not in the way: an object, -1 for none,
    int target_index;   // and its primitive; -1: any of the object
    bool infinite;
};

light_sample light_sample_none() { return light_sample(real3(0.0), real3(0.0), 0.0, -1, -1, false); }

real3 light_xyz(uvec4 word) { return real3(uintBitsToFloat(word.xyz)); }
uvec4 light_word(uint number, uint word) { return texelFetch(light_words, int(LIGHT_WORDS * number + word)); }

// `unit`: scene units per device unit.
void point_sample(inout light_sample s, uint number, uint kind, real3 intensity, real falloff, real unit) {
    real3 l = normalize_robust(s.way);
    s.radiance = light_arriving(intensity, falloff, dot(s.way, l) * unit);
    if (HAS_SPOT && kind == SPOT_LIGHT) {
        uvec4 w2 = light_word(number, 2u);
        s.radiance *= spot_share(-l, light_xyz(w2), uintBitsToFloat(w2.w), uintBitsToFloat(light_word(number, 3u).w));
    }
}

// Light `number`, seen from p: a sample of it, for u and choice in [0, 1). False where it sends nothing to p.
bool light_sample_at(uint number, real3 p, real unit, vec2 u, float choice, out light_sample s) {
    s = light_sample_none();
    uvec4 w0 = light_word(number, 0u), w1 = light_word(number, 1u);
    uint kind = w0.w;
    if (HAS_DIRECTIONAL && kind == DIRECTIONAL_LIGHT) {
        s.way = light_xyz(light_word(number, 2u));
        s.radiance = light_xyz(w1);
        s.infinite = true;
    } else if (kind == POINT_LIGHT || (HAS_SPOT && kind == SPOT_LIGHT)) {
        s.way = light_xyz(w0) - p;
        point_sample(s, number, kind, light_xyz(w1), uintBitsToFloat(w1.w), unit);
    }
    return s.radiance != real3(0.0) && s.way != real3(0.0);
}

#endif
