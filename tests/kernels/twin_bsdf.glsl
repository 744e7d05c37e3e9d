// In, 32 numbers a case: model, diffuse, specular, reflection, shininess, metallic, roughness, ior, then n, ng, wo, wi (made unit here), u,
// choice. Out, 12: value (3) and density for wi; whether there is a sample, its direction (3), weight (3), density. Included by
// twin_bsdf.comp and, with FP64 defined, by twin_bsdf_fp64.comp.
#include "bsdf.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint count; };
layout(set = 0, binding = 0) readonly buffer input_buffer { float given[]; };
layout(set = 0, binding = 1) writeonly buffer output_buffer { real result[]; };

real3 given3(uint at) { return real3(given[at], given[at + 1u], given[at + 2u]); }

void put3(uint at, real3 v) {
    result[at] = v.x;
    result[at + 1u] = v.y;
    result[at + 2u] = v.z;
}

void main() {
    uint i = gl_GlobalInvocationID.x, at = 32u * i, to = 12u * i;
    if (i >= count) return;
    bsdf b = bsdf_make(uint(given[at]), given3(at + 1u), given3(at + 4u), real(given[at + 10u]), given3(at + 7u), real(given[at + 11u]),
                       real(given[at + 12u]), real(given[at + 13u]));
    real3 n = normalize_robust(given3(at + 14u)), ng = normalize_robust(given3(at + 17u));
    real3 wo = normalize_robust(given3(at + 20u)), wi = normalize_robust(given3(at + 23u)), to_wi, weight;
    real pdf;
    put3(to, bsdf_eval(b, n, wo, wi, pdf));
    result[to + 3u] = pdf;
    result[to + 4u] = bsdf_sample(b, n, ng, wo, vec2(given[at + 26u], given[at + 27u]), given[at + 28u], to_wi, weight, pdf) ? 1.0 : 0.0;
    put3(to + 5u, to_wi);
    put3(to + 8u, weight);
    result[to + 11u] = pdf;
}
