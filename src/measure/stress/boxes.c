// Rows of boxes: box.glsl alone must let every ray in that touches the box, in exact arithmetic. To let one in that does not costs time
// only. Boxes lie within [-2, 2], as device coordinates do.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/stress/adversary.h"
#include "measure/stress/job.h"
#include "measure/stress/oracle.h"

struct box_case {
    float min[3], max[3], o[3], d[3], tmin, tmax;
};

_Static_assert(sizeof(struct box_case) == STRESS_BOX_IN * sizeof(float), "a box is what the kernel reads");

typedef void box_maker(struct box_case *out, struct random *random);

// k·2^-bits for |k·2^-bits| up to `most`.
static float grid(struct random *random, double most, int bits) {
    return (float)(floor(random_in(random, -most, most) * ldexp(1, bits)) / ldexp(1, bits));
}

// A box with corners on a grid, flat in some axes.
static void make_box(struct box_case *out, struct random *random) {
    for (int k = 0; k < 3; k++) {
        float a = grid(random, 2, 3), b = random_below(random, 3) ? grid(random, 2, 3) : a;
        out->min[k] = fminf(a, b), out->max[k] = fmaxf(a, b);
    }
    out->tmin = 0, out->tmax = INFINITY;
}

// B01: rays along an axis, in faces and edges.
static void thin(struct box_case *out, struct random *random) {
    make_box(out, random);
    int axis = (int)random_below(random, 3);
    for (int k = 0; k < 3; k++) {
        out->o[k] = random_bits(random) & 1 ? out->min[k] : random_bits(random) & 1 ? out->max[k] : grid(random, 2, 3);
        out->d[k] = random_bits(random) & 1 ? 0.0f : -0.0f;
    }
    out->d[axis] = random_bits(random) & 1 ? 1 : -1;
    out->o[axis] = -5 * out->d[axis];
}

// B02: a box that is a point, and a ray that goes through it exactly.
static void point(struct box_case *out, struct random *random) {
    make_box(out, random);
    for (int k = 0; k < 3; k++) {
        out->min[k] = out->max[k] = grid(random, 2, 20);
        out->o[k] = random_below(random, 4) ? grid(random, 2, 20) : out->min[k];
        out->d[k] = out->min[k] - out->o[k];
    }
    if (out->d[0] == 0 && out->d[1] == 0 && out->d[2] == 0) out->d[0] = 1;
}

// B04: the same from 2^17 away, where plane · inverse - origin · inverse would cancel.
static void point_from_afar(struct box_case *out, struct random *random) {
    make_box(out, random);
    for (int k = 0; k < 3; k++) {
        out->min[k] = out->max[k] = grid(random, 2, 5);
        out->o[k] = grid(random, 131072, 5);
        out->d[k] = out->min[k] - out->o[k];
    }
}

// B07: components of the direction that are zero, denormal or next to nothing.
static void next_to_nothing(struct box_case *out, struct random *random) {
    static const float small[] = {0, -0.0f, 1e-45f, -1e-40f, 1e-38f, 1e-37f, -1e-36f, 1e-35f, 1e-20f};
    make_box(out, random);
    for (int k = 0; k < 3; k++) {
        out->o[k] = random_bits(random) & 1 ? grid(random, 2, 3) : random_bits(random) & 1 ? out->min[k] : out->max[k];
        out->d[k] = random_below(random, 3) ? small[random_below(random, 9)] : (float)random_in(random, -1, 1);
    }
    if (out->d[0] == 0 && out->d[1] == 0 && out->d[2] == 0) out->d[2] = 1e-40f;
}

// B08: origins inside, on faces and on corners; intervals that end on faces.
static void on_box(struct box_case *out, struct random *random) {
    make_box(out, random);
    for (int k = 0; k < 3; k++) {
        uint32_t where = random_below(random, 3);
        out->o[k] = where == 0 ? out->min[k] : where == 1 ? out->max[k] : (float)random_in(random, out->min[k], out->max[k]);
        out->d[k] = random_below(random, 3) ? (float)random_in(random, -1, 1) : 0;
    }
    if (out->d[0] == 0 && out->d[1] == 0 && out->d[2] == 0) out->d[1] = -1;
    if (random_bits(random) & 1) out->tmax = ldexpf(1, -(int)random_below(random, 140));
}

// Every number moved, a box still a box.
static void fuzz(struct box_case *c, struct random *random) {
    for (int k = 0; k < 3; k++) {
        float a = random_ulps(random, c->min[k], 3), b = random_ulps(random, c->max[k], 3);
        c->min[k] = fminf(a, b), c->max[k] = fmaxf(a, b);
        c->o[k] = random_ulps(random, c->o[k], 3);
        c->d[k] = random_ulps(random, c->d[k], 3);
    }
    if (c->d[0] == 0 && c->d[1] == 0 && c->d[2] == 0) c->d[0] = 1;
}

static void judge(struct tally *tally, const struct box_case *cases, const bool *touched, const float *entered, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const struct box_case *c = &cases[i];
        tally->rays++;
        if (touched[i] && entered[i] == 0)
            tally_wrong(tally, "box (%a, %a, %a) (%a, %a, %a) o (%a, %a, %a) d (%a, %a, %a) tmax %a", c->min[0], c->min[1], c->min[2],
                        c->max[0], c->max[1], c->max[2], c->o[0], c->o[1], c->o[2], c->d[0], c->d[1], c->d[2], c->tmax);
    }
}

static bool run_boxes(struct stress *s, box_maker *make) {
    uint32_t count = s->rays / 2 + 1;
    struct box_case *cases = array_alloc(s->ctx, count, sizeof *cases, "boxes");
    bool *touched = array_alloc(s->ctx, count, sizeof *touched, "boxes");
    float *entered = array_alloc(s->ctx, count, sizeof *entered, "boxes");
    bool done = cases && touched && entered;
    for (uint32_t i = 0; done && i < count; i++) {
        make(&cases[i], &s->random);
        if (i & 1) fuzz(&cases[i], &s->random);
        struct gn_ray ray = {.tmin = cases[i].tmin, .tmax = cases[i].tmax};
        memcpy(ray.origin, cases[i].o, sizeof ray.origin);
        memcpy(ray.direction, cases[i].d, sizeof ray.direction);
        touched[i] = oracle_box(cases[i].min, cases[i].max, &ray);
    }
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        if (!s->judged[tier]) continue;
        const struct job job = {.fp32 = KERNEL_STRESS_BOX,
                                .fp64 = KERNEL_STRESS_BOX_FP64,
                                .tier = tier,
                                .count = count,
                                .in = &cases->min[0],
                                .out = entered,
                                .in_each = STRESS_BOX_IN,
                                .out_each = 1};
        done = job_run(s, &job);
        if (done) judge(&s->tally[tier], cases, touched, entered, count);
    }
    free(cases);
    free(touched);
    free(entered);
    return done;
}

bool boxes_thin(struct stress *s) { return run_boxes(s, thin); }
bool boxes_points(struct stress *s) { return run_boxes(s, point); }
bool boxes_from_afar(struct stress *s) { return run_boxes(s, point_from_afar); }
bool boxes_next_to_nothing(struct stress *s) { return run_boxes(s, next_to_nothing); }
bool boxes_origin_on(struct stress *s) { return run_boxes(s, on_box); }

// --------------------------------------------------------------------------------------------------- the worst of devices

// The ray as ray.glsl makes it: the direction's largest component in [1, 2).
static void scale_ray(struct box_case *c) {
    float most = fmaxf(fabsf(c->d[0]), fmaxf(fabsf(c->d[1]), fabsf(c->d[2])));
    int exponent = ilogbf(most);
    for (int k = 0; k < 3; k++) c->d[k] = ldexpf(c->d[k], -exponent);
    c->tmin = ldexpf(c->tmin, exponent), c->tmax = ldexpf(c->tmax, exponent);
}

static bool enters(struct adversary *adversary, const struct box_case *c) {
    return adversary_box(adversary, c->min, c->max, c->o, c->d, c->tmin, c->tmax);
}

#define ENOUGH_TO_LOSE 500u // boxes, for the control

// B03: the box test with arithmetic as bad as Vulkan allows, on all the kinds of boxes above. Control: without its pad it must lose
// some.
bool boxes_perturbed(struct stress *s) {
    static box_maker *const makers[] = {thin, point, point_from_afar, next_to_nothing, on_box};
    struct adversary adversary = {.random = &s->random, .any_rounding = true, .band = 1},
                     unpadded = {.random = &s->random, .any_rounding = true};
    struct tally tally = {0};
    uint32_t lost = 0;
    for (uint32_t i = 0; i < s->rays; i++) {
        struct box_case c;
        makers[i % 5](&c, &s->random);
        if (i / 5 % 2) fuzz(&c, &s->random);
        scale_ray(&c);
        struct gn_ray ray = {.tmin = c.tmin, .tmax = c.tmax};
        memcpy(ray.origin, c.o, sizeof ray.origin);
        memcpy(ray.direction, c.d, sizeof ray.direction);
        const bool touched = oracle_box(c.min, c.max, &ray);
        const float entered = enters(&adversary, &c) ? 1 : 0;
        judge(&tally, &c, &touched, &entered, 1);
        lost += touched && !enters(&unpadded, &c);
    }
    if (lost == 0 && s->rays >= ENOUGH_TO_LOSE) tally_wrong(&tally, "control: without its pad the box test loses nothing");
    tally_every(s, &tally);
    return true;
}
