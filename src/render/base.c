#include "render/base.h"

#include <math.h>

// Where the geometry lies along an axis, or 0. It is not 0 where the extent is at most the distance from the origin: all coordinates are then multiples of
// the nearer bound's ulp, the base, too, and their differences no larger than that bound, so that they are exact (cf. Sterbenz).
static float axis_base(float low, float high) {
    double near = fmin(fabs((double)low), fabs((double)high)), extent = (double)high - low;
    if (!(low > 0 || high < 0) || !(extent <= near) || !isfinite(extent)) return 0;
    return (float)(0.5 * ((double)low + high));
}

static bool is_exact_difference(float a, float b) { return (double)(float)((double)a - b) == (double)a - b; }

void scene_base(float base[3], const struct scene *scene, const float *eye) {
    for (int i = 0; i < 3; i++) {
        base[i] = axis_base(scene->bounds_min[i], scene->bounds_max[i]);
        if (eye && !is_exact_difference(eye[i], base[i])) base[i] = 0;
    }
}
