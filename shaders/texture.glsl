// Textures: pictures of 8-bit codes, looked up by texture coordinates. Reads TEXTURES and TEXELS of shared.h.
//
// Texel (i, j) has its center at ((i + 1/2)/width, (j + 1/2)/height), v downward; taps.glsl says what lies between. Codes become linear
// light by a table, right to the last bit, before they are interpolated. Coordinates as large as 1e6 have as few digits of a fraction as
// fp32 leaves them.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL
#include "math.glsl"
#include "taps.glsl"

layout(set = 0, binding = BINDING_TEXTURES) uniform usamplerBuffer texture_words;
layout(set = 0, binding = BINDING_TEXELS) uniform usamplerBuffer texel_words;

uint component_of(uvec4 word, uint number) {
    uvec2 half_word = (number & 2u) == 0u ? word.xy : word.zw;
    return (number & 1u) == 0u ? half_word.x : half_word.y;
}

// What a code means by the table that begins at `table`.
real decode_code(uint code, uint table) {
    uint at = table + code;
    return real(uintBitsToFloat(component_of(texelFetch(texel_words, int(at >> 2)), at & 3u)));
}

// The linear values of a texel's four codes; alpha is linear always.
real4 decode_texel(uint texel, bool srgb) {
    uint table = srgb ? 0u : 256u;
    return real4(decode_code(texel & 255u, table), decode_code((texel >> 8) & 255u, table), decode_code((texel >> 16) & 255u, table),
                 decode_code(texel >> 24, 256u));
}

real4 texel_at(uvec4 header, uint x, uint y, bool srgb) {
    uint number = y * header.x + x;
    return decode_texel(component_of(texelFetch(texel_words, int(header.z + (number >> 2))), number & 3u), srgb);
}

// Red, green, blue and alpha of a texture at uv, linear.
real4 texture_lookup(uint number, real2 uv, bool srgb) {
    uvec4 header = texelFetch(texture_words, int(TEXTURE_WORDS * number));
    bool nearest = (header.w & TEXTURE_NEAREST) != 0u;
    taps u = taps_of(uv.x, header.x, header.w & 3u, nearest), v = taps_of(uv.y, header.y, (header.w >> 2) & 3u, nearest);
    real4 a = texel_at(header, u.first, v.first, srgb), b = texel_at(header, u.second, v.first, srgb);
    real4 c = texel_at(header, u.first, v.second, srgb), d = texel_at(header, u.second, v.second, srgb);
    real4 upper = a + u.weight * (b - a), lower = c + u.weight * (d - c);
    return upper + v.weight * (lower - upper);
}

// A map's transform, as the words of its material have it: two rows of three.
real2 map_uv(vec3 row0, vec3 row1, real2 uv) {
    real3 whole = real3(uv, 1.0);
    return real2(dot(real3(row0), whole), dot(real3(row1), whole));
}

// Where a sphere's picture has the point with this unit normal. Row 0 is the pole +y; the middle column is at +z, and, seen from there, x
// grows to the right. The seam at -z is u = 0 or 1, which are the same texels of a picture that repeats; at the poles u is 1/2.
real2 sphere_uv(real3 n) { return real2(0.5 + atan2_turns(n.x, n.z), 2.0 * atan2_turns(sqrt(n.x * n.x + n.z * n.z), n.y)); }

#endif
