// The shapes of a scene file, and the meshes that instances of it draw.
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/json_parts.h"
#include "scene/mesh.h"
#include "scene/words.h"

#define NOT_PERPENDICULAR 1e-4 // cosine of the angle between a rectangle's edges, from which on it is none

static const char *const types[] = {[SHAPE_SPHERE] = "sphere",       [SHAPE_TRIANGLE] = "triangle", [SHAPE_MESH] = "mesh",
                                    [SHAPE_RECTANGLE] = "rectangle", [SHAPE_INSTANCE] = "instance", NULL};

#define SPHERE (1u << SHAPE_SPHERE)
#define TRIANGLE (1u << SHAPE_TRIANGLE)
#define MESH (1u << SHAPE_MESH)
#define RECTANGLE (1u << SHAPE_RECTANGLE)
#define INSTANCE (1u << SHAPE_INSTANCE)
#define ALL (SPHERE | TRIANGLE | MESH | RECTANGLE | INSTANCE)

static const struct json_key keys[] = {
    {"type", ALL},        {"center", SPHERE}, {"radius", SPHERE}, {"vertices", TRIANGLE},         {"uvs", TRIANGLE}, {"corner", RECTANGLE},
    {"edges", RECTANGLE}, {"file", MESH},     {"mesh", INSTANCE}, {"transform", MESH | INSTANCE}, {"normals", MESH}, {"material", ALL},
    {"motion", ALL},      {NULL, 0},
};

// A mesh that instances draw, by its name in the file.
struct prototype {
    const char *name;
    uint32_t number, material; // in scene.prototypes, in scene.materials
    double reach[3];           // largest absolute coordinates
};
struct prototypes {
    struct prototype *items;
    uint32_t count;
    json_t *numbers; // by name
};

// Finds the material that a shape names; *out stays NULL when it names none.
static bool find_material(const uint32_t **out, uint32_t *number, const struct scene_build *build, const struct json_at *shape) {
    struct json_at member;
    const char *name;
    *out = NULL;
    if (!at_member(&member, shape, "material")) return true;
    if (!at_text(&member, "the name of a material", &name)) return false;
    if (material_find(&build->materials, name, number)) {
        *out = number;
        return true;
    }
    struct nearest nearest = nearest_to(name);
    const struct scene_material *materials = build->materials.items.items;
    for (size_t i = 0; i < build->materials.items.count; i++) nearest_offer(&nearest, materials[i].name);
    return at_fail(&member, "is \"%s\", expected the name of one of the %zu materials in \"materials\"%s", excerpt_word(name).text,
                   build->materials.items.count, nearest_hint(&nearest).text);
}

static bool set_material(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    const uint32_t *named;
    if (!find_material(&named, &out->material, build, at)) return false;
    return named || material_need(&build->materials, build->ctx, DEFAULT_MATERIAL, &out->material);
}

// ------------------------------------------------------------------------------------------------------- spheres, flat shapes

static bool read_sphere(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    return at_require(at, "center", "3 numbers") && at_get_float3(at, "center", RANGE_ANY, out->center) &&
           at_require(at, "radius", "a number greater than 0") && at_get_float(at, "radius", RANGE_POSITIVE, &out->radius) &&
           set_material(out, build, at);
}

// A list of `count` lists of `width` numbers each.
static bool read_rows(float *out, const struct json_at *shape, const char *key, size_t count, size_t width, const char *expected) {
    struct json_at list;
    if (!at_require(shape, key, expected) || !at_member(&list, shape, key) || !at_list(&list, count, count, expected)) return false;
    for (size_t i = 0; i < count; i++) {
        const struct json_at item = at_item(&list, i);
        if (!at_floats(&item, RANGE_ANY, width, out + width * i)) return false;
    }
    return true;
}

static bool read_triangle(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    struct json_at uvs;
    if (!mesh_init(&out->mesh, build->ctx, 3, 1, false)) return false;
    for (uint32_t i = 0; i < 3; i++) out->mesh.indices[i] = i;
    if (!read_rows(out->mesh.positions, at, "vertices", 3, 3, "a list of 3 points")) return false;
    if (at_member(&uvs, at, "uvs") &&
        (!mesh_add_uvs(&out->mesh, build->ctx) || !read_rows(out->mesh.uvs, at, "uvs", 3, 2, "a list of 3 pairs of numbers")))
        return false;
    return set_material(out, build, at);
}

static bool are_edges(const float edges[6]) {
    double a = 0, b = 0, product = 0;
    for (int i = 0; i < 3; i++) {
        a += (double)edges[i] * edges[i];
        b += (double)edges[3 + i] * edges[3 + i];
        product += (double)edges[i] * edges[3 + i];
    }
    return a > 0 && b > 0 && fabs(product) <= NOT_PERPENDICULAR * sqrt(a) * sqrt(b);
}

// The vertices corner, + a, + b, + a + b. A picture's lower left is at the corner, its lower edge along a.
static bool read_rectangle(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    static const uint32_t indices[6] = {0, 1, 2, 3, 2, 1};
    static const float uvs[8] = {0, 1, 1, 1, 0, 0, 1, 0};
    struct json_at member;
    float corner[3], edges[6];
    if (!at_require(at, "corner", "3 numbers") || !at_get_float3(at, "corner", RANGE_ANY, corner) ||
        !read_rows(edges, at, "edges", 2, 3, "a list of 2 vectors"))
        return false;
    at_member(&member, at, "edges");
    if (!are_edges(edges)) return at_fail(&member, "are not perpendicular, or one is zero, expected the two sides of a rectangle");
    if (!mesh_init(&out->mesh, build->ctx, 4, 2, false) || !mesh_add_uvs(&out->mesh, build->ctx)) return false;
    memcpy(out->mesh.indices, indices, sizeof indices);
    memcpy(out->mesh.uvs, uvs, sizeof uvs);
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++) {
            const double value = (double)corner[i] + (k & 1 ? edges[i] : 0.0) + (k & 2 ? edges[3 + i] : 0.0);
            if (!(fabs(value) <= FLT_MAX)) return at_fail(&member, "leave the range of fp32, expected smaller numbers");
            out->mesh.positions[3 * k + i] = (float)value;
        }
    return set_material(out, build, at);
}

// ------------------------------------------------------------------------------------------------------------------- meshes

// 4 rows of 4 numbers, or the 16 numbers in one list.
static bool read_transform(struct transform *out, const struct json_at *at) {
    static const char expected[] = "4 rows of 4 numbers";
    const bool flat = json_array_size(at->value) == 16;
    if (!flat && !at_list(at, 4, 4, expected)) return false;
    for (size_t i = 0; i < 4; i++) {
        const struct json_at row = flat ? *at : at_item(at, i);
        if (!flat && !at_list(&row, 4, 4, "a row of 4 numbers")) return false;
        for (size_t j = 0; j < 4; j++) {
            const struct json_at item = at_item(&row, flat ? 4 * i + j : j);
            if (!at_double(&item, &out->m[i][j])) return false;
            if (i == 3 && out->m[i][j] != (j == 3))
                return at_expected(&item, j == 3 ? "1: the last row must be 0 0 0 1" : "0: the last row must be 0 0 0 1");
        }
    }
    const double condition = transform_condition(out);
    if (condition < WORST_CONDITION) return true;
    return at_fail(at, "is singular or nearly so (condition number %.3g), expected a transform that can be undone", condition);
}

static bool apply_transform(struct scene_mesh *mesh, const struct json_at *shape) {
    struct json_at at;
    struct transform transform;
    uint32_t bad;
    if (!at_member(&at, shape, "transform")) return true;
    if (!read_transform(&transform, &at)) return false;
    return mesh_transform(mesh, &transform, 0, mesh->vertex_count, &bad) ||
           at_fail(&at, "takes vertex %u of the mesh out of the range of fp32, expected smaller numbers", bad);
}

enum normals { NORMALS_FILE, NORMALS_FLAT, NORMALS_SMOOTH };

static bool load_model(struct model *out, struct scene_build *build, const struct json_at *shape) {
    struct json_at at;
    const char *name;
    if (!at_require(shape, "file", "the path of a mesh") || !at_member(&at, shape, "file") || !at_text(&at, "the path of a mesh", &name))
        return false;
    char *path = path_beside(build->scene->path, name);
    if (!path) return fail(build->ctx, GN_LIMIT, "no memory for a path");
    const char *trouble = path_unreadable(path);
    const bool done = trouble ? at_fail(&at, "is \"%s\", expected a file that can be read: %s", excerpt_word(name).text, trouble)
                              : model_load(out, build->ctx, path);
    free(path);
    return done;
}

// Loads the mesh that "file" names, with its materials unless `material` is one.
static bool read_file(struct scene_shape *out, struct scene_build *build, const struct json_at *at) {
    static const char *const policies[] = {[NORMALS_FILE] = "file", [NORMALS_FLAT] = "flat", [NORMALS_SMOOTH] = "smooth", NULL};
    int normals = NORMALS_FILE;
    const uint32_t *material;
    uint32_t number;
    struct model model = {0};
    bool done = at_get_choice(at, "normals", policies, &normals) && find_material(&material, &number, build, at) &&
                load_model(&model, build, at) && shape_take_model(out, build, &model, material);
    model_finish(&model);
    if (done && normals != NORMALS_FILE) {
        free(out->mesh.normals);
        out->mesh.normals = NULL;
    }
    return done && apply_transform(&out->mesh, at) && (normals != NORMALS_SMOOTH || mesh_smooth(&out->mesh, build->ctx, CREASE_DEG));
}

static void find_reach(double out[3], const struct scene_mesh *mesh) {
    for (int i = 0; i < 3; i++) out[i] = 0;
    for (size_t v = 0; v < 3 * (size_t)mesh->vertex_count; v++) out[v % 3] = fmax(out[v % 3], fabs(mesh->positions[v]));
}

// Of the shape that read_file makes, a prototype keeps the mesh; its material is that of triangles without one of their own.
static bool read_prototype(struct scene_build *build, const struct json_at *at, struct prototype *out) {
    static const char *const prototype_keys[] = {"file", "transform", "normals", "material", NULL};
    struct scene_shape shape = {0};
    const bool done = at_object(at, prototype_keys) && read_file(&shape, build, at);
    build->scene->prototypes[out->number] = shape.mesh;
    build->scene->prototype_count = out->number + 1;
    out->material = shape.material;
    find_reach(out->reach, &shape.mesh);
    return done;
}

static bool read_prototypes(struct prototypes *out, struct scene_build *build, const struct json_at *root) {
    struct json_at meshes;
    if (!at_member(&meshes, root, "meshes")) return true;
    if (!json_is_object(meshes.value)) return at_expected(&meshes, "an object of meshes by name");
    const size_t count = json_object_size(meshes.value);
    build->scene->prototypes = array_alloc(build->ctx, count, sizeof *build->scene->prototypes, "meshes");
    out->items = array_alloc(build->ctx, count, sizeof *out->items, "meshes");
    out->numbers = json_object();
    if (!build->scene->prototypes || !out->items) return false;
    json_t *value;
    const char *name;
    json_object_foreach(meshes.value, name, value) {
        struct json_at at;
        struct prototype *item = &out->items[out->count];
        *item = (struct prototype){.name = name, .number = out->count};
        if (json_object_set_new(out->numbers, name, json_integer(out->count++)) != 0)
            return fail(build->ctx, GN_LIMIT, "no memory for a mesh");
        if (!at_member(&at, &meshes, name) || !read_prototype(build, &at, item)) return false;
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------------- instances

static const struct prototype *find_prototype(const struct prototypes *prototypes, const struct json_at *shape) {
    struct json_at at;
    const char *name;
    if (!at_require(shape, "mesh", "the name of a mesh") || !at_member(&at, shape, "mesh") || !at_text(&at, "the name of a mesh", &name))
        return NULL;
    const json_t *number = json_object_get(prototypes->numbers, name);
    if (number) return &prototypes->items[json_integer_value(number)];
    struct nearest nearest = nearest_to(name);
    for (uint32_t i = 0; i < prototypes->count; i++) nearest_offer(&nearest, prototypes->items[i].name);
    at_fail(&at, "is \"%s\", expected the name of one of the %u meshes in \"meshes\"%s", excerpt_word(name).text, prototypes->count,
            nearest_hint(&nearest).text);
    return NULL;
}

static bool read_placement(float out[12], const struct json_at *shape) {
    struct json_at at;
    struct transform transform = transform_identity;
    if (at_member(&at, shape, "transform") && !read_transform(&transform, &at)) return false;
    for (int i = 0; i < 12; i++) {
        if (!(fabs(transform.m[i / 4][i % 4]) <= FLT_MAX))
            return at_fail(&at, "has numbers beyond the range of fp32, expected smaller ones");
        out[i] = (float)transform.m[i / 4][i % 4];
    }
    return true;
}

// Whether points with coordinates up to `reach` stay in the range of fp32 where the shape takes them; with some room, as sums are rounded
// there.
static bool stays_in_range(const struct scene_shape *shape, const double reach[3]) {
    for (int i = 0; i < 3; i++) {
        const float *m = shape->placement + 4 * i;
        const double placed = fabs(m[0]) * reach[0] + fabs(m[1]) * reach[1] + fabs(m[2]) * reach[2] + fabs(m[3]);
        if ((shape->type == SHAPE_INSTANCE ? placed : reach[i]) + fabs(shape->motion[i]) > 0.999 * FLT_MAX) return false;
    }
    return true;
}

static bool read_instance(struct scene_shape *out, struct scene_build *build, const struct prototypes *prototypes,
                          const struct json_at *at) {
    const struct prototype *prototype = find_prototype(prototypes, at);
    const uint32_t *material;
    if (!prototype || !find_material(&material, &out->material, build, at) || !read_placement(out->placement, at)) return false;
    out->prototype = prototype->number;
    out->own_material = material != NULL;
    if (!material) out->material = prototype->material;
    return stays_in_range(out, prototype->reach) || at_fail(at, "takes its mesh out of the range of fp32, expected smaller numbers");
}

// ------------------------------------------------------------------------------------------------------------------ the list

static bool read_motion(struct scene_shape *out, const struct prototypes *prototypes, const struct json_at *shape) {
    struct json_at at;
    double reach[3] = {fabs(out->center[0]), fabs(out->center[1]), fabs(out->center[2])};
    if (!at_member(&at, shape, "motion")) return true;
    if (!at_floats(&at, RANGE_ANY, 3, out->motion)) return false;
    out->moves = out->motion[0] != 0 || out->motion[1] != 0 || out->motion[2] != 0;
    if (out->type != SHAPE_SPHERE && out->type != SHAPE_INSTANCE) find_reach(reach, &out->mesh);
    return stays_in_range(out, out->type == SHAPE_INSTANCE ? prototypes->items[out->prototype].reach : reach) ||
           at_fail(&at, "takes the shape out of the range of fp32, expected smaller numbers");
}

static bool read_shape(struct scene_shape *out, struct scene_build *build, const struct prototypes *prototypes, const struct json_at *at) {
    int type = SHAPE_SPHERE;
    if (!json_is_object(at->value)) return at_expected(at, "an object");
    if (!at_require(at, "type", "\"sphere\", \"triangle\", \"mesh\", \"rectangle\" or \"instance\"") ||
        !at_get_choice(at, "type", types, &type) || !at_object_of_kind(at, keys, types, type))
        return false;
    out->type = (enum shape_type)type;
    const bool done = type == SHAPE_SPHERE      ? read_sphere(out, build, at)
                      : type == SHAPE_TRIANGLE  ? read_triangle(out, build, at)
                      : type == SHAPE_RECTANGLE ? read_rectangle(out, build, at)
                      : type == SHAPE_INSTANCE  ? read_instance(out, build, prototypes, at)
                                                : read_file(out, build, at);
    return done && read_motion(out, prototypes, at);
}

static bool read_shapes(struct scene_build *build, const struct prototypes *prototypes, const struct json_at *root) {
    struct scene *scene = build->scene;
    struct json_at shapes;
    if (!at_member(&shapes, root, "shapes")) return true;
    if (!at_list(&shapes, 0, INT32_MAX, "a list of shapes")) return false;
    const uint32_t count = (uint32_t)json_array_size(shapes.value);
    scene->shapes = array_alloc(build->ctx, count, sizeof *scene->shapes, "shapes");
    if (!scene->shapes) return false;
    scene->shape_count = count;
    for (uint32_t i = 0; i < count; i++) {
        const struct json_at at = at_item(&shapes, i);
        if (!read_shape(&scene->shapes[i], build, prototypes, &at)) return false;
        if (i % 256 == 0 && !progress(build->ctx, "scene", (double)i / count, -1)) return false;
    }
    return true;
}

bool part_shapes(struct scene_build *build, const struct json_at *root) {
    struct prototypes prototypes = {0};
    const bool done = read_prototypes(&prototypes, build, root) && read_shapes(build, &prototypes, root);
    json_decref(prototypes.numbers);
    free(prototypes.items);
    return done;
}
