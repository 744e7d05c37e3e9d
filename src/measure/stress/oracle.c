#include "measure/stress/oracle.h"

#include <float.h>
#include <gmp.h>
#include <math.h>
#include <stdlib.h>

#include "base/threads.h"

#define LOWEST_BIT 149 // fp32 numbers are multiples of 2^-149
#define REAL_BITS 4096 // of the one division and root behind a reported t: p - √f may lose some 1200 bits

typedef mpz_t vec[3];

// ---------------------------------------------------------------------------------------------------------------- vectors

static void vec_init(vec a) { mpz_inits(a[0], a[1], a[2], (mpz_ptr)0); }
static void vec_clear(vec a) { mpz_clears(a[0], a[1], a[2], (mpz_ptr)0); }

static void set(mpz_t out, float x) { mpz_set_d(out, ldexp((double)x, LOWEST_BIT)); }

static void vec_set(vec out, const float x[3]) {
    for (int i = 0; i < 3; i++) set(out[i], x[i]);
}

static void vec_sub(vec out, const vec a, const vec b) {
    for (int i = 0; i < 3; i++) mpz_sub(out[i], a[i], b[i]);
}

// `out` is neither a nor b.
static void vec_cross(vec out, const vec a, const vec b) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(out[i], a[j], b[k]);
        mpz_submul(out[i], a[k], b[j]);
    }
}

static void vec_dot(mpz_t out, const vec a, const vec b) {
    mpz_mul(out, a[0], b[0]);
    mpz_addmul(out, a[1], b[1]);
    mpz_addmul(out, a[2], b[2]);
}

// ---------------------------------------------------------------------------------------------------- t as (p + root √f)/m

struct fraction {
    mpz_t p, f, m; // f >= 0, m > 0
    int root;      // -1, 0 or 1
};

static void fraction_init(struct fraction *a) {
    mpz_inits(a->p, a->f, a->m, (mpz_ptr)0);
    a->root = 0;
}

static void fraction_clear(struct fraction *a) { mpz_clears(a->p, a->f, a->m, (mpz_ptr)0); }

static void fraction_swap(struct fraction *a, struct fraction *b) {
    struct fraction other = *a;
    *a = *b;
    *b = other;
}

// The sign of a + b√f.
static int sign_of_sum(const mpz_t a, const mpz_t b, const mpz_t f) {
    int sa = mpz_sgn(a), sb = mpz_sgn(f) ? mpz_sgn(b) : 0;
    if (sa == sb || sb == 0) return sa;
    if (sa == 0) return sb;
    mpz_t left, right;
    mpz_inits(left, right, (mpz_ptr)0);
    mpz_mul(left, a, a);
    mpz_mul(right, b, b);
    mpz_mul(right, right, f);
    int order = mpz_cmp(left, right);
    mpz_clears(left, right, (mpz_ptr)0);
    return order > 0 ? sa : order < 0 ? sb : 0;
}

// The sign of a + b√f + c√g: of x = a + b√f against y = -c√g; where both have one sign, of x² - y², which has one root.
static int sign_of_sums(const mpz_t a, const mpz_t b, const mpz_t f, const mpz_t c, const mpz_t g) {
    int x = sign_of_sum(a, b, f), y = mpz_sgn(g) ? -mpz_sgn(c) : 0;
    if (x != y) return x > y ? 1 : -1;
    if (x == 0) return 0;
    mpz_t whole, factor, term;
    mpz_inits(whole, factor, term, (mpz_ptr)0);
    mpz_mul(whole, a, a);
    mpz_mul(term, b, b);
    mpz_addmul(whole, term, f);
    mpz_mul(term, c, c);
    mpz_submul(whole, term, g);
    mpz_mul(factor, a, b);
    mpz_mul_2exp(factor, factor, 1);
    int sign = sign_of_sum(whole, factor, f) * x;
    mpz_clears(whole, factor, term, (mpz_ptr)0);
    return sign;
}

// The sign of a - b.
static int fraction_compare(const struct fraction *a, const struct fraction *b) {
    mpz_t whole, left, right;
    mpz_inits(whole, left, right, (mpz_ptr)0);
    mpz_mul(whole, a->p, b->m);
    mpz_submul(whole, b->p, a->m);
    mpz_mul_si(left, b->m, a->root);
    mpz_mul_si(right, a->m, -b->root);
    int sign = sign_of_sums(whole, left, a->f, right, b->f);
    mpz_clears(whole, left, right, (mpz_ptr)0);
    return sign;
}

static int fraction_compare_float(const struct fraction *a, float x) {
    if (isinf(x)) return x > 0 ? -1 : 1;
    struct fraction b;
    fraction_init(&b);
    set(b.p, x);
    mpz_set_ui(b.m, 1);
    mpz_mul_2exp(b.m, b.m, LOWEST_BIT);
    int sign = fraction_compare(a, &b);
    fraction_clear(&b);
    return sign;
}

static double quotient(const mpf_t numerator, const mpz_t denominator) {
    mpf_t value;
    mpf_init2(value, REAL_BITS);
    mpf_set_z(value, denominator);
    mpf_div(value, numerator, value);
    double result = mpf_get_d(value);
    mpf_clear(value);
    return result;
}

static double fraction_double(const struct fraction *a) {
    mpf_t sum, root;
    mpf_init2(sum, REAL_BITS);
    mpf_init2(root, REAL_BITS);
    mpf_set_z(sum, a->p);
    mpf_set_z(root, a->f);
    mpf_sqrt(root, root);
    if (a->root > 0) mpf_add(sum, sum, root);
    if (a->root < 0) mpf_sub(sum, sum, root);
    double value = quotient(sum, a->m);
    mpf_clear(sum);
    mpf_clear(root);
    return value;
}

static double ratio(const mpz_t a, const mpz_t b) {
    mpf_t numerator;
    mpf_init2(numerator, REAL_BITS);
    mpf_set_z(numerator, a);
    double value = quotient(numerator, b);
    mpf_clear(numerator);
    return value;
}

// ------------------------------------------------------------------------------------------------------------- the search

// A ray, and the nearest crossing so far.
struct search {
    const struct world *world;
    const struct gn_ray *ray;
    bool plain;
    vec o, d;
    struct fraction best, t; // t: of the crossing that is looked at
    int32_t object, primitive;
    uint32_t crossings;
};

static void search_init(struct search *s, const struct world *world, bool plain) {
    *s = (struct search){.world = world, .plain = plain};
    vec_init(s->o);
    vec_init(s->d);
    fraction_init(&s->best);
    fraction_init(&s->t);
}

static void search_clear(struct search *s) {
    vec_clear(s->o);
    vec_clear(s->d);
    fraction_clear(&s->best);
    fraction_clear(&s->t);
}

// s->t is a crossing of this primitive if it lies in the interval. Returns whether it does.
static bool consider(struct search *s, int32_t object, int32_t primitive) {
    if (fraction_compare_float(&s->t, s->ray->tmin) <= 0 || fraction_compare_float(&s->t, s->ray->tmax) >= 0) return false;
    s->crossings++;
    int order = s->object < 0 ? -1 : fraction_compare(&s->t, &s->best);
    bool lower = object < s->object || (object == s->object && primitive < s->primitive);
    if (order < 0 || (order == 0 && lower)) {
        fraction_swap(&s->t, &s->best);
        s->object = object, s->primitive = primitive;
    }
    return true;
}

// -------------------------------------------------------------------------------------------------------------- triangles

// f(p, q) = d·((q-o)×(p-o)) for a = p-o, b = q-o. Returns its sign; a zero has the sign of the first non-zero component of (q-p)×d.
static int edge(mpz_t f, const vec d, const vec a, const vec b) {
    vec cross, along;
    vec_init(cross);
    vec_cross(cross, b, a);
    vec_dot(f, d, cross);
    int sign = mpz_sgn(f);
    if (sign == 0) {
        vec_init(along);
        vec_sub(along, b, a);
        vec_cross(cross, along, d);
        for (int i = 0; i < 3 && sign == 0; i++) sign = mpz_sgn(cross[i]);
        vec_clear(along);
    }
    vec_clear(cross);
    return sign;
}

int oracle_edge_sign(const float o[3], const float d[3], const float p[3], const float q[3]) {
    vec origin, direction, a, b;
    mpz_t f;
    vec_init(origin), vec_init(direction), vec_init(a), vec_init(b);
    mpz_init(f);
    vec_set(origin, o), vec_set(direction, d), vec_set(a, p), vec_set(b, q);
    vec_sub(a, a, origin);
    vec_sub(b, b, origin);
    int sign = edge(f, direction, a, b);
    vec_clear(origin), vec_clear(direction), vec_clear(a), vec_clear(b);
    mpz_clear(f);
    return sign;
}

// What is computed of a ray and a triangle: the edge functions, and t = height/slope.
struct triangle_numbers {
    mpz_t f[3], sum, height, slope;
};

static void numbers_init(struct triangle_numbers *n) { mpz_inits(n->f[0], n->f[1], n->f[2], n->sum, n->height, n->slope, (mpz_ptr)0); }
static void numbers_clear(struct triangle_numbers *n) { mpz_clears(n->f[0], n->f[1], n->f[2], n->sum, n->height, n->slope, (mpz_ptr)0); }

// Fills *n; returns whether the line crosses the triangle.
static bool cross_triangle(struct triangle_numbers *n, const struct search *s, uint32_t triangle) {
    const struct world_triangle *corners = &s->world->triangles[triangle];
    vec a[3], e1, e2, normal;
    for (int i = 0; i < 3; i++) {
        vec_init(a[i]);
        vec_set(a[i], s->world->vertices[corners->v[i]]);
        vec_sub(a[i], a[i], s->o);
    }
    int u = edge(n->f[0], s->d, a[1], a[2]), v = edge(n->f[1], s->d, a[2], a[0]), w = edge(n->f[2], s->d, a[0], a[1]);
    mpz_add(n->sum, n->f[0], n->f[1]);
    mpz_add(n->sum, n->sum, n->f[2]);
    bool hit = mpz_sgn(n->sum) != 0 && u == v && v == w && u != 0;
    if (hit) {
        vec_init(e1), vec_init(e2), vec_init(normal);
        vec_sub(e1, a[1], a[0]);
        vec_sub(e2, a[2], a[0]);
        vec_cross(normal, e1, e2);
        vec_dot(n->height, a[0], normal);
        vec_dot(n->slope, s->d, normal);
        vec_clear(e1), vec_clear(e2), vec_clear(normal);
    }
    for (int i = 0; i < 3; i++) vec_clear(a[i]);
    return hit;
}

static void try_triangle(struct search *s, uint32_t triangle, int32_t object, int32_t primitive) {
    struct triangle_numbers n;
    numbers_init(&n);
    if (cross_triangle(&n, s, triangle)) {
        mpz_abs(s->t.m, n.slope);
        if (mpz_sgn(n.slope) < 0) mpz_neg(n.height, n.height);
        mpz_set(s->t.p, n.height);
        mpz_set_ui(s->t.f, 0);
        s->t.root = 0;
        consider(s, object, primitive);
    }
    numbers_clear(&n);
}

// Whether fp64 is sure that a line misses: two edge functions of certainly different sign. Differences of fp32 numbers are right to
// 2^-53 each, a product of three to 2^-50 with all its roundings, so that 2^-47 of the sum of absolute products is ample; nothing of
// degree 3 over- or underflows.
static bool surely_missed(const struct gn_ray *ray, const float *const v[3]) {
    double a[3][3], sign_low = 0, sign_high = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) a[i][k] = (double)v[i][k] - ray->origin[k];
    for (int i = 0; i < 3; i++) {
        const double *p = a[(i + 1) % 3], *q = a[(i + 2) % 3];
        double f = 0, size = 0;
        for (int k = 0; k < 3; k++) {
            int y = (k + 1) % 3, z = (k + 2) % 3;
            f += ray->direction[k] * (q[y] * p[z] - q[z] * p[y]);
            size += fabs(ray->direction[k]) * (fabs(q[y] * p[z]) + fabs(q[z] * p[y]));
        }
        if (f > 0x1p-47 * size) sign_high = 1;
        if (f < -0x1p-47 * size) sign_low = 1;
    }
    return sign_low > 0 && sign_high > 0;
}

static void search_triangles(struct search *s, uint32_t self) {
    const struct world *w = s->world;
    int32_t primitive = 0;
    for (uint32_t i = 0; i < w->triangle_count; i++, primitive++) {
        const struct world_triangle *t = &w->triangles[i];
        if (i > 0 && t->mesh != w->triangles[i - 1].mesh) primitive = 0;
        if (i == self) continue;
        const float *const v[3] = {w->vertices[t->v[0]], w->vertices[t->v[1]], w->vertices[t->v[2]]};
        if (s->plain || !surely_missed(s->ray, v)) try_triangle(s, i, (int32_t)world_mesh_object(w, t->mesh), primitive);
    }
}

// ---------------------------------------------------------------------------------------------------------------- spheres

// The equation of a ray and a sphere: t = (b ± √f)/a.
struct sphere_numbers {
    mpz_t a, b, f;
};

static void sphere_numbers(struct sphere_numbers *n, const struct search *s, const struct world_sphere *sphere) {
    vec l, x;
    mpz_t square;
    mpz_inits(n->a, n->b, n->f, square, (mpz_ptr)0);
    vec_init(l), vec_init(x);
    vec_set(l, sphere->center);
    vec_sub(l, l, s->o);
    vec_dot(n->a, s->d, s->d);
    vec_dot(n->b, l, s->d);
    vec_cross(x, l, s->d);
    vec_dot(square, x, x);
    set(n->f, sphere->radius);
    mpz_mul(n->f, n->f, n->f);
    mpz_mul(n->f, n->f, n->a);
    mpz_sub(n->f, n->f, square);
    vec_clear(l), vec_clear(x);
    mpz_clear(square);
}

static void try_sphere(struct search *s, const struct world_sphere *sphere, int32_t object, bool again) {
    struct sphere_numbers n;
    sphere_numbers(&n, s, sphere);
    uint32_t before = s->crossings;
    for (int root = -1; root <= 1; root += 2) {
        if (again ? root < 0 : mpz_sgn(n.f) < 0) continue;
        mpz_set(s->t.p, n.b);
        mpz_set(s->t.m, n.a);
        mpz_set(s->t.f, n.f);
        s->t.root = root;
        if (again) {
            mpz_mul_2exp(s->t.p, s->t.p, 1);
            mpz_set_ui(s->t.f, 0);
            s->t.root = 0;
        }
        consider(s, object, 0);
    }
    if (s->crossings > before && mpz_sgn(n.f) == 0) s->crossings = before + 1; // a double root is one crossing
    mpz_clears(n.a, n.b, n.f, (mpz_ptr)0);
}

// ------------------------------------------------------------------------------------------------------------------- rays

static bool ray_is_valid(const struct gn_ray *ray) {
    bool moves = false;
    for (int i = 0; i < 3; i++) {
        if (!isfinite(ray->origin[i]) || !isfinite(ray->direction[i])) return false;
        moves = moves || ray->direction[i] != 0;
    }
    return moves && !isnan(ray->tmin) && !isnan(ray->tmax);
}

// u and v of the nearest crossing, a triangle's.
static void fill_weights(struct oracle_answer *answer, const struct search *s) {
    const struct world *w = s->world;
    struct triangle_numbers n;
    uint32_t triangle = 0;
    int32_t primitive = 0;
    for (;; triangle++, primitive++) {
        if (triangle > 0 && w->triangles[triangle].mesh != w->triangles[triangle - 1].mesh) primitive = 0;
        if (primitive == s->primitive && (int32_t)world_mesh_object(w, w->triangles[triangle].mesh) == s->object) break;
    }
    numbers_init(&n);
    cross_triangle(&n, s, triangle);
    answer->u = ratio(n.f[1], n.sum);
    answer->v = ratio(n.f[2], n.sum);
    numbers_clear(&n);
}

static bool is_sphere_object(const struct world *world, int32_t object) {
    uint32_t first = world_sphere_object(world, 0);
    return world->sphere_count > 0 && (uint32_t)object >= first && (uint32_t)object < first + world->sphere_count;
}

static void answer_ray(struct oracle_answer *out, struct search *s, const struct gn_ray *ray, uint32_t self) {
    *out = (struct oracle_answer){.valid = ray_is_valid(ray), .object = -1, .primitive = -1, .t = INFINITY};
    if (!out->valid || !(ray->tmin < ray->tmax)) return;
    s->ray = ray;
    s->object = s->primitive = -1;
    s->crossings = 0;
    vec_set(s->o, ray->origin);
    vec_set(s->d, ray->direction);
    search_triangles(s, self);
    for (uint32_t i = 0; i < s->world->sphere_count; i++)
        try_sphere(s, &s->world->spheres[i], (int32_t)world_sphere_object(s->world, i), self == s->world->triangle_count + i);
    if (s->object < 0) return;
    out->hit = true;
    out->object = s->object, out->primitive = s->primitive;
    out->t = fraction_double(&s->best);
    if (!is_sphere_object(s->world, s->object)) fill_weights(out, s);
}

uint32_t oracle_crossings(const struct world *world, const struct gn_ray *ray) {
    struct search s;
    struct oracle_answer answer;
    search_init(&s, world, false);
    answer_ray(&answer, &s, ray, ORACLE_NO_SELF);
    search_clear(&s);
    return s.crossings;
}

struct batch {
    struct oracle_answer *answers;
    const struct world *world;
    const struct oracle_params *params;
};

static bool answer_some(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    const struct batch *b = data;
    struct search s;
    search_init(&s, b->world, b->params->plain);
    for (size_t i = begin; i < end; i++)
        answer_ray(&b->answers[i], &s, &b->world->rays[i], b->params->self ? b->params->self[i] : ORACLE_NO_SELF);
    search_clear(&s);
    return true;
}

bool oracle_answer(struct oracle_answer *answers, struct context *ctx, const struct world *world, const struct oracle_params *params) {
    struct batch b = {answers, world, params};
    if (!progress(ctx, "oracle", -1, -1)) return false;
    return parallel_for(params->threads ? params->threads : 1, world->ray_count, 64, answer_some, &b);
}

// ------------------------------------------------------------------------------------------------------------ boxes, ulps

// The interval of t in which the ray is between two planes, as [near, far] in rationals; false if it never is.
static bool clip(mpq_t near, mpq_t far, const mpq_t o, const mpq_t d, float low, float high) {
    mpq_t a, b;
    mpq_inits(a, b, (mpq_ptr)0);
    mpq_set_d(a, (double)low);
    mpq_set_d(b, (double)high);
    bool inside = mpq_cmp(a, o) <= 0 && mpq_cmp(o, b) <= 0;
    if (mpq_sgn(d) != 0) {
        mpq_sub(a, a, o);
        mpq_sub(b, b, o);
        mpq_div(a, a, d);
        mpq_div(b, b, d);
        if (mpq_sgn(d) < 0) mpq_swap(a, b);
        if (mpq_cmp(a, near) > 0) mpq_set(near, a);
        if (mpq_cmp(b, far) < 0) mpq_set(far, b);
        inside = mpq_cmp(near, far) <= 0;
    }
    mpq_clears(a, b, (mpq_ptr)0);
    return inside;
}

bool oracle_box(const float box_min[3], const float box_max[3], const struct gn_ray *ray) {
    mpq_t near, far, o, d;
    mpq_inits(near, far, o, d, (mpq_ptr)0);
    mpq_set_d(near, (double)ray->tmin);
    mpq_set_d(far, isinf(ray->tmax) ? DBL_MAX : (double)ray->tmax);
    bool touches = true;
    for (int i = 0; i < 3 && touches; i++) {
        mpq_set_d(o, (double)ray->origin[i]);
        mpq_set_d(d, (double)ray->direction[i]);
        touches = clip(near, far, o, d, box_min[i], box_max[i]);
    }
    mpq_clears(near, far, o, d, (mpq_ptr)0);
    return touches;
}

double oracle_ulps(double got, double right) {
    if (fabs(right) >= 0x1.ffffffp127) right = copysign(INFINITY, right);
    if (isnan(got) || isinf(got) || isinf(right)) return got == right ? 0 : INFINITY;
    int exponent = right == 0 ? -126 : ilogb(right);
    return fabs(got - right) / ldexp(1, (exponent < -126 ? -126 : exponent) - 23);
}
