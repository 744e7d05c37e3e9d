// Ray against triangle.
//
// For an edge from p to q, f(p,q) = d·((q-o)×(p-o)). With E = q-p and B = q-o this is d·(E×B), as p-o = B-E: the form whose error grows
// with |E||B| and not with |B|². U = f(v1,v2), V = f(v2,v0), W = f(v0,v1), D = U+V+W. With N = (v1-v0)×(v2-v0) and A = v0-o,
// T = A·N and S = d·N = -D (mind the sign): t = T/S, u = V/D, v = W/D.
//
// Error in fp64, u = 2^-53. Differences are rounded once (u), products of two of them carry 3u, their difference 4u, times d_i 5u, and the
// sum of three at most 7u: |f̂-f| <= ((1+u)^7 - 1)·P where P is the same sum over absolute values; P̂ differs from P as little, so that
// 8u·P̂ is a bound. T has one difference more: 10u·P̂. Nothing under- or overflows: numbers as exact_holds says have products of degree 3
// between 2^-699 and 2^400.
#include "reference/predicates.h"

#include <string.h>

#define U 0x1p-53

static void sub3(double out[3], const float *a, const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

static void sub3_float(double out[3], const float *a, const float *b) {
    for (int i = 0; i < 3; i++) out[i] = (double)a[i] - b[i];
}

// x·(a×b), and in *magnitude the same sum over absolute values.
static double triple(double *magnitude, const double x[3], const double a[3], const double b[3]) {
    double sum = 0;
    *magnitude = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double left = a[j] * b[k], right = a[k] * b[j];
        sum += x[i] * (left - right);
        *magnitude += fabs(x[i]) * (fabs(left) + fabs(right));
    }
    return sum;
}

static struct interval edge_fp64(const struct ref_ray *ray, const float *p, const float *q) {
    double e[3], b[3], magnitude;
    sub3_float(e, q, p);
    sub3(b, q, ray->o);
    double f = triple(&magnitude, ray->d, e, b);
    return interval_around(f, 8 * U * magnitude);
}

static void set3_float(struct exact out[3], const float *v) {
    for (int i = 0; i < 3; i++) exact_set(&out[i], v[i]);
}

// v - w for two vertices.
static void edge_exact(struct exact out[3], const float *v, const float *w) {
    struct exact a[3], b[3];
    set3_float(a, v);
    set3_float(b, w);
    exact_sub3(out, a, b);
}

static void from_origin_exact(struct exact out[3], const float *v, const double o[3]) {
    struct exact a[3], b[3];
    set3_float(a, v);
    exact_set3(b, o);
    exact_sub3(out, a, b);
}

static void edge_function_exact(struct exact *f, const struct ref_ray *ray, const float *p, const float *q) {
    struct exact e[3], b[3], n[3], d[3];
    edge_exact(e, q, p);
    from_origin_exact(b, q, ray->o);
    exact_cross(n, e, b);
    exact_set3(d, ray->d);
    exact_dot(f, d, n);
}

// The sign of f(p,q), where a zero has the sign of its limit when o moves to o + (ε, ε², ε³): the gradient of f along o is (q-p)×d, and its
// first component that is not zero decides. 0 if there is none: the edge is parallel to the ray, D is 0.
static int edge_sign_exact(const struct ref_ray *ray, const float *p, const float *q) {
    struct exact f, e[3], d[3], gradient[3];
    edge_function_exact(&f, ray, p, q);
    if (f.sign != 0) return f.sign;
    edge_exact(e, q, p);
    exact_set3(d, ray->d);
    exact_cross(gradient, e, d);
    for (int i = 0; i < 3; i++) {
        if (gradient[i].sign != 0) return gradient[i].sign;
    }
    return 0;
}

// The common sign of U, V and W, and of D as their sum; 0 for a miss.
static int common_sign(struct ref_ray *ray, const float *const v[3]) {
    int sign[3], common = 0;
    for (int i = 0; i < 3; i++) {
        sign[i] = interval_sign(edge_fp64(ray, v[(i + 1) % 3], v[(i + 2) % 3]));
        if (sign[i] * common < 0) return 0;
        if (sign[i] != 0) common = sign[i];
    }
    for (int i = 0; i < 3; i++) {
        if (sign[i] != 0) continue;
        ray->undecided++;
        sign[i] = edge_sign_exact(ray, v[(i + 1) % 3], v[(i + 2) % 3]);
        if (sign[i] == 0 || sign[i] * common < 0) return 0;
        common = sign[i];
    }
    return common;
}

// T and S.
struct depth {
    struct interval t, s;
};
struct depth_exact {
    struct exact t, s;
};

static struct depth depth_fp64(const struct ref_ray *ray, const float *const v[3]) {
    double a[3], e1[3], e2[3], magnitude_t, magnitude_s;
    sub3(a, v[0], ray->o);
    sub3_float(e1, v[1], v[0]);
    sub3_float(e2, v[2], v[0]);
    double t = triple(&magnitude_t, a, e1, e2), s = triple(&magnitude_s, ray->d, e1, e2);
    return (struct depth){interval_around(t, 10 * U * magnitude_t), interval_around(s, 8 * U * magnitude_s)};
}

static void normal_exact(struct exact n[3], const float *const v[3]) {
    struct exact e1[3], e2[3];
    edge_exact(e1, v[1], v[0]);
    edge_exact(e2, v[2], v[0]);
    exact_cross(n, e1, e2);
}

static void depth_exact(struct depth_exact *out, const struct ref_ray *ray, const float *const v[3]) {
    struct exact n[3], a[3], d[3];
    normal_exact(n, v);
    from_origin_exact(a, v[0], ray->o);
    exact_set3(d, ray->d);
    exact_dot(&out->t, a, n);
    exact_dot(&out->s, d, n);
}

bool triangle_cross(struct crossing *out, struct ref_ray *ray, const float *const v[3]) {
    int sign = common_sign(ray, v);
    if (sign == 0) return false;
    *out = (struct crossing){.kind = CROSSING_TRIANGLE, .side = -sign};
    for (int i = 0; i < 3; i++) memcpy(out->v[i], v[i], sizeof out->v[i]);
    struct depth depth = depth_fp64(ray, v);
    out->t = interval_div(depth.t, depth.s);
    if (!interval_narrow(out->t, 0)) {
        ray->undecided++;
        struct depth_exact exact;
        depth_exact(&exact, ray, v);
        out->t = interval_div(exact_interval(&exact.t), exact_interval(&exact.s));
    }
    return crossing_inside(ray, out);
}

// numerator / denominator, brought to a denominator above 0.
static void quotient(struct fraction *out, const struct exact *numerator, const struct exact *denominator) {
    out->p = *numerator;
    out->m = *denominator;
    out->root = 0;
    if (out->m.sign < 0) {
        exact_negate(&out->p);
        exact_negate(&out->m);
    }
}

struct vertices {
    const float *v[3];
};

static struct vertices vertices_of(const struct crossing *crossing) { return (struct vertices){{crossing->v[0], crossing->v[1], crossing->v[2]}}; }

void triangle_t(struct fraction *t, const struct ref_ray *ray, const struct crossing *crossing) {
    struct depth_exact depth;
    depth_exact(&depth, ray, vertices_of(crossing).v);
    quotient(t, &depth.t, &depth.s);
}

// The weight of vertex number `vertex`.
static void weight_exact(struct fraction *out, const struct ref_ray *ray, const struct crossing *crossing, int vertex) {
    struct depth_exact depth;
    struct exact f;
    depth_exact(&depth, ray, vertices_of(crossing).v);
    edge_function_exact(&f, ray, crossing->v[(vertex + 1) % 3], crossing->v[(vertex + 2) % 3]);
    exact_negate(&f);
    quotient(out, &f, &depth.s);
}

void crossing_u(struct fraction *u, const struct ref_ray *ray, const struct crossing *crossing) { weight_exact(u, ray, crossing, 1); }
void crossing_v(struct fraction *v, const struct ref_ray *ray, const struct crossing *crossing) { weight_exact(v, ray, crossing, 2); }

static struct interval weight(const struct ref_ray *ray, const struct crossing *crossing, int vertex) {
    struct interval d = interval_negate(depth_fp64(ray, vertices_of(crossing).v).s);
    struct interval f = edge_fp64(ray, crossing->v[(vertex + 1) % 3], crossing->v[(vertex + 2) % 3]);
    struct interval fast = interval_div(f, d);
    if (interval_narrow(fast, 1)) return fast;
    struct fraction exact;
    weight_exact(&exact, ray, crossing, vertex);
    return interval_div(exact_interval(&exact.p), exact_interval(&exact.m));
}

void triangle_weights(struct interval *u, struct interval *v, const struct ref_ray *ray, const struct crossing *crossing) {
    *u = weight(ray, crossing, 1);
    *v = weight(ray, crossing, 2);
}

// e1×e2; false if a component is off by more than 2^-30 of the largest: each carries 4u of the sum over absolute values.
static bool normal_fp64(double n[3], const float *const v[3]) {
    double e1[3], e2[3], largest = 0, error = 0;
    sub3_float(e1, v[1], v[0]);
    sub3_float(e2, v[2], v[0]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double left = e1[j] * e2[k], right = e1[k] * e2[j];
        n[i] = left - right;
        largest = fmax(largest, fabs(n[i]));
        error = fmax(error, 5 * U * (fabs(left) + fabs(right)));
    }
    return error <= 0x1p-30 * largest;
}

void triangle_normal(double normal[3], const float *const v[3]) {
    if (!normal_fp64(normal, v)) {
        struct exact n[3];
        normal_exact(n, v);
        for (int i = 0; i < 3; i++) normal[i] = interval_mid(exact_interval(&n[i]));
    }
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int i = 0; i < 3; i++) normal[i] = length > 0 ? normal[i] / length : 0;
}

bool triangle_in_plane(const float *const v[3], const float *const w[3]) {
    double e1[3], e2[3], a[3], magnitude;
    sub3_float(e1, v[1], v[0]);
    sub3_float(e2, v[2], v[0]);
    for (int i = 0; i < 3; i++) {
        sub3_float(a, w[i], v[0]);
        if (fabs(triple(&magnitude, a, e1, e2)) > 10 * U * magnitude) return false;
    }
    for (int i = 0; i < 3; i++) {
        struct exact n[3], b[3], distance;
        normal_exact(n, v);
        edge_exact(b, w[i], v[0]);
        exact_dot(&distance, b, n);
        if (distance.sign != 0) return false;
    }
    return true;
}
