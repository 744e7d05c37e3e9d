#include "reference/fraction.h"

// The sign of p + q·√f, f >= 0: where the two terms differ in sign, the one with the larger square decides.
static int sign_one_root(const struct exact *p, const struct exact *q, const struct exact *f) {
    int second = q->sign * f->sign;
    if (p->sign * second >= 0) return p->sign ? p->sign : second;
    struct exact left, right;
    exact_mul(&left, p, p);
    exact_mul(&right, q, q);
    exact_mul(&right, &right, f);
    return p->sign * exact_compare(&left, &right);
}

// The sign of p + q·√f + r·√g: the same idea, (p + q·√f)² = (p² + q²f) + 2pq·√f against r²g.
static int sign_two_roots(const struct exact *p, const struct exact *q, const struct exact *f, const struct exact *r,
                          const struct exact *g) {
    int first = sign_one_root(p, q, f), second = r->sign * g->sign;
    if (first * second >= 0) return first ? first : second;
    struct exact rational, square, cross;
    exact_mul(&rational, p, p);
    exact_mul(&square, q, q);
    exact_mul(&square, &square, f);
    exact_add(&rational, &rational, &square);
    exact_mul(&square, r, r);
    exact_mul(&square, &square, g);
    exact_sub(&rational, &rational, &square);
    exact_mul(&cross, p, q);
    exact_add(&cross, &cross, &cross);
    return first * sign_one_root(&rational, &cross, f);
}

// a - b times both denominators, which are positive: (p_a·m_b - p_b·m_a) + root_a·m_b·√f_a - root_b·m_a·√f_b. Equal denominators cancel:
// all spheres have the same, d·d, and the degree stays at 8.
int fraction_compare(const struct fraction *a, const struct fraction *b) {
    struct exact p, other, scale_a, scale_b;
    exact_set(&scale_a, 1);
    exact_set(&scale_b, 1);
    if (exact_compare(&a->m, &b->m) != 0) {
        scale_a = b->m;
        scale_b = a->m;
    }
    exact_mul(&p, &a->p, &scale_a);
    exact_mul(&other, &b->p, &scale_b);
    exact_sub(&p, &p, &other);
    if (a->root < 0) exact_negate(&scale_a);
    if (b->root > 0) exact_negate(&scale_b);
    if (a->root == 0 && b->root == 0) return p.sign;
    if (b->root == 0) return sign_one_root(&p, &scale_a, &a->f);
    if (a->root == 0) return sign_one_root(&p, &scale_b, &b->f);
    return sign_two_roots(&p, &scale_a, &a->f, &scale_b, &b->f);
}

int fraction_compare_number(const struct fraction *a, double x) {
    struct fraction b = {.root = 0};
    exact_set(&b.p, x);
    exact_set(&b.m, 1);
    return fraction_compare(a, &b);
}
