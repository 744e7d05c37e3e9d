// A light of any kind, as the light words have it: a sample of it, seen from a point, and how likely that was.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL
#include "light_point.glsl"
#include "light_rectangle.glsl"
#include "light_sphere.glsl"
#include "ray.glsl"

layout(set = 0, binding = BINDING_LIGHTS) uniform usamplerBuffer light_words;
layout(set = 0, binding = BINDING_EMITTERS) uniform usamplerBuffer emitter_words;

// What a light sends to p from one of its points, if nothing is in the way.
struct light_sample {
    real3 way;          // from p to that point, device units; unit and endless where `infinite`
    real3 radiance;     // with pdf 0 an intensity, which adds radiance·eval, eval being π·f·cos; else a radiance, which adds radiance·eval/(π·pdf)
    real pdf;           // of the way, per solid angle; 0: the light has no size, and nothing else finds it
    int target_object;  // what the way ends on, which is not in the way: an object, -1 for none,
    int target_index;   // and its primitive; -1: any of the object
    bool infinite;
};

light_sample light_sample_none() { return light_sample(real3(0.0), real3(0.0), 0.0, -1, -1, false); }

real3 light_xyz(uvec4 word) { return real3(uintBitsToFloat(word.xyz)); }
uvec4 light_word(uint number, uint word) { return texelFetch(light_words, int(LIGHT_WORDS * number + word)); }
uvec4 emitter_word(uint number, uint word) { return texelFetch(emitter_words, int(EMITTER_WORDS * number + word)); }

// ------------------------------------------------------------------------------------------------------------ no size
// `unit`: scene units per device unit.
void sample_point(inout light_sample s, uint number, uint kind, real3 p, real unit) {
    uvec4 w0 = light_word(number, 0u), w1 = light_word(number, 1u);
    s.way = light_xyz(w0) - p;
    real3 l = normalize_robust(s.way);
    s.radiance = light_arriving(light_xyz(w1), uintBitsToFloat(w1.w), dot(s.way, l) * unit);
    if (HAS_SPOT && kind == SPOT_LIGHT) {
        uvec4 w2 = light_word(number, 2u);
        s.radiance *= spot_share(-l, light_xyz(w2), uintBitsToFloat(w2.w), uintBitsToFloat(light_word(number, 3u).w));
    }
    if (!any(greaterThan(abs(s.way), real3(0.0)))) s.radiance = real3(0.0);
}

void sample_direction(inout light_sample s, uint number) {
    s.way = light_xyz(light_word(number, 2u));
    s.radiance = light_xyz(light_word(number, 1u));
    s.infinite = true;
}

// ------------------------------------------------------------------------------------------------------------ spheres
void sample_sphere(inout light_sample s, uint number, real3 p, vec2 u) {
    uvec4 w1 = light_word(number, 1u);
    s.target_object = int(w1.w);
    bool seen = sphere_light_sample(p, light_xyz(light_word(number, 0u)), uintBitsToFloat(light_word(number, 2u).x), u, s.way, s.pdf);
    s.radiance = seen ? light_xyz(w1) : real3(0.0);
}

// ---------------------------------------------------------------------------------------------- triangles and rectangles
// Of the emitters [first, first + count) of a mesh light the first one with choice < cdf; `steps` is counted down.
uint emitter_chosen(uint first, uint count, float choice, inout int steps) {
    uint low = first, high = first + count - 1u;
    while (low < high && steps > 0) {
        uint middle = low + (high - low) / 2u;
        bool found = choice < uintBitsToFloat(emitter_word(middle, 0u).w);
        high = found ? middle : high;
        low = found ? low : middle + 1u;
        steps--;
    }
    return low;
}

// The emitter that is triangle `primitive`, or the one before which it would be.
uint emitter_of(uint first, uint count, uint primitive, inout int steps) {
    uint low = first, high = first + count - 1u;
    while (low < high && steps > 0) {
        uint middle = low + (high - low) / 2u;
        bool found = emitter_word(middle, 2u).w >= primitive;
        high = found ? middle : high;
        low = found ? low : middle + 1u;
        steps--;
    }
    return low;
}

// A triangle of a mesh light, or all of another flat light.
struct flat_light {
    real3 v0, v1, v2, radiance;
    real probability;   // of its being chosen
    int object, index;
};

flat_light flat_light_at(uint number) {
    uvec4 w1 = light_word(number, 1u);
    real3 v0 = light_xyz(light_word(number, 0u)), v1 = light_xyz(light_word(number, 2u)), v2 = light_xyz(light_word(number, 3u));
    return flat_light(v0, v1, v2, light_xyz(w1), 1.0, int(w1.w), -1);
}

flat_light emitter_at(uint emitter) {
    uvec4 w0 = emitter_word(emitter, 0u), w1 = emitter_word(emitter, 1u), w2 = emitter_word(emitter, 2u), w3 = emitter_word(emitter, 3u);
    return flat_light(light_xyz(w0), light_xyz(w1), light_xyz(w2), light_xyz(w3), uintBitsToFloat(w3.w), int(w1.w), int(w2.w));
}

rectangle_view flat_light_view(flat_light f, real3 p, uint kind) { return rectangle_view_of(f.v0 - p, f.v1 - f.v0, f.v2 - f.v0, kind == RECTANGLE_LIGHT); }

void sample_flat(inout light_sample s, uint number, uint kind, real3 p, vec2 u, float choice, inout int steps) {
    flat_light f = flat_light_at(number);
    if (kind == MESH_LIGHT) {
        uvec4 w2 = light_word(number, 2u);
        f = emitter_at(emitter_chosen(w2.x, w2.y, choice, steps));
    }
    rectangle_view r = flat_light_view(f, p, kind);
    s.way = rectangle_view_sample(r, u);
    s.pdf = rectangle_view_pdf(r) * f.probability;
    s.radiance = s.pdf > 0.0 && dot(s.way, s.way) > 0.0 ? f.radiance : real3(0.0);
    s.target_object = f.object;
    s.target_index = f.index;
}

// --------------------------------------------------------------------------------------------------------------- any
// Light `number`, seen from p (device units): a sample of it, for u and choice in [0, 1). False where it sends nothing to p. `unit`: scene units per device unit; `steps` is
// counted down by loops, and if it is 0 the sample is not to be trusted.
bool light_sample_at(uint number, real3 p, real unit, vec2 u, float choice, inout int steps, out light_sample s) {
    s = light_sample_none();
    uint kind = light_word(number, 0u).w;
    if (HAS_DIRECTIONAL && kind == DIRECTIONAL_LIGHT) sample_direction(s, number);
    else if (HAS_SOFT_SHADOWS && HAS_SPHERES && kind == SPHERE_LIGHT) sample_sphere(s, number, p, u);
    else if (HAS_SOFT_SHADOWS && HAS_TRIANGLES && kind > SPHERE_LIGHT) sample_flat(s, number, kind, p, u, choice, steps);
    else if (kind == POINT_LIGHT || (HAS_SPOT && kind == SPOT_LIGHT)) sample_point(s, number, kind, p, unit);
    return s.radiance != real3(0.0);
}

// The density per solid angle with which light `number` samples, from p, the direction in which h was hit, a point of the light's shape. 0 where it never does.
real light_pdf_of(uint number, real3 p, hit h, inout int steps) {
    uvec4 w0 = light_word(number, 0u);
    if (HAS_SPHERES && w0.w == SPHERE_LIGHT) return sphere_light_pdf(p, light_xyz(w0), uintBitsToFloat(light_word(number, 2u).x));
    if (!HAS_TRIANGLES || w0.w < TRIANGLE_LIGHT) return 0.0;
    flat_light f = flat_light_at(number);
    if (w0.w == MESH_LIGHT) {
        uvec4 w2 = light_word(number, 2u);
        f = emitter_at(emitter_of(w2.x, w2.y, uint(h.index), steps));
        if (f.index != h.index) return 0.0;
    }
    return rectangle_view_pdf(flat_light_view(f, p, w0.w)) * f.probability;
}

#endif
