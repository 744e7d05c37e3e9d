// Rows of the exact tier's filter: what it is sure of must be so, on the device that is there and on the worst that Vulkan allows.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/stress/adversary.h"
#include "measure/stress/job.h"
#include "measure/stress/oracle.h"

#define CONTROL (1.0f / 64) // of the bounds: so narrow that the adversary must find decisions to break

// A ray and a triangle, or a sphere, in device coordinates; the direction's largest component is in [1, 2).
struct filter_case {
    float o[3], d[3], v[3][3], root_sign;
};

_Static_assert(sizeof(struct filter_case) == STRESS_NUMBERS_IN * sizeof(float), "what the kernel reads");

// ------------------------------------------------------------------------------------------------------------- the cases

static void scale_direction(float d[3]) {
    float most = fmaxf(fabsf(d[0]), fmaxf(fabsf(d[1]), fabsf(d[2])));
    if (most == 0) d[0] = most = 1;
    int exponent = ilogbf(most);
    for (int k = 0; k < 3; k++) d[k] = ldexpf(d[k], -exponent);
}

// An origin near or far, and the direction to p as fp32 has it, in which some components may be nothing.
static void aim(struct filter_case *out, struct random *random, const double p[3]) {
    const double distance = ldexp(1, (int)random_below(random, 24) - 4);
    for (int k = 0; k < 3; k++) {
        out->o[k] = (float)(random_below(random, 8) ? distance * random_in(random, -1, 1) : p[k]);
        out->d[k] = (float)(p[k] - out->o[k]);
    }
    scale_direction(out->d);
}

// A triangle of any shape, from plump to needle, and a ray to a vertex, to an edge, or past one by as little as rounding.
static void make_triangle(struct filter_case *out, struct random *random) {
    const double size = ldexp(1, -(int)random_below(random, 20)), thin = ldexp(1, -(int)random_below(random, 24)),
                 place = random_in(random, -1, 1);
    double p[3], along = random_below(random, 4) ? random_unit(random) : 0,
                 past = ldexp(random_in(random, -1, 1), -(int)random_below(random, 26));
    for (int k = 0; k < 3; k++) {
        out->v[0][k] = (float)(place + size * random_in(random, -1, 1));
        out->v[1][k] = (float)(place + size * random_in(random, -1, 1));
        out->v[2][k] = (float)(out->v[0][k] + 0.3 * ((double)out->v[1][k] - out->v[0][k]) + thin * size * random_in(random, -1, 1));
    }
    const uint32_t corner = random_below(random, 3);
    const float *a = out->v[corner], *b = out->v[(corner + 1) % 3], *c = out->v[(corner + 2) % 3];
    for (int k = 0; k < 3; k++) p[k] = a[k] + along * ((double)b[k] - a[k]) + past * ((double)c[k] - a[k]);
    aim(out, random, p);
    out->root_sign = 0;
}

// A sphere of any size, v[0] its centre and v[1][0] its radius, and a ray past its limb by as little as rounding.
static void make_sphere(struct filter_case *out, struct random *random) {
    const double radius = ldexp(random_in(random, 0.5, 1), -(int)random_below(random, 20));
    double p[3], direction[3], past = 1 + ldexp(random_in(random, -1, 1), -(int)random_below(random, 26));
    random_direction(direction, random);
    for (int k = 0; k < 3; k++) {
        out->v[0][k] = (float)random_in(random, -1, 1);
        p[k] = out->v[0][k] + radius * past * direction[k];
    }
    memset(out->v[1], 0, sizeof out->v[1]);
    memset(out->v[2], 0, sizeof out->v[2]);
    out->v[1][0] = (float)radius;
    aim(out, random, p);
    out->root_sign = 0;
}

// The exact answer: whether the whole line, forwards and backwards, crosses, and where; for a sphere at the root that is asked for.
static bool answer(struct oracle_answer *out, struct context *ctx, const struct filter_case *c, bool sphere, float root_sign) {
    struct world world = {0};
    float corners[9];
    memcpy(corners, c->v, sizeof corners);
    if (sphere)
        world_sphere(&world, c->v[0], c->v[1][0]);
    else
        world_lone_triangle(&world, corners);
    world_ray(&world, c->o, c->d, -INFINITY, INFINITY);
    bool done = world_ok(&world, ctx) && oracle_answer(out, ctx, &world, &(struct oracle_params){0});
    if (done && sphere && root_sign > 0 && out->hit) {
        // The farther root: the sum of both is 2 b/a, to fp64, which is more than the filter knows.
        double a = 0, b = 0;
        for (int k = 0; k < 3; k++) a += (double)c->d[k] * c->d[k], b += ((double)c->v[0][k] - c->o[k]) * c->d[k];
        out->t = 2 * b / a - out->t;
    }
    world_finish(&world);
    return done;
}

// --------------------------------------------------------------------------------------------------------------- judging

static bool is_broken(const struct told *told, const struct oracle_answer *right) {
    if (told->lo > told->hi) return right->hit;
    if (told->certain && !right->hit) return true;
    return right->hit && !(right->t >= told->lo && right->t <= told->hi);
}

static void judge(struct tally *tally, const struct filter_case *c, const struct told *told, const struct oracle_answer *right,
                  const char *who) {
    tally->rays++;
    if (!is_broken(told, right)) return;
    const float *a = c->v[0], *b = c->v[1], *v = c->v[2];
    tally_wrong(tally, "%s: o (%a, %a, %a) d (%a, %a, %a) v (%a, %a, %a) (%a, %a, %a) (%a, %a, %a)", who, c->o[0], c->o[1], c->o[2],
                c->d[0], c->d[1], c->d[2], a[0], a[1], a[2], b[0], b[1], b[2], v[0], v[1], v[2]);
}

static struct told ask(struct adversary *adversary, const struct filter_case *c, bool sphere, float root_sign) {
    if (!sphere) return adversary_triangle(adversary, c->o, c->d, c->v);
    return adversary_sphere(adversary, c->o, c->d, c->v[0], c->v[1][0], root_sign);
}

// How many cases the adversary breaks with a band so narrow that it must break some.
static uint32_t control(struct stress *s, const struct filter_case *cases, const struct oracle_answer *answers, uint32_t count, bool sphere,
                        bool any_rounding) {
    struct adversary adversary = {.random = &s->random, .any_rounding = any_rounding, .band = CONTROL};
    uint32_t broken = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct told told = ask(&adversary, &cases[i], sphere, cases[i].root_sign);
        broken += is_broken(&told, &answers[i]);
    }
    return broken;
}

// The device's own filter, and how often it says something else than the twin that rounds as fp32 should.
static bool judge_device(struct stress *s, const struct filter_case *cases, const struct oracle_answer *answers, uint32_t count,
                         bool sphere, uint32_t *others) {
    float *out = array_alloc(s->ctx, count, 3 * sizeof *out, "verdicts");
    const struct job job = {.fp32 = KERNEL_STRESS_NUMBERS,
                            .tier = TIER_EXACT,
                            .count = count,
                            .what = sphere ? STRESS_SPHERE : STRESS_TRIANGLE,
                            .in = cases->o,
                            .out = out,
                            .in_each = STRESS_NUMBERS_IN,
                            .out_each = 3};
    bool done = out && job_run(s, &job);
    struct adversary twin = {.band = 1};
    for (uint32_t i = 0; done && i < count; i++) {
        const struct told device = {out[3 * i], out[3 * i + 1], out[3 * i + 2] != 0},
                          same = ask(&twin, &cases[i], sphere, cases[i].root_sign);
        judge(&s->tally[TIER_EXACT], &cases[i], &device, &answers[i], "the device");
        *others += device.certain != same.certain || (device.lo > device.hi) != (same.lo > same.hi);
    }
    free(out);
    return done;
}

static bool run_shapes(struct stress *s, bool sphere, bool any_rounding, uint32_t *others) {
    const uint32_t count = s->rays;
    struct filter_case *cases = array_alloc(s->ctx, count, sizeof *cases, "rays");
    struct oracle_answer *answers = array_alloc(s->ctx, count, sizeof *answers, "answers");
    bool done = cases && answers;
    for (uint32_t i = 0; done && i < count; i++) {
        (sphere ? make_sphere : make_triangle)(&cases[i], &s->random);
        // The sphere's filter reads its radius and the root where a triangle has its second vertex.
        if (sphere) cases[i].v[1][1] = cases[i].root_sign = i % 2 ? 1 : -1;
        done = answer(&answers[i], s->ctx, &cases[i], sphere, cases[i].root_sign);
    }
    struct adversary adversary = {.random = &s->random, .any_rounding = any_rounding, .band = 1};
    for (uint32_t i = 0; done && i < count; i++) {
        struct told told = ask(&adversary, &cases[i], sphere, cases[i].root_sign);
        judge(&s->tally[TIER_EXACT], &cases[i], &told, &answers[i], "the adversary");
    }
    if (done && control(s, cases, answers, count, sphere, any_rounding) == 0)
        tally_wrong(&s->tally[TIER_EXACT], "control: with 1/64 of the bounds the adversary breaks nothing");
    done = done && judge_device(s, cases, answers, count, sphere, others);
    free(cases);
    free(answers);
    return done;
}

static bool run_filters(struct stress *s, bool any_rounding) {
    uint32_t others = 0;
    if (!s->judged[TIER_EXACT]) return true;
    if (!run_shapes(s, false, any_rounding, &others) || !run_shapes(s, true, any_rounding, &others)) return false;
    snprintf(s->tally[TIER_EXACT].note, sizeof s->tally[TIER_EXACT].note, "the device's filter decides %u of %u otherwise than its twin",
             others, 2 * s->rays);
    return true;
}

// V01: ÷ by 2.5 ulp, products fused at random, denormals flushed.
bool filters_perturbed(struct stress *s) { return run_filters(s, false); }

// V02: and each operation rounded either way.
bool filters_any_rounding(struct stress *s) { return run_filters(s, true); }
