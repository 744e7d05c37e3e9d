#include "measure/stress/adversary.h"

#include <math.h>
#include <string.h>

#define UNIT 0x1p-24f
#define TINY 0x1p-120f

// ------------------------------------------------------------------------------------------------------------ operations

static bool flip(struct adversary *a) { return a->random && random_bits(a->random) & 1; }

static float flushed(struct adversary *a, float x) { return fabsf(x) < 0x1p-126f && x != 0 && flip(a) ? copysignf(0, x) : x; }

// One of the two fp32 neighbours of a number that is given to fp64's precision.
static float rounded(struct adversary *a, double x) {
    float near = (float)x;
    if (a->any_rounding && (double)near != x && isfinite(near) && flip(a)) near = nextafterf(near, x > (double)near ? INFINITY : -INFINITY);
    return flushed(a, near);
}

static float add(struct adversary *a, float x, float y) { return rounded(a, (double)flushed(a, x) + flushed(a, y)); }
static float sub(struct adversary *a, float x, float y) { return add(a, x, -y); }
static float mul(struct adversary *a, float x, float y) { return rounded(a, (double)flushed(a, x) * flushed(a, y)); }

// x·y + z, fused or not.
static float mad(struct adversary *a, float x, float y, float z) {
    if (!flip(a)) return add(a, mul(a, x, y), z);
    return flushed(a, fmaf(flushed(a, x), flushed(a, y), flushed(a, z)));
}

static float disturbed(struct adversary *a, double x, double ulps) {
    if (!a->random || x == 0 || !isfinite(x)) return (float)x;
    return flushed(a, (float)(x + random_in(a->random, -ulps, ulps) * ldexp(1, ilogb(x) - 23)));
}

static float quotient(struct adversary *a, float x, float y) { return disturbed(a, (double)flushed(a, x) / flushed(a, y), 2.5); }
static float root(struct adversary *a, float x) { return disturbed(a, sqrt((double)flushed(a, x)), 4.5); }

static float dot(struct adversary *a, const float x[3], const float y[3]) {
    return mad(a, x[2], y[2], mad(a, x[0], y[0], mul(a, x[1], y[1])));
}

static float largest(const float v[3]) { return fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2]))); }

// ------------------------------------------------------------------------------------------------------------- triangles

// The rows of the shear: rows[0] and rows[1] map to the plane, rows[2] to depth. As shear_make.
static void shear(struct adversary *a, float rows[3][3], const float d[3]) {
    float x = fabsf(d[0]), y = fabsf(d[1]), z = fabsf(d[2]);
    int axis = z >= x && z >= y ? 2 : x >= y ? 0 : 1;
    float inverse = quotient(a, 1, d[axis]);
    memset(rows, 0, 9 * sizeof(float));
    int row = 0;
    for (int k = 0; k < 3; k++) {
        int other = axis == 1 ? (k == 0 ? 2 : k == 2 ? 0 : 1) : k;
        if (other == axis) continue;
        rows[row][other] = 1;
        rows[row++][axis] = -mul(a, d[other], inverse);
    }
    rows[2][axis] = inverse;
}

static float sheared(struct adversary *a, const float row[3], const float v[3]) {
    return mad(a, row[2], v[2], mad(a, row[0], v[0], mul(a, row[1], v[1])));
}

static float edge(struct adversary *a, const float p[2], const float q[2]) { return mad(a, p[0], q[1], -mul(a, p[1], q[0])); }

// An edge function's error at most; `reach` and `extent`: the largest coordinate before and after the shear.
static float edge_band(struct adversary *a, float reach, float extent) {
    float factor = mul(a, a->band * 64 * UNIT, reach);
    return mad(a, factor, mad(a, 16 * UNIT, reach, extent), TINY);
}

static struct told everything(void) { return (struct told){-3.4e38f, 3.4e38f, false}; }
static struct told nothing(void) { return (struct told){3.4e38f, -3.4e38f, true}; }

struct told adversary_triangle(struct adversary *a, const float o[3], const float d[3], const float v[3][3]) {
    float rows[3][3], from_o[3][3], p[3][2], depth[3], reach = 0, extent = 0;
    shear(a, rows, d);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) from_o[i][k] = sub(a, v[i][k], o[k]);
        p[i][0] = sheared(a, rows[0], from_o[i]);
        p[i][1] = sheared(a, rows[1], from_o[i]);
        depth[i] = sheared(a, rows[2], from_o[i]);
        reach = fmaxf(reach, largest(from_o[i]));
        extent = fmaxf(extent, fmaxf(fabsf(p[i][0]), fabsf(p[i][1])));
    }
    float u = edge(a, p[2], p[1]), w0 = edge(a, p[0], p[2]), w1 = edge(a, p[1], p[0]), band = edge_band(a, reach, extent);
    float low = fminf(u, fminf(w0, w1)), high = fmaxf(u, fmaxf(w0, w1));
    if (low < -band && high > band) return nothing();

    float nearest = fminf(depth[0], fminf(depth[1], depth[2])), farthest = fmaxf(depth[0], fmaxf(depth[1], depth[2]));
    float slack = mad(a, fmaxf(fabsf(nearest), fabsf(farthest)), a->band * 32 * UNIT, TINY);
    float det = add(a, add(a, u, w0), w1), sum = mad(a, w1, depth[2], mad(a, u, depth[0], mul(a, w0, depth[1])));
    float sure = sub(a, fabsf(det), mul(a, 4, band));
    bool certain = (low > band || high < -band) && sure > 0;
    float t = mul(a, sum, quotient(a, 1, det));
    float error = certain ? mad(a, quotient(a, mul(a, mul(a, 4, band), sub(a, farthest, nearest)), sure), 1.0001f, slack) : INFINITY;
    float lo = sub(a, t, error), hi = add(a, t, error), least = sub(a, nearest, slack), most = add(a, farthest, slack);
    if (!(lo >= least && hi <= most)) lo = least, hi = most;
    return lo <= hi && reach < 1e18f ? (struct told){lo, hi, certain} : everything();
}

// --------------------------------------------------------------------------------------------------------------- spheres

static void cross(struct adversary *a, float out[3], const float x[3], const float y[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = mad(a, x[j], y[k], -mul(a, x[k], y[j]));
    }
}

struct told adversary_sphere(struct adversary *a, const float o[3], const float d[3], const float center[3], float radius,
                             float root_sign) {
    float l[3], x[3], size_x[3], reach[3], size_l[3], size_d[3];
    for (int k = 0; k < 3; k++) l[k] = sub(a, center[k], o[k]);
    cross(a, x, l, d);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        reach[i] = add(a, fabsf(mul(a, l[j], d[k])), fabsf(mul(a, l[k], d[j])));
        size_x[i] = fabsf(x[i]), size_l[i] = fabsf(l[i]), size_d[i] = fabsf(d[i]);
    }
    float dd = dot(a, d, d), r2 = mul(a, mul(a, radius, radius), dd), x2 = dot(a, x, x), f = sub(a, r2, x2);
    float f_error = mul(a, add(a, add(a, dot(a, size_x, reach), x2), r2), a->band * 9 * UNIT);
    f_error = add(a, mad(a, dot(a, reach, reach), a->band * 34 * UNIT * UNIT, f_error), TINY);
    if (f < -f_error) return nothing();
    float b = dot(a, l, d), b_error = mul(a, dot(a, size_l, size_d), a->band * 5 * UNIT);
    bool certain = f > f_error;
    float root_lo = mul(a, root(a, fmaxf(sub(a, f, f_error), 0)), 1 - 13 * UNIT),
          root_hi = mul(a, root(a, add(a, f, f_error)), 1 + 13 * UNIT);
    float lo = root_sign < 0 ? sub(a, b, root_hi) : add(a, b, root_lo), hi = root_sign < 0 ? sub(a, b, root_lo) : add(a, b, root_hi);
    float slack = add(a, mad(a, add(a, fabsf(b), root_hi), a->band * 10 * UNIT, b_error), TINY), inverse = quotient(a, 1, dd);
    lo = mul(a, sub(a, lo, slack), inverse);
    hi = mul(a, add(a, hi, slack), inverse);
    if (!(lo <= hi && fmaxf(largest(l), radius) < 1e9f)) return everything();
    return (struct told){mad(a, fabsf(lo), -(a->band * 17 * UNIT), lo), mad(a, fabsf(hi), a->band * 17 * UNIT, hi), certain};
}

// ----------------------------------------------------------------------------------------------------------------- boxes

bool adversary_box(struct adversary *a, const float box_min[3], const float box_max[3], const float o[3], const float d[3], float tmin,
                   float tmax) {
    float enter = tmin, leave = tmax;
    for (int k = 0; k < 3; k++) {
        bool flat = fabsf(d[k]) < 0x1p-120f;
        float nudge = flat ? mul(a, fmaxf(fabsf(o[k]), 1), 4 * UNIT) : 0, inverse = flat ? 0x1p120f : quotient(a, 1, d[k]);
        float low = mul(a, sub(a, box_min[k], flat ? add(a, o[k], nudge) : o[k]), inverse);
        float high = mul(a, sub(a, box_max[k], flat ? sub(a, o[k], nudge) : o[k]), inverse);
        enter = fmaxf(enter, fminf(low, high));
        leave = fminf(leave, fmaxf(low, high));
    }
    return enter <= mad(a, fabsf(leave), a->band * 16 * UNIT, leave) && enter < INFINITY;
}
