// Boxes alone, for the stress cases: whether box.glsl says that a ray enters. Included by stress_box.comp and, with FP64 defined, by
// stress_box_fp64.comp.
#ifndef STRESS_BOX_GLSL
#define STRESS_BOX_GLSL
#include "box.glsl"
#include "constants.glsl"
#include "stress.glsl"

// In: box min, box max, origin, direction, tmin, tmax. Out: 1 if it is entered, else 0.
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.count) return;
    uint at = STRESS_BOX_IN * i;
    ray r = ray_make(given3(at + 6u), given3(at + 9u), given1(at + 12u), given1(at + 13u), SELF_NONE);
    real enter = box_enter(given3(at), given3(at + 3u), slabs_make(r.o, r.d), r.tmin, r.tmax);
    result[i] = enter < INFINITY ? 1.0 : 0.0;
}

#endif
