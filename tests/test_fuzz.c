// Broken files of every format: every beginning of a small good file, and the file with bytes changed at random. Each load gives a sound
// scene or one clean error, and with sanitizers nothing else happens either.
#include "scratch.h"

#include <math.h>

#include "scene/scene.h"

#define MOST_BYTES 4096

struct sample {
    const char *name;
    unsigned char bytes[MOST_BYTES];
    size_t size;
};

static void put(struct sample *sample, const void *bytes, size_t size) {
    assert_true(sample->size + size <= MOST_BYTES);
    memcpy(sample->bytes + sample->size, bytes, size);
    sample->size += size;
}

static void put_text(struct sample *sample, const char *text) { put(sample, text, strlen(text)); }

static void put_u32(struct sample *sample, uint32_t value) {
    for (int i = 0; i < 4; i++) put(sample, &(unsigned char){(unsigned char)(value >> (8 * i) & 0xff)}, 1);
}

static void put_float(struct sample *sample, float value, bool big) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    if (big) bits = bits >> 24 | (bits >> 8 & 0xff00) | (bits << 8 & 0xff0000) | bits << 24;
    put_u32(sample, bits);
}

static const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1.5f, 0}, {0, 0, -2}};
static const unsigned char faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

static void make_scene(struct sample *s) {
    put_text(s, "{\"version\": 1, \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, -1], \"up\": [0, 1, 0], \"fov_y_deg\": 90},\n"
                "\"film\": {\"width\": 32, \"height\": 16, \"spp\": 4, \"transfer\": \"linear\"}, \"background\": [0.1, 2e-1, 0],\n"
                "\"ambient\": [1, 1, 1], \"shadows\": true,\n\"materials\": {\"r\\u00e9d\": {\"diffuse\": [1, 0, 0], \"shininess\": 3}},\n"
                "\"lights\": [{\"type\": \"point\", \"position\": [1, 2, 3], \"falloff\": \"inverse_square\"}],\n\"shapes\": [\n"
                "{\"type\": \"sphere\", \"center\": [0, 0, 16777217.0000000000001], \"radius\": 1.5, \"material\": \"r\\u00e9d\"},\n"
                "{\"type\": \"triangle\", \"vertices\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]},\n"
                "{\"type\": \"mesh\", \"file\": \"part.obj\", \"transform\": [[1, 0, 0, 5], [0, 2, 0, 0], [0, 0, 3, 0], [0, 0, 0, 1]], "
                "\"normals\": \"smooth\"}]}\n");
}

// The rest of the format.
static void make_effects(struct sample *s) {
    put_text(
        s,
        "{\"version\": 1, \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, -1], \"lens_radius\": 0.1, \"focus_distance\": 4,\n"
        "\"motion\": {\"position\": [1, 0, 5], \"look_at\": [0, 0, 0]}}, \"film\": {\"filter\": {\"type\": \"gaussian\", \"radius\": 2}},\n"
        "\"environment\": {\"file\": \"sky.hdr\", \"scale\": 2, \"rotation_deg\": 30}, \"fog\": {\"density\": 0.1, \"albedo\": [1, 0.5, "
        "0],\n"
        "\"anisotropy\": 0.5}, \"paths\": {\"max_depth\": 5, \"indirect\": true, \"roulette_depth\": 2},\n\"materials\": {\"a\": "
        "{\"model\": "
        "\"lambert\", \"emission\": [1, 2, 3], \"reflection\": [0, 0, 1]},\n\"b\": {\"model\": \"metallic_roughness\", \"metallic\": 1, "
        "\"roughness\": "
        "0.5, \"diffuse_map\": {\"file\": \"a.pfm\", \"wrap\": [\"clamp\", \"mirror\"],\n\"filter\": \"nearest\", \"encoding\": "
        "\"linear\", "
        "\"transform\": [[1, 0, 0], [0, 2, 0.5]]}, \"normal_map\": {\"file\": \"sky.hdr\", \"scale\": 0.5}, \"alpha_cutoff\": 0.25},\n"
        "\"c\": {\"model\": \"dielectric\", \"ior\": 1.3, \"absorption\": [0, 1, 2], \"priority\": 3, \"thin\": true}},\n\"lights\": "
        "[{\"type\": "
        "\"spot\", \"position\": [1, 2, 3], \"direction\": [0, -1, 0], \"inner_deg\": 10, \"outer_deg\": 20},\n{\"type\": \"directional\", "
        "\"direction\": [1, 0, 0], \"intensity\": [1, 1, 1]}], \"meshes\": {\"m\": {\"file\": \"part.obj\", \"material\": "
        "\"b\"}},\n\"shapes\": ["
        "{\"type\": \"rectangle\", \"corner\": [0, 0, 0], \"edges\": [[1, 0, 0], [0, 1, 0]], \"motion\": [0, 0, 1]},\n{\"type\": "
        "\"instance\", "
        "\"mesh\": \"m\", \"motion\": [0, 1, 0]}, {\"type\": \"instance\", \"mesh\": \"m\", \"material\": \"c\", \"transform\": [[1, 0, 0, "
        "5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]},\n{\"type\": "
        "\"triangle\", "
        "\"vertices\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], \"uvs\": [[0, 0], [1, 0], [0, 1]], \"material\": \"a\"}]}\n");
}

static void make_hdr(struct sample *s) {
    put_text(s, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 8\n");
    for (int y = 0; y < 3; y++) put(s, "\2\2\0\10\210\200\10abcdefgh\205a\3ijk\210\200", 23);
}

static void make_pfm(struct sample *s) {
    put_text(s, "PF\n2 3\n-1.0\n");
    for (int i = 0; i < 18; i++) put_float(s, (float)i / 17, false);
}

static void make_obj(struct sample *s) {
    put_text(
        s, "# a comment\nmtllib part.mtl\no thing\nv 0 0 0\nv 1 0 0 1\r\nv 0 1.5 0 0.5 0.5 0.5\nv 0 0 \\\n -2\nvt 0 1\nvn 0 0 1\nvn 1 0 0\n"
           "usemtl a\ns off\nf 1//1 3//1 2//2\nusemtl b\nf 1/1/1 2/1/1 4/1/2\nf -4 -1 -2\nf 2 3 4\nf 1 2 3 4\nl 1 2\n");
}

static void make_mtl(struct sample *s) {
    put_text(s, "newmtl a\nKd 1 0 0\nKs 0.5\nNs 20\nNi 1.5\nillum 3\nnewmtl b\nKa 0 0 0\nKd xyz 1 2 3\nd 0.5\n"
                "map_Kd -s 2 2 -clamp on sky.hdr\nmap_d a.pfm\nnorm sky.hdr\nmap_Ke x.png\n");
}

static void make_ply_ascii(struct sample *s) {
    put_text(s,
             "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty double x\nproperty float y\nproperty int z\n"
             "property list uchar short extra\nproperty uchar red\nelement junk 2\nproperty float a\nelement face 3\nproperty uchar flag\n"
             "property list uchar int vertex_indices\nend_header\n0 0 0 2 7 8 255\n1 0 0 0 0\n0 1.5 0 1 3 1\n0 0 -2 0 2\n1.5\n2.5\n"
             "0 3 0 2 1\n1 3 0 1 3\n0 4 0 1 2 3\n");
}

static void make_ply_binary(struct sample *s, bool big) {
    put_text(s, big ? "ply\r\nformat binary_big_endian 1.0\r\n" : "ply\nformat binary_little_endian 1.0\n");
    const char *header = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
                         "property float nz\nelement face 4\nproperty list uchar uchar vertex_index\nend_header\n";
    for (; *header; header++) {
        if (big && *header == '\n') put_text(s, "\r");
        put(s, header, 1);
    }
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 6; k++) put_float(s, k < 3 ? corners[i][k] : 1, big);
    for (int i = 0; i < 4; i++) {
        put(s, "\3", 1);
        put(s, faces[i], 3);
    }
}

static void make_ply_little(struct sample *s) { make_ply_binary(s, false); }
static void make_ply_big(struct sample *s) { make_ply_binary(s, true); }

static void make_stl_binary(struct sample *s) {
    put_text(s, "solid in name only, as some programs write it");
    while (s->size < 80) put_text(s, " ");
    put_u32(s, 4);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) put_float(s, 0, false);
        for (int k = 0; k < 9; k++) put_float(s, corners[faces[i][k / 3]][k % 3], false);
        put(s, "\0\0", 2);
    }
}

static void make_stl_ascii(struct sample *s) {
    put_text(s, "solid a thing\n");
    for (int i = 0; i < 2; i++)
        put_text(s, "facet normal 0 nan 1\n outer loop\n  vertex 0 0 0\n  VERTEX 1e0 0 0\n  vertex 0 1.5 0\n endloop\nendfacet\n");
    put_text(s, "endsolid a thing\nsolid b\nendsolid b\n");
}

#define GLTF_HEAD                                                                                                                          \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,2]}],\"nodes\":[{\"mesh\":0,\"children\":[1],\"matrix\""       \
    ":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]},{\"camera\":0,\"rotation\":[0,0,0,1],\"scale\":[1,2,3]},{\"translation\":[0,5,0],\"extensi"       \
    "ons\":{\"KHR_lights_punctual\":{\"light\":0}}}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1"       \
    "}}],\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"co"       \
    "lor\":[1,1,1],\"intensity\":50}]}},\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0,\"TEXCOORD_0\":2}"       \
    ",\"indices\":1,\"material\":0},{\"attributes\":{\"POSITION\":0},\"mode\":5}]}],\"materials\":[{\"name\":\"m\",\"pbrMetallicRou"       \
    "ghness\":{\"baseColorFactor\":[1,0,0,1],\"roughnessFactor\":0.5,\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_textur"       \
    "e_transform\":{\"scale\":[2,2]}}}},\"alphaMode\":\"BLEND\",\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFacto"       \
    "r\":1},\"KHR_materials_volume\":{\"thicknessFactor\":1}}}],\"textures\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{\"wrapS\""      \
    ":33071}],\"images\":[{\"uri\":\"data:;base64,Iz9SQURJQU5DRQpGT1JNQVQ9MzItYml0X3JsZV9yZ2JlCgotWSAxICtYIDEKgEAggQ==\"}],\"access"       \
    "ors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5121,\"coun"       \
    "t\":12,\"type\":\"SCALAR\"},{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"}],\"bufferViews\":[{\"buffe"       \
    "r\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12}],\"buffers\":[{\"byteLength\":60"

static void make_glb(struct sample *s) {
    static const char json[] = GLTF_HEAD "}]}";
    const size_t padded = (strlen(json) + 3) / 4 * 4;
    put_text(s, "glTF");
    put_u32(s, 2);
    put_u32(s, (uint32_t)(12 + 8 + padded + 8 + 60));
    put_u32(s, (uint32_t)padded);
    put_text(s, "JSON");
    put_text(s, json);
    for (size_t i = strlen(json); i < padded; i++) put_text(s, " ");
    put_u32(s, 60);
    put(s, "BIN", 4);
    for (int i = 0; i < 12; i++) put_float(s, corners[i / 3][i % 3], false);
    put(s, faces, 12);
}

static void make_gltf(struct sample *s) {
    put_text(s, GLTF_HEAD ",\"uri\":\"data:application/octet-stream;base64,"
                          "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAwD8AAAAAAAAAAAAAAAAAAADAAAIBAAEDAAMCAQID\"}]}");
}

static const struct {
    const char *name;
    void (*make)(struct sample *);
    uint32_t triangles;
    const char *through; // what is loaded: a scene that refers to it, or NULL: itself
} kinds[] = {
    {"scene.json", make_scene, 7, NULL},      {"effects.json", make_effects, 15, NULL}, {"sky.hdr", make_hdr, 15, "effects.json"},
    {"a.pfm", make_pfm, 15, "effects.json"},  {"part.mtl", make_mtl, 6, "part.obj"},    {"part.obj", make_obj, 6, NULL},
    {"ascii.ply", make_ply_ascii, 4, NULL},   {"little.ply", make_ply_little, 4, NULL}, {"big.ply", make_ply_big, 4, NULL},
    {"binary.stl", make_stl_binary, 4, NULL}, {"ascii.stl", make_stl_ascii, 2, NULL},   {"mesh.glb", make_glb, 6, NULL},
    {"mesh.gltf", make_gltf, 6, NULL},
};
#define KIND_COUNT (sizeof kinds / sizeof *kinds)

// All of them, those of instances, too.
static uint32_t triangles_of(const struct scene *scene) { return scene_triangle_count(scene) + (uint32_t)scene_instanced_count(scene); }

// Fails the test unless all that a renderer would follow without looking is in range.
static void assert_sound(const struct scene *scene, const char *what) {
    for (uint32_t i = 0; i < triangles_of(scene); i++) {
        const uint32_t own = scene_triangle_count(scene);
        const struct scene_triangle t = scene_triangle_at(scene, i < own ? i : i + scene_sphere_count(scene));
        const struct scene_mesh *mesh = scene_mesh_of(scene, t.object);
        bool sound = t.object < scene->shape_count && t.primitive < mesh->triangle_count && t.material < scene->material_count;
        for (int k = 0; k < 9; k++) sound = sound && t.vertex[k / 3] < mesh->vertex_count && isfinite(t.v[k / 3][k % 3]);
        if (!sound) fail_msg("%s: triangle %u is not sound", what, i);
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const struct scene_material *m = &scene->materials[i];
        if (m->diffuse_map.texture > scene->texture_count || m->normal_map.texture > scene->texture_count ||
            m->roughness_map.texture > scene->texture_count || m->emission_map.texture > scene->texture_count)
            fail_msg("%s: material %u is not sound", what, i);
    }
    for (uint32_t i = 0; i < scene_sphere_count(scene); i++) {
        const struct scene_shape *shape = &scene->shapes[scene_sphere_object(scene, i)];
        if (shape->type != SHAPE_SPHERE || !(shape->radius > 0) || !isfinite(shape->radius))
            fail_msg("%s: sphere %u is not sound", what, i);
    }
}

// Loads these bytes; whether they are a scene. `triangles`, unless NULL, receives how many it has.
static bool load(size_t kind, const unsigned char *bytes, size_t size, const char *what, uint32_t *triangles) {
    struct scene scene;
    const char *path = scratch_file(kinds[kind].name, bytes, size);
    if (kinds[kind].through) path = scratch_path(kinds[kind].through);
    if (scene_load(&scene, scratch_context(), path)) {
        assert_int_equal(scratch_state()->error.status, GN_OK);
        assert_sound(&scene, what);
        if (triangles) *triangles = triangles_of(&scene);
        scene_finish(&scene);
        return true;
    }
    const struct gn_error *error = &scratch_state()->error;
    if (error->status != GN_SCENE && error->status != GN_LIMIT) fail_msg("%s: status %d: %s", what, (int)error->status, error->message);
    if (strlen(error->message) < 20) fail_msg("%s: says only '%s'", what, error->message);
    assert_null(scene.shapes);
    return false;
}

// The files that others refer to.
static void restore_parts(void) {
    for (size_t k = 0; k < KIND_COUNT; k++) {
        struct sample part = {.name = kinds[k].name};
        kinds[k].make(&part);
        scratch_file(part.name, part.bytes, part.size);
    }
}

static void good_files_load(void **state) {
    (void)state;
    restore_parts();
    for (size_t k = 0; k < KIND_COUNT; k++) {
        struct sample sample = {.name = kinds[k].name};
        uint32_t triangles = 0;
        kinds[k].make(&sample);
        if (!load(k, sample.bytes, sample.size, sample.name, &triangles)) fail_msg("%s", scratch_state()->error.message);
        if (triangles != kinds[k].triangles) fail_msg("%s: %u triangles, expected %u", sample.name, triangles, kinds[k].triangles);
    }
}

static void every_beginning_is_clean(void **state) {
    (void)state;
    restore_parts();
    for (size_t k = 0; k < KIND_COUNT; k++) {
        struct sample sample = {.name = kinds[k].name};
        kinds[k].make(&sample);
        size_t refused = 0;
        for (size_t size = 0; size < sample.size; size++) {
            char what[64];
            snprintf(what, sizeof what, "%s cut to %zu bytes", sample.name, size);
            refused += !load(k, sample.bytes, size, what, NULL);
        }
        assert_true(refused > sample.size / 10);
        restore_parts();
    }
}

static uint32_t next_random(uint64_t *random) {
    *random = *random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*random >> 33);
}

// One to four bytes become others: any, a digit, a neighbour in the file, or a bit changes.
static void mutate(struct sample *sample, uint64_t *random) {
    for (uint32_t n = next_random(random) % 4 + 1; n > 0; n--) {
        unsigned char *byte = &sample->bytes[next_random(random) % sample->size];
        switch (next_random(random) % 4) {
        case 0:
            *byte = (unsigned char)next_random(random);
            break;
        case 1:
            *byte = (unsigned char)('0' + next_random(random) % 10);
            break;
        case 2:
            *byte = sample->bytes[next_random(random) % sample->size];
            break;
        default:
            *byte ^= (unsigned char)(1u << next_random(random) % 8);
        }
    }
}

static void random_bytes_are_clean(void **state) {
    (void)state;
    restore_parts();
    const char *rounds_text = getenv("GNOMON_FUZZ_ROUNDS");
    const int rounds = rounds_text ? atoi(rounds_text) : 1500;
    uint64_t random = 12345;
    for (size_t k = 0; k < KIND_COUNT; k++) {
        int good = 0;
        for (int i = 0; i < rounds; i++) {
            char what[64];
            struct sample sample = {.name = kinds[k].name};
            kinds[k].make(&sample);
            mutate(&sample, &random);
            snprintf(what, sizeof what, "%s, mutation %d", sample.name, i);
            good += load(k, sample.bytes, sample.size, what, NULL);
        }
        // Some changes do no harm, and some do, or the test is none.
        if (rounds >= 1000 && (good == 0 || good == rounds)) fail_msg("%s: %d of %d loaded", kinds[k].name, good, rounds);
        restore_parts();
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_files_load),
        cmocka_unit_test(every_beginning_is_clean),
        cmocka_unit_test(random_bytes_are_clean),
    };
    return cmocka_run_group_tests_name("broken files", tests, scratch_open, scratch_close);
}
