// Normal maps in tangent space: red is where u grows, green where v falls (up in the picture, as in glTF), blue along the normal.
#ifndef NORMAL_MAP_GLSL
#define NORMAL_MAP_GLSL
#include "hemisphere.glsl"
#include "tier_robust.glsl"

// The normal that a texel (three linear values, 0 to 1) makes of the unit normal n of a triangle with the edges e1, e2 and what the texture
// coordinates change along them. For a surface seen from its back, n is the front's, and the result is turned. Where the coordinates have
// no area, or n lies along the tangent, any frame will do; a texel that says nothing leaves n.
real3 map_normal(real3 n, real3 e1, real3 e2, real2 duv1, real2 duv2, real3 texel, real scale) {
    real area = duv1.x * duv2.y - duv1.y * duv2.x;
    real3 right = (e1 * duv2.y - e2 * duv1.y) * sign(area), up = (e1 * duv2.x - e2 * duv1.x) * sign(area); // ∂p/∂u, -∂p/∂v, times the area
    real3 t, b;
    tangents(n, t, b);
    real3 across = normalize_robust(right);
    across = normalize_robust(across - n * dot(n, across));
    t = dot(across, across) > 0.5 ? across : t;
    b = cross(n, t);
    b = dot(b, up) < 0.0 ? -b : b;
    real3 m = 2.0 * texel - 1.0;
    real3 mapped = normalize_robust(scale * (m.x * t + m.y * b) + m.z * n);
    return dot(mapped, mapped) > 0.5 ? mapped : n;
}

// The same for a sphere's point with unit normal n, in the frame of sphere_uv: u grows along n's way around +y.
real3 map_sphere_normal(real3 n, real3 texel, real scale) {
    real3 along_u = real3(n.z, 0.0, -n.x), along_v = real3(n.x * n.y, n.y * n.y - 1.0, n.y * n.z);
    return map_normal(n, along_u, along_v, real2(1.0, 0.0), real2(0.0, 1.0), texel, scale);
}

#endif
