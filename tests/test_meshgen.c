// The mesh generator: the committed files are what it makes, closed where they claim to be, with unit normals that point outward; and
// its arguments. The PLY reader here is the test's own. And scenes/: every one loads, and the demo's shadow tells the time.
#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene/scene.h"

#include <cmocka.h>

// ---------------------------------------------------------------------------------------------------------- running it

// Runs the generator, which stands beside the program; returns its exit code.
static int meshgen(const char *arguments) {
    static const char program[] = TEST_PROGRAM;
    char command[1024];
    int folder = (int)(strrchr(program, '/') - program);
    snprintf(command, sizeof command, "'%.*s/gnomon_meshgen' %s >/dev/null 2>&1", folder, program, arguments);
    int status = system(command);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

struct bytes {
    char *data;
    size_t size;
};

static struct bytes read_file(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("cannot open %s", path);
    struct bytes bytes = {NULL, 0};
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    bytes.size = (size_t)ftell(file);
    bytes.data = malloc(bytes.size + 1);
    assert_non_null(bytes.data);
    rewind(file);
    assert_int_equal(fread(bytes.data, 1, bytes.size, file), bytes.size);
    bytes.data[bytes.size] = '\0';
    fclose(file);
    return bytes;
}

// Makes a shape and reads the file back.
static struct bytes generate(const char *arguments) {
    static const char path[] = TEST_OUTPUT_DIR "/meshgen.out";
    char command[800];
    mkdir(TEST_OUTPUT_DIR, 0777);
    snprintf(command, sizeof command, "%s -o '%s'", arguments, path);
    if (meshgen(command) != 0) fail_msg("gnomon_meshgen %s failed", arguments);
    struct bytes bytes = read_file(path);
    remove(path);
    return bytes;
}

// -------------------------------------------------------------------------------------------------------------- meshes

struct mesh {
    uint32_t vertex_count, triangle_count;
    float *positions, *normals;
    uint32_t *indices;
};

static unsigned header_count(const char *header, const char *element) {
    const char *line = strstr(header, element);
    assert_non_null(line);
    return (unsigned)strtoul(line + strlen(element), NULL, 10);
}

// Takes the bytes over.
static struct mesh parse_ply(struct bytes bytes) {
    const char *end = strstr(bytes.data, "end_header\n");
    assert_non_null(end);
    const char *body = end + strlen("end_header\n");
    struct mesh mesh = {.vertex_count = header_count(bytes.data, "element vertex "),
                        .triangle_count = header_count(bytes.data, "element face ")};
    assert_int_equal(bytes.size - (size_t)(body - bytes.data), 24 * (size_t)mesh.vertex_count + 13 * (size_t)mesh.triangle_count);
    mesh.positions = malloc(12 * (size_t)mesh.vertex_count);
    mesh.normals = malloc(12 * (size_t)mesh.vertex_count);
    mesh.indices = malloc(12 * (size_t)mesh.triangle_count);
    assert_true(mesh.positions && mesh.normals && mesh.indices);
    for (uint32_t i = 0; i < mesh.vertex_count; i++, body += 24) {
        memcpy(mesh.positions + 3 * (size_t)i, body, 12);
        memcpy(mesh.normals + 3 * (size_t)i, body + 12, 12);
    }
    for (uint32_t i = 0; i < mesh.triangle_count; i++, body += 13) {
        assert_int_equal(body[0], 3);
        memcpy(mesh.indices + 3 * (size_t)i, body + 1, 12);
        for (int k = 0; k < 3; k++) assert_true(mesh.indices[3 * (size_t)i + (size_t)k] < mesh.vertex_count);
    }
    free(bytes.data);
    return mesh;
}

static void mesh_free(struct mesh *mesh) {
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->indices);
}

struct point {
    float p[3];
    uint32_t vertex;
};

static int compare_points(const void *a, const void *b) {
    const struct point *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->p[k] != y->p[k]) return x->p[k] < y->p[k] ? -1 : 1;
    return 0;
}

// Replaces each index by the lowest-numbered place in a sorted list of positions: vertices at one point become one.
static void weld(const struct mesh *mesh, uint32_t *out) {
    struct point *points = malloc(mesh->vertex_count * sizeof *points);
    uint32_t *place = malloc(mesh->vertex_count * sizeof *place);
    assert_true(points && place);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        memcpy(points[i].p, mesh->positions + 3 * (size_t)i, 12);
        points[i].vertex = i;
    }
    qsort(points, mesh->vertex_count, sizeof *points, compare_points);
    for (uint32_t i = 0, first = 0; i < mesh->vertex_count; i++) {
        if (compare_points(points + i, points + first) != 0) first = i;
        place[points[i].vertex] = first;
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) out[i] = place[mesh->indices[i]];
    free(points);
    free(place);
}

static int compare_edges(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

// How many directed edges do not occur exactly once, or lack their reverse: 0 for a closed, consistently wound manifold.
static size_t bad_edges(const struct mesh *mesh) {
    size_t count = 3 * (size_t)mesh->triangle_count, bad = 0;
    uint32_t *welded = malloc(count * sizeof *welded);
    uint64_t *edges = malloc(count * sizeof *edges);
    assert_true(welded && edges);
    weld(mesh, welded);
    for (size_t i = 0; i < count; i++) edges[i] = (uint64_t)welded[i] << 32 | welded[i % 3 == 2 ? i - 2 : i + 1];
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i++) {
        uint64_t reverse = edges[i] << 32 | edges[i] >> 32;
        if (reverse == edges[i] || (i && edges[i] == edges[i - 1]) || !bsearch(&reverse, edges, count, sizeof *edges, compare_edges)) bad++;
    }
    free(welded);
    free(edges);
    return bad;
}

static void load_triangle(const struct mesh *mesh, uint32_t triangle, double p[3][3]) {
    for (int k = 0; k < 9; k++)
        p[k / 3][k % 3] = mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)triangle + (size_t)k / 3] + (size_t)k % 3];
}

static void triangle_normal(const struct mesh *mesh, uint32_t triangle, double n[3]) {
    double p[3][3];
    load_triangle(mesh, triangle, p);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
    }
}

// Six times the enclosed volume: positive when the triangles are wound counter-clockwise seen from outside.
static double signed_volume(const struct mesh *mesh) {
    double sum = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        double p[3][3], n[3];
        load_triangle(mesh, i, p);
        triangle_normal(mesh, i, n);
        sum += p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2];
    }
    return sum;
}

// The largest |length − 1| of the vertex normals, and how many triangle corners have a normal at the triangle's back.
static double worst_length(const struct mesh *mesh) {
    double worst = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *n = mesh->normals + 3 * (size_t)i;
        double error = fabs(sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]) - 1);
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

static size_t backward_normals(const struct mesh *mesh) {
    size_t backward = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        double n[3];
        triangle_normal(mesh, i, n);
        for (int k = 0; k < 3; k++) {
            const float *v = mesh->normals + 3 * (size_t)mesh->indices[3 * (size_t)i + (size_t)k];
            if (!(n[0] * v[0] + n[1] * v[1] + n[2] * v[2] > 0)) backward++;
        }
    }
    return backward;
}

// ---------------------------------------------------------------------------------------------------------------- cases

struct shape_case {
    const char *arguments, *file;
    bool closed;
}; // file: of scenes/, or NULL where none is committed

static const struct shape_case shape_cases[] = {
    {"teapot", "meshes/teapot.ply", false},
    {"teapot -n 16", NULL, false},
    {"terrain", NULL, false},
    {"bumpy_sphere", "meshes/bumpy_sphere.ply", true},
    {"bumpy_sphere -n 6", "meshes/bumpy_sphere_coarse.ply", true},
    {"bumpy_sphere -n 1", NULL, true},
    {"bumpy_sphere -n 64 --seed 3", NULL, true},
    {"shell", "meshes/shell.ply", true},
    {"torus_knot", "meshes/torus_knot.ply", true},
    {"needles", "meshes/needles.ply", false},
    {"fan", "meshes/fan.ply", false},
    {"dial", "meshes/dial.ply", true},
    {"dial_marks", NULL, true},
    {"gnomon", "meshes/gnomon.ply", true},
    {"table", "meshes/table.ply", true},
    {"cup", "meshes/cup.ply", true},
    {"saucer", "meshes/saucer.ply", true},
    {"backdrop", "meshes/backdrop.ply", false},
};
#define SHAPE_CASES (sizeof shape_cases / sizeof *shape_cases)

static void assert_committed(const char *arguments, const char *file) {
    char path[600];
    snprintf(path, sizeof path, TEST_SOURCE_DIR "/scenes/%s", file);
    struct bytes made = generate(arguments), committed = read_file(path);
    if (made.size != committed.size || memcmp(made.data, committed.data, made.size) != 0)
        fail_msg("%s is not what 'gnomon_meshgen %s' makes", path, arguments);
    free(made.data);
    free(committed.data);
}

static void committed_files_are_what_the_generator_makes(void **state) {
    (void)state;
    for (size_t i = 0; i < SHAPE_CASES; i++)
        if (shape_cases[i].file) assert_committed(shape_cases[i].arguments, shape_cases[i].file);
    assert_committed("terrain --no-normals", "meshes/terrain.ply");
    assert_committed("dial_marks --no-normals", "meshes/dial_marks.ply");
    assert_committed("flake", "flake.json");
}

static void normals_are_unit_and_point_outward(void **state) {
    (void)state;
    for (size_t i = 0; i < SHAPE_CASES; i++) {
        struct mesh mesh = parse_ply(generate(shape_cases[i].arguments));
        double length = worst_length(&mesh);
        size_t backward = backward_normals(&mesh);
        if (!(length <= 2e-7)) fail_msg("%s: a normal is off unit length by %g", shape_cases[i].arguments, length);
        if (backward)
            fail_msg("%s: %zu of %u corners have a normal at the back", shape_cases[i].arguments, backward, 3 * mesh.triangle_count);
        mesh_free(&mesh);
    }
}

static void closed_shapes_are_closed(void **state) {
    (void)state;
    for (size_t i = 0; i < SHAPE_CASES; i++) {
        struct mesh mesh = parse_ply(generate(shape_cases[i].arguments));
        size_t bad = bad_edges(&mesh);
        double volume = signed_volume(&mesh);
        if ((bad == 0) != shape_cases[i].closed)
            fail_msg("%s: %zu of %u edges are bad", shape_cases[i].arguments, bad, 3 * mesh.triangle_count);
        if (shape_cases[i].closed && !(volume > 0)) fail_msg("%s: inside out, volume %g", shape_cases[i].arguments, volume / 6);
        mesh_free(&mesh);
    }
}

// The negative control: each way to spoil a closed mesh is noticed.
static void spoiled_meshes_are_noticed(void **state) {
    (void)state;
    struct mesh mesh = parse_ply(generate("bumpy_sphere -n 4"));
    assert_int_equal(bad_edges(&mesh), 0);
    mesh.triangle_count--;
    assert_int_equal(bad_edges(&mesh), 3);
    mesh.triangle_count++;
    uint32_t first = mesh.indices[0];
    mesh.indices[0] = mesh.indices[1];
    mesh.indices[1] = first;
    assert_true(bad_edges(&mesh) > 0);
    assert_true(backward_normals(&mesh) == 3);
    mesh.normals[0] *= 1.001f;
    assert_true(worst_length(&mesh) > 2e-7);
    mesh_free(&mesh);
}

// Extremes of Newell's control points that the surface touches, and its poles.
static void the_teapot_has_newells_measures(void **state) {
    (void)state;
    struct mesh mesh = parse_ply(generate("teapot -n 8"));
    double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
    unsigned poles = 0;
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        const float *p = mesh.positions + 3 * (size_t)i, *n = mesh.normals + 3 * (size_t)i;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], p[k]);
        }
        if (p[0] == 0 && p[2] == 0) {
            assert_true(n[0] == 0 && n[2] == 0 && n[1] == (p[1] > 1 ? 1.0f : -1.0f));
            poles++;
        }
    }
    assert_int_equal(poles, 2);
    const double expected[6] = {-3, 0, -2, 3.434, 3.15, 2};
    for (int k = 0; k < 6; k++)
        if (!(fabs((k < 3 ? low[k] : high[k - 3]) - expected[k]) < 0.002))
            fail_msg("bound %d is %g, not %g", k, k < 3 ? low[k] : high[k - 3], expected[k]);
    mesh_free(&mesh);
}

static void triangles_chooses_n(void **state) {
    (void)state;
    struct mesh mesh = parse_ply(generate("bumpy_sphere --triangles 2000 --seed 7"));
    assert_int_equal(mesh.triangle_count, 12 * 13 * 13);
    mesh_free(&mesh);
    struct bytes one = generate("bumpy_sphere -n 4 --seed 1"), same = generate("bumpy_sphere -n 4"),
                 other = generate("bumpy_sphere -n 4 --seed 2");
    assert_int_equal(one.size, other.size);
    assert_memory_equal(one.data, same.data, one.size);
    assert_memory_not_equal(one.data, other.data, one.size);
    free(one.data);
    free(same.data);
    free(other.data);
}

static void an_offset_moves_the_mesh(void **state) {
    (void)state;
    struct mesh here = parse_ply(generate("bumpy_sphere -n 3")), there = parse_ply(generate("bumpy_sphere -n 3 --offset 1000,-8,0.5"));
    const float offset[3] = {1000, -8, 0.5f};
    for (uint32_t i = 0; i < 3 * here.vertex_count; i++)
        assert_true(fabs(here.positions[i] + (double)offset[i % 3] - there.positions[i]) < 1e-4);
    mesh_free(&here);
    mesh_free(&there);
}

static void wrong_usage_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *arguments;
        int code;
    } rows[] = {
        {"--help", 0},
        {"", 2},
        {"dodecahedron -o x.ply", 2},
        {"teapot", 2},
        {"teapot -o", 2},
        {"teapot -n 0 -o x.ply", 2},
        {"teapot -n 12x -o x.ply", 2},
        {"teapot -n -3 -o x.ply", 2},
        {"teapot -n 99999999999999999999 -o x.ply", 2},
        {"teapot --seed 4294967296 -o x.ply", 2},
        {"teapot --offset 1,2 -o x.ply", 2},
        {"teapot --offset 1,2,nan -o x.ply", 2},
        {"teapot --wrong 1 -o x.ply", 2},
        {"fan --triangles 10 -o x.ply", 2},
        {"teapot -o /nowhere/at/all.ply", 8},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        int code = meshgen(rows[i].arguments);
        if (code != rows[i].code) fail_msg("gnomon_meshgen %s: exit code %d, not %d", rows[i].arguments, code, rows[i].code);
    }
    assert_int_not_equal(access("x.ply", F_OK), 0);
}

static struct scene load_scene(const char *path) {
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct scene scene;
    if (!scene_load(&scene, &ctx, path)) fail_msg("%s", error.message);
    return scene;
}

static void every_scene_loads(void **state) {
    (void)state;
    glob_t found;
    assert_int_equal(glob(TEST_SOURCE_DIR "/scenes/*.json", 0, NULL, &found), 0);
    assert_true(found.gl_pathc >= 15);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        struct scene scene = load_scene(found.gl_pathv[i]);
        assert_true(scene.shape_count > 0 && (scene.light_count > 0 || scene.environment.width > 0));
        scene_finish(&scene);
    }
    globfree(&found);
}

// How far, as the sine of an angle, the first light of the demo is from the plane of the style and the line of an hour.
static double off_hour_plane(const struct scene *demo, double hour) {
    const double pi = 3.14159265358979323846, latitude = 50 * pi / 180, angle = hour * pi / 12;
    const double style[3] = {0, sin(latitude), -cos(latitude)}, line[3] = {sin(latitude) * sin(angle), 0, -cos(angle)},
                 foot[3] = {0, 0, 0.3};
    double sun[3], normal[3], product = 0, lengths[2] = {0, 0};
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        sun[k] = demo->lights[0].position[k] - foot[k];
        normal[k] = style[i] * line[j] - style[j] * line[i];
        product += sun[k] * normal[k];
        lengths[0] += sun[k] * sun[k];
        lengths[1] += normal[k] * normal[k];
    }
    return fabs(product) / sqrt(lengths[0] * lengths[1]);
}

static void the_demo_shows_five_o_clock(void **state) {
    (void)state;
    struct scene demo = load_scene(TEST_SOURCE_DIR "/scenes/demo.json");
    assert_true(off_hour_plane(&demo, 5) < 0.002);
    assert_true(off_hour_plane(&demo, 5.1) > 0.01);
    scene_finish(&demo);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(committed_files_are_what_the_generator_makes),
        cmocka_unit_test(normals_are_unit_and_point_outward),
        cmocka_unit_test(closed_shapes_are_closed),
        cmocka_unit_test(spoiled_meshes_are_noticed),
        cmocka_unit_test(the_teapot_has_newells_measures),
        cmocka_unit_test(triangles_chooses_n),
        cmocka_unit_test(an_offset_moves_the_mesh),
        cmocka_unit_test(wrong_usage_is_refused),
        cmocka_unit_test(every_scene_loads),
        cmocka_unit_test(the_demo_shows_five_o_clock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
