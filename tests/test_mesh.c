// Meshes: what each reader makes of a file, transforms, computed normals.
#include "scratch.h"

#include <float.h>
#include <math.h>

#include "scene/import.h"
#include "scene/mesh.h"
#include "scene/unique.h"

static const double PI = 3.14159265358979323846;

// Loads a text as a file of this name.
static struct model load_text(const char *name, const char *text) {
    struct model model;
    const char *path = scratch_file(name, text, strlen(text));
    scratch_assert(model_load(&model, scratch_context(), path));
    return model;
}

static void assert_vertices(const struct scene_mesh *mesh, const float *expected, uint32_t count) {
    assert_int_equal(mesh->vertex_count, count);
    assert_memory_equal(mesh->positions, expected, count * 3 * sizeof(float));
}

static void assert_indices(const struct scene_mesh *mesh, const uint32_t *expected, uint32_t triangles) {
    assert_int_equal(mesh->triangle_count, triangles);
    assert_memory_equal(mesh->indices, expected, triangles * 3 * sizeof(uint32_t));
}

// --------------------------------------------------------------------------------------------------------------------- OBJ

static void obj_keeps_the_order_of_the_file(void **state) {
    (void)state;
    // A comment, every form of a corner, a continued line, CRLF, colors, negative numbers, a use before the definition.
    struct model model =
        load_text("a.obj", "\xef\xbb\xbf# comment \\\n\nv 0 0 0 # here, too\r\n  v\t1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 \\\n 0\nvt 1 2\n"
                           "g a b\ns 1\nf 1 2 3 4 5\nf -1 -2 -4\nl 1 2\nv 16777217 3e-46 -0\nf 1 3 2");
    static const float vertices[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 16777216, 0, -0.0f};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 3, 2, 0, 0, 2, 1};
    assert_vertices(&model.mesh, vertices, 5);
    assert_indices(&model.mesh, triangles, 5);
    assert_null(model.mesh.normals);
    assert_null(model.mesh.materials);
    assert_int_equal(model.material_count, 0);
    model_finish(&model);
}

static void obj_splits_vertices_by_normal(void **state) {
    (void)state;
    struct model model =
        load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 2\nf 1//1 2//1 3//1\nf 1//2 2//1 3//-2\nf 1 2 3\n");
    static const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 1, 2, 4, 5, 6};
    assert_vertices(&model.mesh, vertices, 7);
    assert_indices(&model.mesh, triangles, 3);
    assert_memory_equal(model.mesh.normals, normals, sizeof normals);
    model_finish(&model);
}

static void obj_splits_vertices_by_texture_coordinate(void **state) {
    (void)state;
    struct model model = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0 0\nvt 7\nvn 0 0 1\n"
                                            "f 1/1 2/2 3/-1\nf 1/1 2/1 3/3\nf 1/2/1 2/2 3\n");
    static const float uvs[] = {0, 0.75f, 1, 1, 7, 1, 0, 0.75f, 1, 1, 0, 0}; // v goes down
    static const uint32_t triangles[] = {0, 1, 2, 0, 3, 2, 4, 1, 5};
    assert_int_equal(model.mesh.vertex_count, 6);
    assert_indices(&model.mesh, triangles, 3);
    assert_memory_equal(model.mesh.uvs, uvs, sizeof uvs);
    assert_true(model.mesh.normals[3 * 4 + 2] == 1 && model.mesh.normals[2] == 0);
    model_finish(&model);
}

static void obj_has_materials(void **state) {
    (void)state;
    const char library[] = "# two\nnewmtl red one\n Kd 1 0 0\n Ks 0.25\n Ns 20 \nmap_Kd a.png\nnewmtl blue\nKa 0 0 0.5\nKd 0 0 1\nNs "
                           "-1\nnewmtl unused\nKd 1 1 1\n";
    scratch_file("two colors.mtl", library, strlen(library));
    struct model model = load_text("a.obj", "mtllib two colors.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl red one\nf 1 2 3\nf 1 2 3\n"
                                            "usemtl blue\nusemtl red one\nusemtl blue\nf 1 2 3\nusemtl red one\nf 1 2 3\n");
    static const uint32_t materials[] = {2, 0, 0, 1, 0};
    assert_int_equal(model.material_count, 3);
    assert_memory_equal(model.mesh.materials, materials, sizeof materials);
    const struct scene_material *m = model.materials;
    assert_string_equal(m[0].name, "red one");
    assert_string_equal(m[1].name, "blue");
    assert_string_equal(m[2].name, "default");
    assert_true(m[0].diffuse[0] == 1 && m[0].diffuse[1] == 0 && m[0].ambient[0] == 1 && m[0].ambient[2] == 0); // Ka is Kd
    assert_true(m[0].specular[2] == 0.25f && m[0].shininess == 20);
    assert_true(m[1].ambient[2] == 0.5f && m[1].diffuse[2] == 1 && m[1].shininess == 0);
    assert_true(m[2].diffuse[0] == 0.8f);
    model_finish(&model);
}

// Everything that a library can say of a material; the files of the textures need only be there.
static void obj_has_textures_and_effects(void **state) {
    (void)state;
    const char library[] =
        "newmtl a\nKd 0.5 0.5 0.5\nKe 3\nNi 1.25\nd 0.5\nmap_Kd -s 2 4 -o 0.5 0.25 1 -clamp on -bm 2 x y.png\nnorm n.png\nmap_Ke x y.png\n"
        "newmtl b\nKs 0.5 0.25 2\nillum 3\nmap_Kd n.png\nmap_d n.png\n"
        "newmtl c\nillum 7\nTf 1 0.5 0.25\nKa 1 1 1\nKd 0 0 0\nd 1\nNi 2\nmap_Kd .\\n.png\nmap_d x y.png\n"
        "newmtl d\nmap_d n.png\nmap_Kd gone.png\nd -halo 0\n";
    scratch_file("t.mtl", library, strlen(library));
    scratch_file("x y.png", "", 0);
    scratch_file("n.png", "", 0);
    struct model model =
        load_text("a.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n"
                           "usemtl d\nf 1 2 3\n");
    const struct scene_material *m = model.materials;
    const struct texture_source *t = model.textures;
    assert_int_equal(model.texture_count, 6);
    assert_true(m[0].emission[2] == 3 && m[0].ior == 1.25f && m[0].alpha == 0.5f && m[0].alpha_mode == ALPHA_BLEND);
    assert_true(m[0].diffuse_map.texture == 1 && m[0].emission_map.texture == 2 && m[0].normal_map.texture == 3);
    assert_true(m[0].diffuse_map.srgb && m[0].emission_map.srgb && !m[0].normal_map.srgb);
    static const float transform[6] = {2, 0, 0.5f, 0, 4, -3.25f}; // v' = 1 - (4 (1 - v) + 0.25)
    assert_memory_equal(m[0].diffuse_map.transform, transform, sizeof transform);
    assert_true(strstr(t[0].name, "/x y.png") && t[0].wrap_u == WRAP_CLAMP && t[0].wrap_v == WRAP_CLAMP && t[1].wrap_u == WRAP_REPEAT);
    assert_true(m[1].model == MODEL_PHONG && m[1].reflection[0] == 0.5f && m[1].reflection[2] == 1);
    assert_true(m[1].alpha_mode == ALPHA_BLEND && m[1].diffuse[0] == 1 && !t[m[1].diffuse_map.texture - 1].alpha_name); // its own alpha
    assert_true(m[2].model == MODEL_DIELECTRIC && m[2].diffuse[1] == 0.5f && m[2].ambient[0] == 0 && m[2].ior == 2);
    assert_true(strstr(t[m[2].diffuse_map.texture - 1].name, "n.png") && strstr(t[m[2].diffuse_map.texture - 1].alpha_name, "/x y.png"));
    assert_true(m[3].alpha == 1 && strstr(t[m[3].diffuse_map.texture - 1].alpha_name, "/n.png"));
    model_finish(&model);
}

static void note(void *user, enum gn_level level, const char *text) {
    if (level == GN_LEVEL_WARNING) snprintf(user, 512, "%s", text);
}

static void obj_warns_of_what_is_missing(void **state) {
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"mtllib gone.mtl\nv 0 0 0\nf 1 1 1\n", "a.obj:1:8: material library "},
        {"v 0 0 0\nwhatever 3\nother 4\nf 1 1 1\n", "a.obj:2:1: statement 'whatever' is not known"},
        {"mtllib two\\ncolors.mtl\nusemtl x\nv 0 0 0\nf 1 1 1\n", "material library"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char warning[512] = "";
        struct gn_error error;
        struct gn_host host = {.user = warning, .message = note};
        struct context ctx = context_make(&host, &error);
        struct model model;
        assert_true(model_load(&model, &ctx, scratch_file("a.obj", cases[i].text, strlen(cases[i].text))));
        if (!strstr(warning, cases[i].says)) fail_msg("'%s', expected '%s'", warning, cases[i].says);
        model_finish(&model);
    }
}

// --------------------------------------------------------------------------------------------------------------------- PLY

struct bytes {
    unsigned char data[4096];
    size_t size;
    bool big;
};

static void put_bits(struct bytes *bytes, uint64_t bits, unsigned size) {
    for (unsigned i = 0; i < size; i++) bytes->data[bytes->size++] = (unsigned char)(bits >> (8 * (bytes->big ? size - 1 - i : i)) & 0xff);
}

static void put_double(struct bytes *bytes, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bits(bytes, bits, 8);
}

static void put_float(struct bytes *bytes, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bits(bytes, bits, 4);
}

static const char ply_rest[] =
    "comment of no use\nobj_info none\nelement odd 2\nproperty list ushort double values\nproperty char c\nelement vertex 4\nproperty "
    "uchar red\n"
    "property double x\nproperty short y\nproperty list uchar float more\nproperty float z\nelement nothing 4000000000\n"
    "element face 2\nproperty float quality\nproperty list char ushort vertex_indices\nend_header\n";
// 1 + 2^-24 + 2^-50 rounds up, by way of nothing else; y is an integer.
#define PLY_X 1.00000005960464566
static const float ply_vertices[] = {0, -2, 0.5f, 0x1.000002p0f, 3, 0, 2, -32768, 1e-40f, 4, 32767, -0.0f};
static const uint32_t ply_triangles[] = {0, 1, 2, 3, 2, 1, 3, 1, 0};

static void assert_ply(const char *path) {
    struct model model;
    scratch_assert(model_load(&model, scratch_context(), path));
    assert_vertices(&model.mesh, ply_vertices, 4);
    assert_indices(&model.mesh, ply_triangles, 3);
    assert_null(model.mesh.normals);
    model_finish(&model);
}

static void ply_is_the_same_in_ascii(void **state) {
    (void)state;
    char text[2048];
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\n%s2 1 2 3\n0 -1\n255 0 -2 2 nan nan .5\n0 %.17g 3 0 0\n0 2 -32768 1 1 1e-40\n0 4 32767 0\n-0\n"
             "0 3 0 1 2\n.5 4 3 2 1 0\n",
             ply_rest, PLY_X);
    assert_ply(scratch_file("a.ply", text, strlen(text)));
}

static void ply_is_the_same_in_binary(void **state) {
    (void)state;
    static const double x[4] = {0, PLY_X, 2, 4};
    static const int y[4] = {-2, 3, -32768, 32767}, more[4] = {2, 0, 1, 0};
    static const float z[4] = {0.5f, 0, 1e-40f, -0.0f};
    for (int big = 0; big < 2; big++) {
        struct bytes b = {.big = big};
        b.size = (size_t)snprintf((char *)b.data, sizeof b.data, "ply\nformat binary_%s_endian 1.0\n%s", big ? "big" : "little", ply_rest);
        put_bits(&b, 2, 2), put_double(&b, 1), put_double(&b, 2), put_bits(&b, 3, 1);
        put_bits(&b, 0, 2), put_bits(&b, 0xff, 1);
        for (int i = 0; i < 4; i++) {
            put_bits(&b, 255, 1), put_double(&b, x[i]), put_bits(&b, (uint64_t)(uint16_t)y[i], 2), put_bits(&b, (uint64_t)more[i], 1);
            for (int k = 0; k < more[i]; k++) put_float(&b, NAN);
            put_float(&b, z[i]);
        }
        put_float(&b, 0), put_bits(&b, 3, 1), put_bits(&b, 0, 2), put_bits(&b, 1, 2), put_bits(&b, 2, 2);
        put_float(&b, 0), put_bits(&b, 4, 1), put_bits(&b, 3, 2), put_bits(&b, 2, 2), put_bits(&b, 1, 2), put_bits(&b, 0, 2);
        put_bits(&b, 0x123456, 3); // what follows is not looked at
        assert_ply(scratch_file("a.ply", b.data, b.size));
    }
}

static void ply_has_normals_if_whole(void **state) {
    (void)state;
    for (int whole = 0; whole < 2; whole++) {
        char text[512];
        snprintf(
            text, sizeof text,
            "ply\r\nformat ascii 1.0\r\nelement face 1\r\nproperty list uchar int vertex_index\r\nelement vertex 3\r\n"
            "property float nx\r\nproperty float %s\r\nproperty float nz\r\nproperty float z\r\nproperty float y\r\nproperty float x\r\n"
            "end_header\r\n3 0 1 2\r\n1 2 3 4 5 6\r\n1 2 3 4 5 7\r\n1 2 3 4 6 6\r\n",
            whole ? "ny" : "my");
        struct model model = load_text("a.ply", text);
        static const float vertices[] = {6, 5, 4, 7, 5, 4, 6, 6, 4}, normals[] = {1, 2, 3, 1, 2, 3, 1, 2, 3};
        assert_vertices(&model.mesh, vertices, 3);
        if (whole)
            assert_memory_equal(model.mesh.normals, normals, sizeof normals);
        else
            assert_null(model.mesh.normals);
        model_finish(&model);
    }
}

// --------------------------------------------------------------------------------------------------------------------- STL

static void ply_has_texture_coordinates(void **state) {
    (void)state;
    static const struct {
        const char *first, *second;
        bool there;
    } cases[] = {
        {"float s", "float t", true},  {"double u", "uchar v", true}, {"float texture_u", "float texture_v", true},
        {"float s", "float w", false}, {"float u", "float t", true},  {"float v", "float u", true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(
            text, sizeof text,
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty %s\n"
            "property %s\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 3\n1 0 0 1 0\n0 1 0 1 1\n3 0 1 2\n",
            cases[i].first, cases[i].second);
        struct model model = load_text("a.ply", text);
        const float *uvs = model.mesh.uvs;
        if ((uvs != NULL) != cases[i].there) fail_msg("case %zu", i);
        if (uvs && i < 5) assert_true(uvs[0] == 1 && uvs[1] == -2 && uvs[3] == 1 && uvs[5] == 0);
        if (uvs && i == 5) assert_true(uvs[0] == 3 && uvs[1] == 0);
        model_finish(&model);
    }
}

static void stl_is_the_same_in_both_forms(void **state) {
    (void)state;
    static const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0.1f};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5};
    struct bytes b = {0};
    b.size = (size_t)snprintf((char *)b.data, sizeof b.data, "%-80s", "solid, says this binary file");
    put_bits(&b, 2, 4);
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) put_float(&b, NAN);
        for (int k = 0; k < 9; k++) put_float(&b, vertices[9 * i + k]);
        put_bits(&b, 0xabcd, 2);
    }
    const char text[] =
        "solid facet\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid facet\n"
        "SOLID\n\n  FACET NORMAL 0 0 1 OUTER LOOP VERTEX 0 0 0\nVERTEX 0 1 0 VERTEX 0 0 1e-1 ENDLOOP ENDFACET ENDSOLID";
    for (int ascii = 0; ascii < 2; ascii++) {
        struct model model;
        const char *path = ascii ? scratch_file("a.stl", text, strlen(text)) : scratch_file("a.STL", b.data, b.size);
        scratch_assert(model_load(&model, scratch_context(), path));
        assert_vertices(&model.mesh, vertices, 6);
        assert_indices(&model.mesh, triangles, 2);
        model_finish(&model);
    }
}

// -------------------------------------------------------------------------------------------------------------------- glTF

static void assert_near(const float a[3], double x, double y, double z, double error) {
    const double b[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        if (!(fabs(a[i] - b[i]) <= error))
            fail_msg("(%g, %g, %g), expected (%g, %g, %g)", (double)a[0], (double)a[1], (double)a[2], x, y, z);
}

// A triangle (0,0,0) (1,0,0) (0,1.5,0), indexed, and again as a strip, below a node that turns by 90° about z and another that moves.
static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[2,0]}],\"nodes\":["
    "{\"name\":\"same\",\"mesh\":0},"
    "{\"name\":\"same\",\"mesh\":0,\"rotation\":[0,0,0.70710678118654752,0.70710678118654752],\"scale\":[2,1,1],\"children\":[3]},"
    "{\"name\":\"same\",\"translation\":[10,20,30],\"children\":[1,4]},"
    "{\"translation\":[1,0,0],\"camera\":0},"
    "{\"translation\":[0,0,5],\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}}],"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"directional\"},{\"type\":\"point\",\"color\":[1,0.5,0],\"intensity\":"
    "8}]}},"
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5,\"aspectRatio\":3,\"znear\":0.1}}],"
    "\"meshes\":[{\"primitives\":[{\"mode\":1,\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":"
    "1},"
    "{\"attributes\":{\"POSITION\":0},\"mode\":5}]}],"
    "\"materials\":[{\"name\":\"never\"},{\"name\":\"paint\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1],"
    "\"metallicFactor\":0,"
    "\"roughnessFactor\":0.5}}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":42}],"
    "\"buffers\":[{\"byteLength\":42,\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAwD8AAAAAAgABAAAA\"}]}";

// Where a corner of a triangle is. The vertices' numbers say nothing: Assimp 5.2 keeps those of the file, 5.4 counts them as they are used.
static const float *corner(const struct scene_mesh *mesh, uint32_t triangle, uint32_t number) {
    return mesh->positions + 3 * (size_t)mesh->indices[3 * triangle + number];
}

static void gltf_composes_its_nodes(void **state) {
    (void)state;
    struct model model = load_text("a.gltf", gltf);
    // Depth first in the order of the scene: node 2, its child 1, then node 0; two triangles each, the indexed one from its last vertex.
    static const uint32_t materials[] = {0, 1, 0, 1};
    assert_int_equal(model.mesh.triangle_count, 4);
    assert_int_equal(model.mesh.vertex_count, 12);
    assert_memory_equal(model.mesh.materials, materials, sizeof materials);
    static const float plain[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1.5f, 0}};
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t triangle = 0; triangle < 2; triangle++) {
            const float *vertex = plain[triangle == 0 ? 2 - k : k];
            assert_near(corner(&model.mesh, triangle, k), 10 - vertex[1], 20 + 2 * vertex[0], 30, 1e-5); // x, times 2, becomes y
            assert_memory_equal(corner(&model.mesh, 2 + triangle, k), vertex, sizeof plain[0]);          // bit for bit
        }
    assert_int_equal(model.material_count, 2);
    assert_string_equal(model.materials[0].name, "paint");
    assert_string_equal(model.materials[1].name, "default");
    assert_near(model.materials[0].diffuse, 0.5, 0.25, 1, 0);
    assert_int_equal(model.materials[0].model, MODEL_METALLIC_ROUGHNESS);
    assert_true(model.materials[0].metallic == 0 && model.materials[0].roughness == 0.5f);
    model_finish(&model);
}

static void gltf_has_cameras_and_lights(void **state) {
    (void)state;
    struct model model = load_text("a.gltf", gltf);
    assert_int_equal(model.camera_count, 1);
    assert_near(model.cameras[0].position, 10, 22, 30, 1e-5); // not moved twice
    assert_true(fabs(model.cameras[0].fov_y_deg - 0.5 * 180 / PI) < 1e-4);
    assert_near(model.cameras[0].up, -1, 0, 0, 1e-6);
    assert_true(model.cameras[0].look_at[2] < 29 && fabsf(model.cameras[0].look_at[0] - 10) < 1e-4f);
    assert_int_equal(model.light_count, 1); // the other is no point, and no node has it
    assert_near(model.lights[0].position, 10, 20, 35, 1e-5);
    assert_near(model.lights[0].intensity, 8 / PI, 4 / PI, 0, 1e-6);
    assert_int_equal(model.lights[0].falloff, FALLOFF_INVERSE_SQUARE);
    model_finish(&model);
}

// ----------------------------------------------------------------------------------------------------------------- smoothing

// A mesh from plain arrays.
static struct scene_mesh mesh_of(const float *positions, uint32_t vertices, const uint32_t *indices, uint32_t triangles) {
    struct scene_mesh mesh;
    scratch_assert(mesh_init(&mesh, scratch_context(), vertices, triangles, false));
    memcpy(mesh.positions, positions, vertices * 3 * sizeof(float));
    memcpy(mesh.indices, indices, triangles * 3 * sizeof(uint32_t));
    return mesh;
}

static const float cube_vertices[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
static const uint32_t cube[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

static void face_normal(double n[3], const struct scene_mesh *mesh, uint32_t triangle) {
    const float *a = mesh->positions + 3 * mesh->indices[3 * triangle], *b = mesh->positions + 3 * mesh->indices[3 * triangle + 1],
                *c = mesh->positions + 3 * mesh->indices[3 * triangle + 2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = ((double)b[j] - a[j]) * ((double)c[k] - a[k]) - ((double)b[k] - a[k]) * ((double)c[j] - a[j]);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++) n[i] /= length;
}

static void smoothing_keeps_sharp_edges(void **state) {
    (void)state;
    struct scene_mesh mesh = mesh_of(cube_vertices, 8, cube, 12);
    scratch_assert(mesh_smooth(&mesh, scratch_context(), 60));
    assert_int_equal(mesh.vertex_count, 24);
    for (uint32_t i = 0; i < 36; i++) {
        double n[3];
        face_normal(n, &mesh, i / 3);
        assert_near(mesh.normals + 3 * mesh.indices[i], n[0], n[1], n[2], 1e-7);
        assert_memory_equal(mesh.positions + 3 * mesh.indices[i], cube_vertices + 3 * cube[i], 3 * sizeof(float));
    }
    mesh_finish(&mesh);
}

// Two triangles that share an edge, with texture coordinates that differ at one of its ends: the normals do not.
static void smoothing_keeps_texture_coordinates(void **state) {
    (void)state;
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.1f, 1, 0, 0}, uvs[] = {0, 0, 1, 0, 0, 1, 1, 1, 7, 7};
    static const uint32_t triangles[] = {0, 1, 2, 4, 3, 2};
    struct scene_mesh mesh = mesh_of(positions, 5, triangles, 2);
    scratch_assert(mesh_add_uvs(&mesh, scratch_context()));
    memcpy(mesh.uvs, uvs, sizeof uvs);
    scratch_assert(mesh_smooth(&mesh, scratch_context(), 60));
    assert_int_equal(mesh.vertex_count, 5);
    for (int i = 0; i < 6; i++) {
        assert_memory_equal(mesh.uvs + 2 * mesh.indices[i], uvs + 2 * triangles[i], 2 * sizeof(float));
        assert_memory_equal(mesh.positions + 3 * mesh.indices[i], positions + 3 * triangles[i], 3 * sizeof(float));
    }
    assert_memory_equal(mesh.normals + 3 * mesh.indices[1], mesh.normals + 3 * mesh.indices[3], 3 * sizeof(float));
    assert_int_not_equal(mesh.indices[1], mesh.indices[3]);
    mesh_finish(&mesh);
}

// With a wide crease angle a cube's corners look along the diagonals, however its sides are cut into triangles: weights by angle.
static void smoothing_weighs_by_angle(void **state) {
    (void)state;
    struct scene_mesh mesh = mesh_of(cube_vertices, 8, cube, 12);
    scratch_assert(mesh_smooth(&mesh, scratch_context(), 100));
    assert_int_equal(mesh.vertex_count, 8);
    for (uint32_t v = 0; v < 8; v++) {
        const float *p = mesh.positions + 3 * v;
        assert_near(mesh.normals + 3 * v, p[0] / sqrt(3.0), p[1] / sqrt(3.0), p[2] / sqrt(3.0), 1e-6);
    }
    mesh_finish(&mesh);
}

// An icosahedron's faces meet by 41.8°, but those across a vertex by 70.5°: joined edge by edge.
static void smoothing_goes_from_edge_to_edge(void **state) {
    (void)state;
    const float g = 1.618034f;
    const float p[] = {-1, g,  0,  1, g, 0,  -1, -g, 0,  1, -g, 0, 0,  -1, g,  0,  1, g,
                       0,  -1, -g, 0, 1, -g, g,  0,  -1, g, 0,  1, -g, 0,  -1, -g, 0, 1};
    static const uint32_t f[] = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                                 3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
    // Each face with vertices of its own, as in an STL file, and zeros of both signs: equal positions are one.
    float separate[180];
    uint32_t numbers[60];
    for (uint32_t i = 0; i < 60; i++) {
        numbers[i] = i;
        for (int k = 0; k < 3; k++)
            separate[3 * i + (uint32_t)k] = p[3 * f[i] + (uint32_t)k] * (i % 2 && p[3 * f[i] + (uint32_t)k] == 0 ? -1.0f : 1.0f);
    }
    struct scene_mesh mesh = mesh_of(separate, 60, numbers, 20);
    scratch_assert(mesh_smooth(&mesh, scratch_context(), 60));
    assert_int_equal(mesh.vertex_count, 12);
    for (uint32_t v = 0; v < 12; v++) {
        const float *q = mesh.positions + 3 * v;
        const double length = sqrt(1 + (double)g * g);
        assert_near(mesh.normals + 3 * v, q[0] / length, q[1] / length, q[2] / length, 1e-6);
    }
    mesh_finish(&mesh);
    mesh = mesh_of(separate, 60, numbers, 20);
    scratch_assert(mesh_smooth(&mesh, scratch_context(), 41)); // less than the angle: nothing is joined
    assert_int_equal(mesh.vertex_count, 60);
    mesh_finish(&mesh);
}

// A wavy grid, its result to be the same whatever the number of threads; and all triangles around one vertex, which must not take forever.
static void smoothing_is_quick_and_the_same_on_all_threads(void **state) {
    (void)state;
    enum { SIDE = 200, FAN = 200000 };
    struct scene_mesh meshes[3];
    for (unsigned threads = 1; threads <= 3; threads++) {
        struct scene_mesh *mesh = &meshes[threads - 1];
        scratch_assert(mesh_init(mesh, scratch_context(), SIDE * SIDE, 2 * (SIDE - 1) * (SIDE - 1), false));
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            mesh->positions[3 * i] = (float)(i % SIDE), mesh->positions[3 * i + 1] = (float)(i / SIDE);
            mesh->positions[3 * i + 2] = 3 * sinf((float)(i % SIDE) * (float)(i / SIDE) * 0.01f);
        }
        uint32_t *index = mesh->indices;
        for (uint32_t y = 0; y + 1 < SIDE; y++)
            for (uint32_t x = 0; x + 1 < SIDE; x++, index += 6) {
                const uint32_t v = y * SIDE + x, quad[6] = {v, v + 1, v + SIDE, v + 1, v + SIDE + 1, v + SIDE};
                memcpy(index, quad, sizeof quad);
            }
        struct gn_error error;
        struct gn_host host = {.threads = threads};
        struct context ctx = context_make(&host, &error);
        assert_true(mesh_smooth(mesh, &ctx, 60));
        assert_int_equal(mesh->vertex_count, meshes[0].vertex_count);
        assert_memory_equal(mesh->normals, meshes[0].normals, mesh->vertex_count * 3 * sizeof(float));
        assert_memory_equal(mesh->indices, meshes[0].indices, mesh->triangle_count * 3 * sizeof(uint32_t));
    }
    assert_true(meshes[0].vertex_count > SIDE * SIDE); // some edges are sharp
    for (int i = 0; i < 3; i++) mesh_finish(&meshes[i]);
    struct scene_mesh fan;
    scratch_assert(mesh_init(&fan, scratch_context(), FAN + 1, FAN, false));
    for (uint32_t i = 0; i < FAN; i++) {
        fan.positions[3 * i + 3] = cosf((float)i), fan.positions[3 * i + 4] = sinf((float)i), fan.positions[3 * i + 5] = (float)i;
        fan.indices[3 * i] = 0, fan.indices[3 * i + 1] = i + 1, fan.indices[3 * i + 2] = i + 1 < FAN ? i + 2 : i;
    }
    scratch_assert(mesh_smooth(&fan, scratch_context(), 60));
    mesh_finish(&fan);
}

static void smoothing_stands_degenerate_triangles(void **state) {
    (void)state;
    static const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1e38f, 1e38f, 1e38f, -1e38f, 1e38f, 0, 1e-45f, 0, 0, 0, 1e-45f, 0};
    static const uint32_t triangles[] = {0, 0, 0, 0, 1, 1, 0, 1, 2, 3, 4, 0, 0, 5, 6};
    struct scene_mesh mesh = mesh_of(vertices, 7, triangles, 5);
    scratch_assert(mesh_smooth(&mesh, scratch_context(), 60));
    for (uint32_t i = 0; i < 15; i++) {
        const float *n = mesh.normals + 3 * mesh.indices[i];
        const double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
        assert_memory_equal(mesh.positions + 3 * mesh.indices[i], vertices + 3 * triangles[i], 3 * sizeof(float));
        if (!(i < 6 ? length == 0 : fabs(length - 1) < 1e-6)) fail_msg("corner %u has a normal of length %g", i, length);
    }
    mesh_finish(&mesh);
}

// ---------------------------------------------------------------------------------------------------------------- transforms

static void transforms_round_once(void **state) {
    (void)state;
    static const float vertices[] = {0.1f, 3, 1, 1, 2, 3};
    static const uint32_t none[3] = {0};
    struct scene_mesh mesh = mesh_of(vertices, 2, none, 1);
    uint32_t bad;
    // The sum in fp64, 1e4 + 1e-4 · 0.1f, is rounded at the end; the product rounded to fp32 first gives another number.
    const struct transform t = {{{1e-4, 0, 0, 1e4}, {0, 1.0 / 3, 0, 0}, {0, 0, 1e30, 0}, {0, 0, 0, 1}}};
    assert_true(mesh_transform(&mesh, &t, 0, 1, &bad));
    assert_true(mesh.positions[0] == (float)(1e4 + 1e-4 * (double)0.1f));
    assert_true(mesh.positions[1] == 1 && mesh.positions[2] == 1e30f);
    assert_true(mesh.positions[3] == 1 && mesh.positions[5] == 3); // not in the range
    const struct transform huge = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0x1.ffffffp127 / 3, 0}, {0, 0, 0, 1}}};
    assert_false(mesh_transform(&mesh, &huge, 1, 1, &bad)); // midway between FLT_MAX and infinity
    assert_int_equal(bad, 1);
    mesh_finish(&mesh);
}

static void normals_go_by_the_inverse_transpose(void **state) {
    (void)state;
    static const struct {
        struct transform t;
        double n[3], expected[3];
    } cases[] = {
        {{{{1, 0, 0, 5}, {0, 1e-4, 0, 6}, {0, 0, 1, 7}, {0, 0, 0, 1}}}, {1, 1, 0}, {1e-4, 1, 0}}, // flattened: the normal rises
        {{{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, {0.5, 1, 0}, {-0.5, 1, 0}}, // a mirror: same side
        {{{{1, 1, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, {1, 0, 0}, {1, -1, 0}},      // sheared
        {{{{1e-30, 0, 0, 0}, {0, 1e-30, 0, 0}, {0, 0, 1e-30, 0}, {0, 0, 0, 1}}}, {0, 0, 1}, {0, 0, 1}},
        {{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, {0, 0, 0}, {0, 0, 0}}, // none stays none
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct scene_mesh mesh;
        uint32_t bad;
        scratch_assert(mesh_init(&mesh, scratch_context(), 1, 0, true));
        for (int k = 0; k < 3; k++) mesh.normals[k] = (float)cases[i].n[k];
        assert_true(mesh_transform(&mesh, &cases[i].t, 0, 1, &bad));
        assert_near(mesh.normals, cases[i].expected[0], cases[i].expected[1], cases[i].expected[2], 1e-7);
        mesh_finish(&mesh);
    }
}

static void conditions_do_not_depend_on_scale(void **state) {
    (void)state;
    static const struct {
        struct transform t;
        bool sound;
    } cases[] = {
        {{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, true},
        {{{{1e-30, 0, 0, 0}, {0, -1e-30, 0, 0}, {0, 0, 1e-30, 0}, {0, 0, 0, 1}}}, true},
        {{{{1e200, 0, 0, 0}, {0, 1e200, 0, 0}, {0, 0, 1e200, 0}, {0, 0, 0, 1}}}, true},
        {{{{1, 0, 0, 0}, {0, 1e-4, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, true},
        {{{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}}}, false},
        {{{{1, 2, 3, 0}, {2, 4, 6, 0}, {1, 1, 1, 0}, {0, 0, 0, 1}}}, false},
        {{{{1 + 1.2e-7, 2, 3, 0}, {2, 4 + 1.2e-7, 6, 0}, {1, 1, 1 + 1.2e-7, 0}, {0, 0, 0, 1}}}, false}, // helped along by FLT_EPSILON
        {{{{1e-200, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, false},
    };
    assert_true(fabs(transform_condition(&cases[0].t) - 3) < 1e-12);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if ((transform_condition(&cases[i].t) < WORST_CONDITION) != cases[i].sound)
            fail_msg("case %zu: %g", i, transform_condition(&cases[i].t));
}

static void equal_rows_are_found(void **state) {
    (void)state;
    static const uint32_t rows[] = {1, 2, 3, 4, 1, 2, 0x80000000u, 0, 0, 0x80000000u, 3, 4, 2, 1};
    uint32_t number[7], distinct;
    scratch_assert(unique_rows(number, &distinct, scratch_context(), rows, 7, 2));
    static const uint32_t expected[] = {0, 1, 0, 2, 2, 1, 3};
    assert_int_equal(distinct, 4);
    assert_memory_equal(number, expected, sizeof expected);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obj_keeps_the_order_of_the_file),
        cmocka_unit_test(obj_splits_vertices_by_normal),
        cmocka_unit_test(obj_splits_vertices_by_texture_coordinate),
        cmocka_unit_test(obj_has_materials),
        cmocka_unit_test(obj_has_textures_and_effects),
        cmocka_unit_test(obj_warns_of_what_is_missing),
        cmocka_unit_test(ply_is_the_same_in_ascii),
        cmocka_unit_test(ply_is_the_same_in_binary),
        cmocka_unit_test(ply_has_normals_if_whole),
        cmocka_unit_test(ply_has_texture_coordinates),
        cmocka_unit_test(stl_is_the_same_in_both_forms),
        cmocka_unit_test(gltf_composes_its_nodes),
        cmocka_unit_test(gltf_has_cameras_and_lights),
        cmocka_unit_test(smoothing_keeps_sharp_edges),
        cmocka_unit_test(smoothing_keeps_texture_coordinates),
        cmocka_unit_test(smoothing_weighs_by_angle),
        cmocka_unit_test(smoothing_goes_from_edge_to_edge),
        cmocka_unit_test(smoothing_is_quick_and_the_same_on_all_threads),
        cmocka_unit_test(smoothing_stands_degenerate_triangles),
        cmocka_unit_test(transforms_round_once),
        cmocka_unit_test(normals_go_by_the_inverse_transpose),
        cmocka_unit_test(conditions_do_not_depend_on_scale),
        cmocka_unit_test(equal_rows_are_found),
    };
    return cmocka_run_group_tests_name("meshes", tests, scratch_open, scratch_close);
}
