// The scene format beyond shapes of plain materials: what each key becomes, and what is said of each that makes no sense.
#include "scratch.h"

#include <math.h>
#include <spng.h>

#include "scene/scene.h"

#define QUAD "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
#define TINTED "mtllib t.mtl\nusemtl t\n" QUAD
#define LIBRARY "newmtl t\nKd 1 0 0\n"

// A picture of 2 × 1 pixels: red, and half transparent blue-ish.
static void write_png(const char *name) {
    static const unsigned char pixels[8] = {255, 0, 0, 255, 10, 20, 200, 128};
    spng_ctx *png = spng_ctx_new(SPNG_CTX_ENCODER);
    struct spng_ihdr ihdr = {.width = 2, .height = 1, .bit_depth = 8, .color_type = SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
    size_t size;
    int error;
    assert_int_equal(spng_set_option(png, SPNG_ENCODE_TO_BUFFER, 1), 0);
    assert_int_equal(spng_set_ihdr(png, &ihdr), 0);
    assert_int_equal(spng_encode_image(png, pixels, sizeof pixels, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE), 0);
    void *bytes = spng_get_png_buffer(png, &size, &error);
    scratch_file(name, bytes, size);
    free(bytes);
    spng_ctx_free(png);
}

#define HDR "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x00\xff\x00\x80" // (1, 0.5, 0.25), (0, 0.996, 0)

static void helpers(void) {
    write_png("a.png");
    scratch_file("sky.hdr", HDR, sizeof HDR - 1);
    scratch_file("cut.hdr", HDR, sizeof HDR - 2);
    scratch_file("text.png", "hello", 5);
    scratch_file("quad.obj", QUAD, strlen(QUAD));
    scratch_file("tinted.obj", TINTED, strlen(TINTED));
    scratch_file("t.mtl", LIBRARY, strlen(LIBRARY));
}

// Loads a scene of these members.
static struct scene load(const char *members) {
    static char text[8192];
    struct scene scene;
    snprintf(text, sizeof text, "{\"version\": 1, %s}", members);
    scratch_assert(scene_load(&scene, scratch_context(), scratch_file("a.json", text, strlen(text))));
    return scene;
}

static void assert_float3(const float a[3], double x, double y, double z) {
    if (!(a[0] == (float)x && a[1] == (float)y && a[2] == (float)z))
        fail_msg("(%.9g, %.9g, %.9g), expected (%.9g, %.9g, %.9g)", (double)a[0], (double)a[1], (double)a[2], x, y, z);
}

// -------------------------------------------------------------------------------------------------------------------- view

static void cameras_have_lenses_and_move(void **state) {
    (void)state;
    struct scene s = load("\"camera\": {\"position\": [0,0,5], \"look_at\": [0,3,1], \"lens_radius\": 0.1}");
    assert_true(s.camera.lens_radius == 0.1f && s.camera.focus_distance == 5); // sharp where it looks
    assert_false(s.camera.moves);
    assert_float3(s.camera.position_end, 0, 0, 5);
    assert_float3(s.camera.look_at_end, 0, 3, 1);
    scene_finish(&s);
    s = load("\"camera\": {\"position\": [0,0,5], \"look_at\": [0,0,0], \"focus_distance\": 2, \"motion\": {\"position\": [1,0,5]}}");
    assert_true(s.camera.lens_radius == 0 && s.camera.focus_distance == 2 && s.camera.moves);
    assert_float3(s.camera.position_end, 1, 0, 5);
    assert_float3(s.camera.look_at_end, 0, 0, 0);
    scene_finish(&s);
    s = load("\"camera\": {\"position\": [0,0,5], \"look_at\": [0,0,0], \"motion\": {\"look_at\": [0,0,0]}}");
    assert_false(s.camera.moves);
    scene_finish(&s);
    s = load("\"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1}]");
    assert_true(s.camera.lens_radius == 0 && !s.camera.moves && s.camera.position_end[2] == s.camera.position[2]);
    scene_finish(&s);
}

static void films_have_filters(void **state) {
    (void)state;
    static const struct {
        const char *film;
        enum film_filter filter;
        float radius;
    } cases[] = {
        {"", FILTER_BOX, 0.5f},
        {"\"filter\": \"box\"", FILTER_BOX, 0.5f},
        {"\"filter\": \"tent\"", FILTER_TENT, 1},
        {"\"filter\": {\"type\": \"gaussian\"}", FILTER_GAUSSIAN, 1.5f},
        {"\"filter\": {\"type\": \"blackman_harris\", \"radius\": 16}", FILTER_BLACKMAN_HARRIS, 16},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        snprintf(text, sizeof text, "\"film\": {%s}", cases[i].film);
        struct scene s = load(text);
        if (s.film.filter != cases[i].filter || s.film.filter_radius != cases[i].radius)
            fail_msg("case %zu: filter %d, radius %g", i, (int)s.film.filter, (double)s.film.filter_radius);
        scene_finish(&s);
    }
}

static void paths_and_fog_have_defaults(void **state) {
    (void)state;
    struct scene s = load("\"shadows\": true");
    assert_true(s.paths.max_depth == 8 && !s.paths.indirect && s.paths.roulette_depth == 3 && s.fog.density == 0);
    scene_finish(&s);
    s = load("\"paths\": {\"max_depth\": 0, \"indirect\": true, \"roulette_depth\": 1000}, \"fog\": {\"density\": 0.25}");
    assert_true(s.paths.max_depth == 0 && s.paths.indirect && s.paths.roulette_depth == 1000);
    assert_true(s.fog.density == 0.25f && s.fog.anisotropy == 0);
    assert_float3(s.fog.albedo, 1, 1, 1);
    scene_finish(&s);
    s = load("\"fog\": {\"density\": 1, \"albedo\": [0.5,0,1], \"anisotropy\": -0.5}");
    assert_float3(s.fog.albedo, 0.5, 0, 1);
    assert_true(s.fog.anisotropy == -0.5f);
    scene_finish(&s);
}

// --------------------------------------------------------------------------------------------------------------- materials

static void materials_have_models(void **state) {
    (void)state;
    struct scene s = load(
        "\"materials\": {"
        "\"a\": {\"model\": \"blinn_phong\", \"diffuse\": [1,0,0], \"specular\": [0,1,0], \"shininess\": 5, \"reflection\": [0,0.5,1]},"
        "\"b\": {\"model\": \"lambert\", \"emission\": [3,2,1], \"alpha\": 0.5},"
        "\"c\": {\"model\": \"metallic_roughness\", \"diffuse\": [1,0.5,0], \"metallic\": 1, \"roughness\": 0.25, \"ior\": 1.4, "
        "\"alpha_cutoff\": 0.75},"
        "\"d\": {\"model\": \"dielectric\", \"ior\": 1.33, \"absorption\": [0.1,0.2,0.3], \"priority\": 7, \"thin\": true},"
        "\"e\": {\"model\": \"mirror\", \"diffuse\": [0.9,0.8,0.7], \"alpha_mode\": \"mask\"}, \"f\": {\"alpha_mode\": \"opaque\", "
        "\"alpha\": 0}}");
    static const enum material_model models[] = {MODEL_BLINN_PHONG, MODEL_LAMBERT, MODEL_METALLIC_ROUGHNESS,
                                                 MODEL_DIELECTRIC,  MODEL_MIRROR,  MODEL_PHONG};
    assert_int_equal(s.material_count, 6);
    const struct scene_material *m = s.materials;
    for (int i = 0; i < 6; i++) assert_int_equal(m[i].model, models[i]);
    assert_float3(m[0].reflection, 0, 0.5, 1);
    assert_float3(m[0].ambient, 1, 0, 0);
    assert_true(m[0].shininess == 5 && m[0].alpha_mode == ALPHA_OPAQUE && m[0].alpha == 1 && m[0].normal_scale == 1);
    assert_float3(m[1].emission, 3, 2, 1);
    assert_true(m[1].alpha_mode == ALPHA_BLEND && m[1].alpha == 0.5f);
    assert_true(m[2].metallic == 1 && m[2].roughness == 0.25f && m[2].ior == 1.4f);
    assert_true(m[2].alpha_mode == ALPHA_MASK && m[2].alpha_cutoff == 0.75f);
    assert_true(m[3].ior == 1.33f && m[3].priority == 7 && m[3].thin);
    assert_float3(m[3].absorption, 0.1, 0.2, 0.3);
    assert_float3(m[3].diffuse, 1, 1, 1);
    assert_float3(m[3].ambient, 0, 0, 0);
    assert_float3(m[4].diffuse, 0.9, 0.8, 0.7);
    assert_float3(m[4].ambient, 0, 0, 0);
    assert_true(m[4].alpha_mode == ALPHA_MASK && m[4].alpha_cutoff == 0.5f);
    assert_true(m[5].alpha_mode == ALPHA_OPAQUE && m[5].alpha == 0);
    for (int i = 0; i < 6; i++) assert_true(m[i].diffuse_map.texture == NO_TEXTURE && m[i].diffuse_map.transform[4] == 1);
    scene_finish(&s);
}

static void materials_have_maps(void **state) {
    (void)state;
    helpers();
    struct scene s =
        load("\"materials\": {\"a\": {\"diffuse_map\": \"a.png\", \"normal_map\": {\"file\": \"a.png\", \"scale\": -0.5}},"
             "\"b\": {\"model\": \"metallic_roughness\", \"diffuse\": [0.5,0.5,0.5], \"roughness_map\": {\"file\": \"a.png\"}, "
             "\"diffuse_map\": {\"file\": \"a.png\", "
             "\"wrap\": [\"mirror\", \"clamp\"], \"filter\": \"nearest\", \"encoding\": \"linear\", \"transform\": [[2,0,0.5],[0,3,1]]}},"
             "\"c\": {\"emission_map\": \"sky.hdr\", \"diffuse_map\": {\"file\": \"sky.hdr\", \"encoding\": \"linear\"}, \"diffuse\": "
             "[0,0,0]}}");
    const struct scene_material *m = s.materials;
    const struct scene_texture *t = s.textures;
    assert_int_equal(s.texture_count, 5); // of a.png color, others, another lookup; of sky.hdr two encodings
    assert_float3(m[0].diffuse, 1, 1, 1);
    assert_float3(m[0].ambient, 1, 1, 1);
    assert_float3(m[0].emission, 0, 0, 0);
    assert_true(m[0].diffuse_map.texture == 1 && m[0].diffuse_map.srgb && m[0].normal_scale == -0.5f);
    assert_true(m[0].normal_map.texture == 2 && !m[0].normal_map.srgb);
    static const uint8_t codes[8] = {255, 0, 0, 255, 10, 20, 200, 128};
    assert_true(t[0].width == 2 && t[0].height == 1 && t[0].wrap_u == WRAP_REPEAT && !t[0].nearest && strstr(t[0].name, "/a.png"));
    assert_memory_equal(t[0].texels, codes, sizeof codes);
    assert_memory_equal(t[1].texels, codes, sizeof codes);
    assert_float3(m[1].diffuse, 0.5, 0.5, 0.5);
    assert_true(m[1].metallic == 1 && m[1].roughness == 1 && m[1].roughness_map.texture == 2 && !m[1].diffuse_map.srgb);
    const struct scene_texture *other = &t[m[1].diffuse_map.texture - 1];
    assert_true(other->wrap_u == WRAP_MIRROR && other->wrap_v == WRAP_CLAMP && other->nearest);
    assert_memory_equal(other->texels, codes, sizeof codes);
    static const float transform[6] = {2, 0, 0.5f, 0, 3, 1};
    assert_memory_equal(m[1].diffuse_map.transform, transform, sizeof transform);
    assert_float3(m[2].diffuse, 0, 0, 0);
    assert_float3(m[2].emission, 1, 1, 1);
    assert_int_equal(t[m[2].emission_map.texture - 1].texels[1], 188); // 0.5
    assert_int_equal(t[m[2].diffuse_map.texture - 1].texels[1], 128);
    scene_finish(&s);
}

// The textures of a model are the scene's, too, unless the shape has a material of its own.
static void models_bring_their_textures(void **state) {
    (void)state;
    static const char library[] = "newmtl t\nmap_Kd a.png\nnewmtl u\nmap_Kd a.png\nmap_Ke sky.hdr\n",
                      object[] = "mtllib lib.mtl\n" QUAD "vt 0 0\nusemtl u\nf 1/1 2/1 3/1\nusemtl t\nf 1/1 2/1 4/1\n";
    helpers();
    scratch_file("lib.mtl", library, sizeof library - 1);
    scratch_file("textured.obj", object, sizeof object - 1);
    struct scene s =
        load("\"materials\": {\"sky\": {\"diffuse_map\": \"sky.hdr\"}}, \"shapes\": [{\"type\": \"mesh\", \"file\": \"textured.obj\"},"
             "{\"type\": \"mesh\", \"file\": \"textured.obj\"}]");
    assert_int_equal(s.texture_count, 2);
    assert_non_null(s.shapes[0].mesh.uvs);
    for (uint32_t i = 1; i < s.material_count; i++) {
        const struct scene_material *m = &s.materials[i];
        if (strcmp(m->name, "default") == 0) continue;
        assert_int_equal(m->diffuse_map.texture, 2);
        assert_int_equal(m->emission_map.texture, strcmp(m->name, "u") == 0 ? 1 : NO_TEXTURE);
    }
    scene_finish(&s);
    s = load("\"materials\": {\"own\": {}}, \"shapes\": [{\"type\": \"mesh\", \"file\": \"textured.obj\", \"material\": \"own\"}]");
    assert_int_equal(s.texture_count, 0);
    assert_null(s.shapes[0].mesh.uvs); // nothing asks for them
    scene_finish(&s);
}

static void environments_are_linear(void **state) {
    (void)state;
    helpers();
    struct scene s = load("\"environment\": \"sky.hdr\"");
    static const float texels[6] = {1, 0.5f, 0.25f, 0, 0x1.fep-1f, 0};
    assert_true(s.environment.width == 2 && s.environment.height == 1 && s.environment.scale == 1 && s.environment.rotation_deg == 0);
    assert_memory_equal(s.environment.texels, texels, sizeof texels);
    scene_finish(&s);
    s = load("\"environment\": {\"file\": \"a.png\", \"scale\": 3, \"rotation_deg\": -400}");
    assert_true(s.environment.scale == 3 && s.environment.rotation_deg == -400 && s.environment.texels[0] == 1);
    scene_finish(&s);
    static const float odd[6] = {INFINITY, -1, NAN, 7, -INFINITY, 0}, sound[6] = {7, 0, 0, 7, 0, 0};
    const struct image image = {.width = 2, .height = 1, .channels = 3, .pixels = (float *)odd};
    scratch_assert(image_write_pfm(&image, scratch_context(), scratch_path("odd.pfm")));
    s = load("\"environment\": \"odd.pfm\"");
    assert_memory_equal(s.environment.texels, sound, sizeof sound);
    scene_finish(&s);
}

// ------------------------------------------------------------------------------------------------------------------- lights

static void lights_have_types(void **state) {
    (void)state;
    struct scene s = load("\"lights\": [{\"type\": \"directional\", \"direction\": [0,-2,0], \"intensity\": [1,2,3]},"
                          "{\"type\": \"spot\", \"position\": [1,2,3], \"direction\": [0,0,-1], \"falloff\": \"inverse_square\"},"
                          "{\"type\": \"spot\", \"position\": [1,2,3], \"direction\": [0,0,-1], \"inner_deg\": 20, \"outer_deg\": 90}]");
    assert_int_equal(s.light_count, 3);
    assert_int_equal(s.lights[0].type, LIGHT_DIRECTIONAL);
    assert_float3(s.lights[0].direction, 0, -2, 0);
    assert_float3(s.lights[0].intensity, 1, 2, 3);
    assert_true(s.lights[1].type == LIGHT_SPOT && s.lights[1].inner_deg == 0 && s.lights[1].outer_deg == 45);
    assert_int_equal(s.lights[1].falloff, FALLOFF_INVERSE_SQUARE);
    assert_float3(s.lights[1].position, 1, 2, 3);
    assert_true(s.lights[2].inner_deg == 20 && s.lights[2].outer_deg == 90 && s.lights[2].falloff == FALLOFF_NONE);
    scene_finish(&s);
}

// ------------------------------------------------------------------------------------------------------------------- shapes

#define TEXTURED "\"materials\": {\"t\": {\"diffuse_map\": \"a.png\"}}, " // else nothing needs texture coordinates

static void rectangles_are_two_triangles(void **state) {
    (void)state;
    helpers();
    struct scene s = load(TEXTURED "\"shapes\": [{\"type\": \"rectangle\", \"corner\": [1,0,0], \"edges\": [[0,2,0],[0.1,0,0]]}]");
    const struct scene_mesh *mesh = &s.shapes[0].mesh;
    assert_true(s.shapes[0].type == SHAPE_RECTANGLE && mesh->triangle_count == 2 && mesh->vertex_count == 4 && mesh->uvs);
    assert_float3(mesh->positions + 3, 1, 2, 0);
    assert_float3(mesh->positions + 6, 1.1, 0, 0);
    assert_float3(mesh->positions + 9, 1.1, 2, 0);
    // Both triangles face the same way, and cover all four vertices.
    static const uint32_t indices[] = {0, 1, 2, 3, 2, 1};
    assert_memory_equal(mesh->indices, indices, sizeof indices);
    assert_true(mesh->uvs[0] == 0 && mesh->uvs[1] == 1 && mesh->uvs[6] == 1 && mesh->uvs[7] == 0);
    assert_int_equal(scene_triangle_count(&s), 2);
    scene_finish(&s);
}

static void triangles_have_uvs(void **state) {
    (void)state;
    helpers();
    struct scene s =
        load(TEXTURED "\"shapes\": [{\"type\": \"triangle\", \"vertices\": [[0,0,0],[1,0,0],[0,1,0]], \"uvs\": [[0,0.5],[1,2],[-3,4]]},"
                      "{\"type\": \"triangle\", \"vertices\": [[0,0,0],[1,0,0],[0,1,0]]}]");
    static const float uvs[] = {0, 0.5f, 1, 2, -3, 4};
    assert_memory_equal(s.shapes[0].mesh.uvs, uvs, sizeof uvs);
    assert_null(s.shapes[1].mesh.uvs);
    scene_finish(&s);
}

static void shapes_move(void **state) {
    (void)state;
    helpers();
    struct scene s = load("\"shapes\": [{\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1, \"motion\": [0,0.5,0]},"
                          "{\"type\": \"mesh\", \"file\": \"quad.obj\", \"motion\": [1,2,3]},"
                          "{\"type\": \"mesh\", \"file\": \"quad.obj\", \"motion\": [0,0,0]}]");
    assert_true(s.shapes[0].moves && s.shapes[1].moves && !s.shapes[2].moves);
    assert_float3(s.shapes[1].motion, 1, 2, 3);
    scene_finish(&s);
}

static void instances_draw_meshes(void **state) {
    (void)state;
    helpers();
    struct scene s = load(
        "\"materials\": {\"green\": {}}, \"meshes\": {\"plain\": {\"file\": \"quad.obj\", \"transform\": "
        "[[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},"
        "\"tinted\": {\"file\": \"tinted.obj\", \"normals\": \"smooth\"}, \"green\": {\"file\": \"tinted.obj\", \"material\": \"green\"}},"
        "\"shapes\": [{\"type\": \"instance\", \"mesh\": \"tinted\", \"motion\": [0,0,1], "
        "\"transform\": [[0,-1,0,0.1],[1,0,0,2],[0,0,1,3],[0,0,0,1]]}, {\"type\": \"instance\", \"mesh\": \"plain\", \"material\": "
        "\"green\", \"motion\": [1,0,0]}, {\"type\": \"instance\", \"mesh\": \"green\", \"motion\": [1,0,0]},"
        "{\"type\": \"instance\", \"mesh\": \"green\"}]"); // what is drawn once and stands still becomes a mesh
    assert_int_equal(s.prototype_count, 3);
    assert_true(s.prototypes[0].positions[3] == 2 && s.prototypes[1].normals != NULL);
    static const float placement[12] = {0, -1, 0, 0.1f, 1, 0, 0, 2, 0, 0, 1, 3}, identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const struct scene_shape *a = &s.shapes[0], *b = &s.shapes[1], *c = &s.shapes[2];
    assert_true(a->type == SHAPE_INSTANCE && a->prototype == 1 && !a->own_material && a->moves);
    assert_memory_equal(a->placement, placement, sizeof placement);
    assert_memory_equal(b->placement, identity, sizeof identity);
    assert_string_equal(s.materials[a->material].name, "t");
    assert_true(b->prototype == 0 && b->own_material);
    assert_string_equal(s.materials[b->material].name, "green");
    assert_false(c->own_material);
    assert_string_equal(s.materials[c->material].name, "green");
    scene_finish(&s);
}

// ------------------------------------------------------------------------------------------------------------------- faults

#define SPHERE "\"type\": \"sphere\", \"center\": [0,0,0], \"radius\": 1"
#define CAMERA "\"camera\": {\"position\": [0,0,5], \"look_at\": [0,0,0], "

// The members stand on line 2, from its first column on.
static const struct {
    const char *members, *says;
} faults[] = {
    {CAMERA "\"lens_radius\": -1}", "2:68: camera.lens_radius is -1, expected a number of at least 0"},
    {CAMERA "\"focus_distance\": 0}", "2:71: camera.focus_distance is 0, expected a number greater than 0"},
    {CAMERA "\"motion\": [0,0,1]}", "2:63: camera.motion is a list, expected an object"},
    {CAMERA "\"motion\": {\"up\": [0,0,1]}}", "2:64: camera.motion has an unknown key 'up', expected one of: position, look_at"},
    {CAMERA "\"motion\": {\"look_at\": [0,0,5]}}", "2:63: camera.motion takes the camera to what it looks at, expected a point"},
    {CAMERA "\"motion\": {\"look_at\": [0,9,5]}}", "2:63: camera.motion takes the view along 'up', expected a motion on which it"},
    {CAMERA "\"motion\": {\"look_at\": [0,0,9]}}", "2:63: camera.motion takes the view along 'up', expected a motion on which it"},
    {"\"film\": {\"filter\": \"cone\"}", "2:20: film.filter is \"cone\", expected \"box\", \"tent\", \"gaussian\" or \"blackman_harris\""},
    {"\"film\": {\"filter\": 2}", "2:20: film.filter is 2, expected an object"},
    {"\"film\": {\"filter\": {\"radius\": 2}}", "2:20: film.filter has no 'type', expected the name of a filter"},
    {"\"film\": {\"filter\": {\"type\": \"tent\", \"radius\": 17}}",
     "2:47: film.filter.radius is 17, expected a number greater than 0, at most 16"},
    {"\"paths\": {\"max_depth\": 1001}", "2:24: paths.max_depth is 1001, expected an integer from 0 to 1000"},
    {"\"paths\": {\"indirect\": 1}", "2:23: paths.indirect is 1, expected true or false"},
    {"\"paths\": {\"depth\": 1}", "2:11: paths has an unknown key 'depth', expected one of: max_depth, indirect, roulette_depth"},
    {"\"fog\": {\"albedo\": [1,1,1]}", "2:8: fog has no 'density', expected a number of at least 0"},
    {"\"fog\": {\"density\": 1, \"albedo\": [1,1,1.5]}", "2:38: fog.albedo[2] is 1.5, expected a number from 0 to 1"},
    {"\"fog\": {\"density\": 1, \"anisotropy\": 1}", "2:37: fog.anisotropy is 1, expected a number greater than -1 and less than 1"},
    {"\"fog\": {\"density\": 1, \"anisotropy\": -0.99999999999}", "expected a number greater than -1 and less than 1; in fp32 this is -1"},
    {"\"materials\": {\"m\": {\"model\": \"fong\"}}",
     "2:30: materials.m.model is \"fong\", expected \"phong\", \"blinn_phong\", \"lambert\", "
     "\"metallic_roughness\", \"dielectric\" or \"mirror\"; did you mean 'phong'?"},
    {"\"materials\": {\"m\": {\"roughness\": 1}}",
     "2:21: materials.m has a key 'roughness', which belongs to \"metallic_roughness\", not to \"phong\""},
    {"\"materials\": {\"m\": {\"model\": \"mirror\", \"ior\": 1}}",
     "2:40: materials.m has a key 'ior', which belongs to \"metallic_roughness\", \"dielectric\", not to \"mirror\""},
    {"\"materials\": {\"m\": {\"model\": \"lambert\", \"difuse\": 1}}",
     "2:41: materials.m has an unknown key 'difuse', expected one of: model, ambient, diffuse, reflection, emission, alpha, alpha_mode, "},
    {"\"materials\": {\"m\": {\"model\": \"dielectric\", \"ior\": 0}}", "2:51: materials.m.ior is 0, expected a number greater than 0"},
    {"\"materials\": {\"m\": {\"model\": \"dielectric\", \"priority\": -1}}", "expected an integer from 0 to 65535"},
    {"\"materials\": {\"m\": {\"model\": \"dielectric\", \"thin\": 1}}", "2:52: materials.m.thin is 1, expected true or false"},
    {"\"materials\": {\"m\": {\"reflection\": [2,0,0]}}", "2:36: materials.m.reflection[0] is 2, expected a number from 0 to 1"},
    {"\"materials\": {\"m\": {\"alpha\": 1.1}}", "2:30: materials.m.alpha is 1.1, expected a number from 0 to 1"},
    {"\"materials\": {\"m\": {\"alpha_mode\": \"cut\"}}",
     "2:35: materials.m.alpha_mode is \"cut\", expected \"opaque\", \"mask\" or \"blend\""},
    {"\"materials\": {\"m\": {\"emission\": [1,-1,0]}}", "2:36: materials.m.emission[1] is -1, expected a number of at least 0"},
    {"\"lights\": [{\"type\": \"spot\", \"position\": [0,0,0]}]", "2:12: lights[0] has no 'direction', expected 3 numbers"},
    {"\"lights\": [{\"type\": \"directional\", \"direction\": [0,0,0]}]",
     "2:49: lights[0].direction is zero, expected the way that the light"},
    {"\"lights\": [{\"type\": \"directional\", \"position\": [0,0,0]}]",
     "2:36: lights[0] has a key 'position', which belongs to \"point\", \"spot\", not to \"directional\""},
    {"\"lights\": [{\"type\": \"spot\", \"position\": [0,0,0], \"direction\": [0,0,1], \"inner_deg\": 45}]",
     "2:12: lights[0] has an inner angle of 45° and an outer one of 45°, expected a smaller inner one"},
    {"\"lights\": [{\"type\": \"spot\", \"position\": [0,0,0], \"direction\": [0,0,1], \"outer_deg\": 91}]",
     "lights[0].outer_deg is 91, expected a number from 0 to 90"},
    {"\"shapes\": [{\"type\": \"rectangle\", \"corner\": [0,0,0], \"edges\": [[1,0,0]]}]",
     "2:62: shapes[0].edges is a list of 1, expected a list of 2"},
    {"\"shapes\": [{\"type\": \"rectangle\", \"corner\": [0,0,0], \"edges\": [[1,0,0],[1,1,0]]}]",
     "2:62: shapes[0].edges are not perpendicular, or one is zero, expected the two sides of a rectangle"},
    {"\"shapes\": [{\"type\": \"rectangle\", \"corner\": [0,0,0], \"edges\": [[1,0,0],[0,0,0]]}]",
     "2:62: shapes[0].edges are not perpendicular, or one is zero, expected the two sides of a rectangle"},
    {"\"shapes\": [{\"type\": \"rectangle\", \"corner\": [3e38,0,0], \"edges\": [[1e38,0,0],[0,1,0]]}]",
     "shapes[0].edges leave the range of fp32, expected smaller numbers"},
    {"\"shapes\": [{\"type\": \"triangle\", \"vertices\": [[0,0,0],[1,0,0],[0,1,0]], \"uvs\": [[0,0],[0,0]]}]",
     "2:79: shapes[0].uvs is a list of 2, expected a list of 3 pairs of numbers"},
    {"\"shapes\": [{\"type\": \"triangle\", \"vertices\": [[0,0,0],[1,0,0],[0,1,0]], \"uvs\": [[0,0],[0,0],[1]]}]",
     "2:92: shapes[0].uvs[2] is a list of 1, expected a list of 2 numbers"},
    {"\"shapes\": [{" SPHERE ", \"motion\": [1,2]}]", "shapes[0].motion is a list of 2, expected a list of 3 numbers"},
    {"\"shapes\": [{\"type\": \"sphere\", \"center\": [3e38,0,0], \"radius\": 1, \"motion\": [3e38,0,0]}]",
     "2:76: shapes[0].motion takes the shape out of the range of fp32, expected smaller numbers"},
    {"\"shapes\": [{" SPHERE ", \"transform\": 1}]",
     "2:63: shapes[0] has a key 'transform', which belongs to \"mesh\", \"instance\", not to \"sphere\""},
    {"\"environment\": 1", "2:16: environment is 1, expected an object"},
    {"\"environment\": {\"scale\": 1}", "2:16: environment has no 'file', expected the path of an image"},
    {"\"environment\": \"none.hdr\"", "2:16: environment is \"none.hdr\", expected a file that can be read: No such file"},
    {"\"environment\": {\"file\": \"cut.hdr\"}", "2:25: environment.file cannot be used: "},
    {"\"environment\": {\"file\": \"cut.hdr\"}", "cut.hdr: is not a valid Radiance file: it ends early, or its rows are damaged"},
    {"\"environment\": {\"file\": \"sky.hdr\", \"scale\": -1}", "2:45: environment.scale is -1, expected a number of at least 0"},
    {"\"materials\": {\"m\": {\"diffuse_map\": 1}}", "2:36: materials.m.diffuse_map is 1, expected the path of an image, or an object"},
    {"\"materials\": {\"m\": {\"diffuse_map\": {}}}", "2:36: materials.m.diffuse_map has no 'file', expected the path of an image"},
    {"\"materials\": {\"m\": {\"diffuse_map\": \"none.png\"}}",
     "2:36: materials.m.diffuse_map is \"none.png\", expected a file that can be read"},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"text.png\"}}}", "2:45: materials.m.diffuse_map.file cannot be used: "},
    {"\"materials\": {\"m\": {\"diffuse_map\": \"text.png\"}}",
     "text.png: is neither PNG, OpenEXR, JPEG, Radiance (.hdr) nor PFM (5 bytes)"},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"a.png\", \"scale\": 2}}}",
     "2:54: materials.m.diffuse_map has a key 'scale', which belongs to \"normal map\", not to \"color map\""},
    {"\"materials\": {\"m\": {\"normal_map\": {\"file\": \"a.png\", \"encoding\": \"srgb\"}}}",
     "materials.m.normal_map has a key 'encoding', which belongs to \"color map\", not to \"normal map\""},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"a.png\", \"wrap\": \"tile\"}}}",
     "materials.m.diffuse_map.wrap is \"tile\", expected \"repeat\", \"clamp\" or \"mirror\""},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"a.png\", \"wrap\": [\"clamp\", 1]}}}",
     "materials.m.diffuse_map.wrap[1] is 1, expected \"repeat\", \"clamp\" or \"mirror\""},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"a.png\", \"wrap\": [\"clamp\"]}}}",
     "materials.m.diffuse_map.wrap is a list of 1, expected \"repeat\", \"clamp\" or \"mirror\", or a list of 2 of these"},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"a.png\", \"filter\": \"cubic\"}}}",
     "materials.m.diffuse_map.filter is \"cubic\", expected \"linear\" or \"nearest\""},
    {"\"materials\": {\"m\": {\"diffuse_map\": {\"file\": \"a.png\", \"transform\": [[1,0,0]]}}}",
     "materials.m.diffuse_map.transform is a list of 1, expected 2 rows of 3 numbers"},
    {"\"materials\": {\"m\": {\"roughness_map\": \"a.png\"}}",
     "has a key 'roughness_map', which belongs to \"metallic_roughness\", not to \"phong\""},
    {"\"meshes\": [], \"shapes\": []", "2:11: meshes is a list, expected an object of meshes by name"},
    {"\"meshes\": {\"m\": {\"type\": \"mesh\"}}",
     "2:18: meshes.m has an unknown key 'type', expected one of: file, transform, normals, material"},
    {"\"meshes\": {\"m\": {\"file\": \"none.obj\"}}", "2:26: meshes.m.file is \"none.obj\", expected a file that can be read: No such"},
    {"\"meshes\": {\"m\": {\"file\": \"quad.obj\", \"material\": \"x\"}}",
     "2:50: meshes.m.material is \"x\", expected the name of one of the 0 materials"},
    {"\"meshes\": {\"bunny\": {\"file\": \"quad.obj\"}}, \"shapes\": [{\"type\": \"instance\", \"mesh\": \"buny\"}]",
     "2:84: shapes[0].mesh is \"buny\", expected the name of one of the 1 meshes in \"meshes\"; did you mean 'bunny'?"},
    {"\"shapes\": [{\"type\": \"instance\"}]", "2:12: shapes[0] has no 'mesh', expected the name of a mesh"},
    {"\"meshes\": {\"m\": {\"file\": \"quad.obj\"}}, \"shapes\": [{\"type\": \"instance\", \"mesh\": \"m\", \"transform\": "
     "[[3e38,-3e38,0,0],[3e38,3e38,0,0],[0,0,3e38,0],[0,0,0,1]]}]",
     "2:51: shapes[0] takes its mesh out of the range of fp32, expected smaller numbers"},
    {"\"meshes\": {\"m\": {\"file\": \"quad.obj\"}}, \"shapes\": [{\"type\": \"instance\", \"mesh\": \"m\", \"transform\": "
     "[[1e39,0,0,0],[0,1e39,0,0],[0,0,1e39,0],[0,0,0,1]]}]",
     "shapes[0].transform has numbers beyond the range of fp32, expected smaller ones"},
};

static void each_fault_is_told(void **state) {
    (void)state;
    helpers();
    int wrong = 0;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        char text[1024];
        struct scene scene;
        snprintf(text, sizeof text, "{\"version\": 1,\n%s}", faults[i].members);
        const bool loaded = scene_load(&scene, scratch_context(), scratch_file("a.json", text, strlen(text)));
        const struct gn_error *error = &scratch_state()->error;
        if (loaded || error->status != GN_SCENE || !strstr(error->message, faults[i].says)) {
            wrong++;
            print_error("%s: status %d\n  \"%s\", expected\n  \"%s\"\n", faults[i].members, (int)error->status, error->message,
                        faults[i].says);
        }
        assert_null(scene.shapes);
    }
    assert_int_equal(wrong, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cameras_have_lenses_and_move),
        cmocka_unit_test(films_have_filters),
        cmocka_unit_test(paths_and_fog_have_defaults),
        cmocka_unit_test(materials_have_models),
        cmocka_unit_test(materials_have_maps),
        cmocka_unit_test(models_bring_their_textures),
        cmocka_unit_test(environments_are_linear),
        cmocka_unit_test(lights_have_types),
        cmocka_unit_test(rectangles_are_two_triangles),
        cmocka_unit_test(triangles_have_uvs),
        cmocka_unit_test(shapes_move),
        cmocka_unit_test(instances_draw_meshes),
        cmocka_unit_test(each_fault_is_told),
    };
    return cmocka_run_group_tests_name("the scene format", tests, scratch_open, scratch_close);
}
