// The layers that show where accuracy is lost, on a square whose diagonal, an edge of both its triangles, passes through pixel centres.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "measure/layers.h"

#include <cmocka.h>

#define SIDE 32
#define PIXELS (SIDE * SIDE)
#define ALL (GN_AOV_ERROR | GN_AOV_ULP | GN_AOV_UNDECIDED)

static const char scene_text[] =
    "{\"version\": 1,\n"
    " \"camera\": {\"position\": [0,0,0], \"look_at\": [0,0,-1], \"up\": [0,1,0], \"fov_y_deg\": 60},\n"
    " \"film\": {\"width\": 32, \"height\": 32, \"spp\": 1, \"transfer\": \"srgb\"},\n"
    " \"materials\": {\"red\": {\"ambient\": [1,0,0], \"diffuse\": [0.8,0.3,0.1], \"specular\": [0.1,0.1,0.1], \"shininess\": 32}},\n"
    " \"lights\": [{\"type\": \"point\", \"position\": [-1,2,1], \"intensity\": [0.8,0.8,0.8]}],\n"
    " \"shapes\": [{\"type\": \"triangle\", \"vertices\": [[-1,-1,-3],[1,-1,-3],[1,1,-3]], \"material\": \"red\"},\n"
    "  {\"type\": \"triangle\", \"vertices\": [[-1,-1,-3],[1,1,-3],[-1,1,-3]], \"material\": \"red\"}]}\n";

struct fixture {
    struct gn_scene *scene;
    struct gn_device *device; // NULL where there is none
    struct gn_error error;
};

static int open_all(void **state) {
    static struct fixture fixture;
    mkdir(TEST_OUTPUT_DIR, 0777);
    FILE *file = fopen(TEST_OUTPUT_DIR "/square.json", "wb");
    if (!file || fputs(scene_text, file) < 0 || fclose(file) != 0) return -1;
    fixture.scene = gn_scene_load(TEST_OUTPUT_DIR "/square.json", NULL, &fixture.error);
    if (!fixture.scene) print_error("%s\n", fixture.error.message);
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    fixture.device = gn_device_create(&params, &fixture.error);
    if (!fixture.device) print_message("no device: %s\n", fixture.error.message);
    *state = &fixture;
    return fixture.scene ? 0 : -1;
}

static int close_all(void **state) {
    struct fixture *fixture = *state;
    gn_device_destroy(fixture->device);
    gn_scene_destroy(fixture->scene);
    return 0;
}

static struct gn_picture *rendered(struct fixture *f, struct gn_device *device, enum gn_accuracy accuracy, uint32_t aovs) {
    const struct gn_render_params params = {.accuracy = accuracy, .aovs = aovs};
    struct gn_picture *picture = gn_render(device, f->scene, &params, &f->error);
    if (!picture) fail_msg("%s", f->error.message);
    return picture;
}

static void ulp_are_counted(void **state) {
    (void)state;
    static const struct {
        float a, b, distance;
    } rows[] = {
        {1, 1, 0},
        {1, 1 + 0x1p-23f, 1},
        {1, 1 - 0x1p-24f, 1},
        {1, 2, 0x1p23f},
        {0, 0x1p-149f, 1},
        {INFINITY, 1, INFINITY},
        {1, INFINITY, INFINITY},
        {INFINITY, INFINITY, 0},
        {NAN, 1, INFINITY},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) assert_true(ulp_distance(rows[i].a, rows[i].b) == rows[i].distance);
}

static void errors_are_differences_to_the_reference(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    struct gn_picture *ours = rendered(f, f->device, GN_FAST, ALL), *theirs = rendered(f, NULL, GN_ROBUST, GN_AOV_DEPTH);
    const float *color = gn_picture_pixels(ours, 0), *right = gn_picture_pixels(theirs, 0);
    const float *error = gn_picture_pixels(ours, GN_AOV_ERROR), *ulp = gn_picture_pixels(ours, GN_AOV_ULP);
    const float *depth = gn_picture_pixels(theirs, GN_AOV_DEPTH);
    assert_null(gn_picture_pixels(ours, GN_AOV_DEPTH)); // it took part, but was not asked for
    assert_true(gn_picture_stats(ours)->time_ms.reference > 0);
    int off = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_true(error[i] == fabsf(color[i] - right[i]));
        off += error[i] > 0;
    }
    assert_true(off > 0); // fp32 is not exact
    for (int i = 0; i < PIXELS; i++) assert_true(isfinite(depth[i]) ? ulp[i] < 64 || isinf(ulp[i]) : ulp[i] == 0 || isinf(ulp[i]));
    gn_picture_destroy(ours);
    gn_picture_destroy(theirs);
}

static void undecided_rays_are_counted_where_they_are(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    for (int exact = 0; exact < 2; exact++) {
        struct gn_picture *picture = rendered(f, f->device, exact ? GN_EXACT : GN_ROBUST, ALL);
        const struct gn_render_stats *stats = gn_picture_stats(picture);
        const float *undecided = gn_picture_pixels(picture, GN_AOV_UNDECIDED);
        double sum = 0, diagonal = 0;
        for (int i = 0; i < PIXELS; i++) {
            sum += (double)undecided[i];
            diagonal += i % SIDE + i / SIDE == SIDE - 1 ? (double)undecided[i] : 0;
        }
        assert_true(sum == (double)stats->undecided_rays);
        assert_true(stats->second_stage_rays + stats->host_rays == stats->undecided_rays);
        if (exact)
            assert_true(diagonal > 8 && sum < PIXELS);
        else
            assert_true(sum == 0);
        gn_picture_destroy(picture);
    }
}

static void the_reference_has_none(void **state) {
    struct fixture *f = *state;
    for (uint32_t bit = GN_AOV_ERROR; bit <= GN_AOV_UNDECIDED; bit *= 2) {
        const struct gn_render_params params = {.aovs = bit};
        assert_null(gn_render(NULL, f->scene, &params, &f->error));
        assert_int_equal(f->error.status, GN_USAGE);
    }
    const struct gn_render_params unknown = {.aovs = 2 * GN_AOV_UNDECIDED};
    assert_null(gn_render(f->device, f->scene, &unknown, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
}

static void each_becomes_a_file(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    static const char *const files[] = {"a.error.png", "a.ulp.png", "a.undecided.png", "a.png", "b.error.pfm", "b.pfm", "c.exr"};
    struct gn_picture *picture = rendered(f, f->device, GN_EXACT, ALL);
    assert_true(gn_picture_save(picture, TEST_OUTPUT_DIR "/a.png", &f->error));
    assert_true(gn_picture_save(picture, TEST_OUTPUT_DIR "/b.pfm", &f->error));
    assert_true(gn_picture_save(picture, TEST_OUTPUT_DIR "/c.exr", &f->error));
    gn_picture_destroy(picture);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", TEST_OUTPUT_DIR, files[i]);
        if (access(path, F_OK) != 0) fail_msg("%s is missing", path);
        remove(path);
    }
}

// False colour is a heat map: darker is less.
static void views_grow_with_what_they_show(void **state) {
    (void)state;
    static const struct {
        bool (*view)(struct image *, struct context *, const struct image *);
        float values[6];
    } rows[] = {
        {view_of_error, {0, 1e-6f, 1e-4f, 1e-2f, 1, NAN}},
        {view_of_ulp, {0, 1, 8, 200, 4095, INFINITY}},
        {view_of_undecided, {0, 1, 3, 7, 15, 1000}},
    };
    for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
        float values[6];
        memcpy(values, rows[row].values, sizeof values);
        const struct image in = {.width = 6, .height = 1, .channels = 1, .pixels = values};
        struct image out;
        struct gn_error error;
        struct context ctx = context_make(NULL, &error);
        assert_true(rows[row].view(&out, &ctx, &in));
        for (int i = 1; i < 6; i++) {
            float before = 0, here = 0;
            for (int c = 0; c < 3; c++) before += out.pixels[3 * i - 3 + c], here += out.pixels[3 * i + c];
            assert_true(i < 5 ? here > before : here >= before);
        }
        image_finish(&out);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ulp_are_counted),
        cmocka_unit_test(errors_are_differences_to_the_reference),
        cmocka_unit_test(undecided_rays_are_counted_where_they_are),
        cmocka_unit_test(the_reference_has_none),
        cmocka_unit_test(each_becomes_a_file),
        cmocka_unit_test(views_grow_with_what_they_show),
    };
    return cmocka_run_group_tests_name("layers", tests, open_all, close_all);
}
