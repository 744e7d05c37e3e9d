// The program from outside: arguments, exit codes, messages, JSON, signals, standard output that cannot be written.
#include <math.h>

#include "program.h"

#include "base/npy.h"
#include "shaders/shared.h"

static const char scene_text[] =
    "{\"version\": 1,\n"
    " \"camera\": {\"position\": [0,0,0], \"look_at\": [0,0,-1], \"up\": [0,1,0], \"fov_y_deg\": 90},\n"
    " \"film\": {\"width\": 64, \"height\": 48, \"spp\": 1, \"transfer\": \"linear\"},\n"
    " \"ambient\": [0.2,0.2,0.2],\n"
    " \"materials\": {\"red\": {\"ambient\": [1,0,0], \"diffuse\": [1,0,0], \"specular\": [1,1,1], \"shininess\": 32}},\n"
    " \"lights\": [{\"type\": \"point\", \"position\": [-10,10,4], \"intensity\": [0.8,0.8,0.8]}],\n"
    " \"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1, \"material\": \"red\"}]}\n";

static int write_inputs(void **state) {
    (void)state;
    static const float rays[] = {0, 0, 0, 0, 0, 0, -1, 100, 0, 0, 0, 0, 0, 1, 0, 100, 0, 0, 0, 0, 0, 0, 0, 100};
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    if (system("rm -rf '" PROGRAM_FOLDER "'") != 0) return -1;
    program_write("scene.json", scene_text);
    program_write("bad.json", "{\"version\": 1,\n \"lights\": [{]}\n");
    program_write("text.npy", "these are no rays\n");
    return npy_write_f32(rays, 3, 8, &ctx, PROGRAM_FOLDER "/rays.npy") ? 0 : -1;
}

// Whether the program can use a device here; the tests that need one are skipped where it cannot.
static void need_device(void) {
    struct program_result result = program_run(&(struct program_call){.words = "devices"});
    int code = result.code;
    program_free(&result);
    if (code == GN_NO_DEVICE) skip();
    assert_int_equal(code, 0);
}

// ------------------------------------------------------------------------------------------------------------------ faults

static const struct {
    const char *words;
    int code;
    const char *says;
} faults[] = {
    {"", 2, "a command is missing"},
    {"rende", 2, "did you mean render?"},
    {"frobnicate", 2, "no command 'frobnicate'"},
    {"scene.json", 2, "gnomon render scene.json"},
    {"--size 1x1", 2, "a command comes first"},
    {"help frobnicate", 2, "no command"},
    {"cost", 2, "an argument is missing; expected: SCENE"},
    {"cost scene.json -o report.pdf", 2, "expected one of html|htm"},
    {"cost scene.json --rounds 0", 2, "expected a whole number from 1 to 64"},
    {"cost scene.json --spp 4", 2, "belongs to another command"},
    {"bench", 2, "not in this version yet"},
    {"render", 2, "an argument is missing; expected: SCENE"},
    {"render scene.json", 2, "-o FILE is missing"},
    {"render scene.json more -o a.png", 2, "unexpected argument 'more'"},
    {"devices more", 2, "takes none"},
    {"compare scene.json", 2, "expected: A B"},
    {"render scene.json -o a.png --sise 1x1", 2, "did you mean --size?"},
    {"render scene.json -o a.png --frobnicate", 2, "unknown option --frobnicate"},
    {"render scene.json -o a.png --repeat 3", 2, "belongs to another command"},
    {"render scene.json -o a.png -x", 2, "unknown option -x"},
    {"render scene.json -o", 2, "--output needs a value"},
    {"render scene.json -o --reference", 2, "--output needs a value"},
    {"render scene.json -o a.png --size", 2, "--size needs a value: --size WxH"},
    {"render scene.json -o a.png --size=", 2, "--size needs a value"},
    {"render scene.json -o a.png --size 0x0", 2, "each from 1 to 65535"},
    {"render scene.json -o a.png --size 12xfoo", 2, "expected WIDTHxHEIGHT"},
    {"render scene.json -o a.png --size 12", 2, "expected WIDTHxHEIGHT"},
    {"render scene.json -o a.png --size 12x12x12", 2, "expected WIDTHxHEIGHT"},
    {"render scene.json -o a.png --size 70000x1", 2, "each from 1 to 65535"},
    {"render scene.json -o a.png --size -1x5", 2, "expected WIDTHxHEIGHT"},
    {"render scene.json -o a.png --size 4294967297x1", 2, "each from 1 to 65535"},
    {"render scene.json -o a.png --size 99999999999999999999x1", 2, "each from 1 to 65535"},
    {"render scene.json -o a.png --size 1x1 --size 1x1", 2, "--size is given twice"},
    {"render scene.json -o a.png --spp 0", 2, "expected a whole number from 1"},
    {"render scene.json -o a.png --spp -1", 2, "expected a whole number from 1"},
    {"render scene.json -o a.png --spp 1e99", 2, "expected a whole number from 1"},
    {"render scene.json -o a.png --spp 1.5", 2, "expected a whole number from 1"},
    {"render scene.json -o a.png --spp +1", 2, "expected a whole number from 1"},
    {"render scene.json -o a.png --spp 0x10", 2, "expected a whole number from 1"},
    {"render scene.json -o a.png --seed 4294967296", 2, "expected a whole number from 0 to 4294967295"},
    {"render scene.json -o a.png --seed -1", 2, "expected a whole number from 0"},
    {"render scene.json -o a.png --threads 0", 2, "expected a whole number from 1 to 256"},
    {"render scene.json -o a.png --accuracy best", 2, "expected one of robust|fast|exact|fp64"},
    {"render scene.json -o a.png --aov depth,colour", 2, "expected a comma list of depth|normal|id"},
    {"render scene.json -o a.png --aov depth,", 2, "expected a comma list"},
    {"render scene.json -o a.png --progress fast", 2, "expected one of auto|bar|plain|none"},
    {"render scene.json -o a.png --reference=yes", 2, "--reference takes no value"},
    {"render scene.json -o a.png --disable frobnication --reference", 2, "frobnication"},
    {"render scene.json -o a.jpeg", 2, "expected one of png|exr|pfm"},
    {"render scene.json -o a", 2, "expected one of png|exr|pfm"},
    {"render scene.json -o missing/a.png", 8, "its folder does not exist"},
    {"render missing.json -o a.png", 8, "missing.json"},
    {"render bad.json -o a.png", 3, "bad.json:2:"},
    {"trace scene.json -o hits.npy", 2, "--rays IN.npy is missing"},
    {"trace scene.json --rays rays.npy", 2, "-o OUT.npy is missing"},
    {"trace scene.json --rays rays.npy -o hits.png", 2, "expected one of npy"},
    {"trace scene.json --rays missing.npy -o hits.npy --reference", 8, "missing.npy"},
    {"trace scene.json --rays text.npy -o hits.npy --reference", 8, "text.npy"},
    {"trace bad.json --rays rays.npy -o hits.npy --reference", 3, "bad.json:2:"},
    {"trace scene.json --rays rays.npy -o hits.npy --repeat 0", 2, "expected a whole number from 1"},
    {"verify scene.json --reference", 2, "belongs to another command"},
    {"verify scene.json --tolerance nan", 2, "expected a number"},
    {"verify scene.json --tolerance -1", 2, "expected a number"},
    {"verify scene.json -o a.npy", 2, "expected one of png|exr|pfm"},
    {"verify bad.json", 3, "bad.json:2:"},
    {"plan bad.json", 3, "bad.json:2:"},
    {"plan scene.json --disable frobnication", 2, "frobnication"},
    {"compare missing.png missing.png", 8, "missing.png"},
    {"compare scene.json scene.json", 8, "scene.json"},
    {"compare a b --max-flip 2", 2, "expected a number from 0 to 1"},
};

static void each_fault_has_its_message_and_code(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        struct program_result result = program_expect(faults[i].words, faults[i].code, faults[i].says);
        if (*faults[i].words && *result.out) fail_msg("gnomon %s: standard output is not empty", faults[i].words);
        if (faults[i].code == 2 && !strstr(result.err, "--help")) fail_msg("gnomon %s: no word of --help", faults[i].words);
        program_free(&result);
    }
    assert_false(program_has("a.png") || program_has("hits.npy"));
}

static void json_is_one_object_in_every_fault(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        char words[256];
        if (!*faults[i].words) continue; // an overview, and no command
        snprintf(words, sizeof words, "%s --json", faults[i].words);
        if (strstr(words, "-o --json") || strstr(words, "--size --json")) continue; // the same fault, with another value
        struct program_result result = program_run(&(struct program_call){.words = words});
        json_t *object = program_json(words, &result), *error = json_object_get(object, "error");
        assert_int_equal(result.code, faults[i].code);
        assert_int_equal(json_integer_value(json_object_get(error, "status")), faults[i].code);
        const char *message = json_string_value(json_object_get(error, "message"));
        if (!message || !strstr(message, faults[i].says)) fail_msg("gnomon %s: expected '%s' in\n%s", words, faults[i].says, result.out);
        json_decref(object);
        program_free(&result);
    }
}

static void environment_is_heard(void **state) {
    (void)state;
    need_device();
    struct program_result result =
        program_run(&(struct program_call){.words = "render scene.json -o a.png", .environment = "GNOMON_DEVICE=frobnicator"});
    assert_int_equal(result.code, GN_NO_DEVICE);
    assert_non_null(strstr(result.err, "frobnicator"));
    program_free(&result);
    result = program_run(
        &(struct program_call){.words = "render scene.json -o env.png --device cpu", .environment = "GNOMON_DEVICE=frobnicator"});
    assert_int_equal(result.code, 0);
    program_free(&result);
    result = program_run(&(struct program_call){.words = "render scene.json -o env.png", .environment = "GNOMON_DEVICE="});
    assert_int_equal(result.code, 0);
    program_free(&result);
}

static void no_driver_is_no_device(void **state) {
    (void)state;
    static const char *const words[] = {"devices", "render scene.json -o a.png", "verify scene.json"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct program_result result = program_run(&(struct program_call){
            .words = words[i], .environment = "VK_DRIVER_FILES=/nonexistent.json VK_ICD_FILENAMES=/nonexistent.json"});
        assert_int_equal(result.code, GN_NO_DEVICE);
        assert_non_null(strstr(result.err, "mesa-vulkan-drivers"));
        program_free(&result);
    }
    assert_false(program_has("a.png"));
}

// -------------------------------------------------------------------------------------------------------------------- help

static const char *const commands[] = {"render", "trace", "verify", "plan", "probe", "devices", "compare"};

static void help_is_complete_and_narrow(void **state) {
    (void)state;
    char *manual = program_text(TEST_SOURCE_DIR "/man/gnomon.1");
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        char words[64];
        snprintf(words, sizeof words, "%s --frobnicate --help", commands[i]);
        struct program_result result = program_expect(words, 0, ""), again;
        assert_non_null(strstr(result.out, "Usage: gnomon"));
        assert_non_null(strstr(result.out, "Examples:"));
        snprintf(words, sizeof words, "help %s", commands[i]);
        again = program_expect(words, 0, "");
        assert_string_equal(result.out, again.out);
        char *rest;
        for (char *line = strtok_r(result.out, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
            size_t columns = 0;
            for (const char *c = line; *c; c++) columns += (*c & 0xc0) != 0x80;
            if (columns > 80) fail_msg("%zu columns: %s", columns, line);
            char name[32], macro[40];
            if (line[0] != ' ' || sscanf(line + 2, "%*[-a-z,] --%31[a-z-]", name) + sscanf(line + 2, " --%31[a-z-]", name) < 1) continue;
            snprintf(macro, sizeof macro, "Fl -%s", name);
            if (!strstr(manual, macro)) fail_msg("the manual does not know --%s", name);
        }
        program_free(&result);
        program_free(&again);
    }
    free(manual);
}

static void overview_and_version(void **state) {
    (void)state;
    static const struct {
        const char *words, *says;
    } rows[] = {{"--help", "Exit codes"}, {"-h", "Exit codes"}, {"help", "compare A B"}, {"--version", "gnomon 0."}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct program_result result = program_expect(rows[i].words, 0, "");
        if (!strstr(result.out, rows[i].says)) fail_msg("gnomon %s: no '%s'", rows[i].words, rows[i].says);
        program_free(&result);
    }
}

// ----------------------------------------------------------------------------------------------------------------- results

// Fails unless `object` has all of these members (words).
static void assert_members(const json_t *object, const char *members) {
    char *list[PROGRAM_MOST_WORDS + 1], *copy = program_split(members, list, 0);
    for (int i = 0; list[i]; i++)
        if (!json_object_get(object, list[i])) fail_msg("no member '%s'", list[i]);
    free(copy);
}

static void check_render(const char *extra, const char *accuracy) {
    char words[256];
    snprintf(words, sizeof words, "render scene.json -o out.exr --size 40x30 --spp 2 --seed 4294967295 --json %s", extra);
    struct program_result result = program_expect(words, 0, "out.exr");
    json_t *object = program_json(words, &result);
    assert_members(object,
                   "image width height spp device driver accuracy effects rays nonfinite_pixels undecided_rays time_ms mrays_per_s");
    assert_members(json_object_get(object, "time_ms"), "total startup scene bvh pipeline trace output");
    assert_string_equal(json_string_value(json_object_get(object, "image")), "out.exr");
    assert_string_equal(json_string_value(json_object_get(object, "accuracy")), accuracy);
    assert_int_equal(json_integer_value(json_object_get(object, "width")), 40);
    assert_int_equal(json_integer_value(json_object_get(object, "height")), 30);
    assert_int_equal(json_integer_value(json_object_get(object, "spp")), 2);
    assert_true(json_is_array(json_object_get(object, "effects")) && json_array_size(json_object_get(object, "effects")) >= 3);
    assert_true(json_integer_value(json_object_get(object, "rays")) >= 40 * 30 * 2);
    assert_true(json_real_value(json_object_get(json_object_get(object, "time_ms"), "total")) > 0);
    json_decref(object);
    program_free(&result);
    assert_true(program_has("out.exr"));
}

static void render_reference_json(void **state) {
    (void)state;
    check_render("--reference", "reference");
}

static void render_device_json(void **state) {
    (void)state;
    need_device();
    check_render("", "robust");
#define X(number, id, name, text) check_render("--accuracy " name, name);
    TIERS(X)
#undef X
}

static void options_in_every_spelling(void **state) {
    (void)state;
    static const char *const rows[] = {
        "render scene.json -o spelled.png --reference",
        "render -ospelled.png --reference scene.json",
        "render --output spelled.png --reference -- scene.json",
        "render --output=spelled.png --size=8x8 --spp=1 --reference scene.json -qv",
        "render scene.json -o spelled.PNG --reference -vv --progress none --threads 1",
        "render scene.json -o spelled.png --reference --disable shadows --disable specular,diffuse --aov id --aov depth",
        "render scene.json -o spelled.png --reference --no-prune --stats",
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        remove(PROGRAM_FOLDER "/spelled.png");
        struct program_result result = program_expect(rows[i], 0, "");
        assert_true(program_has(strstr(rows[i], ".PNG") ? "spelled.PNG" : "spelled.png"));
        assert_string_equal(result.out, "");
        program_free(&result);
    }
    assert_true(program_has("spelled.id.png") && program_has("spelled.depth.png") && !program_has("spelled.normal.png"));
}

static void quiet_says_nothing(void **state) {
    (void)state;
    struct program_result result = program_expect("render scene.json -o quiet.png --reference -q", 0, "");
    assert_string_equal(result.err, "");
    program_free(&result);
    result = program_expect("render missing.json -o quiet.png --reference -q", 8, "missing.json"); // but errors
    program_free(&result);
}

static void check_trace(const char *extra) {
    char words[256];
    snprintf(words, sizeof words, "trace scene.json --rays rays.npy -o hits.npy --repeat 3 --json %s", extra);
    struct program_result result = program_expect(words, 0, "hits.npy");
    json_t *object = program_json(words, &result);
    assert_members(object, "rays hits accuracy undecided_rays time_ms mrays_per_s");
    assert_members(json_object_get(object, "time_ms"), "total startup scene bvh pipeline trace");
    assert_int_equal(json_integer_value(json_object_get(object, "rays")), 3);
    assert_int_equal(json_integer_value(json_object_get(object, "hits")), 1);
    json_decref(object);
    program_free(&result);

    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct gn_hit *hits;
    size_t count;
    assert_true(npy_read_hits(&hits, &count, &ctx, PROGRAM_FOLDER "/hits.npy"));
    assert_int_equal(count, 3);
    assert_int_equal(hits[0].object, 0);
    assert_int_equal(hits[1].object, -1);
    assert_int_equal(hits[2].object, -1);
    if (!strstr(extra, "--any")) assert_true(hits[0].t == 2.0f && isinf(hits[1].t) && hits[2].flags & GN_HIT_INVALID);
    free(hits);
}

static void trace_reference(void **state) {
    (void)state;
    check_trace("--reference");
    check_trace("--reference --any");
}

static void trace_device(void **state) {
    (void)state;
    need_device();
    check_trace("");
    check_trace("--any");
}

static void verify_passes_and_can_fail(void **state) {
    (void)state;
    need_device();
    static const struct {
        const char *words;
        int code;
        bool pass;
    } rows[] = {
        {"verify scene.json --json", 0, true},
        {"verify scene.json --json --spp 3 --size 33x17 --seed 7 --accuracy fast -o difference.png", 0, true},
        {"verify scene.json --json --tolerance 1e-12 -o difference.exr", 1, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct program_result result = program_expect(rows[i].words, rows[i].code, rows[i].pass ? "the same" : "not the same");
        json_t *object = program_json(rows[i].words, &result);
        assert_members(object, "pass pixels pixels_differing max_abs rmse wrong_hits");
        assert_int_equal(json_is_true(json_object_get(object, "pass")), rows[i].pass);
        assert_null(json_object_get(object, "error"));
        json_decref(object);
        program_free(&result);
    }
    assert_true(program_has("difference.png") && program_has("difference.exr"));
}

static void plan_lists_effects(void **state) {
    (void)state;
    struct program_result result = program_expect("plan scene.json --json --disable specular", 0, "");
    json_t *object = program_json("plan", &result), *effect;
    size_t i, known = 0;
    json_array_foreach(json_object_get(object, "effects"), i, effect) {
        const char *name = json_string_value(json_object_get(effect, "name")),
                   *state_text = json_string_value(json_object_get(effect, "state"));
        const char *because = json_string_value(json_object_get(effect, "because"));
        assert_true(name && state_text && because && *because);
        bool on = strcmp(state_text, "on") == 0;
        assert_true(on || strcmp(state_text, "pruned") == 0);
        if (strcmp(name, "spheres") == 0 || strcmp(name, "diffuse") == 0) assert_true(on), known++;
        if (strcmp(name, "triangles") == 0 || strcmp(name, "specular") == 0 || strcmp(name, "antialiasing") == 0) assert_false(on), known++;
    }
    assert_int_equal(known, 5);
    json_decref(object);
    program_free(&result);
    result = program_expect("plan scene.json", 0, "");
    assert_non_null(strstr(result.out, "antialiasing"));
    program_free(&result);
}

static void devices_lists_devices(void **state) {
    (void)state;
    need_device();
    struct program_result result = program_expect("devices --json", 0, "");
    json_t *object = program_json("devices", &result), *devices = json_object_get(object, "devices");
    assert_true(json_array_size(devices) >= 1);
    assert_members(json_array_get(devices, 0), "index name type driver api uuid");
    assert_true(json_is_integer(json_object_get(object, "selected")));
    json_decref(object);
    program_free(&result);
    result = program_expect("devices", 0, "");
    assert_non_null(strstr(result.out, "Used: "));
    program_free(&result);
    result = program_expect("devices --device frobnicator", GN_NO_DEVICE, "frobnicator");
    program_free(&result);
}

static void compare_measures(void **state) {
    (void)state;
    struct program_result result = program_expect("render scene.json -o one.pfm --reference", 0, "");
    program_free(&result);
    result = program_expect("render scene.json -o two.pfm --reference --disable specular", 0, "");
    program_free(&result);
    static const struct {
        const char *words;
        int code;
        bool equal;
    } rows[] = {
        {"compare one.pfm one.pfm --json --max-abs 0 --max-flip 0 -o heat.png", 0, true},
        {"compare one.pfm two.pfm --json", 0, false},
        {"compare one.pfm two.pfm --json --max-abs 0.01", 1, false},
        {"compare one.pfm two.pfm --json --max-flip 0.0001", 1, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        result = program_expect(rows[i].words, rows[i].code, "");
        json_t *object = program_json(rows[i].words, &result);
        assert_members(object, "pass max_abs rmse psnr_db flip worst_x worst_y pixels_differing");
        assert_int_equal(json_is_null(json_object_get(object, "psnr_db")), rows[i].equal);
        assert_int_equal(json_real_value(json_object_get(object, "max_abs")) == 0, rows[i].equal);
        assert_int_equal(json_is_true(json_object_get(object, "pass")), rows[i].code == 0);
        json_decref(object);
        program_free(&result);
    }
    assert_true(program_has("heat.png"));
    result = program_expect("compare one.pfm two.pfm", 0, "");
    assert_non_null(strstr(result.out, "FLIP"));
    program_free(&result);
    result = program_expect("render scene.json -o small.pfm --reference --size 8x8", 0, "");
    program_free(&result);
    result = program_expect("compare one.pfm small.pfm", GN_USAGE, "");
    program_free(&result);
}

// ------------------------------------------------------------------------------------------------------- outputs and signals

static void output_that_cannot_be_written(void **state) {
    (void)state;
    static const struct {
        const char *words, *out;
    } rows[] = {
        {"plan scene.json --json", "/dev/full"},
        {"plan scene.json", "/dev/full"},
        {"--help", "/dev/full"},
        {"render --help", "/dev/full"},
        {"plan scene.json --json", "|"},
        {"plan scene.json", "|"},
        {"plan scene.json --json", ""},
        {"--version", ""},
        {"render scene.json -o full.png --reference --json", "/dev/full"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct program_result result = program_run(&(struct program_call){.words = rows[i].words, .out = rows[i].out});
        if (result.code != GN_IO) fail_msg("gnomon %s >%s: exit code %d\n%s", rows[i].words, rows[i].out, result.code, result.err);
        assert_non_null(strstr(result.err, "standard output"));
        program_free(&result);
    }
    // What writes nothing there does not care.
    struct program_result result = program_run(&(struct program_call){.words = "render scene.json -o full.png --reference", .out = ""});
    assert_int_equal(result.code, 0);
    program_free(&result);
}

static void picture_that_cannot_be_written(void **state) {
    (void)state;
    remove(PROGRAM_FOLDER "/full.pfm");
    assert_int_equal(symlink("/dev/full", PROGRAM_FOLDER "/full.pfm"), 0);
    mkdir(PROGRAM_FOLDER "/folder.png", 0777);
    struct program_result result = program_expect("render scene.json -o full.pfm --reference --aov depth", 8, "full.pfm");
    assert_false(program_has("full.depth.pfm")); // written before it, and gone again
    assert_int_equal(program_count(".*.tmp"), 0);
    program_free(&result);
    result = program_expect("render scene.json -o folder.png --reference", 8, "directory");
    program_free(&result);
    remove(PROGRAM_FOLDER "/full.pfm");
}

static void an_old_output_survives_a_failure(void **state) {
    (void)state;
    program_write("old.png", "old");
    struct program_result result = program_expect("render bad.json -o old.png --reference", 3, "");
    char *text = program_text(PROGRAM_FOLDER "/old.png");
    assert_string_equal(text, "old");
    free(text);
    program_free(&result);
}

// Work that takes hours, ended: within a second, with 130, and nothing on the disk.
static void check_interrupt(const char *extra, int number, int signals) {
    char words[256];
    snprintf(words, sizeof words, "render scene.json -o never.png --spp 16777216 %s", extra);
    struct program_result result = program_run(&(struct program_call){.words = words, .signal = number, .signals = signals});
    if (result.code != 130) fail_msg("gnomon %s, signal %d: exit code %d\n%s", words, number, result.code, result.err);
    if (!(result.seconds < 1.5)) fail_msg("gnomon %s: ended after %g s", words, result.seconds); // 1, and what a busy machine takes
    assert_false(program_has("never.png"));
    assert_int_equal(program_count(".*.tmp"), 0);
    if (strstr(words, "--json")) {
        json_t *object = program_json(words, &result);
        assert_int_equal(json_integer_value(json_object_get(json_object_get(object, "error"), "status")), 130);
        json_decref(object);
    }
    program_free(&result);
}

static void reference_is_interrupted(void **state) {
    (void)state;
    check_interrupt("--reference --json", SIGINT, 1);
    check_interrupt("--reference", SIGTERM, 1);
    check_interrupt("--reference --progress bar", SIGHUP, 1);
    check_interrupt("--reference --json", SIGINT, 2);
}

static void device_is_interrupted(void **state) {
    (void)state;
    need_device();
    check_interrupt("--json", SIGINT, 1);
    check_interrupt("", SIGINT, 2);
}

// --------------------------------------------------------------------------------------------------------- the shader cache

// How many folders for shaders there are under PROGRAM_FOLDER/cache after a run with this environment.
static int cache_folders(const char *environment) {
    char all[512];
    snprintf(all, sizeof all, "XDG_CACHE_HOME=%s/cache MESA_SHADER_CACHE_DIR MESA_SHADER_CACHE_DISABLE %s", PROGRAM_FOLDER, environment);
    struct program_result result = program_run(&(struct program_call){.words = "devices", .environment = all});
    program_free(&result);
    return program_count("cache/gnomon/mesa-*");
}

static void every_driver_and_setting_has_its_cache(void **state) {
    (void)state;
    if (strchr(PROGRAM_FOLDER, ' ')) skip();
    assert_int_equal(cache_folders("MESA_SHADER_CACHE_DIR=/tmp"), 0); // the user's choice
    assert_int_equal(cache_folders("MESA_SHADER_CACHE_DISABLE=true"), 0);
    assert_int_equal(cache_folders(""), 1);
    assert_int_equal(cache_folders(""), 1); // the same again
    assert_int_equal(cache_folders("LP_NATIVE_VECTOR_WIDTH=128"), 2);
    assert_int_equal(cache_folders("GALLIVM_PERF=nopt"), 3);
    assert_int_equal(cache_folders("LANG=C GNOMON_DEVICE=cpu"), 3); // has nothing to do with it
    program_write("driver.json", "{\"ICD\": {\"library_path\": \"./driver.so\"}}");
    program_write("driver.so", "one");
    char driver[300];
    snprintf(driver, sizeof driver, "VK_DRIVER_FILES=%s/driver.json VK_ICD_FILENAMES=%s/driver.json", PROGRAM_FOLDER, PROGRAM_FOLDER);
    assert_int_equal(cache_folders(driver), 4);
    assert_int_equal(cache_folders(driver), 4);
    program_write("driver.so", "another"); // an update in the same place
    assert_int_equal(cache_folders(driver), 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_fault_has_its_message_and_code),
        cmocka_unit_test(json_is_one_object_in_every_fault),
        cmocka_unit_test(environment_is_heard),
        cmocka_unit_test(no_driver_is_no_device),
        cmocka_unit_test(help_is_complete_and_narrow),
        cmocka_unit_test(overview_and_version),
        cmocka_unit_test(render_reference_json),
        cmocka_unit_test(render_device_json),
        cmocka_unit_test(options_in_every_spelling),
        cmocka_unit_test(quiet_says_nothing),
        cmocka_unit_test(trace_reference),
        cmocka_unit_test(trace_device),
        cmocka_unit_test(verify_passes_and_can_fail),
        cmocka_unit_test(plan_lists_effects),
        cmocka_unit_test(devices_lists_devices),
        cmocka_unit_test(compare_measures),
        cmocka_unit_test(output_that_cannot_be_written),
        cmocka_unit_test(picture_that_cannot_be_written),
        cmocka_unit_test(an_old_output_survives_a_failure),
        cmocka_unit_test(reference_is_interrupted),
        cmocka_unit_test(device_is_interrupted),
        cmocka_unit_test(every_driver_and_setting_has_its_cache),
    };
    return cmocka_run_group_tests_name("cli", tests, write_inputs, NULL);
}
