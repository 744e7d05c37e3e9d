// The plan: what runs and what is pruned, for small scenes that differ in one thing.
#include "scratch.h"

#include "effects/plan.h"

#define SPHERE "{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1, \"material\": \"m\"}"
#define TRIANGLE "{\"type\": \"triangle\", \"vertices\": [[-1,-1,-3.5],[1,1,-3],[0.75,-1,-2.5]], \"material\": \"m\"}"
#define LIGHT(position, intensity) "{\"type\": \"point\", \"position\": " position ", \"intensity\": " intensity "}"
#define SUN LIGHT("[-10,10,4]", "[1,1,1]")
#define PARALLEL(intensity) "{\"type\": \"directional\", \"direction\": [0,-1,0], \"intensity\": " intensity "}"
#define CONE(intensity) "{\"type\": \"spot\", \"position\": [0,9,0], \"direction\": [0,-1,0], \"intensity\": " intensity "}"
#define GLASS "\"model\": \"dielectric\""
#define NO_DEPTH ", \"paths\": {\"max_depth\": 0}"
#define INDIRECT(depth) ", \"paths\": {\"indirect\": true, \"max_depth\": " #depth "}"
#define FOG(density) ", \"fog\": {\"density\": " density "}"
#define MATT "\"diffuse\": [1,0,0]"
#define SHINY "\"diffuse\": [0,0,0], \"specular\": [0,0,1]"
#define OUTSIDE "[0,0,0]"

// A scene with the camera at `camera` and one material "m"; then disabled effects.
struct scene_case {
    const char *camera, *material, *lights, *shapes, *more, *disable;
    const char *effects; // that run
};

static struct scene load_case(const struct scene_case *c) {
    char text[4096];
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
    {OUTSIDE, MATT, SUN, "{\"type\": \"mesh\", \"file\": \"n.obj\"}", NULL, NULL, "triangles,smooth_normals,diffuse,shadows"}, // bent normals
    {OUTSIDE, MATT ", \"alpha\": 0.5", SUN, SPHERE, NULL, NULL, "spheres,diffuse,shadows,alpha"},               // its inside is seen
    // Lights: they must shine, and on something that shows it.
    {OUTSIDE, MATT, PARALLEL("[1,1,1]"), SPHERE, NULL, NULL, "spheres,diffuse,directional"},
    {OUTSIDE, MATT, PARALLEL("[0,0,0]"), SPHERE, NULL, NULL, "spheres"},
    {OUTSIDE, "\"diffuse\": [0,0,0]", PARALLEL("[1,1,1]"), SPHERE, NULL, NULL, "spheres"},
    {OUTSIDE, MATT, CONE("[1,1,1]"), SPHERE, NULL, NULL, "spheres,diffuse,spot"},
    {OUTSIDE, MATT, CONE("[0,0,1]"), SPHERE, NULL, NULL, "spheres"},
    {OUTSIDE, MATT ", \"emission\": [1,0,0]", "", TRIANGLE, NULL, NULL, "triangles,diffuse,emission,soft_shadows"},
    {OUTSIDE, "\"diffuse\": [0,0,0], \"emission\": [1,0,0]", "", TRIANGLE, NULL, NULL, "triangles,emission"}, // it lights nothing
    {OUTSIDE, MATT ", \"emission\": [0,0,0]", "", TRIANGLE, NULL, NULL, "triangles"},
    // Materials: what is unused, or is multiplied by 0, calls for nothing.
    {OUTSIDE, "\"model\": \"blinn_phong\", \"diffuse\": [0,0,0], \"specular\": [1,0,0]", SUN, TRIANGLE, NULL, NULL, "triangles,blinn_phong"},
    {OUTSIDE, "\"model\": \"blinn_phong\", \"diffuse\": [0,0,0], \"specular\": [0,0,0]", SUN, TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, "\"model\": \"metallic_roughness\", \"diffuse\": [1,1,1], \"metallic\": 0.5", SUN, TRIANGLE, NULL, NULL, "triangles,diffuse,ggx"},
    {OUTSIDE, "\"model\": \"metallic_roughness\", \"diffuse\": [1,1,1], \"metallic\": 1", SUN, TRIANGLE, NULL, NULL, "triangles,ggx"},
    {OUTSIDE, "\"model\": \"metallic_roughness\", \"diffuse\": [1,1,1]", "", TRIANGLE, NULL, NULL, "triangles"}, // no light
    {OUTSIDE, MATT ", \"alpha\": 0.5", "", TRIANGLE, NULL, NULL, "triangles,alpha"},
    {OUTSIDE, MATT ", \"alpha\": 1", "", TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, MATT ", \"alpha\": 0.5, \"alpha_cutoff\": 0.5", "", TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, MATT ", \"alpha\": 0.4, \"alpha_cutoff\": 0.5", "", TRIANGLE, NULL, NULL, "triangles,alpha"},
    {OUTSIDE, MATT ", \"reflection\": [0,0.5,0]", "", TRIANGLE, NULL, NULL, "triangles,reflection"},
    {OUTSIDE, MATT ", \"reflection\": [0,0,0]", "", TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, "\"model\": \"mirror\"", "", TRIANGLE, NULL, NULL, "triangles,reflection"},
    {OUTSIDE, "\"model\": \"mirror\", \"diffuse\": [0,0,0]", "", TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE, "\"model\": \"mirror\"", "", TRIANGLE, NO_DEPTH, NULL, "triangles"}, // paths end there
    {OUTSIDE, GLASS, "", SPHERE, NULL, NULL, "spheres,refraction"},
    {OUTSIDE, GLASS ", \"ior\": 1", "", SPHERE, NULL, NULL, "spheres,refraction"}, // what is behind it must still be seen
    {OUTSIDE, GLASS ", \"absorption\": [0,1,0]", "", SPHERE, NULL, NULL, "spheres,refraction,absorption"},
    {OUTSIDE, GLASS ", \"absorption\": [0,1,0], \"thin\": true", "", SPHERE, NULL, NULL, "spheres,refraction"},
    {OUTSIDE, GLASS ", \"absorption\": [0,1,0]", "", SPHERE, NO_DEPTH, NULL, "spheres"},
    // The way light goes, and is seen.
    {OUTSIDE, MATT, "", TRIANGLE, INDIRECT(3), NULL, "triangles,diffuse,indirect"}, // the background shines
    {OUTSIDE, MATT, "", TRIANGLE, INDIRECT(0), NULL, "triangles"},
    {OUTSIDE, MATT, "", TRIANGLE, FOG("0.5"), NULL, "triangles,fog"},
    {OUTSIDE, MATT, "", TRIANGLE, FOG("0"), NULL, "triangles"},
    {OUTSIDE, MATT, LIGHT("[0,9,0]", "[0,1,0]"), TRIANGLE, FOG("0.5"), NULL, "triangles,shadows,fog"}, // of the triangle, in the fog
    {OUTSIDE, MATT, LIGHT("[0,9,0]", "[0,1,0]"), "", FOG("0.5"), NULL, "fog"},
    {OUTSIDE ", \"lens_radius\": 0.1", MATT, "", TRIANGLE, NULL, NULL, "triangles,depth_of_field"},
    {OUTSIDE ", \"lens_radius\": 0", MATT, "", TRIANGLE, NULL, NULL, "triangles"},
    {OUTSIDE ", \"motion\": {\"position\": [0,1,0]}", MATT, "", TRIANGLE, NULL, NULL, "triangles,motion_blur"},
    {OUTSIDE ", \"motion\": {\"position\": [0,0,0]}", MATT, "", TRIANGLE, NULL, NULL, "triangles"},
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
                                                      "no material in use has a Blinn-Phong specular color that a light could show",
                                                      "no material in use has a metallic-roughness color that a light could show",
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

// What only some effects leave: of those that the scene calls for, the ones that are asked for, and geometry.
static void only_some_effects_run(void **state) {
    (void)state;
    static const struct scene_case c = {OUTSIDE, MATT, SUN, SPHERE "," TRIANGLE, NULL, NULL, ""};
    static const struct {
        const char *only, *disable, *effects;
    } rows[] = {
        {"", "", "triangles,spheres,bvh,diffuse,shadows"},
        {"diffuse", "", "triangles,spheres,bvh,diffuse"},
        {"shadows,diffuse", "", "triangles,spheres,bvh,diffuse,shadows"},
        {"shadows,diffuse", "shadows,spheres", "triangles,bvh,diffuse"},
        {"fog,reflection", "", "triangles,spheres,bvh"},
    };
    struct scene scene = load_case(&c);
    struct plan plan;
    char effects[256];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scratch_assert(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .only = rows[i].only, .disable = rows[i].disable}));
        effect_names(plan.effects, effects, sizeof effects);
        assert_string_equal(effects, rows[i].effects);
    }
    scratch_assert_fails(plan_make(&plan, scratch_context(), &scene, &(struct plan_params){.spp = 1, .only = "fogs"}), GN_USAGE, "did you mean 'fog'?");
    scene_finish(&scene);
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
        cmocka_unit_test(only_some_effects_run),
        cmocka_unit_test(the_hierarchy_cannot_be_disabled),
    };
    return cmocka_run_group_tests_name("plan", tests, make_meshes, scratch_close);
}
