// The library as a program sees it: gnomon.h alone, and files.
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

#include "gnomon.h"

#include <cmocka.h>

#define FOLDER TEST_OUTPUT_DIR "/api"
#define WIDTH 48
#define HEIGHT 32

static const char scene_text[] =
    "{\"version\": 1,\n"
    " \"camera\": {\"position\": [0,0.5,0], \"look_at\": [0,0,-3], \"up\": [0,1,0], \"fov_y_deg\": 60},\n"
    " \"film\": {\"width\": 48, \"height\": 32, \"spp\": 2, \"transfer\": \"srgb\"},\n"
    " \"background\": [0.25,0.5,1], \"ambient\": [0.2,0.2,0.2],\n"
    " \"materials\": {\"red\": {\"ambient\": [1,0,0], \"diffuse\": [0.8,0,0], \"specular\": [0.1,0.1,0.1], \"shininess\": 32}},\n"
    " \"lights\": [{\"type\": \"point\", \"position\": [-10,10,4], \"intensity\": [0.8,0.8,0.8]}],\n"
    " \"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1, \"material\": \"red\"},\n"
    "  {\"type\": \"triangle\", \"vertices\": [[-4,-1,-6],[4,-1,-6],[0,-1,1]], \"material\": \"red\"}]}\n";

struct fixture {
    struct gn_scene *scene;
    struct gn_device *device; // NULL where there is none
    struct gn_error error;
};

static int open_all(void **state) {
    static struct fixture fixture;
    mkdir(TEST_OUTPUT_DIR, 0777);
    mkdir(FOLDER, 0777);
    FILE *file = fopen(FOLDER "/scene.json", "wb");
    if (!file || fputs(scene_text, file) < 0 || fclose(file) != 0) return -1;
    fixture.scene = gn_scene_load(FOLDER "/scene.json", NULL, &fixture.error);
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

// A picture, or the end of the test.
static struct gn_picture *rendered(struct fixture *f, struct gn_device *device, const struct gn_render_params *params) {
    struct gn_picture *picture = gn_render(device, f->scene, params, &f->error);
    if (!picture) fail_msg("%s", f->error.message);
    return picture;
}

// -------------------------------------------------------------------------------------------------------------- the basics

static void version_is_the_header_s(void **state) {
    (void)state;
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", GN_VERSION_MAJOR, GN_VERSION_MINOR, GN_VERSION_PATCH);
    assert_string_equal(gn_version(), text);
}

static void nothing_can_be_destroyed(void **state) {
    (void)state;
    gn_device_destroy(NULL);
    gn_scene_destroy(NULL);
    gn_picture_destroy(NULL);
}

static void scene_is_described(void **state) {
    struct fixture *f = *state;
    struct gn_scene_info info;
    gn_scene_info(f->scene, &info);
    assert_true(info.shapes == 2 && info.materials >= 1 && info.lights == 1 && info.triangles == 1 && info.spheres == 1);
    assert_true(info.width == WIDTH && info.height == HEIGHT && info.spp == 2);
}

static void scene_faults_are_values(void **state) {
    struct fixture *f = *state;
    assert_null(gn_scene_load(FOLDER "/missing.json", NULL, &f->error));
    assert_int_equal(f->error.status, GN_IO);
    assert_non_null(strstr(f->error.message, "missing.json"));
    FILE *file = fopen(FOLDER "/bad.json", "wb");
    assert_non_null(file);
    assert_true(fputs("{\"version\": 1, \"shapes\": 7}", file) >= 0 && fclose(file) == 0);
    assert_null(gn_scene_load(FOLDER "/bad.json", NULL, &f->error));
    assert_int_equal(f->error.status, GN_SCENE);
    assert_non_null(strstr(f->error.message, "bad.json:1:"));
}

static void devices_are_listed(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    struct gn_device_info infos[16];
    uint32_t count;
    int selected;
    assert_true(gn_device_list(NULL, infos, 16, &count, &selected, &f->error));
    assert_true(count >= 1 && selected >= 0);
    assert_true(strlen(gn_device_info(f->device)->name) > 0 && gn_device_info(f->device)->usable);
    assert_true(gn_device_list(&(struct gn_device_params){.select = "no such device"}, infos, 16, &count, &selected, &f->error));
    assert_int_equal(selected, -1);
    assert_null(gn_device_create(&(struct gn_device_params){.select = "no such device"}, &f->error));
    assert_int_equal(f->error.status, GN_NO_DEVICE);
}

static void plan_says_why(void **state) {
    struct fixture *f = *state;
    struct gn_effect effects[64];
    uint32_t count, on = 0;
    assert_true(gn_plan(f->scene, NULL, effects, 64, &count, &f->error));
    assert_true(count >= 8);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(strlen(effects[i].name) > 0 && strlen(effects[i].because) > 0);
        on += effects[i].on;
        if (strcmp(effects[i].name, "antialiasing") == 0) assert_true(effects[i].on); // 2 samples per pixel
    }
    assert_true(on > 0 && on < count);
    assert_true(gn_plan(f->scene, &(struct gn_render_params){.no_prune = true}, effects, 64, &count, &f->error));
    for (uint32_t i = 0; i < count; i++) assert_true(effects[i].on);
    assert_true(gn_plan(f->scene, NULL, effects, 3, &count, &f->error));
    assert_int_equal(count, 3);
    assert_false(gn_plan(f->scene, &(struct gn_render_params){.disable = "frobnication"}, effects, 64, &count, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
}

// --------------------------------------------------------------------------------------------------------------- pictures

static void check_picture(struct fixture *f, struct gn_device *device) {
    const struct gn_render_params params = {.aovs = GN_AOV_DEPTH | GN_AOV_NORMAL | GN_AOV_ID, .seed = 3};
    struct gn_picture *picture = rendered(f, device, &params);
    const struct gn_render_stats *stats = gn_picture_stats(picture);
    assert_true(gn_picture_width(picture) == WIDTH && gn_picture_height(picture) == HEIGHT);
    assert_true(stats->rays >= 2 * WIDTH * HEIGHT && stats->nonfinite_pixels == 0 && stats->time_ms.total > 0 && stats->mrays_per_s > 0);
    assert_string_equal(stats->accuracy, device ? "robust" : "reference");
    assert_non_null(strstr(stats->effects, "spheres"));

    const float *color = gn_picture_pixels(picture, 0), *depth = gn_picture_pixels(picture, GN_AOV_DEPTH);
    const float *normal = gn_picture_pixels(picture, GN_AOV_NORMAL), *id = gn_picture_pixels(picture, GN_AOV_ID);
    assert_true(color && depth && normal && id);
    assert_null(gn_picture_pixels(picture, 8));
    size_t middle = (size_t)(HEIGHT / 2) * WIDTH + WIDTH / 2; // the sphere
    assert_true(color[0] == 0.25f && color[1] == 0.5f && color[2] == 1);
    assert_true(isinf(depth[0]) && id[0] == -1 && id[1] == -1 && normal[0] == 0 && normal[1] == 0 && normal[2] == 0);
    assert_true(id[2 * middle] == 0 && depth[middle] > 1.9f && depth[middle] < 2.3f && color[3 * middle] > 0.3f);
    const float *n = normal + 3 * middle;
    assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) <= 0.02f && n[2] > 0.9f); // the mean of two samples
    gn_picture_destroy(picture);
}

static void reference_picture(void **state) { check_picture(*state, NULL); }

static void device_picture(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    check_picture(f, f->device);
}

static void parameters_override_the_scene(void **state) {
    struct fixture *f = *state;
    struct gn_picture *picture = rendered(f, NULL, &(struct gn_render_params){.width = 7, .height = 5, .spp = 1});
    assert_true(gn_picture_width(picture) == 7 && gn_picture_height(picture) == 5);
    assert_null(strstr(gn_picture_stats(picture)->effects, "antialiasing"));
    assert_null(gn_picture_pixels(picture, GN_AOV_DEPTH));
    gn_picture_destroy(picture);
}

// More rows than an image of any device may have.
static void tall_pictures_come_in_bands(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    enum { ROWS = 65535 };
    const struct gn_render_params params = {.width = 1, .height = ROWS, .spp = 1, .aovs = GN_AOV_ID};
    struct gn_picture *a = rendered(f, f->device, &params), *b = rendered(f, NULL, &params);
    const float *id = gn_picture_pixels(a, GN_AOV_ID), *right = gn_picture_pixels(b, GN_AOV_ID);
    int differing = 0, hits = 0;
    for (int i = 0; i < ROWS; i++) {
        differing += id[2 * i] != right[2 * i];
        hits += id[2 * i] >= 0;
    }
    assert_true(hits > 0 && hits < ROWS && differing <= 6);
    gn_picture_destroy(a);
    gn_picture_destroy(b);
}

static void same_seed_same_bits(void **state) {
    struct fixture *f = *state;
    struct gn_device *devices[] = {NULL, f->device};
    for (int i = 0; i < (f->device ? 2 : 1); i++) {
        const struct gn_host one_thread = {.threads = 1};
        struct gn_picture *a = rendered(f, devices[i], &(struct gn_render_params){.seed = 9});
        struct gn_picture *b = rendered(f, devices[i], &(struct gn_render_params){.seed = 9, .tile_pixels = 100, .host = &one_thread});
        struct gn_picture *c = rendered(f, devices[i], &(struct gn_render_params){.seed = 10});
        size_t size = 3 * WIDTH * HEIGHT * sizeof(float);
        assert_memory_equal(gn_picture_pixels(a, 0), gn_picture_pixels(b, 0), size);
        assert_true(memcmp(gn_picture_pixels(a, 0), gn_picture_pixels(c, 0), size) != 0);
        gn_picture_destroy(a);
        gn_picture_destroy(b);
        gn_picture_destroy(c);
    }
}

static void render_faults_are_values(void **state) {
    struct fixture *f = *state;
    static const struct {
        struct gn_render_params params;
        const char *says;
    } rows[] = {{{.width = 65536}, "65535"},
                {{.height = 4000000000u}, "65535"},
                {{.spp = 1u << 25}, "samples"},
                {{.aovs = 8}, "layers"},
                {{.disable = "frobnication"}, "frobnication"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_null(gn_render(NULL, f->scene, &rows[i].params, &f->error));
        assert_int_equal(f->error.status, GN_USAGE);
        if (!strstr(f->error.message, rows[i].says)) fail_msg("%s", f->error.message);
    }
    if (!f->device) return;
    static const enum gn_accuracy missing[] = {GN_ACCURACY_COUNT, (enum gn_accuracy)77};
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++) {
        assert_null(gn_render(f->device, f->scene, &(struct gn_render_params){.accuracy = missing[i]}, &f->error));
        assert_int_equal(f->error.status, GN_USAGE);
        assert_non_null(strstr(f->error.message, "accuracy"));
    }
}

static bool stop(void *user, const struct gn_progress *progress) {
    assert_non_null(progress->stage);
    ++*(int *)user;
    return false;
}

static void the_callback_cancels(void **state) {
    struct fixture *f = *state;
    int asked = 0;
    const struct gn_host host = {.user = &asked, .progress = stop};
    const struct gn_render_params params = {.spp = 1u << 20, .host = &host};
    assert_null(gn_render(NULL, f->scene, &params, &f->error));
    assert_int_equal(f->error.status, GN_CANCELLED);
    assert_true(asked > 0);
    if (!f->device) return;
    assert_null(gn_render(f->device, f->scene, &params, &f->error));
    assert_int_equal(f->error.status, GN_CANCELLED);
    gn_picture_destroy(rendered(f, f->device, NULL)); // the device is as good as before
}

// ------------------------------------------------------------------------------------------------------------------ files

static bool there(const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", FOLDER, name);
    return access(path, F_OK) == 0;
}

static void pictures_are_saved(void **state) {
    struct fixture *f = *state;
    static const char *const files[] = {"p.png",       "p.depth.png",  "p.normal.png", "p.id.png", "p.pfm",
                                        "p.depth.pfm", "p.normal.pfm", "p.id.pfm",     "p.exr"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", FOLDER, files[i]);
        remove(path);
    }
    struct gn_picture *picture = rendered(f, NULL, &(struct gn_render_params){.aovs = GN_AOV_DEPTH | GN_AOV_NORMAL | GN_AOV_ID});
    assert_true(gn_picture_save(picture, FOLDER "/p.png", &f->error));
    assert_true(gn_picture_save(picture, FOLDER "/p.pfm", &f->error));
    assert_true(gn_picture_save(picture, FOLDER "/p.exr", &f->error));
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        if (!there(files[i])) fail_msg("%s is missing", files[i]);
    assert_true(gn_picture_stats(picture)->time_ms.output > 0);
    assert_false(gn_picture_save(picture, FOLDER "/p.jpeg", &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
    assert_non_null(strstr(f->error.message, ".exr"));
    assert_false(gn_picture_save(picture, FOLDER "/missing/p.png", &f->error));
    assert_int_equal(f->error.status, GN_IO);

    struct gn_compare_result result;
    struct gn_picture *heat;
    assert_true(gn_compare(FOLDER "/p.pfm", FOLDER "/p.exr", &result, &heat, &f->error));
    assert_true(result.max_abs == 0 && isinf(result.psnr_db) && result.pixels_differing == 0 && gn_picture_width(heat) == WIDTH);
    gn_picture_destroy(heat);
    assert_true(gn_compare(FOLDER "/p.pfm", FOLDER "/p.png", &result, NULL, &f->error));
    assert_true(result.max_abs > 0 && result.max_abs <= 0.005); // half a code of sRGB near 1 is 0.0045
    gn_picture_destroy(picture);
}

// ------------------------------------------------------------------------------------------------------- rays, measuring

static void check_rays(struct fixture *f, struct gn_device *device) {
    static const struct gn_ray rays[] = {
        {{0, 0, 0}, 0, {0, 0, -1}, INFINITY}, {{0, 0, 0}, 0, {0, 0, -2}, 100}, {{0, 0, 0}, 0, {0, 1, 0}, 100},
        {{0, 0, 0}, 0, {0, 0, -1}, 2},        {{0, 0, -1}, 0, {0, -1, 0}, 9},  {{NAN, 0, 0}, 0, {0, 0, -1}, 9},
    };
    static const struct {
        float t;
        int32_t object;
        uint32_t invalid;
    } right[] = {{2, 0, 0}, {1, 0, 0}, {INFINITY, -1, 0}, {INFINITY, -1, 0}, {1, 1, 0}, {INFINITY, -1, 1}};
    enum { COUNT = sizeof rays / sizeof *rays };
    struct gn_hit hits[COUNT];
    struct gn_trace_stats stats;
    if (!gn_trace(device, f->scene, &(struct gn_trace_params){.repeat = 3}, rays, hits, COUNT, &stats, &f->error))
        fail_msg("%s", f->error.message);
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(hits[i].object, right[i].object);
        if (!(hits[i].t == right[i].t)) fail_msg("ray %d: t is %g", i, (double)hits[i].t);
        assert_int_equal(hits[i].flags & GN_HIT_INVALID, right[i].invalid);
    }
    assert_true(stats.rays == COUNT && stats.hits == 3);
    assert_true(gn_trace(device, f->scene, &(struct gn_trace_params){.any = true}, rays, hits, COUNT, NULL, &f->error));
    for (int i = 0; i < COUNT; i++) assert_int_equal(hits[i].object, right[i].object < 0 ? -1 : 0);
    assert_true(gn_trace(device, f->scene, NULL, rays, hits, 0, &stats, &f->error));
    assert_int_equal(stats.hits, 0);
}

static void reference_rays(void **state) { check_rays(*state, NULL); }

static void device_rays(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    check_rays(f, f->device);
    assert_false(gn_trace(f->device, f->scene, &(struct gn_trace_params){.accuracy = GN_ACCURACY_COUNT}, NULL, NULL, 0, NULL, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
}

static void device_is_verified(void **state) {
    struct fixture *f = *state;
    struct gn_verify_result result;
    struct gn_picture *difference;
    assert_false(gn_verify(NULL, f->scene, NULL, &result, NULL, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
    if (!f->device) skip();
    if (!gn_verify(f->device, f->scene, NULL, &result, &difference, &f->error)) fail_msg("%s", f->error.message);
    assert_true(result.pass && result.pixels == WIDTH * HEIGHT && result.max_abs < 1e-4);
    assert_true(gn_picture_width(difference) == WIDTH);
    gn_picture_destroy(difference);
    const struct gn_verify_params strict = {.tolerance = 1e-12}; // which fp32 cannot keep
    assert_true(gn_verify(f->device, f->scene, &strict, &result, NULL, &f->error));
    assert_true(!result.pass && result.pixels_differing > result.pixels_allowed);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(version_is_the_header_s),
        cmocka_unit_test(nothing_can_be_destroyed),
        cmocka_unit_test(scene_is_described),
        cmocka_unit_test(scene_faults_are_values),
        cmocka_unit_test(devices_are_listed),
        cmocka_unit_test(plan_says_why),
        cmocka_unit_test(reference_picture),
        cmocka_unit_test(device_picture),
        cmocka_unit_test(parameters_override_the_scene),
        cmocka_unit_test(tall_pictures_come_in_bands),
        cmocka_unit_test(same_seed_same_bits),
        cmocka_unit_test(render_faults_are_values),
        cmocka_unit_test(the_callback_cancels),
        cmocka_unit_test(pictures_are_saved),
        cmocka_unit_test(reference_rays),
        cmocka_unit_test(device_rays),
        cmocka_unit_test(device_is_verified),
    };
    return cmocka_run_group_tests_name("api", tests, open_all, close_all);
}
