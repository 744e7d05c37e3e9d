// A device that does as if it had no doubles: exact still agrees with the reference in every bit, fp64 says what is missing.
#include "fixture.h"
#include "program.h"

#include <math.h>

#include "gnomon.h"

enum { SIDE = 24, VERTICES = SIDE * SIDE, RAYS = 6000 };

static uint64_t random_state = 7;

static double random_in(double low, double high) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

// A closed bumpy sphere: rings of vertices, the first and the last of which are poles.
static float vertices[VERTICES][3];

static void make_vertices(void) {
    const double pi = 3.14159265358979323846;
    for (int i = 0; i < SIDE; ++i) {
        for (int k = 0; k < SIDE; ++k) {
            const double theta = pi * i / (SIDE - 1), phi = 2 * pi * k / SIDE, radius = 1 + random_in(0, 1);
            const bool pole = i == 0 || i == SIDE - 1;
            float *v = vertices[i * SIDE + k];
            v[0] = (float)(pole ? 0 : radius * sin(theta) * cos(phi));
            v[1] = (float)(pole ? 0 : radius * sin(theta) * sin(phi));
            v[2] = (float)(pole ? cos(theta) : radius * cos(theta));
        }
    }
}

static void write_mesh(const char *path) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    for (int i = 0; i < VERTICES; ++i) fprintf(file, "v %.9g %.9g %.9g\n", vertices[i][0], vertices[i][1], vertices[i][2]);
    for (int i = 0; i + 1 < SIDE; ++i) {
        for (int k = 0; k < SIDE; ++k) {
            const int a = i * SIDE + k + 1, b = i * SIDE + (k + 1) % SIDE + 1;
            fprintf(file, "f %d %d %d\nf %d %d %d\n", a, b, b + SIDE, a, b + SIDE, a + SIDE);
        }
    }
    assert_int_equal(fclose(file), 0);
}

// Rays from inside, at vertices and at points of edges.
static void aim(struct gn_ray *rays) {
    for (int i = 0; i < RAYS; ++i) {
        const int number = (int)random_in(0, VERTICES - 1), ring = number / SIDE;
        const float *v = vertices[number], *w = vertices[ring * SIDE + (number + 1) % SIDE];
        const double share = i % 2 ? random_in(0, 1) : 0;
        rays[i].tmin = 0;
        rays[i].tmax = INFINITY;
        for (int c = 0; c < 3; ++c) {
            rays[i].origin[c] = (float)random_in(-0.3, 0.3);
            rays[i].direction[c] = (float)(v[c] + share * (w[c] - v[c])) - rays[i].origin[c];
        }
    }
}

struct hidden {
    struct gn_device *device;
    struct gn_scene *scene;
};

static int open_hidden(void **state) {
    static struct hidden hidden;
    struct gn_error error;
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true, .hide_fp64 = true};
    mkdir(TEST_OUTPUT_DIR, 0777);
    make_vertices();
    write_mesh(TEST_OUTPUT_DIR "/bumpy.obj");
    hidden.scene = gn_scene_load(TEST_OUTPUT_DIR "/bumpy.obj", NULL, &error);
    assert_non_null(hidden.scene);
    hidden.device = gn_device_create(&params, &error);
    *state = &hidden;
    return 0;
}

static int close_hidden(void **state) {
    struct hidden *hidden = *state;
    gn_device_destroy(hidden->device);
    gn_scene_destroy(hidden->scene);
    return fixture_close(state);
}

// Skipped where there is no device at all.
static struct hidden *hidden_of(void **state) {
    struct hidden *hidden = *state;
    if (!hidden->device) skip();
    return hidden;
}

static void exact_needs_no_doubles(void **state) {
    struct hidden *hidden = hidden_of(state);
    static struct gn_ray rays[RAYS];
    static struct gn_hit ours[RAYS], right[RAYS];
    struct gn_error error;
    struct gn_trace_stats stats;
    const struct gn_trace_params params = {.accuracy = GN_EXACT};
    assert_false(gn_device_info(hidden->device)->has_fp64);
    aim(rays);
    if (!gn_trace(hidden->device, hidden->scene, &params, rays, ours, RAYS, &stats, &error)) fail_msg("%s", error.message);
    // Every vertex is a question that fp32 leaves open.
    assert_true(stats.undecided_rays > RAYS / 4);
    assert_true(gn_trace(NULL, hidden->scene, &params, rays, right, RAYS, &stats, &error));
    assert_int_equal(stats.hits, RAYS);
    for (int i = 0; i < RAYS; ++i) {
        ours[i].flags = right[i].flags = 0;
        if (memcmp(&ours[i], &right[i], sizeof *ours))
            fail_msg("ray %d: %d/%d at %.9g, not %d/%d at %.9g", i, ours[i].object, ours[i].primitive, ours[i].t, right[i].object,
                     right[i].primitive, right[i].t);
    }
}

static void exact_pictures_need_none(void **state) {
    struct hidden *hidden = hidden_of(state);
    struct gn_error error;
    struct gn_verify_result result;
    const struct gn_verify_params params = {.render = {.accuracy = GN_EXACT, .width = 96, .height = 64}};
    if (!gn_verify(hidden->device, hidden->scene, &params, &result, NULL, &error)) fail_msg("%s", error.message);
    assert_true(result.pass && result.wrong_hits == 0);
}

static void fp64_says_so(void **state) {
    struct hidden *hidden = hidden_of(state);
    struct gn_error error;
    const struct gn_trace_params params = {.accuracy = GN_FP64};
    const struct gn_ray ray = {.direction = {0, 0, 1}, .tmax = 1};
    struct gn_hit hit;
    struct gn_trace_stats stats;
    assert_false(gn_trace(hidden->device, hidden->scene, &params, &ray, &hit, 1, &stats, &error));
    assert_int_equal(error.status, GN_NO_DEVICE);
    assert_non_null(strstr(error.message, "accuracy 'fp64' needs a device with doubles"));
}

static void the_program_hides_them(void **state) {
    hidden_of(state);
    remove(PROGRAM_FOLDER "/a.png");
    struct program_result result =
        program_expect("render ../bumpy.obj -o a.png --size 16x16 --hide-fp64 --accuracy fp64", 4, "needs a device with doubles");
    program_free(&result);
    assert_false(program_has("a.png"));
    result = program_expect("render ../bumpy.obj -o a.png --size 16x16 --hide-fp64 --accuracy exact", 0, "");
    program_free(&result);
    assert_true(program_has("a.png"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_needs_no_doubles),
        cmocka_unit_test(exact_pictures_need_none),
        cmocka_unit_test(fp64_says_so),
        cmocka_unit_test(the_program_hides_them),
    };
    return cmocka_run_group_tests(tests, open_hidden, close_hidden);
}
