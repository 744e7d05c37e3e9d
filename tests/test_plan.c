// The plan: what runs and what is pruned, for small scenes that differ in one thing.
#include "scratch.h"

#include "effects/plan.h"

#define SPHERE "{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1, \"material\": \"m\"}"
#define TRIANGLE "{\"type\": \"triangle\", \"vertices\": [[-1,-1,-3.5],[1,1,-3],[0.75,-1,-2.5]], \"material\": \"m\"}"
#define LIGHT(position, intensity) "{\"type\": \"point\", \"position\": " position ", \"intensity\": " intensity "}"
#define SUN LIGHT("[-10,10,4]", "[1,1,1]")
#define MATT "\"diffuse\": [1,0,0]"
#define SHINY "\"diffuse\": [0,0,0], \"specular\": [0,0,1]"
#define OUTSIDE "[0,0,0]"

// A scene with the camera at `camera` and one material "m"; then disabled effects.
struct scene_case {
    const char *camera, *material, *lights, *shapes, *more, *disable;
    const char *effects; // that run
};

static struct scene load_case(const struct scene_case *c) {
    char text[2048];
    struct scene scene;
    snprintf(text, sizeof text,
             "{\"version\": 1, \"camera\": {\"position\": %s, \"look_at\": [0,0,-9]}, \"materials\": {\"m\": {%s}, \"unused\": "
             "{\"diffuse\": [1,1,1], \"specular\": [1,1,1]}}, \"lights\": [%s], \"shapes\": [%s]%s}",
             c->camera, c->material, c->lights, c->shapes, c->more ? c->more : "");
    scratch_assert(scene_load(&scene, scratch_context(), scratch_file("a.json", text, strlen(text))));
    return scene;
}

static const struct scene_case cases[] = {
    // Geometry.
    {OUTSIDE, MATT, "", "", NULL, NULL, ""},
    {OUTSIDE, MATT, "", SPHERE, NULL, NULL, "spheres"},
    {OUTSIDE, MATT, "", TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, MATT, "", TRIANGLE "," TRIANGLE "," TRIANGLE "," TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, MATT, "", TRIANGLE "," TRIANGLE "," TRIANGLE "," TRIANGLE "," TRIANGLE, NULL, NULL, "triangles,bvh"},
    {OUTSIDE, MATT, "", SPHERE "," TRIANGLE, NULL, NULL, "triangles,spheres,bvh"},
    {OUTSIDE, MATT, "", "{\"type\": \"mesh\", \"file\": \"n.obj\"}", NULL, NULL, "triangles,smooth_normals"},
    {OUTSIDE, MATT, "", "{\"type\": \"mesh\", \"file\": \"n.obj\", \"normals\": \"flat\"}", NULL, NULL, "triangles"},
    // Light: it takes a light and a material in use with a channel in common.
    {OUTSIDE, MATT, SUN, TRIANGLE, NULL, NULL, "triangles,diffuse"},
    {OUTSIDE, SHINY, SUN, TRIANGLE, NULL, NULL, "triangles,specular"},
    {OUTSIDE,
     SHINY ","
           "\"ambient\": [1,1,1]",
     LIGHT("[0,9,0]", "[1,1,0]"), TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, MATT, LIGHT("[0,9,0]", "[0,0,0]"), TRIANGLE "," SPHERE, NULL, NULL, "triangles,spheres,bvh"},
    {OUTSIDE, MATT, LIGHT("[0,9,0]", "[0,1,0]") "," LIGHT("[0,9,0]", "[1,0,0]"), TRIANGLE, NULL, NULL, "triangles,diffuse"},
    {OUTSIDE, MATT, "", TRIANGLE "," TRIANGLE, NULL, NULL, "triangles"},
    // Shadows.
    {OUTSIDE, MATT, SUN, TRIANGLE "," TRIANGLE, NULL, NULL, "triangles,diffuse,shadows"},
    {OUTSIDE, MATT, SUN, TRIANGLE "," TRIANGLE, ", \"shadows\": false", NULL, "triangles,diffuse"},
    {OUTSIDE, MATT, SUN, SPHERE "," SPHERE, NULL, NULL, "spheres,diffuse,shadows"},
    {OUTSIDE, MATT, SUN, SPHERE, NULL, NULL, "spheres,diffuse"},
    {OUTSIDE, MATT, LIGHT("[0,0,-3]", "[1,1,1]"), SPHERE, NULL, NULL, "spheres,diffuse"},      // the light is inside
    {"[0,0,-3]", MATT, SUN, SPHERE, NULL, NULL, "spheres,diffuse,shadows"},                    // the camera is inside
    {"[0,0,-2]", MATT, SUN, SPHERE, NULL, NULL, "spheres,diffuse,shadows"},                    // on it
    {"[0,0,-2.5]", MATT, LIGHT("[0,0,-3]", "[1,1,1]"), SPHERE, NULL, NULL, "spheres,diffuse"}, // both are inside
    {"[0,0,-2.5]", MATT, LIGHT("[0,0,-3]", "[1,1,1]") "," SUN, SPHERE, NULL, NULL, "spheres,diffuse,shadows"},
    {"[0,0,-2.5]", MATT, LIGHT("[0,1,-3]", "[1,1,1]"), SPHERE, NULL, NULL, "spheres,diffuse,shadows"}, // the light is on it
    // Disabled effects, and what hangs on them.
    {OUTSIDE, MATT, SUN, SPHERE "," TRIANGLE, NULL, "shadows", "triangles,spheres,bvh,diffuse"},
    {OUTSIDE, MATT, SUN, SPHERE "," TRIANGLE, NULL, "diffuse", "triangles,spheres,bvh"},
    {OUTSIDE, MATT, SUN, SPHERE "," TRIANGLE, NULL, "triangles", "spheres,bvh,diffuse"},
    {OUTSIDE, MATT, SUN, SPHERE "," TRIANGLE, NULL, "spheres,shadows", "triangles,bvh,diffuse"},
};

static int make_meshes(void **state) {
    if (scratch_open(state)) return -1;
    static const char mesh[] = "v 0 0 0\nvn 0 0 1\nf 1//1 1//1 1//1\n";
    scratch_file("n.obj", mesh, strlen(mesh));
    return 0;
}

static void each_scene_calls_for_what_it_needs(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct scene scene = load_case(&cases[i]);
        struct plan plan;
        char effects[256];
        scratch_assert(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .disable = cases[i].disable}));
        effect_names(plan.effects, effects, sizeof effects);
        if (strcmp(effects, cases[i].effects) != 0) fail_msg("case %zu: '%s', expected '%s'", i, effects, cases[i].effects);
        for (uint32_t k = 0; k < EFFECT_COUNT; k++) assert_true(strlen(plan.because[k]) > 5);
        scene_finish(&scene);
    }
}

static void reasons_name_the_culprit(void **state) {
    (void)state;
    static const struct scene_case c = {OUTSIDE, MATT, LIGHT("[0,9,0]", "[0,1,1]") "," SUN, TRIANGLE "," SPHERE, NULL, "spheres", ""};
    static const char *const reasons[EFFECT_COUNT] = {"shape 0 and 1 triangle in all",
                                                      "disabled on request",
                                                      "triangles and spheres",
                                                      "no mesh has vertex normals",
                                                      "light 1 and the diffuse color of material 'm' on shape 0",
                                                      "no material in use has a specular color that a light could show",
                                                      "a triangle alone casts no shadow on itself",
                                                      "7 samples per pixel",
                                                      "samples are spread over their pixel",
                                                      "the camera is a pinhole",
                                                      "nothing moves",
                                                      "no mesh is drawn more than once, and none moves",
                                                      "there are no directional lights",
                                                      "there are no spot lights",
                                                      "no material in use sends out light",
                                                      "no light has a size",
                                                      "the background is one colour",
                                                      "no material in use has a Blinn-Phong's specular color that a light could show",
                                                      "no material in use is metallic-roughness",
                                                      "no material in use has a texture",
                                                      "no material in use has a normal map",
                                                      "every material in use is opaque",
                                                      "no material in use is a mirror",
                                                      "no material in use is a dielectric",
                                                      "no dielectric in use takes light away",
                                                      "the scene does not ask for indirect light",
                                                      "there is no medium"};
    struct scene scene = load_case(&c);
    struct plan plan;
    scratch_assert(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 7, .disable = c.disable}));
    for (uint32_t k = 0; k < EFFECT_COUNT; k++) assert_string_equal(plan.because[k], reasons[k]);
    assert_true(plan.effects & EFFECT_ANTIALIASING);
    scene_finish(&scene);
}

static void without_pruning_everything_runs(void **state) {
    (void)state;
    static const struct scene_case c = {OUTSIDE, MATT, "", "", NULL, NULL, ""};
    struct scene scene = load_case(&c);
    struct plan plan;
    scratch_assert(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .no_prune = true}));
    assert_int_equal(plan.effects, (1u << EFFECT_COUNT) - 1);
    scratch_assert(
        plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .no_prune = true, .disable = "shadows,spheres"}));
    assert_int_equal(plan.effects, ((1u << EFFECT_COUNT) - 1) & ~(uint32_t)(EFFECT_SHADOWS | EFFECT_SPHERES));
    scene_finish(&scene);
    scratch_assert(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .no_prune = true})); // nothing there at all
    assert_int_equal(plan.effects, (1u << EFFECT_COUNT) - 1);
}

static void names_are_checked(void **state) {
    (void)state;
    static const struct {
        const char *list, *says;
    } bad[] = {
        {"shadow", "'shadow' is no effect, expected some of: triangles,spheres,bvh,smooth_normals,diffuse,specular,shadows,antialiasing,filter"},
        {"shadow", "fog; did you mean 'shadows'?"},
        {"bvh,,shadows", "'' is no effect"},
        {"bvh,", "'' is no effect"},
        {",", "'' is no effect"},
        {"bvh, shadows", "' shadows' is no effect"},
        {"a\nvery long name that goes on and on and on and on and on and on and on and on and on and on", "'a?very long name"},
    };
    struct scene scene = {0};
    struct plan plan;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        scratch_assert_fails(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .disable = bad[i].list}), GN_USAGE,
                             bad[i].says);
    scratch_assert(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .disable = ""}));
    assert_string_equal(effect_name(0), "triangles");
    assert_string_equal(effect_name(EFFECT_COUNT), "");
    char text[12];
    effect_names(EFFECT_TRIANGLES | EFFECT_SPHERES, text, sizeof text);
    assert_string_equal(text, "triangles,s"); // cut, not overrun
}

// Leaving the hierarchy out of a scene that needs it would lose hits, so it is refused.
static void the_hierarchy_cannot_be_disabled(void **state) {
    (void)state;
    static const struct scene_case c = {OUTSIDE, MATT, SUN, SPHERE "," TRIANGLE, NULL, NULL, ""};
    struct scene scene = load_case(&c);
    struct plan plan;
    scratch_assert_fails(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .disable = "bvh"}), GN_USAGE,
                         "effect 'bvh' cannot be disabled here (triangles and spheres)");
    scene_finish(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_scene_calls_for_what_it_needs),
        cmocka_unit_test(reasons_name_the_culprit),
        cmocka_unit_test(without_pruning_everything_runs),
        cmocka_unit_test(names_are_checked),
        cmocka_unit_test(the_hierarchy_cannot_be_disabled),
    };
    return cmocka_run_group_tests_name("plan", tests, make_meshes, scratch_close);
}
