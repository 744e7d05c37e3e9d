// What surfaces do to light: the shaders' fp32 and fp64 against the reference, samples against densities, energy against numbers that are
// known, and the hard cases.
#include "fixture.h"

#include <math.h>

#include "chi_squared.h"
#include "reference/bsdf.h"
#include "reference/vector.h"
#include "shaders/shared.h"
#include "twin_bsdf.h"
#include "twin_bsdf_fp64.h"
#include "twin_bsdf_phong.h"

#define PI 3.14159265358979323846
#define CASES 4096
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

// As the kernel reads it.
struct given {
    float model, diffuse[3], specular[3], reflection[3], shininess, metallic, roughness, ior;
    float n[3], ng[3], wo[3], wi[3], u[2], choice, unused[3];
};

// As the kernel writes it, in the type of its numbers.
#define TOLD(real)                                                                                                                         \
    { real value[3], pdf, drawn, wi[3], weight[3], sample_pdf; }
struct told32 TOLD(float);
struct told TOLD(double);

// --------------------------------------------------------------------------------------------------------------- inputs

static uint32_t random_state = 1;

static uint32_t random_bits(void) {
    random_state = random_state * 747796405u + 2891336453u;
    uint32_t word = ((random_state >> ((random_state >> 28) + 4)) ^ random_state) * 277803737u;
    return (word >> 22) ^ word;
}

static float random_unit(void) { return (float)(random_bits() >> 8) * 0x1p-24f; }

static void random_color(float v[3]) {
    for (int i = 0; i < 3; i++) v[i] = random_unit();
}

// On the side of n, if there is one.
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

// Any material; normals that bend a little away from the geometric one.
static struct given random_given(int i) {
    struct given g = {.model = (float)(i % 6), .metallic = random_unit(), .roughness = random_unit(), .ior = 1 + random_unit()};
    random_color(g.diffuse);
    random_color(g.specular);
    random_color(g.reflection);
    if (i % 3 == 0) memset(g.reflection, 0, sizeof g.reflection);
    g.shininess = i % 8 == 0 ? 0 : 100 * random_unit();
    random_direction(g.ng, NULL);
    random_direction(g.n, g.ng);
    if (i % 4) memcpy(g.n, g.ng, sizeof g.n);
    random_direction(g.wo, g.ng);
    random_direction(g.wi, i % 16 == 0 ? NULL : g.ng);
    for (int k = 0; k < 2; k++) g.u[k] = random_unit();
    g.choice = random_unit();
    return g;
}

static struct ref_bsdf bsdf_of(const struct given *g, uint32_t effects) {
    struct scene_material m = {.model = (enum material_model)g->model,
                               .shininess = g->shininess,
                               .metallic = g->metallic,
                               .roughness = g->roughness,
                               .ior = g->ior};
    memcpy(m.diffuse, g->diffuse, sizeof m.diffuse);
    memcpy(m.specular, g->specular, sizeof m.specular);
    memcpy(m.reflection, g->reflection, sizeof m.reflection);
    return ref_bsdf_make(&m, effects);
}

struct directions {
    double n[3], ng[3], wo[3], wi[3];
};

static struct directions directions_of(const struct given *g) {
    struct directions d;
    const float *from[] = {g->n, g->ng, g->wo, g->wi};
    double *to[] = {d.n, d.ng, d.wo, d.wi};
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < 3; i++) to[k][i] = from[k][i];
        vector_normalize(to[k]);
    }
    return d;
}

static struct told right_of(const struct given *g, uint32_t effects) {
    struct told t = {.drawn = 0};
    struct ref_bsdf b = bsdf_of(g, effects);
    struct directions d = directions_of(g);
    struct ref_sample s;
    ref_bsdf_eval(t.value, &b, d.n, d.wo, d.wi);
    t.pdf = ref_bsdf_pdf(&b, d.n, d.wo, d.wi);
    t.drawn = ref_bsdf_sample(&s, &b, d.n, d.ng, d.wo, g->u, g->choice);
    memcpy(t.wi, s.wi, sizeof t.wi);
    memcpy(t.weight, s.weight, sizeof t.weight);
    t.sample_pdf = s.pdf;
    return t;
}

// ---------------------------------------------------------------------------------------------------------------- kernel

#define ALL 0xffffffffu

// With the own power function, and without the effects that are no bits of `effects`.
static size_t constants_of(struct kernel_constant constants[EFFECT_COUNT + 1], uint32_t effects) {
    for (uint32_t i = 0; i < EFFECT_COUNT; i++) constants[i] = (struct kernel_constant){i, effects >> i & 1};
    constants[EFFECT_COUNT] = (struct kernel_constant){CONSTANT_POWER, POWER_OWN};
    return EFFECT_COUNT + 1;
}

static void run(struct told *told, const struct given *given, uint32_t count, uint32_t effects, bool fp64) {
    struct kernel_constant constants[EFFECT_COUNT + 1];
    size_t constant_count = constants_of(constants, effects);
    struct told32 *narrow = malloc(count * sizeof *narrow);
    assert_non_null(narrow);
    memset(narrow, 0, count * sizeof *narrow);
    if (fp64) {
        fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_bsdf_fp64), .constants = constants, .constant_count = constant_count,
                                          .in = given, .in_bytes = count * sizeof *given, .out = told, .out_bytes = count * sizeof *told,
                                          .count = count});
    } else {
        fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_bsdf), .constants = constants, .constant_count = constant_count, .in = given,
                                          .in_bytes = count * sizeof *given, .out = narrow, .out_bytes = count * sizeof *narrow,
                                          .count = count});
        for (size_t i = 0; i < count * (sizeof *told / sizeof(double)); i++) ((double *)told)[i] = ((float *)narrow)[i];
    }
    free(narrow);
}

// ------------------------------------------------------------------------------------------------ against the reference

// How far fp32 or fp64 may be off, relative: 64 roundings, and what they do to the cosine of a highlight, whose logarithm is multiplied by
// the exponent, or to the sine of GGX's, which is divided by α.
static double tolerance(const struct given *g, double unit) {
    double alpha = fmax(g->roughness * g->roughness, 0x1p-10);
    return unit * (64 + (g->model == METALLIC_ROUGHNESS_MODEL ? 16 / alpha : 8 * g->shininess));
}

static bool near(double got, double right, double relative) { return fabs(got - right) <= relative * (fabs(right) + 0.01); }

// A case at the edge between two lobes or of the horizon may go either way: its sample lands elsewhere, or is refused.
static int compare(const struct told *got, const struct told *right, const struct given *g, double unit) {
    double relative = tolerance(g, unit);
    for (int k = 0; k < 3; k++)
        if (!near(got->value[k], right->value[k], relative)) fail_msg("value %g, not %g", got->value[k], right->value[k]);
    if (!near(got->pdf, right->pdf, relative)) fail_msg("pdf %g, not %g", got->pdf, right->pdf);
    if (got->drawn != right->drawn) return 1;
    if (!right->drawn) return 0;
    for (int k = 0; k < 3; k++)
        if (!(fabs(got->wi[k] - right->wi[k]) <= relative)) return 1;
    for (int k = 0; k < 3; k++)
        if (!near(got->weight[k], right->weight[k], 8 * relative))
            fail_msg("model %g weight %g, not %g", g->model, got->weight[k], right->weight[k]);
    if (!near(got->sample_pdf, right->sample_pdf, 8 * relative)) fail_msg("pdf of sample %g, not %g", got->sample_pdf, right->sample_pdf);
    return 0;
}

static void agrees(bool fp64, double unit) {
    static struct given given[CASES];
    static struct told told[CASES];
    for (int i = 0; i < CASES; i++) given[i] = random_given(i);
    run(told, given, CASES, ALL, fp64);
    int lit = 0, elsewhere = 0, caught = 0;
    for (int i = 0; i < CASES; i++) {
        struct told right = right_of(&given[i], ALL);
        elsewhere += compare(&told[i], &right, &given[i], unit);
        lit += right.value[0] > 0.01;
        caught += !near(told[i].value[0], right.value[0] * (1 + 4 * tolerance(&given[i], unit)), tolerance(&given[i], unit));
    }
    assert_true(elsewhere <= 2);
    assert_true(lit > CASES / 3 && caught > CASES / 4);
}

static void fp32_agrees_with_the_reference(void **state) {
    (void)state;
    agrees(false, 0x1p-24);
}

static void fp64_agrees_with_the_reference(void **state) {
    (void)state;
    if (!fixture_device()->has_fp64) skip();
    agrees(true, 0x1p-40); // the reference's own GGX loses digits at the peak
}

// phong_reflect, which is the contract's, and bsdf_eval with a Phong material.
static void contract_is_kept_to_the_bit(void **state) {
    (void)state;
    static float in[CASES * 16], out[CASES * 6];
    for (int i = 0; i < CASES; i++) {
        struct given g = random_given(i);
        struct directions d = directions_of(&g);
        memcpy(&in[16 * i], g.diffuse, 6 * sizeof(float));
        in[16 * i + 6] = g.shininess;
        for (int k = 0; k < 3; k++) {
            in[16 * i + 7 + k] = (float)d.n[k];
            in[16 * i + 10 + k] = (float)d.wi[k];
            in[16 * i + 13 + k] = (float)d.wo[k];
        }
    }
    fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_bsdf_phong), .in = in, .in_bytes = sizeof in, .out = out, .out_bytes = sizeof out,
                                      .count = CASES});
    int lit = 0;
    for (int i = 0; i < CASES; i++) {
        assert_memory_equal(&out[6 * i], &out[6 * i + 3], 3 * sizeof(float));
        lit += out[6 * i] > 0;
    }
    assert_true(lit > CASES / 2);
}

// The shaders' numbers of the models are the scene's.
static void models_have_one_number(void **state) {
    (void)state;
    assert_true(PHONG_MODEL == MODEL_PHONG && BLINN_PHONG_MODEL == MODEL_BLINN_PHONG && LAMBERT_MODEL == MODEL_LAMBERT);
    assert_true(METALLIC_ROUGHNESS_MODEL == MODEL_METALLIC_ROUGHNESS && DIELECTRIC_MODEL == MODEL_DIELECTRIC &&
                MIRROR_MODEL == MODEL_MIRROR);
}

// What materials do not use changes no bit when it is left out; what they use is gone when it is.
static void lobes_can_be_left_out(void **state) {
    (void)state;
    static struct given given[CASES];
    static struct told whole[CASES], part[CASES];
    static const struct {
        uint32_t left_out;
        float model;
    } rows[] = {
        {EFFECT_GGX | EFFECT_BLINN | EFFECT_REFLECTION, PHONG_MODEL},
        {EFFECT_GGX | EFFECT_SPECULAR | EFFECT_REFLECTION, BLINN_PHONG_MODEL},
        {EFFECT_GGX | EFFECT_SPECULAR | EFFECT_BLINN | EFFECT_REFLECTION, LAMBERT_MODEL},
        {EFFECT_BLINN | EFFECT_SPECULAR | EFFECT_REFLECTION, METALLIC_ROUGHNESS_MODEL},
        {EFFECT_BLINN | EFFECT_SPECULAR | EFFECT_GGX | EFFECT_DIFFUSE, MIRROR_MODEL},
    };
    for (size_t row = 0; row < COUNT(rows); row++) {
        for (int i = 0; i < CASES; i++) {
            given[i] = random_given(i);
            given[i].model = rows[row].model;
            memset(given[i].reflection, 0, sizeof given[i].reflection);
        }
        run(whole, given, CASES, ALL, false);
        run(part, given, CASES, ~rows[row].left_out, false);
        assert_memory_equal(whole, part, sizeof whole);
        run(part, given, CASES, rows[row].left_out, false);
        for (int i = 0; i < CASES; i++) assert_true(part[i].value[0] == 0 && part[i].pdf == 0 && part[i].drawn == 0);
    }
}

// ------------------------------------------------------------------------------------------------- samples and densities

struct lobe_case {
    const char *name;
    float model, diffuse, specular, reflection, shininess, metallic, roughness;
    float angle_deg;   // of wo
    bool about_mirror; // cells lie about the mirror direction, else about n
    double reach;      // radians, of the cells
};

// clang-format off
static const struct lobe_case LOBES[] = {
    {"lambert", LAMBERT_MODEL, 1, 0, 0, 0, 0, 0, 30, false, PI / 2},
    {"phong 0", PHONG_MODEL, 0, 1, 0, 0, 0, 0, 20, true, PI / 2},
    {"phong 1, grazing", PHONG_MODEL, 0, 1, 0, 1, 0, 0, 85, true, PI / 2},
    {"phong 20", PHONG_MODEL, 0, 1, 0, 20, 0, 0, 45, true, 1},
    {"phong 1000", PHONG_MODEL, 0, 1, 0, 1000, 0, 0, 60, true, 0.15},
    {"phong 1e6", PHONG_MODEL, 0, 1, 0, 1e6f, 0, 0, 60, true, 0.005},
    {"phong 30 over diffuse", PHONG_MODEL, 0.1f, 0.9f, 0, 30, 0, 0, 40, true, 1},
    {"phong 3 over diffuse beside a mirror", PHONG_MODEL, 0.5f, 0.9f, 0.3f, 3, 0, 0, 40, false, PI / 2},
    {"blinn 0", BLINN_PHONG_MODEL, 0, 1, 0, 0, 0, 0, 30, false, PI / 2},
    {"blinn 10", BLINN_PHONG_MODEL, 0, 1, 0, 10, 0, 0, 30, true, 2},
    {"blinn 500, grazing", BLINN_PHONG_MODEL, 0, 1, 0, 500, 0, 0, 75, true, 0.3},
    {"blinn 50 over diffuse", BLINN_PHONG_MODEL, 0.1f, 0.9f, 0, 50, 0, 0, 20, true, 1},
    {"ggx 1", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 1, 10, false, PI / 2},
    {"ggx 1, grazing", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 1, 85, false, PI / 2},
    {"ggx 0.5", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 0.5f, 45, true, 1.2},
    {"ggx 0.1", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 0.1f, 60, true, 0.1},
    {"ggx 0", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 0, 60, true, 0.01},
    {"ggx 0.4 over diffuse", METALLIC_ROUGHNESS_MODEL, 0.8f, 0, 0, 0, 0.3f, 0.4f, 70, true, 1},
};

// clang-format on

static struct given given_of(const struct lobe_case *c) {
    struct given g = {.model = c->model,
                      .shininess = c->shininess,
                      .metallic = c->metallic,
                      .roughness = c->roughness,
                      .ior = 1.5f,
                      .n = {0.36f, -0.48f, -0.8f}};
    for (int i = 0; i < 3; i++) {
        static const float side[3] = {0.8f, 0.6f, 0};
        double angle = c->angle_deg * PI / 180;
        g.diffuse[i] = c->diffuse;
        g.specular[i] = c->specular;
        g.reflection[i] = c->reflection;
        g.wo[i] = (float)(cos(angle) * g.n[i] + sin(angle) * side[i]);
    }
    memcpy(g.ng, g.n, sizeof g.n);
    memcpy(g.wi, g.n, sizeof g.n);
    return g;
}

// Directions in polar coordinates about an axis; any frame will do.
struct chart {
    double axis[3], t[3], b[3];
};

static struct chart chart_of(const struct directions *d, bool about_mirror) {
    struct chart c;
    memcpy(c.axis, d->n, sizeof c.axis);
    if (about_mirror) vector_mirror(c.axis, d->n, d->wo);
    int least = fabs(c.axis[0]) < fabs(c.axis[1]) ? 0 : 1;
    for (int i = 0; i < 3; i++) c.t[i] = (i == least) - c.axis[least] * c.axis[i];
    vector_normalize(c.t);
    for (int i = 0; i < 3; i++) c.b[i] = c.axis[(i + 1) % 3] * c.t[(i + 2) % 3] - c.axis[(i + 2) % 3] * c.t[(i + 1) % 3];
    return c;
}

static void chart_direction(double w[3], const struct chart *c, double theta, double phi) {
    for (int i = 0; i < 3; i++) w[i] = sin(theta) * (cos(phi) * c->t[i] + sin(phi) * c->b[i]) + cos(theta) * c->axis[i];
}

enum { RINGS = 10, SECTORS = 12, CELLS = RINGS * SECTORS + 2, SAMPLES = 1 << 16, FINE = 40 };
#define CELL_BEYOND (CELLS - 2)
#define CELL_REFUSED (CELLS - 1)

static size_t cell_of(const struct chart *c, const double w[3], double reach) {
    double half[3] = {w[0] - c->axis[0], w[1] - c->axis[1], w[2] - c->axis[2]}; // of the chord: accurate for small angles
    double theta = 2 * asin(fmin(sqrt(vector_dot(half, half)) / 2, 1)), turn = atan2(vector_dot(w, c->b), vector_dot(w, c->t)) / (2 * PI);
    if (!(theta < reach)) return CELL_BEYOND;
    return (size_t)(theta / reach * RINGS) * SECTORS + (size_t)fmin((turn + 0.5) * SECTORS, SECTORS - 1);
}

// The integral of the density, over a ring's part between two angles.
static double density_in(const struct ref_bsdf *b, const struct directions *d, const struct chart *c, const double theta[2],
                         const double phi[2]) {
    double sum = 0, step = (theta[1] - theta[0]) / FINE, turn = (phi[1] - phi[0]) / FINE;
    for (int i = 0; i < FINE; i++) {
        double at = theta[0] + (i + 0.5) * step, ring = 0;
        for (int k = 0; k < FINE; k++) {
            double w[3];
            chart_direction(w, c, at, phi[0] + (k + 0.5) * turn);
            ring += ref_bsdf_pdf(b, d->n, d->wo, w);
        }
        sum += ring * sin(at);
    }
    return sum * step * turn;
}

// What is expected of `samples` in each cell: the last but one takes what lies beyond them, the last what is neither a mirror's nor, of the
// integral `whole`, drawn.
static void expect(double expected[CELLS], const struct ref_bsdf *b, const struct directions *d, const struct chart *c, double reach,
                   double whole, double mirrored) {
    double inside = 0;
    for (int i = 0; i < CELL_BEYOND; i++) {
        double theta[2] = {reach * (i / SECTORS) / RINGS, reach * (i / SECTORS + 1) / RINGS};
        double phi[2] = {2 * PI * (i % SECTORS) / SECTORS - PI, 2 * PI * (i % SECTORS + 1) / SECTORS - PI};
        expected[i] = SAMPLES * density_in(b, d, c, theta, phi);
        inside += expected[i];
    }
    expected[CELL_BEYOND] = fmax(SAMPLES * whole - inside, 0);
    expected[CELL_REFUSED] = fmax(SAMPLES * (1 - whole - mirrored), 0);
}

// The integral of value/π or of the density over the sphere, with most points near the mirror direction.
static double over_sphere(const struct ref_bsdf *b, const struct directions *d, bool density) {
    enum { POLAR = 1000, AROUND = 200 };
    struct chart c = chart_of(d, true);
    double sum = 0;
    for (int i = 0; i < POLAR; i++) {
        double t = (i + 0.5) / POLAR, theta = PI * t * t * t, ring = 0;
        for (int k = 0; k < AROUND; k++) {
            double w[3], value[3];
            chart_direction(w, &c, theta, 2 * PI * (k + 0.5) / AROUND);
            if (!density) ref_bsdf_eval(value, b, d->n, d->wo, w);
            ring += density ? ref_bsdf_pdf(b, d->n, d->wo, w) : value[0] / PI;
        }
        sum += ring * sin(theta) * 3 * PI * t * t;
    }
    return sum / POLAR * 2 * PI / AROUND;
}

static void draw(struct told *told, const struct lobe_case *c) {
    struct given *given = malloc(SAMPLES * sizeof *given);
    assert_non_null(given);
    for (int i = 0; i < SAMPLES; i++) {
        given[i] = given_of(c);
        for (int k = 0; k < 2; k++) given[i].u[k] = random_unit();
        given[i].choice = random_unit();
    }
    run(told, given, SAMPLES, ALL, false);
    free(given);
}

// Counts of the samples, by cell.
static void tally(double counts[CELLS], const struct told *told, const struct chart *chart, double reach) {
    memset(counts, 0, CELLS * sizeof *counts);
    for (int i = 0; i < SAMPLES; i++) {
        if (told[i].drawn && told[i].sample_pdf == 0) continue; // a mirror's
        counts[told[i].drawn ? cell_of(chart, told[i].wi, reach) : CELL_REFUSED]++;
    }
}

// How often the mirror is chosen.
static double mirror_share(const struct lobe_case *c) {
    return c->reflection > 0 ? c->reflection / (c->reflection + c->diffuse + c->specular * 2 / (c->shininess + 1)) : 0;
}

// A tenth more in every second cell, a tenth less in the others, is noticed. The densities' integrals are 1 but for mirrors and samples
// that would go below the surface.
static void samples_have_the_density(void **state) {
    (void)state;
    static struct told told[SAMPLES];
    for (size_t row = 0; row < COUNT(LOBES); row++) {
        const struct lobe_case *c = &LOBES[row];
        struct given g = given_of(c);
        struct directions d = directions_of(&g);
        struct ref_bsdf b = bsdf_of(&g, ALL);
        struct chart chart = chart_of(&d, c->about_mirror);
        double counts[CELLS], expected[CELLS];
        draw(told, c);
        tally(counts, told, &chart, c->reach);
        expect(expected, &b, &d, &chart, c->reach, over_sphere(&b, &d, true), mirror_share(c));
        double chance = chi_squared_chance(counts, expected, CELLS);
        if (!(chance > 1e-4 / COUNT(LOBES))) fail_msg("%s: a chance of %g", c->name, chance);
        for (int i = 0; i < CELL_BEYOND; i++) expected[i] *= i % 2 ? 1.1 : 0.9;
        double control = chi_squared_chance(counts, expected, CELLS);
        if (control > 1e-4 / COUNT(LOBES)) fail_msg("%s: wrong densities pass, %g", c->name, control);
    }
}

// ---------------------------------------------------------------------------------------------------------------- energy

// The mean of the weights is what the surface sends back of a uniform light, in the first channel.
static void weights_add_up_to_the_albedo(void **state) {
    (void)state;
    static struct told told[SAMPLES];
    for (size_t row = 0; row < COUNT(LOBES); row++) {
        struct given g = given_of(&LOBES[row]);
        struct directions d = directions_of(&g);
        struct ref_bsdf b = bsdf_of(&g, ALL);
        double right = over_sphere(&b, &d, false) + LOBES[row].reflection, sum = 0, squares = 0;
        draw(told, &LOBES[row]);
        for (int i = 0; i < SAMPLES; i++) {
            sum += told[i].weight[0] / SAMPLES;
            squares += told[i].weight[0] * told[i].weight[0] / SAMPLES;
        }
        double deviation = sqrt(fmax(squares - sum * sum, 0) / SAMPLES), limit = 4.5 * deviation + 3e-4 * right;
        if (!(fabs(sum - right) <= limit)) fail_msg("%s: albedo %g, not %g +- %g", LOBES[row].name, sum, right, limit);
        if (!(fabs(1.05 * sum - right) > limit)) fail_msg("%s: a wrong albedo passes", LOBES[row].name);
    }
}

struct furnace_case {
    struct lobe_case lobe;
    double albedo, tolerance;
};

// Phong head-on: the integral of cos^n. GGX: quadrature over visible facets, which over_sphere knows nothing of; 1 - ln 2 by hand.
static const struct furnace_case FURNACE[] = {
    {{"lambert, white", LAMBERT_MODEL, 1, 0, 0, 0, 0, 0, 50, false, 0}, 1, 1e-4},
    {{"phong 0, head-on", PHONG_MODEL, 0, 1, 0, 0, 0, 0, 0, false, 0}, 2, 5e-3},
    {{"phong 7, head-on", PHONG_MODEL, 0, 1, 0, 7, 0, 0, 0, false, 0}, 0.25, 1e-4},
    {{"phong 99 over diffuse, head-on", PHONG_MODEL, 0.5f, 0.5f, 0, 99, 0, 0, 0, false, 0}, 0.51, 1e-4},
    {{"white metal 1, head-on", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 1, 0, false, 0}, 0.30685282, 2e-4},
    {{"white metal 1", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 1, 60, false, 0}, 0.45069, 3e-4},
    {{"white metal 0.5", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 0.5f, 30, false, 0}, 0.90415, 3e-4},
    {{"white metal 0.5, grazing", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 0.5f, 85, false, 0}, 0.90075, 3e-4},
    {{"white metal 0.3", METALLIC_ROUGHNESS_MODEL, 1, 0, 0, 0, 1, 0.3f, 60, false, 0}, 0.97503, 3e-4},
    {{"black 0.5", METALLIC_ROUGHNESS_MODEL, 0, 0, 0, 0, 0, 0.5f, 60, false, 0}, 0.05574, 3e-4},
    {{"black 0.3, grazing", METALLIC_ROUGHNESS_MODEL, 0, 0, 0, 0, 0, 0.3f, 85, false, 0}, 0.35531, 5e-4},
    {{"black 0.1, grazing", METALLIC_ROUGHNESS_MODEL, 0, 0, 0, 0, 0, 0.1f, 80, false, 0}, 0.40630, 5e-4},
};

static void albedos_that_are_known(void **state) {
    (void)state;
    for (size_t row = 0; row < COUNT(FURNACE); row++) {
        struct given g = given_of(&FURNACE[row].lobe);
        struct directions d = directions_of(&g);
        struct ref_bsdf b = bsdf_of(&g, ALL);
        double albedo = over_sphere(&b, &d, false);
        if (!(fabs(albedo - FURNACE[row].albedo) <= FURNACE[row].tolerance))
            fail_msg("%s: %.6f, not %.6f", FURNACE[row].lobe.name, albedo, FURNACE[row].albedo);
        assert_false(fabs(1.01 * albedo - FURNACE[row].albedo) <= FURNACE[row].tolerance);
    }
}

// White metallic-roughness sends back no more than comes, of whatever roughness and metal, from wherever it is seen, but for the 0.07 % by
// which the facets' mean Fresnel term can be above that of the surface.
static void metallic_roughness_makes_no_energy(void **state) {
    (void)state;
    double most = 0;
    for (int i = 0; i < 4 * 5 * 6; i++) {
        struct lobe_case c = {.model = METALLIC_ROUGHNESS_MODEL, .diffuse = 1, .metallic = (float)(i % 4) / 3};
        c.roughness = 0.2f + 0.2f * (float)(i / 4 % 5);
        c.angle_deg = 17.5f * (float)(i / 20);
        struct given g = given_of(&c);
        struct directions d = directions_of(&g);
        struct ref_bsdf b = bsdf_of(&g, ALL);
        most = fmax(most, over_sphere(&b, &d, false));
    }
    assert_true(most <= 1.001 && most > 0.99);
}

// White surfaces without a highlight, and mirrors: every single weight is 1, so that a furnace stays as it is to the last bit.
static void white_weights_are_exactly_one(void **state) {
    (void)state;
    static struct told told[SAMPLES];
    static const struct lobe_case cases[] = {
        {"lambert", LAMBERT_MODEL, 1, 0, 0, 0, 0, 0, 50, false, 0},
        {"phong without highlight", PHONG_MODEL, 1, 0, 0, 30, 0, 0, 80, false, 0},
        {"mirror", MIRROR_MODEL, 1, 0, 0, 0, 0, 0, 30, false, 0},
        {"a mirror's share", PHONG_MODEL, 0, 0, 1, 0, 0, 0, 30, false, 0},
        {"half a mirror", PHONG_MODEL, 0.5f, 0, 0.5f, 0, 0, 0, 30, false, 0},
    };
    for (size_t row = 0; row < COUNT(cases); row++) {
        draw(told, &cases[row]);
        for (int i = 0; i < SAMPLES; i++)
            if (!(told[i].drawn && told[i].weight[0] == 1)) fail_msg("%s: weight %.9g", cases[row].name, told[i].weight[0]);
    }
}

// f(wo, wi) = f(wi, wo), of the device's fp32. Highlights of Phong and of Blinn and Phong are reciprocal in f·cos instead: the control.
static void light_goes_both_ways(void **state) {
    (void)state;
    static struct given given[2 * CASES];
    static struct told told[2 * CASES];
    for (int i = 0; i < CASES; i++) {
        given[i] = random_given(4 * i + 1);
        given[i].model = (float)(i % 4); // up to metallic-roughness
        if (given[i].model < LAMBERT_MODEL) memset(given[i].diffuse, 0, sizeof given[i].diffuse);
        given[CASES + i] = given[i];
        memcpy(given[CASES + i].wo, given[i].wi, sizeof given[i].wi);
        memcpy(given[CASES + i].wi, given[i].wo, sizeof given[i].wo);
    }
    run(told, given, 2 * CASES, ALL, false);
    int one_way = 0;
    for (int i = 0; i < CASES; i++) {
        struct directions d = directions_of(&given[i]);
        double cos_o = vector_dot(d.n, d.wo), cos_i = vector_dot(d.n, d.wi), there = told[i].value[0], back = told[CASES + i].value[0];
        bool highlight = given[i].model < LAMBERT_MODEL;
        if (!highlight) there /= cos_i, back /= cos_o;
        if (!near(there, back, 4 * tolerance(&given[i], 0x1p-24) / fmin(cos_o, cos_i)))
            fail_msg("model %g: %g there, %g back", given[i].model, there, back);
        one_way += highlight && there > 0.01 && !near(there / cos_i, back / cos_o, 0.01);
    }
    assert_true(one_way > CASES / 20);
}

// ------------------------------------------------------------------------------------------------------------ hard cases

struct hard_case {
    const char *name;
    float model, shininess, roughness, n[3], wo[3], wi[3];
    double value; // of diffuse 1/4, specular 1/2, metallic 1
};

static const struct hard_case HARD[] = {
    {"no half vector", BLINN_PHONG_MODEL, 8, 0, {0, 1, 0}, {-0.6f, -0.8f, 0}, {0.6f, 0.8f, 0}, 0.2},
    {"no half vector, exponent 0", BLINN_PHONG_MODEL, 0, 0, {0, 1, 0}, {-0.6f, -0.8f, 0}, {0.6f, 0.8f, 0}, 0.2},
    {"0 to the 0", PHONG_MODEL, 0, 0, {0, 0, 1}, {-1, 0, 1}, {-1, 0, 1}, 0.25 * 0.70710678 + 0.5},
    {"a negative cosine to an uneven power", PHONG_MODEL, 32.5f, 0, {0, 0, 1}, {-1, 0, 0.99999998f}, {-1, 0, 1}, 0.25 * 0.70710678},
    {"a cosine of 1 to a large power", PHONG_MODEL, 1e7f, 0, {0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}, 0.75},
    {"light along the horizon", PHONG_MODEL, 0, 0, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, 0},
    {"light below the shading normal", PHONG_MODEL, 0, 0, {0, 0, 1}, {0, 0, 1}, {1, 0, -1e-3f}, 0},
    {"a smooth metal, at its peak", METALLIC_ROUGHNESS_MODEL, 0, 0, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, 0.25 * 0x1p20 / 4},
    {"a smooth metal, aslant", METALLIC_ROUGHNESS_MODEL, 0, 0, {0, 0, 1}, {-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, 0.25024 * 0x1p20 / 3.2},
    {"metal seen along the horizon", METALLIC_ROUGHNESS_MODEL, 0, 1, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}, 0},
    {"metal seen from below", METALLIC_ROUGHNESS_MODEL, 0, 1, {0, 0, 1}, {1, 0, -0.1f}, {0, 0, 1}, 0},
    {"metal, both along the horizon", METALLIC_ROUGHNESS_MODEL, 0, 0, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, 0},
};

static void hard_values(bool fp64) {
    struct given given[COUNT(HARD)];
    struct told told[COUNT(HARD)];
    for (size_t i = 0; i < COUNT(HARD); i++) {
        const struct hard_case *c = &HARD[i];
        given[i] = (struct given){.model = c->model,
                                  .diffuse = {0.25f},
                                  .specular = {0.5f},
                                  .shininess = c->shininess,
                                  .roughness = c->roughness,
                                  .metallic = 1,
                                  .ior = 1.5f};
        memcpy(given[i].n, c->n, sizeof c->n);
        memcpy(given[i].ng, c->n, sizeof c->n);
        memcpy(given[i].wo, c->wo, sizeof c->wo);
        memcpy(given[i].wi, c->wi, sizeof c->wi);
    }
    run(told, given, COUNT(HARD), ALL, fp64);
    for (size_t i = 0; i < COUNT(HARD); i++)
        if (!(fabs(told[i].value[0] - HARD[i].value) <= 2e-3 * HARD[i].value))
            fail_msg("%s: %.9g, not %.9g", HARD[i].name, told[i].value[0], HARD[i].value);
}

static void hard_cases(void **state) {
    (void)state;
    hard_values(false);
    if (fixture_device()->has_fp64) hard_values(true);
}

// The two normals at which Frisvad's frame breaks down (Duff et al. 2017), and the poles: samples lie where u says, and are unit.
static void frames_are_right(void **state) {
    (void)state;
    static const float normals[][3] = {{0.00038527316f, 0.00038460016f, -0.99999988079f},
                                       {-0.00019813581f, -0.00008946839f, -0.99999988079f},
                                       {0, 0, -1},
                                       {0, 0, 1},
                                       {1, 0, 0},
                                       {1, 0, -0.0f},
                                       {0, 1, -1e-30f}};
    struct given given[COUNT(normals) * 64];
    struct told told[COUNT(given)];
    for (size_t i = 0; i < COUNT(given); i++) {
        given[i] = (struct given){.model = LAMBERT_MODEL, .diffuse = {1, 1, 1}, .u = {random_unit(), random_unit()}};
        const float *n = normals[i / 64];
        memcpy(given[i].n, n, sizeof given[i].n);
        memcpy(given[i].ng, n, sizeof given[i].n);
        memcpy(given[i].wo, n, sizeof given[i].n);
        memcpy(given[i].wi, n, sizeof given[i].n);
    }
    run(told, given, COUNT(given), ALL, false);
    for (size_t i = 0; i < COUNT(given); i++) {
        struct directions d = directions_of(&given[i]);
        assert_true(fabs(vector_dot(told[i].wi, told[i].wi) - 1) <= 3e-7);
        assert_true(fabs(vector_dot(told[i].wi, d.n) - sqrt(1 - (double)given[i].u[0])) <= 3e-7);
    }
}

// Sharpest and dullest materials, directions along the horizon and behind the shading normal, numbers at the ends of their range: whatever
// comes is finite, and a sample that is drawn has a density, unless it is a mirror's, and leaves on the outside.
static void nothing_breaks(void **state) {
    (void)state;
    static const float exponents[] = {0, 1e-30f, 1, 1e9f, 3e38f}, ends[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
    static struct given given[4 * CASES];
    static struct told told[4 * CASES];
    for (uint32_t i = 0; i < COUNT(given); i++) {
        struct given *g = &given[i];
        *g = random_given((int)i);
        g->shininess = exponents[random_bits() % COUNT(exponents)];
        g->roughness = (float)(random_bits() % 2);
        g->choice = ends[random_bits() % COUNT(ends)];
        for (int k = 0; k < 2; k++) g->u[k] = ends[random_bits() % COUNT(ends)];
        if (i % 5 == 0) memset(g->diffuse, 0, sizeof g->diffuse), memset(g->reflection, 0, sizeof g->reflection);
        if (i % 7 == 0) memset(g->specular, 0, sizeof g->specular);
        if (i % 9 == 0) memcpy(g->wo, (float[3]){g->n[1], -g->n[0], 1e-20f}, sizeof g->wo);
        if (i % 11 == 0) memcpy(g->wi, g->wo, sizeof g->wi);
        if (i % 13 == 0)
            for (int k = 0; k < 3; k++) g->wi[k] = -g->wo[k];
    }
    run(told, given, COUNT(given), ALL, false);
    int drawn = 0;
    for (uint32_t i = 0; i < COUNT(given); i++) {
        struct directions d = directions_of(&given[i]);
        for (size_t k = 0; k < 11; k++) assert_true(isfinite(((double *)&told[i])[k]));
        if (!told[i].drawn) continue;
        assert_true(isfinite(told[i].sample_pdf) && told[i].sample_pdf >= 0);
        for (int k = 0; k < 3; k++) assert_true(told[i].weight[k] >= 0 && told[i].weight[k] <= 1000);
        assert_true(vector_dot(told[i].wi, d.ng) > -1e-6);
        drawn++;
    }
    assert_true(drawn > CASES);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fp32_agrees_with_the_reference),
        cmocka_unit_test(fp64_agrees_with_the_reference),
        cmocka_unit_test(contract_is_kept_to_the_bit),
        cmocka_unit_test(models_have_one_number),
        cmocka_unit_test(lobes_can_be_left_out),
        cmocka_unit_test(samples_have_the_density),
        cmocka_unit_test(weights_add_up_to_the_albedo),
        cmocka_unit_test(albedos_that_are_known),
        cmocka_unit_test(metallic_roughness_makes_no_energy),
        cmocka_unit_test(white_weights_are_exactly_one),
        cmocka_unit_test(light_goes_both_ways),
        cmocka_unit_test(hard_cases),
        cmocka_unit_test(frames_are_right),
        cmocka_unit_test(nothing_breaks),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
