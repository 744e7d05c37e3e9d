// Bad input: every file in tests/bad with the message that it must give, and its place. All are GN_SCENE.
#include "scratch.h"

#include "scene/scene.h"

#define FOLDER TEST_SOURCE_DIR "/tests/bad/"

// The message begins with the file's path, unless `says` begins with another file's name; then comes `says`.
static const struct {
    const char *file, *says;
} cases[] = {
    // scene files
    {"background_negative.json", ":3:24: background[2] is -1, expected a number of at least 0"},
    {"camera_at_itself.json", ":3:48: camera.look_at is the camera's position, expected a point to look at elsewhere"},
    {"camera_fov.json", ":3:73: camera.fov_y_deg is 180, expected a number greater than 0 and less than 180"},
    {"camera_position.json", ":3:13: camera has no 'position', expected 3 numbers"},
    {"camera_up_along.json", ":3:66: camera.up is along the view, expected a direction across it"},
    {"camera_up_zero.json", ":3:66: camera.up is zero, expected a direction such as [0,1,0]"},
    {"center_overflow.json", ":3:47: shapes[0].center[1] is 1e39, expected a number within the range of fp32, ±3.4028235e38"},
    {"center_short.json", ":3:43: shapes[0].center is a list of 2, expected a list of 3 numbers"},
    {"deep.json", ":1:2073: not valid JSON: maximum parsing depth reached near '['"},
    {"duplicate_key.json", ":4:3: not valid JSON: duplicate object key near '\"ambient\"'"},
    {"empty.json", ":1:1: the file is empty, expected JSON"},
    {"film_height_large.json", ":3:22: film.height is 65536, expected an integer from 1 to 65535"},
    {"film_spp_fraction.json", ":3:19: film.spp is 1.5, expected an integer from 1 to 16777216"},
    {"film_transfer.json", ":3:24: film.transfer is \"sRGB\", expected \"srgb\" or \"linear\"; did you mean 'srgb'?"},
    {"film_width_zero.json", ":3:21: film.width is 0, expected an integer from 1 to 65535"},
    {"light_falloff.json", ":3:66: lights[0].falloff is \"Inverse_Square\", expected \"none\" or \"inverse_square\"; did you mean"},
    {"light_intensity.json", ":3:75: lights[0].intensity[2] is -1, expected a number of at least 0"},
    {"light_position.json", ":4:5: lights[0] has no 'position', expected 3 numbers"},
    {"light_type.json", ":3:23: lights[0].type is \"spott\", expected \"point\", \"directional\" or \"spot\"; did you mean 'spot'?"},
    {"list.json", ":1:1: the scene is a list, expected an object"},
    {"material_missing.json", ":4:79: shapes[0].material is \"rde\", expected the name of one of the 1 materials in \"materials\";"},
    {"material_negative.json", ":3:43: materials.a.b\"é.diffuse[1] is -0.5, expected a number of at least 0"},
    {"mesh_bad.json", "index_large.obj:4:7: vertex 4, but the file has only 3"},
    {"mesh_folder.json", ":3:39: shapes[0].file is \"../bad\", expected a file that can be read: it is a directory"},
    {"mesh_missing.json", ":3:39: shapes[0].file is \"nowhere.obj\", expected a file that can be read: No such"},
    {"mesh_no_file.json", ":3:14: shapes[0] has no 'file', expected the path of a mesh"},
    {"no_type.json", ":4:5: shapes[0] has no 'type', expected \"sphere\", \"triangle\", \"mesh\", \"rectangle\" or \"instance\""},
    {"no_version.json", ":2:1: the scene has no 'version', expected \"version\": 1"},
    {"normals_unknown.json", ":3:67: shapes[0].normals is \"smoth\", expected \"file\", \"flat\" or \"smooth\"; did you mean 'smooth'?"},
    {"not_utf8.json", ":3:13: not valid JSON: unable to decode byte 0xff near '\"'"},
    {"number_overflow.json", ":3:15: not valid JSON: real number overflow near '1e999'"},
    {"radius_negative.json", ":5:55: shapes[1].radius is -1, expected a number greater than 0"},
    {"radius_text.json", ":3:64: shapes[0].radius is a string, expected a number greater than 0"},
    {"radius_underflow.json", ":3:64: shapes[0].radius is 1e-50, expected a number greater than 0; in fp32 this is 0"},
    {"radius_zero.json", ":3:64: shapes[0].radius is 0, expected a number greater than 0"},
    {"shadows_null.json", ":4:14: shadows is null, expected true or false"},
    {"shadows_number.json", ":3:14: shadows is 0, expected true or false"},
    {"shininess_negative.json", ":3:36: materials.m.shininess is -2, expected a number of at least 0"},
    {"syntax.json", ":3:14: not valid JSON: unexpected token near '}'"},
    {"transform_last_row.json", ":3:119: shapes[0].transform[3][2] is 1, expected 0: the last row must be 0 0 0 1"},
    {"transform_nearly_singular.json", ":3:69: shapes[0].transform is singular or nearly so (condition number 1.41e+08), expected a"},
    {"transform_overflow.json", ":3:69: shapes[0].transform takes vertex 1 of the mesh out of the range of fp32, expected smaller"},
    {"transform_row.json", ":3:84: shapes[0].transform[1] is a list of 3, expected a row of 4 numbers"},
    {"transform_short.json", ":3:69: shapes[0].transform is a list of 3, expected 4 rows of 4 numbers"},
    {"transform_singular.json", ":3:69: shapes[0].transform is singular or nearly so (condition number inf), expected a transform"},
    {"truncated.json", ":4:24: not valid JSON: premature end of input near '\"cent'"},
    {"unknown_key.json", ":4:45: shapes[0] has an unknown key 'raduis', expected one of: type, center, radius, material, motion; did you"},
    {"unknown_top_key.json", ":3:3: the scene has an unknown key 'light', expected one of: $schema, version, camera, film, background,"},
    {"unknown_type.json", ":3:23: shapes[0].type is \"sfere\", expected \"sphere\", \"triangle\", \"mesh\", \"rectangle\" or \"instance\"; did you mean 'sphere'?"},
    {"utf16.json", ":1:1: the file is UTF-16, expected UTF-8"},
    {"version_2.json", ":1:13: version is 2, expected 1, the only version there is"},
    {"vertices_short.json", ":3:47: shapes[0].vertices is a list of 2, expected a list of 3 points"},
    // OBJ, MTL
    {"continued.obj", ":6:2: vertex 5, but the file has only 3"},
    {"empty.obj", ": has no triangles, expected at least one face ('f')"},
    {"face_short.obj", ":3:1: a face of 2 vertices, expected at least 3"},
    {"face_word.obj", ":4:5: expected a vertex: v, v/vt, v//vn or v/vt/vn, found '2/'"},
    {"index_below.obj", ":4:7: vertex -4, but only 3 are above"},
    {"index_huge.obj", ":4:7: vertex 9223372036854775807, expected at most 2^31"},
    {"index_large.obj", ":4:7: vertex 4, but the file has only 3"},
    {"index_zero.obj", ":4:3: vertex 0, expected numbers from 1 or, from the end, below 0"},
    {"library.obj", "color.mtl:2:6: green is -0.5, expected at least 0"},
    {"no_faces.obj", ": has no triangles, expected at least one face ('f')"},
    {"normal_index.obj", ":5:11: normal 2, but the file has only 1"},
    {"vertex_inf.obj", ":2:7: z of a vertex is -inf, expected a finite number within the range of fp32"},
    {"vertex_nan.obj", ":2:5: y of a vertex is nan, expected a finite number within the range of fp32"},
    {"vertex_overflow.obj", ":2:9: z of a vertex is 1e39, expected a finite number within the range of fp32"},
    {"vertex_short.obj", ":2:6: expected a number (z of a vertex), found the end of the line"},
    {"vertex_word.obj", ":2:7: expected a number (z of a vertex), found '0x1p3'"},
    // PLY
    {"binary_cut.ply", ": byte 208: face 0 of 1: the file ends here, expected more data"},
    {"binary_index.ply", ": byte 214: face 0 of 1: there is no vertex 3, expected 0 to 2"},
    {"binary_nan.ply", ": byte 185: vertex 1 of 3: y is nan, expected a finite number within the range of fp32"},
    {"binary_overflow.ply", ": byte 190: vertex 1 of 3: y is 1e+39, expected a finite number within the range of fp32"},
    {"binary_promise.ply", ":3:9: 4000000000 rows of at least 12 bytes are promised, but 36 bytes follow the header"},
    {"cut.ply", ":3:9: 3 rows of at least 6 bytes are promised, but 9 bytes follow the header"},
    {"empty.ply", ":1:1: is no PLY file, expected 'ply' on the first line"},
    {"face_short.ply", ":12:6: face 0 of 1: a face of 2 vertices, expected at least 3"},
    {"format.ply", ":2:8: expected ascii, binary_little_endian or binary_big_endian, found 'binary_middle_endian'"},
    {"header_cut.ply", ":5:1: expected format, element, property, comment or end_header, found 'prope'"},
    {"index_float.ply", ":8:27: the vertices of a face are no list of integers, expected one"},
    {"index_large.ply", ":13:7: face 0 of 1: there is no vertex 3, expected 0 to 2"},
    {"index_negative.ply", ":13:5: face 0 of 1: there is no vertex -1, expected 0 to 2"},
    {"index_scalar.ply", ":8:14: the vertices of a face are no list of integers, expected one"},
    {"length_float.ply", ":8:15: a list with a length that is no integer, expected an integer type"},
    {"magic.ply", ":1:1: is no PLY file, expected 'ply' on the first line"},
    {"nan.ply", ":11:3: y is nan, expected a finite number within the range of fp32"},
    {"negative_count.ply", ":3:16: expected a number of rows, found '-3'"},
    {"negative_length.ply", ": byte 204: face 0 of 1: a face of -3 vertices, expected at least 3"},
    {"no_faces.ply", ":7:9: the file has no triangles, expected faces and vertices"},
    {"no_format.ply", ":8:1: the header ends without a format line"},
    {"no_z.ply", ":3:9: the vertices have no property z, expected x, y and z"},
    {"points.ply", ":1:1: the file has no triangles, expected faces and vertices"},
    {"promise.ply", ":3:9: 4000000000 rows of at least 6 bytes are promised, but 26 bytes follow the header"},
    {"strips.ply", ":7:9: triangle strips are not supported, expected an element 'face'"},
    {"twice.ply", ":5:16: property 'x' is there twice, expected different names"},
    {"type.ply", ":5:10: expected a type: char, uchar, short, ushort, int, uint, float or double, found 'half'"},
    {"x_list.ply", ":4:27: property x is a list, expected a number"},
    // STL
    {"binary_cut.stl", ": byte 80: 2 facets take 184 bytes, but the file has 134"},
    {"binary_inf.stl", ": byte 108: facet 0 has a vertex with inf, expected a finite number"},
    {"binary_none.stl", ": has no triangles, expected at least one"},
    {"cut.stl", ":5:16: expected a number (y of a vertex), found the end of the file"},
    {"empty.stl", ": is no STL file: 0 bytes, expected at least 84"},
    {"nan.stl", ":5:16: y of a vertex is nan, expected a finite number within the range of fp32"},
    {"no_end.stl", ":9:1: expected 'facet' or 'endsolid', found the end of the file"},
    {"no_facets.stl", ": has no triangles, expected at least one"},
    {"word.stl", ":7:5: expected 'endloop', found 'vertex'"},
    // glTF
    {"accessor_long.gltf", ":7:17: accessors[0] has 4 elements, which end behind its buffer view of 36 bytes"},
    {"accessor_number.gltf", ":6:73: meshes[0].primitives[0].indices is 2, expected an integer from 0 to 1"},
    {"accessor_sparse.gltf", ":7:96: accessors[0].sparse is there, but sparse accessors are not supported"},
    {"accessor_type.gltf", ":7:17: accessors[0] is of type VEC2, expected VEC3 for POSITION"},
    {"buffer_missing.gltf", ":9:41: buffers[0].uri is \"nowhere.bin\", expected a file that can be read: No such"},
    {"buffer_short.gltf", ":9:46: buffers[0].uri holds less than the 1000000 bytes that byteLength says"},
    {"circle.gltf", ":5:13: nodes[0] is its own parent or has more than 500 above it, expected a tree"},
    {"draco.gltf", ":10:26: extensionsRequired[0] is KHR_draco_mesh_compression, which is not supported"},
    {"index_large.gltf", ":6:30: meshes[0].primitives[0] has index 3 at 2, expected at most 2"},
    {"nan.gltf", ": vertex 1 of meshes[0] is (1, nan, 0), expected finite numbers"},
    {"no_mesh.gltf", ": has no triangles, expected at least one"},
    {"syntax.gltf", ":1:11: not valid JSON: unexpected token near '}'"},
    {"two_parents.gltf", ":5:57: nodes[1].children[0] is node 2, which has a parent already, expected a tree"},
    {"version_1.gltf", ":2:12: asset is of version \"1.0\", expected \"2.0\""},
    {"view_long.gltf", ":8:19: bufferViews[0] ends behind its buffer of 44 bytes"},
    {"cut.glb", ": byte 8: the file is to have 255 bytes, but it has 12"},
    {"magic.glb", ": byte 4: is no GLB of version 2, expected one"},
    {"no_json.glb", ": byte 12: no whole JSON chunk, expected one"},
    // what Assimp says no to
    {"junk.off", ": Assimp cannot read it: OFF: There are no valid vertices"},
};

// What other files there refer to.
static const char *const helpers[] = {"good_quad.obj", "color.mtl"};

static void each_says_what_is_wrong(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[1024], expected[2048];
        snprintf(path, sizeof path, "%s%s", FOLDER, cases[i].file);
        const bool elsewhere = cases[i].says[0] != ':';
        snprintf(expected, sizeof expected, "%s%s%s", FOLDER, elsewhere ? "" : cases[i].file, cases[i].says);
        struct scene scene;
        const bool loaded = scene_load(&scene, scratch_context(), path);
        const struct gn_error *error = &scratch_state()->error;
        if (loaded || error->status != GN_SCENE || strncmp(error->message, expected, strlen(expected)) != 0)
            fail_msg("%s: status %d\n  \"%s\", expected\n  \"%s\"", cases[i].file, (int)error->status, error->message, expected);
        assert_null(scene.shapes);
        assert_null(scene.path);
    }
}

static bool is_known(const char *name) {
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (strcmp(cases[i].file, name) == 0) return true;
    for (size_t i = 0; i < sizeof helpers / sizeof *helpers; i++)
        if (strcmp(helpers[i], name) == 0) return true;
    return name[0] == '.';
}

static void none_is_forgotten(void **state) {
    (void)state;
    DIR *folder = opendir(FOLDER);
    assert_non_null(folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        if (!is_known(entry->d_name)) fail_msg("tests/bad/%s is in no table", entry->d_name);
    closedir(folder);
}

// What is good about the files: the same reader takes them when the fault is mended.
static void helpers_are_good(void **state) {
    (void)state;
    struct scene scene;
    scratch_assert(scene_load(&scene, scratch_context(), FOLDER "good_quad.obj"));
    assert_int_equal(scene_triangle_count(&scene), 2);
    scene_finish(&scene);
}

static void unreadable_files_are_another_matter(void **state) {
    (void)state;
    struct scene scene;
    scratch_assert_fails(scene_load(&scene, scratch_context(), "/nowhere/scene.json"), GN_IO, "/nowhere/scene.json: ");
    scratch_assert_fails(scene_load(&scene, scratch_context(), "/nowhere/model.ply"), GN_IO, "/nowhere/model.ply: ");
    scratch_assert_fails(scene_load(&scene, scratch_context(), FOLDER), GN_IO, "directory");
    scratch_assert_fails(scene_load(&scene, scratch_context(), TEST_SOURCE_DIR "/CMakeLists.txt"), GN_SCENE,
                         "is no scene (.json) and no model");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_says_what_is_wrong),
        cmocka_unit_test(none_is_forgotten),
        cmocka_unit_test(helpers_are_good),
        cmocka_unit_test(unreadable_files_are_another_matter),
    };
    return cmocka_run_group_tests_name("bad input", tests, NULL, NULL);
}
