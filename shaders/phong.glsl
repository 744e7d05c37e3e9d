// The light model: ambient·Ka + Σ intensity·(Kd·max(0, n·l) + Ks·max(0, r·v)^shininess where n·l > 0).
// B. T. Phong, "Illumination for computer generated pictures", 1975; r is the mirror image of l about n, v points to the viewer.
#ifndef PHONG_GLSL
#define PHONG_GLSL
#include "ray.glsl"

struct phong_material {
    vec3 ambient, diffuse, specular;
    float shininess;
};

// x^y for x >= 0, y >= 0, with 0^0 = 1 (pow leaves it undefined).
float power(float x, float y) { return y == 0.0 ? 1.0 : x > 0.0 ? pow(x, y) : 0.0; }

// What one light of unit intensity adds, without shadow. n, l, v are unit; n·l <= 0 gives 0.
vec3 phong_reflect(phong_material m, vec3 n, vec3 l, vec3 v, bool with_diffuse, bool with_specular) {
    float cos_l = dot(n, l);
    vec3 sum = vec3(0.0);
    if (with_diffuse) sum += m.diffuse * cos_l;
    if (with_specular) {
        vec3 r = 2.0 * cos_l * n - l;
        sum += m.specular * power(clamp(dot(r, v), 0.0, 1.0), m.shininess);
    }
    return cos_l > 0.0 ? sum : vec3(0.0);
}

// 1, or 1/distance² where falloff is 1; 0 at the light itself. Divided twice, so that the square neither over- nor underflows.
float light_falloff(float falloff, float distance) {
    if (falloff == 0.0) return 1.0;
    return distance > 0.0 ? (1.0 / distance) / distance : 0.0;
}

#endif
