// The film: sums of samples in storage images, Kahan-compensated (unless a knob says otherwise), so that a picture of millions of samples keeps its digits,
// and resumable: a pixel knows how many samples it has, and a dispatch goes on from there.
// W. Kahan, "Further remarks on reducing truncation errors", CACM 8(1), 1965.
#ifndef FILM_GLSL
#define FILM_GLSL
#include "constants.glsl"
#include "ray.glsl"

layout(set = 0, binding = BINDING_FILM, rgba32f) uniform image2D film_image;
layout(set = 0, binding = BINDING_RESIDUE, rgba32f) uniform image2D residue_image;
layout(set = 0, binding = BINDING_AOV_SHADE, rgba32f) uniform image2D aov_shade_image;
layout(set = 0, binding = BINDING_AOV_ID, rgba32i) uniform iimage2D aov_id_image;

#define AOV_DEPTH 1u
#define AOV_NORMAL 2u
#define AOV_ID 4u
#define AOV_UNDECIDED 32u

struct film_pixel {
    vec3 sum, residue;
    uint done, nonfinite;   // samples
    vec4 shade;             // sum of normals, sum of depths
    ivec4 id;               // object, primitive of sample 0, samples that hit, rays left undecided
};

// What one sample brings.
struct film_sample {
    vec3 radiance;
    vec3 normal;
    float depth;
    int object, index;      // -1 for a miss
};

film_pixel film_load(ivec2 at) {
    vec4 sum = imageLoad(film_image, at), residue = imageLoad(residue_image, at);
    film_pixel pixel = film_pixel(sum.rgb, residue.rgb, uint(sum.a), uint(residue.a), vec4(0.0), ivec4(0));
    if ((AOVS & (AOV_DEPTH | AOV_NORMAL)) != 0u) pixel.shade = imageLoad(aov_shade_image, at);
    if (AOVS != 0u) pixel.id = imageLoad(aov_id_image, at);
    return pixel;
}

void film_store(ivec2 at, film_pixel pixel) {
    imageStore(film_image, at, vec4(pixel.sum, float(pixel.done)));
    imageStore(residue_image, at, vec4(pixel.residue, float(pixel.nonfinite)));
    if ((AOVS & (AOV_DEPTH | AOV_NORMAL)) != 0u) imageStore(aov_shade_image, at, pixel.shade);
    if (AOVS != 0u) imageStore(aov_id_image, at, pixel.id);
}

void film_add_aovs(inout film_pixel pixel, film_sample s) {
    if (pixel.done == 0u) pixel.id.xy = ivec2(s.object, s.index);
    if (s.object >= 0) {
        pixel.id.z++;
        pixel.shade += vec4(s.normal, s.depth);
    }
}

// Adds a sample; one that is NaN or infinite is dropped and counted.
void film_add(inout film_pixel pixel, film_sample s) {
    if (AOVS != 0u) film_add_aovs(pixel, s);
    pixel.done++;
    if (!is_finite(s.radiance)) {
        pixel.nonfinite++;
        return;
    }
    if (CHOSEN_SUM == SUM_PLAIN) {
        pixel.sum += s.radiance;
        return;
    }
    precise vec3 term = s.radiance - pixel.residue;
    precise vec3 sum = pixel.sum + term;
    precise vec3 residue = (sum - pixel.sum) - term;
    pixel.sum = sum;
    pixel.residue = residue;
}

#endif
