// Tier "exact", first stage: the robust tier's formulas with a bound on their error beside them. What the bounds leave open is a maybe, and is resolved elsewhere; what
// they decide agrees with exact arithmetic on the fp32 inputs.
//
// u is the unit roundoff, 2^-24 or 2^-53: in fp64 this is the second stage. Each + - × is right to u, Vulkan's ÷ to 5 u (2.5 ulp); `precise` keeps the order, and fusing a product into a sum only takes roundings away.
//
// Triangle. A vertex relative to the origin, A = v - o, is right to u. The shear's entry S = -d_x · (1/d_z) is right to 6.1 u and at most 1, so that a sheared
// coordinate x = A_x + S·A_z is off by at most e = u(|A_x| + 8.1|A_z| + |x|) <= 11.2 u m, m the largest |component| of any A. An edge function p_x q_y - p_y q_x
// of coordinates up to M is off by 4 e M + 2 e² from its factors and by 4 u M² <= 8 u m M from its own roundings (M <= 2m): together below
// 53 u m (M + 12 u m). BAND = 64 u m (M + 16 u m) + REAL_TINY, the last for underflow.
// Geometry is fp32, and what is denormal in device coordinates may be flushed or have lost bits: a coordinate may be off by another 2^-126. In fp32 BAND covers
// that wherever m > 2^-106, REAL_TINY below. In fp64 it adds less than 2^-122 M to an edge function, which BAND covers where m > 2^-75; below, M < 2^-74 and
// REAL_TINY does. t may be off by 2^-120 more, and the ray's tmin
// and tmax, which were multiplied by a power of two, by 2^-110: LOST is more than both, a sphere's after its division by d·d < 12, too.
// t is the mean of the vertices' depths z (right to 7.1 u) weighted by the edge functions: a weight's error moves t by the spread of z at most:
// |t error| <= 3 BAND spread/(|D| - 3 BAND) + 17.1 u Z, Z the largest |z|; used with 4 and 32. Where |D| >= 16 BAND, 4 BAND/(|D| - 4 BAND) is
// at most 5.34 BAND/|D|; with the roundings of the quotient, 6. A triangle that is hit at all is hit between its smallest and largest z.
// Their difference is at most |z_b - z_a| + |z_c - z_a|, which stands for the spread, and Z at most |z_a| and that.
//
// Sphere. X = l×d, M_i = |l_j d_k| + |l_k d_j|: F = r²(d·d) - |X|² is off by at most 8 u Σ|X_i|M_i + 8 u(|X|² + r² d²) + 32 u² ΣM_i².
// b = l·d is off by 4.1 u Σ|l_i d_i|; t = (b ± √F)/(d·d).
#ifndef TIER_EXACT_GLSL
#define TIER_EXACT_GLSL
#include "tier_robust.glsl"

const real LOST = 2.4651903e-32; // 2^-105

// What the first stage says of a ray and a primitive. If it is hit, then at a t in [lo, hi]; `certain` says that it is.
// A certain miss has hi = -inf.
struct verdict {
    real3 tuv;
    real lo, hi;
    bool certain;
};

verdict certain_miss() { return verdict(real3(0.0), REAL_MAX, -INFINITY, false); }

real largest(real3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// Extremes, in fp32 by their bits: an instruction each, where min and max of floats must look for a NaN first. Numbers without a sign order as
// integers do, and a NaN is the largest. `most_positive` is the largest if one of the numbers is positive, else none of them; `most_negative` likewise:
// to a signed integer comparison a positive number is above all negative ones, to an unsigned one the most negative number is above all.
#ifdef FP64
real larger(real a, real b) { return max(a, b); }
real smaller(real a, real b) { return min(a, b); }
real most_positive(real a, real b, real c) { return max(a, max(b, c)); }
real most_negative(real a, real b, real c) { return min(a, min(b, c)); }
#else
float larger(float a, float b) { return uintBitsToFloat(max(floatBitsToUint(a), floatBitsToUint(b))); }
float smaller(float a, float b) { return uintBitsToFloat(min(floatBitsToUint(a), floatBitsToUint(b))); }
float most_positive(float a, float b, float c) { return intBitsToFloat(max(floatBitsToInt(a), max(floatBitsToInt(b), floatBitsToInt(c)))); }
float most_negative(float a, float b, float c) { return uintBitsToFloat(max(floatBitsToUint(a), max(floatBitsToUint(b), floatBitsToUint(c)))); }
#endif

real largest_of(real3 v) { return larger(abs(v.x), larger(abs(v.y), abs(v.z))); }
real largest_of(real2 v) { return larger(abs(v.x), abs(v.y)); }

verdict triangle_exact(real3 o, shear s, real3 v0, real3 v1, real3 v2) {
    precise real3 a = v0 - o, b = v1 - o, c = v2 - o;
    real2 pa = real2(sheared(s.x, a), sheared(s.y, a));
    real2 pb = real2(sheared(s.x, b), sheared(s.y, b));
    real2 pc = real2(sheared(s.x, c), sheared(s.y, c));
    real u = edge_function(pc, pb), v = edge_function(pa, pc), w = edge_function(pb, pa);

    real m = larger(largest_of(a), larger(largest_of(b), largest_of(c)));
    real extent = larger(largest_of(pa), larger(largest_of(pb), largest_of(pc)));
    real band = 64.0 * REAL_UNIT * m * (extent + 16.0 * REAL_UNIT * m) + REAL_TINY;
    bool miss = most_negative(u, v, w) < -band && most_positive(u, v, w) > band;
    // Signs that are all certain and no miss are one sign.
    bool certain = smaller(abs(u), smaller(abs(v), abs(w))) > band && !miss;

    real za = sheared(s.z, a), zb = sheared(s.z, b), zc = sheared(s.z, c);
    real spread = abs(zb - za) + abs(zc - za);
    real slack = (abs(za) + spread) * (32.0 * REAL_UNIT) + LOST;
    precise real det = (u + v) + w;
    precise real depth = (u * za + v * zb) + w * zc;
    precise real inverse = 1.0 / det;
    precise real t = depth * inverse;
    real share = abs(inverse) * (6.0 * band);
    bool tight = certain && share < 0.375;
    real middle = tight ? t : za, radius = (tight ? share : 1.0) * spread + slack;
    // Beyond REAL_CUBE_LARGE products may overflow.
    bool sane = m < REAL_CUBE_LARGE;
    real lo = sane ? middle - radius : -REAL_MAX, hi = sane ? middle + radius : REAL_MAX;
    return verdict(real3(t, v * inverse, w * inverse), lo, miss ? -INFINITY : hi, certain && sane);
}

// `root` -1 or +1: the nearer or the farther crossing.
verdict sphere_exact(real3 o, real3 d, real3 center, real radius, real root_sign) {
    precise real3 l = center - o;
    real3 x = cross_precise(l, d);
    real3 reach = abs(l.yzx * d.zxy) + abs(l.zxy * d.yzx);
    real a = dot_precise(d, d);
    precise real r2a = radius * radius * a;
    real x2 = dot_precise(x, x);
    precise real f = r2a - x2;
    real f_error = (dot(abs(x), reach) + x2 + r2a) * (9.0 * REAL_UNIT) + dot(reach, reach) * (34.0 * REAL_UNIT * REAL_UNIT) + REAL_TINY;
    if (f < -f_error) return certain_miss();
    real b = dot_precise(l, d);
    real b_error = dot(abs(l), abs(d)) * (5.0 * REAL_UNIT);
    bool certain = f > f_error;
    real root_lo = sqrt(max(f - f_error, 0.0)) * (1.0 - 13.0 * REAL_UNIT), root_hi = sqrt(f + f_error) * (1.0 + 13.0 * REAL_UNIT);
    real lo = root_sign < 0.0 ? b - root_hi : b + root_lo;
    real hi = root_sign < 0.0 ? b - root_lo : b + root_hi;
    real slack = b_error + (abs(b) + root_hi) * (10.0 * REAL_UNIT) + LOST;
    real inverse = 1.0 / a;
    real middle = root_sign < 0.0 ? b - sqrt(max(f, 0.0)) : b + sqrt(max(f, 0.0));
    lo = (lo - slack) * inverse;
    hi = (hi + slack) * inverse;
    bool sane = lo <= hi && max(largest(l), radius) < REAL_SQRT_LARGE;
    return verdict(real3(middle * inverse, 0.0, 0.0), sane ? lo - abs(lo) * (17.0 * REAL_UNIT) : -REAL_MAX, sane ? hi + abs(hi) * (17.0 * REAL_UNIT) : REAL_MAX, certain && sane);
}

// The other crossing of a sphere on which the ray starts by definition: t = 2 (l·d)/(d·d).
verdict sphere_exact_again(real3 o, real3 d, real3 center) {
    precise real3 l = center - o;
    real inverse = 1.0 / dot_precise(d, d);
    real t = 2.0 * dot_precise(l, d) * inverse;
    real error = 2.0 * dot(abs(l), abs(d)) * inverse * (14.0 * REAL_UNIT) + LOST;
    bool sane = largest(l) < REAL_LARGE;
    return verdict(real3(t, 0.0, 0.0), sane ? t - error : -REAL_MAX, sane ? t + error : REAL_MAX, sane);
}

#endif
