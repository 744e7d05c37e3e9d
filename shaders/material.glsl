// The material at a point: the words of shared.h, and what its maps say there.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL
#include "bsdf.glsl"
#include "normal_map.glsl"
#include "surface.glsl"
#include "texture.glsl"

layout(set = 0, binding = BINDING_MATERIALS) uniform usamplerBuffer material_words;

struct material {
    bsdf b;
    real3 ambient, emission, tint; // tint: of what goes through a dielectric
    real ior;
    real alpha;             // how much of the surface is there
    uint number, priority;
    bool thin;
};

uvec4 material_word(uint number, uint word) { return texelFetch(material_words, int(MATERIAL_WORDS * number + word)); }
real3 real3_of(uvec4 word) { return real3(uintBitsToFloat(word.xyz)); }
real last_of(uvec4 word) { return real(uintBitsToFloat(word.w)); }

// What the map at `word` of a material shows; `none` where there is no map.
real4 map_at(uint number, uint word, real2 uv, real4 none) {
    uvec4 w0 = material_word(number, word), w1 = material_word(number, word + 1u);
    if (w0.w == NO_TEXTURE_WORD) return none;
    real3 at = real3(uv, 1.0);
    real2 there = real2(dot(real3_of(w0), at), dot(real3_of(w1), at));
    return texture_lookup(w0.w, there, w1.w != 0u);
}

// 1 where the surface is there, 0 where not, between them the chance of it.
real alpha_at(uint number, real4 color) {
    uvec4 w6 = material_word(number, 6u);
    uint mode = (material_word(number, 1u).w >> 8) & 0xffu;
    real alpha = color.w * real(uintBitsToFloat(w6.x));
    if (mode == ALPHA_MODE_OPAQUE) return 1.0;
    if (mode == ALPHA_MODE_BLEND) return alpha;
    return alpha < real(uintBitsToFloat(w6.y)) ? 0.0 : 1.0;
}

// The shading normal that the normal map says; it is a map of the front.
real3 mapped_normal(uint number, surface s) {
    real3 texel = map_at(number, MATERIAL_MAP_NORMAL, s.uv, real4(0.5, 0.5, 1.0, 1.0)).xyz;
    real side = s.front ? 1.0 : -1.0, scale = real(uintBitsToFloat(material_word(number, 6u).z));
    return side * map_normal(side * s.n, s.du, s.dv, real2(1.0, 0.0), real2(0.0, 1.0), texel, scale);
}

// Sets s.n, too, where there is a normal map.
material material_at(inout surface s) {
    uint n = s.material;
    uvec4 w0 = material_word(n, 0u), w1 = material_word(n, 1u), w2 = material_word(n, 2u), w3 = material_word(n, 3u), w4 = material_word(n, 4u);
    real3 diffuse = real3_of(w1), ambient = real3_of(w0), emission = real3_of(w4);
    real roughness = last_of(w2), metallic = last_of(w3), alpha = 1.0;
    if (HAS_TEXTURES || HAS_ALPHA) {
        real4 color = map_at(n, MATERIAL_MAP_DIFFUSE, s.uv, real4(1.0));
        if (HAS_TEXTURES) {
            real4 rough = map_at(n, MATERIAL_MAP_ROUGHNESS, s.uv, real4(1.0));
            diffuse *= color.rgb;
            ambient *= color.rgb;
            roughness *= rough.y;
            metallic *= rough.z;
            if (HAS_EMISSION) emission *= map_at(n, MATERIAL_MAP_EMISSION, s.uv, real4(1.0)).rgb;
        }
        if (HAS_ALPHA) alpha = alpha_at(n, color);
    }
    if (HAS_NORMAL_MAPS && material_word(n, MATERIAL_MAP_NORMAL).w != NO_TEXTURE_WORD) s.n = mapped_normal(n, s);
    bsdf b = bsdf_make(w1.w & 0xffu, diffuse, real3_of(w2), last_of(w0), real3_of(w3), metallic, roughness, last_of(w4));
    material m = material(b, ambient, emission, diffuse, last_of(w4), alpha, n, 0u, false);
    if (HAS_REFRACTION) {
        m.priority = material_word(n, 5u).w;
        m.thin = (w1.w >> 16) != 0u;
    }
    return m;
}

#endif
