// The boxes of a scene's primitives, seen through the hierarchy over them: spheres against exact sums (MPFR), triangles against their
// vertices.
#include <float.h>
#include <math.h>
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Ours before cmocka's: that has a macro called fail.
#include "bvh/scene_boxes.h"

#include <cmocka.h>

// splitmix64 (Steele, Lea, Flood 2014).
static uint64_t random_bits(uint64_t *state) {
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static struct bvh built(const struct scene *scene) {
    struct gn_error error;
    struct context ctx = context_make(&(struct gn_host){.threads = 2}, &error);
    struct bvh bvh;
    if (!bvh_build_scene(&bvh, &ctx, scene)) fail_msg("%s", error.message);
    return bvh;
}

// ---- spheres ----

// The box of one sphere, which is the root's.
static struct bvh_box sphere_box(float x, float y, float z, float radius) {
    struct scene_shape shape = {.type = SHAPE_SPHERE, .center = {x, y, z}, .radius = radius};
    uint32_t first_triangle[] = {0, 0}, first_sphere[] = {0, 1};
    struct scene scene = {.shapes = &shape, .shape_count = 1, .first_triangle = first_triangle, .first_sphere = first_sphere};
    struct bvh bvh = built(&scene);
    assert_int_equal(bvh.node_count, 1);
    struct bvh_box box;
    memcpy(box.min, bvh.nodes[0].min, sizeof box.min);
    memcpy(box.max, bvh.nodes[0].max, sizeof box.max);
    bvh_finish(&bvh);
    return box;
}

// Whether `bound` is the least float that is not below center + radius (or, with sign -1, the greatest not above center - radius).
static bool is_tight(float bound, float center, float radius, int sign) {
    mpfr_t sum;
    mpfr_init2(sum, 320); // enough for any sum of two floats to be exact
    mpfr_set_flt(sum, center, MPFR_RNDN);
    mpfr_t r;
    mpfr_init2(r, 320);
    mpfr_set_flt(r, radius, MPFR_RNDN);
    assert_int_equal(sign > 0 ? mpfr_add(sum, sum, r, MPFR_RNDN) : mpfr_sub(sum, sum, r, MPFR_RNDN), 0);
    float inside = nextafterf(bound, sign > 0 ? -INFINITY : INFINITY);
    mpfr_set_flt(r, bound, MPFR_RNDN);
    bool holds = sign * mpfr_cmp(r, sum) >= 0;
    mpfr_set_flt(r, inside, MPFR_RNDN);
    bool tight = sign * mpfr_cmp(r, sum) < 0;
    mpfr_clears(sum, r, (mpfr_ptr)NULL);
    return holds && tight;
}

static const float nasty[] = {
    0.0f,          -0.0f,           1,        -1,       3,         0x1p-149f, -0x1p-149f, 0x1p-126f, 0x1.fffffep-127f, 0x1p-30f, 0x1p-24f,
    0x1.000002p0f, 0x1p-23f,        1e-3f,    1e10f,    -1e10f,    1e30f,     -1e30f,     0x1p53f,   0x1p54f,          0x1p60f,  FLT_MAX,
    -FLT_MAX,      0x1.fffffcp127f, 0x1p103f, 0x1p102f, -0x1p103f, 0x1.8p103f};
#define NASTY_COUNT (sizeof nasty / sizeof nasty[0])

static void test_nasty_spheres(void **unused) {
    (void)unused;
    uint32_t naive_wrong = 0, infinite = 0;
    for (size_t i = 0; i < NASTY_COUNT; i++) {
        for (size_t j = 0; j < NASTY_COUNT; j++) {
            float center = nasty[i], radius = nasty[j];
            if (!(radius > 0)) continue;
            struct bvh_box box = sphere_box(center, -center, 0, radius);
            assert_true(is_tight(box.min[0], center, radius, -1) && is_tight(box.max[0], center, radius, 1));
            assert_true(is_tight(box.min[1], -center, radius, -1) && is_tight(box.max[1], -center, radius, 1));
            assert_true(box.min[2] == -radius && box.max[2] == radius);
            naive_wrong += !is_tight((float)((double)center + (double)radius), center, radius, 1);
            infinite += isinf(box.max[0]) || isinf(box.min[0]);
        }
    }
    assert_true(naive_wrong > 50 && infinite > 5);
}

static float random_float(uint64_t *state, int exponent_range) {
    uint64_t bits = random_bits(state);
    float mantissa = 1 + (float)(bits & 0x7fffff) * 0x1p-23f;
    return ldexpf(bits >> 63 ? -mantissa : mantissa, (int)(bits >> 32 & 0xffff) % exponent_range - exponent_range / 2);
}

static void test_random_spheres(void **unused) {
    (void)unused;
    static const int ranges[] = {4, 30, 80, 254};
    uint64_t state = 1;
    for (int i = 0; i < 20000; i++) {
        int range = ranges[i % 4];
        float x = random_float(&state, range), y = random_float(&state, range), z = random_float(&state, range);
        float radius = fabsf(random_float(&state, range)), center[3] = {x, y, z};
        struct bvh_box box = sphere_box(x, y, z, radius);
        for (int axis = 0; axis < 3; axis++)
            assert_true(is_tight(box.min[axis], center[axis], radius, -1) && is_tight(box.max[axis], center[axis], radius, 1));
    }
}

// ---- scenes of several shapes ----

#define TRIANGLES 20000u // of the large mesh: several pieces of work
#define VERTICES 500u

static float *random_positions(uint64_t *state) {
    float *positions = malloc(3 * VERTICES * sizeof *positions);
    assert_non_null(positions);
    for (uint32_t i = 0; i < 3 * VERTICES; i++) positions[i] = random_float(state, 8);
    return positions;
}

static struct scene_mesh random_mesh(uint32_t triangle_count, uint64_t *state) {
    struct scene_mesh mesh = {.positions = random_positions(state), .vertex_count = VERTICES, .triangle_count = triangle_count};
    mesh.indices = malloc(3 * (size_t)(triangle_count + 1) * sizeof *mesh.indices);
    assert_non_null(mesh.indices);
    for (uint32_t i = 0; i < 3 * triangle_count; i++) mesh.indices[i] = (uint32_t)(random_bits(state) % VERTICES);
    return mesh;
}

static struct bvh_box vertices_box(const struct scene_mesh *mesh, uint32_t triangle) {
    struct bvh_box box;
    for (int axis = 0; axis < 3; axis++) {
        float a = mesh->positions[3 * mesh->indices[3 * triangle] + (uint32_t)axis];
        float b = mesh->positions[3 * mesh->indices[3 * triangle + 1] + (uint32_t)axis];
        float c = mesh->positions[3 * mesh->indices[3 * triangle + 2] + (uint32_t)axis];
        box.min[axis] = fminf(a, fminf(b, c));
        box.max[axis] = fmaxf(a, fmaxf(b, c));
    }
    return box;
}

// Triangles of each shape; -1 for a sphere.
static const struct {
    const char *name;
    int count;
    int shapes[8];
} mixtures[] = {
    {"a triangle", 1, {1}},
    {"spheres only", 3, {-1, -1, -1}},
    {"a mesh between spheres", 3, {-1, TRIANGLES, -1}},
    {"spheres between meshes", 5, {TRIANGLES, -1, -1, TRIANGLES, 1}},
    {"empty meshes", 8, {0, 0, 5, 0, -1, 0, 1, 0}},
    {"empty meshes only", 2, {0, 0}},
    {"a sphere after empty meshes", 3, {0, 0, -1}},
};

struct built_scene {
    struct scene scene;
    struct scene_shape shapes[8];
    uint32_t first_triangle[9], first_sphere[9];
    struct bvh_box *boxes; // what they should be: triangles, then spheres
};

static void scene_make(struct built_scene *out, size_t mixture, uint64_t *state) {
    memset(out, 0, sizeof *out);
    out->boxes = malloc((2 * TRIANGLES + 16) * sizeof *out->boxes);
    assert_non_null(out->boxes);
    int count = mixtures[mixture].count;
    for (int i = 0; i < count; i++) {
        struct scene_shape *shape = &out->shapes[i];
        int triangles = mixtures[mixture].shapes[i];
        *shape = (struct scene_shape){.type = triangles < 0 ? SHAPE_SPHERE : triangles == 1 ? SHAPE_TRIANGLE : SHAPE_MESH};
        if (triangles < 0)
            shape->radius = 0.5f + (float)i;
        else
            shape->mesh = random_mesh((uint32_t)triangles, state);
        out->first_triangle[i + 1] = out->first_triangle[i] + shape->mesh.triangle_count;
        out->first_sphere[i + 1] = out->first_sphere[i] + (triangles < 0);
        for (uint32_t t = 0; t < shape->mesh.triangle_count; t++) out->boxes[out->first_triangle[i] + t] = vertices_box(&shape->mesh, t);
    }
    for (int i = 0; i < count; i++) {
        float r = out->shapes[i].radius;
        if (r > 0) out->boxes[out->first_triangle[count] + out->first_sphere[i]] = (struct bvh_box){{-r, -r, -r}, {r, r, r}};
    }
    out->scene = (struct scene){
        .shapes = out->shapes, .shape_count = (uint32_t)count, .first_triangle = out->first_triangle, .first_sphere = out->first_sphere};
}

static void scene_free(struct built_scene *built_scene) {
    for (int i = 0; i < 8; i++) {
        free(built_scene->shapes[i].mesh.positions);
        free(built_scene->shapes[i].mesh.indices);
    }
    free(built_scene->boxes);
}

static void test_mixtures(void **unused) {
    (void)unused;
    uint64_t state = 2;
    for (size_t i = 0; i < sizeof mixtures / sizeof mixtures[0]; i++) {
        struct built_scene made;
        scene_make(&made, i, &state);
        uint32_t triangles = made.first_triangle[made.scene.shape_count], spheres = made.first_sphere[made.scene.shape_count];
        struct bvh_params params = {.split_at = triangles};
        struct bvh bvh = built(&made.scene);
        char why[256] = "";
        assert_int_equal(bvh.primitive_count, triangles + spheres);
        if (!bvh_check(&bvh, made.boxes, &params, why, sizeof why)) fail_msg("%s: %s", mixtures[i].name, why);
        if (triangles > 0) made.boxes[triangles / 2].max[1] += 1;
        if (triangles > 0) assert_false(bvh_check(&bvh, made.boxes, &params, why, sizeof why));
        bvh_finish(&bvh);
        scene_free(&made);
    }
}

static void test_no_shapes(void **unused) {
    (void)unused;
    struct scene scene = {0};
    struct bvh bvh = built(&scene);
    assert_int_equal(bvh.node_count, 0);
    bvh_finish(&bvh);
}

static bool refuse(void *user, const struct gn_progress *state) {
    (void)user, (void)state;
    return false;
}

static void test_cancelled(void **unused) {
    (void)unused;
    uint64_t state = 3;
    struct built_scene made;
    struct gn_error error;
    struct context ctx = context_make(&(struct gn_host){.progress = refuse}, &error);
    struct bvh bvh;
    scene_make(&made, 2, &state);
    assert_false(bvh_build_scene(&bvh, &ctx, &made.scene));
    assert_int_equal(error.status, GN_CANCELLED);
    assert_int_equal(bvh.node_count, 0);
    scene_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nasty_spheres), cmocka_unit_test(test_random_spheres), cmocka_unit_test(test_mixtures),
        cmocka_unit_test(test_no_shapes),     cmocka_unit_test(test_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
