// Whole pictures: the seed's figures against their formulas, every scene against the reference, the same seed the same bits, and hits that are exact.
#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "gnomon.h"

#include <cmocka.h>

static struct gn_device *device;
static struct gn_error error;

static int open_device(void **state) {
    (void)state;
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    mkdir(TEST_OUTPUT_DIR, 0777);
    device = gn_device_create(&params, &error);
    if (!device) print_message("no device: %s\n", error.message);
    return 0;
}

static int close_device(void **state) {
    (void)state;
    gn_device_destroy(device);
    return 0;
}

static struct gn_scene *loaded(const char *path) {
    struct gn_scene *scene = gn_scene_load(path, NULL, &error);
    if (!scene) fail_msg("%s", error.message);
    return scene;
}

static struct gn_picture *rendered(struct gn_scene *scene, const struct gn_render_params *params) {
    struct gn_picture *picture = gn_render(device, scene, params, &error);
    if (!picture) fail_msg("%s", error.message);
    return picture;
}

static const char *scene_path(const char *name) {
    static char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s", TEST_SOURCE_DIR, name);
    return path;
}

// ---------------------------------------------------------------------------------------------------------- the seed's formulas

#define SIDE 512

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void normalize(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) v[i] /= length;
}

// The light model at p with unit normal n, seen from the origin: red material, white light at (-10, 10, 4).
static void phong(double rgb[3], const double p[3], const double n[3], bool specular) {
    double l[3] = {-10 - p[0], 10 - p[1], 4 - p[2]}, v[3] = {-p[0], -p[1], -p[2]}, r[3];
    normalize(l);
    normalize(v);
    double cosine = dot(n, l);
    for (int i = 0; i < 3; i++) r[i] = 2 * cosine * n[i] - l[i];
    double gloss = specular && cosine > 0 ? pow(fmax(dot(r, v), 0), 32) : 0;
    rgb[0] = 0.2 + 0.8 * fmax(cosine, 0) + 0.8 * gloss;
    rgb[1] = rgb[2] = 0.8 * gloss;
}

// Figures 1 and 3: the sphere at (0, 0, -3).
static bool sphere_pixel(double rgb[3], const double d[3], bool specular) {
    double a = dot(d, d), b = -3 * d[2], c = 8, discriminant = b * b - a * c;
    if (discriminant < 0) return false;
    double t = (b - sqrt(discriminant)) / a, p[3] = {t * d[0], t * d[1], t * d[2]}, n[3] = {p[0], p[1], p[2] + 3};
    normalize(n);
    phong(rgb, p, n, specular);
    return true;
}

// Figure 6: the triangle.
static bool triangle_pixel(double rgb[3], const double d[3]) {
    static const double v[3][3] = {{-1, -1, -3.5}, {1, 1, -3}, {0.75, -1, -2.5}};
    double e1[3], e2[3], n[3];
    for (int i = 0; i < 3; i++) {
        e1[i] = v[1][i] - v[0][i];
        e2[i] = v[2][i] - v[0][i];
    }
    for (int i = 0; i < 3; i++) n[i] = e1[(i + 1) % 3] * e2[(i + 2) % 3] - e1[(i + 2) % 3] * e2[(i + 1) % 3];
    // Edge functions d·(q×p), exact in fp64 for this ray: a pixel centre on an edge counts, as in Möller and Trumbore's test.
    double side[3];
    for (int k = 0; k < 3; k++) {
        const double *a = v[k], *b = v[(k + 1) % 3];
        side[k] = 0;
        for (int i = 0; i < 3; i++) side[k] += d[i] * (b[(i + 1) % 3] * a[(i + 2) % 3] - b[(i + 2) % 3] * a[(i + 1) % 3]);
    }
    if (fmin(side[0], fmin(side[1], side[2])) < 0 && fmax(side[0], fmax(side[1], side[2])) > 0) return false;
    double t = dot(v[0], n) / dot(d, n), p[3] = {t * d[0], t * d[1], t * d[2]};
    normalize(n);
    if (dot(n, d) > 0)
        for (int i = 0; i < 3; i++) n[i] = -n[i];
    phong(rgb, p, n, true);
    return true;
}

static int code(double value) { return (int)lround(255 * fmin(fmax(value, 0), 1)); }

// How many pixels of a figure are off by more than one code; `shift` moves the formula's pixel centres, in pixels.
static int figure_differences(const float *pixels, int figure, double shift) {
    int off = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double d[3] = {-1 + (i % SIDE + 0.5 + shift) * 2 / SIDE, 1 - (i / SIDE + 0.5) * 2 / SIDE, -1}, rgb[3] = {0, 0, 0};
        if (figure == 6) triangle_pixel(rgb, d);
        else sphere_pixel(rgb, d, figure == 3);
        bool differs = false;
        for (int k = 0; k < 3; k++) differs = differs || abs(code(pixels[3 * i + k]) - code(rgb[k])) > 1;
        off += differs;
    }
    return off;
}

static void seed_figures_are_their_formulas(void **state) {
    (void)state;
    static const int figures[] = {1, 3, 6};
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "seed_figure%d.json", figures[i]);
        struct gn_scene *scene = loaded(scene_path(name));
        for (int side = 0; side < 2; side++) { // the device, then the reference
            if (side == 0 && !device) continue;
            struct gn_picture *picture = gn_render(side == 0 ? device : NULL, scene, &(struct gn_render_params){0}, &error);
            assert_non_null(picture);
            const float *pixels = gn_picture_pixels(picture, 0);
            int off = figure_differences(pixels, figures[i], 0), control = figure_differences(pixels, figures[i], 1);
            if (off > 8 || control <= 8) fail_msg("figure %d: %d pixels are off; %d with centres moved by a pixel", figures[i], off, control);
            gn_picture_destroy(picture);
        }
        gn_scene_destroy(scene);
    }
}

// ------------------------------------------------------------------------------------------------------ scenes and the reference

// Every scene of scenes/, smaller than it is, in every tier that has something to promise.
static void scenes_agree_with_the_reference(void **state) {
    (void)state;
    if (!device) skip();
    static const enum gn_accuracy tiers[] = {GN_ROBUST, GN_EXACT, GN_FP64};
    glob_t scenes;
    assert_int_equal(glob(scene_path("*.json"), 0, NULL, &scenes), 0);
    assert_true(scenes.gl_pathc >= 20);
    int wrong = 0;
    for (size_t i = 0; i < scenes.gl_pathc; i++) {
        struct gn_scene *scene = loaded(scenes.gl_pathv[i]);
        struct gn_scene_info info;
        gn_scene_info(scene, &info);
        for (int t = 0; t < 3; t++) {
            if (tiers[t] == GN_FP64 && !gn_device_info(device)->has_fp64) continue;
            uint32_t width = 64, height = width * info.height / info.width;
            const struct gn_verify_params params = {.render = {.width = width, .height = height, .spp = 1, .accuracy = tiers[t]}};
            struct gn_verify_result result;
            if (!gn_verify(device, scene, &params, &result, NULL, &error)) fail_msg("%s: %s", scenes.gl_pathv[i], error.message);
            bool exact = tiers[t] == GN_ROBUST || result.wrong_hits == 0;
            if (!result.pass || !exact)
                print_error("%s, tier %d: %lu pixels differ, %lu hits are wrong, at most by %g at (%u, %u)\n", scenes.gl_pathv[i], (int)tiers[t],
                            (unsigned long)result.pixels_differing, (unsigned long)result.wrong_hits, result.max_abs, result.worst_x, result.worst_y);
            wrong += !result.pass || !exact;
        }
        gn_scene_destroy(scene);
    }
    globfree(&scenes);
    assert_int_equal(wrong, 0);
}

// ---------------------------------------------------------------------------------------------------------------- the same bits

static void expect_same(const struct gn_picture *a, const struct gn_picture *b, bool same) {
    size_t bytes = (size_t)gn_picture_width(a) * gn_picture_height(a) * 3 * sizeof(float);
    bool equal = memcmp(gn_picture_pixels(a, 0), gn_picture_pixels(b, 0), bytes) == 0;
    size_t depth = bytes / 3;
    equal = equal && memcmp(gn_picture_pixels(a, GN_AOV_DEPTH), gn_picture_pixels(b, GN_AOV_DEPTH), depth) == 0;
    assert_int_equal(equal, same);
}

static void same_seed_same_bits(void **state) {
    (void)state;
    if (!device) skip();
    struct gn_scene *scene = loaded(scene_path("seed_elaborate.json"));
    for (int tier = GN_ROBUST; tier <= GN_EXACT; tier++) {
        const struct gn_render_params plain = {.width = 90, .height = 70, .spp = 5, .seed = 3, .accuracy = (enum gn_accuracy)tier, .aovs = GN_AOV_DEPTH};
        struct gn_picture *first = rendered(scene, &plain);
        static const uint32_t tiles[] = {64, 640, 6400, 1000000};
        for (int i = 0; i < 4; i++) {
            struct gn_render_params params = plain;
            const struct gn_host host = {.threads = 1 + (unsigned)i};
            params.tile_pixels = tiles[i];
            params.host = &host;
            struct gn_picture *other = rendered(scene, &params);
            expect_same(first, other, true);
            gn_picture_destroy(other);
        }
        struct gn_render_params params = plain; // the control: another seed
        params.seed = 4;
        struct gn_picture *other = rendered(scene, &params);
        expect_same(first, other, false);
        gn_picture_destroy(other);
        gn_picture_destroy(first);
    }
    gn_scene_destroy(scene);
}

// A small scene with every length multiplied by 2^exponent, which is exact.
static struct gn_scene *scaled_scene(int exponent) {
    const char *path = TEST_OUTPUT_DIR "/scaled.json";
    double s = ldexp(1, exponent);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file,
            "{\"version\": 1, \"ambient\": [0.1,0.1,0.1], \"film\": {\"width\": 64, \"height\": 48, \"spp\": 2},\n"
            " \"camera\": {\"position\": [%.9g,%.9g,%.9g], \"look_at\": [0,0,0], \"fov_y_deg\": 50},\n"
            " \"materials\": {\"m\": {\"diffuse\": [0.7,0.6,0.5], \"specular\": [0.3,0.3,0.3], \"shininess\": 20}},\n"
            " \"lights\": [{\"type\": \"point\", \"position\": [%.9g,%.9g,%.9g]}],\n"
            " \"shapes\": [{\"type\": \"sphere\", \"center\": [0,%.9g,0], \"radius\": %.9g, \"material\": \"m\"},\n"
            "  {\"type\": \"triangle\", \"vertices\": [[%.9g,%.9g,%.9g],[%.9g,%.9g,%.9g],[0,%.9g,%.9g]], \"material\": \"m\"}]}\n",
            s, 0.75 * s, 3 * s, -2 * s, 4 * s, 3 * s, 0.25 * s, 0.75 * s, -3 * s, -0.5 * s, 2 * s, 3 * s, -0.5 * s, 2 * s, -0.5 * s, -4 * s);
    assert_int_equal(fclose(file), 0);
    return loaded(path);
}

// No epsilon is absolute: the picture of a scene scaled by a power of two is the same, to the bit.
static void any_scale_is_the_same_picture(void **state) {
    (void)state;
    if (!device) skip();
    static const int exponents[] = {-60, -20, 1, 20, 60};
    for (int tier = 0; tier < GN_ACCURACY_COUNT; tier++) {
        if (tier == GN_FP64 && !gn_device_info(device)->has_fp64) continue;
        const struct gn_render_params params = {.accuracy = (enum gn_accuracy)tier};
        struct gn_scene *scene = scaled_scene(0);
        struct gn_picture *right = rendered(scene, &params);
        gn_scene_destroy(scene);
        for (int i = 0; i < 5; i++) {
            scene = scaled_scene(exponents[i]);
            struct gn_picture *picture = rendered(scene, &params);
            size_t bytes = 64 * 48 * 3 * sizeof(float);
            if (memcmp(gn_picture_pixels(picture, 0), gn_picture_pixels(right, 0), bytes) != 0)
                fail_msg("tier %d: at 2^%d the picture is another", tier, exponents[i]);
            gn_picture_destroy(picture);
            gn_scene_destroy(scene);
        }
        gn_picture_destroy(right);
    }
}

// Samples that come in several dispatches are the same as in one: spp beyond a chunk, and a sum that is resumed.
static void more_samples_come_closer(void **state) {
    (void)state;
    if (!device) skip();
    struct gn_scene *scene = loaded(scene_path("shadow_gallery.json"));
    const struct gn_render_params many = {.width = 32, .height = 32, .spp = 128}, few = {.width = 32, .height = 32, .spp = 16, .seed = 9},
                                  one = {.width = 32, .height = 32, .spp = 1};
    struct gn_picture *truth = gn_render(NULL, scene, &many, &error);
    assert_non_null(truth);
    const struct gn_render_params *params[] = {&one, &few, &many};
    double rmse[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        struct gn_picture *picture = rendered(scene, params[i]);
        for (int k = 0; k < 32 * 32 * 3; k++) rmse[i] += pow(gn_picture_pixels(picture, 0)[k] - gn_picture_pixels(truth, 0)[k], 2);
        rmse[i] = sqrt(rmse[i] / (32 * 32 * 3));
        gn_picture_destroy(picture);
    }
    assert_true(rmse[2] < 1e-3 && rmse[1] < 0.5 * rmse[0] && rmse[2] < rmse[1]);
    gn_picture_destroy(truth);
    gn_scene_destroy(scene);
}

// ---------------------------------------------------------------------------------------------------------------------- rays

static uint32_t random_state = 1;

static float random_unit(void) {
    random_state = random_state * 1664525u + 1013904223u;
    return (float)(random_state >> 8) * 0x1p-24f;
}

// Rays from around the middle of the bumpy sphere: exact lattice directions, axes and diagonals among them, and random ones; some very long or short, and
// some that reach backwards.
static void make_rays(struct gn_ray *rays, size_t count) {
    for (size_t i = 0; i < count; i++) {
        bool lattice = i % 2 == 0;
        int exponent = i % 11 == 0 ? -140 : i % 13 == 0 ? 124 : 0;
        for (int k = 0; k < 3; k++) {
            rays[i].origin[k] = lattice ? 0 : 0.2f * (random_unit() - 0.5f);
            rays[i].direction[k] = ldexpf(lattice ? (float)((int)(random_unit() * 9) - 4) : random_unit() - 0.5f, exponent);
        }
        rays[i].tmin = i % 5 == 0 ? 0.125f : i % 5 == 1 ? -INFINITY : 0;
        rays[i].tmax = i % 7 == 0 ? 1 : INFINITY;
    }
}

static int differing_hits(const struct gn_hit *a, const struct gn_hit *b, size_t count) {
    int differing = 0;
    for (size_t i = 0; i < count; i++) {
        bool same = a[i].object == b[i].object && a[i].primitive == b[i].primitive && (a[i].flags & GN_HIT_INVALID) == (b[i].flags & GN_HIT_INVALID);
        differing += !(same && memcmp(&a[i].t, &b[i].t, 3 * sizeof(float)) == 0);
    }
    return differing;
}

static void traced(struct gn_device *on, struct gn_scene *scene, enum gn_accuracy accuracy, bool any, const struct gn_ray *rays, struct gn_hit *hits,
                   size_t count) {
    struct gn_trace_stats stats;
    const struct gn_trace_params params = {.accuracy = accuracy, .any = any};
    if (!gn_trace(on, scene, &params, rays, hits, count, &stats, &error)) fail_msg("%s", error.message);
}

// Every way to be invalid, and intervals that are empty but valid; each tier says the same of them.
static void invalid_rays_are_flagged(void **state) {
    (void)state;
    static const float odd[] = {NAN, INFINITY, -INFINITY};
    enum { ODD = 3, EMPTY = 3, COUNT = 8 * ODD + EMPTY + 1 };
    struct gn_ray rays[COUNT];
    struct gn_hit hits[COUNT];
    for (int i = 0; i < COUNT; i++) {
        rays[i] = (struct gn_ray){{0, 0, 0}, 0, {0, 0, -1}, INFINITY};
        float *const numbers[8] = {rays[i].origin, rays[i].origin + 1, rays[i].origin + 2, &rays[i].tmin,
                                   rays[i].direction, rays[i].direction + 1, rays[i].direction + 2, &rays[i].tmax};
        if (i < 8 * ODD) *numbers[i / ODD] = odd[i % ODD];
        else if (i < 8 * ODD + EMPTY) rays[i].tmin = INFINITY, rays[i].tmax = odd[i % ODD == 0 ? 1 : i % ODD];
    }
    rays[COUNT - 1].direction[2] = -0.0f; // not a direction at all
    struct gn_scene *scene = loaded(scene_path("inside_a_sphere.json"));
    static const enum gn_accuracy tiers[] = {GN_FAST, GN_ROBUST, GN_EXACT, GN_FP64};
    for (int t = 0; t < 5; t++) {
        if (t < 4 && (!device || (tiers[t] == GN_FP64 && !gn_device_info(device)->has_fp64))) continue;
        for (int any = 0; any < 2; any++) {
            traced(t < 4 ? device : NULL, scene, t < 4 ? tiers[t] : GN_ROBUST, any, rays, hits, COUNT);
            for (int i = 0; i < COUNT; i++) {
                bool bound = i < 8 * ODD && (i / ODD == 3 || i / ODD == 7);
                bool invalid = i == COUNT - 1 || (i < 8 * ODD && (!bound || i % ODD == 0));
                if ((hits[i].flags & GN_HIT_INVALID) != invalid) fail_msg("tier %d, ray %d: flags %x", t, i, hits[i].flags);
                if (invalid || i >= 8 * ODD) assert_int_equal(hits[i].object, -1);
            }
        }
    }
    gn_scene_destroy(scene);
}

// On a lattice mesh many rays go through vertices and edges exactly: only exact decisions agree with the reference everywhere.
static void exact_hits_are_the_reference(void **state) {
    (void)state;
    if (!device) skip();
    enum { COUNT = 6000 };
    static struct gn_ray rays[COUNT];
    static struct gn_hit hits[COUNT], right[COUNT];
    static const char *const names[] = {"interpenetrating.json", "asteroid.json", "flake.json", "inside_a_sphere.json", "far_from_origin.json"};
    int fast = 0;
    for (int i = 0; i < 5; i++) {
        struct gn_scene *scene = loaded(scene_path(names[i]));
        make_rays(rays, COUNT);
        for (int any = 0; any < 2; any++) {
            traced(NULL, scene, GN_ROBUST, any, rays, right, COUNT);
            traced(device, scene, GN_EXACT, any, rays, hits, COUNT);
            if (any) {
                for (int k = 0; k < COUNT; k++) assert_int_equal(hits[k].object, right[k].object);
                continue;
            }
            int differing = differing_hits(hits, right, COUNT);
            if (differing) fail_msg("%s: %d hits differ", names[i], differing);
            traced(device, scene, GN_FAST, any, rays, hits, COUNT);
            fast += differing_hits(hits, right, COUNT);
        }
        gn_scene_destroy(scene);
    }
    assert_true(fast > COUNT / 10); // the control
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(seed_figures_are_their_formulas), cmocka_unit_test(scenes_agree_with_the_reference),
        cmocka_unit_test(same_seed_same_bits),             cmocka_unit_test(any_scale_is_the_same_picture),
        cmocka_unit_test(more_samples_come_closer),        cmocka_unit_test(exact_hits_are_the_reference),
        cmocka_unit_test(invalid_rays_are_flagged),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
