// The proof that pruning changes nothing: every scene of scenes/, and one generated for each effect, gives the same bits with the effects that
// it calls for as with all of them, in every tier and in the reference. And the proof that this would show: an effect that is called for,
// once disabled, makes another picture.
#include "scratch.h"

#include <glob.h>
#include <sys/wait.h>

#include "gnomon.h"

#define WIDTH 24

static struct gn_device *device;
static struct gn_error error;

static bool open_device(void) {
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    device = gn_device_create(&params, &error);
    if (!device) print_message("no device: %s\n", error.message);
    return device;
}

static const uint32_t layers[] = {0, GN_AOV_DEPTH, GN_AOV_NORMAL, GN_AOV_ID};
static const uint32_t channels[] = {3, 1, 3, 2};

static struct gn_picture *rendered(struct gn_scene *scene, int tier, uint32_t spp, bool no_prune, const char *disable) {
    struct gn_scene_info info;
    gn_scene_info(scene, &info);
    const struct gn_render_params params = {
        .width = WIDTH,
        .height = 1 + (WIDTH * info.height - 1) / info.width,
        .spp = spp,
        .aovs = GN_AOV_DEPTH | GN_AOV_NORMAL | GN_AOV_ID,
        .accuracy = tier < 0 ? GN_ROBUST : (enum gn_accuracy)tier,
        .no_prune = no_prune,
        .disable = disable,
    };
    return gn_render(tier < 0 ? NULL : device, scene, &params, &error);
}

// How many pixels differ in a layer.
static int differences(const struct gn_picture *a, const struct gn_picture *b, int layer) {
    const uint32_t count = gn_picture_width(a) * gn_picture_height(a), width = channels[layer];
    const float *left = gn_picture_pixels(a, layers[layer]), *right = gn_picture_pixels(b, layers[layer]);
    int off = 0;
    for (uint32_t i = 0; i < count; i++) off += memcmp(left + width * i, right + width * i, width * sizeof(float)) != 0;
    return off;
}

static const char *tier_name(int tier) { return tier < 0 ? "reference" : gn_accuracy_name((enum gn_accuracy)tier); }

// How many layers differ between pruned and not; says which.
static int compare(struct gn_scene *scene, const char *name, int tier, uint32_t spp) {
    struct gn_picture *pruned = rendered(scene, tier, spp, false, NULL), *full = pruned ? rendered(scene, tier, spp, true, NULL) : NULL;
    int wrong = 0;
    if (!full) {
        print_error("%s, %s: %s\n", name, tier_name(tier), error.message);
        wrong++;
    }
    for (int layer = 0; full && layer < 4; layer++) {
        const int off = differences(pruned, full, layer);
        if (off)
            print_error("%s, %s: %d pixels of layer %u differ; pruned to %s\n", name, tier_name(tier), off, layers[layer],
                        gn_picture_stats(pruned)->effects);
        wrong += off > 0;
    }
    if (full && gn_picture_stats(pruned)->rays > gn_picture_stats(full)->rays) {
        print_error("%s, %s: pruning adds rays\n", name, tier_name(tier));
        wrong++;
    }
    gn_picture_destroy(full);
    gn_picture_destroy(pruned);
    return wrong;
}

// ------------------------------------------------------------------------------------------------------------ one effect each

#define FLOOR "{\"type\": \"rectangle\", \"corner\": [-6,-1,-9], \"edges\": [[0,0,9],[12,0,0]], \"material\": \"matt\"}"
#define BALL "{\"type\": \"sphere\", \"center\": [-0.8,0,-4], \"radius\": 1, \"material\": \"m\"}"
#define PANE "{\"type\": \"triangle\", \"vertices\": [[0.2,-1,-3.5],[2.4,-0.8,-3],[1,1.2,-3.4]], \"material\": \"m\"}"
#define SUN "{\"type\": \"directional\", \"direction\": [1,-2,-0.5], \"intensity\": [0.7,0.7,0.7]}"
#define LAMP "{\"type\": \"point\", \"position\": [-2,3,-1], \"intensity\": [0.8,0.8,0.8]}"
#define BEAM                                                                                                                  \
    "{\"type\": \"spot\", \"position\": [-2,3,-1], \"direction\": [1,-3,-3], \"intensity\": [9,9,9], \"falloff\": " \
    "\"inverse_square\", \"outer_deg\": 20}"
#define BOUNCES ", \"paths\": {\"indirect\": true, \"max_depth\": 3}"

// A floor and a ball of material "m", seen from near the ceiling; and the effect that a check has to be about.
static const struct generated {
    const char *effect, *material, *lights, *shapes, *more, *camera;
    uint32_t spp;
} generated[] = {
    {"diffuse", "\"diffuse\": [0.6,0.5,0.4]", LAMP, FLOOR "," BALL, "", "", 1},
    {"shadows", "\"diffuse\": [0.6,0.5,0.4]", LAMP, FLOOR "," BALL "," PANE, "", "", 1},
    {"specular", "\"diffuse\": [0,0,0.1], \"specular\": [1,1,1], \"shininess\": 9", LAMP, BALL "," PANE, "", "", 2},
    {"antialiasing", "\"diffuse\": [0.6,0.5,0.4]", "", FLOOR "," BALL, "", "", 3},
    {"filter", "\"diffuse\": [0.6,0.5,0.4]", LAMP, BALL, ", \"film\": {\"filter\": \"tent\"}", "", 2},
    {"depth_of_field", "\"diffuse\": [0.6,0.5,0.4]", LAMP, BALL "," PANE, "", ", \"lens_radius\": 0.2", 2},
    {"motion_blur", "\"diffuse\": [0.6,0.5,0.4]", LAMP, BALL, "", ", \"motion\": {\"position\": [0.5,0.5,0]}", 2},
    {"directional", "\"diffuse\": [0.6,0.5,0.4]", SUN, FLOOR "," BALL, "", "", 1},
    {"spot", "\"diffuse\": [0.6,0.5,0.4]", BEAM, FLOOR "," BALL, "", "", 1},
    {"blinn_phong", "\"model\": \"blinn_phong\", \"specular\": [1,1,1], \"shininess\": 20", LAMP, BALL "," PANE, "", "", 1},
    {"ggx", "\"model\": \"metallic_roughness\", \"diffuse\": [0.9,0.5,0.2], \"metallic\": 0.7, \"roughness\": 0.4", LAMP,
     FLOOR "," BALL, "", "", 1},
    {"emission", "\"diffuse\": [0.2,0.2,0.2], \"emission\": [2,3,4]", "", BALL, "", "", 1},
    {"soft_shadows", "\"emission\": [2,3,4]", "", FLOOR "," BALL "," PANE, "", "", 2},
    {"alpha", "\"diffuse\": [0.6,0.5,0.4], \"alpha\": 0.5", LAMP, FLOOR "," BALL "," PANE, "", "", 2},
    {"reflection", "\"model\": \"mirror\", \"diffuse\": [0.9,0.8,0.7]", LAMP, FLOOR "," BALL "," PANE, "", "", 1},
    {"refraction", "\"model\": \"dielectric\", \"ior\": 1.5", LAMP, FLOOR "," BALL, "", "", 1},
    {"absorption", "\"model\": \"dielectric\", \"ior\": 1.5, \"absorption\": [1,0.2,0.1]", LAMP, FLOOR "," BALL, "", "", 1},
    {"indirect", "\"diffuse\": [0.9,0.5,0.4]", LAMP, FLOOR "," BALL, BOUNCES, "", 2},
    {"indirect", "\"diffuse\": [0.5,0.5,0.4], \"specular\": [0.4,0.4,0.4], \"shininess\": 7, \"emission\": [1,1,1]", "",
     FLOOR "," BALL, BOUNCES, "", 2},
    {"fog", "\"diffuse\": [0.6,0.5,0.4]", LAMP, FLOOR "," BALL, ", \"fog\": {\"density\": 0.2, \"albedo\": [0.9,0.9,0.9]}", "", 2},
};

static struct gn_scene *generate(const struct generated *g) {
    char text[4096], name[32];
    snprintf(name, sizeof name, "%ld.json", (long)getpid());
    snprintf(text, sizeof text,
             "{\"version\": 1, \"camera\": {\"position\": [0,0.5,0.5], \"look_at\": [0,-0.2,-4], \"fov_y_deg\": 50%s}, \"background\": [0.1,0.2,0.3], "
             "\"ambient\": [0.1,0.1,0.1], \"materials\": {\"matt\": {\"model\": \"lambert\", \"diffuse\": [0.5,0.6,0.5]}, \"m\": {%s}}, "
             "\"lights\": [%s], \"shapes\": [%s]%s}",
             g->camera, g->material, g->lights, g->shapes, g->more);
    struct gn_scene *scene = gn_scene_load(scratch_file(name, text, strlen(text)), NULL, &error);
    if (!scene) fail_msg("%s: %s", g->effect, error.message);
    return scene;
}

// ------------------------------------------------------------------------------------------------------------ all of them

// Scenes generated for an effect: all in the reference, each in one of the tiers. Compiling is what takes the time.
static int compare_generated(int tier) {
    int wrong = 0;
    for (int i = 0; i < (int)(sizeof generated / sizeof *generated); i++) {
        if (tier >= 0 && i % GN_ACCURACY_COUNT != tier) continue;
        struct gn_scene *scene = generate(&generated[i]);
        wrong += compare(scene, generated[i].effect, tier, generated[i].spp);
        gn_scene_destroy(scene);
    }
    return wrong;
}

static int compare_file(const char *path, int tier) {
    struct gn_scene *scene = gn_scene_load(path, NULL, &error);
    if (!scene) print_error("%s\n", error.message);
    const int wrong = scene ? compare(scene, strrchr(path, '/') + 1, tier, 1) : 1;
    gn_scene_destroy(scene);
    return wrong;
}

// Every scene in the reference. On the device each in one tier of every GNOMON_TEST_SHARE (a number; 2 unless given, 1 for all of it), another one for the
// next scene, so that all tiers are there: kernels compile for as long as the machine has patience.
static bool is_left_out(size_t scene, int tier) {
    const char *text = getenv("GNOMON_TEST_SHARE");
    const unsigned long share = text && *text ? strtoul(text, NULL, 10) : 2;
    return tier >= 0 && share > 1 && (scene + (size_t)tier) % share != 0;
}

static int compare_files(int tier) {
    glob_t scenes;
    if (glob(TEST_SOURCE_DIR "/scenes/*.json", 0, NULL, &scenes) != 0 || scenes.gl_pathc < 30) return 1;
    int wrong = 0;
    for (size_t i = 0; i < scenes.gl_pathc; i++)
        if (!is_left_out(i, tier)) wrong += compare_file(scenes.gl_pathv[i], tier);
    globfree(&scenes);
    return wrong;
}

#define NO_DEVICE 77

// What is wrong in a tier, as the exit code of a process of its own.
static int judge_tier(int tier) {
    if (tier >= 0 && !open_device()) return error.status == GN_NO_DEVICE ? NO_DEVICE : 1;
    if (tier == GN_FP64 && !gn_device_info(device)->has_fp64) return NO_DEVICE;
    const int wrong = compare_generated(tier) + compare_files(tier);
    gn_device_destroy(device);
    return wrong > 0;
}

// A process for each tier, so that they compile side by side; -1 is the reference.
static void pruning_changes_no_bit(void **state) {
    (void)state;
    pid_t children[1 + GN_ACCURACY_COUNT];
    for (int tier = -1; tier < GN_ACCURACY_COUNT; tier++) {
        fflush(NULL);
        children[1 + tier] = fork();
        assert_true(children[1 + tier] >= 0);
        if (children[1 + tier] == 0) _Exit(judge_tier(tier));
    }
    int wrong = 0, status;
    for (int tier = -1; tier < GN_ACCURACY_COUNT; tier++) {
        assert_int_equal(waitpid(children[1 + tier], &status, 0), children[1 + tier]);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
        if (code == NO_DEVICE) print_message("%s: no device for it\n", tier_name(tier));
        wrong += code != 0 && code != NO_DEVICE;
    }
    assert_int_equal(wrong, 0);
}

// The negative control: the same comparison, with the effect that the scene is about disabled instead of those that it does not call for.
static void a_disabled_effect_shows(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof generated / sizeof *generated; i++) {
        const struct generated *g = &generated[i];
        struct gn_scene *scene = generate(g);
        struct gn_picture *pruned = rendered(scene, -1, g->spp, false, NULL), *less = rendered(scene, -1, g->spp, false, g->effect);
        if (!pruned || !less) fail_msg("%s: %s", g->effect, error.message);
        if (!strstr(gn_picture_stats(pruned)->effects, g->effect)) fail_msg("case %zu, %s: it is not on", i, g->effect);
        if (differences(pruned, less, 0) == 0) fail_msg("case %zu, %s: nobody sees that it is off", i, g->effect);
        gn_picture_destroy(less);
        gn_picture_destroy(pruned);
        gn_scene_destroy(scene);
    }
}

// ------------------------------------------------------------------------------------------------------------- what it saves

static void effects_that_can_be_off_are_measured(void **state) {
    (void)state;
    struct gn_scene *scene = generate(&generated[0]);
    const struct gn_render_params params = {.width = 16, .height = 16, .spp = 1};
    struct gn_effect effects[GN_PLAN_EFFECTS];
    struct gn_plan_cost cost;
    uint32_t count;
    assert_false(gn_plan_measure(NULL, scene, &params, &cost, &error));
    assert_int_equal(error.status, GN_USAGE);
    if (!open_device()) skip();
    if (!gn_plan(scene, &params, effects, GN_PLAN_EFFECTS, &count, &error)) fail_msg("%s", error.message);
    if (!gn_plan_measure(device, scene, &params, &cost, &error)) fail_msg("%s", error.message);
    for (uint32_t i = 0; i < count; i++) {
        const bool can_be_off = strcmp(effects[i].name, "diffuse") == 0 || strcmp(effects[i].name, "shadows") == 0;
        assert_int_equal(cost.without[i].measured, can_be_off);
    }
    assert_true(cost.rounds >= 1 && cost.buffer_count > 10);
    assert_true(cost.pruned.rays <= cost.full.rays && cost.pruned.device_bytes <= cost.full.device_bytes);
    for (uint32_t i = 0; i < cost.buffer_count; i++) {
        const struct gn_plan_buffer *buffer = &cost.buffers[i];
        assert_true(buffer->bytes > 0 && (buffer->limit == 0 || buffer->bytes < buffer->limit));
    }
    gn_device_destroy(device);
    gn_scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_disabled_effect_shows),
        cmocka_unit_test(pruning_changes_no_bit),
        cmocka_unit_test(effects_that_can_be_off_are_measured),
    };
    return cmocka_run_group_tests_name("prune", tests, scratch_open, scratch_close);
}
