#include "render/upload.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "render/base.h"
#include "render/upload_instances.h"
#include "render/upload_lights.h"
#include "scene/area_lights.h"
#include "scene/fog.h"

// A hierarchy: the scene's, or that of a part.
struct tree {
    const struct bvh *bvh;
    struct part_frame frame; // what its boxes are measured in
    uint32_t *inner;         // by node: inner nodes before it
    uint32_t inner_count;
    uint32_t first_node;     // inner nodes of the trees before
    uint32_t first_slot;     // of a part's triangles
};

// Of the scene's hierarchy, by position in the order.
enum kind { KIND_TRIANGLE, KIND_SPHERE, KIND_INSTANCE };

// What the fill functions need. A primitive's slot is its number in leaf order among its kind; the triangles of parts have those behind.
struct upload {
    const struct scene *scene;
    const struct bvh *bvh;
    uint32_t effects;
    uint32_t triangle_count, sphere_count;
    uint32_t triangle_slots;     // triangle_count and those of parts
    float base[3], scale;        // as in device_scene
    struct tree *trees;          // the scene's, then those of the parts, where there are instances
    uint32_t tree_count;
    uint32_t *slot;              // by position in bvh->order; NULL where there is only one kind
    uint32_t *primitive_at[2];   // by slot, triangles and spheres: the primitive of the BVH; the same
    uint32_t *record_of;         // by shape: word of its record in INSTANCES; NULL where nothing asks for any
    uint32_t record_count;
    uint32_t *first_attribute;   // by mesh: triangles with attributes in the meshes before; only where there is shading
    struct light_table lights;   // the same
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

// A corner of a box, moved outward (`side` -1 for the lower one, +1) by what denormal coordinates may lose on the way; for others that is nothing. In a part's
// frame it is rounded, which is part of its instances' slack.
static struct word4 corner_of(const struct part_frame *frame, const float v[3], double side, uint32_t last) {
    float p[3];
    for (int i = 0; i < 3; i++) p[i] = (float)(((double)v[i] - frame->center[i]) * frame->scale + side * 0x1p-120);
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

static enum kind kind_of(const struct upload *u, uint32_t primitive) {
    if (primitive < u->triangle_count) return KIND_TRIANGLE;
    return primitive - u->triangle_count < u->sphere_count ? KIND_SPHERE : KIND_INSTANCE;
}

static bool has_kind(const struct upload *u, enum kind kind) {
    static const uint32_t needed[] = {
        [KIND_TRIANGLE] = EFFECT_TRIANGLES, [KIND_SPHERE] = EFFECT_SPHERES, [KIND_INSTANCE] = EFFECT_TRIANGLES | EFFECT_INSTANCES};
    return (u->effects & needed[kind]) == needed[kind];
}

static bool tree_init(struct tree *tree, struct context *ctx, const struct bvh *bvh) {
    tree->bvh = bvh;
    tree->inner = array_alloc(ctx, bvh->node_count, sizeof *tree->inner, "node numbers");
    for (uint32_t i = 0; tree->inner && i < bvh->node_count; i++) {
        tree->inner[i] = tree->inner_count;
        if (bvh->nodes[i].count == 0) tree->inner_count++;
    }
    return tree->inner != NULL;
}

static bool make_trees(struct upload *u, struct context *ctx) {
    const uint32_t parts = has_kind(u, KIND_INSTANCE) ? u->scene->part_count : 0;
    u->trees = array_alloc(ctx, parts + 1u, sizeof *u->trees, "hierarchies");
    if (!u->trees) return false;
    u->tree_count = parts + 1;
    u->triangle_slots = u->triangle_count;
    for (uint32_t i = 0; i <= parts; i++) {
        struct tree *tree = &u->trees[i];
        tree->first_node = i ? tree[-1].first_node + tree[-1].inner_count : 0;
        tree->first_slot = i ? u->triangle_slots : 0;
        tree->frame = i ? part_frame_of(&u->scene->parts[i - 1]) : (struct part_frame){{u->base[0], u->base[1], u->base[2]}, u->scale};
        if (!tree_init(tree, ctx, i ? &u->bvh->parts[i - 1] : u->bvh)) return false;
        if (i) u->triangle_slots += tree->bvh->primitive_count;
    }
    return true;
}

static bool make_slots(struct upload *u, struct context *ctx) {
    if ((u->triangle_count > 0) + (u->sphere_count > 0) + (u->scene->instance_count > 0) <= 1) return true;
    u->slot = array_alloc(ctx, u->bvh->primitive_count, sizeof *u->slot, "primitive numbers");
    u->primitive_at[KIND_TRIANGLE] = array_alloc(ctx, u->triangle_count, sizeof *u->slot, "primitive numbers");
    u->primitive_at[KIND_SPHERE] = array_alloc(ctx, u->sphere_count, sizeof *u->slot, "primitive numbers");
    if (!u->slot || !u->primitive_at[KIND_TRIANGLE] || !u->primitive_at[KIND_SPHERE]) return false;
    uint32_t next[3] = {0, 0, 0};
    for (uint32_t i = 0; i < u->bvh->primitive_count; i++) {
        const enum kind kind = kind_of(u, u->bvh->order[i]);
        if (kind != KIND_INSTANCE) u->primitive_at[kind][next[kind]] = u->bvh->order[i];
        u->slot[i] = next[kind]++;
    }
    return true;
}

static bool has_record(const struct upload *u, const struct scene_shape *shape) {
    if (shape->instance) return has_kind(u, KIND_INSTANCE);
    return shape->type == SHAPE_SPHERE && shape->moves && u->effects & EFFECT_MOTION_BLUR;
}

// Gives records their places, behind the words of the objects.
static bool make_records(struct upload *u, struct context *ctx) {
    const uint32_t shapes = u->scene->shape_count, first = (shapes + 3) / 4;
    if (!(u->effects & (EFFECT_INSTANCES | EFFECT_MOTION_BLUR))) return true;
    u->record_of = array_alloc(ctx, shapes, sizeof *u->record_of, "instances");
    if (!u->record_of) return false;
    for (uint32_t i = 0; i < shapes; i++)
        if (has_record(u, &u->scene->shapes[i])) u->record_of[i] = first + INSTANCE_WORDS * u->record_count++;
    return (uint64_t)first + (uint64_t)INSTANCE_WORDS * u->record_count <= REF_FIRST_MASK ||
           fail(ctx, GN_LIMIT, "%u instances are more than a hierarchy on a device can refer to (%u)", u->record_count, (REF_FIRST_MASK - first) / INSTANCE_WORDS);
}

static bool upload_init(struct upload *u, struct context *ctx, const struct scene *scene, const struct bvh *bvh, uint32_t effects, const float *eye) {
    *u = (struct upload){.scene = scene, .bvh = bvh, .effects = effects};
    scene_base(u->base, scene, eye);
    u->scale = find_scale(scene, u->base);
    u->triangle_count = scene_triangle_count(scene);
    u->sphere_count = scene_sphere_count(scene);
    return make_trees(u, ctx) && make_slots(u, ctx) && make_records(u, ctx);
}

static void upload_finish(struct upload *u) {
    light_table_finish(&u->lights);
    for (uint32_t i = 0; i < u->tree_count; i++) free(u->trees[i].inner);
    free(u->trees);
    free(u->slot);
    free(u->primitive_at[KIND_TRIANGLE]);
    free(u->primitive_at[KIND_SPHERE]);
    free(u->record_of);
    free(u->first_attribute);
}

// --------------------------------------------------------------------------------------------------------------- nodes

// In place of a leaf whose kind is disabled: the null primitive, behind the last one, of a kind that is not.
static uint32_t null_reference(const struct upload *u) {
    const bool sphere = !has_kind(u, KIND_TRIANGLE);
    return REF_LEAF | (sphere ? REF_SPHERES | u->sphere_count : u->triangle_slots);
}

static uint32_t leaf_reference(const struct upload *u, const struct tree *tree, const struct bvh_node *node) {
    const uint32_t count = (node->count - 1) << REF_COUNT_SHIFT, primitive = tree->bvh->order[node->first];
    if (tree != u->trees) return REF_LEAF | count | (tree->first_slot + node->first);
    const enum kind kind = kind_of(u, primitive);
    if (!has_kind(u, kind)) return null_reference(u);
    if (kind == KIND_INSTANCE)
        return REF_LEAF | REF_INSTANCE | u->record_of[u->scene->instances[primitive - u->triangle_count - u->sphere_count].shape];
    return REF_LEAF | (kind == KIND_SPHERE ? REF_SPHERES : 0u) | count | (u->slot ? u->slot[node->first] : node->first);
}

static uint32_t node_reference(const struct upload *u, const struct tree *tree, uint32_t number) {
    const struct bvh_node *node = &tree->bvh->nodes[number];
    return node->count ? leaf_reference(u, tree, node) : tree->first_node + tree->inner[number];
}

static uint32_t root_reference(const struct upload *u) {
    if (u->bvh->node_count == 0 || !(u->effects & (EFFECT_TRIANGLES | EFFECT_SPHERES))) return REF_NONE;
    if (u->effects & EFFECT_BVH) return node_reference(u, u->trees, 0);
    // Without a hierarchy (the plan prunes it for a few primitives of one kind): one leaf of all.
    const struct bvh_node all = {.first = 0, .count = u->bvh->primitive_count};
    return leaf_reference(u, u->trees, &all);
}

static void write_node(const struct upload *u, const struct tree *tree, uint32_t number, struct word4 *to) {
    uint32_t first = tree->bvh->nodes[number].first;
    const struct bvh_node *left = &tree->bvh->nodes[first], *right = left + 1;
    to[0] = corner_of(&tree->frame, left->min, -1, node_reference(u, tree, first));
    to[1] = corner_of(&tree->frame, left->max, +1, node_reference(u, tree, first + 1));
    to[2] = corner_of(&tree->frame, right->min, -1, 0);
    to[3] = corner_of(&tree->frame, right->max, +1, 0);
}

// The last node before which there are `inner` inner nodes and which is one itself.
static uint32_t find_inner(const struct tree *tree, uint32_t inner) {
    uint32_t low = 0, high = tree->bvh->node_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low + 1) / 2;
        if (tree->inner[middle] <= inner) low = middle;
        else high = middle - 1;
    }
    return low;
}

// The tree that has inner node `node` of all: the last that begins at or before it.
static const struct tree *find_tree(const struct upload *u, uint64_t node) {
    uint32_t low = 0, high = u->tree_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (u->trees[middle].first_node <= node) low = middle;
        else high = middle;
    }
    return &u->trees[low];
}

static bool fill_nodes(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    struct word4 *word = to;
    const uint64_t begin = offset / (NODE_WORDS * sizeof *word), end = begin + size / (NODE_WORDS * sizeof *word);
    const struct tree *tree = find_tree(u, begin);
    for (uint64_t at = begin; at < end; tree++) {
        uint32_t number = tree->inner_count ? find_inner(tree, (uint32_t)(at - tree->first_node)) : 0;
        for (; at < end && at - tree->first_node < tree->inner_count; number++) {
            if (tree->bvh->nodes[number].count) continue;
            write_node(u, tree, number, word);
            word += NODE_WORDS;
            at++;
        }
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

// A triangle of a part: its vertices as the mesh has them. Where the mesh has no materials the instances' shapes, or the one that moves, have one.
static void write_part_triangle(const struct upload *u, uint32_t slot, struct word4 *to) {
    uint32_t low = 1, high = u->tree_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (u->trees[middle].first_slot <= slot) low = middle;
        else high = middle;
    }
    const struct tree *tree = &u->trees[low];
    const struct scene_mesh *mesh = u->scene->parts[low - 1].mesh;
    const uint32_t primitive = tree->bvh->order[slot - tree->first_slot], *index = mesh->indices + 3 * (size_t)primitive;
    const uint32_t last[3] = {0, primitive, mesh->materials ? mesh->materials[primitive] : 0};
    for (int i = 0; i < 3; i++) to[i] = word4_of(mesh->positions + 3 * (size_t)index[i], last[i]);
}

static void write_sphere(const struct upload *u, uint32_t number, struct word4 *to) {
    uint32_t object = scene_sphere_object(u->scene, number);
    const struct scene_shape *shape = &u->scene->shapes[object];
    to[0] = point_of(u, shape->center, float_bits(shape->radius * u->scale));
    to[1] = (struct word4){{object, shape->material, u->record_of ? u->record_of[object] : 0, 0}};
}

// Slots [begin, end) of one kind; the slot behind the last primitive is the null primitive, which nothing hits.
struct slots {
    const struct upload *u;
    struct word4 *to;
    uint64_t first;
    bool spheres;
};

static void write_slot(const struct slots *s, uint32_t slot, struct word4 *to) {
    const struct upload *u = s->u;
    if (!s->spheres && slot >= u->triangle_count) {
        write_part_triangle(u, slot, to);
        return;
    }
    const uint32_t *primitive_at = u->primitive_at[s->spheres ? KIND_SPHERE : KIND_TRIANGLE], primitive = (primitive_at ? primitive_at : u->bvh->order)[slot];
    if (s->spheres) write_sphere(u, primitive - u->triangle_count, to);
    else write_triangle(u, primitive, to);
}

static bool write_slots(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    const struct slots *s = data;
    const uint32_t words = s->spheres ? SPHERE_WORDS : TRIANGLE_WORDS, count = s->spheres ? s->u->sphere_count : s->u->triangle_slots;
    for (size_t i = begin; i < end; i++) {
        struct word4 *to = s->to + words * i;
        if (s->first + i < count) {
            write_slot(s, (uint32_t)(s->first + i), to);
            continue;
        }
        for (uint32_t w = 0; w < words; w++) to[w] = (struct word4){{0x7fc00000u, 0x7fc00000u, 0x7fc00000u, 0}}; // NaN hits nothing
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

// ----------------------------------------------------------------------------------------------------------- instances

static uint64_t instance_words(const struct upload *u) {
    return u->record_of ? ((uint64_t)u->scene->shape_count + 3) / 4 + (uint64_t)INSTANCE_WORDS * (u->record_count ? u->record_count : 1) : 0;
}

static void write_record(const struct upload *u, uint32_t object, struct word4 *to) {
    const struct scene_shape *shape = &u->scene->shapes[object];
    if (!shape->instance) {
        write_moving_sphere(to, shape, u->base, u->scale);
        return;
    }
    const struct scene_instance *instance = &u->scene->instances[shape->instance - 1];
    const struct tree *tree = &u->trees[instance->part + 1];
    write_instance(to, u->scene, instance, u->base, u->scale, node_reference(u, tree, 0), u->triangle_slots + instance->first - tree->first_slot);
}

// Asked for in any pieces of whole words, as the records begin behind a varying number of them.
static bool fill_instances(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    const uint32_t shapes = u->scene->shape_count;
    const uint64_t begin = offset / sizeof(struct word4), end = begin + size / sizeof(struct word4), heads = ((uint64_t)shapes + 3) / 4;
    struct word4 *word = to, record[INSTANCE_WORDS];
    memset(to, 0, size);
    for (uint64_t i = begin; i < end && i < heads; i++)
        for (uint32_t k = 0; k < 4 && 4 * i + k < shapes; k++) word[i - begin].w[k] = u->record_of[4 * i + k];
    for (uint32_t object = 0; object < shapes; object++) {
        const uint64_t at = u->record_of[object];
        if (at == 0 || at >= end || at + INSTANCE_WORDS <= begin) continue;
        write_record(u, object, record);
        for (uint64_t k = 0; k < INSTANCE_WORDS; k++)
            if (at + k >= begin && at + k < end) word[at + k - begin] = record[k];
    }
    return true;
}

// ------------------------------------------------------------------------------------------------------------- shading

#define EFFECTS_LIT (EFFECT_DIFFUSE | EFFECT_SPECULAR | EFFECT_BLINN | EFFECT_GGX | EFFECT_FOG) // that ask lights
#define EFFECTS_WITH_UVS (EFFECT_TEXTURES | EFFECT_NORMAL_MAPS | EFFECT_ALPHA)

// Whether kernels look at a mesh's vertices once more after the hit.
static bool has_attributes(const struct upload *u, const struct scene_mesh *mesh) {
    return (mesh->normals && u->effects & EFFECT_SMOOTH_NORMALS) || (mesh->uvs && u->effects & EFFECTS_WITH_UVS);
}

// The meshes with arrays of attributes, one after the other: those of the shapes, then the prototypes.
static uint32_t mesh_count(const struct upload *u) { return u->scene->shape_count + u->scene->prototype_count; }
static const struct scene_mesh *mesh_at(const struct upload *u, uint32_t number) {
    const uint32_t shapes = u->scene->shape_count;
    return number < shapes ? &u->scene->shapes[number].mesh : &u->scene->prototypes[number - shapes];
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
    for (uint32_t i = 0; i < mesh_count(u); i++) {
        const struct scene_mesh *mesh = mesh_at(u, i);
        if (!has_attributes(u, mesh)) continue;
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
    for (uint32_t i = 0; i < mesh_count(u); i++) {
        const struct scene_mesh *mesh = mesh_at(u, i);
        if (!has_attributes(u, mesh)) continue;
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
static uint32_t light_count(const struct upload *u) { return u->effects & EFFECTS_LIT ? u->scene->light_count : 0; }

static uint32_t light_of(const struct upload *u, uint32_t object) {
    const uint32_t light = scene_light_of(u->scene, object);
    return light < light_count(u) && u->lights.kind[light] != ABSENT_LIGHT ? light : NO_LIGHT;
}

static bool fill_objects(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct upload *u = data;
    uint64_t begin = offset / sizeof(struct word4), end = begin + size / sizeof(struct word4);
    for (uint64_t i = begin; i < end; i++) {
        const struct scene_shape *shape = &u->scene->shapes[i];
        const uint32_t mesh = shape->type == SHAPE_INSTANCE ? u->scene->shape_count + shape->prototype : (uint32_t)i;
        const uint32_t first = has_attributes(u, mesh_at(u, mesh)) ? u->first_attribute[mesh] : NO_ATTRIBUTES;
        ((struct word4 *)to)[i - begin] = (struct word4){{first, light_of(u, (uint32_t)i), 0, 0}};
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

static uint32_t switches_of(const struct scene *scene) {
    return (scene->shadows ? SWITCH_SHADOWS : 0) | (scene->paths.indirect ? SWITCH_INDIRECT : 0) | (scene->environment.width > 0 ? SWITCH_ENVIRONMENT : 0);
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
        {{float_bits(scene->fog.anisotropy), switches_of(scene), 0, 0}},
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

static bool count_attributes(struct upload *u, struct context *ctx, uint64_t *triangles, uint64_t *vertices) {
    *triangles = *vertices = 0;
    u->first_attribute = array_alloc(ctx, mesh_count(u), sizeof *u->first_attribute, "vertex attributes");
    if (!u->first_attribute) return false;
    for (uint32_t i = 0; i < mesh_count(u); i++) {
        u->first_attribute[i] = (uint32_t)*triangles;
        if (!has_attributes(u, mesh_at(u, i))) continue;
        *triangles += mesh_at(u, i)->triangle_count;
        *vertices += mesh_at(u, i)->vertex_count;
    }
    return true;
}

static bool make_shading(struct device_scene *out, struct context *ctx, struct device *device, struct upload *u) {
    uint64_t triangles, vertices;
    bool normals = u->effects & EFFECT_SMOOTH_NORMALS, uvs = u->effects & EFFECTS_WITH_UVS, objects = normals || uvs || u->effects & EFFECT_SOFT_SHADOWS;
    out->light_count = light_count(u);
    if (!count_attributes(u, ctx, &triangles, &vertices) || !light_table_init(&u->lights, ctx, u->scene, u->effects)) return false;
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
    const struct tree *last = &u->trees[u->tree_count - 1];
    return make(&out->nodes, ctx, device, u, "bvh nodes", last->first_node + last->inner_count, NODE_WORDS, fill_nodes) &&
           make(&out->triangles, ctx, device, u, "triangles", triangles ? u->triangle_slots + 1ull : 0, TRIANGLE_WORDS, fill_triangles) &&
           make(&out->spheres, ctx, device, u, "spheres", spheres ? u->sphere_count + 1ull : 0, SPHERE_WORDS, fill_spheres) &&
           make(&out->instances, ctx, device, u, "instances", instance_words(u), 1, fill_instances);
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
                                &ds->lights, &ds->indices, &ds->normals, &ds->uvs, &ds->globals, &ds->emitters, &ds->instances};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) buffer_finish(buffers[i], device);
    *ds = (struct device_scene){0};
}

void device_point(float out[3], const struct device_scene *ds, const float point[3]) {
    for (int i = 0; i < 3; i++) out[i] = (float)(((double)point[i] - ds->base[i]) * ds->scale);
}

size_t device_scene_bindings(struct device_scene *ds, struct kernel_binding *bindings, bool shading) {
    struct kernel_binding all[DEVICE_SCENE_BINDINGS] = {
        {BINDING_NODES, &ds->nodes, NULL},         {BINDING_TRIANGLES, &ds->triangles, NULL}, {BINDING_SPHERES, &ds->spheres, NULL},
        {BINDING_INSTANCES, &ds->instances, NULL},
        {BINDING_OBJECTS, &ds->objects, NULL},     {BINDING_MATERIALS, &ds->materials, NULL}, {BINDING_LIGHTS, &ds->lights, NULL},
        {BINDING_INDICES, &ds->indices, NULL},     {BINDING_NORMALS, &ds->normals, NULL},     {BINDING_GLOBALS, &ds->globals, NULL},
        {BINDING_UVS, &ds->uvs, NULL},             {BINDING_EMITTERS, &ds->emitters, NULL},
    };
    size_t count = shading ? DEVICE_SCENE_BINDINGS : 4;
    memcpy(bindings, all, count * sizeof *bindings);
    return count;
}
