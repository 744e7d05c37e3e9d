#include "reference/rounding.h"

#include <string.h>

// Numbers the floats in order; both zeros are 0.
static int64_t ordinal(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    int64_t magnitude = bits & 0x7fffffffu;
    return bits >> 31 ? -magnitude : magnitude;
}

static float from_ordinal(int64_t number) {
    uint32_t bits = number < 0 ? (uint32_t)-number | 0x80000000u : (uint32_t)number;
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

// Infinity stands for 2^128 where rounding is concerned (IEEE 754, 4.3.1).
static double as_number(float x) { return isinf(x) ? copysign(0x1p128, x) : x; }

float round_fraction(const struct fraction *exact, struct interval bounds) {
    int64_t lo = ordinal((float)bounds.lo), hi = ordinal((float)bounds.hi);
    while (lo < hi) {
        int64_t middle = lo + (hi - lo) / 2;
        double half_way = 0.5 * (as_number(from_ordinal(middle)) + as_number(from_ordinal(middle + 1)));
        int side = fraction_compare_number(exact, half_way);
        if (side == 0) return from_ordinal(middle % 2 == 0 ? middle : middle + 1);
        if (side < 0)
            hi = middle;
        else
            lo = middle + 1;
    }
    return from_ordinal(lo);
}

// Most intervals lie between two half-way cases, and rounding their ends is enough.
static float round_number(const struct ref_ray *ray, const struct crossing *crossing, struct interval bounds,
                          void (*number)(struct fraction *out, const struct ref_ray *ray, const struct crossing *crossing)) {
    float lo = (float)bounds.lo;
    if (lo == (float)bounds.hi) return lo + 0.0f; // never -0
    struct fraction exact;
    number(&exact, ray, crossing);
    return round_fraction(&exact, bounds);
}

void crossing_round(struct gn_hit *hit, const struct ref_ray *ray, const struct crossing *crossing) {
    hit->t = round_number(ray, crossing, crossing->t, crossing_t);
    hit->u = hit->v = 0;
    if (crossing->kind == CROSSING_SPHERE) return;
    struct interval u, v;
    triangle_weights(&u, &v, ray, crossing);
    hit->u = round_number(ray, crossing, u, crossing_u);
    hit->v = round_number(ray, crossing, v, crossing_v);
}
