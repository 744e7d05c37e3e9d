// In, 16 numbers a case: n, ng, wo, index here and beyond, choice, tint, σ, 1 to make the directions unit first, way (negative: infinite).
// Out, 12: share sent back; direction, weight, whether it went through, of glass; the same of a thin sheet; what σ leaves.
// Included by twin_dielectric.comp and, with FP64 defined, by twin_dielectric_fp64.comp.
#include "absorption.glsl"
#include "dielectric.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint count; };
layout(set = 0, binding = 0) readonly buffer input_buffer { float given[]; };
layout(set = 0, binding = 1) writeonly buffer output_buffer { real result[]; };

real3 direction(uint at, bool unit) {
    real3 v = real3(given[at], given[at + 1u], given[at + 2u]);
    return unit ? normalize_robust(v) : v;
}

void put_passage(uint to, real3 wi, real3 weight, bool transmitted) {
    for (int k = 0; k < 3; k++) result[to + k] = wi[k];
    result[to + 3u] = weight.x;
    result[to + 4u] = transmitted ? 1.0 : 0.0;
}

void main() {
    uint i = gl_GlobalInvocationID.x, at = 16u * i, to = 12u * i;
    if (i >= count) return;
    bool unit = given[at + 14u] != 0.0;
    real3 n = direction(at, unit), ng = direction(at + 3u, unit), wo = direction(at + 6u, unit), wi, weight;
    real here = real(given[at + 9u]), beyond = real(given[at + 10u]);
    real3 tint = real3(given[at + 12u]);
    float choice = given[at + 11u];
    bool transmitted;
    result[to] = fresnel_at(dot(n, wo), here, beyond).reflected;
    dielectric_sample(n, ng, wo, here, beyond, tint, choice, wi, weight, transmitted);
    put_passage(to + 1u, wi, weight, transmitted);
    dielectric_sheet_sample(n, ng, wo, beyond, tint, choice, wi, weight, transmitted);
    put_passage(to + 6u, wi, weight, transmitted);
    result[to + 11u] = absorb(real3(given[at + 13u]), given[at + 15u] < 0.0 ? INFINITY : real(given[at + 15u])).x;
}
