// Rows of what is refused, and of what a transform does to a mesh, before any ray is shot.
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "measure/stress/row.h"
#include "scene/mesh.h"

#define SPHERE "{\"type\": \"sphere\", \"center\": [0, 0, %s], \"radius\": %s, \"material\": \"m\"}"
#define TRIANGLE "{\"type\": \"triangle\", \"vertices\": [[0, 0, %s], [1, 0, 0], [0, %s, 0]], \"material\": \"m\"}"
#define SCENE_HEAD "{\"version\": 1, \"materials\": {\"m\": {}}, \"shapes\": ["
#define SCENE_TAIL "]}"

struct load_case {
    const char *shape, *a, *b;
    bool good;
};

// Writes a scene with this shape to `path` and loads it; *status is how that went. False without a place to write.
static bool load(enum gn_status *status, struct context *ctx, const char *path, const struct load_case *c) {
    struct gn_error error;
    struct context own = context_make(NULL, &error);
    struct scene scene;
    FILE *file = fopen(path, "w");
    bool written = file && fputs(SCENE_HEAD, file) >= 0;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    written = written && fprintf(file, c->shape, c->a, c->b) > 0;
#pragma GCC diagnostic pop
    written = written && fputs(SCENE_TAIL, file) >= 0;
    if (file && fclose(file) != 0) written = false;
    if (!written) return fail(ctx, GN_IO, "%s: cannot be written; a stress case needs a place for a small scene (TMPDIR)", path);
    if (scene_load(&scene, &own, path)) scene_finish(&scene);
    *status = error.status;
    return true;
}

static bool judge_loads(struct stress *s, const struct load_case *cases, size_t count) {
    char folder[256], path[300];
    const char *place = getenv("TMPDIR");
    struct tally tally = {0};
    bool done = true;
    snprintf(folder, sizeof folder, "%s/gnomon-stress-XXXXXX", place && *place ? place : "/tmp");
    if (!mkdtemp(folder)) return fail(s->ctx, GN_IO, "%s: cannot be made; a stress case needs a place for a small scene (TMPDIR)", folder);
    snprintf(path, sizeof path, "%s/scene.json", folder);
    for (size_t i = 0; done && i < count; i++) {
        enum gn_status status = GN_OK;
        done = load(&status, s->ctx, path, &cases[i]);
        tally.rays++;
        if (done && status != (cases[i].good ? GN_OK : GN_SCENE))
            tally_wrong(&tally, "a shape with %s, %s: status %d", cases[i].a, cases[i].b, status);
    }
    unlink(path);
    rmdir(folder);
    snprintf(tally.note, sizeof tally.note, "%zu shapes with such numbers are refused when they are loaded", count - 1);
    tally_every(s, &tally);
    return done;
}

// S11
bool loading_radius(struct stress *s) {
    static const struct load_case cases[] = {
        {SPHERE, "0", "1e-40", true},  {SPHERE, "0", "0", false},      {SPHERE, "0", "-1", false},    {SPHERE, "0", "-0.0", false},
        {SPHERE, "0", "1e-60", false}, {SPHERE, "0", "1e60", false},   {SPHERE, "0", "1e400", false}, {SPHERE, "0", "NaN", false},
        {SPHERE, "1e60", "1", false},  {SPHERE, "-1e400", "1", false},
    };
    return judge_loads(s, cases, sizeof cases / sizeof *cases);
}

// T29, B09: numbers that would make a node NaN.
bool loading_vertices(struct stress *s) {
    static const struct load_case cases[] = {
        {TRIANGLE, "0", "1", true},    {TRIANGLE, "1e39", "1", false},     {TRIANGLE, "0", "-1e39", false},
        {TRIANGLE, "NaN", "1", false}, {TRIANGLE, "Infinity", "1", false}, {TRIANGLE, "1e400", "1", false},
    };
    struct tally before[TIER_COUNT];
    memcpy(before, s->tally, sizeof before);
    if (!judge_loads(s, cases, sizeof cases / sizeof *cases)) return false;
    for (int tier = 0; tier < TIER_COUNT; tier++) { // on top of the rays that were judged before
        if (!before[tier].wrong)
            before[tier].wrong = s->tally[tier].wrong, memcpy(before[tier].first, s->tally[tier].first, sizeof before[tier].first);
        before[tier].rays += s->tally[tier].rays;
        memcpy(before[tier].note, s->tally[tier].note, sizeof before[tier].note);
    }
    memcpy(s->tally, before, sizeof before);
    return true;
}

// ------------------------------------------------------------------------------------------------------------- transforms

// The normal that goes with v0 v1 v2 after a transform, unit, times the sign of the determinant: the edges transformed, their product.
// That is the inverse transpose up to a factor, by another way.
static void exact_normal(double out[3], const struct transform *t, float v[3][3]) {
    mpfr_t edge[2][3], n[3], term, length;
    mpfr_inits2(256, term, length, (mpfr_ptr)0);
    for (int k = 0; k < 3; k++) mpfr_inits2(256, edge[0][k], edge[1][k], n[k], (mpfr_ptr)0);
    for (int e = 0; e < 2; e++)
        for (int row = 0; row < 3; row++) {
            mpfr_set_zero(edge[e][row], 1);
            for (int k = 0; k < 3; k++) {
                mpfr_set_flt(term, v[e + 1][k], MPFR_RNDN);
                mpfr_sub_d(term, term, (double)v[0][k], MPFR_RNDN);
                mpfr_mul_d(term, term, t->m[row][k], MPFR_RNDN);
                mpfr_add(edge[e][row], edge[e][row], term, MPFR_RNDN);
            }
        }
    mpfr_set_zero(length, 1);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        mpfr_mul(n[i], edge[0][j], edge[1][k], MPFR_RNDN);
        mpfr_mul(term, edge[0][k], edge[1][j], MPFR_RNDN);
        mpfr_sub(n[i], n[i], term, MPFR_RNDN);
        mpfr_fma(length, n[i], n[i], length, MPFR_RNDN);
    }
    mpfr_sqrt(length, length, MPFR_RNDN);
    for (int k = 0; k < 3; k++) {
        mpfr_div(n[k], n[k], length, MPFR_RNDN);
        out[k] = mpfr_get_d(n[k], MPFR_RNDN);
    }
    for (int k = 0; k < 3; k++) mpfr_clears(edge[0][k], edge[1][k], n[k], (mpfr_ptr)0);
    mpfr_clears(term, length, (mpfr_ptr)0);
}

// Transforms a random triangle with its own normal and holds the transformed normal against the exact one. `mirror`: the determinant is
// negative, and the normal stays on the same side of the surface.
static bool judge_transform(struct tally *tally, struct stress *s, const struct transform *t, bool mirror) {
    struct scene_mesh mesh = {0};
    float v[3][3];
    double before[3], after[3], length = 0, error = 0;
    uint32_t bad;
    if (!mesh_init(&mesh, s->ctx, 3, 1, true)) return false;
    for (int i = 0; i < 9; i++) v[i / 3][i % 3] = (float)random_in(&s->random, -1, 1);
    exact_normal(before, &transform_identity, v);
    exact_normal(after, t, v);
    memcpy(mesh.positions, v, sizeof v);
    for (int i = 0; i < 9; i++) mesh.normals[i] = (float)before[i % 3];
    bool fits = mesh_transform(&mesh, t, 0, 3, &bad);
    for (int k = 0; k < 3; k++) length += (double)mesh.normals[k] * mesh.normals[k];
    for (int k = 0; k < 3; k++) error = fmax(error, fabs(mesh.normals[k] / sqrt(length) - (mirror ? -after[k] : after[k])));
    // The normal that went in was rounded to fp32, and the transform may magnify that by its condition.
    double slack = 4 * 0x1p-24 * transform_condition(t);
    tally->rays++;
    if (!fits || !(error <= slack)) tally_wrong(tally, "a normal is off by %.3g, more than %.3g", error, slack);
    mesh_finish(&mesh);
    return true;
}

static struct transform scaling(double x, double y, double z) {
    struct transform t = transform_identity;
    t.m[0][0] = x, t.m[1][1] = y, t.m[2][2] = z;
    t.m[0][3] = 10, t.m[1][3] = -3, t.m[2][3] = 0.5;
    return t;
}

static bool run_transforms(struct stress *s, const struct transform *transforms, size_t count, bool mirror) {
    struct tally tally = {0};
    for (uint32_t i = 0; i < 40 * count; i++)
        if (!judge_transform(&tally, s, &transforms[i % count], mirror)) return false;
    tally_every(s, &tally);
    return true;
}

// X03
bool loading_uneven_scale(struct stress *s) {
    struct transform sheared = scaling(1, 1e-4, 1);
    sheared.m[0][1] = 0.5, sheared.m[2][0] = -0.25;
    const struct transform all[] = {scaling(1, 1e-4, 1), scaling(100, 1, 0.01), scaling(1e-3, 1e-3, 1e-3), sheared};
    return run_transforms(s, all, sizeof all / sizeof *all, false);
}

// X04
bool loading_mirror(struct stress *s) {
    const struct transform all[] = {scaling(-1, 1, 1), scaling(1, 1, -2), scaling(-3, -1, -0.5)};
    return run_transforms(s, all, sizeof all / sizeof *all, true);
}

// X05: what has no inverse, or hardly one, is recognised; scene_json.c refuses it.
bool loading_singular(struct stress *s) {
    struct transform flat = scaling(1, 0, 1), nearly = scaling(1, 1e-9, 1), rank = scaling(1, 1, 1), all_zero = scaling(0, 0, 0),
                     bad = scaling(NAN, 1, 1);
    for (int k = 0; k < 3; k++) rank.m[2][k] = rank.m[0][k] + rank.m[1][k];
    const struct {
        const struct transform t;
        bool singular;
    } cases[] = {{flat, true},
                 {nearly, true},
                 {rank, true},
                 {all_zero, true},
                 {bad, true},
                 {scaling(1, 1e-4, 1), false},
                 {scaling(1e-6, 1e-6, 1e-6), false}};
    struct tally tally = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double condition = transform_condition(&cases[i].t);
        tally.rays++;
        if ((condition < WORST_CONDITION) == cases[i].singular) tally_wrong(&tally, "transform %zu: condition %g", i, condition);
    }
    tally_every(s, &tally);
    return true;
}
