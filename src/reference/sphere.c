// Ray against sphere.
//
// With l = c-o, b = l·d, a = d·d, F = r²a - |l×d|² and K = |l|²-r²: the roots are t = (b ± √F)/a; their product is K/a, since b²-F = aK. So
// with q = b + s·√F, s the sign of b, in which nothing cancels, they are q/a and K/q (Press et al., Numerical Recipes, 5.6).
//
// Errors in fp64, u = 2^-53; nothing under- or overflows (degree 4: 2^-932 to 2^532). l carries u. a: 3u of itself. b: 4u of Σ|l_i·d_i|. K:
// 6u of |l|² + r². F: with X = l×d and M_i = |l_j·d_k| + |l_k·d_j|, X̂_i is off by 3u·M_i, so X̂_i² by 6u·|X̂_i|M_i + 9u²·M_i²; squaring
// and adding costs 3u·ΣX̂², r²a 5u of itself, the last difference u of both. In all at most 8u·(Σ|X̂_i|M̂_i + ΣX̂_i² + r²a) + 32u²·ΣM̂_i².
#include "reference/predicates.h"

#define U 0x1p-53

struct sphere_terms {
    struct interval a, b, f, k;
};
struct sphere_exact {
    struct exact a, b, f, k;
};

static struct interval discriminant_fp64(const double l[3], const double d[3], double r2a) {
    double squares = 0, mixed = 0, magnitudes = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double left = l[j] * d[k], right = l[k] * d[j];
        double x = left - right, m = fabs(left) + fabs(right);
        squares += x * x;
        mixed += fabs(x) * m;
        magnitudes += m * m;
    }
    return interval_around(r2a - squares, 8 * U * (mixed + squares + r2a) + 32 * U * U * magnitudes);
}

static struct sphere_terms terms_fp64(const struct ref_ray *ray, const float center[3], double radius) {
    double l[3], a = 0, b = 0, magnitude = 0, l2 = 0;
    for (int i = 0; i < 3; i++) {
        l[i] = center[i] - ray->o[i];
        a += ray->d[i] * ray->d[i];
        b += l[i] * ray->d[i];
        magnitude += fabs(l[i] * ray->d[i]);
        l2 += l[i] * l[i];
    }
    double r2 = radius * radius;
    return (struct sphere_terms){
        .a = interval_around(a, 4 * U * a),
        .b = interval_around(b, 5 * U * magnitude),
        .f = discriminant_fp64(l, ray->d, r2 * a),
        .k = interval_around(l2 - r2, 8 * U * (l2 + r2)),
    };
}

static void terms_exact(struct sphere_exact *out, const struct ref_ray *ray, const float center[3], double radius) {
    struct exact c[3], o[3], l[3], d[3], x[3], r2, square;
    for (int i = 0; i < 3; i++) exact_set(&c[i], center[i]);
    exact_set3(o, ray->o);
    exact_set3(d, ray->d);
    exact_sub3(l, c, o);
    exact_dot(&out->a, d, d);
    exact_dot(&out->b, l, d);
    exact_set(&r2, radius);
    exact_mul(&r2, &r2, &r2);
    exact_dot(&out->k, l, l);
    exact_sub(&out->k, &out->k, &r2);
    exact_cross(x, l, d);
    exact_dot(&square, x, x);
    exact_mul(&out->f, &r2, &out->a);
    exact_sub(&out->f, &out->f, &square);
}

static struct sphere_terms intervals_of(const struct sphere_exact *exact) {
    return (struct sphere_terms){exact_interval(&exact->a), exact_interval(&exact->b), exact_interval(&exact->f),
                                 exact_interval(&exact->k)};
}

// Where |b| is below its error, either sign of q serves: only the accuracy depends on it.
static struct interval root_interval(const struct sphere_terms *terms, enum sphere_root root) {
    if (root == ROOT_OTHER) return interval_div(interval_add(terms->b, terms->b), terms->a);
    struct interval half_chord = interval_sqrt(terms->f), back = interval_negate(half_chord);
    bool forward = interval_mid(terms->b) >= 0;
    struct interval q = interval_add(terms->b, forward ? half_chord : back);
    if (forward == (root == ROOT_FAR)) return interval_div(q, terms->a);
    if (interval_sign(q) != 0) return interval_div(terms->k, q);
    return interval_div(interval_add(terms->b, root == ROOT_FAR ? half_chord : back), terms->a);
}

// t of `root`; computed again from the exact terms where fp64 says too little of it.
static void set_root(struct crossing *out, struct ref_ray *ray, const struct sphere_terms *terms, enum sphere_root root) {
    out->root = root;
    out->t = root_interval(terms, root);
    if (interval_narrow(out->t, 0)) return;
    ray->undecided++;
    struct sphere_exact exact;
    terms_exact(&exact, ray, out->center, out->radius);
    struct sphere_terms narrow = intervals_of(&exact);
    out->t = root_interval(&narrow, root);
}

// Whether F >= 0.
static bool line_meets(struct ref_ray *ray, struct interval f, const float center[3], float radius) {
    if (f.hi < 0) return false;
    if (f.lo > 0) return true;
    ray->undecided++;
    struct sphere_exact exact;
    terms_exact(&exact, ray, center, radius);
    return exact.f.sign >= 0;
}

bool sphere_cross(struct crossing *out, struct ref_ray *ray, const float center[3], float radius) {
    struct sphere_terms terms = terms_fp64(ray, center, radius);
    if (!line_meets(ray, terms.f, center, radius)) return false;
    *out = (struct crossing){.kind = CROSSING_SPHERE, .center = {center[0], center[1], center[2]}, .radius = radius};
    set_root(out, ray, &terms, ROOT_NEAR);
    if (crossing_inside(ray, out)) return true;
    set_root(out, ray, &terms, ROOT_FAR);
    return crossing_inside(ray, out);
}

bool sphere_cross_again(struct crossing *out, struct ref_ray *ray, const float center[3], float radius) {
    struct sphere_terms terms = terms_fp64(ray, center, radius);
    *out = (struct crossing){.kind = CROSSING_SPHERE, .center = {center[0], center[1], center[2]}, .radius = radius};
    set_root(out, ray, &terms, ROOT_OTHER);
    return crossing_inside(ray, out);
}

void sphere_t(struct fraction *t, const struct ref_ray *ray, const struct crossing *crossing) {
    struct sphere_exact exact;
    terms_exact(&exact, ray, crossing->center, crossing->radius);
    t->p = exact.b;
    t->m = exact.a;
    t->f = exact.f;
    t->root = (int)crossing->root;
    if (crossing->root == ROOT_OTHER) exact_add(&t->p, &t->p, &t->p);
}
