// Rows of shading: frames, mirrors, facets, lobes, one function of the shaders at a time.
//
// Right answers are calculated in fp64, in forms in which nothing cancels: they are off by 2^-29 of what fp32 may be. Where there are
// none such, MPFR gives them (glass.c, places.c).
#include "measure/stress/shading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ------------------------------------------------------------------------------------------------------------- the runner

void expect(struct shading_case *out, int k, double right, double slack) {
    out->right[k] = right;
    out->slack[k] = slack;
}

double dot_of(const float a[3], const float b[3]) { return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2]; }

bool is_unit(const float v[3], double slack) { return fabs(dot_of(v, v) - 1) <= 2 * slack; }

void unit_about(float out[3], struct random *random, const float *n, double least) {
    do {
        double v[3];
        random_direction(v, random);
        for (int k = 0; k < 3; k++) out[k] = (float)v[k];
    } while (n && !(dot_of(n, out) >= least));
}

// Whether a number is as it should be.
static bool as_expected(const struct shading_case *c, int k, float got) {
    return c->slack[k] < 0 ? isfinite(got) : fabs((double)got - c->right[k]) <= c->slack[k];
}

static void judge(struct tally *tally, const struct shading *shading, const struct shading_case *cases, const float *got, uint32_t count) {
    for (uint32_t i = 0; i < count; i++, got += STRESS_SHADING_OUT) {
        const struct shading_case *c = &cases[i];
        const float *in = c->in;
        int bad = 0;
        while (bad < (int)STRESS_SHADING_OUT && as_expected(c, bad, got[bad])) bad++;
        bool right = bad == (int)STRESS_SHADING_OUT, holds = !shading->holds || shading->holds(in, got);
        tally->rays++;
        if (!right)
            tally_wrong(tally, "of (%.9g, %.9g, %.9g, %.9g, %.9g …): number %d is %.9g, not %.9g within %.3g", in[0], in[1], in[2], in[3],
                        in[4], bad, got[bad], c->right[bad], c->slack[bad]);
        else if (!holds)
            tally_wrong(tally, "of (%.9g, %.9g, %.9g, %.9g, %.9g …): (%.9g, %.9g, %.9g) (%.9g, %.9g, %.9g)", in[0], in[1], in[2], in[3],
                        in[4], got[0], got[1], got[2], got[3], got[4], got[5]);
    }
}

// With the lowest tier of those, which promises the least.
static bool run_precision(struct stress *s, const struct shading *shading, const struct shading_case *cases, const float *in, float *out,
                          uint32_t count, bool fp64) {
    uint32_t first = fp64 ? TIER_FP64 : TIER_FAST, end = fp64 ? TIER_COUNT : TIER_FP64;
    while (first < end && !s->judged[first]) first++;
    if (first == end) return true;
    const struct job job = {.fp32 = KERNEL_STRESS_SHADING,
                            .fp64 = KERNEL_STRESS_SHADING_FP64,
                            .tier = first,
                            .effects = shading->effects,
                            .count = count,
                            .what = shading->what,
                            .in = in,
                            .out = out,
                            .in_each = STRESS_SHADING_IN,
                            .out_each = STRESS_SHADING_OUT};
    memset(out, 0, (size_t)count * STRESS_SHADING_OUT * sizeof *out);
    if (!job_run(s, &job)) return false;
    for (uint32_t tier = first; tier < end; tier++)
        if (s->judged[tier]) judge(&s->tally[tier], shading, cases, out, count);
    return true;
}

bool run_shading(struct stress *s, const struct shading *shading) {
    uint32_t count = s->rays / 4 + 64;
    struct shading_case *cases = array_alloc(s->ctx, count, sizeof *cases, "numbers");
    float *in = array_alloc(s->ctx, count, sizeof cases->in, "numbers");
    float *out = array_alloc(s->ctx, count, STRESS_SHADING_OUT * sizeof *out, "numbers");
    bool done = cases && in && out;
    for (uint32_t i = 0; done && i < count; i++) {
        cases[i] = (struct shading_case){0};
        shading->make(&cases[i], &s->random, i);
        memcpy(in + STRESS_SHADING_IN * i, cases[i].in, sizeof cases->in);
    }
    done = done && run_precision(s, shading, cases, in, out, count, false) && run_precision(s, shading, cases, in, out, count, true);
    free(cases);
    free(in);
    free(out);
    return done;
}

// ----------------------------------------------------------------------------------------------------------------- frames

// H07: J. Frisvad's basis is off by 0.3 at the two that T. Duff et al. name; and the axes, both zeros, and any.
static void frame(struct shading_case *out, struct random *random, uint32_t i) {
    static const float nasty[][3] = {{-0.00038527316f, 0.00038460016f, -0.99999988f}, {-0.00019813581f, -0.00008946839f, -0.99999988f},
                                     {0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0, -1, -0.0f}, {1, -0.0f, 0}, {0x1p-40f, 0, -1}};
    if (i % 16 < 8)
        memcpy(out->in, nasty[i % 16], sizeof nasty[0]);
    else
        unit_about(out->in, random, NULL, 0);
    for (int k = 0; k < 6; k++) expect(out, k, 0, -1);
}

// Orthonormal, and right-handed.
static bool is_frame(const float *n, const float *out) {
    const float *t = out, *b = out + 3;
    double handed = 0, slack = 8 * FP32_UNIT;
    for (int k = 0; k < 3; k++)
        handed += n[k] * ((double)t[(k + 1) % 3] * b[(k + 2) % 3] - (double)t[(k + 2) % 3] * b[(k + 1) % 3]);
    return is_unit(t, slack) && is_unit(b, slack) && fabs(dot_of(t, b)) <= slack && fabs(dot_of(n, t)) <= slack &&
           fabs(dot_of(n, b)) <= slack && fabs(handed - 1) <= 4 * slack;
}

bool shading_frames(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_FRAME, EFFECT_INDIRECT, frame, is_frame});
}

// ---------------------------------------------------------------------------------------------------------------- mirrors

// H13: 10, 100 and 1000 bounces between two mirrors, the normals as they are in fp32.
static void mirrors(struct shading_case *out, struct random *random, uint32_t i) {
    static const int bounces[] = {10, 100, 1000};
    int count = bounces[i % 3];
    double d[3], length;
    for (int k = 0; k < 3; k++) unit_about(out->in + 3 * k, random, NULL, 0);
    out->in[9] = (float)count;
    for (int k = 0; k < 3; k++) d[k] = out->in[6 + k];
    for (int bounce = 0; bounce < count; bounce++) {
        const float *n = out->in + 3 * (bounce & 1);
        double along = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        for (int k = 0; k < 3; k++) d[k] -= 2 * along * n[k];
        length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int k = 0; k < 3; k++) d[k] /= length;
    }
    for (int k = 0; k < 3; k++) expect(out, k, d[k], (8 + 4 * count) * FP32_UNIT);
}

static bool stays_unit(const float *in, const float *out) {
    (void)in;
    return is_unit(out, 4 * FP32_UNIT);
}

bool shading_mirrors(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_MIRRORS, EFFECT_REFLECTION, mirrors, stays_unit});
}

// ----------------------------------------------------------------------------------------------------------------- facets

// The formulas of ggx.glsl, with the sine from the cross product.
static void expect_facets(struct shading_case *out, double alpha) {
    const float *n = out->in, *wo = out->in + 3, *wi = out->in + 6;
    double h[3], length = 0, cos_n = 0, across = 0, cos_h = 0, a2 = alpha * alpha, cos_o = dot_of(n, wo), cos_i = dot_of(n, wi);
    for (int k = 0; k < 3; k++) h[k] = (double)wo[k] + wi[k];
    length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int k = 0; k < 3; k++) h[k] /= length, cos_n += n[k] * h[k], cos_h += wo[k] * h[k];
    for (int k = 0; k < 3; k++) {
        double c = n[(k + 1) % 3] * h[(k + 2) % 3] - n[(k + 2) % 3] * h[(k + 1) % 3];
        across += c * c;
    }
    double root = alpha / fmax(a2 * cos_n * cos_n + across, a2), slack = 32 * FP32_UNIT / alpha + 256 * FP32_UNIT;
    double from = sqrt(a2 + (1 - a2) * cos_o * cos_o), to = sqrt(a2 + (1 - a2) * cos_i * cos_i);
    double value = root * root * 0.5 * cos_i / (cos_i * from + cos_o * to), density = root * root * 0.5 / (cos_o + from);
    expect(out, 0, value, slack * value);
    expect(out, 1, density, slack * density);
    expect(out, 2, cos_h, 8 * FP32_UNIT);
}

// H14: no roughness, or little, at the highlight's peak and next to it. Roughness below 2^-5 counts as that.
static void facets(struct shading_case *out, struct random *random, uint32_t i) {
    static const float rough[] = {0, 1e-20f, 1e-4f, 0.03f, 0.1f, 1};
    float *n = out->in, *wo = out->in + 3, *wi = out->in + 6;
    unit_about(n, random, NULL, 0);
    unit_about(wo, random, n, 0.3);
    if (i % 4 == 0) memcpy(wo, n, 3 * sizeof *wo);
    double cosine = dot_of(n, wo), off = i % 4 < 2 ? 0 : 1e-3;
    for (int k = 0; k < 3; k++) wi[k] = (float)(2 * cosine * n[k] - wo[k] + off * random_in(random, -1, 1));
    out->in[9] = rough[i % 6];
    expect_facets(out, fmax((double)out->in[9] * out->in[9], 0x1p-10));
}

bool shading_facets(struct stress *s) { return run_shading(s, &(struct shading){SHADING_FACETS, EFFECT_GGX, facets, NULL}); }

// H16: a cosine over 1, below 0, and any.
static void grazing_rise(struct shading_case *out, struct random *random, uint32_t i) {
    float c = i % 3 == 0 ? 1 + (float)(i % 8) * 0x1p-23f : i % 3 == 1 ? (float)random_unit(random) : -(float)random_unit(random) * 1e-6f;
    double x = 1 - fmin(fmax(c, 0), 1);
    out->in[3] = c;
    for (int k = 0; k < 3; k++) {
        out->in[k] = (float)random_unit(random);
        expect(out, k, out->in[k] + (1 - (double)out->in[k]) * pow(x, 5), 8 * FP32_UNIT);
        if (c >= 1) expect(out, k, out->in[k], 0);
    }
}

bool shading_grazing(struct stress *s) { return run_shading(s, &(struct shading){SHADING_SCHLICK, EFFECT_GGX, grazing_rise, NULL}); }

// ------------------------------------------------------------------------------------------------------------------ lobes

// A random number: the first, the last, any.
static float nasty_unit(struct random *random) {
    uint32_t which = random_below(random, 4);
    return which == 0 ? 0 : which == 1 ? 1 - 0x1p-24f : (float)(random_bits(random) >> 8) * 0x1p-24f;
}

// H17: every model, lobes of any width, seen from anywhere.
static void lobe(struct shading_case *out, struct random *random, uint32_t i) {
    static const float exponents[] = {0, 1, 100, 1e7f}, rough[] = {0, 0.01f, 0.5f, 1};
    float *n = out->in + 2, *wo = out->in + 5;
    out->in[0] = (float)(i % 4);
    out->in[1] = i % 4 == METALLIC_ROUGHNESS_MODEL ? rough[i / 4 % 4] : exponents[i / 4 % 4];
    unit_about(n, random, NULL, 0);
    unit_about(wo, random, n, 0);
    if (i % 5 == 0) memcpy(wo, n, 3 * sizeof *wo);
    if (i % 5 == 1) // next to the horizon
        for (int k = 0; k < 3; k++) wo[k] = (float)(wo[k] - (1 - 1e-5) * dot_of(n, wo) * n[k]);
    for (int k = 8; k < 11; k++) out->in[k] = nasty_unit(random);
    for (int k = 11; k < 14; k++) out->in[k] = (float)random_unit(random) * 0.5f;
    for (int k = 0; k < 6; k++) expect(out, k, 0, -1);
}

// What is drawn has a direction above n, and a density unless it is a mirror's.
static bool is_drawn_well(const float *in, const float *out) {
    bool drawn = out[5] != 0, mirror = out[4] == 0 && in[13] > 0;
    return !drawn || (is_unit(out, 8 * FP32_UNIT) && dot_of(in + 2, out) > 0 && out[3] >= 0 && (out[4] > 0 || mirror));
}

bool shading_lobes(struct stress *s) {
    const uint32_t effects = EFFECT_INDIRECT | EFFECT_DIFFUSE | EFFECT_SPECULAR | EFFECT_BLINN | EFFECT_GGX | EFFECT_REFLECTION;
    return run_shading(s, &(struct shading){SHADING_LOBE, effects, lobe, is_drawn_well});
}
