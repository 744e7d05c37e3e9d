// The light model: ambient·Ka + Σ intensity·(Kd·max(0, n·l) + Ks·max(0, r·v)^shininess where n·l > 0).
// B. T. Phong, "Illumination for computer generated pictures", 1975; r is the mirror image of l about n, v points to the viewer.
#ifndef PHONG_GLSL
#define PHONG_GLSL
#include "power.glsl"
#include "ray.glsl"

struct phong_material {
    real3 ambient, diffuse, specular;
    real shininess;
};

// max(0, r·v), at most 1.
real phong_cosine(real3 n, real3 l, real3 v) {
    real3 r = 2.0 * dot(n, l) * n - l;
    return clamp(dot(r, v), 0.0, 1.0);
}

// What one light of unit intensity adds, without shadow. n, l, v are unit; n·l <= 0 gives 0.
real3 phong_reflect(phong_material m, real3 n, real3 l, real3 v, bool with_diffuse, bool with_specular) {
    real cos_l = dot(n, l);
    real3 sum = real3(0.0);
    if (with_diffuse) sum += m.diffuse * cos_l;
    if (with_specular) sum += m.specular * power(phong_cosine(n, l, v), m.shininess);
    return cos_l > 0.0 ? sum : real3(0.0);
}

#endif
