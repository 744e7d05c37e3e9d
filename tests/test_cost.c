// What accuracy costs: the Pareto front on points made by hand, lattices, and one measurement of a small scene with its report.
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

#include "api/handles.h"
#include "base/file.h"
#include "measure/cost/html.h"
#include "measure/cost/pareto.h"
#include "reference/reference.h"
#include "render/render.h"

#include "program.h"

#define SCENE TEST_OUTPUT_DIR "/still_life.json"
#define REPORT TEST_OUTPUT_DIR "/report.html"
#define WIDTH 64
#define HEIGHT 48

// A light without shadow edges on the floor would hide what offsets do; the square's diagonal is an edge through pixels' centres. The
// material's name must be escaped nowhere, the file's name in the report's title.
static const char scene_text[] =
    "{\"version\": 1,\n"
    " \"camera\": {\"position\": [0,0.5,0], \"look_at\": [0,0,-3], \"up\": [0,1,0], \"fov_y_deg\": 60},\n"
    " \"film\": {\"width\": 64, \"height\": 48, \"spp\": 1, \"transfer\": \"srgb\"},\n"
    " \"background\": [0.25,0.5,1], \"ambient\": [0.2,0.2,0.2],\n"
    " \"materials\": {\"red\": {\"ambient\": [1,0,0], \"diffuse\": [0.8,0.4,0.2], \"specular\": [0.1,0.1,0.1], \"shininess\": 32}},\n"
    " \"lights\": [{\"type\": \"point\", \"position\": [-10,10,4], \"intensity\": [0.8,0.8,0.8]}],\n"
    " \"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1, \"material\": \"red\"},\n"
    "  {\"type\": \"triangle\", \"vertices\": [[-4,-1,-6],[4,-1,-6],[0,-1,1]], \"material\": \"red\"},\n"
    "  {\"type\": \"triangle\", \"vertices\": [[-4,-1,-6],[4,-1,-6],[0,3,-7]], \"material\": \"red\"}]}\n";

struct fixture {
    struct gn_scene *scene;
    struct gn_device *device; // NULL where there is none
    struct gn_cost *cost;     // likewise
    struct gn_error error;
};

static int open_all(void **state) {
    static struct fixture f;
    *state = &f;
    mkdir(TEST_OUTPUT_DIR, 0777);
    FILE *file = fopen(SCENE, "wb");
    if (!file || fputs(scene_text, file) < 0 || fclose(file) != 0) return -1;
    if (!(f.scene = gn_scene_load(SCENE, NULL, &f.error))) return print_error("%s\n", f.error.message), -1;
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    f.device = gn_device_create(&params, &f.error);
    if (!f.device) return print_message("no device: %s\n", f.error.message), 0;
    f.cost = gn_cost_measure(f.device, f.scene, &(struct gn_cost_params){.rounds = 1, .seconds = 2}, &f.error);
    if (!f.cost) print_error("%s\n", f.error.message);
    return f.cost ? 0 : -1;
}

static int close_all(void **state) {
    struct fixture *f = *state;
    gn_cost_destroy(f->cost);
    gn_device_destroy(f->device);
    gn_scene_destroy(f->scene);
    return 0;
}

// --------------------------------------------------------------------------------------------------------------- Pareto

static void the_front_is_what_nothing_beats(void **state) {
    (void)state;
    static const struct {
        double same;
        size_t count;
        struct pareto_point points[5]; // `front`: what is right
    } rows[] = {
        {1, 1, {{1, 1, true}}},
        {1, 3, {{1, 3, true}, {2, 2, true}, {3, 1, true}}},
        {1, 3, {{1, 1, true}, {2, 2, false}, {3, 1, false}}},
        {1, 2, {{1, 1, true}, {1, 1, true}}},
        {1, 3, {{2, 1, true}, {1, 2, true}, {2, 2, false}}},
        {1, 3, {{1, 0, true}, {2, 0, false}, {0.5, 1, true}}},
        {1, 3, {{1, NAN, false}, {NAN, 1, false}, {5, INFINITY, false}}},
        {1, 2, {{1.04, 1, true}, {1, 1.04, true}}},
        {1.05, 2, {{1.04, 1, true}, {1, 1, true}}}, // the same, within the noise
        {1, 2, {{1.04, 1, false}, {1, 1, true}}},   // the control
        {1.05, 2, {{1.06, 1, false}, {1, 1, true}}},
        {1.05, 3, {{1, 1, false}, {1.04, 0.5, true}, {1.5, 0.5, false}}},
    };
    for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
        struct pareto_point points[5];
        memcpy(points, rows[row].points, sizeof points);
        pareto_mark(points, rows[row].count, rows[row].same);
        for (size_t i = 0; i < rows[row].count; i++)
            if (points[i].front != rows[row].points[i].front) fail_msg("row %zu, point %zu: %d", row, i, points[i].front);
    }
}

// -------------------------------------------------------------------------------------------------------------- lattices

// A lattice has the pixels of the whole picture, to the bit: on the device in every tier, and in the reference.
static void a_lattice_is_every_third_pixel(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    const struct lattice lattice = {.stride = 3, .x = 2, .y = 1};
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct plan plan; // the measurement's, so that its kernels serve again
    assert_true(plan_make(&plan, &ctx, &f->scene->scene, &(struct plan_params){.spp = 2}));
    for (uint32_t tier = 0; tier <= TIER_COUNT; tier++) { // the last is the reference
        struct image whole = {0}, part = {0};
        for (int pass = 0; pass < 2; pass++) {
            const struct render_params device = {.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .spp = 2,
                                                 .seed = 5,
                                                 .tier = tier,
                                                 .effects = plan.effects,
                                                 .lattice = pass ? lattice : (struct lattice){0}};
            const struct reference_params cpu = {
                .width = WIDTH, .height = HEIGHT, .spp = 2, .seed = 5, .effects = plan.effects, .lattice = device.lattice};
            struct render_film film = {0};
            struct reference_film right = {0};
            if (tier == TIER_FP64 && !f->device->device.has_fp64) continue;
            if (tier < TIER_COUNT)
                assert_true(render_picture(&film, &ctx, &f->device->device, &f->scene->scene, &f->scene->bvh, &device));
            else
                assert_true(reference_render(&right, &ctx, &f->scene->scene, &f->scene->bvh, &cpu));
            *(pass ? &part : &whole) = tier < TIER_COUNT ? film.color : right.color;
        }
        assert_int_equal(part.width, whole.width ? (WIDTH - 2 + 2) / 3 : 0);
        assert_int_equal(part.height, whole.width ? (HEIGHT - 1 + 2) / 3 : 0);
        for (uint32_t y = 0; y < part.height; y++)
            for (uint32_t x = 0; x < part.width; x++)
                assert_memory_equal(part.pixels + 3 * (y * part.width + x), whole.pixels + 3 * ((3 * y + 1) * WIDTH + 3 * x + 2), 12);
        image_finish(&whole);
        image_finish(&part);
    }
}

// ------------------------------------------------------------------------------------------------------------------ rows

static const struct gn_cost_row *row_of(const struct fixture *f, const char *axis, const char *setting) {
    uint32_t count;
    const struct gn_cost_row *rows = gn_cost_rows(f->cost, &count);
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(rows[i].axis, axis) == 0 && strcmp(rows[i].setting, setting) == 0) return &rows[i];
    fail_msg("there is no row %s, %s", axis, setting);
    return NULL;
}

static void every_axis_is_there(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    static const char *const wanted[][2] = {
        {"tier", "fast"},
        {"tier", "robust"},
        {"tier", "exact"},
        {"offset", "share"},
        {"offset", "bound"},
        {"offset", "bound and self"},
        {"normalize", "inverse root"},
        {"normalize", "root and division"},
        {"power", "built-in"},
        {"power", "own"},
        {"output", "32-bit float"},
        {"output", "8-bit code"},
        {"sum", "kahan"},
        {"sum", "plain"},
        {"samples", "1 per pixel"},
        {"samples", "4 per pixel"},
        {"sampler", "sobol, 4 per pixel"},
        {"sampler", "independent, 4 per pixel"},
        {"together", "exact, 4 per pixel"},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) row_of(f, wanted[i][0], wanted[i][1]);
    uint32_t count, skipped_count, bases = 0;
    const struct gn_cost_row *rows = gn_cost_rows(f->cost, &count);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(rows[i].time_ms > 0 && rows[i].time_low_ms <= rows[i].time_ms && rows[i].time_ms <= rows[i].time_high_ms);
        assert_true(rows[i].picture_ms >= rows[i].time_ms && rows[i].nonfinite_pixels == 0 && rows[i].pixels > 0);
        assert_true(isfinite(rows[i].rmse) && isfinite(rows[i].flip) && isfinite(rows[i].wrong_per_million));
        bases += rows[i].base;
    }
    assert_int_equal(bases, 9); // one for each axis
    const struct gn_cost_skipped *skipped = gn_cost_skipped(f->cost, &skipped_count);
    assert_true(skipped_count > 0 && strstr(skipped[skipped_count - 1].because, "reflection"));
}

static void errors_are_where_they_belong(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    const struct gn_cost_row *exact = row_of(f, "tier", "exact"), *robust = row_of(f, "tier", "robust");
    assert_true(exact->wrong_per_million == 0 && exact->t_ulp_max <= 1);
    assert_true(robust->t_ulp_max > 0 && robust->rmse < 1e-3 && robust->rmse > 0);
    if (gn_device_info(f->device)->has_fp64) {
        assert_true(row_of(f, "tier", "fp64")->rmse <= 1e-6);
        assert_true(row_of(f, "sum", "kahan")->rmse < row_of(f, "sum", "plain")->rmse);
    }
    // 8 bits lose what rounding to them loses, 1/255 divided by the root of 12 and stretched by the transfer function; no arithmetic does.
    assert_true(row_of(f, "output", "8-bit code")->rmse > 1e-4 && row_of(f, "output", "8-bit code")->rmse < 1e-2);
    assert_true(row_of(f, "samples", "4 per pixel")->rmse < row_of(f, "samples", "1 per pixel")->rmse);
    assert_true(row_of(f, "samples", "1 per pixel")->rmse > 10 * robust->rmse);
    assert_true(row_of(f, "samples", "1 per pixel")->converged && !robust->converged);
    struct gn_cost_summary summary;
    gn_cost_summary(f->cost, &summary);
    assert_true(summary.width == WIDTH && summary.height == HEIGHT && summary.rounds == 1 && summary.rays > 1000);
    assert_true(summary.stride[0] >= 1 && summary.stride[1] >= summary.stride[0] && summary.reference_spp >= 16);
}

static bool never_on(void *user, const struct gn_progress *progress) {
    (void)user;
    (void)progress;
    return false;
}

static void faults_are_values(void **state) {
    struct fixture *f = *state;
    assert_null(gn_cost_measure(NULL, f->scene, NULL, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
    if (!f->device) return;
    assert_null(gn_cost_measure(f->device, f->scene, &(struct gn_cost_params){.rounds = 65}, &f->error));
    assert_int_equal(f->error.status, GN_USAGE);
    const struct gn_host host = {.progress = never_on};
    assert_null(gn_cost_measure(f->device, f->scene, &(struct gn_cost_params){.host = &host}, &f->error));
    assert_int_equal(f->error.status, GN_CANCELLED);
    assert_false(gn_cost_save(f->cost, TEST_OUTPUT_DIR "/no such folder/report.html", &f->error));
    assert_int_equal(f->error.status, GN_IO);
}

// ------------------------------------------------------------------------------------------------------------ the report

// Whether elements are closed in the order in which they were opened, and attributes quoted; of a page without comments and scripts.
static bool is_well_formed(const char *text) {
    char open[32][16];
    size_t depth = 0;
    if (strncmp(text, "<!DOCTYPE html>", 15) == 0) text += 15;
    for (const char *at = strchr(text, '<'); at; at = strchr(at, '<')) {
        bool closing = at[1] == '/';
        const char *name = at + 1 + closing, *end = name;
        size_t length = strcspn(name, " />\n");
        for (bool quoted = false; *end && (quoted || *end != '>'); end++) {
            if (*end == '"') quoted = !quoted;
            if (!quoted && *end == '=' && end[1] != '"') return false;
            if (*end == '<') return false;
        }
        if (!*end || length == 0 || length >= 16) return false;
        if (closing && (depth == 0 || strlen(open[depth - 1]) != length || strncmp(open[depth - 1], name, length) != 0)) return false;
        if (closing) {
            depth--;
        } else if (end[-1] != '/') {
            if (depth == 32) return false;
            snprintf(open[depth++], 16, "%.*s", (int)length, name);
        }
        at = end;
    }
    return depth == 0;
}

static size_t occurrences(const char *text, const char *what) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, what)); at++) count++;
    return count;
}

// Blanks the data of pictures, in which any four letters may stand.
static void blank_pictures(char *text) {
    for (char *at = text; (at = strstr(at, "base64,")); at++)
        for (char *data = at + 7; *data && *data != '"'; data++) *data = '.';
}

// Blanks the name of SVG's elements, which looks like an address, and says how often it stood there.
static size_t blank_namespaces(char *text) {
    static const char name[] = "xmlns=\"http://www.w3.org/2000/svg\"";
    size_t count = 0;
    for (char *at = text; (at = strstr(at, name)); count++) memset(at + 7, '.', sizeof name - 9);
    return count;
}

// Whether each chart, cut out of the page, is a file by itself: in order, and with its colours.
static void assert_charts_stand_alone(const char *page) {
    for (const char *at = page; (at = strstr(at, "<svg")); at++) {
        const char *end = strstr(at, "</svg>");
        assert_non_null(end);
        char *chart = strndup(at, (size_t)(end - at) + 6);
        assert_true(is_well_formed(chart));
        assert_non_null(strstr(chart, "--paper:"));
        free(chart);
    }
}

static void the_report_is_complete_in_itself(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    if (!gn_cost_save(f->cost, REPORT, &f->error)) fail_msg("%s", f->error.message);
    struct context ctx = context_make(NULL, &f->error);
    struct file_bytes page;
    assert_true(file_read(&page, &ctx, REPORT, GN_IO));
    assert_true(is_well_formed(page.data));
    uint32_t tiers = gn_device_info(f->device)->has_fp64 ? 4 : 3;
    assert_int_equal(occurrences(page.data, "src=\"data:image/png;base64,iVBORw0KGgo"), 2 * tiers + 2 + 5); // and scale, reference, changes
    blank_pictures(page.data);
    assert_charts_stand_alone(page.data);
    assert_int_equal(blank_namespaces(page.data), 2);
    assert_null(strstr(page.data, "http"));
    assert_null(strstr(page.data, "<script"));
    assert_null(strstr(page.data, "\"nan"));
    assert_null(strstr(page.data, "inf\""));
    assert_non_null(strstr(page.data, "still_life.json"));
    assert_non_null(strstr(page.data, "inversesqrt")); // of the probe
    assert_int_equal(occurrences(page.data, "<svg"), 2);
    file_bytes_finish(&page);
}

// The program says the same, in the contract's words.
static void the_program_tells_rows(void **state) {
    struct fixture *f = *state;
    if (!f->device) skip();
    const char *words = "cost ../still_life.json --rounds 1 --seconds 1 --json -o report.html";
    struct program_result result = program_expect(words, 0, "");
    json_t *object = program_json(words, &result), *rows = json_object_get(object, "rows"), *row;
    size_t i;
    assert_true(json_array_size(rows) > 20); // how far the samples go depends on the time
    json_array_foreach(rows, i, row) {
        static const char *const numbers[] = {"time_ms", "wrong_per_million", "t_ulp_max", "rmse", "flip"};
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) assert_true(json_is_number(json_object_get(row, numbers[k])));
        assert_true(json_is_string(json_object_get(row, "accuracy")));
    }
    assert_true(json_array_size(json_object_get(json_object_get(object, "probe"), "rows")) > 10);
    assert_true(program_has("report.html"));
    json_decref(object);
    program_free(&result);
}

static void what_is_not_well_formed_is_noticed(void **state) {
    (void)state;
    assert_true(is_well_formed("<!DOCTYPE html><a><b c=\"1\"/>x</a>"));
    assert_false(is_well_formed("<a><b></a></b>"));
    assert_false(is_well_formed("<a>"));
    assert_false(is_well_formed("<a b=1></a>"));
    assert_false(is_well_formed("</a>"));
    assert_false(is_well_formed("<a"));
}

static void numbers_are_for_people(void **state) {
    (void)state;
    static const struct {
        double value;
        const char *text;
    } rows[] = {
        {0, "0"},        {0.0612, "0.0612"},  {0.612, "0.612"},        {1, "1.00"},         {61.56, "61.6"}, {612, "612"},
        {1240, "1 240"}, {123456, "123 456"}, {4.474e-7, "4.47·10⁻⁷"}, {2e12, "2.00·10¹²"}, {INFINITY, "∞"}, {NAN, "not a number"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *text = NULL;
        size_t size;
        FILE *to = open_memstream(&text, &size);
        html_number(to, rows[i].value);
        fclose(to);
        assert_string_equal(text, rows[i].text);
        free(text);
    }
}

static void text_is_escaped(void **state) {
    (void)state;
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    html_text(to, "a<b>&\"é\"\x80\x01");
    html_text(to, " ");
    html_count(to, 2000017);
    fclose(to);
    assert_string_equal(text, "a&lt;b&gt;&amp;&quot;é&quot;?? 2 000 017");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_front_is_what_nothing_beats),
        cmocka_unit_test(a_lattice_is_every_third_pixel),
        cmocka_unit_test(every_axis_is_there),
        cmocka_unit_test(errors_are_where_they_belong),
        cmocka_unit_test(faults_are_values),
        cmocka_unit_test(the_report_is_complete_in_itself),
        cmocka_unit_test(the_program_tells_rows),
        cmocka_unit_test(what_is_not_well_formed_is_noticed),
        cmocka_unit_test(numbers_are_for_people),
        cmocka_unit_test(text_is_escaped),
    };
    return cmocka_run_group_tests_name("cost", tests, open_all, close_all);
}
