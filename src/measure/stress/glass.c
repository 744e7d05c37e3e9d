// Rows of refraction, Fresnel's formulas and absorption, against MPFR at 256 bits.
#include <math.h>
#include <mpfr.h>
#include <string.h>

#include "measure/stress/shading.h"

#define BITS 256
#define LAST 0x1.fffffep-1f // the largest random number: what can go through does

// ------------------------------------------------------------------------------------------------------------------- MPFR

// Of light that comes with a cosine of c: the share that is sent back, the cosine beyond times η = beyond/here, and its square, which is
// negative for total reflection.
struct fresnel {
    double reflected, w, square;
};

static void share(mpfr_t sum, const mpfr_t a, const mpfr_t b) {
    mpfr_t top, bottom;
    mpfr_inits2(BITS, top, bottom, (mpfr_ptr)0);
    mpfr_sub(top, a, b, MPFR_RNDN);
    mpfr_add(bottom, a, b, MPFR_RNDN);
    mpfr_div(top, top, bottom, MPFR_RNDN);
    mpfr_sqr(top, top, MPFR_RNDN);
    mpfr_add(sum, sum, top, MPFR_RNDN);
    mpfr_clears(top, bottom, (mpfr_ptr)0);
}

static struct fresnel exact_fresnel(float c, float here, float beyond) {
    struct fresnel f;
    mpfr_t cosine, eta2, w, sum, along;
    mpfr_inits2(BITS, cosine, eta2, w, sum, along, (mpfr_ptr)0);
    mpfr_set_flt(cosine, c, MPFR_RNDN);
    mpfr_set_flt(eta2, beyond, MPFR_RNDN);
    mpfr_div_d(eta2, eta2, here, MPFR_RNDN);
    mpfr_sqr(eta2, eta2, MPFR_RNDN);
    mpfr_sqr(w, cosine, MPFR_RNDN);
    mpfr_add(w, w, eta2, MPFR_RNDN);
    mpfr_sub_ui(w, w, 1, MPFR_RNDN);
    f = (struct fresnel){.reflected = 1, .square = mpfr_get_d(w, MPFR_RNDN)};
    if (mpfr_sgn(w) > 0) {
        mpfr_sqrt(w, w, MPFR_RNDN);
        f.w = mpfr_get_d(w, MPFR_RNDN);
        mpfr_set_zero(sum, 1);
        share(sum, cosine, w);
        mpfr_mul(along, cosine, eta2, MPFR_RNDN);
        share(sum, along, w);
        f.reflected = mpfr_get_d(sum, MPFR_RNDN) / 2;
    }
    mpfr_clears(cosine, eta2, w, sum, along, (mpfr_ptr)0);
    return f;
}

static double exact_sine(float c) { // √(1 - c²)
    mpfr_t x;
    mpfr_init2(x, BITS);
    mpfr_set_flt(x, c, MPFR_RNDN);
    mpfr_sqr(x, x, MPFR_RNDN);
    mpfr_ui_sub(x, 1, x, MPFR_RNDN);
    mpfr_sqrt(x, x, MPFR_RNDN);
    double value = mpfr_get_d(x, MPFR_RNDN);
    mpfr_clear(x);
    return value;
}

// --------------------------------------------------------------------------------------------------- Fresnel and refraction

// Light with sine s and cosine c, in a plane of two axes, at a surface between two media; whatever can go through does. Next to the
// critical angle the cosine beyond is the root of a difference of some 8 roundings.
static void set_glass(struct shading_case *out, uint32_t i, float s, float c, float here, float beyond) {
    int normal = (int)(i % 3), tangent = (normal + 1 + (int)(i / 3 % 2)) % 3;
    float side = i / 6 % 2 ? -1 : 1;
    struct fresnel f = exact_fresnel(c, here, beyond);
    double noise = 8 * FP32_UNIT * fmax(1, (double)c * c), eta = (double)beyond / here, length = sqrt((double)s * s + f.square);
    double off = fmin(noise / fmax(f.w, 1e-30), 2 * sqrt(noise)), steep = 4 * (1 + 1 / (eta * eta)) / fmax(c, 0.05);
    bool through = f.square > 0, critical = eta < 1 && fabs(f.square) < noise;
    bool doubtful = critical || (through && f.reflected > 1 - 16 * FP32_UNIT); // sent back as likely as not
    out->in[normal] = out->in[3 + normal] = side;
    out->in[6 + normal] = side * c;
    out->in[6 + tangent] = s;
    out->in[9] = here, out->in[10] = beyond, out->in[11] = LAST;
    for (int k = 0; k < 3; k++) expect(out, k, 0, doubtful ? -1 : 0);
    if (!doubtful) {
        double away = through ? 16 * FP32_UNIT + off / eta : 16 * FP32_UNIT;
        expect(out, normal, through ? -side * f.w / length : side * c, away);
        expect(out, tangent, through ? -s / length : -s, through ? 16 * FP32_UNIT * s / length + off / eta * s / length : away);
    }
    expect(out, 3, 1, 0);
    expect(out, 4, through, doubtful ? 1 : 0);
    expect(out, 5, f.reflected, critical ? steep * 2 * sqrt(noise) : through ? 16 * FP32_UNIT + steep * off : 0);
}

// A number of places in fp32 away.
static float places(float x, int count) {
    for (; count > 0; count--) x = nextafterf(x, 2);
    for (; count < 0; count++) x = nextafterf(x, -2);
    return x;
}

// R01: 200 places on either side of the critical angle.
static void near_critical(struct shading_case *out, struct random *random, uint32_t i) {
    float c = places(0.745355992f, (int)random_below(random, 401) - 200);
    set_glass(out, i, (float)exact_sine(c), c, 1.5f, 1);
}

// R02: √¾ rounded both ways, and next to that.
static void at_critical(struct shading_case *out, struct random *random, uint32_t i) {
    float c = places(0x1.bb67aep-1f, (int)random_below(random, 4) - 1);
    set_glass(out, i, (float)exact_sine(c), c, 2, 1);
}

// R03: the sine beyond is right in all its digits, though the cosine is 1 or next to it.
static void small_sines(struct shading_case *out, struct random *random, uint32_t i) {
    static const float sines[] = {1e-3f, 2e-4f, 1e-5f, 1e-10f};
    static const float indices[][2] = {{1, 1.5f}, {1.5f, 1}, {1.33f, 1.5f}, {2.4f, 1}};
    float s = i % 8 < 4 ? sines[i % 4] : (float)pow(10, random_in(random, -15, -2));
    const float *index = indices[random_below(random, 4)];
    set_glass(out, i, s, (float)exact_sine(s), index[0], index[1]);
}

// R04: straight on, to the bit, and nothing sent back.
static void no_change(struct shading_case *out, struct random *random, uint32_t i) {
    float index = i % 2 ? 1 : (float)random_in(random, 1, 3);
    unit_about(out->in, random, NULL, 0);
    memcpy(out->in + 3, out->in, 3 * sizeof *out->in);
    unit_about(out->in + 6, random, out->in, 0);
    out->in[9] = out->in[10] = index, out->in[11] = i % 3 ? LAST : 0;
    for (int k = 0; k < 3; k++) expect(out, k, -(double)out->in[6 + k], 0);
    expect(out, 3, 1, 0);
    expect(out, 4, 1, 0);
}

// R05: the share that is sent back, next to nothing, has all its digits.
static void least_change(struct shading_case *out, struct random *random, uint32_t i) {
    float c = i % 2 ? 1 : (float)random_in(random, 0.1, 1);
    set_glass(out, i, (float)exact_sine(c), c, 1, 1 + 0x1p-23f);
    expect(out, 5, out->right[5], 128 * FP32_UNIT / ((double)c * c) * out->right[5]);
}

// R06: a cosine of 1e-4, and down to 1e-8.
static void grazing_in(struct shading_case *out, struct random *random, uint32_t i) {
    float c = i % 2 ? 1e-4f : (float)pow(10, random_in(random, -8, -2));
    set_glass(out, i, (float)exact_sine(c), c, 1, 1.5f);
    expect(out, 5, out->right[5], 8 * FP32_UNIT + 64 * FP32_UNIT * (1 - out->right[5]));
}

// R08: beyond the critical angle.
static void total_reflection(struct shading_case *out, struct random *random, uint32_t i) {
    float index = (float)random_in(random, 1.05, 4), limit = (float)sqrt(1 - 1 / ((double)index * index));
    float c = (float)(limit * random_in(random, 0, i % 2 ? 0.99 : 1e-3));
    set_glass(out, i, (float)exact_sine(c), c, index, 1);
}

// R12: at grazing incidence, from inside and outside, about a normal that leans: all of the light goes on, to the right side.
static void grazing_out(struct shading_case *out, struct random *random, uint32_t i) {
    float *n = out->in, *ng = out->in + 3, *wo = out->in + 6, c = (float)pow(10, random_in(random, -7, -1));
    unit_about(ng, random, NULL, 0);
    unit_about(n, random, ng, i % 4 ? 0.9 : 0.01);
    unit_about(wo, random, ng, 0.01);
    double along = dot_of(ng, wo), length;
    float flat[3];
    for (int k = 0; k < 3; k++) flat[k] = (float)(wo[k] - along * ng[k]);
    length = sqrt(dot_of(flat, flat));
    for (int k = 0; k < 3; k++) wo[k] = (float)(flat[k] / length * exact_sine(c) + c * ng[k]);
    out->in[9] = i % 2 ? 1.5f : 1, out->in[10] = i % 2 ? 1 : 1.5f;
    out->in[11] = (float)(random_bits(random) >> 8) * 0x1p-24f;
    for (int k = 0; k < 6; k++) expect(out, k, 0, -1);
    expect(out, 3, 1, 0);
}

static bool is_on_its_side(const float *in, const float *out) {
    return is_unit(out, 4 * FP32_UNIT) && dot_of(in + 3, out) * (out[4] != 0 ? -1 : 1) > -8 * FP32_UNIT;
}

// ----------------------------------------------------------------------------------------------------------------- the rest

// R11: 1000 times from wall to wall: the distance of the ray from the middle stays, and nothing gets out.
static void round_trips(struct shading_case *out, struct random *random, uint32_t i) {
    float *p = out->in, *d = out->in + 3;
    double impact = random_in(random, 0.7, 0.99), along, length;
    float flat[3];
    unit_about(p, random, NULL, 0);
    unit_about(d, random, NULL, 0);
    along = dot_of(p, d);
    for (int k = 0; k < 3; k++) flat[k] = (float)(d[k] - along * p[k]);
    length = sqrt(dot_of(flat, flat));
    for (int k = 0; k < 3; k++) d[k] = (float)(flat[k] / length * impact - sqrt(1 - impact * impact) * p[k]);
    out->in[6] = i % 4 ? 1000 : 10;
    for (int k = 0; k < 6; k++) expect(out, k, 0, -1);
}

static double impact_of(const float *p, const float *d) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double c = (double)p[(k + 1) % 3] * d[(k + 2) % 3] - (double)p[(k + 2) % 3] * d[(k + 1) % 3];
        sum += c * c;
    }
    return sqrt(sum);
}

static bool keeps_its_distance(const float *in, const float *out) {
    return fabs(impact_of(out, out + 3) - impact_of(in, in + 3)) <= (16 + 4 * (double)in[6]) * FP32_UNIT && is_unit(out, 4 * FP32_UNIT) &&
           is_unit(out + 3, 4 * FP32_UNIT);
}

// R10: nothing is absorbed by a medium that absorbs nothing, on a way without an end; all of it by any other.
static void what_is_left(struct shading_case *out, struct random *random, uint32_t i) {
    double size = random_in(random, -30, 30);
    float sigma = i % 4 == 0 ? 0 : (float)pow(10, size), way = i % 8 < 3 ? INFINITY : (float)pow(10, random_in(random, -5, 2) - size);
    double depth = sigma > 0 ? (double)sigma * way : 0, left = 1;
    mpfr_t x;
    mpfr_init2(x, BITS);
    mpfr_set_d(x, -depth, MPFR_RNDN);
    mpfr_exp(x, x, MPFR_RNDN);
    left = mpfr_get_d(x, MPFR_RNDN);
    mpfr_clear(x);
    for (int k = 0; k < 3; k++) out->in[k] = sigma;
    out->in[3] = way;
    for (int k = 0; k < 3; k++) expect(out, k, left, sigma > 0 ? (8 + 2 * fmin(depth, 200)) * FP32_UNIT * left + 0x1p-126 : 0);
}

// ----------------------------------------------------------------------------------------------------------------- the rows

static bool run_glass(struct stress *s, void (*make)(struct shading_case *out, struct random *random, uint32_t i)) {
    return run_shading(s, &(struct shading){SHADING_GLASS, EFFECT_REFRACTION, make, NULL});
}

bool glass_near_critical(struct stress *s) { return run_glass(s, near_critical); }
bool glass_critical(struct stress *s) { return run_glass(s, at_critical); }
bool glass_small_sines(struct stress *s) { return run_glass(s, small_sines); }
bool glass_no_change(struct stress *s) { return run_glass(s, no_change); }
bool glass_least_change(struct stress *s) { return run_glass(s, least_change); }
bool glass_grazing_in(struct stress *s) { return run_glass(s, grazing_in); }
bool glass_total_reflection(struct stress *s) { return run_glass(s, total_reflection); }
bool glass_grazing_out(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_GLASS, EFFECT_REFRACTION | EFFECT_SMOOTH_NORMALS, grazing_out, is_on_its_side});
}
bool glass_round_trips(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_INSIDE, EFFECT_REFRACTION, round_trips, keeps_its_distance});
}
bool glass_what_is_left(struct stress *s) { return run_shading(s, &(struct shading){SHADING_LEFT, EFFECT_ABSORPTION, what_is_left, NULL}); }
