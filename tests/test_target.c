// A shadow ray's target, the light that it is shot at, is not in the way: in every tier, in the second stage's integers and in the reference.
#include "shot.h"

#include <math.h>

#include "bvh/scene_boxes.h"
#include "reference/resolve.h"
#include "scene/build.h"

// Along +x from the origin: a mesh of two triangles at x = 1 and 2, spheres from 3 to 5 and from 6 to 8, and the same triangle again at x = 9.
static float positions[2][18] = {{1, -1, -1, 1, 1, -1, 1, 0, 2, 2, -1, -1, 2, 1, -1, 2, 0, 2}, {9, -1, -1, 9, 1, -1, 9, 0, 2}};
static uint32_t indices[6] = {0, 1, 2, 3, 4, 5};

static struct scene_shape shapes[4] = {
    {.type = SHAPE_MESH, .mesh = {.positions = positions[0], .indices = indices, .vertex_count = 6, .triangle_count = 2}},
    {.type = SHAPE_SPHERE, .center = {4, 0, 0}, .radius = 1},
    {.type = SHAPE_SPHERE, .center = {7, 0, 0}, .radius = 1},
    {.type = SHAPE_TRIANGLE, .mesh = {.positions = positions[1], .indices = indices, .vertex_count = 3, .triangle_count = 1}},
};

static const struct {
    float from;
    int32_t target, index;
    int32_t object, primitive;
    float t;
} cases[] = {
    {0, -1, -1, 0, 0, 1},   {0, 0, 0, 0, 1, 2},         {0, 0, 1, 0, 0, 1},   {0, 0, -1, 1, 0, 3},  {2.5f, -1, 0, 1, 0, 0.5f}, {2.5f, 1, -1, 2, 0, 3.5f},
    {2.5f, 1, 0, 2, 0, 3.5f}, {2.5f, 1, 1, 1, 0, 0.5f}, {4, 1, -1, 2, 0, 2},  {5.5f, 2, 0, 3, 0, 3.5f}, {8.5f, 3, -1, -1, -1, INFINITY},
    {8.5f, 3, 0, -1, -1, INFINITY}, {8.5f, 0, -1, 3, 0, 0.5f},
};
#define CASES (sizeof cases / sizeof cases[0])

struct stage {
    struct scene scene;
    struct bvh bvh;
};

static void stage_init(struct stage *stage) {
    *stage = (struct stage){.scene = {.shapes = shapes, .shape_count = 4}};
    fixture_assert(scene_derive(&stage->scene, fixture_context()));
    fixture_assert(bvh_build_scene(&stage->bvh, fixture_context(), &stage->scene));
}

static void stage_finish(struct stage *stage) {
    free(stage->scene.first_triangle);
    free(stage->scene.first_sphere);
    bvh_finish(&stage->bvh);
}

static void device_ignores_it(void **state) {
    (void)state;
    const uint32_t effects = EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_BVH | EFFECT_SOFT_SHADOWS;
    struct stage stage;
    stage_init(&stage);
    for (uint32_t tier = TIER_FAST; tier <= TIER_EXACT; tier++) {
        struct shoot_ray rays[CASES];
        struct shoot_hit hits[CASES], any[CASES], hard[CASES];
        for (size_t i = 0; i < CASES; i++)
            rays[i] = (struct shoot_ray){{cases[i].from, 0, 0}, 0, {1, 0, 0}, INFINITY, cases[i].target, cases[i].index, SHOOT_NO_SELF, 0};
        shoot(hits, &stage.scene, &stage.bvh, &(struct shoot_params){tier, effects, false}, rays, CASES);
        shoot(any, &stage.scene, &stage.bvh, &(struct shoot_params){tier, effects, true}, rays, CASES);
        shoot(hard, &stage.scene, &stage.bvh, &(struct shoot_params){tier, effects & ~EFFECT_SOFT_SHADOWS, false}, rays, CASES); // the control: targets are hit
        uint32_t differ = 0;
        for (size_t i = 0; i < CASES; i++) {
            assert_int_equal(hits[i].object, cases[i].object);
            assert_int_equal(hits[i].primitive, cases[i].primitive);
            assert_true(fabsf(hits[i].t - cases[i].t) <= 1e-6f * cases[i].t || hits[i].t == cases[i].t);
            assert_int_equal(any[i].object >= 0, cases[i].object >= 0);
            assert_int_equal(hits[i].undecided + any[i].undecided, 0);
            differ += hard[i].object != hits[i].object || hard[i].primitive != hits[i].primitive;
        }
        assert_int_equal(differ, 8);
    }
    stage_finish(&stage);
}

static void integers_ignore_it(void **state) {
    (void)state;
    struct stage stage;
    stage_init(&stage);
    struct ref_world world = ref_world_make(&stage.scene, &stage.bvh, EFFECT_TRIANGLES | EFFECT_SPHERES);
    for (size_t i = 0; i < 2 * CASES; i++) {
        const bool any = i >= CASES;
        const size_t k = i % CASES;
        const struct ref_target target = {cases[k].target >= 0, (uint32_t)cases[k].target, cases[k].index};
        const struct resolve_ray question = {
            .o = {cases[k].from, 0, 0}, .d = {1, 0, 0}, .tmax = INFINITY, .self = RESOLVE_NO_SELF, .any = any, .target = target};
        struct resolve_answer answer;
        fixture_assert(resolve_rays(&answer, fixture_context(), &world, &question, 1));
        if (any) {
            assert_int_equal(answer.hit.object, cases[k].object >= 0 ? 0 : -1);
            continue;
        }
        assert_int_equal(answer.hit.object, cases[k].object);
        assert_int_equal(answer.hit.primitive, cases[k].primitive);
        assert_true(answer.hit.t == cases[k].t);
    }
    stage_finish(&stage);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(device_ignores_it),
        cmocka_unit_test(integers_ignore_it),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests_name("target", tests, NULL, fixture_close);
}
