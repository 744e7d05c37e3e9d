// t, u and v of a hit to within 1 ulp of fp32, in fp64, once per ray; or false, where even fp64's error bounds are too wide for that.
//
// U = 2^-53. Triangle: f(p, q) = d·(E×B), E = q-p, B = q-o. With components up to |d|, e and m the products' absolute sum is at most 6 |d| e m, and there are eight
// roundings on the way of each: off by less than 48 U |d| e m < 2^-47 |d| e m. The same way A·N by 2^-47 m e², d·N by 2^-47 |d| e². Demanding 2^-29 relative of
// each leaves every quotient right to 2^-27, an eighth of an fp32 ulp before its rounding.
// Things smaller than SMALLEST may be of coordinates that lost bits.
// Sphere: F, b, |l|² - r² as in tier_exact.glsl with U for u; the root that would cancel is taken as (|l|² - r²)/q.
#ifndef REFINE_FP64_GLSL
#define REFINE_FP64_GLSL

const double ENOUGH = 1.862645149230957e-9lf; // 2^-29
const double SMALLEST = 3.2e-27lf; // 2^-88: 2^-29 of it is still 2^9 times what a flushed denormal loses

dvec3 cross_double(dvec3 a, dvec3 b) {
    precise dvec3 value = a.yzx * b.zxy - a.zxy * b.yzx;
    return value;
}

double dot_double(dvec3 a, dvec3 b) {
    precise double value = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return value;
}

double largest_double(dvec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

bool refine_triangle(dvec3 origin, dvec3 direction, vec3 v0, vec3 v1, vec3 v2, out dvec3 tuv) {
    dvec3 p0 = dvec3(v0), p1 = dvec3(v1), p2 = dvec3(v2);
    precise dvec3 a = p0 - origin, b = p1 - origin, c = p2 - origin;
    precise dvec3 e01 = p1 - p0, e12 = p2 - p1, e20 = p0 - p2;
    double u = dot_double(direction, cross_double(e12, c));
    double v = dot_double(direction, cross_double(e20, a));
    double w = dot_double(direction, cross_double(e01, b));
    double d_sum = u + v + w;
    dvec3 n = cross_double(e01, e20);
    double t = dot_double(a, n), d_n = dot_double(direction, n);
    tuv = dvec3(t / d_n, v / d_sum, w / d_sum);

    double m = max(largest_double(a), max(largest_double(b), largest_double(c)));
    double e = max(largest_double(e01), max(largest_double(e12), largest_double(e20)));
    const double bound = 1.4210854715202004e-14lf; // 2^-46
    double n_error = bound * e * e, reach = largest_double(direction), edge_error = bound * reach * e * m;
    return edge_error <= ENOUGH * min(abs(v), min(abs(w), abs(d_sum) / 3.0lf)) && n_error * m <= ENOUGH * abs(t) &&
           n_error * reach <= ENOUGH * abs(d_n) && min(m, e) > SMALLEST;
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
    return min(r, l2) > SMALLEST && f > 2.0lf * f_error && q_error <= ENOUGH * q && (!cancels || 6.0e-16lf * (l2 + r * r) <= ENOUGH * abs(c));
}

#endif
