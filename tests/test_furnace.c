// Furnaces: whole renders with a known answer. A ball fills the picture, all around it is a radiance of 1; a ball that takes nothing away
// cannot be seen.
#include "scratch.h"

#include <math.h>

#include "gnomon.h"

#define SIDE 12

static const char FURNACE[] = "{\"version\": 1, \"background\": [1, 1, 1],"
                              " \"paths\": {\"indirect\": true, \"max_depth\": %d, \"roulette_depth\": 64},"
                              " \"film\": {\"width\": 12, \"height\": 12, \"spp\": 64},"
                              " \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], \"fov_y_deg\": 10},"
                              " \"materials\": {\"m\": {\"diffuse\": [%g, %g, %g], %s}},"
                              " \"shapes\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"m\"}]}";

// `right`: of every pixel. Where `found` is false it is wrong, and every row's check must see that: the controls.
static const struct furnace {
    const char *name, *material;
    double albedo;
    int max_depth;
    double right;
    bool found;
} ROWS[] = {
    {"lambert", "\"model\": \"lambert\"", 1, 64, 1, true},
    {"lambert_grey", "\"model\": \"lambert\"", 0.5, 64, 0.5, true},
    {"lambert_taken", "\"model\": \"lambert\"", 0.999, 64, 1, false},
    {"mirror", "\"model\": \"mirror\"", 1, 64, 1, true},
    {"mirror_taken", "\"model\": \"mirror\"", 0.999, 64, 1, false},
    {"glass", "\"model\": \"dielectric\", \"ior\": 1.5", 1, 64, 1, true},
    {"glass_cut_short", "\"model\": \"dielectric\", \"ior\": 1.5", 1, 1, 1, false},
};

static struct gn_scene *load(const struct furnace *row) {
    struct gn_error error;
    char path[512];
    snprintf(path, sizeof path, "%s/furnace_%s.json", TEST_OUTPUT_DIR, row->name);
    mkdir(TEST_OUTPUT_DIR, 0777);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, FURNACE, row->max_depth, row->albedo, row->albedo, row->albedo, row->material);
    assert_int_equal(fclose(file), 0);
    struct gn_scene *scene = gn_scene_load(path, NULL, &error);
    if (!scene) fail_msg("%s", error.message);
    return scene;
}

// The largest distance of a pixel from what is right. Every sample of these is the answer, so that there is no noise.
static double largest_error(struct gn_device *device, struct gn_scene *scene, double right) {
    struct gn_error error;
    struct gn_picture *picture = gn_render(device, scene, &(struct gn_render_params){0}, &error);
    if (!picture) fail_msg("%s", error.message);
    const float *pixels = gn_picture_pixels(picture, 0);
    double largest = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) largest = pixels[i] >= 0 ? fmax(largest, fabs(pixels[i] - right)) : INFINITY;
    gn_picture_destroy(picture);
    return largest;
}

static void a_furnace_stays_as_it_is(struct gn_device *device) {
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        struct gn_scene *scene = load(&ROWS[i]);
        double off = largest_error(device, scene, ROWS[i].right);
        if ((off <= 1e-5) != ROWS[i].found) fail_msg("%s: off by %g", ROWS[i].name, off);
        gn_scene_destroy(scene);
    }
}

static void on_the_device(void **state) {
    (void)state;
    struct gn_error error;
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    struct gn_device *device = gn_device_create(&params, &error);
    if (!device) fail_msg("%s", error.message);
    a_furnace_stays_as_it_is(device);
    gn_device_destroy(device);
}

static void in_the_reference(void **state) {
    (void)state;
    a_furnace_stays_as_it_is(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(on_the_device), cmocka_unit_test(in_the_reference)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
