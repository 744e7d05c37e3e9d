// Rows of numbers: one function of the shaders at a time, against MPFR at 256 bits on the same fp32 inputs.
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

#include "measure/stress/job.h"
#include "measure/stress/oracle.h"
#include "render/camera.h"

#define BITS 256
#define UNIT 0x1p-24 // roundoff of fp32

// A function's arguments, its right answer, and how far from that fp32 may be.
struct number_case {
    float in[STRESS_NUMBERS_IN];
    double right[3], slack[3];
};

// A function of the shaders. `wide`: the tier fp64 computes it in fp64, and is off by its rounding to fp32 alone; others are fp32 in
// every tier.
struct number_function {
    uint32_t what;
    bool wide;
    uint32_t power;
};

typedef void number_maker(struct number_case *out, struct random *random, uint32_t i);

// ----------------------------------------------------------------------------------------------------------------- MPFR

// x^y for x >= 0, with 0^0 = 1.
static double exact_power(mpfr_t x, double y) {
    mpfr_t power;
    if (y == 0) return 1;
    mpfr_init2(power, BITS);
    mpfr_set_d(power, y, MPFR_RNDN);
    mpfr_pow(power, x, power, MPFR_RNDN);
    double value = mpfr_get_d(power, MPFR_RNDN);
    mpfr_clear(power);
    return value;
}

static void exact_dot(mpfr_t out, const float a[3], const float b[3]) {
    mpfr_t term;
    mpfr_init2(term, BITS);
    mpfr_set_zero(out, 1);
    for (int k = 0; k < 3; k++) {
        mpfr_set_flt(term, a[k], MPFR_RNDN);
        mpfr_mul_d(term, term, (double)b[k], MPFR_RNDN);
        mpfr_add(out, out, term, MPFR_RNDN);
    }
    mpfr_clear(term);
}

// r·v with r = 2 (n·l) n - l.
static void exact_mirror(mpfr_t out, const float n[3], const float l[3], const float v[3]) {
    mpfr_t nl, lv;
    mpfr_inits2(BITS, nl, lv, (mpfr_ptr)0);
    exact_dot(nl, n, l);
    exact_dot(lv, l, v);
    exact_dot(out, n, v);
    mpfr_mul(out, out, nl, MPFR_RNDN);
    mpfr_mul_2ui(out, out, 1, MPFR_RNDN);
    mpfr_sub(out, out, lv, MPFR_RNDN);
    mpfr_clears(nl, lv, (mpfr_ptr)0);
}

// ---------------------------------------------------------------------------------------------------------------- powers

// What Vulkan allows pow(x, y) = exp2(y·log2 x), relative: log2 to 2^-21 between 1/2 and 2 and to 3 ulp elsewhere, exp2(z) to 3 + 2|z|
// ulp.
static double power_slack(double x, double y) {
    double z = fabs(y * log2(x)), log_error = x >= 0.5 && x <= 2 ? 0x1p-21 : 6 * UNIT * fabs(log2(x));
    return log(2) * (y * log_error + z * UNIT) + (3 + 2 * z) * 2 * UNIT;
}

static void set_power(struct number_case *out, float x, float y) {
    mpfr_t base;
    out->in[0] = x, out->in[1] = y;
    mpfr_init2(base, BITS);
    mpfr_set_flt(base, x > 0 ? x : 0, MPFR_RNDN);
    out->right[0] = exact_power(base, y);
    out->slack[0] = x > 0 ? out->right[0] * power_slack(x, y) + 0x1p-126 : 0;
    mpfr_clear(base);
}

// H02: 0^0 and x^0 are 1, 0^y is 0.
static void power_of_nothing(struct number_case *out, struct random *random, uint32_t i) {
    static const float bases[] = {0, 1, 0.5f, 1e-38f, 2};
    set_power(out, bases[i % 5], i % 2 ? 0 : (float)(i % 5 ? 0 : exp(random_in(random, -5, 15))));
}

// H03: below 0 counts as 0.
static void power_below_zero(struct number_case *out, struct random *random, uint32_t i) {
    set_power(out, i % 8 ? -(float)exp(random_in(random, -60, 0)) : -1e-8f, i % 8 ? (float)random_in(random, 0.1, 1000) : 32.5f);
}

// H05: with the built-in pow, by what Vulkan allows it.
static void power_near_one(struct number_case *out, struct random *random, uint32_t i) {
    static const float exponents[] = {32, 1e3f, 1e4f, 1e6f};
    uint32_t k = i % 64 < 40 ? i / 4 % 200 : random_bits(random) >> random_below(random, 24) & 0xffffff;
    set_power(out, (float)(1 - k * UNIT), exponents[i % 4]);
}

// The same with our own, to 4 ulp.
static void own_power_near_one(struct number_case *out, struct random *random, uint32_t i) {
    power_near_one(out, random, i);
    out->slack[0] = 8 * UNIT * out->right[0] + 0x1p-126;
}

// ----------------------------------------------------------------------------------------------------------------- phong

static void unit_vector(float out[3], struct random *random) {
    double v[3];
    random_direction(v, random);
    for (int k = 0; k < 3; k++) out[k] = (float)v[k];
}

// A specular colour of 1, no diffuse one, and these vectors.
static void set_specular(struct number_case *out, float shininess, const float n[3], const float l[3], const float v[3]) {
    const float head[7] = {0, 0, 0, 1, 1, 1, shininess};
    memcpy(out->in, head, sizeof head);
    memcpy(out->in + 7, n, 3 * sizeof *n);
    memcpy(out->in + 10, l, 3 * sizeof *l);
    memcpy(out->in + 13, v, 3 * sizeof *v);
    mpfr_t cosine, mirror;
    mpfr_inits2(BITS, cosine, mirror, (mpfr_ptr)0);
    exact_dot(cosine, n, l);
    exact_mirror(mirror, n, l, v);
    double c = mpfr_get_d(mirror, MPFR_RNDN);
    if (mpfr_sgn(mirror) < 0) mpfr_set_zero(mirror, 1);
    if (mpfr_cmp_ui(mirror, 1) > 0) mpfr_set_ui(mirror, 1, MPFR_RNDN);
    double lit = exact_power(mirror, shininess), slack = c > 1e-3 ? lit * (power_slack(c, shininess) + shininess * 24 * UNIT / c) : 1e-6;
    bool dark = mpfr_cmp_d(cosine, 4 * UNIT) < 0, doubtful = dark && mpfr_cmp_d(cosine, -4 * UNIT) > 0;
    for (int k = 0; k < 3; k++) {
        out->right[k] = dark ? 0 : lit;
        out->slack[k] = doubtful ? 1 : dark ? 0 : slack + 0x1p-126;
    }
    mpfr_clears(cosine, mirror, (mpfr_ptr)0);
}

// H01: the viewer opposite the light. On the viewer's side of any n there is no light; elsewhere the formula holds.
static void opposite_light(struct number_case *out, struct random *random, uint32_t i) {
    const float l[3] = {0.6f, 0.8f, 0}, v[3] = {-0.6f, -0.8f, -0.0f};
    float n[3];
    unit_vector(n, random);
    if (i % 16 == 0) n[0] = 0.8f, n[1] = -0.6f, n[2] = 0;
    set_specular(out, 32, n, l, v);
}

// H04: r·v a little over 1, to the power 1e7: at most 1.
static void over_one(struct number_case *out, struct random *random, uint32_t i) {
    float n[3], v[3];
    unit_vector(n, random);
    for (int k = 0; k < 3; k++) v[k] = (float)(n[k] * (1 + (i % 8) * UNIT));
    set_specular(out, i % 2 ? 1e7f : 1e3f, n, v, v);
    for (int k = 0; k < 3; k++) out->right[k] = out->slack[k] = 0.5;
}

// ---------------------------------------------------------------------------------------------------------- other numbers

// H06: 0 stays 0; else a unit vector, whatever its scale.
static void any_length(struct number_case *out, struct random *random, uint32_t i) {
    static const float nasty[][3] = {{0, 0, 0},           {1e-23f, 0, 0}, {3e19f, 1, 0}, {-0.0f, 0, 0}, {3.4e38f, 3.4e38f, -3.4e38f},
                                     {1e-38f, -1e-38f, 0}};
    mpfr_t square;
    double length = 0;
    if (i % 32 < 6)
        memcpy(out->in, nasty[i % 32], sizeof nasty[0]);
    else
        for (int k = 0; k < 3; k++)
            out->in[k] = (float)ldexp(random_in(random, -1, 1), (int)random_below(random, 250) - 125 + (int)(i % 3));
    mpfr_init2(square, BITS);
    exact_dot(square, out->in, out->in);
    mpfr_sqrt(square, square, MPFR_RNDN);
    length = mpfr_get_d(square, MPFR_RNDN);
    mpfr_clear(square);
    for (int k = 0; k < 3; k++) {
        out->right[k] = length > 0 ? out->in[k] / length : 0;
        out->slack[k] = length > 0 ? 32 * UNIT : 0;
    }
}

static void set_light(struct number_case *out, float intensity, float falloff, float distance) {
    const float in[5] = {intensity, 0.5f * intensity, 0, falloff, distance};
    memcpy(out->in, in, sizeof in);
    for (int k = 0; k < 3; k++) {
        out->right[k] = falloff == 0 ? in[k] : distance > 0 ? (double)in[k] / ((double)distance * distance) : 0;
        out->slack[k] = 12 * UNIT * fabs(out->right[k]) + 0x1p-126;
    }
}

// H10: a light at the point gives nothing; one that is next to it gives what fp32 holds, or infinity, which the film drops and counts.
static void light_at_point(struct number_case *out, struct random *random, uint32_t i) {
    if (i % 4 == 0)
        set_light(out, 1, 1, 0);
    else
        set_light(out, 1, 1, i % 4 == 1 ? 1e-20f : (float)pow(10, random_in(random, -30, 0)));
}

// H11: intensity and square of the distance both beyond fp32, but not what arrives.
static void light_far_away(struct number_case *out, struct random *random, uint32_t i) {
    if (i % 4 == 0)
        set_light(out, 1e38f, 1, 1e20f);
    else
        set_light(out, (float)pow(10, random_in(random, 20, 38)), 1, (float)pow(10, random_in(random, 15, 22)));
}

// C06: 24 of 32 random bits, as a number below 1.
static void random_numbers(struct number_case *out, struct random *random, uint32_t i) {
    for (int k = 0; k < 2; k++) {
        uint32_t bits = i < 4 ? 0xffffffffu << 2 * i : i < 8 ? 0xffffffffu >> 8 * (i - 4) : random_bits(random);
        if ((bits & 0x7f800000u) == 0x7f800000u && i >= 8) bits &= 0xff7fffffu; // a NaN may not travel as a float
        memcpy(&out->in[k], &bits, sizeof bits);
        out->right[k] = (bits >> 8) * UNIT;
        out->slack[k] = 0;
    }
}

// C08: the last pixels of a film, and offsets next to 1.
static void last_pixel(struct number_case *out, struct random *random, uint32_t i) {
    for (int k = 0; k < 9; k++) out->in[k] = (float)(random_in(random, -1, 1) * (k < 3 ? 1 : 0x1p-13));
    out->in[9] = (float)(i % 2 ? 16383 : random_below(random, 65536));
    out->in[10] = (float)(i % 3 ? 16383 : random_below(random, 65536));
    out->in[11] = i % 4 ? 0x1.fffffep-1f : (float)random_unit(random) * 0x1.fffffep-1f;
    out->in[12] = i % 5 ? 0x1.fffffep-1f : 0;
    for (int k = 0; k < 3; k++) {
        double x = ((double)out->in[9] + out->in[11]) * out->in[3 + k], y = ((double)out->in[10] + out->in[12]) * out->in[6 + k];
        out->right[k] = out->in[k] + x + y;
        out->slack[k] = 4 * UNIT * (fabs((double)out->in[k]) + fabs(x) + fabs(y));
    }
}

// ------------------------------------------------------------------------------------------------------------------ lens

// A number of the sampler's: next to 1/2, or any.
static float sample_number(struct random *random, bool near) {
    return near ? 0.5f + (float)((int)random_below(random, 9) - 4) * 0x1p-24f : (float)(random_bits(random) >> 8) * 0x1p-24f;
}

// P. Shirley and K. Chiu's map: the distance from the middle is the square's, the angle how far around the square.
static void exact_disk(double point[2], const float u[2]) {
    const double a = 2.0 * u[0] - 1, b = 2.0 * u[1] - 1; // exact
    const bool wide = fabs(a) > fabs(b);
    const double r = wide ? a : b, side = wide ? b : a;
    mpfr_t angle, sine, cosine;
    mpfr_inits2(BITS, angle, sine, cosine, (mpfr_ptr)0);
    mpfr_const_pi(angle, MPFR_RNDN);
    mpfr_mul_d(angle, angle, side / 4, MPFR_RNDN);
    mpfr_div_d(angle, angle, r != 0 ? r : 1, MPFR_RNDN);
    mpfr_sin_cos(sine, cosine, angle, MPFR_RNDN);
    mpfr_mul_d(sine, sine, r, MPFR_RNDN);
    mpfr_mul_d(cosine, cosine, r, MPFR_RNDN);
    point[0] = mpfr_get_d(wide ? cosine : sine, MPFR_RNDN);
    point[1] = mpfr_get_d(wide ? sine : cosine, MPFR_RNDN);
    mpfr_clears(angle, sine, cosine, (mpfr_ptr)0);
}

// C09: the middle, what is next to it, the rims and all else; off by 8 ulp of the distance from the middle.
static void disk(struct number_case *out, struct random *random, uint32_t i) {
    for (int k = 0; k < 2; k++) out->in[k] = i == 0 ? 0.5f : i % 16 == 1 ? 0 : sample_number(random, i % 4 == 0);
    exact_disk(out->right, out->in);
    double distance = hypot(out->right[0], out->right[1]);
    for (int k = 0; k < 2; k++) out->slack[k] = 8 * UNIT * distance;
}

// C05: of a pixel's direction through a point of the lens. Without a radius, or with the focus at infinity, it is the pinhole's, to the bit.
static void lens(struct number_case *out, struct random *random, uint32_t i) {
    static const float distances[] = {1e-6f, 1, 1e6f, INFINITY};
    struct scene_camera camera = {.up = {0, 1, 0}, .fov_y_deg = (float)random_in(random, 1, 150), .focus_distance = distances[i / 2 % 4]};
    if (i % 2) camera.lens_radius = (float)random_in(random, 1e-3, 1);
    struct camera_rays rays;
    double view[3], point[2];
    random_direction(view, random);
    for (int k = 0; k < 3; k++) camera.look_at[k] = (float)view[k];
    camera_rays_make(&rays, &camera, 640, 480);
    const struct camera_sample sample = {.offset = {0.5f, 0.5f}};
    const struct gn_ray pinhole = camera_ray(&rays, random_below(random, 640), random_below(random, 480), &sample);
    const float *du = rays.frames[0].du, *dv = rays.frames[0].dv;
    memcpy(out->in, pinhole.direction, sizeof pinhole.direction);
    memcpy(out->in + 3, du, 3 * sizeof *du);
    memcpy(out->in + 6, dv, 3 * sizeof *dv);
    out->in[9] = rays.aim;
    for (int k = 10; k < 12; k++) out->in[k] = sample_number(random, false);
    exact_disk(point, out->in + 10);
    for (int k = 0; k < 3; k++) {
        const double x = rays.aim * point[0] * du[k], y = rays.aim * point[1] * dv[k];
        out->right[k] = pinhole.direction[k] - (x + y);
        out->slack[k] = rays.aim > 0 ? UNIT * (fabs(out->right[k]) + 8 * rays.aim * (fabs((double)du[k]) + fabs((double)dv[k]))) : 0;
    }
}

// --------------------------------------------------------------------------------------------------------------- judging

// Right if within the slack; an answer too large for fp32 may be infinite.
static bool is_right(double got, double right, double slack) {
    if (isinf(got)) return got > 0 && right > 0x1.ffffffp127;
    return fabs(got - right) <= slack;
}

static double slack_of(const struct number_case *c, int k, bool wide) {
    double rounding = 4 * UNIT * fabs(c->right[k]) + 0x1p-126;
    return wide && rounding < c->slack[k] ? rounding : c->slack[k];
}

// A relative error worth telling: of a number that is neither next to nothing nor beyond fp32.
static double relative_error(float got, double right) {
    return right > 0x1p-100 && right < 0x1p127 && isfinite(got) ? fabs(got - right) / right : 0;
}

static void judge(struct tally *tally, const struct number_case *cases, const float *got, uint32_t count, bool wide) {
    for (uint32_t i = 0; i < count; i++, got += 3) {
        const struct number_case *c = &cases[i];
        int bad = 0;
        while (bad < 3 && is_right(got[bad], c->right[bad], slack_of(c, bad, wide))) bad++;
        tally->rays++;
        if (bad < 3)
            tally_wrong(tally, "of (%.9g, %.9g, %.9g, %.9g, %.9g …): right %.9g, got %.9g", c->in[0], c->in[1], c->in[2], c->in[3],
                        c->in[4], c->right[bad], got[bad]);
        for (int k = 0; k < 3; k++) tally->error = fmax(tally->error, relative_error(got[k], c->right[k]));
    }
}

static bool run_numbers(struct stress *s, struct number_function function, number_maker *make) {
    uint32_t count = s->rays / 4 + 8;
    struct number_case *cases = array_alloc(s->ctx, count, sizeof *cases, "numbers");
    float *in = array_alloc(s->ctx, count, sizeof cases->in, "numbers"), *out = array_alloc(s->ctx, count, 3 * sizeof *out, "numbers");
    bool done = cases && in && out;
    for (uint32_t i = 0; done && i < count; i++) {
        make(&cases[i], &s->random, i);
        memcpy(in + STRESS_NUMBERS_IN * i, cases[i].in, sizeof cases->in);
    }
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        if (!s->judged[tier]) continue;
        const struct job job = {.fp32 = KERNEL_STRESS_NUMBERS,
                                .fp64 = KERNEL_STRESS_NUMBERS_FP64,
                                .tier = tier,
                                .count = count,
                                .what = function.what,
                                .power = function.power,
                                .in = in,
                                .out = out,
                                .in_each = STRESS_NUMBERS_IN,
                                .out_each = 3};
        done = job_run(s, &job);
        if (done) judge(&s->tally[tier], cases, out, count, function.wide && tier == TIER_FP64);
    }
    free(cases);
    free(in);
    free(out);
    return done;
}

static const struct number_function power = {.what = STRESS_POWER, .wide = true},
                                    own_power = {.what = STRESS_POWER, .wide = true, .power = POWER_OWN};
static const struct number_function phong = {.what = STRESS_PHONG, .wide = true}, specular = {.what = STRESS_PHONG};
static const struct number_function normalize = {.what = STRESS_NORMALIZE, .wide = true}, light = {.what = STRESS_LIGHT, .wide = true};
static const struct number_function unit_interval = {.what = STRESS_UNIT_INTERVAL}, direction = {.what = STRESS_CAMERA};
static const struct number_function disk_point = {.what = STRESS_DISK}, through_lens = {.what = STRESS_LENS};

bool numbers_opposite_light(struct stress *s) { return run_numbers(s, phong, opposite_light); }
bool numbers_power_of_nothing(struct stress *s) { return run_numbers(s, power, power_of_nothing); }
bool numbers_power_below_zero(struct stress *s) { return run_numbers(s, power, power_below_zero); }
bool numbers_over_one(struct stress *s) { return run_numbers(s, specular, over_one); }
bool numbers_power_near_one(struct stress *s) { return run_numbers(s, power, power_near_one); }
bool numbers_own_power_near_one(struct stress *s) { return run_numbers(s, own_power, own_power_near_one); }
bool numbers_any_length(struct stress *s) { return run_numbers(s, normalize, any_length); }
bool numbers_light_at_point(struct stress *s) { return run_numbers(s, light, light_at_point); }
bool numbers_light_far_away(struct stress *s) { return run_numbers(s, light, light_far_away); }
bool numbers_random(struct stress *s) { return run_numbers(s, unit_interval, random_numbers); }
bool numbers_last_pixel(struct stress *s) { return run_numbers(s, direction, last_pixel); }
bool numbers_disk(struct stress *s) { return run_numbers(s, disk_point, disk); }
bool numbers_lens(struct stress *s) { return run_numbers(s, through_lens, lens); }
