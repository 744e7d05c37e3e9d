// glTF: materials, textures, lights and the extensions that we know; what is not right in them, with its place. Geometry is in test_mesh.c.
#include "scratch.h"

#include <math.h>

#include "scene/import.h"

static const double PI = 3.14159265358979323846;

// One triangle with two sets of texture coordinates: positions, floats, and 8 bits each. Then an image of one pixel, as in HDR.
#define HDR_BASE64 "Iz9SQURJQU5DRQpGT1JNQVQ9MzItYml0X3JsZV9yZ2JlCgotWSAxICtYIDEKgEAggQ=="
#define BUFFERS                                                                                                                            \
    "\"buffers\":[{\"byteLength\":72,\"uri\":\"data:;base64,"                                                                              \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD4AAIA/AAAAAAAAAAAAAIA/AP8AAACAAAAA/wAA\"},"                                 \
    "{\"byteLength\":49,\"uri\":\"data:;base64," HDR_BASE64 "\"}],"                                                                        \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24},"                                \
    "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":12,\"byteStride\":4},{\"buffer\":1,\"byteLength\":49}],"                               \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"                                              \
    "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},"                                                             \
    "{\"bufferView\":2,\"componentType\":5121,\"normalized\":true,\"count\":3,\"type\":\"VEC2\"}],"
#define TRIANGLE(material) "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2},\"material\":" #material "}"

// A document with one mesh of these primitives, and these members.
static const char *document(const char *primitives, const char *members) {
    static char text[8192];
    const char *nodes = strstr(members, "\"nodes\":[{") ? "" : "\"nodes\":[{\"mesh\":0}],";
    const int length = snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},%s" BUFFERS "\"meshes\":[{\"primitives\":[%s]}],\n%s}",
                                nodes, primitives, members);
    assert_in_range(length, 1, sizeof text - 1);
    return scratch_file("a.gltf", text, (size_t)length);
}

static struct model load(const char *primitives, const char *members) {
    struct model model;
    scratch_assert(model_load(&model, scratch_context(), document(primitives, members)));
    return model;
}

static void assert_near(const float *actual, size_t count, const double *expected) {
    for (size_t i = 0; i < count; i++)
        if (!(fabs(actual[i] - expected[i]) <= 1e-6 * fmax(1, fabs(expected[i]))))
            fail_msg("value %zu: %.9g, expected %.9g", i, (double)actual[i], expected[i]);
}

#define NEAR(actual, ...) assert_near(actual, sizeof((double[]){__VA_ARGS__}) / sizeof(double), (double[]){__VA_ARGS__})

static void defaults_are_the_specification_s(void **state) {
    (void)state;
    struct model model = load(TRIANGLE(0), "\"materials\":[{}]");
    const struct scene_material *m = model.materials;
    assert_int_equal(model.material_count, 1);
    assert_string_equal(m->name, "material 0");
    assert_true(m->model == MODEL_METALLIC_ROUGHNESS && m->metallic == 1 && m->roughness == 1 && m->ior == 1.5f && m->alpha == 1);
    assert_true(m->alpha_mode == ALPHA_OPAQUE && m->alpha_cutoff == 0.5f && m->normal_scale == 1);
    NEAR(m->diffuse, 1, 1, 1);
    NEAR(m->emission, 0, 0, 0);
    assert_true(m->diffuse_map.texture == NO_TEXTURE && model.texture_count == 0);
    NEAR(model.mesh.uvs, 0, 0.25, 1, 0, 0, 1);
    model_finish(&model);
}

static void materials_are_complete(void **state) {
    (void)state;
    struct model model =
        load(TRIANGLE(0),
             "\"materials\":[{\"name\":\"all\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,0.75],\"metallicFactor\":0.5,"
             "\"roughnessFactor\":0.125},\"emissiveFactor\":[1,0.5,0],\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3,\"doubleSided\":true,"
             "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":10},\"KHR_materials_ior\":{\"ior\":1.25}}}]");
    const struct scene_material *m = model.materials;
    assert_string_equal(m->name, "all");
    assert_true(m->metallic == 0.5f && m->roughness == 0.125f && m->ior == 1.25f && m->alpha == 0.75f);
    assert_true(m->alpha_mode == ALPHA_MASK && m->alpha_cutoff == 0.3f);
    NEAR(m->diffuse, 0.5, 0.25, 1);
    NEAR(m->ambient, 0.5, 0.25, 1);
    NEAR(m->emission, 10, 5, 0);
    model_finish(&model);
}

// KHR_materials_transmission, _volume, _ior, _unlit.
static void glass_is_a_dielectric(void **state) {
    (void)state;
    struct model model = load(
        TRIANGLE(0) "," TRIANGLE(1) "," TRIANGLE(2) "," TRIANGLE(3),
        "\"materials\":[{\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_ior\":{\"ior\":1.33},"
        "\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationColor\":[0.5,1,0],\"attenuationDistance\":2}},"
        "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[1,0.5,0.25,1]}},"
        "{\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.5}},\"pbrMetallicRoughness\":{\"metallicFactor\":0}},"
        "{\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.25}},\"pbrMetallicRoughness\":{\"metallicFactor\":0}},"
        "{\"extensions\":{\"KHR_materials_unlit\":{}},\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0.25,1]}}]");
    const struct scene_material *m = model.materials;
    assert_int_equal(model.material_count, 4);
    assert_true(m[0].model == MODEL_DIELECTRIC && m[0].ior == 1.33f && !m[0].thin);
    NEAR(m[0].absorption, log(2) / 2, 0, log(1e4) / 2);
    NEAR(m[0].diffuse, 1, 0.5, 0.25);
    assert_true(m[1].model == MODEL_DIELECTRIC && m[1].thin && m[1].ior == 1.5f && m[1].absorption[0] == 0);
    assert_int_equal(m[2].model, MODEL_METALLIC_ROUGHNESS);
    NEAR(m[3].emission, 1, 0.5, 0.25);
    NEAR(m[3].diffuse, 0, 0, 0);
    model_finish(&model);
}

#define TEXTURES                                                                                                                           \
    "\"textures\":[{\"source\":0,\"sampler\":0},{\"source\":1},{\"source\":2},{}],"                                                        \
    "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33648,\"magFilter\":9728}],"                                                                 \
    "\"images\":[{\"uri\":\"my%20sky.hdr\"},{\"bufferView\":3,\"mimeType\":\"image/png\"},{\"uri\":\"data:image/png;base64," HDR_BASE64    \
    "\"}],"

static void textures_come_from_everywhere(void **state) {
    (void)state;
    scratch_file("my sky.hdr", "", 0);
    struct model model =
        load(TRIANGLE(0) "," TRIANGLE(2), TEXTURES
             "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":1},"
             "\"metallicRoughnessTexture\":{\"index\":1,\"texCoord\":1}},\"normalTexture\":{\"index\":1,\"texCoord\":1,\"scale\":-2},"
             "\"emissiveTexture\":{\"index\":2}},{\"emissiveTexture\":{\"index\":2}},"
             "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":2,\"extensions\":{\"KHR_texture_transform\":"
             "{\"offset\":[0.5,0.25],\"rotation\":0.5,\"scale\":[2,3]}}}},\"normalTexture\":{\"index\":3}}]");
    const struct scene_material *m = model.materials;
    const struct texture_source *t = model.textures;
    assert_int_equal(model.texture_count, 3);
    assert_true(m[0].diffuse_map.texture == 1 && m[0].diffuse_map.srgb && m[0].normal_map.texture == m[0].roughness_map.texture);
    assert_true(m[0].normal_scale == -2 && !m[0].roughness_map.srgb);
    assert_int_equal(m[0].emission_map.texture, NO_TEXTURE); // its texture coordinates are others
    assert_true(strstr(t[0].name, "/my sky.hdr") && !t[0].bytes.data);
    assert_true(t[0].wrap_u == WRAP_CLAMP && t[0].wrap_v == WRAP_MIRROR && t[0].nearest);
    assert_true(strstr(t[1].name, "a.gltf: image 1") && t[1].bytes.size == 49 && t[1].wrap_u == WRAP_REPEAT && !t[1].nearest);
    assert_true(strstr(t[2].name, "a.gltf: image 2") && t[2].bytes.size == 49);
    assert_memory_equal(t[1].bytes.data, t[2].bytes.data, t[1].bytes.size);
    NEAR(m[1].diffuse_map.transform, 2 * cos(0.5), 3 * sin(0.5), 0.5, -2 * sin(0.5), 3 * cos(0.5), 0.25);
    assert_int_equal(m[1].normal_map.texture, NO_TEXTURE);                 // has no picture
    NEAR(model.mesh.uvs, 0, 1, 0, 128 / 255.0, 0, 1, 0, 0.25, 1, 0, 0, 1); // the second set, and the first
    model_finish(&model);
}

static void scenes_have_the_textures(void **state) {
    (void)state;
    scratch_file("my sky.hdr", "", 0); // no picture, but nobody uses it
    struct scene scene;
    const char *path = document(TRIANGLE(0), TEXTURES "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":1}}},"
                                                      "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]");
    scratch_assert(scene_load(&scene, scratch_context(), path));
    assert_int_equal(scene.texture_count, 1);
    static const uint8_t texel[4] = {255, 188, 137, 255}; // 1, 0.5, 0.25
    assert_memory_equal(scene.textures[0].texels, texel, sizeof texel);
    assert_non_null(scene.shapes[0].mesh.uvs);
    scene_finish(&scene);
}

static void lights_are_of_three_kinds(void **state) {
    (void)state;
    struct model model =
        load(TRIANGLE(0), "\"materials\":[{}],\"scenes\":[{\"nodes\":[0,1,2,3]}],\"nodes\":[{\"mesh\":0},"
                          "{\"rotation\":[1,0,0,0],\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
                          "{\"rotation\":[0,0.70710678,0,0.70710678],\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},"
                          "{\"scale\":[3,3,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}}],"
                          "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"intensity\":4,\"spot\":{"
                          "\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}},"
                          "{\"type\":\"directional\",\"color\":[0.5,1,0],\"intensity\":2},{\"type\":\"spot\"}]}}");
    const struct scene_light *l = model.lights;
    assert_int_equal(model.light_count, 3);
    assert_true(l[0].type == LIGHT_SPOT && l[0].falloff == FALLOFF_INVERSE_SQUARE);
    NEAR(l[0].direction, 0, 0, 1);
    NEAR(l[0].position, 1, 2, 3);
    NEAR(l[0].intensity, 4 / PI, 4 / PI, 4 / PI);
    NEAR(&l[0].inner_deg, 45 / PI);
    NEAR(&l[0].outer_deg, 90 / PI);
    assert_true(l[1].type == LIGHT_DIRECTIONAL && l[1].falloff == FALLOFF_NONE);
    NEAR(l[1].direction, -1, 0, 0);
    NEAR(l[1].intensity, 1 / PI, 2 / PI, 0);
    NEAR(l[2].direction, 0, 0, -1);
    NEAR(&l[2].outer_deg, 45);
    assert_true(l[2].inner_deg == 0);
    model_finish(&model);
}

static void strips_and_fans_are_cut(void **state) {
    (void)state;
    // Five vertices; in a strip every other triangle is turned round.
    static const char text[] = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"mode\":5,"
                               "\"attributes\":{\"POSITION\":0}},"
                               "{\"mode\":6,\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0}}]}],"
                               "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"}],\"bufferViews\":[{"
                               "\"buffer\":0,\"byteLength\":60}],"
                               "\"buffers\":[{\"byteLength\":60,\"uri\":\"data:;base64,"
                               "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\"}]}";
    static const uint32_t expected[] = {0, 1, 2, 1, 3, 2, 2, 3, 4, 5, 6, 7, 5, 7, 8, 5, 8, 9, 10, 11, 12};
    struct model model;
    scratch_assert(model_load(&model, scratch_context(), scratch_file("a.gltf", text, sizeof text - 1)));
    assert_int_equal(model.mesh.triangle_count, 7);
    assert_memory_equal(model.mesh.indices, expected, sizeof expected);
    assert_int_equal(model.material_count, 0);
    model_finish(&model);
}

// ------------------------------------------------------------------------------------------------------------------- faults

#define LIGHT(...) "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{" __VA_ARGS__ "}]}}"

static const struct {
    const char *members, *says;
} faults[] = {
    {"\"materials\":[{\"pbrMetallicRoughness\":1}]", "2:38: materials[0].pbrMetallicRoughness is 1, expected an object"},
    {"\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1]}}]",
     "baseColorFactor is a list of 3, expected a list of 4 numbers"},
    {"\"materials\":[{\"pbrMetallicRoughness\":{\"roughnessFactor\":-1}}]", "roughnessFactor is -1, expected a number of at least 0"},
    {"\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{}}}]",
     "baseColorTexture has no 'index', expected the number of a texture"},
    {"\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]",
     "index refers to 'textures', of which there are none"},
    {"\"materials\":[{\"normalTexture\":{\"index\":4}}]," TEXTURES "\"x\":0",
     "materials[0].normalTexture.index is 4, expected an integer from 0 to 3"},
    {"\"materials\":[{\"alphaMode\":\"CUT\"}]", "materials[0].alphaMode is \"CUT\", expected \"OPAQUE\", \"MASK\" or \"BLEND\""},
    {"\"materials\":[{\"emissiveFactor\":[1,1,-1]}]", "materials[0].emissiveFactor[2] is -1, expected a number of at least 0"},
    {"\"materials\":[{\"extensions\":[]}]", "materials[0].extensions is a list, expected an object"},
    {"\"materials\":[{\"extensions\":{\"KHR_materials_ior\":{\"ior\":-1}}}]",
     "KHR_materials_ior.ior is -1, expected a number of at least 0"},
    {"\"materials\":[{\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":2}}}]", "is 2, expected a number from 0 to 1"},
    {"\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"extensions\":{\"KHR_materials_transmission\":{"
     "\"transmissionFactor\":1},"
     "\"KHR_materials_volume\":{\"attenuationDistance\":0}}}]",
     "attenuationDistance is 0, expected a number greater than 0"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":1}}}}]," TEXTURES "\"x\":0",
     "KHR_texture_transform.scale is 1, expected a list of 2 numbers"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"gone.png\"}]",
     "images[0].uri is \"gone.png\", expected a file that can be read: No such file"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{\"source\":0}],\"images\":[{}]",
     "images[0] has no 'uri', expected a URI or a"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:x\"}]",
     "images[0].uri is a data URI of another kind, expected base64"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"data:x;base64,aGVsbG8=\"}]",
     "a.gltf: image 0: is neither PNG, OpenEXR, JPEG, Radiance (.hdr) nor PFM (5 bytes)"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{\"source\":0}],\"images\":[{\"bufferView\":9}]",
     "images[0].bufferView is 9, expected an integer from 0 to 3"},
    {"\"materials\":[{\"normalTexture\":{\"index\":0}}],\"textures\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{\"wrapS\":1}],"
     "\"images\":[{\"bufferView\":3}]",
     "samplers[0].wrapS is 1, expected 10497 (repeat), 33071 (clamp) or 33648 (mirror)"},
    {"\"materials\":[{}]," LIGHT("\"type\":\"sun\""), "lights[0].type is \"sun\", expected \"point\", \"directional\" or \"spot\""},
    {"\"materials\":[{}]," LIGHT("\"intensity\":1"), "lights[0] has no 'type', expected \"point\", \"directional\" or \"spot\""},
    {"\"materials\":[{}]," LIGHT("\"type\":\"spot\",\"spot\":{\"innerConeAngle\":1,\"outerConeAngle\":1}"),
     "lights[0].spot has cone angles of 1 and 1, expected an inner one below the outer one, and that up to pi/2"},
    {"\"materials\":[{}]," LIGHT("\"type\":\"spot\",\"spot\":{\"outerConeAngle\":1.6}"), "has cone angles of 0 and 1.6, expected"},
};

static void each_fault_is_told(void **state) {
    (void)state;
    int wrong = 0;
    scratch_file("my sky.hdr", "", 0);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        struct scene scene;
        const bool loaded = scene_load(&scene, scratch_context(), document(TRIANGLE(0), faults[i].members));
        const struct gn_error *error = &scratch_state()->error;
        if (!loaded && error->status == GN_SCENE && strstr(error->message, faults[i].says)) continue;
        if (loaded) scene_finish(&scene);
        print_error("%s: status %d\n  \"%s\", expected\n  \"%s\"\n", faults[i].members, (int)error->status, error->message, faults[i].says);
        wrong++;
    }
    assert_int_equal(wrong, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_the_specification_s),
        cmocka_unit_test(materials_are_complete),
        cmocka_unit_test(glass_is_a_dielectric),
        cmocka_unit_test(textures_come_from_everywhere),
        cmocka_unit_test(scenes_have_the_textures),
        cmocka_unit_test(lights_are_of_three_kinds),
        cmocka_unit_test(strips_and_fans_are_cut),
        cmocka_unit_test(each_fault_is_told),
    };
    return cmocka_run_group_tests_name("glTF", tests, scratch_open, scratch_close);
}
