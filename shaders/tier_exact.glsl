// Tier "exact", first stage: the robust tier's formulas with a bound on their error beside them. What the bounds leave open is a maybe, and is resolved elsewhere; what
// they decide agrees with exact arithmetic on the fp32 inputs.
//
// u = 2^-24. Each + - × is right to u, Vulkan's ÷ to 5 u (2.5 ulp); `precise` keeps the order, and fusing a product into a sum only takes roundings away.
//
// Triangle. A vertex relative to the origin, A = v - o, is right to u. The shear's entry S = -d_x · (1/d_z) is right to 6.1 u and at most 1, so that a sheared
// coordinate x = A_x + S·A_z is off by at most e = u(|A_x| + 8.1|A_z| + |x|) <= 11.2 u m, m the largest |component| of any A. An edge function p_x q_y - p_y q_x
// of coordinates up to M is off by 4 e M + 2 e² from its factors and by 4 u M² <= 8 u m M from its own roundings (M <= 2m): together below
// 53 u m (M + 12 u m). BAND = 64 u m (M + 16 u m) + 2^-120, the last for underflow.
// t is the mean of the vertices' depths z (right to 7.1 u) weighted by the edge functions: a weight's error moves t by the spread of z at most:
// |t error| <= 3 BAND spread/(|D| - 3 BAND) + 17.1 u Z, Z the largest |z|; used with 4 and 32. A triangle that is hit at all is hit between its smallest and largest z.
//
// Sphere. X = l×d, M_i = |l_j d_k| + |l_k d_j|: F = r²(d·d) - |X|² is off by at most 8 u Σ|X_i|M_i + 8 u(|X|² + r² d²) + 32 u² ΣM_i².
// b = l·d is off by 4.1 u Σ|l_i d_i|; t = (b ± √F)/(d·d).
#ifndef TIER_EXACT_GLSL
#define TIER_EXACT_GLSL
#include "tier_robust.glsl"

// What the first stage says of a ray and a primitive. If it is hit, then at a t in [lo, hi]; `certain` says that it is.
// A certain miss has lo = +inf, hi = -inf.
struct verdict {
    vec3 tuv;
    float lo, hi;
    bool certain;
};

const verdict MISS = verdict(vec3(0.0), 3.4e38, -3.4e38, true);

float largest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

verdict triangle_exact(vec3 o, shear s, vec3 v0, vec3 v1, vec3 v2) {
    precise vec3 a = v0 - o, b = v1 - o, c = v2 - o;
    vec2 pa = vec2(sheared(s.x, a), sheared(s.y, a));
    vec2 pb = vec2(sheared(s.x, b), sheared(s.y, b));
    vec2 pc = vec2(sheared(s.x, c), sheared(s.y, c));
    float u = edge_function(pc, pb), v = edge_function(pa, pc), w = edge_function(pb, pa);

    vec3 reach = max(abs(a), max(abs(b), abs(c)));
    float m = max(reach.x, max(reach.y, reach.z));
    vec2 extent = max(abs(pa), max(abs(pb), abs(pc)));
    float band = 3.8146973e-6 * m * (max(extent.x, extent.y) + 9.5367432e-7 * m) + 7.5231638e-37;

    float low = min(u, min(v, w)), high = max(u, max(v, w));
    if (low < -band && high > band) return MISS;
    float za = sheared(s.z, a), zb = sheared(s.z, b), zc = sheared(s.z, c);
    float nearest = min(za, min(zb, zc)), farthest = max(za, max(zb, zc));
    float slack = max(abs(nearest), abs(farthest)) * 1.9073486e-6; // 32 u Z
    precise float det = (u + v) + w;
    precise float depth = (u * za + v * zb) + w * zc;
    float sure = abs(det) - 4.0 * band;
    bool certain = (low > band || high < -band) && sure > 0.0;
    precise float inverse = 1.0 / det;
    precise float t = depth * inverse;
    float error = certain ? 4.0 * band * (farthest - nearest) / sure * 1.0001 + slack : INFINITY;
    // NaN or overflow anywhere fails a comparison, and leaves the interval that holds everything.
    bool tight = t - error >= nearest - slack && t + error <= farthest + slack;
    float lo = tight ? t - error : nearest - slack, hi = tight ? t + error : farthest + slack;
    bool sane = lo <= hi && m < 1e18;
    return verdict(vec3(t, v * inverse, w * inverse), sane ? lo : -3.4e38, sane ? hi : 3.4e38, certain && sane);
}

// `root` -1 or +1: the nearer or the farther crossing.
verdict sphere_exact(vec3 o, vec3 d, vec3 center, float radius, float root_sign) {
    precise vec3 l = center - o;
    vec3 x = cross_precise(l, d);
    vec3 reach = abs(l.yzx * d.zxy) + abs(l.zxy * d.yzx);
    float a = dot_precise(d, d);
    precise float r2a = radius * radius * a;
    float x2 = dot_precise(x, x);
    precise float f = r2a - x2;
    float f_error = (dot(abs(x), reach) + x2 + r2a) * 5.4e-7 + dot(reach, reach) * 1.2e-13 + 7.5231638e-37; // 9 u, 34 u²
    if (f < -f_error) return MISS;
    float b = dot_precise(l, d);
    float b_error = dot(abs(l), abs(d)) * 2.98e-7; // 5 u
    bool certain = f > f_error;
    float root_lo = sqrt(max(f - f_error, 0.0)) * 0.9999992, root_hi = sqrt(f + f_error) * 1.0000008;
    float lo = root_sign < 0.0 ? b - root_hi : b + root_lo;
    float hi = root_sign < 0.0 ? b - root_lo : b + root_hi;
    float slack = b_error + (abs(b) + root_hi) * 6e-7;
    float inverse = 1.0 / a;
    float middle = root_sign < 0.0 ? b - sqrt(max(f, 0.0)) : b + sqrt(max(f, 0.0));
    lo = (lo - slack) * inverse;
    hi = (hi + slack) * inverse;
    bool sane = lo <= hi && max(largest(l), radius) < 1e9;
    return verdict(vec3(middle * inverse, 0.0, 0.0), sane ? lo - abs(lo) * 1e-6 : -3.4e38, sane ? hi + abs(hi) * 1e-6 : 3.4e38, certain && sane);
}

// The other crossing of a sphere on which the ray starts by definition: t = 2 (l·d)/(d·d).
verdict sphere_exact_again(vec3 o, vec3 d, vec3 center) {
    precise vec3 l = center - o;
    float inverse = 1.0 / dot_precise(d, d);
    float t = 2.0 * dot_precise(l, d) * inverse;
    float error = 2.0 * dot(abs(l), abs(d)) * inverse * 8e-7 + 7.5231638e-37;
    bool sane = largest(l) < 1e18;
    return verdict(vec3(t, 0.0, 0.0), sane ? t - error : -3.4e38, sane ? t + error : 3.4e38, sane);
}

#endif
