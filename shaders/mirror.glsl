// A mirror.
#ifndef MIRROR_GLSL
#define MIRROR_GLSL
#include "tier_robust.glsl"

// Where a shading normal can differ from the geometric one.
const bool HAS_BENT_NORMALS = HAS_SMOOTH_NORMALS || HAS_NORMAL_MAPS;

// The mirror image of wo about n; or about ng, where the one about n would come out of the back of the surface, so that no light is lost.
// Unit after any number of bounces.
real3 mirror_direction(real3 n, real3 ng, real3 wo) {
    real3 wi = 2.0 * dot(n, wo) * n - wo;
    if (HAS_BENT_NORMALS) wi = dot(wi, ng) > 0.0 ? wi : 2.0 * dot(ng, wo) * ng - wo;
    return normalize_robust(wi);
}

#endif
