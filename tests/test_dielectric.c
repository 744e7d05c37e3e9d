// Glass: the shaders' fp32 and fp64 against the reference and against MPFR, the hard cases, and what overlaps.
#include "fixture.h"

#include <math.h>
#include <mpfr.h>

#include "reference/dielectric.h"
#include "reference/vector.h"
#include "shaders/shared.h"
#include "twin_bounce.h"
#include "twin_dielectric.h"
#include "twin_dielectric_fp64.h"
#include "twin_media.h"

#define CASES 4096
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

// As the kernel reads it.
struct given {
    float n[3], ng[3], wo[3], here, beyond, choice, tint, sigma, unit, way;
};

// As the kernel writes it, in the type of its numbers.
#define TOLD(real)                                                                                                                         \
    { real reflected, wi[3], weight, transmitted, sheet_wi[3], sheet_weight, sheet_transmitted, left; }
struct told32 TOLD(float);
struct told TOLD(double);

static uint32_t random_state = 1;

static uint32_t random_bits(void) {
    random_state = random_state * 747796405u + 2891336453u;
    uint32_t word = ((random_state >> ((random_state >> 28) + 4)) ^ random_state) * 277803737u;
    return (word >> 22) ^ word;
}

static float random_unit(void) { return (float)(random_bits() >> 8) * 0x1p-24f; }

static void random_direction(float v[3], const float *n) {
    double length, along;
    do {
        length = along = 0;
        for (int i = 0; i < 3; i++) {
            v[i] = 2 * random_unit() - 1;
            length += v[i] * v[i];
            along += n ? v[i] * n[i] : 0;
        }
    } while (length > 1 || length < 0.01);
    for (int i = 0; i < 3; i++) v[i] = along < 0 ? -v[i] : v[i];
}

static struct given random_given(int i) {
    static const float indices[] = {1, 1.00000012f, 1.33f, 1.5f, 2.4f};
    struct given g = {.choice = random_unit(), .tint = 0.5f, .unit = 1, .sigma = 3 * random_unit(), .way = 5 * random_unit()};
    g.here = indices[random_bits() % COUNT(indices)];
    g.beyond = i % 8 == 0 ? 0.5f + random_unit() : indices[random_bits() % COUNT(indices)];
    random_direction(g.ng, NULL);
    random_direction(g.n, g.ng);
    if (i % 4) memcpy(g.n, g.ng, sizeof g.n);
    random_direction(g.wo, g.ng);
    return g;
}

static void run(struct told *told, const struct given *given, uint32_t count, bool fp64) {
    static struct told32 narrow[CASES];
    assert_true(count <= CASES);
    if (fp64) {
        fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_dielectric_fp64), .in = given, .in_bytes = count * sizeof *given, .out = told,
                                          .out_bytes = count * sizeof *told, .count = count});
    } else {
        fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_dielectric), .in = given, .in_bytes = count * sizeof *given, .out = narrow,
                                          .out_bytes = count * sizeof *narrow, .count = count});
        for (size_t i = 0; i < count * (sizeof *told / sizeof(double)); i++) ((double *)told)[i] = ((float *)narrow)[i];
    }
}

// ------------------------------------------------------------------------------------------------ against the reference

struct directions {
    double n[3], ng[3], wo[3];
};

static struct directions directions_of(const struct given *g) {
    struct directions d;
    for (int i = 0; i < 3; i++) {
        d.n[i] = g->n[i];
        d.ng[i] = g->ng[i];
        d.wo[i] = g->wo[i];
    }
    vector_normalize(d.n);
    vector_normalize(d.ng);
    vector_normalize(d.wo);
    return d;
}

static bool near(double got, double right, double limit) { return fabs(got - right) <= limit; }

static double distance(const double a[3], const double b[3]) {
    double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(vector_dot(d, d));
}

// What is lost where little light is left to refract: near the critical angle the cosine beyond is the root of a small difference, and
// falls with it.
static double tolerance(const struct given *g, double cosine, double unit) {
    double square = fabs(1 - (double)g->here * g->here / ((double)g->beyond * g->beyond) * (1 - cosine * cosine));
    return 64 * unit / fmax(sqrt(square), sqrt(unit));
}

// A choice at the edge may go either way.
static int compare(const struct told *got, const struct given *g, double unit) {
    struct directions d = directions_of(g);
    struct ref_sample glass, sheet;
    const double tint[3] = {g->tint, g->tint, g->tint}, cosine = vector_dot(d.n, d.wo);
    ref_dielectric_sample(&glass, d.n, d.ng, d.wo, g->here, g->beyond, tint, g->choice);
    ref_dielectric_sheet_sample(&sheet, d.n, d.ng, d.wo, g->beyond, tint, g->choice);
    double limit = tolerance(g, fmax(cosine, 0), unit), along = tolerance(g, vector_dot(d.ng, d.wo), unit);
    double right = ref_fresnel(cosine, g->here, g->beyond), left = ref_absorb(g->sigma, g->way);
    if (cosine > 0 && !near(got->reflected, right, limit)) fail_msg("sends back %.9g, not %.9g", got->reflected, right);
    if (!near(got->left, left, 64 * unit * (left + 0.01))) fail_msg("leaves %.9g, not %.9g", got->left, left);
    if (got->transmitted != glass.transmitted || got->sheet_transmitted != sheet.transmitted) return 1;
    assert_true(got->weight == glass.weight[0] && got->sheet_weight == sheet.weight[0]);
    if (!(distance(got->wi, glass.wi) <= fmax(limit, along))) return 1; // about the other normal
    if (!(distance(got->sheet_wi, sheet.wi) <= 32 * unit)) return 1;
    return 0;
}

static void agrees(bool fp64, double unit) {
    static struct given given[CASES];
    static struct told told[CASES];
    for (int i = 0; i < CASES; i++) given[i] = random_given(i);
    run(told, given, CASES, fp64);
    int elsewhere = 0, caught = 0, transmitted = 0;
    for (int i = 0; i < CASES; i++) {
        elsewhere += compare(&told[i], &given[i], unit);
        transmitted += told[i].transmitted > 0;
        struct told wrong = told[i];
        wrong.wi[0] += 1e-3;
        caught += compare(&wrong, &given[i], unit);
    }
    assert_true(elsewhere <= 2);
    assert_true(caught > CASES * 9 / 10 && transmitted > CASES / 3 && transmitted < CASES);
}

static void fp32_agrees_with_the_reference(void **state) {
    (void)state;
    agrees(false, 0x1p-24);
}

static void fp64_agrees_with_the_reference(void **state) {
    (void)state;
    if (!fixture_device()->has_fp64) skip();
    agrees(true, 0x1p-48);
}

// White glass loses nothing: of every ray the weight is 1, and the direction is unit and on the side that it says, whatever the shading
// normal.
static void glass_keeps_all_light(void **state) {
    (void)state;
    static struct given given[CASES];
    static struct told told[CASES];
    for (int i = 0; i < CASES; i++) {
        given[i] = random_given(4 * i);
        given[i].tint = 1;
        if (i % 3 == 0) memcpy(given[i].wo, (float[3]){given[i].ng[1], -given[i].ng[0], 1e-6f * given[i].ng[2]}, sizeof given[i].wo);
    }
    run(told, given, CASES, false);
    for (int i = 0; i < CASES; i++) {
        struct directions d = directions_of(&given[i]);
        double side = vector_dot(told[i].wi, d.ng) * (told[i].transmitted > 0 ? -1 : 1);
        assert_true(told[i].weight == 1 && told[i].sheet_weight == 1);
        assert_true(fabs(vector_dot(told[i].wi, told[i].wi) - 1) <= 1e-6);
        assert_true(side >= -1e-6);
        assert_true(told[i].reflected >= 0 && told[i].reflected <= 1);
    }
}

// ------------------------------------------------------------------------------------------------------------ hard cases

// The share sent back and what is left of 1, with 200 bits.
static void fresnel_exact(double *reflected, double *rest, double cosine, double here, double beyond) {
    mpfr_t c, w, s, p, t;
    mpfr_inits2(200, c, w, s, p, t, (mpfr_ptr)0);
    mpfr_set_d(c, cosine, MPFR_RNDN);
    mpfr_sqr(t, c, MPFR_RNDN);
    mpfr_ui_sub(t, 1, t, MPFR_RNDN); // sin²
    mpfr_mul_d(t, t, here, MPFR_RNDN);
    mpfr_mul_d(t, t, here, MPFR_RNDN);
    mpfr_set_d(w, beyond, MPFR_RNDN);
    mpfr_sqr(w, w, MPFR_RNDN);
    mpfr_sub(w, w, t, MPFR_RNDN); // beyond² cos² beyond
    *reflected = 1;
    *rest = 0;
    if (mpfr_sgn(w) > 0) {
        mpfr_sqrt(w, w, MPFR_RNDN);
        mpfr_mul_d(t, c, here, MPFR_RNDN);
        mpfr_sub(s, t, w, MPFR_RNDN);
        mpfr_add(t, t, w, MPFR_RNDN);
        mpfr_div(s, s, t, MPFR_RNDN);
        mpfr_mul_d(c, c, beyond, MPFR_RNDN);
        mpfr_mul_d(c, c, beyond, MPFR_RNDN);
        mpfr_mul_d(w, w, here, MPFR_RNDN);
        mpfr_sub(p, c, w, MPFR_RNDN);
        mpfr_add(t, c, w, MPFR_RNDN);
        mpfr_div(p, p, t, MPFR_RNDN);
        mpfr_sqr(s, s, MPFR_RNDN);
        mpfr_sqr(p, p, MPFR_RNDN);
        mpfr_add(s, s, p, MPFR_RNDN);
        mpfr_div_2ui(s, s, 1, MPFR_RNDN);
        *reflected = mpfr_get_d(s, MPFR_RNDN);
        mpfr_ui_sub(s, 1, s, MPFR_RNDN);
        *rest = mpfr_get_d(s, MPFR_RNDN);
    }
    mpfr_clears(c, w, s, p, t, (mpfr_ptr)0);
}

// wo with exactly this cosine; it is as unit as fp32 can be.
static struct given at_cosine(float cosine, float here, float beyond) {
    struct given g = {.n = {0, 0, 1}, .ng = {0, 0, 1}, .here = here, .beyond = beyond, .choice = 1 - 0x1p-24f, .tint = 1, .way = 1};
    g.wo[0] = (float)sqrt(1 - (double)cosine * cosine);
    g.wo[2] = cosine;
    return g;
}

struct fresnel_case {
    const char *name;
    float cosine, here, beyond;
    double limit; // relative, of the share sent back; of what is left where that is smaller
};

static const struct fresnel_case FRESNEL[] = {
    {"head-on", 1, 1, 1.5f, 1e-6},
    {"head-on, from inside", 1, 1.5f, 1, 1e-6},
    {"indices next to each other", 1, 1, 1.00000012f, 1e-6},
    {"indices next to each other, aslant", 0.5f, 1, 1.00000012f, 1e-6},
    {"indices next to each other, grazing", 1e-3f, 1, 1.00000012f, 1e-5},
    {"grazing", 1e-4f, 1, 1.5f, 1e-3},
    {"grazing, diamond", 1e-3f, 1, 2.4f, 1e-4},
    {"beside the critical angle", 0.7454f, 1.5f, 1, 1e-3},
    {"beyond the critical angle", 0.7f, 1.5f, 1, 0},
    {"along the surface", 0, 1, 1.5f, 0},
};

static void fresnel_by_mpfr(void **state) {
    (void)state;
    struct given given[COUNT(FRESNEL)];
    struct told told[COUNT(FRESNEL)];
    for (size_t i = 0; i < COUNT(FRESNEL); i++) given[i] = at_cosine(FRESNEL[i].cosine, FRESNEL[i].here, FRESNEL[i].beyond);
    run(told, given, COUNT(FRESNEL), false);
    for (size_t i = 0; i < COUNT(FRESNEL); i++) {
        const struct fresnel_case *c = &FRESNEL[i];
        double reflected, rest;
        fresnel_exact(&reflected, &rest, c->cosine, c->here, c->beyond);
        double limit = c->limit * fmin(reflected, rest) + (rest > 0 && reflected > 0.5 ? 0x1p-24 : 0); // half an ulp below 1
        if (!near(told[i].reflected, reflected, limit)) fail_msg("%s: %.9g, not %.9g", c->name, told[i].reflected, reflected);
        assert_true(rest == 0 || !near(told[i].reflected * (1 + 1e-3), reflected, limit));
    }
    assert_true(near(told[2].reflected, 3.5527133e-15, 1e-21)); // ((η - 1)/(η + 1))²
}

// Within 200 ulp of the critical cosine √5/3: what is decided, and the cosine beyond, are those of a cosine that is off by 2 ulp at most.
// The cosine beyond is the root of a small difference, which makes 7.5e-5 of the roundings of its terms.
static void around_the_critical_angle(void **state) {
    (void)state;
    enum { REACH = 200 };
    struct given given[2 * REACH + 1];
    struct told told[2 * REACH + 1];
    const double critical = sqrt(5) / 3;
    for (int i = 0; i <= 2 * REACH; i++) given[i] = at_cosine((float)critical + (float)(i - REACH) * 0x1p-24f, 1.5f, 1);
    run(told, given, COUNT(given), false);
    double worst = 0;
    for (int i = 0; i <= 2 * REACH; i++) {
        double cosine = given[i].wo[2], low = cosine - 0x1p-23, high = cosine + 0x1p-23;
        if (fabs(cosine - critical) > 0x1p-23) assert_true(told[i].transmitted == (cosine > critical));
        if (told[i].transmitted == 0) continue;
        double got = -told[i].wi[2];
        assert_true(got >= sqrt(fmax(1 - 2.25 * (1 - low * low), 0)) - 1e-6 && got <= sqrt(1 - 2.25 * (1 - high * high)) + 1e-6);
        worst = fmax(worst, fabs(got - sqrt(fmax(1 - 2.25 * (1 - cosine * cosine), 0))));
    }
    assert_true(worst > 0 && worst < 1e-4);
}

// Half way: sin² beyond is exactly 1 if the cosine is √¾, which lies between two fp32 numbers. On the side where it is not below 1 all is
// sent back.
static void the_critical_angle_is_closed(void **state) {
    (void)state;
    float below = (float)sqrt(0.75);
    if ((double)below * below > 0.75) below = nextafterf(below, 0);
    struct given given[] = {at_cosine(below, 2, 1), at_cosine(nextafterf(nextafterf(below, 1), 1), 2, 1), at_cosine(0, 2, 1),
                            at_cosine(0, 1, 2)};
    struct told told[COUNT(given)];
    run(told, given, COUNT(given), false);
    assert_true(told[0].transmitted == 0 && told[0].reflected == 1 && told[0].weight == 1);
    assert_true(told[1].transmitted == 1);
    assert_true(told[2].transmitted == 0 && told[3].transmitted == 0 && told[3].reflected == 1);
    for (size_t i = 0; i < COUNT(given); i++)
        for (int k = 0; k < 3; k++) assert_true(isfinite(told[i].wi[k]));
}

// At θ = 10^-3, 2·10^-4 and 10^-6 the refracted ray leans by the sine over η, which a sine from the fp32 cosine would miss by 2 %, and by
// all of it.
static void small_angles_are_kept(void **state) {
    (void)state;
    static const double angles[] = {1e-3, 2e-4, 1e-6};
    for (size_t i = 0; i < COUNT(angles); i++) {
        struct given g = at_cosine((float)cos(angles[i]), 1, 1.5f);
        struct told t;
        g.wo[0] = (float)sin(angles[i]);
        run(&t, &g, 1, false);
        double cosine = g.wo[2], naive = sqrt(1 - cosine * cosine) / 1.5;
        assert_true(near(-t.wi[0], g.wo[0] / 1.5, 1e-6 * g.wo[0]));
        assert_false(near(naive, g.wo[0] / 1.5, 1e-6 * g.wo[0]));
    }
}

// Between media of one index there is nothing: no light back, and the direction to the bit, be it unit or not, seen from anywhere.
static void equal_indices_change_nothing(void **state) {
    (void)state;
    static struct given given[CASES];
    static struct told told[CASES];
    for (int i = 0; i < CASES; i++) {
        given[i] = random_given(i);
        given[i].beyond = given[i].here = 1 + random_unit();
        given[i].choice = 0;
        given[i].unit = 0;
        if (i % 5 == 0) memcpy(given[i].wo, (float[3]){given[i].ng[1], -given[i].ng[0], -0.0f}, sizeof given[i].wo);
    }
    run(told, given, CASES, false);
    for (int i = 0; i < CASES; i++) {
        assert_true(told[i].reflected == 0 && told[i].transmitted == 1);
        for (int k = 0; k < 3; k++) {
            float got = (float)told[i].wi[k], right = -given[i].wo[k];
            assert_memory_equal(&got, &right, sizeof got);
        }
    }
}

struct absorption_case {
    float sigma, way;
    double left;
};

static void absorption_at_its_ends(void **state) {
    (void)state;
    static const struct absorption_case cases[] = {{0, -1, 1}, {2, -1, 0},        {0, 1e30f, 1},
                                                   {1, 0, 1},  {1e30f, 1e30f, 0}, {0.5f, 2, 0.36787944117144233}};
    struct given given[COUNT(cases)];
    struct told told[COUNT(cases)];
    for (size_t i = 0; i < COUNT(cases); i++) {
        given[i] = at_cosine(1, 1, 1.5f);
        given[i].sigma = cases[i].sigma;
        given[i].way = cases[i].way; // negative: infinite
    }
    for (int fp64 = 0; fp64 <= fixture_device()->has_fp64; fp64++) {
        run(told, given, COUNT(cases), fp64);
        for (size_t i = 0; i < COUNT(cases); i++)
            if (!near(told[i].left, cases[i].left, 2e-7 * cases[i].left))
                fail_msg("exp(-%g·%g) = %g", cases[i].sigma, cases[i].way, told[i].left);
    }
}

// Up to 1000 total reflections in a ball of glass: no ray gets out, directions stay unit, and the distance of the path from the center is
// kept (to 6e-6).
static void bounces_inside_a_ball(void **state) {
    (void)state;
    static const int bounces[] = {10, 100, 1000};
    float in[COUNT(bounces) * 64 * 8], out[COUNT(in)];
    for (size_t i = 0; i < COUNT(in) / 8; i++) {
        float *g = &in[8 * i], p[3], d[3];
        double along, n[3], w[3];
        do { // within 45° to 80° of the normal, beyond the critical angle
            random_direction(p, NULL);
            random_direction(d, NULL);
            for (int k = 0; k < 3; k++) n[k] = p[k], w[k] = d[k];
            vector_normalize(n);
            vector_normalize(w);
            along = vector_dot(n, w);
        } while (!(along < -0.17 && along > -0.7));
        for (int k = 0; k < 3; k++) g[k] = (float)n[k], g[3 + k] = (float)w[k];
        g[6] = (float)bounces[i / 64];
        g[7] = 1.5f;
    }
    fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_bounce), .in = in, .in_bytes = sizeof in, .out = out, .out_bytes = sizeof out,
                                      .count = COUNT(in) / 8});
    double drift[COUNT(bounces)] = {0};
    for (size_t i = 0; i < COUNT(in) / 8; i++) {
        double square[2];
        for (int k = 0; k < 2; k++) {
            const float *g = k ? &out[8 * i] : &in[8 * i];
            double p[3] = {g[0], g[1], g[2]}, d[3] = {g[3], g[4], g[5]}, along = vector_dot(p, d);
            square[k] = sqrt(1 - along * along / (vector_dot(p, p) * vector_dot(d, d)));
        }
        assert_true(out[8 * i + 6] == 0 && out[8 * i + 7] <= 2.5e-7f);
        drift[i / 64] = fmax(drift[i / 64], fabs(square[0] - square[1]));
    }
    for (size_t k = 0; k < COUNT(bounces); k++) assert_true(drift[k] <= 1e-6 * sqrt(bounces[k]));
}

// ---------------------------------------------------------------------------------------------------------------- media

enum { SURFACES = 8 };
struct surface_case {
    float material, priority, entering;
};
struct change {
    float counts, here, beyond;
};

struct media_case {
    const char *name;
    struct surface_case surfaces[SURFACES];
    struct change right[SURFACES];
};

// Materials 0 (glass) and 1 (water), 2 (ice), by their number + 1. What follows the last row is not looked at.
// clang-format off
static const struct media_case MEDIA[] = {
    {"in and out", {{0, 0, 1}, {0, 0, 0}}, {{1, 0, 1}, {1, 1, 0}}},
    {"water reaches into its glass, which wins", {{1, 1, 1}, {0, 2, 1}, {1, 1, 0}, {0, 2, 0}}, {{1, 0, 2}, {1, 2, 1}, {0, 2, 1}, {1, 1, 0}}},
    {"the same from the other side", {{0, 2, 1}, {1, 1, 1}, {0, 2, 0}, {1, 1, 0}}, {{1, 0, 1}, {0, 1, 2}, {1, 1, 2}, {1, 2, 0}}},
    {"equal priorities: the higher number wins", {{0, 0, 1}, {1, 0, 1}, {0, 0, 0}, {1, 0, 0}}, {{1, 0, 1}, {1, 1, 2}, {0, 1, 2}, {1, 2, 0}}},
    {"ice in water", {{1, 1, 1}, {2, 5, 1}, {2, 5, 0}, {1, 1, 0}}, {{1, 0, 2}, {1, 2, 3}, {1, 3, 2}, {1, 2, 0}}},
    {"two balls of one glass that overlap", {{0, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}}, {{1, 0, 1}, {0, 1, 1}, {0, 1, 1}, {1, 1, 0}}},
    {"a camera in the glass", {{0, 0, 0}, {0, 0, 1}, {0, 0, 0}}, {{1, 1, 0}, {1, 0, 1}, {1, 1, 0}}},
};

// clang-format on

static void run_media(struct change *out, const struct surface_case *in, uint32_t count) {
    const size_t bytes = count * SURFACES * sizeof *in;
    fixture_run(
        &(struct fixture_job){FIXTURE_KERNEL(twin_media), .in = in, .in_bytes = bytes, .out = out, .out_bytes = bytes, .count = count});
}

static void media_by_hand(void **state) {
    (void)state;
    struct surface_case in[COUNT(MEDIA)][SURFACES];
    struct change out[COUNT(MEDIA)][SURFACES];
    for (size_t i = 0; i < COUNT(MEDIA); i++) memcpy(in[i], MEDIA[i].surfaces, sizeof in[i]);
    run_media(out[0], in[0], COUNT(MEDIA));
    for (size_t i = 0; i < COUNT(MEDIA); i++) {
        for (int k = 0; k < SURFACES; k++) {
            const struct change *right = &MEDIA[i].right[k], *got = &out[i][k];
            if (right->here == 0 && right->beyond == 0) break;
            // a surface that does not count says nothing about its sides
            bool same = got->counts == right->counts && (!got->counts || (got->here == right->here && got->beyond == right->beyond));
            if (!same) fail_msg("%s, surface %d: %g %g %g", MEDIA[i].name, k, got->counts, got->here, got->beyond);
        }
    }
}

// Spans of a line, four at random: the device and the reference see the same, and the way back sees what the way there does.
static void media_there_and_back(void **state) {
    (void)state;
    enum { LINES = 512 };
    static struct surface_case in[2 * LINES][SURFACES];
    static struct change out[2 * LINES][SURFACES];
    for (int i = 0; i < LINES; i++) {
        struct surface_case spans[4];
        for (int k = 0; k < 4; k++) spans[k] = (struct surface_case){(float)(random_bits() % 3), 0, 0};
        for (int k = 0; k < 4; k++) spans[k].priority = (float)(((uint32_t)i >> (2 * (int)spans[k].material)) & 3);
        int open[4] = {0, 1, 2, 3}, opened = 0;
        bool inside[4] = {false};
        for (int k = 0; k < SURFACES; k++) { // opens the next one, or closes some that is open
            int closable[4], closables = 0;
            for (int j = 0; j < 4; j++)
                if (inside[j]) closable[closables++] = j;
            bool opens = opened < 4 && (closables == 0 || random_bits() % 2);
            int which = opens ? open[opened++] : closable[random_bits() % (uint32_t)closables];
            inside[which] = opens;
            in[i][k] = (struct surface_case){spans[which].material, spans[which].priority, opens};
            in[LINES + i][SURFACES - 1 - k] = (struct surface_case){spans[which].material, spans[which].priority, !opens};
        }
    }
    run_media(out[0], in[0], 2 * LINES);
    int counted = 0, ignored = 0;
    for (int i = 0; i < 2 * LINES; i++) {
        struct ref_media media = {.count = 0};
        for (int k = 0; k < SURFACES; k++) {
            const struct surface_case *s = &in[i][k];
            const struct change *got = &out[i][k], *back = &out[(i + LINES) % (2 * LINES)][SURFACES - 1 - k];
            struct ref_media_change right = ref_media_cross(&media, (uint32_t)s->material, (uint32_t)s->priority, s->entering != 0);
            assert_true(got->counts == right.counts && got->here == (float)right.here && got->beyond == (float)right.beyond);
            assert_true(got->counts == back->counts);
            if (got->counts) assert_true(got->here == back->beyond && got->beyond == back->here);
            media = right.after;
            counted += right.counts;
            ignored += !right.counts;
        }
        assert_true(media.count == 0 && ref_media_top(&media) == 0);
    }
    assert_true(counted > LINES && ignored > LINES);
}

// More than the list holds, and what was never entered: the device forgets what the reference forgets.
static void media_in_disorder(void **state) {
    (void)state;
    static struct surface_case in[CASES][SURFACES];
    static struct change out[CASES][SURFACES];
    for (int i = 0; i < CASES; i++) {
        for (int k = 0; k < SURFACES; k++) {
            uint32_t material = random_bits() % 7;
            in[i][k] = (struct surface_case){(float)material, (float)(material % 3), random_bits() % 4 != 0};
        }
    }
    run_media(out[0], in[0], CASES);
    for (int i = 0; i < CASES; i++) {
        struct ref_media media = {.count = 0};
        for (int k = 0; k < SURFACES; k++) {
            const struct surface_case *s = &in[i][k];
            struct ref_media_change right = ref_media_cross(&media, (uint32_t)s->material, (uint32_t)s->priority, s->entering != 0);
            assert_true(out[i][k].counts == right.counts && out[i][k].here == (float)right.here && out[i][k].beyond == (float)right.beyond);
            media = right.after;
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fp32_agrees_with_the_reference),
        cmocka_unit_test(fp64_agrees_with_the_reference),
        cmocka_unit_test(glass_keeps_all_light),
        cmocka_unit_test(fresnel_by_mpfr),
        cmocka_unit_test(around_the_critical_angle),
        cmocka_unit_test(the_critical_angle_is_closed),
        cmocka_unit_test(small_angles_are_kept),
        cmocka_unit_test(equal_indices_change_nothing),
        cmocka_unit_test(absorption_at_its_ends),
        cmocka_unit_test(bounces_inside_a_ball),
        cmocka_unit_test(media_by_hand),
        cmocka_unit_test(media_there_and_back),
        cmocka_unit_test(media_in_disorder),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
