// Arithmetic that goes wrong as far as Vulkan lets it ("Precision and Operation of SPIR-V Instructions"), and the exact tier's filter
// and the box test computed with it: formula by formula as shaders/tier_exact.glsl and box.glsl have them, in code of their own.
//
// + - × are correctly rounded, but which way is the implementation's choice unless a shader asks for one; ÷ is off by up to 2.5 ulp, √
// by what 1/inversesqrt is, 4.5; a·b + c may be fused unless it is `precise`; denormals may be flushed, on the way in and on the way
// out.
#ifndef MEASURE_STRESS_ADVERSARY_H
#define MEASURE_STRESS_ADVERSARY_H

#include <stdbool.h>

#include "measure/stress/random.h"

struct adversary {
    struct random *random; // NULL: round to nearest, fuse and flush nothing
    bool any_rounding;     // the farther neighbour, too [the nearest]
    float band;            // factor of all error bounds; 1 but for negative controls
};

// What the filter says of a ray and a primitive: if it is hit then at a t in [lo, hi]. lo > hi is a certain miss.
struct told {
    float lo, hi;
    bool certain;
};

// d: its largest component in [1, 2).
struct told adversary_triangle(struct adversary *a, const float o[3], const float d[3], const float v[3][3]);
struct told adversary_sphere(struct adversary *a, const float o[3], const float d[3], const float center[3], float radius, float root_sign);

// Whether the box is entered.
bool adversary_box(struct adversary *a, const float box_min[3], const float box_max[3], const float o[3], const float d[3], float tmin,
                   float tmax);

#endif
