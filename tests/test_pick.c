// Picking a setting: the choice on candidates made by hand, samples of a picture, and real pictures that must keep what was asked for.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "api/handles.h"
#include "measure/pick.h"
#include "reference/reference.h"

#include "program.h"

#define WIDTH 64
#define HEIGHT 48

// A sphere on a floor, and many thin triangles: edges everywhere.
static const char head[] =
    "{\"version\": 1,\n"
    " \"camera\": {\"position\": [0,0.5,0], \"look_at\": [0,0,-3], \"up\": [0,1,0], \"fov_y_deg\": 60},\n"
    " \"film\": {\"width\": 64, \"height\": 48, \"spp\": 1, \"transfer\": \"srgb\"},\n"
    " \"background\": [0.25,0.5,1], \"ambient\": [0.2,0.2,0.2],\n"
    " \"materials\": {\"red\": {\"ambient\": [1,0,0], \"diffuse\": [0.8,0.4,0.2], \"specular\": [0.1,0.1,0.1], \"shininess\": 32}},\n"
    " \"lights\": [{\"type\": \"point\", \"position\": [-10,10,4], \"intensity\": [0.8,0.8,0.8]}],\n"
    " \"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1, \"material\": \"red\"},\n"
    "  {\"type\": \"triangle\", \"vertices\": [[-4,-1,-6],[4,-1,-6],[0,-1,1]], \"material\": \"red\"}";

static const char *const scenes[] = {"plain", "fence"};

static bool write_scene(const char *name, int posts) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s.json", TEST_OUTPUT_DIR, name);
    FILE *file = fopen(path, "wb");
    if (!file) return false;
    fputs(head, file);
    for (int i = 0; i < posts; i++)
        fprintf(file, ",\n{\"type\": \"triangle\", \"vertices\": [[%g,-1,-5],[%g,-1,-5],[%g,1.5,-5]], \"material\": \"red\"}", 0.3 * i - 3,
                0.3 * i - 2.9, 0.3 * i - 2.95);
    fputs("]}\n", file);
    return fclose(file) == 0;
}

struct fixture {
    struct gn_scene *scenes[2];
    struct gn_device *device; // NULL where there is none
    struct gn_error error;
};

static int open_all(void **state) {
    static struct fixture f;
    *state = &f;
    mkdir(TEST_OUTPUT_DIR, 0777);
    for (int i = 0; i < 2; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s.json", TEST_OUTPUT_DIR, scenes[i]);
        if (!write_scene(scenes[i], 20 * i)) return -1;
        if (!(f.scenes[i] = gn_scene_load(path, NULL, &f.error))) return print_error("%s\n", f.error.message), -1;
    }
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    f.device = gn_device_create(&params, &f.error);
    if (!f.device) print_message("no device: %s\n", f.error.message);
    return 0;
}

static int close_all(void **state) {
    struct fixture *f = *state;
    gn_device_destroy(f->device);
    for (int i = 0; i < 2; i++) gn_scene_destroy(f->scenes[i]);
    return 0;
}

// ---------------------------------------------------------------------------------------------------------------- choice

static void the_best_is_picked(void **state) {
    (void)state;
    static const struct {
        double max_error, max_seconds;
        bool met;
        uint32_t best;
    } rows[] = {
        {0.2, 0, true, 1},                        // the fastest that is close enough
        {0.05, 0, true, 3},                       // only one is
        {0.001, 0, false, 4},                     // none: the closest
        {0, 3, true, 1},                          // the closest in time; of equal ones the faster
        {0, 100, true, 4},    {0, 0.5, false, 0}, // none: the fastest
        {0.2, 1.5, false, 0},                     // none has both: the closest in time
        {0.05, 5, true, 3},   {0.04, 5, false, 3},
    };
    static const struct pick_candidate candidates[] = {{.error = 0.5, .seconds = 1},  {.error = 0.1, .seconds = 2},
                                                       {.error = 0.1, .seconds = 3},  {.error = 0.05, .seconds = 4},
                                                       {.error = 0.01, .seconds = 8}, {.error = NAN, .seconds = 0.1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bool met;
        uint32_t best = pick_best(candidates, 5, rows[i].max_error, rows[i].max_seconds, &met);
        if (best != rows[i].best || met != rows[i].met) fail_msg("row %zu: %u, %s", i, best, met ? "met" : "not met");
    }
    bool met;
    assert_int_equal(pick_best(candidates, 6, 0.2, 0, &met), 1); // what is no number is not close
}

// --------------------------------------------------------------------------------------------------------------- samples

static void a_sample_is_of_the_picture(void **state) {
    struct fixture *f = *state;
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct image whole, part, gathered;
    assert_true(scene_bvh(f->scenes[1], &ctx));
    struct sample sample = {.scene = &f->scenes[1]->scene, .bvh = &f->scenes[1]->bvh, .width = WIDTH, .height = HEIGHT, .effects = 0xff};
    double seconds;
    assert_true(sample_reference(&whole, &seconds, &ctx, &sample, 2, 9));
    assert_true(whole.width == WIDTH && whole.height == HEIGHT && seconds > 0 && sample_pixels(&sample) == WIDTH * HEIGHT);
    for (double pixels = 0.1; pixels < 1e5; pixels *= 7) {
        sample.lattice = sample_lattice(WIDTH, HEIGHT, pixels);
        assert_true(sample_pixels(&sample) >= 1 && sample_pixels(&sample) <= fmax(1.5 * pixels + 40, 1));
        assert_true(sample_reference(&part, NULL, &ctx, &sample, 2, 9));
        assert_true(sample_gather(&gathered, &ctx, &sample, &whole));
        assert_true(gathered.width == part.width && gathered.height == part.height);
        assert_true(sample_rmse(&gathered, &part) == 0);
        gathered.pixels[0] += 0.5f;
        assert_true(sample_rmse(&gathered, &part) > 0);
        gathered.pixels[0] = NAN;
        assert_true(isinf(sample_rmse(&gathered, &part)));
        image_finish(&gathered);
        image_finish(&part);
    }
    image_finish(&whole);
}

// -------------------------------------------------------------------------------------------------------------- pictures

// Picks, renders and checks. Returns the error that was measured.
static double picked_error(struct fixture *f, struct gn_scene *scene, const struct gn_pick_params *params, struct gn_pick *pick) {
    double error;
    uint64_t pixels;
    if (!gn_pick(f->device, scene, params, pick, &f->error)) fail_msg("%s", f->error.message);
    struct gn_render_params render = params->render;
    render.accuracy = pick->picked.accuracy, render.spp = pick->picked.spp;
    struct gn_picture *picture = gn_render(f->device, scene, &render, &f->error);
    if (!picture) fail_msg("%s", f->error.message);
    if (!gn_pick_check(scene, params, pick, picture, 1, &error, &pixels, &f->error)) fail_msg("%s", f->error.message);
    assert_true(pixels >= 16 && pixels <= WIDTH * HEIGHT);
    gn_picture_destroy(picture);
    return error;
}

static void errors_are_kept(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    static const struct {
        int scene;
        struct gn_pick_params params;
        bool met;
    } rows[] = {
        {0, {.max_error = 0.05}, true},
        {1, {.max_error = 0.02}, true},
        {1, {.render = {.spp = 1}, .max_error = 1e-4}, true},
        {0, {.render = {.spp = 4, .accuracy = GN_EXACT}, .keep_accuracy = true, .max_error = 1e-5}, true},
        {1, {.render = {.spp = 1, .accuracy = GN_FAST}, .keep_accuracy = true, .max_error = 1e-10}, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct gn_pick_params *params = &rows[i].params;
        struct gn_pick pick;
        double error = picked_error(f, f->scenes[rows[i].scene], params, &pick);
        if (pick.met != rows[i].met) fail_msg("row %zu: %s", i, pick.because);
        if ((error <= params->max_error) != rows[i].met) fail_msg("row %zu: an error of %g; %s", i, error, pick.because);
        assert_true(strlen(pick.because) > 0 && pick.count > 0 && isfinite(pick.picked.error) && pick.picked.seconds > 0);
        if (params->render.spp) assert_int_equal(pick.picked.spp, params->render.spp);
        if (params->keep_accuracy) assert_int_equal(pick.picked.accuracy, params->render.accuracy);
    }
}

// A smaller error takes more samples: the control that something is picked at all.
static void less_error_takes_more(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    struct gn_pick coarse, fine;
    assert_true(gn_pick(f->device, f->scenes[1], &(struct gn_pick_params){.max_error = 0.1}, &coarse, &f->error));
    assert_true(gn_pick(f->device, f->scenes[1], &(struct gn_pick_params){.max_error = 0.02}, &fine, &f->error));
    assert_true(coarse.met && fine.met && fine.picked.spp > coarse.picked.spp && fine.picked.error < coarse.picked.error);
}

static void time_is_kept_as_far_as_can_be_expected(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    struct gn_pick pick;
    assert_true(gn_pick(f->device, f->scenes[0], &(struct gn_pick_params){.max_seconds = 2}, &pick, &f->error));
    assert_true(!pick.met || pick.picked.seconds <= 2);
    assert_true(gn_pick(f->device, f->scenes[0], &(struct gn_pick_params){.max_seconds = 1e-9}, &pick, &f->error));
    assert_false(pick.met);
    for (uint32_t i = 0; i < pick.count; i++) assert_true(pick.picked.seconds <= pick.candidates[i].seconds);
}

static void faults_are_values(void **state) {
    struct fixture *f = *state;
    struct gn_pick pick;
    assert_false(gn_pick(NULL, f->scenes[0], &(struct gn_pick_params){.max_error = 1}, &pick, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
    if (!f->device) return;
    assert_false(gn_pick(f->device, f->scenes[0], &(struct gn_pick_params){.max_error = 0}, &pick, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
    const struct gn_pick_params many = {.render = {.spp = 100000}, .max_error = 0.1};
    assert_false(gn_pick(f->device, f->scenes[0], &many, &pick, &f->error)); // more samples than are tried
    assert_int_equal(f->error.status, GN_USAGE);
    assert_string_equal(gn_accuracy_name(GN_EXACT), "exact");
    assert_null(gn_accuracy_name(GN_ACCURACY_COUNT));
}

// --------------------------------------------------------------------------------------------------------------- program

static void the_program_says_what_it_picked(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    static const struct {
        const char *words;
        int code;
    } rows[] = {
        {"render ../fence.json -o a.png --max-error 0.05 --json", 0},
        {"render ../fence.json -o b.png --max-error 1e-10 --accuracy fast --spp 1 --json", 1},
        {"render ../fence.json -o c.png --max-error 0.05 --reference", 2},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct program_result result = program_expect(rows[i].words, rows[i].code, rows[i].code == 2 ? "nothing to pick" : "picked");
        assert_int_equal(program_has(i == 0 ? "a.png" : i == 1 ? "b.png" : "c.png"), rows[i].code < 2);
        if (rows[i].code < 2) {
            json_t *object = program_json(rows[i].words, &result), *picked = json_object_get(object, "picked");
            assert_true(json_is_string(json_object_get(picked, "accuracy")) && json_is_integer(json_object_get(picked, "spp")));
            double expected = json_number_value(json_object_get(object, "expected_error"));
            double measured = json_number_value(json_object_get(object, "measured_error"));
            assert_true(expected > 0 && measured > 0 && (measured <= 0.05 || rows[i].code == 1));
            assert_int_equal(json_integer_value(json_object_get(object, "spp")), json_integer_value(json_object_get(picked, "spp")));
            json_decref(object);
        }
        program_free(&result);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_is_picked),
        cmocka_unit_test(a_sample_is_of_the_picture),
        cmocka_unit_test(errors_are_kept),
        cmocka_unit_test(less_error_takes_more),
        cmocka_unit_test(time_is_kept_as_far_as_can_be_expected),
        cmocka_unit_test(faults_are_values),
        cmocka_unit_test(the_program_says_what_it_picked),
    };
    return cmocka_run_group_tests_name("pick", tests, open_all, close_all);
}
