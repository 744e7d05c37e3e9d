// The effects of the camera in whole pictures: each device picture against the reference's, which shoots the same rays to the bit, and what changes nothing where a
// scene does not call for it.
#include "fixture.h"

#include <math.h>

#include "api/handles.h"

#define WIDTH 96
#define HEIGHT 64

static struct gn_error error;
static struct gn_device *device;

static int open_device(void **state) {
    (void)state;
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    device = gn_device_create(&params, &error);
    if (!device) print_message("no device: %s\n", error.message);
    return 0;
}

static int close_device(void **state) {
    (void)state;
    gn_device_destroy(device);
    return 0;
}

static struct gn_scene *loaded(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s", TEST_SOURCE_DIR, name);
    struct gn_scene *scene = gn_scene_load(path, NULL, &error);
    if (!scene) fail_msg("%s", error.message);
    return scene;
}

static struct gn_picture *rendered(struct gn_scene *scene, const struct gn_render_params *params) {
    struct gn_picture *picture = gn_render(device, scene, params, &error);
    if (!picture) fail_msg("%s", error.message);
    return picture;
}

static uint32_t pixels_different(const struct gn_picture *a, const struct gn_picture *b) {
    uint32_t count = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        count += memcmp(gn_picture_pixels(a, 0) + 3 * i, gn_picture_pixels(b, 0) + 3 * i, 3 * sizeof(float)) != 0;
    return count;
}

// -------------------------------------------------------------------------------------------------------------- what changes

static void wide_gaussian(struct scene *scene) {
    scene->film.filter = FILTER_GAUSSIAN;
    scene->film.filter_radius = 2;
}

static double distance_of(const struct scene_camera *camera) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += ((double)camera->look_at[i] - camera->position[i]) * ((double)camera->look_at[i] - camera->position[i]);
    return sqrt(square);
}

static void lens(struct scene *scene) {
    struct scene_camera *camera = &scene->camera;
    camera->focus_distance = (float)(0.8 * distance_of(camera));
    camera->lens_radius = (float)(0.05 * distance_of(camera));
}

// The camera moves aside and turns.
static void motion(struct scene *scene) {
    struct scene_camera *camera = &scene->camera;
    const float step = (float)(0.1 * distance_of(camera));
    camera->moves = true;
    for (int i = 0; i < 3; i++) {
        camera->position_end[i] = camera->position[i] + (i == 0 ? step : 0);
        camera->look_at_end[i] = camera->look_at[i] + (i == 1 ? step : 0);
    }
}

static void everything(struct scene *scene) {
    wide_gaussian(scene);
    lens(scene);
    motion(scene);
}

static const struct {
    const char *name, *effect;
    void (*apply)(struct scene *scene);
} CHANGES[] = {
    {"a wide gaussian", "filter", wide_gaussian},
    {"a lens", "depth_of_field", lens},
    {"a moving camera", "motion_blur", motion},
    {"all of them", "filter,depth_of_field,motion_blur", everything},
};
#define CHANGE_COUNT (sizeof CHANGES / sizeof *CHANGES)

// Where it is looked at: the first scene is small and near, the second one far from the origin.
static const char *const SCENES[] = {"seed_elaborate.json", "far_from_origin.json"};
static const struct {
    int scene;
    enum gn_accuracy accuracy;
    size_t first; // of the changes that are looked at there
} PLACES[] = {{0, GN_ROBUST, 0}, {0, GN_EXACT, CHANGE_COUNT - 1}, {1, GN_ROBUST, CHANGE_COUNT - 1}};
#define PLACE_COUNT (sizeof PLACES / sizeof *PLACES)

static void check_change(struct gn_scene *scene, const char *file, size_t change, const struct gn_picture *plain, enum gn_accuracy accuracy) {
    const struct gn_verify_params params = {
        .render = {.width = WIDTH, .height = HEIGHT, .spp = 4, .seed = 3, .accuracy = accuracy}};
    struct gn_verify_result result;
    if (!gn_verify(device, scene, &params, &result, NULL, &error)) fail_msg("%s", error.message);
    const char *name = CHANGES[change].name;
    if (!strstr(result.device.effects, CHANGES[change].effect)) fail_msg("%s with %s: effects are %s", file, name, result.device.effects);
    if (!result.pass)
        fail_msg("%s with %s, %s: %d pixels differ, %d wrong hits, off by %g", file, name, result.device.accuracy, (int)result.pixels_differing,
                 (int)result.wrong_hits, result.max_abs);
    struct gn_picture *changed = rendered(scene, &params.render);
    if (pixels_different(changed, plain) < WIDTH * HEIGHT / 100) fail_msg("%s with %s: the picture is the plain one", file, name);
    gn_picture_destroy(changed);
}

static void pictures_are_the_references(void **state) {
    (void)state;
    if (!device) skip();
    for (size_t p = 0; p < PLACE_COUNT; p++) {
        const char *file = SCENES[PLACES[p].scene];
        const struct gn_render_params params = {.width = WIDTH, .height = HEIGHT, .spp = 4, .seed = 3, .accuracy = PLACES[p].accuracy};
        struct gn_scene *scene = loaded(file);
        struct gn_picture *plain = rendered(scene, &params);
        const struct scene_film film = scene->scene.film;
        const struct scene_camera camera = scene->scene.camera;
        for (size_t i = PLACES[p].first; i < CHANGE_COUNT; i++) {
            CHANGES[i].apply(&scene->scene);
            check_change(scene, file, i, plain, PLACES[p].accuracy);
            scene->scene.film = film;
            scene->scene.camera = camera;
        }
        gn_picture_destroy(plain);
        gn_scene_destroy(scene);
    }
}

// With every effect on, a scene that calls for none of the camera's has the same picture, bit by bit.
static void pruning_changes_nothing(void **state) {
    (void)state;
    if (!device) skip();
    for (size_t s = 0; s < sizeof SCENES / sizeof *SCENES; s++)
        for (uint32_t spp = 1; spp <= 4; spp += 3) {
            struct gn_scene *scene = loaded(SCENES[s]);
            struct gn_render_params params = {.width = WIDTH, .height = HEIGHT, .spp = spp};
            struct gn_picture *pruned = rendered(scene, &params);
            params.no_prune = true;
            struct gn_picture *whole = rendered(scene, &params);
            uint32_t different = pixels_different(pruned, whole);
            if (different) fail_msg("%s, %u samples: %u pixels differ from the picture with every effect", SCENES[s], spp, different);
            gn_picture_destroy(whole);
            gn_picture_destroy(pruned);
            gn_scene_destroy(scene);
        }
}

// One sample goes through the pixel's center, whatever the filter.
static void one_sample_has_no_filter(void **state) {
    (void)state;
    if (!device) skip();
    struct gn_scene *scene = loaded(SCENES[0]);
    struct gn_render_params params = {.width = WIDTH, .height = HEIGHT, .spp = 1};
    struct gn_picture *plain = rendered(scene, &params);
    wide_gaussian(&scene->scene);
    params.no_prune = true;
    struct gn_picture *filtered = rendered(scene, &params);
    params.spp = 2;
    struct gn_picture *blurred = rendered(scene, &params);
    assert_int_equal(pixels_different(plain, filtered), 0);
    assert_true(pixels_different(plain, blurred) > 0);
    gn_picture_destroy(blurred);
    gn_picture_destroy(filtered);
    gn_picture_destroy(plain);
    gn_scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_references),
        cmocka_unit_test(pruning_changes_nothing),
        cmocka_unit_test(one_sample_has_no_filter),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
