// Scenes: what a good file becomes, defaults, derived fields, models on their own.
#include "scratch.h"

#include <float.h>
#include <math.h>

#include "scene/bounds.h"
#include "scene/build.h"
#include "scene/frame.h"
#include "scene/mesh.h"
#include "scene/scene.h"

#define QUAD "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

// Loads a text as a file of this name.
static struct scene load_text(const char *name, const char *text) {
    struct scene scene;
    const char *path = scratch_file(name, text, strlen(text));
    scratch_assert(scene_load(&scene, scratch_context(), path));
    return scene;
}

static void assert_float3(const float a[3], double x, double y, double z) {
    if (!(a[0] == (float)x && a[1] == (float)y && a[2] == (float)z))
        fail_msg("(%.9g, %.9g, %.9g), expected (%.9g, %.9g, %.9g)", (double)a[0], (double)a[1], (double)a[2], x, y, z);
}

// The example of the format's description.
static void every_key_counts(void **state) {
    (void)state;
    scratch_file("part.obj", QUAD "f 1 2 3 4\n", strlen(QUAD "f 1 2 3 4\n"));
    struct scene s = load_text(
        "a.json",
        "{\"version\": 1.0, \"camera\": {\"position\": [1,2,3], \"look_at\": [4,5,6], \"up\": [0,0,1], \"fov_y_deg\": 90},"
        "\"film\": {\"width\": 640, \"height\": 65535, \"spp\": 16777216, \"transfer\": \"linear\"}, \"background\": [0.1,0.2,0.3],"
        "\"ambient\": [0.4,0.5,0.6], \"shadows\": false,"
        "\"materials\": {\"red\": {\"ambient\": [1,0,0], \"diffuse\": [0.5,0,0], \"specular\": [0,1,0], \"shininess\": 0}, \"plain\": {},"
        " \"blue\": {\"diffuse\": [0,0,7]}},"
        "\"lights\": [{\"type\": \"point\", \"position\": [-10,10,4]},"
        " {\"type\": \"point\", \"position\": [0,0,100000000000000000000], \"intensity\": [0,8,16777217], \"falloff\": "
        "\"inverse_square\"}],"
        "\"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,-3], \"radius\": 1e-40, \"material\": \"blue\"},"
        " {\"type\": \"triangle\", \"vertices\": [[-1,-1,-3.5],[1,1,-3],[0.75,-1,-2.5]], \"material\": \"red\"},"
        " {\"type\": \"mesh\", \"file\": \"part.obj\", \"material\": \"plain\", \"transform\": "
        "[[0,-1,0,0],[1,0,0,0],[0,0,1,0.1],[0,0,0,1]]}]}");
    assert_float3(s.camera.position, 1, 2, 3);
    assert_float3(s.camera.look_at, 4, 5, 6);
    assert_float3(s.camera.up, 0, 0, 1);
    assert_true(s.camera.fov_y_deg == 90);
    assert_true(s.film.width == 640 && s.film.height == 65535 && s.film.spp == 16777216 && s.film.transfer == TRANSFER_LINEAR);
    assert_float3(s.background, 0.1, 0.2, 0.3);
    assert_float3(s.ambient, 0.4, 0.5, 0.6);
    assert_false(s.shadows);
    assert_int_equal(s.material_count, 3);
    assert_string_equal(s.materials[0].name, "red");
    assert_float3(s.materials[0].ambient, 1, 0, 0);
    assert_float3(s.materials[0].diffuse, 0.5, 0, 0);
    assert_float3(s.materials[0].specular, 0, 1, 0);
    assert_true(s.materials[0].shininess == 0);
    assert_float3(s.materials[1].ambient, 0.8, 0.8, 0.8);
    assert_float3(s.materials[1].specular, 0, 0, 0);
    assert_true(s.materials[1].shininess == 32);
    assert_float3(s.materials[2].ambient, 0, 0, 7); // as diffuse
    assert_int_equal(s.light_count, 2);
    assert_float3(s.lights[0].intensity, 1, 1, 1);
    assert_int_equal(s.lights[0].falloff, FALLOFF_NONE);
    assert_float3(s.lights[1].position, 0, 0, 1e20);
    assert_float3(s.lights[1].intensity, 0, 8, 16777216);
    assert_int_equal(s.lights[1].falloff, FALLOFF_INVERSE_SQUARE);
    assert_int_equal(s.shape_count, 3);
    assert_true(s.shapes[0].type == SHAPE_SPHERE && s.shapes[0].radius == 1e-40f && s.shapes[0].material == 2);
    assert_true(s.shapes[1].type == SHAPE_TRIANGLE && s.shapes[1].material == 0);
    assert_float3(s.shapes[1].mesh.positions + 6, 0.75, -1, -2.5);
    assert_true(s.shapes[2].type == SHAPE_MESH && s.shapes[2].material == 1);
    assert_float3(s.shapes[2].mesh.positions + 3, 0, 1, 0.1);
    scene_finish(&s);
}

static void defaults_are_as_described(void **state) {
    (void)state;
    struct scene s = load_text("a.json", "\xef\xbb\xbf\n{\"version\": 1}");
    assert_true(s.film.width == 512 && s.film.height == 512 && s.film.spp == 1 && s.film.transfer == TRANSFER_SRGB && s.shadows);
    assert_float3(s.background, 0, 0, 0);
    assert_float3(s.ambient, 0, 0, 0);
    assert_true(s.shape_count == 0 && s.material_count == 0 && s.light_count == 0);
    assert_true(scene_triangle_count(&s) == 0 && scene_sphere_count(&s) == 0);
    assert_true(s.bounds_min[0] > s.bounds_max[0]);
    assert_true(s.camera.fov_y_deg > 0 && s.camera.position[2] > 0); // there is always a camera
    scene_finish(&s);
}

static void shapes_without_material_get_the_default(void **state) {
    (void)state;
    struct scene s = load_text(
        "a.json",
        "{\"version\": 1, \"materials\": {\"m\": {}}, \"shapes\": ["
        "{\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1}, {\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 2}]}");
    assert_int_equal(s.material_count, 2);
    assert_string_equal(s.materials[1].name, "default");
    assert_true(s.shapes[0].material == 1 && s.shapes[1].material == 1);
    scene_finish(&s);
    s = load_text("a.json", "{\"version\": 1, \"materials\": {\"default\": {\"diffuse\": [1,0,0]}}, \"shapes\": ["
                            "{\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1}]}");
    assert_int_equal(s.material_count, 1); // the scene's own
    scene_finish(&s);
}

static void meshes_bring_their_materials(void **state) {
    (void)state;
    const char library[] = "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n",
               two[] = "mtllib m.mtl\n" QUAD "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n", one[] = "mtllib m.mtl\n" QUAD "usemtl b\nf 1 2 3\n";
    scratch_file("m.mtl", library, strlen(library));
    scratch_file("two.obj", two, strlen(two));
    scratch_file("one.obj", one, strlen(one));
    struct scene s = load_text(
        "a.json", "{\"version\": 1, \"materials\": {\"a\": {}}, \"shapes\": [{\"type\": \"mesh\", \"file\": \"two.obj\"},"
                  "{\"type\": \"mesh\", \"file\": \"one.obj\"}, {\"type\": \"mesh\", \"file\": \"two.obj\", \"material\": \"a\"}]}");
    assert_int_equal(s.material_count, 4); // the scene's, two, one
    assert_int_equal(scene_triangle_at(&s, 0).material, 1);
    assert_int_equal(scene_triangle_at(&s, 1).material, 2);
    assert_int_equal(scene_triangle_at(&s, 2).material, 3);
    assert_int_equal(scene_triangle_at(&s, 3).material, 0);
    assert_float3(s.materials[2].diffuse, 0, 1, 0);
    assert_float3(s.materials[3].diffuse, 0, 1, 0);
    scene_finish(&s);
}

static void normals_are_as_asked_for(void **state) {
    (void)state;
    const char plain[] = QUAD "f 1 2 3 4\n", normal[] = QUAD "vn 0 1 1\nf 1//1 2//1 3//1 4//1\n";
    scratch_file("plain.obj", plain, strlen(plain));
    scratch_file("normal.obj", normal, strlen(normal));
    static const struct {
        const char *file, *normals;
        bool there;
        float z;
    } cases[] = {
        {"plain.obj", "", false, 0},
        {"plain.obj", ", \"normals\": \"file\"", false, 0},
        {"plain.obj", ", \"normals\": \"smooth\"", true, 1},
        {"normal.obj", "", true, 1},
        {"normal.obj", ", \"normals\": \"flat\"", false, 0},
        {"normal.obj", ", \"normals\": \"smooth\"", true, 1},
        {"normal.obj", ", \"transform\": [[1,0,0,0],[0,1,0,0],[0,0,2,0],[0,0,0,1]]", true, 0.5f}, // z is stretched: the normal falls
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(text, sizeof text, "{\"version\": 1, \"shapes\": [{\"type\": \"mesh\", \"file\": \"%s\"%s}]}", cases[i].file,
                 cases[i].normals);
        struct scene s = load_text("a.json", text);
        const float *n = s.shapes[0].mesh.normals;
        if ((n != NULL) != cases[i].there || (n && n[2] != cases[i].z)) fail_msg("case %zu: %g", i, n ? (double)n[2] : -1.0);
        scene_finish(&s);
    }
}

static void numbers_lead_to_shapes(void **state) {
    (void)state;
    scratch_file("part.obj", QUAD "f 1 2 3 4\n", strlen(QUAD "f 1 2 3 4\n"));
    struct scene s = load_text(
        "a.json", "{\"version\": 1, \"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1},"
                  "{\"type\": \"mesh\", \"file\": \"part.obj\"}, {\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1},"
                  "{\"type\": \"triangle\", \"vertices\": [[7,0,0],[8,0,0],[9,0,0]]}, {\"type\": \"mesh\", \"file\": \"part.obj\"}]}");
    static const uint32_t triangles[] = {0, 0, 2, 2, 3, 5}, spheres[] = {0, 1, 1, 2, 2, 2};
    assert_memory_equal(s.first_triangle, triangles, sizeof triangles);
    assert_memory_equal(s.first_sphere, spheres, sizeof spheres);
    static const uint32_t objects[] = {1, 1, 3, 4, 4}, primitives[] = {0, 1, 0, 0, 1};
    for (uint32_t i = 0; i < 5; i++) {
        const struct scene_triangle t = scene_triangle_at(&s, i);
        assert_int_equal(t.object, objects[i]);
        assert_int_equal(t.primitive, primitives[i]);
    }
    assert_float3(scene_triangle_at(&s, 2).v[1], 8, 0, 0);
    assert_float3(scene_triangle_at(&s, 4).v[2], 0, 1, 0);
    assert_int_equal(scene_triangle_at(&s, 4).vertex[1], 2);
    assert_int_equal(scene_sphere_object(&s, 0), 0);
    assert_int_equal(scene_sphere_object(&s, 1), 2);
    scene_finish(&s);
}

static void bounds_go_outward(void **state) {
    (void)state;
    static const struct {
        float center, radius, low, high;
    } cases[] = {
        {0, 1, -1, 1},
        {1, 0x1p-30f, 0x1.fffffep-1f, 0x1.000002p0f},
        {0.1f, 0.2f, -0x1.99999ap-4f, 0x1.333334p-2f}, // -0.1 exactly; 0.3 is between two floats
        {1, 0x1p-149f, 0x1.fffffep-1f, 0x1.000002p0f}, // fp64 loses this radius
        {3e38f, 3e38f, 0, FLT_MAX},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct scene_shape shape = {.type = SHAPE_SPHERE, .center = {cases[i].center, 0, -cases[i].center}, .radius = cases[i].radius};
        struct scene s = {.shapes = &shape, .shape_count = 1};
        scene_bounds(&s);
        if (s.bounds_min[0] != cases[i].low || s.bounds_max[0] != cases[i].high || s.bounds_min[2] != -cases[i].high ||
            s.bounds_max[2] != -cases[i].low)
            fail_msg("case %zu: %a to %a", i, (double)s.bounds_min[0], (double)s.bounds_max[0]);
    }
    struct scene s = load_text("a.obj", QUAD "v 99 99 99\nf 1 2 3\n"); // a stray vertex does not count
    assert_float3(s.bounds_min, 0, 0, 0);
    assert_float3(s.bounds_max, 1, 1, 0);
    scene_finish(&s);
}

static void there_is_a_limit(void **state) {
    (void)state;
    struct scene_shape shapes[2] = {{.type = SHAPE_MESH, .mesh = {.triangle_count = MOST_PRIMITIVES}},
                                    {.type = SHAPE_MESH, .mesh = {.triangle_count = 1}}};
    struct scene s = {.path = "big.json", .shapes = shapes, .shape_count = 2};
    scratch_assert_fails(scene_derive(&s, scratch_context()), GN_LIMIT, "big.json: the scene has more than 67108863 triangles");
    free(s.first_triangle);
    free(s.first_sphere);
}

// ------------------------------------------------------------------------------------------------------------------ framing

// The ball's apparent half angle and its distance from the middle of the view, in degrees.
static void ball_in_view(const struct scene *s, double *half, double *off) {
    const struct scene_ball ball = scene_ball(s);
    double to_ball[3], view[3], a = 0, b = 0, c = 0;
    for (int i = 0; i < 3; i++) {
        to_ball[i] = ball.center[i] - s->camera.position[i], view[i] = (double)s->camera.look_at[i] - s->camera.position[i];
        a += to_ball[i] * to_ball[i], b += view[i] * view[i], c += to_ball[i] * view[i];
    }
    *half = asin(fmin(1, ball.radius / sqrt(a))) * 180 / acos(-1);
    *off = acos(fmin(1, c / sqrt(a * b))) * 180 / acos(-1);
}

static void models_are_in_view(void **state) {
    (void)state;
    static const char *const vertices[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n",
        "v 0 0 0\nv 1e-30 0 0\nv 0 1e-30 0\nv 0 0 1e-30\n",
        "v 0 0 0\nv 1e36 0 0\nv 0 1e36 0\nv 0 0 1e36\n",
        "v 1e7 1e7 0\nv 10000001 1e7 0\nv 1e7 10000001 0\nv 1e7 1e7 1\n",
    };
    for (size_t i = 0; i < sizeof vertices / sizeof *vertices; i++) {
        char text[256];
        double half, off;
        snprintf(text, sizeof text, "%sf 1 2 3\nf 1 2 4\n", vertices[i]);
        struct scene s = load_text("a.obj", text);
        ball_in_view(&s, &half, &off);
        if (!(half + off < 0.5 * s.camera.fov_y_deg)) fail_msg("model %zu: %g° and %g° off", i, half, off);
        if (i < 3 && !(half > 0.4 * s.camera.fov_y_deg)) fail_msg("model %zu is too small: %g°", i, half);
        scene_finish(&s);
    }
    struct scene s;
    const char huge[] = "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n";
    scratch_assert_fails(scene_load(&s, scratch_context(), scratch_file("a.obj", huge, strlen(huge))), GN_SCENE, "too large to frame");
    s = load_text("a.obj", "v 5 5 5\nf 1 1 1\n"); // no size at all
    assert_true(s.camera.position[2] > 5);
    scene_finish(&s);
}

static void models_are_lit(void **state) {
    (void)state;
    struct scene s = load_text("a.obj", QUAD "f 1 2 3 4\n");
    assert_int_equal(s.light_count, 2);
    assert_true(s.lights[0].intensity[0] > s.lights[1].intensity[0] && s.lights[0].falloff == FALLOFF_NONE);
    assert_true(s.lights[0].position[1] > s.camera.position[1]); // key light: above, and on the left of the view
    double left = 0;
    const double view[3] = {(double)s.camera.look_at[0] - s.camera.position[0], 0, (double)s.camera.look_at[2] - s.camera.position[2]};
    left = view[2] * ((double)s.lights[0].position[0] - s.camera.look_at[0]) -
           view[0] * ((double)s.lights[0].position[2] - s.camera.look_at[2]);
    assert_true(left > 0);
    assert_true(s.background[0] > 0 && s.ambient[0] > 0 && s.shapes[0].mesh.normals != NULL);
    assert_string_equal(s.materials[0].name, "default");
    scene_finish(&s);
    const char stl[] = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n";
    s = load_text("a.stl", stl);
    assert_float3(s.camera.up, 0, 0, 1); // z is up
    assert_true(s.camera.position[1] < 0);
    scene_finish(&s);
}

static void exposure_keeps_ratios(void **state) {
    (void)state;
    struct scene_light lights[3] = {
        {.position = {0, 0, 10}, .intensity = {54000, 27000, 0}, .falloff = FALLOFF_INVERSE_SQUARE},
        {.position = {20, 0, 0}, .intensity = {0, 54000, 0}, .falloff = FALLOFF_INVERSE_SQUARE},
        {.position = {0, 0, 0.1f}, .intensity = {1, 1, 1}, .falloff = FALLOFF_INVERSE_SQUARE}, // inside: as from the surface
    };
    const struct scene_ball ball = {.center = {0, 0, 0}, .radius = 1};
    frame_exposure(lights, 3, &ball);
    assert_true(fabs(lights[0].intensity[0] / 100.0 + lights[1].intensity[1] / 400.0 + lights[2].intensity[0] - 1) < 1e-6);
    assert_true(fabs(lights[0].intensity[0] / (double)lights[1].intensity[1] - 1) < 1e-6 && lights[0].intensity[0] > 10);
    struct scene_light dark = {.intensity = {0, 0, 0}};
    frame_exposure(&dark, 1, &ball);
    assert_float3(dark.intensity, 0, 0, 0);
}

// ---------------------------------------------------------------------------------------------------------------- the caller

static bool refuse(void *user, const struct gn_progress *progress) {
    assert_string_equal(progress->stage, "scene");
    assert_true(progress->fraction >= 0 && progress->fraction <= 1);
    return ++*(int *)user < 3;
}

static void loading_can_be_cancelled(void **state) {
    (void)state;
    const char *path = scratch_file("a.json", "{\"version\": 1, \"shapes\": []}", strlen("{\"version\": 1, \"shapes\": []}"));
    int asked = 0;
    struct gn_error error;
    struct gn_host host = {.user = &asked, .progress = refuse};
    struct context ctx = context_make(&host, &error);
    struct scene s;
    assert_true(scene_load(&s, &ctx, path)); // asks twice
    scene_finish(&s);
    path = scratch_file("a.obj", QUAD "f 1 2 3 4\n", strlen(QUAD "f 1 2 3 4\n"));
    ctx = context_make(&host, &error);
    assert_false(scene_load(&s, &ctx, path));
    assert_int_equal(error.status, GN_CANCELLED);
    assert_null(s.path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_counts),
        cmocka_unit_test(defaults_are_as_described),
        cmocka_unit_test(shapes_without_material_get_the_default),
        cmocka_unit_test(meshes_bring_their_materials),
        cmocka_unit_test(normals_are_as_asked_for),
        cmocka_unit_test(numbers_lead_to_shapes),
        cmocka_unit_test(bounds_go_outward),
        cmocka_unit_test(there_is_a_limit),
        cmocka_unit_test(models_are_in_view),
        cmocka_unit_test(models_are_lit),
        cmocka_unit_test(exposure_keeps_ratios),
        cmocka_unit_test(loading_can_be_cancelled),
    };
    return cmocka_run_group_tests_name("scenes", tests, scratch_open, scratch_close);
}
