// In: diffuse, specular, shininess, n, l, v. Out: what a light of unit intensity adds, by the light model alone and as one of all models.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint at = 16u * i;
    vec3 diffuse = given3(at), specular = given3(at + 3u), n = given3(at + 7u), l = given3(at + 10u), v = given3(at + 13u);
    phong_material m = phong_material(vec3(0.0), diffuse, specular, given[at + 6u]);
    bsdf b = bsdf_make(PHONG_MODEL, diffuse, specular, given[at + 6u], vec3(0.0), 0.0, 0.0, 1.5);
    put3(6u * i, phong_reflect(m, n, l, v, true, true));
    real pdf;
    put3(6u * i + 3u, bsdf_eval(b, n, v, l, pdf));
}
