// docs/scene.schema.json and docs/scene-format.md against the reader. The reader says what it knows when it is given something unknown: for
// every object and every choice of the schema, what it says must be what the schema has, and nothing of the schema is left out.
#include "scratch.h"

#include <jansson.h>

#include "scene/scene.h"

#define MATERIAL(members) "\"materials\": {\"m\": {" members "}}"
#define MAP(key, members) MATERIAL("\"model\": \"metallic_roughness\", \"" key "\": {\"file\": \"a\", " members "}")
#define LIGHT(type) "\"lights\": [{\"type\": \"" type "\", @}]"
#define SHAPE(type) "\"shapes\": [{\"type\": \"" type "\", @}]"
#define CAMERA "\"camera\": {\"position\": [0,0,1], \"look_at\": [0,0,0], "

// For each object of the schema (a JSON pointer) the members of a scene that has one; @ is where a key is added.
static const struct {
    const char *pointer, *members;
} objects[] = {
    {"", "@"},
    {"/properties/camera", CAMERA "@}"},
    {"/properties/camera/properties/motion", CAMERA "\"motion\": {@}}"},
    {"/properties/film", "\"film\": {@}"},
    {"/properties/film/properties/filter/oneOf/1", "\"film\": {\"filter\": {@}}"},
    {"/properties/environment/oneOf/1", "\"environment\": {@}"},
    {"/properties/fog", "\"fog\": {@}"},
    {"/properties/paths", "\"paths\": {@}"},
    {"/$defs/color_map/oneOf/1", MAP("diffuse_map", "@")},
    {"/$defs/color_map/oneOf/1", MAP("emission_map", "@")},
    {"/$defs/normal_map/oneOf/1", MAP("normal_map", "@")},
    {"/$defs/data_map/oneOf/1", MAP("roughness_map", "@")},
    {"/$defs/material_phong", MATERIAL("@")},
    {"/$defs/material_phong", MATERIAL("\"model\": \"phong\", @")},
    {"/$defs/material_blinn_phong", MATERIAL("\"model\": \"blinn_phong\", @")},
    {"/$defs/material_lambert", MATERIAL("\"model\": \"lambert\", @")},
    {"/$defs/material_metallic_roughness", MATERIAL("\"model\": \"metallic_roughness\", @")},
    {"/$defs/material_dielectric", MATERIAL("\"model\": \"dielectric\", @")},
    {"/$defs/material_mirror", MATERIAL("\"model\": \"mirror\", @")},
    {"/$defs/light_point", LIGHT("point")},
    {"/$defs/light_directional", LIGHT("directional")},
    {"/$defs/light_spot", LIGHT("spot")},
    {"/$defs/mesh", "\"meshes\": {\"m\": {@}}"},
    {"/$defs/shape_sphere", SHAPE("sphere")},
    {"/$defs/shape_triangle", SHAPE("triangle")},
    {"/$defs/shape_rectangle", SHAPE("rectangle")},
    {"/$defs/shape_mesh", SHAPE("mesh")},
    {"/$defs/shape_instance", SHAPE("instance")},
};

// The same for choices: a pointer to a list of words, or to alternatives whose member `key` is one word; @ is where a wrong one stands.
static const struct {
    const char *pointer, *key, *members;
} choices[] = {
    {"/properties/film/properties/transfer/enum", NULL, "\"film\": {\"transfer\": @}"},
    {"/properties/film/properties/filter/oneOf/0/enum", NULL, "\"film\": {\"filter\": @}"},
    {"/properties/film/properties/filter/oneOf/1/properties/type/enum", NULL, "\"film\": {\"filter\": {\"type\": @}}"},
    {"/properties/materials/additionalProperties/oneOf", "model", MATERIAL("\"model\": @")},
    {"/properties/lights/items/oneOf", "type", "\"lights\": [{\"type\": @}]"},
    {"/properties/shapes/items/oneOf", "type", "\"shapes\": [{\"type\": @}]"},
    {"/$defs/material_phong/properties/alpha_mode/enum", NULL, MATERIAL("\"alpha_mode\": @")},
    {"/$defs/wrap/oneOf/0/enum", NULL, MAP("diffuse_map", "\"wrap\": @")},
    {"/$defs/wrap/oneOf/1/items/enum", NULL, MAP("normal_map", "\"wrap\": [\"clamp\", @]")},
    {"/$defs/color_map/oneOf/1/properties/filter/enum", NULL, MAP("diffuse_map", "\"filter\": @")},
    {"/$defs/color_map/oneOf/1/properties/encoding/enum", NULL, MAP("diffuse_map", "\"encoding\": @")},
    {"/$defs/light_point/properties/falloff/enum", NULL, "\"lights\": [{\"type\": \"point\", \"position\": [0,0,0], \"falloff\": @}]"},
    {"/$defs/shape_mesh/properties/normals/enum", NULL, "\"shapes\": [{\"type\": \"mesh\", \"file\": \"a\", \"normals\": @}]"},
};

static json_t *schema;

static int read_schema(void **state) {
    json_error_t error;
    schema = json_load_file(TEST_SOURCE_DIR "/docs/scene.schema.json", JSON_REJECT_DUPLICATES, &error);
    if (!schema) print_error("scene.schema.json:%d: %s\n", error.line, error.text);
    return schema ? scratch_open(state) : -1;
}

static int drop_schema(void **state) {
    json_decref(schema);
    return scratch_close(state);
}

// What a JSON pointer (RFC 6901, without escapes) leads to.
static json_t *follow(const char *pointer) {
    json_t *at = schema;
    while (at && *pointer) {
        const size_t length = strcspn(++pointer, "/");
        char key[64];
        snprintf(key, sizeof key, "%.*s", (int)length, pointer);
        at = json_is_array(at) ? json_array_get(at, (size_t)atoi(key)) : json_object_get(at, key);
        pointer += length;
    }
    return at;
}

// What the reader says of a scene with `put` where the @ is.
static const char *complaint(const char *members, const char *put) {
    static char text[1024];
    const char *hole = strchr(members, '@');
    assert_non_null(hole);
    snprintf(text, sizeof text, "{\"version\": 1, %.*s%s%s}", (int)(hole - members), members, put, hole + 1);
    struct scene scene;
    assert_false(scene_load(&scene, scratch_context(), scratch_file("a.json", text, strlen(text))));
    return scratch_state()->error.message;
}

// A set of words as an object with them as keys.
static void add_word(json_t *set, const char *word, size_t length) { json_object_setn_new(set, word, length, json_true()); }

// The words of "… expected one of: a, b, c; did you mean …".
static json_t *known_keys(const char *message) {
    static const char before[] = "has an unknown key 'zzz', expected one of: ";
    json_t *set = json_object();
    const char *at = strstr(message, before);
    if (!at) fail_msg("%s", message);
    for (at += strlen(before); *at && *at != ';'; at += strspn(at, ", ")) {
        const size_t length = strcspn(at, ",;");
        add_word(set, at, length);
        at += length;
    }
    return set;
}

// The words in quotes of "… expected "a", "b" or "c"".
static json_t *known_words(const char *message) {
    json_t *set = json_object();
    const char *at = strstr(message, "is \"zzz\", expected ");
    if (!at) fail_msg("%s", message);
    for (at = strchr(at, ','); (at = strchr(at, '"')); at++) {
        const size_t length = strcspn(++at, "\"");
        add_word(set, at, length);
        at += length;
    }
    return set;
}

// Fails unless the two sets are one, and frees them.
static void assert_same(const char *what, json_t *in_schema, json_t *in_reader) {
    const char *word;
    json_t *value;
    json_object_foreach(in_schema, word, value) {
        (void)value;
        if (!json_object_get(in_reader, word)) fail_msg("%s: '%s' is in the schema alone", what, word);
    }
    json_object_foreach(in_reader, word, value) {
        if (!json_object_get(in_schema, word)) fail_msg("%s: '%s' is not in the schema", what, word);
    }
    json_decref(in_schema);
    json_decref(in_reader);
}

static void keys_are_those_of_the_reader(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++) {
        json_t *object = follow(objects[i].pointer), *set = json_object(), *value;
        const char *key;
        if (!object) fail_msg("%s is not in the schema", objects[i].pointer);
        json_object_foreach(json_object_get(object, "properties"), key, value) { add_word(set, key, strlen(key)); }
        assert_same(objects[i].pointer, set, known_keys(complaint(objects[i].members, "\"zzz\": 0")));
    }
}

// The words of a list, or those that members of alternatives must be.
static json_t *words_of(const json_t *list, const char *member) {
    json_t *set = json_object(), *item;
    size_t index;
    json_array_foreach(list, index, item) {
        const char *reference = json_string_value(json_object_get(item, "$ref"));
        const json_t *properties = reference ? json_object_get(follow(reference + 1), "properties") : NULL;
        const json_t *word = member ? json_object_get(json_object_get(properties, member), "const") : item;
        assert_true(json_is_string(word));
        add_word(set, json_string_value(word), json_string_length(word));
    }
    return set;
}

static void choices_are_those_of_the_reader(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++) {
        const json_t *list = follow(choices[i].pointer);
        if (!json_is_array(list)) fail_msg("%s is no list", choices[i].pointer);
        assert_same(choices[i].pointer, words_of(list, choices[i].key), known_words(complaint(choices[i].members, "\"zzz\"")));
    }
}

static bool is_checked_object(const json_t *object) {
    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++)
        if (follow(objects[i].pointer) == object) return true;
    return false;
}

static bool is_checked_choice(const json_t *list) {
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++)
        if (json_equal(follow(choices[i].pointer), list)) return true;
    return false;
}

// Every object of the schema takes no other keys than those it names, and is in the tables above; so are all choices.
static void walk(const json_t *value, const char *name, int *objects_seen) {
    const char *key;
    json_t *member;
    size_t index;
    if (json_object_get(value, "properties") && json_is_object(json_object_get(value, "properties"))) {
        ++*objects_seen;
        if (!is_checked_object(value)) fail_msg("the object %s of the schema is in no table", name);
        if (!json_is_false(json_object_get(value, "additionalProperties"))) fail_msg("the object %s takes any key", name);
    }
    if (json_is_array(json_object_get(value, "enum")) && !is_checked_choice(json_object_get(value, "enum")))
        fail_msg("the choices of %s are in no table", name);
    json_object_foreach((json_t *)(uintptr_t)value, key, member) { walk(member, key, objects_seen); }
    json_array_foreach(value, index, member) { walk(member, name, objects_seen); }
}

static void nothing_is_left_out(void **state) {
    (void)state;
    int seen = 0;
    walk(schema, "scene", &seen);
    assert_true(seen > 20);
}

static void find_keys(const json_t *value, const char *text) {
    const char *key;
    json_t *member;
    size_t index;
    json_object_foreach(json_object_get(value, "properties"), key, member) {
        char quoted[80];
        snprintf(quoted, sizeof quoted, "`%s`", key);
        if (!strstr(text, quoted)) fail_msg("scene-format.md does not say what %s is", quoted);
    }
    json_array_foreach(json_object_get(value, "enum"), index, member) {
        char quoted[80];
        snprintf(quoted, sizeof quoted, "`%s`", json_string_value(member));
        if (!strstr(text, quoted)) fail_msg("scene-format.md does not say what %s is", quoted);
    }
    json_object_foreach((json_t *)(uintptr_t)value, key, member) { find_keys(member, text); }
    json_array_foreach(value, index, member) { find_keys(member, text); }
}

static void the_description_names_everything(void **state) {
    (void)state;
    struct file_bytes text;
    scratch_assert(file_read(&text, scratch_context(), TEST_SOURCE_DIR "/docs/scene-format.md", GN_IO));
    find_keys(schema, text.data);
    file_bytes_finish(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_are_those_of_the_reader),
        cmocka_unit_test(choices_are_those_of_the_reader),
        cmocka_unit_test(nothing_is_left_out),
        cmocka_unit_test(the_description_names_everything),
    };
    return cmocka_run_group_tests_name("the schema", tests, read_schema, drop_schema);
}
