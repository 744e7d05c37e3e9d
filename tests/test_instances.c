// Instances and shapes that move, against the same scene with every vertex put where it is: the same hits to the bit, in every tier and in the reference.
#include "shot.h"

#include <float.h>
#include <math.h>

#include "bvh/scene_boxes.h"
#include "effects/plan.h"
#include "oracle.h"
#include "reference/reference.h"
#include "reference/resolve.h"
#include "render/render.h"
#include "scene/build.h"
#include "scene/instances.h"

#define MOST_SHAPES 24

static uint32_t below(uint64_t *state, uint32_t count) { return oracle_random(state) % count; }

// --------------------------------------------------------------------------------------------------------------- making scenes

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    assert_non_null(memory);
    return memory;
}

// A closed bumpy surface of 2·n·(n - 1)… triangles around the origin, radius about 1, with vertex normals.
static struct scene_mesh ball_make(uint32_t n, uint64_t seed) {
    struct scene_mesh mesh = {.vertex_count = 2 * n * n + 2, .triangle_count = 4 * n * n};
    mesh.positions = allocate(3 * (size_t)mesh.vertex_count, sizeof(float));
    mesh.normals = allocate(3 * (size_t)mesh.vertex_count, sizeof(float));
    mesh.indices = allocate(3 * (size_t)mesh.triangle_count, sizeof(uint32_t));
    const uint32_t south = 2 * n * n, north = south + 1, across = 2 * n;
    uint64_t state = seed;
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        double polar = 3.14159265 * (i / across + 1) / (n + 1), turn = 3.14159265 * (i % across) / n, radius = 0.8 + 0.4 * oracle_uniform(&state);
        if (i >= south) polar = i == south ? 0 : 3.14159265;
        const double p[3] = {sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)};
        for (int k = 0; k < 3; k++) {
            mesh.positions[3 * i + k] = (float)(radius * p[k]);
            mesh.normals[3 * i + k] = (float)p[k];
        }
    }
    uint32_t *to = mesh.indices;
    for (uint32_t row = 0; row <= n; row++)
        for (uint32_t k = 0; k < across; k++) {
            const uint32_t a = row == 0 ? south : (row - 1) * across + k, b = row == 0 ? south : (row - 1) * across + (k + 1) % across;
            const uint32_t c = row == n ? north : row * across + k, d = row == n ? north : row * across + (k + 1) % across;
            if (row < n) *to++ = a, *to++ = c, *to++ = d;
            if (row > 0) *to++ = a, *to++ = d, *to++ = b;
        }
    assert_true(to == mesh.indices + 3 * (size_t)mesh.triangle_count);
    return mesh;
}

static struct scene_mesh mesh_copy(const struct scene_mesh *from) {
    struct scene_mesh mesh = *from;
    mesh.positions = allocate(3 * (size_t)mesh.vertex_count, sizeof(float));
    mesh.indices = allocate(3 * (size_t)mesh.triangle_count, sizeof(uint32_t));
    memcpy(mesh.positions, from->positions, 3 * (size_t)mesh.vertex_count * sizeof(float));
    memcpy(mesh.indices, from->indices, 3 * (size_t)mesh.triangle_count * sizeof(uint32_t));
    mesh.normals = NULL;
    return mesh;
}

static struct scene empty_scene(void) {
    struct scene scene = {.film = {.width = 16, .height = 16, .spp = 1, .filter_radius = 0.5f}, .shadows = true, .material_count = 1};
    scene.camera = (struct scene_camera){.position = {0, 0, 9}, .up = {0, 1, 0}, .fov_y_deg = 60};
    scene.materials = allocate(1, sizeof *scene.materials);
    scene.shapes = allocate(MOST_SHAPES, sizeof *scene.shapes);
    scene.prototypes = allocate(4, sizeof *scene.prototypes);
    return scene;
}

static struct scene_shape *add_shape(struct scene *scene, enum shape_type type) {
    struct scene_shape *shape = &scene->shapes[scene->shape_count++];
    assert_true(scene->shape_count <= MOST_SHAPES);
    *shape = (struct scene_shape){.type = type};
    return shape;
}

static struct scene_shape *add_instance(struct scene *scene, uint32_t prototype, const float placement[12]) {
    struct scene_shape *shape = add_shape(scene, SHAPE_INSTANCE);
    shape->prototype = prototype;
    memcpy(shape->placement, placement, sizeof shape->placement);
    return shape;
}

static struct scene_shape *add_sphere(struct scene *scene, float x, float y, float z, float radius) {
    struct scene_shape *shape = add_shape(scene, SHAPE_SPHERE);
    shape->center[0] = x, shape->center[1] = y, shape->center[2] = z, shape->radius = radius;
    return shape;
}

static void finish_making(struct scene *scene) { fixture_assert(scene_derive(scene, fixture_context())); }

// The fl(…) sequence of scene.h, with every result stored, so that no compiler keeps more digits.
static void place_by_hand(float out[3], const struct scene_shape *shape, const float v[3], float time) {
    for (int i = 0; i < 3; i++) {
        volatile float sum = v[i], product;
        if (shape->type == SHAPE_INSTANCE) {
            const float *m = shape->placement + 4 * i;
            sum = m[0] * v[0];
            product = m[1] * v[1];
            sum = sum + product;
            product = m[2] * v[2];
            sum = sum + product;
            sum = sum + m[3];
        }
        product = time * shape->motion[i];
        out[i] = shape->moves ? sum + product : sum;
    }
}

// The same scene with every vertex where it is at a time. Call it before the scene's derived fields are filled.
static struct scene frozen(const struct scene *scene, float time) {
    struct scene out = empty_scene();
    out.camera = scene->camera;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct scene_shape *shape = &scene->shapes[i];
        struct scene_shape *copy = add_shape(&out, shape->type == SHAPE_INSTANCE ? SHAPE_MESH : shape->type);
        place_by_hand(copy->center, shape, shape->center, time);
        copy->radius = shape->radius;
        if (shape->type == SHAPE_SPHERE) continue;
        copy->mesh = mesh_copy(shape->type == SHAPE_INSTANCE ? &scene->prototypes[shape->prototype] : &shape->mesh);
        for (uint32_t k = 0; k < copy->mesh.vertex_count; k++) {
            float placed[3];
            place_by_hand(placed, shape, copy->mesh.positions + 3 * (size_t)k, time);
            memcpy(copy->mesh.positions + 3 * (size_t)k, placed, sizeof placed);
        }
    }
    return out;
}

// --------------------------------------------------------------------------------------------------------------- placements

static void rotation(double m[3][3], uint64_t *state) {
    double q[4], length = 0;
    for (int i = 0; i < 4; i++) q[i] = 2 * oracle_uniform(state) - 1, length += q[i] * q[i];
    for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    memcpy(m, r, sizeof r);
}

// A rotation, times axes scaled and sheared, times `size`; then a place.
static void placement_make(float out[12], uint64_t *state, const double axes[3], double shear, double size, const double place[3]) {
    double r[3][3];
    rotation(r, state);
    for (int i = 0; i < 3; i++) {
        const double row[3] = {r[i][0], r[i][1] + shear * r[i][0], r[i][2] - shear * r[i][1]};
        for (int k = 0; k < 3; k++) out[4 * i + k] = (float)(row[k] * axes[k] * size);
        out[4 * i + 3] = (float)place[i];
    }
}

// Where things are around: each fills a scene.
struct setting {
    const char *name;
    double size, spread, away; // of the instances; of their places around; how far all of it is from the origin
    double axes[3], shear;
    uint32_t flattened;        // instances that are to be meshes
};

static const struct setting settings[] = {
    {"rotated", 1, 4, 0, {1, 1, 1}, 0, 0},
    {"translated by 1e4", 1, 4, 1e4, {1, 1, 1}, 0, 0},
    {"translated by 4.5e6", 1, 4, 4.5e6, {1, 1, 1}, 0, 0},
    {"mirrored", 1, 4, 0, {-1, 1, 1}, 0, 0},
    {"sheared", 1, 4, 0, {1, 1, 1}, 2, 0},
    {"stretched", 1, 4, 10, {1, 0.02, 3}, 0.5, 0},
    {"flat as a leaf", 1, 4, 0, {1, 1e-4, 1}, 0, 0},
    {"flatter than is good", 1, 4, 0, {1, 1e-6, 1}, 0, 6},
    {"scaled by 1e-4", 1e-4, 4e-4, 0, {1, 1, 1}, 0.3, 0},
    {"scaled by 1e-4 in a large place", 1e-4, 3, 0, {1, 1, 1}, 0.3, 0},
    {"scaled by 1e-4, translated by 1e2", 1e-4, 3e-4, 1e2, {1, 1, 1}, 0, 0},
    {"scaled by 1e-4, translated by 1e4", 1e-4, 3e-4, 1e4, {1, 1, 1}, 0, 0},
    {"scaled by 1e4", 1e4, 4e4, 0, {1, -1, 1}, 0.3, 0},
    {"scaled by 1e-25", 1e-25, 4e-25, 0, {1, 1, 1}, 0.3, 0},
    {"scaled by 1e-37", 1e-37, 4e-37, 0, {1, 1, 1}, 0.3, 6},
    {"scaled by 1e25", 1e25, 4e25, 0, {1, 1, 1}, 0.3, 0},
};
#define SETTINGS (sizeof settings / sizeof settings[0])
#define INSTANCES 6

static void fill(struct scene *scene, const struct setting *how, bool moving) {
    uint64_t state = 5;
    *scene = empty_scene();
    scene->prototypes[scene->prototype_count++] = ball_make(6, 3);
    scene->prototypes[scene->prototype_count++] = ball_make(3, 4);
    float placement[12];
    double place[3];
    for (uint32_t i = 0; i < INSTANCES; i++) {
        for (int k = 0; k < 3; k++) place[k] = how->away * (k == 1 ? -0.7 : 1) + how->spread * (oracle_uniform(&state) - 0.5);
        placement_make(placement, &state, how->axes, how->shear, how->size, place);
        struct scene_shape *shape = add_instance(scene, i % 2, placement);
        if (moving && i % 3 != 1) {
            shape->moves = true;
            for (int k = 0; k < 3; k++) shape->motion[k] = (float)(how->size * (2 * oracle_uniform(&state) - 1));
        }
        if (i == 2) add_sphere(scene, (float)place[0], (float)(place[1] + how->size), (float)place[2], (float)(0.3 * how->size));
    }
    struct scene_shape *plain = add_shape(scene, SHAPE_MESH);
    plain->mesh = ball_make(3, 5);
    for (uint32_t i = 0; i < 3 * plain->mesh.vertex_count; i++)
        plain->mesh.positions[i] = (float)(how->away * (i % 3 == 1 ? -0.7 : 1) + 0.4 * how->size * plain->mesh.positions[i]);
    if (moving) {
        struct scene_shape *sphere = add_sphere(scene, (float)how->away, (float)(-0.7 * how->away), (float)how->away, (float)(0.5 * how->size));
        struct scene_shape *mesh = plain;
        for (int k = 0; k < 3; k++) {
            sphere->motion[k] = (float)(how->size * (k - 0.9));
            mesh->motion[k] = (float)(how->size * (0.7 - k));
        }
        sphere->moves = mesh->moves = true;
    }
    for (int k = 0; k < 3; k++) {
        scene->camera.look_at[k] = (float)(how->away * (k == 1 ? -0.7 : 1));
        scene->camera.position[k] = (float)(how->away * (k == 1 ? -0.7 : 1) + 2 * how->spread * (k == 2));
    }
}

// Rays at vertices, points of edges and anywhere, from near, far and inside.
static void aim(struct gn_ray *rays, uint32_t count, const struct scene *flat, const struct setting *how) {
    uint64_t state = 9;
    for (uint32_t i = 0; i < count; i++) {
        const struct scene_triangle t = scene_triangle_at(flat, below(&state, scene_triangle_count(flat)));
        const double s = i % 3 == 0 ? 0 : oracle_uniform(&state), r = i % 3 < 2 ? 0 : oracle_uniform(&state) * (1 - s);
        const double away = how->spread * (i % 5 == 0 ? 100 : i % 5 == 1 ? 0.2 : 3);
        rays[i] = (struct gn_ray){.tmin = 0, .tmax = i % 11 ? INFINITY : 1};
        for (int k = 0; k < 3; k++) {
            const double p = t.v[0][k] + s * ((double)t.v[1][k] - t.v[0][k]) + r * ((double)t.v[2][k] - t.v[0][k]);
            const double center = how->away * (k == 1 ? -0.7 : 1);
            rays[i].origin[k] = (float)(center + away * (2 * oracle_uniform(&state) - 1));
            rays[i].direction[k] = (float)p - rays[i].origin[k];
            if (i % 17 == 0 && k == (int)(i % 3)) rays[i].direction[k] = 0;
        }
        if (rays[i].direction[0] == 0 && rays[i].direction[1] == 0 && rays[i].direction[2] == 0) rays[i].direction[0] = 1;
    }
}

// --------------------------------------------------------------------------------------------------------------- the tests

struct pair {
    struct scene scene, flat;
    struct bvh bvh, flat_bvh;
};

static void pair_build(struct pair *pair) {
    finish_making(&pair->scene);
    finish_making(&pair->flat);
    fixture_assert(bvh_build_scene(&pair->bvh, fixture_context(), &pair->scene));
    fixture_assert(bvh_build_scene(&pair->flat_bvh, fixture_context(), &pair->flat));
}

static void pair_finish(struct pair *pair) {
    bvh_finish(&pair->bvh);
    bvh_finish(&pair->flat_bvh);
    scene_finish(&pair->scene);
    scene_finish(&pair->flat);
}

static bool same_hit(const struct gn_hit *a, const struct gn_hit *b) {
    return a->t == b->t && a->u == b->u && a->v == b->v && a->object == b->object && a->primitive == b->primitive;
}

static void bounds_and_kinds(void **state) {
    (void)state;
    for (size_t i = 0; i < SETTINGS; i++) {
        struct pair pair;
        fill(&pair.scene, &settings[i], false);
        pair.flat = frozen(&pair.scene, 0);
        pair_build(&pair);
        assert_int_equal(pair.scene.instance_count, INSTANCES - settings[i].flattened);
        assert_int_equal(pair.flat.instance_count, 0);
        assert_int_equal(pair.scene.part_count, settings[i].flattened ? 0 : 2);
        assert_memory_equal(pair.scene.bounds_min, pair.flat.bounds_min, sizeof pair.flat.bounds_min);
        assert_memory_equal(pair.scene.bounds_max, pair.flat.bounds_max, sizeof pair.flat.bounds_max);
        pair_finish(&pair);
    }
}

static void reference_hits_the_same(void **state) {
    (void)state;
    enum { RAYS = 3000 };
    static struct gn_ray rays[RAYS];
    static struct gn_hit hits[RAYS], right[RAYS];
    for (size_t i = 0; i < SETTINGS; i++) {
        struct pair pair;
        fill(&pair.scene, &settings[i], false);
        pair.flat = frozen(&pair.scene, 0);
        pair_build(&pair);
        aim(rays, RAYS, &pair.flat, &settings[i]);
        uint32_t found = 0, wrong = 0, wrong_any = 0;
        fixture_assert(reference_trace(hits, fixture_context(), &pair.scene, &pair.bvh, rays, RAYS, false));
        fixture_assert(reference_trace(right, fixture_context(), &pair.flat, &pair.flat_bvh, rays, RAYS, false));
        for (uint32_t k = 0; k < RAYS; k++) {
            found += right[k].object >= 0;
            wrong += !same_hit(&hits[k], &right[k]);
        }
        fixture_assert(reference_trace(hits, fixture_context(), &pair.scene, &pair.bvh, rays, RAYS, true));
        for (uint32_t k = 0; k < RAYS; k++) wrong_any += (hits[k].object >= 0) != (right[k].object >= 0);
        print_message("%-36s %u of %u rays hit, %u wrong, %u any\n", settings[i].name, found, RAYS, wrong, wrong_any);
        assert_true(found > RAYS / 3);
        assert_int_equal(wrong + wrong_any, 0);
        pair_finish(&pair);
    }
}

#define EVERY_HIT (EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_BVH)

// Exact is the same to the bit. What the other tiers take for a hit may lie outside the triangle, and its box, by their rounding: the padded boxes of an
// instance let them find a little more, and never less.
static uint32_t differences(const struct gn_hit *hits, const struct gn_hit *right, uint32_t count, uint32_t tier, bool any) {
    const bool strict = tier == TIER_EXACT;
    uint32_t wrong = 0, more = 0;
    for (uint32_t k = 0; k < count; k++) {
        const bool same = any ? (hits[k].object >= 0) == (right[k].object >= 0) : same_hit(&hits[k], &right[k]);
        const bool nearer = any ? hits[k].object >= 0 : hits[k].object >= 0 && hits[k].t <= right[k].t;
        more += !same && !strict && nearer;
        if (same || (!strict && nearer) || wrong++ >= 3) continue;
        print_message("  ray %u: object %d primitive %d t %a, expected %d %d %a\n", k, hits[k].object, hits[k].primitive, (double)hits[k].t,
                      right[k].object, right[k].primitive, (double)right[k].t);
    }
    assert_true(more <= (tier == TIER_ROBUST ? count / 2000 : count / 200));
    return wrong;
}

static void every_tier_hits_the_same(void **state) {
    (void)state;
    enum { RAYS = 3000 };
    static struct gn_ray rays[RAYS];
    static struct gn_hit hits[RAYS], right[RAYS];
    uint32_t all_wrong = 0;
    for (size_t i = 0; i < SETTINGS; i++) {
        struct pair pair;
        fill(&pair.scene, &settings[i], false);
        pair.flat = frozen(&pair.scene, 0);
        pair_build(&pair);
        aim(rays, RAYS, &pair.flat, &settings[i]);
        for (uint32_t tier = 0; tier < TIER_COUNT; tier++) {
            if (tier == TIER_FP64 && !fixture_device()->has_fp64) continue;
            for (int any = 0; any < 2; any++) {
                struct render_trace_stats stats;
                struct render_trace_params params = {.tier = tier, .effects = EVERY_HIT | EFFECT_INSTANCES, .any = any, .repeat = 1};
                fixture_assert(render_trace(hits, &stats, fixture_context(), fixture_device(), &pair.scene, &pair.bvh, &params, rays, RAYS));
                params.effects = EVERY_HIT;
                fixture_assert(render_trace(right, &stats, fixture_context(), fixture_device(), &pair.flat, &pair.flat_bvh, &params, rays, RAYS));
                const uint32_t wrong = differences(hits, right, RAYS, tier, any);
                if (wrong) print_message("%s, tier %u, any %d: %u wrong\n", settings[i].name, tier, any, wrong);
                all_wrong += wrong;
            }
        }
        pair_finish(&pair);
    }
    assert_int_equal(all_wrong, 0);
}

// Shots at a time, of the first stage alone: in the exact tier what it leaves open may differ, but not what it decides.
static uint32_t shot_differences(const struct shoot_hit *hits, const struct shoot_hit *right, uint32_t count, uint32_t tier, uint32_t *open) {
    uint32_t wrong = 0;
    for (uint32_t k = 0; k < count; k++) {
        *open += hits[k].undecided | right[k].undecided;
        if (hits[k].undecided | right[k].undecided) continue;
        if (tier != TIER_EXACT && hits[k].object >= 0 && hits[k].t <= right[k].t) continue;
        if (hits[k].object == right[k].object && hits[k].primitive == right[k].primitive && hits[k].t == right[k].t) continue;
        if (wrong++ < 3)
            print_message("  tier %u, shot %u: object %d primitive %d t %a, expected %d %d %a\n", tier, k, hits[k].object, hits[k].primitive,
                          (double)hits[k].t, right[k].object, right[k].primitive, (double)right[k].t);
    }
    return wrong;
}

static void reference_at_time(struct gn_hit *out, const struct scene *scene, const struct bvh *bvh, const struct gn_ray *ray, float time) {
    const struct ref_world world = ref_world_make(scene, bvh, EVERY_HIT | EFFECT_INSTANCES);
    struct resolve_ray question = {.tmin = ray->tmin, .tmax = ray->tmax, .self = RESOLVE_NO_SELF, .time = time};
    struct resolve_answer answer;
    for (int k = 0; k < 3; k++) question.o[k] = ray->origin[k], question.d[k] = ray->direction[k];
    fixture_assert(resolve_rays(&answer, fixture_context(), &world, &question, 1));
    *out = answer.hit;
}

// What moves is where it is at the ray's time: against the scene frozen at that time; and against the scene at another time, as the control.
static void motion_is_the_scene_at_that_time(void **state) {
    (void)state;
    enum { RAYS = 2000, CHECKED = 300 };
    static const float times[] = {0, 0.25f, 0.7f, 0x1.fffffep-1f};
    static struct gn_ray rays[RAYS];
    static struct shoot_ray shots[RAYS];
    static struct shoot_hit hits[RAYS], right[RAYS];
    uint32_t all_wrong = 0;
    static const size_t chosen[] = {0, 1, 2, 4, 5, 8, 9, 12, 13};
    for (size_t i = 0; i < sizeof chosen / sizeof chosen[0]; i++) {
        const struct setting *how = &settings[chosen[i]];
        uint32_t wrong = 0, open = 0, reference_wrong = 0, control = 0;
        for (size_t at = 0; at < sizeof times / sizeof times[0]; at++) {
            struct pair pair;
            fill(&pair.scene, how, true);
            pair.flat = frozen(&pair.scene, times[at]);
            pair_build(&pair);
            aim(rays, RAYS, &pair.flat, how);
            for (uint32_t k = 0; k < RAYS; k++) {
                shots[k] = (struct shoot_ray){.tmin = rays[k].tmin, .tmax = rays[k].tmax, .target_object = -1, .self = SHOOT_NO_SELF, .time = times[at]};
                memcpy(shots[k].origin, rays[k].origin, sizeof shots[k].origin);
                memcpy(shots[k].direction, rays[k].direction, sizeof shots[k].direction);
            }
            // The frozen scene has other bounds, and may have another base: let it have the same.
            memcpy(pair.flat.bounds_min, pair.scene.bounds_min, sizeof pair.flat.bounds_min);
            memcpy(pair.flat.bounds_max, pair.scene.bounds_max, sizeof pair.flat.bounds_max);
            for (uint32_t tier = TIER_FAST; tier <= TIER_EXACT; tier++) {
                const struct shoot_params moving = {tier, EVERY_HIT | EFFECT_INSTANCES | EFFECT_MOTION_BLUR, false}, still = {tier, EVERY_HIT, false};
                shoot(hits, &pair.scene, &pair.bvh, &moving, shots, RAYS);
                shoot(right, &pair.flat, &pair.flat_bvh, &still, shots, RAYS);
                wrong += shot_differences(hits, right, RAYS, tier, &open);
            }
            for (uint32_t k = 0; k < CHECKED; k++) {
                struct gn_hit found, expected, other;
                reference_at_time(&found, &pair.scene, &pair.bvh, &rays[k], times[at]);
                reference_at_time(&expected, &pair.flat, &pair.flat_bvh, &rays[k], 0);
                reference_at_time(&other, &pair.scene, &pair.bvh, &rays[k], at ? 0 : 0.5f);
                reference_wrong += !same_hit(&found, &expected);
                control += !same_hit(&other, &expected);
            }
            pair_finish(&pair);
        }
        print_message("%-36s %u wrong, %u open, reference %u wrong, control %u\n", how->name, wrong, open, reference_wrong, control);
        all_wrong += wrong + reference_wrong;
        assert_true(control > CHECKED);
    }
    assert_int_equal(all_wrong, 0);
}

// Pictures of both: the same primitives, depths and shadows in every pixel, by rays that start on instances, too.
static void pictures_are_the_same(void **state) {
    (void)state;
    static const size_t chosen[] = {0, 2, 3, 5, 8};
    for (size_t i = 0; i < sizeof chosen / sizeof chosen[0]; i++) {
        struct pair pair;
        struct scene_light light = {.type = LIGHT_POINT, .intensity = {1, 1, 1}};
        fill(&pair.scene, &settings[chosen[i]], false);
        pair.flat = frozen(&pair.scene, 0);
        for (int k = 0; k < 3; k++) light.position[k] = pair.scene.camera.position[k] + (float)settings[chosen[i]].spread;
        struct scene *scenes[] = {&pair.scene, &pair.flat};
        for (int k = 0; k < 2; k++) {
            scenes[k]->lights = allocate(1, sizeof light);
            scenes[k]->lights[0] = light;
            scenes[k]->light_count = 1;
            for (int c = 0; c < 3; c++) scenes[k]->materials[0].diffuse[c] = 0.5f;
        }
        pair_build(&pair);
        for (uint32_t tier = TIER_ROBUST; tier <= TIER_EXACT; tier++) {
            struct render_film film[2];
            for (int k = 0; k < 2; k++) {
                const struct render_params params = {.width = 64, .height = 64, .spp = 4, .tier = tier, .aovs = GN_AOV_ID | GN_AOV_DEPTH,
                    .effects = EVERY_HIT | EFFECT_DIFFUSE | EFFECT_SHADOWS | EFFECT_ANTIALIASING | (k ? 0 : EFFECT_INSTANCES)};
                fixture_assert(render_picture(&film[k], fixture_context(), fixture_device(), scenes[k], k ? &pair.flat_bvh : &pair.bvh, &params));
            }
            uint32_t differ = 0, seen = 0;
            for (uint32_t at = 0; at < 64 * 64; at++) {
                seen += film[0].id.pixels[2 * at] >= 0;
                // What the first stage leaves open may be another ray, and the hit's numbers then better in one of the pictures.
                const double depth = film[0].depth.pixels[at], other = film[1].depth.pixels[at];
                bool same = memcmp(&film[0].id.pixels[2 * at], &film[1].id.pixels[2 * at], 2 * sizeof(float)) == 0 &&
                            (depth == other || fabs(depth - other) <= 1e-5 * depth);
                for (uint32_t c = 0; c < 3; c++) same = same && fabs(film[0].color.pixels[3 * at + c] - film[1].color.pixels[3 * at + c]) <= 1e-5;
                differ += !same;
            }
            print_message("%-36s tier %u: %u of 4096 pixels see something, %u differ\n", settings[chosen[i]].name, tier, seen, differ);
            assert_true(seen > 200);
            assert_int_equal(differ, 0);
            render_film_finish(&film[0]);
            render_film_finish(&film[1]);
        }
        pair_finish(&pair);
    }
}

// Vertex normals against the inverse transpose in fp64, by pictures of the normals: the smooth normal of an instance is that of the flattened mesh (X03, X04).
static void normals_are_transformed(void **state) {
    (void)state;
    static const double axes[][3] = {{1, 1, 1}, {1, 1e-2, 1}, {-1, 1, 2}, {1, 1e-4, 1}};
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++) {
        uint64_t random = 21 + i;
        struct scene twice = empty_scene(), once[2];
        float placement[2][12];
        twice.prototypes[twice.prototype_count++] = ball_make(5, 8);
        for (int k = 0; k < 2; k++) {
            const double place[3] = {k ? 1.2 : -1.2, 0, 0};
            placement_make(placement[k], &random, axes[i], 0.2, 1, place);
            add_instance(&twice, 0, placement[k]);
        }
        finish_making(&twice);
        struct scene flat = empty_scene();
        for (int k = 0; k < 2; k++) { // drawn once each: flattened when derived
            flat.prototypes[flat.prototype_count++] = ball_make(5, 8);
            add_instance(&flat, (uint32_t)k, placement[k]);
        }
        finish_making(&flat);
        assert_int_equal(twice.instance_count, 2);
        assert_int_equal(flat.instance_count, 0);
        once[0] = twice, once[1] = flat;
        struct render_film film[2];
        for (int k = 0; k < 2; k++) {
            struct bvh bvh;
            struct plan plan;
            fixture_assert(bvh_build_scene(&bvh, fixture_context(), &once[k]));
            fixture_assert(plan_make(&plan, fixture_context(), &once[k], &(struct plan_params){.spp = 1}));
            assert_int_equal((plan.effects & EFFECT_INSTANCES) != 0, k == 0);
            const struct render_params params = {.width = 64, .height = 64, .spp = 1, .tier = TIER_ROBUST, .aovs = GN_AOV_NORMAL | GN_AOV_ID, .effects = plan.effects};
            fixture_assert(render_picture(&film[k], fixture_context(), fixture_device(), &once[k], &bvh, &params));
            bvh_finish(&bvh);
        }
        double worst = 0;
        uint32_t seen = 0;
        for (uint32_t at = 0; at < 64 * 64; at++) {
            assert_memory_equal(&film[0].id.pixels[2 * at], &film[1].id.pixels[2 * at], 2 * sizeof(float));
            seen += film[0].id.pixels[2 * at] >= 0;
            for (int k = 0; k < 3; k++) worst = fmax(worst, fabs((double)film[0].normal.pixels[3 * at + k] - film[1].normal.pixels[3 * at + k]));
        }
        print_message("axes %g %g %g: %u pixels, normals differ by %.2g at most\n", axes[i][0], axes[i][1], axes[i][2], seen, worst);
        assert_true(seen > 50);
        assert_true(worst <= 1e-6);
        for (int k = 0; k < 2; k++) {
            render_film_finish(&film[k]);
            scene_finish(&once[k]);
        }
    }
}

// What the plan says: an instance drawn once is a mesh; one drawn twice, or that moves, calls for the effect.
static void plan_knows_them(void **state) {
    (void)state;
    static const struct {
        uint32_t instances;
        bool moves;
        uint32_t effects;
    } cases[] = {{1, false, 0}, {2, false, EFFECT_INSTANCES}, {1, true, EFFECT_INSTANCES | EFFECT_MOTION_BLUR}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint64_t random = 31;
        struct scene scene = empty_scene();
        struct plan plan;
        float placement[12];
        scene.prototypes[scene.prototype_count++] = ball_make(3, 1);
        for (uint32_t k = 0; k < cases[i].instances; k++) {
            placement_make(placement, &random, (const double[3]){1, 2, 3}, 0, 1, (const double[3]){k, 0, 0});
            struct scene_shape *shape = add_instance(&scene, 0, placement);
            shape->moves = cases[i].moves;
            shape->motion[1] = 0.5f;
        }
        finish_making(&scene);
        fixture_assert(plan_make(&plan, fixture_context(), &scene, &(struct plan_params){.spp = 1}));
        assert_int_equal(plan.effects & (EFFECT_INSTANCES | EFFECT_MOTION_BLUR), cases[i].effects);
        assert_true(plan.effects & EFFECT_TRIANGLES && plan.effects & EFFECT_BVH);
        assert_int_equal(scene_triangle_count(&scene), cases[i].effects ? 0 : 36);
        assert_int_equal(scene_instanced_count(&scene), cases[i].effects ? 36 * cases[i].instances : 0);
        scene_finish(&scene);
    }
}

static void out_of_range_is_an_error(void **state) {
    (void)state;
    for (int moves = 0; moves < 2; moves++) {
        struct scene scene = empty_scene();
        const float placement[12] = {moves ? 1 : 3e38f, 0, 0, moves ? 3e38f : 3e38f, 0, 1, 0, 0, 0, 0, 1, 0};
        scene.path = strdup("far.json");
        scene.prototypes[scene.prototype_count++] = ball_make(3, 1);
        for (int k = 0; k < 2; k++) {
            struct scene_shape *shape = add_instance(&scene, 0, placement);
            shape->moves = moves;
            shape->motion[0] = 3e38f;
        }
        assert_false(scene_derive(&scene, fixture_context()));
        assert_int_equal(fixture_state()->error.status, GN_SCENE);
        scene_finish(&scene);
    }
}

// A leaf for each of the last primitives, within the depth that stacks have, however they lie.
static void singles_have_leaves_of_their_own(void **state) {
    (void)state;
    enum { COUNT = 3000 };
    static struct bvh_box boxes[COUNT];
    for (int kind = 0; kind < 3; kind++) {
        uint64_t random = 41;
        for (uint32_t i = 0; i < COUNT; i++)
            for (int k = 0; k < 3; k++) {
                const float at = kind == 0 ? 1 : kind == 1 ? (float)oracle_uniform(&random) : ldexpf(1, (int)(i % 200) - 100);
                boxes[i].min[k] = at;
                boxes[i].max[k] = kind == 1 ? at + 0.01f : at;
            }
        const struct bvh_params params = {.split_at = 1000, .singles = 1500};
        struct bvh bvh;
        char why[200] = "";
        fixture_assert(bvh_build(&bvh, fixture_context(), boxes, COUNT, &params));
        if (!bvh_check(&bvh, boxes, &params, why, sizeof why)) fail_msg("%s", why);
        const struct bvh_params stricter = {.split_at = 1000, .singles = COUNT};
        if (kind == 0) assert_false(bvh_check(&bvh, boxes, &stricter, why, sizeof why)); // the control
        bvh_finish(&bvh);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_and_kinds),
        cmocka_unit_test(reference_hits_the_same),
        cmocka_unit_test(every_tier_hits_the_same),
        cmocka_unit_test(motion_is_the_scene_at_that_time),
        cmocka_unit_test(pictures_are_the_same),
        cmocka_unit_test(normals_are_transformed),
        cmocka_unit_test(plan_knows_them),
        cmocka_unit_test(out_of_range_is_an_error),
        cmocka_unit_test(singles_have_leaves_of_their_own),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests_name("instances", tests, NULL, fixture_close);
}
