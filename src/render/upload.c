#include "render/upload.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "render/base.h"
#include "render/upload_lights.h"
#include "scene/area_lights.h"
#include "scene/fog.h"

// What the fill functions need. `inner` numbers the inner nodes, `slot` the primitives of each kind in leaf order.
struct upload {
    const struct scene *scene;
    const struct bvh *bvh;
    uint32_t effects;
    uint32_t triangle_count, sphere_count;
    float base[3], scale;   // as in device_scene
    uint32_t *inner;        // by node: inner nodes before it
    uint32_t *slot;         // by position in bvh->order: primitives of the same kind before it; NULL where there is only one kind
    uint32_t inner_count;
    struct light_table lights; // only where there is shading
};

static uint32_t float_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static struct word4 word4_of(const float v[3], uint32_t last) { return (struct word4){{float_bits(v[0]), float_bits(v[1]), float_bits(v[2]), last}}; }

// A point in device coordinates. Exact for geometry; what is not, lights, is rounded once.
static struct word4 point_of(const struct upload *u, const float v[3], uint32_t last) {
    float p[3];
    for (int i = 0; i < 3; i++) p[i] = (float)(((double)v[i] - u->base[i]) * u->scale);
    return word4_of(p, last);
}

// A corner of a box, moved outward (`side` -1 for the lower one, +1) by what denormal coordinates may lose on the way; for others that is nothing.
static struct word4 corner_of(const struct upload *u, const float v[3], double side, uint32_t last) {
    float p[3];
    for (int i = 0; i < 3; i++) p[i] = (float)(((double)v[i] - u->base[i]) * u->scale + side * 0x1p-120);
    return word4_of(p, last);
}

// The power of two that brings the largest coordinate, relative to the base, into [1, 2).
static float find_scale(const struct scene *scene, const float base[3]) {
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        if (!(scene->bounds_min[i] <= scene->bounds_max[i])) continue;
        largest = fmax(largest, fmax(fabs((double)scene->bounds_min[i] - base[i]), fabs((double)scene->bounds_max[i] - base[i])));
    }
    if (!(largest > 0) || isinf(largest)) return largest > 0 ? 0x1p-126f : 1.0f;
    int exponent;
    frexp(largest, &exponent); // largest = m · 2^exponent, m in [0.5, 1)
    exponent = 1 - exponent;
    return ldexpf(1.0f, exponent < -126 ? -126 : exponent > 126 ? 126 : exponent);
}

static bool is_sphere(const struct upload *u, uint32_t primitive) { return primitive >= u->triangle_count; }

static bool upload_init(struct upload *u, struct context *ctx, const struct scene *scene, const struct bvh *bvh, uint32_t effects, const float *eye) {
    *u = (struct upload){.scene = scene, .bvh = bvh, .effects = effects};
    scene_base(u->base, scene, eye);
    u->scale = find_scale(scene, u->base);
    u->triangle_count = scene_triangle_count(scene);
    u->sphere_count = scene_sphere_count(scene);
    u->inner = array_alloc(ctx, bvh->node_count, sizeof *u->inner, "node numbers");
    if (!u->inner) return false;
    for (uint32_t i = 0; i < bvh->node_count; i++) {
        u->inner[i] = u->inner_count;
        if (bvh->nodes[i].count == 0) u->inner_count++;
    }
    if (u->triangle_count == 0 || u->sphere_count == 0) return true;
    u->slot = array_alloc(ctx, bvh->primitive_count, sizeof *u->slot, "primitive numbers");
    if (!u->slot) return false;
    uint32_t next[2] = {0, 0};
    for (uint32_t i = 0; i < bvh->primitive_count; i++) u->slot[i] = next[is_sphere(u, bvh->order[i])]++;
    return true;
}

static void upload_finish(struct upload *u) {
    light_table_finish(&u->lights);
    free(u->inner);
    free(u->slot);
}

// --------------------------------------------------------------------------------------------------------------- nodes

// A leaf whose kind is disabled becomes a leaf of the other kind that holds the null primitive behind the last one.
static uint32_t leaf_reference(const struct upload *u, const struct bvh_node *node) {
    bool sphere = is_sphere(u, u->bvh->order[node->first]);
    uint32_t first = u->slot ? u->slot[node->first] : node->first, count = node->count;
    if (!(u->effects & (sphere ? EFFECT_SPHERES : EFFECT_TRIANGLES))) {
        sphere = !sphere;
        first = sphere ? u->sphere_count : u->triangle_count;
        count = 1;
    }
    return REF_LEAF | (sphere ? REF_SPHERES : 0u) | (count - 1) << REF_COUNT_SHIFT | first;
}

static uint32_t node_reference(const struct upload *u, uint32_t number) {
    const struct bvh_node *node = &u->bvh->nodes[number];
    return node->count ? leaf_reference(u, node) : u->inner[number];
}

static uint32_t root_reference(const struct upload *u) {
    if (u->bvh->node_count == 0 || !(u->effects & (EFFECT_TRIANGLES | EFFECT_SPHERES))) return REF_NONE;
    if (u->effects & EFFECT_BVH) return node_reference(u, 0);
    // Without a hierarchy (the plan prunes it for a few primitives of one kind): one leaf of all.
    const struct bvh_node all = {.first = 0, .count = u->bvh->primitive_count};
    return leaf_reference(u, &all);
}

static void write_node(const struct upload *u, uint32_t number, struct word4 *to) {
    uint32_t first = u->bvh->nodes[number].first;
    const struct bvh_node *left = &u->bvh->nodes[first], *right = left + 1;
    to[0] = corner_of(u, left->min, -1, node_reference(u, first));
    to[1] = corner_of(u, left->max, +1, node_reference(u, first + 1));
    to[2] = corner_of(u, right->min, -1, 0);
    to[3] = corner_of(u, right->max, +1, 0);
}

// The last node before which there are `inner` inner nodes and which is one itself.
static uint32_t find_inner(const struct upload *u, uint32_t inner) {
    uint32_t low = 0, high = u->bvh->node_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low + 1) / 2;
        if (u->inner[middle] <= inner) low = middle;
        else high = middle - 1;
    }
    return low;
}

static bool fill_nodes(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    struct word4 *word = to;
    uint64_t left = size / (NODE_WORDS * sizeof *word);
    if (left == 0 || u->inner_count == 0) return true;
    uint32_t number = find_inner(u, (uint32_t)(offset / (NODE_WORDS * sizeof *word)));
    for (; left; number++) {
        if (u->bvh->nodes[number].count) continue;
        write_node(u, number, word);
        word += NODE_WORDS;
        left--;
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------- primitives

static void write_triangle(const struct upload *u, uint32_t number, struct word4 *to) {
    struct scene_triangle t = scene_triangle_at(u->scene, number);
    to[0] = point_of(u, t.v[0], t.object);
    to[1] = point_of(u, t.v[1], t.primitive);
    to[2] = point_of(u, t.v[2], t.material);
}

static void write_sphere(const struct upload *u, uint32_t number, struct word4 *to) {
    uint32_t object = scene_sphere_object(u->scene, number);
    const struct scene_shape *shape = &u->scene->shapes[object];
    to[0] = point_of(u, shape->center, float_bits(shape->radius * u->scale));
    to[1] = (struct word4){{object, shape->material, 0, 0}};
}

// The position in bvh->order of the primitive of kind `spheres` with this slot.
static uint32_t find_slot(const struct upload *u, uint32_t slot, bool spheres) {
    if (!u->slot) return slot;
    uint32_t low = 0, high = u->bvh->primitive_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        bool own = is_sphere(u, u->bvh->order[middle]) == spheres;
        uint32_t before = own ? u->slot[middle] : middle - u->slot[middle]; // primitives of the kind before `middle`
        if (before + (own ? 1 : 0) > slot) high = middle;
        else low = middle + 1;
    }
    return low;
}

// Slots [begin, end) of one kind; the slot behind the last primitive is the null primitive, which nothing hits.
struct slots {
    const struct upload *u;
    struct word4 *to;
    uint64_t first;
    bool spheres;
};

static bool write_slots(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    const struct slots *s = data;
    const struct upload *u = s->u;
    uint32_t words = s->spheres ? SPHERE_WORDS : TRIANGLE_WORDS;
    uint32_t count = s->spheres ? u->sphere_count : u->triangle_count;
    uint32_t position = s->first + begin < count ? find_slot(u, (uint32_t)(s->first + begin), s->spheres) : 0;
    for (size_t i = begin; i < end; i++) {
        struct word4 *to = s->to + words * i;
        if (s->first + i >= count) { // NaN hits nothing
            for (uint32_t w = 0; w < words; w++) to[w] = (struct word4){{0x7fc00000u, 0x7fc00000u, 0x7fc00000u, 0}};
            continue;
        }
        while (is_sphere(u, u->bvh->order[position]) != s->spheres) position++;
        uint32_t primitive = u->bvh->order[position++];
        if (s->spheres) write_sphere(u, primitive - u->triangle_count, to);
        else write_triangle(u, primitive, to);
    }
    return true;
}

static bool fill_slots(const struct upload *u, void *to, uint64_t offset, uint64_t size, bool spheres) {
    uint64_t bytes = (spheres ? SPHERE_WORDS : TRIANGLE_WORDS) * sizeof(struct word4);
    struct slots s = {.u = u, .to = to, .first = offset / bytes, .spheres = spheres};
    return parallel_for(threads_available(), size / bytes, 1 << 15, write_slots, &s);
}

static bool fill_triangles(void *data, void *to, uint64_t offset, uint64_t size) { return fill_slots(data, to, offset, size, false); }
static bool fill_spheres(void *data, void *to, uint64_t offset, uint64_t size) { return fill_slots(data, to, offset, size, true); }

// ------------------------------------------------------------------------------------------------------------- shading

#define EFFECTS_WITH_UVS (EFFECT_TEXTURES | EFFECT_NORMAL_MAPS | EFFECT_ALPHA)

// Whether kernels look at a mesh's vertices once more after the hit.
static bool has_attributes(const struct upload *u, const struct scene_shape *shape) {
    return (shape->mesh.normals && u->effects & EFFECT_SMOOTH_NORMALS) || (shape->mesh.uvs && u->effects & EFFECTS_WITH_UVS);
}

// Words [first, first + count) of an array that is the meshes' parts one after another.
struct part { uint64_t first, count; };

// The overlap of a mesh's part, `length` long and beginning at `start`, with what is to be filled; false if there is none.
static bool overlap(struct part want, uint64_t start, uint64_t length, struct part *out) {
    uint64_t begin = want.first > start ? want.first : start;
    uint64_t end = want.first + want.count < start + length ? want.first + want.count : start + length;
    *out = (struct part){begin, end > begin ? end - begin : 0};
    return end > begin;
}

static bool fill_indices(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    struct part want = {offset / sizeof(struct word4), size / sizeof(struct word4)}, have;
    uint64_t triangles = 0;
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < u->scene->shape_count; i++) {
        const struct scene_mesh *mesh = &u->scene->shapes[i].mesh;
        if (!has_attributes(u, &u->scene->shapes[i])) continue;
        if (overlap(want, triangles, mesh->triangle_count, &have)) {
            struct word4 *word = (struct word4 *)to + (have.first - want.first);
            const uint32_t *index = mesh->indices + 3 * (have.first - triangles);
            for (uint64_t k = 0; k < have.count; k++, index += 3)
                word[k] = (struct word4){{vertices + index[0], vertices + index[1], vertices + index[2], 0}};
        }
        triangles += mesh->triangle_count;
        vertices += mesh->vertex_count;
    }
    return true;
}

// One attribute of the vertices, of `width` numbers, 0 where a mesh has none.
static bool fill_attribute(const struct upload *u, void *to, uint64_t offset, uint64_t size, uint32_t width, const float *(*of)(const struct scene_mesh *)) {
    struct part want = {offset / sizeof(struct word4), size / sizeof(struct word4)}, have;
    uint64_t vertices = 0;
    for (uint32_t i = 0; i < u->scene->shape_count; i++) {
        const struct scene_mesh *mesh = &u->scene->shapes[i].mesh;
        if (!has_attributes(u, &u->scene->shapes[i])) continue;
        if (overlap(want, vertices, mesh->vertex_count, &have)) {
            struct word4 *word = (struct word4 *)to + (have.first - want.first);
            const float *from = of(mesh);
            memset(word, 0, have.count * sizeof *word);
            for (uint64_t k = 0; from && k < have.count; k++) memcpy(word[k].w, from + width * (have.first - vertices + k), width * sizeof *from);
        }
        vertices += mesh->vertex_count;
    }
    return true;
}

static const float *normals_of(const struct scene_mesh *mesh) { return mesh->normals; }
static const float *uvs_of(const struct scene_mesh *mesh) { return mesh->uvs; }
static bool fill_normals(void *data, void *to, uint64_t offset, uint64_t size) { return fill_attribute(data, to, offset, size, 3, normals_of); }
static bool fill_uvs(void *data, void *to, uint64_t offset, uint64_t size) { return fill_attribute(data, to, offset, size, 2, uvs_of); }

// Lights that any effect reads.
static uint32_t light_count(const struct upload *u) { return u->effects & (EFFECT_DIFFUSE | EFFECT_SPECULAR) ? u->scene->light_count : 0; }

static uint32_t light_of(const struct upload *u, uint32_t object) {
    const uint32_t light = scene_light_of(u->scene, object);
    return light < light_count(u) && u->lights.kind[light] != ABSENT_LIGHT ? light : NO_LIGHT;
}

static bool fill_objects(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    uint64_t begin = offset / sizeof(struct word4), end = begin + size / sizeof(struct word4);
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < u->scene->shape_count && i < end; i++) {
        bool attributes = has_attributes(u, &u->scene->shapes[i]);
        if (i >= begin) ((struct word4 *)to)[i - begin] = (struct word4){{attributes ? triangles : NO_ATTRIBUTES, light_of(u, i), 0, 0}};
        if (attributes) triangles += u->scene->shapes[i].mesh.triangle_count;
    }
    return true;
}

static void write_map(struct word4 to[2], const struct scene *scene, const struct scene_map *map) {
    bool used = map->texture != NO_TEXTURE && map->texture <= scene->texture_count;
    to[0] = word4_of(map->transform, used ? map->texture - 1 : NO_TEXTURE_WORD);
    to[1] = word4_of(map->transform + 3, map->srgb);
}

static void write_material(const struct upload *u, const struct scene_material *m, struct word4 *word) {
    float absorption[3];
    for (int i = 0; i < 3; i++) absorption[i] = m->absorption[i] / u->scale;
    word[0] = word4_of(m->ambient, float_bits(m->shininess));
    word[1] = word4_of(m->diffuse, (uint32_t)m->model | (uint32_t)m->alpha_mode << 8 | (uint32_t)m->thin << 16);
    word[2] = word4_of(m->specular, float_bits(m->roughness));
    word[3] = word4_of(m->reflection, float_bits(m->metallic));
    word[4] = word4_of(m->emission, float_bits(m->ior));
    word[5] = word4_of(absorption, m->priority);
    word[6] = (struct word4){{float_bits(m->alpha), float_bits(m->alpha_cutoff), float_bits(m->normal_scale), 0}};
    write_map(word + MATERIAL_MAP_DIFFUSE, u->scene, &m->diffuse_map);
    write_map(word + MATERIAL_MAP_NORMAL, u->scene, &m->normal_map);
    write_map(word + MATERIAL_MAP_ROUGHNESS, u->scene, &m->roughness_map);
    write_map(word + MATERIAL_MAP_EMISSION, u->scene, &m->emission_map);
}

static bool fill_materials(void *data, void *to, uint64_t offset, uint64_t size) {
    struct word4 *word = to;
    const struct upload *u = data;
    const struct scene_material *m = u->scene->materials + offset / (MATERIAL_WORDS * sizeof *word);
    for (uint64_t left = size / (MATERIAL_WORDS * sizeof *word); left; left--, m++, word += MATERIAL_WORDS) write_material(u, m, word);
    return true;
}

static struct light_frame light_frame_of(const struct upload *u) {
    return (struct light_frame){u->scene, &u->lights, {u->base[0], u->base[1], u->base[2]}, u->scale};
}

static bool fill_lights(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct light_frame frame = light_frame_of(data);
    const uint64_t record = LIGHT_WORDS * sizeof(struct word4);
    for (uint64_t i = 0; i < size / record; i++) write_light((struct word4 *)to + LIGHT_WORDS * i, &frame, (uint32_t)(offset / record + i));
    return true;
}

static bool fill_emitters(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct light_frame frame = light_frame_of(data);
    const uint64_t record = EMITTER_WORDS * sizeof(struct word4);
    for (uint64_t i = 0; i < size / record; i++) write_emitter((struct word4 *)to + EMITTER_WORDS * i, &frame, (uint32_t)(offset / record + i));
    return true;
}

static bool fill_globals(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    const struct scene *scene = u->scene;
    const struct fog_ball fog = scene_fog_ball(scene);
    float center[3];
    for (int i = 0; i < 3; i++) center[i] = (float)((fog.center[i] - u->base[i]) * u->scale);
    struct word4 words[GLOBAL_WORDS] = {
        word4_of(scene->background, scene->paths.max_depth),
        word4_of(scene->ambient, scene->paths.roulette_depth),
        word4_of(scene->fog.albedo, float_bits(scene->fog.density / u->scale)),
        word4_of(center, float_bits((float)(fog.radius * u->scale))),
        {{float_bits(scene->fog.anisotropy), 0, 0, 0}},
    };
    memcpy(to, (const char *)words + offset, size);
    return true;
}

// ------------------------------------------------------------------------------------------------------------ together

// One array: `count` records of `words` words.
static bool make(struct buffer *buffer, struct context *ctx, struct device *device, struct upload *u, const char *name, uint64_t count,
                 uint32_t words, bool (*fill)(void *data, void *to, uint64_t offset, uint64_t size)) {
    size_t record = words * sizeof(struct word4);
    struct buffer_params params = {.name = name, .kind = BUFFER_TEXELS, .size = count * record, .host_writes = true};
    if (!buffer_init(buffer, ctx, device, &params)) return false;
    return count == 0 || buffer_fill(buffer, ctx, device, record, fill, u);
}

static void count_attributes(const struct upload *u, uint64_t *triangles, uint64_t *vertices) {
    *triangles = *vertices = 0;
    for (uint32_t i = 0; i < u->scene->shape_count; i++) {
        if (!has_attributes(u, &u->scene->shapes[i])) continue;
        *triangles += u->scene->shapes[i].mesh.triangle_count;
        *vertices += u->scene->shapes[i].mesh.vertex_count;
    }
}

static bool make_shading(struct device_scene *out, struct context *ctx, struct device *device, struct upload *u) {
    uint64_t triangles, vertices;
    bool normals = u->effects & EFFECT_SMOOTH_NORMALS, uvs = u->effects & EFFECTS_WITH_UVS, objects = normals || uvs || u->effects & EFFECT_SOFT_SHADOWS;
    count_attributes(u, &triangles, &vertices);
    out->light_count = light_count(u);
    if (!light_table_init(&u->lights, ctx, u->scene, u->effects)) return false;
    const uint32_t emitters = u->lights.first[out->light_count];
    return make(&out->objects, ctx, device, u, "objects", objects ? u->scene->shape_count : 0, OBJECT_WORDS, fill_objects) &&
           make(&out->indices, ctx, device, u, "vertex indices", triangles, 1, fill_indices) &&
           make(&out->normals, ctx, device, u, "normals", normals ? vertices : 0, 1, fill_normals) &&
           make(&out->uvs, ctx, device, u, "texture coordinates", uvs ? vertices : 0, 1, fill_uvs) &&
           make(&out->materials, ctx, device, u, "materials", u->scene->material_count, MATERIAL_WORDS, fill_materials) &&
           make(&out->lights, ctx, device, u, "lights", out->light_count, LIGHT_WORDS, fill_lights) &&
           make(&out->emitters, ctx, device, u, "triangles that emit", emitters, EMITTER_WORDS, fill_emitters) &&
           make(&out->globals, ctx, device, u, "globals", 1, GLOBAL_WORDS, fill_globals);
}

static bool make_geometry(struct device_scene *out, struct context *ctx, struct device *device, struct upload *u) {
    bool triangles = u->effects & EFFECT_TRIANGLES, spheres = u->effects & EFFECT_SPHERES;
    memcpy(out->base, u->base, sizeof out->base);
    out->scale = u->scale;
    out->root = root_reference(u);
    return make(&out->nodes, ctx, device, u, "bvh nodes", u->inner_count, NODE_WORDS, fill_nodes) &&
           make(&out->triangles, ctx, device, u, "triangles", triangles ? u->triangle_count + 1ull : 0, TRIANGLE_WORDS, fill_triangles) &&
           make(&out->spheres, ctx, device, u, "spheres", spheres ? u->sphere_count + 1ull : 0, SPHERE_WORDS, fill_spheres);
}

bool device_scene_init(struct device_scene *out, struct context *ctx, struct device *device, const struct scene *scene,
                       const struct bvh *bvh, uint32_t effects, const float *eye, bool shading) {
    *out = (struct device_scene){0};
    struct upload u;
    bool ok = upload_init(&u, ctx, scene, bvh, effects, eye) && make_geometry(out, ctx, device, &u) &&
              (!shading || make_shading(out, ctx, device, &u));
    upload_finish(&u);
    if (!ok) device_scene_finish(out, device);
    return ok;
}

void device_scene_finish(struct device_scene *ds, struct device *device) {
    struct buffer *buffers[] = {&ds->nodes, &ds->triangles, &ds->spheres, &ds->objects, &ds->materials,
                                &ds->lights, &ds->indices, &ds->normals, &ds->uvs, &ds->globals, &ds->emitters};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) buffer_finish(buffers[i], device);
    *ds = (struct device_scene){0};
}

void device_point(float out[3], const struct device_scene *ds, const float point[3]) {
    for (int i = 0; i < 3; i++) out[i] = (float)(((double)point[i] - ds->base[i]) * ds->scale);
}

size_t device_scene_bindings(struct device_scene *ds, struct kernel_binding *bindings, bool shading) {
    struct kernel_binding all[DEVICE_SCENE_BINDINGS] = {
        {BINDING_NODES, &ds->nodes, NULL},         {BINDING_TRIANGLES, &ds->triangles, NULL}, {BINDING_SPHERES, &ds->spheres, NULL},
        {BINDING_OBJECTS, &ds->objects, NULL},     {BINDING_MATERIALS, &ds->materials, NULL}, {BINDING_LIGHTS, &ds->lights, NULL},
        {BINDING_INDICES, &ds->indices, NULL},     {BINDING_NORMALS, &ds->normals, NULL},     {BINDING_GLOBALS, &ds->globals, NULL},
        {BINDING_UVS, &ds->uvs, NULL},             {BINDING_EMITTERS, &ds->emitters, NULL},
    };
    size_t count = shading ? DEVICE_SCENE_BINDINGS : 3;
    memcpy(bindings, all, count * sizeof *bindings);
    return count;
}
