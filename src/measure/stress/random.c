#include "measure/stress/random.h"

#include <math.h>

void random_direction(double out[3], struct random *r) {
    double z = random_in(r, -1, 1), angle = random_in(r, 0, 6.283185307179586), rest = sqrt(1 - z * z);
    out[0] = rest * cos(angle);
    out[1] = rest * sin(angle);
    out[2] = z;
}

float random_ulps(struct random *r, float x, int most) {
    int steps = (int)random_below(r, (uint32_t)(2 * most + 1)) - most;
    if (!isfinite(x) || (x == 0 && random_bits(r) & 1)) return x;
    for (; steps > 0; steps--) x = nextafterf(x, INFINITY);
    for (; steps < 0; steps++) x = nextafterf(x, -INFINITY);
    return x;
}
