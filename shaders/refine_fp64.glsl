// t, u and v of a hit to within 1 ulp of fp32, in fp64, once per ray; or false, where even fp64's error bounds are too wide for that.
//
// U = 2^-53. Triangle: the formulas of tier_fast.glsl from a start s = o + t' d - v0 near the hit, t' the t found so far, in 24 bits: its product
// with d, fp32, is exact, so that what is far away has cancelled before anything is rounded. With |d| < 2, edges up to e and s up to S (largest
// components): s·(d×e2), d·(s×e1) and e1·(d×e2) are sums of products up to 12 e S or 12 e², off by seven roundings each, e2·(s×e1) one of
// up to 6 e² S, off by eight: below 2^-46 e S, 2^-46 e² and 2^-47 e² S. Where o - v0, up to m, had to be rounded, s is off by U m more, which m/8
// more of S covers. Demanding 2^-29 relative of each, and that t' is not off by more than t, leaves every result right to 2^-27, an eighth of
// an fp32 ulp before its rounding. Flushing may have taken 2^-126 from a coordinate: little beside the bounds where e > SMALLEST and
// SMALLEST is added to S.
// Sphere: F, b, |l|² - r² as in tier_exact.glsl with U for u; the root that would cancel is taken as (|l|² - r²)/q. Things smaller than
// SMALLEST_SPHERE may be of coordinates that lost bits.
#ifndef REFINE_FP64_GLSL
#define REFINE_FP64_GLSL

const double ENOUGH = 1.862645149230957e-9lf; // 2^-29
const float SMALLEST = 9.094947e-13; // 2^-40
const double SMALLEST_SPHERE = 3.2e-27lf; // 2^-88: 2^-29 of it is still 2^9 times what a flushed denormal loses

dvec3 cross_double(dvec3 a, dvec3 b) {
    precise dvec3 value = a.yzx * b.zxy - a.zxy * b.yzx;
    return value;
}

double dot_double(dvec3 a, dvec3 b) {
    precise double value = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return value;
}

float largest_float(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// t with the 24 significant bits of an fp32 number, by its bits: conversions there and back are not safe from being taken out.
double shortened(double t) {
    uvec2 bits = unpackDouble2x32(t);
    return packDouble2x32(uvec2(bits.x & 0xe0000000u, bits.y));
}

// `direction`: fp32 numbers, the largest in [1, 2). `t_near`: roughly t.
bool refine_triangle(dvec3 origin, dvec3 direction, vec3 v0, vec3 v1, vec3 v2, double t_near, out dvec3 tuv) {
    double t = shortened(t_near);
    dvec3 p0 = dvec3(v0);
    precise dvec3 e1 = dvec3(v1) - p0, e2 = dvec3(v2) - p0;
    precise dvec3 from = origin - p0, origin_again = from + p0, p0_again = origin - from;
    precise dvec3 start = from + t * direction;
    dvec3 p = cross_double(direction, e2), q = cross_double(start, e1);
    double d = dot_double(e1, p), u = dot_double(start, p), v = dot_double(direction, q), correction = dot_double(e2, q);
    double inverse = 1.0lf / d;
    precise double moved = correction * inverse;
    precise double sum = t + moved;
    tuv = dvec3(sum, u * inverse, v * inverse);

    // One of the two differences is exact, whichever is larger.
    bool rounded = origin_again != origin || p0_again != p0;
    float e = largest_float(max(abs(vec3(e1)), abs(vec3(e2))));
    float s = largest_float(vec3(start)) + (rounded ? 0.125 * largest_float(vec3(from)) : 0.0) + SMALLEST;
    const double bound = 7.62939453125e-06lf; // 2^-46 / 2^-29
    double edge_error = bound * double(e * s), d_error = bound * double(e * e);
    return edge_error <= min(abs(u), abs(v)) && d_error <= abs(d) && 0.5lf * edge_error * double(e) <= abs(sum * d) &&
           abs(moved) <= abs(sum) && e > SMALLEST;
}

// `farther`: the root with + before √F.
bool refine_sphere(dvec3 origin, dvec3 direction, vec3 center, float radius, bool farther, out dvec3 tuv) {
    precise dvec3 l = dvec3(center) - origin;
    dvec3 x = cross_double(l, direction), reach = abs(l.yzx * direction.zxy) + abs(l.zxy * direction.yzx);
    double a = dot_double(direction, direction), b = dot_double(l, direction), r = double(radius);
    double x2 = dot_double(x, x), l2 = dot_double(l, l);
    precise double f = r * r * a - x2;
    precise double c = l2 - r * r;
    double root = sqrt(max(f, 0.0lf));
    double f_error = 1.0e-15lf * (dot_double(abs(x), reach) + x2 + r * r * a) + 4.0e-31lf * dot_double(reach, reach);
    double q = abs(b) + root;
    bool cancels = farther ? b < 0.0lf : b > 0.0lf;
    double value = cancels ? c / q : q / a;
    bool negative = b < 0.0lf || (b == 0.0lf && !farther);
    tuv = dvec3(negative ? -value : value, 0.0lf, 0.0lf);
    double q_error = 6.0e-16lf * dot_double(abs(l), abs(direction)) + f_error / max(root, 1e-300lf);
    return min(r, l2) > SMALLEST_SPHERE && f > 2.0lf * f_error && q_error <= ENOUGH * q && (!cancels || 6.0e-16lf * (l2 + r * r) <= ENOUGH * abs(c));
}

#endif
