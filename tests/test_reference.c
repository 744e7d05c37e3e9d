// The reference as a whole: closest and any hits through hierarchies against the oracle over every primitive, and small pictures against
// formulas.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "bvh/scene_boxes.h"
#include "oracle.h"
#include "reference/predicates.h"
#include "reference/reference.h"
#include "scene/build.h"
#include "shaders/shared.h"

#include <cmocka.h>

#define MOST_SHAPES 16
#define EVERYTHING ((1u << EFFECT_COUNT) - 1)

// A scene on the test's own memory, and two hierarchies of it.
struct world {
    struct scene scene;
    struct scene_shape shapes[MOST_SHAPES];
    struct scene_material material;
    struct scene_light lights[2];
    struct bvh bvh, odd_bvh;
    struct gn_error error;
    struct context ctx;
};

static float random_whole(uint64_t *state, int lo, int hi) { return (float)(lo + (int)(oracle_random(state) % (uint32_t)(hi - lo + 1))); }

// ---------------------------------------------------------------------------------------------------------- making scenes

static void world_init(struct world *w) {
    memset(w, 0, sizeof *w);
    w->ctx = context_make(NULL, &w->error);
    w->scene.shapes = w->shapes;
    w->scene.materials = &w->material;
    w->scene.material_count = 1;
    w->scene.lights = w->lights;
    w->scene.shadows = true;
    w->scene.camera = (struct scene_camera){.look_at = {0, 0, -1}, .up = {0, 1, 0}, .fov_y_deg = 90};
    w->scene.film.filter_radius = 0.5f;
    w->material = (struct scene_material){.ambient = {1, 0, 0}, .diffuse = {1, 0, 0}, .specular = {1, 1, 1}, .shininess = 32};
    for (int i = 0; i < 3; i++) w->scene.ambient[i] = 0.2f;
}

static void add_light(struct world *w, float x, float y, float z, float intensity, enum light_falloff falloff) {
    w->lights[w->scene.light_count++] =
        (struct scene_light){.position = {x, y, z}, .intensity = {intensity, intensity, intensity}, .falloff = falloff};
}

static void add_sphere(struct world *w, float x, float y, float z, float radius) {
    w->shapes[w->scene.shape_count++] = (struct scene_shape){.type = SHAPE_SPHERE, .center = {x, y, z}, .radius = radius};
}

// A mesh with room for so many triangles, none of which share vertices.
static struct scene_mesh *add_mesh(struct world *w, uint32_t capacity) {
    struct scene_shape *shape = &w->shapes[w->scene.shape_count++];
    *shape = (struct scene_shape){.type = SHAPE_MESH};
    shape->mesh.positions = calloc(9 * (size_t)capacity, sizeof(float));
    shape->mesh.indices = calloc(3 * (size_t)capacity, sizeof(uint32_t));
    assert_true(shape->mesh.positions && shape->mesh.indices);
    return &shape->mesh;
}

static void add_triangle(struct scene_mesh *mesh, const float a[3], const float b[3], const float c[3]) {
    float *to = mesh->positions + 9 * (size_t)mesh->triangle_count;
    memcpy(to, a, 3 * sizeof *to), memcpy(to + 3, b, 3 * sizeof *to), memcpy(to + 6, c, 3 * sizeof *to);
    for (uint32_t i = 0; i < 3; i++, mesh->vertex_count++) mesh->indices[mesh->vertex_count] = mesh->vertex_count;
    mesh->triangle_count++;
}

// Point (i, j, k) of a cube's surface, 0 to n each: as it is; or on a bumpy sphere of radius about 4 around the origin.
static void cube_point(float out[3], const int at[3], int n, bool bumpy) {
    uint64_t state = 1 + (uint64_t)(at[0] + 64 * at[1] + 4096 * at[2]);
    oracle_random(&state);
    double p[3], length = 0, radius = 3.5 + oracle_uniform(&state);
    for (int i = 0; i < 3; i++) p[i] = 2.0 * at[i] / n - 1, length += p[i] * p[i];
    for (int i = 0; i < 3; i++) out[i] = bumpy ? (float)(radius * p[i] / sqrt(length)) : (float)at[i];
}

// The closed surface of a cube of n³ cells: 12 n² triangles.
static void add_cube(struct world *w, int n, bool bumpy) {
    struct scene_mesh *mesh = add_mesh(w, 12 * (uint32_t)(n * n));
    for (int cell = 0; cell < 6 * n * n; cell++) {
        int axis = cell / (2 * n * n), a = cell / 2 % n, b = cell / 2 / n % n;
        float corner[4][3];
        for (int k = 0; k < 4; k++) {
            int at[3];
            at[axis] = cell % 2 ? n : 0;
            at[(axis + 1) % 3] = a + k % 2;
            at[(axis + 2) % 3] = b + k / 2;
            cube_point(corner[k], at, n, bumpy);
        }
        add_triangle(mesh, corner[0], corner[1], corner[3]);
        add_triangle(mesh, corner[0], corner[3], corner[2]);
    }
}

// A hierarchy as odd as the contract allows: primitives in random order, halves at random, leaves of any size. Returns the number of its
// root.
static void odd_split(struct bvh *bvh, const struct bvh_box *boxes, uint32_t node, uint32_t first, uint32_t count, uint64_t *state) {
    struct bvh_node *n = &bvh->nodes[node];
    *n = (struct bvh_node){.min = {INFINITY, INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = first; i < first + count; i++) {
        for (int k = 0; k < 3; k++) {
            n->min[k] = fminf(n->min[k], boxes[bvh->order[i]].min[k]);
            n->max[k] = fmaxf(n->max[k], boxes[bvh->order[i]].max[k]);
        }
    }
    n->first = first, n->count = count;
    if (count == 1 || (count <= BVH_MAX_LEAF && oracle_random(state) % 2)) return;
    n->first = bvh->node_count, n->count = 0;
    bvh->node_count += 2;
    uint32_t left = count / 4 + oracle_random(state) % (count / 2) + (count < 4), children = n->first;
    odd_split(bvh, boxes, children, first, left, state);
    odd_split(bvh, boxes, children + 1, first + left, count - left, state);
}

static void odd_build(struct bvh *bvh, const struct scene *scene) {
    uint32_t triangles = scene_triangle_count(scene), count = triangles + scene_sphere_count(scene);
    struct bvh_box *boxes = calloc(count, sizeof *boxes);
    *bvh =
        (struct bvh){.nodes = calloc(2 * (size_t)count, sizeof *bvh->nodes), .order = calloc(count, sizeof *bvh->order), .node_count = 1};
    assert_true(boxes && bvh->nodes && bvh->order);
    uint64_t state = 77;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            if (i < triangles) {
                struct scene_triangle t = scene_triangle_at(scene, i);
                boxes[i].min[k] = fminf(t.v[0][k], fminf(t.v[1][k], t.v[2][k]));
                boxes[i].max[k] = fmaxf(t.v[0][k], fmaxf(t.v[1][k], t.v[2][k]));
            } else {
                const struct scene_shape *s = &scene->shapes[scene_sphere_object(scene, i - triangles)];
                boxes[i].min[k] = nextafterf(s->center[k] - s->radius, -INFINITY);
                boxes[i].max[k] = nextafterf(s->center[k] + s->radius, INFINITY);
            }
        }
        uint32_t other = oracle_random(&state) % (i + 1);
        bvh->order[i] = bvh->order[other];
        bvh->order[other] = i;
    }
    if (count > 0)
        odd_split(bvh, boxes, 0, 0, count, &state);
    else
        bvh->node_count = 0;
    free(boxes);
}

static void world_build(struct world *w) {
    assert_true(scene_derive(&w->scene, &w->ctx));
    assert_true(bvh_build_scene(&w->bvh, &w->ctx, &w->scene));
    odd_build(&w->odd_bvh, &w->scene);
}

static void world_finish(struct world *w) {
    for (uint32_t i = 0; i < w->scene.shape_count; i++) {
        free(w->shapes[i].mesh.positions);
        free(w->shapes[i].mesh.normals);
        free(w->shapes[i].mesh.indices);
    }
    free(w->scene.first_triangle);
    free(w->scene.first_sphere);
    free(w->odd_bvh.nodes);
    free(w->odd_bvh.order);
    bvh_finish(&w->bvh);
}

// ------------------------------------------------------------------------------------------------------------------- trace

// The oracle's answer over all primitives, one after the other.
static struct gn_hit brute_force(const struct scene *scene, const struct gn_ray *from) {
    struct gn_hit best = {.t = INFINITY, .object = -1, .primitive = -1};
    struct ref_ray valid;
    if (!ref_ray_make(&valid, from)) return best;
    struct oracle_ray ray = {.tmin = valid.tmin, .tmax = valid.tmax};
    memcpy(ray.o, valid.o, sizeof ray.o), memcpy(ray.d, valid.d, sizeof ray.d);
    struct oracle_hit hits[2];
    oracle_hit_init(&hits[0]), oracle_hit_init(&hits[1]);
    int kept = 0; // which of the two is the best
    uint32_t triangles = scene_triangle_count(scene), count = triangles + scene_sphere_count(scene);
    for (uint32_t i = 0; i < count; i++) {
        struct scene_triangle t = {.primitive = 0};
        struct oracle_hit *hit = &hits[1 - kept];
        if (i < triangles) {
            t = scene_triangle_at(scene, i);
            oracle_triangle(hit, &ray, (const float *const[3]){t.v[0], t.v[1], t.v[2]});
        } else {
            t.object = scene_sphere_object(scene, i - triangles);
            oracle_sphere(hit, &ray, scene->shapes[t.object].center, scene->shapes[t.object].radius);
            mpfr_set_zero(hit->u.value, 1), mpfr_set_zero(hit->v.value, 1);
        }
        if (!hit->hit) continue;
        int order = best.object < 0 ? -1 : oracle_compare(&hit->t, &hits[kept].t);
        bool lower = (int32_t)t.object < best.object || ((int32_t)t.object == best.object && (int32_t)t.primitive < best.primitive);
        if (order > 0 || (order == 0 && !lower)) continue;
        best = (struct gn_hit){.object = (int32_t)t.object, .primitive = (int32_t)t.primitive};
        best.t = oracle_round(&hit->t), best.u = oracle_round(&hit->u), best.v = oracle_round(&hit->v);
        kept = 1 - kept;
    }
    oracle_hit_clear(&hits[0]), oracle_hit_clear(&hits[1]);
    return best;
}

static bool same_hit(const struct gn_hit *a, const struct gn_hit *b) {
    return a->t == b->t && a->u == b->u && a->v == b->v && a->object == b->object && a->primitive == b->primitive;
}

struct counts {
    unsigned hits, undecided, wrong;
};

// Shoots through both hierarchies, closest and any; returns how often something is not as the oracle says.
static struct counts check_rays(struct world *w, const struct gn_ray *rays, size_t count) {
    struct counts counts = {0};
    struct gn_hit *hits = calloc(4 * count, sizeof *hits);
    assert_non_null(hits);
    for (int k = 0; k < 4; k++) {
        const struct bvh *bvh = k % 2 ? &w->odd_bvh : &w->bvh;
        assert_true(reference_trace(hits + (size_t)k * count, &w->ctx, &w->scene, bvh, rays, count, k >= 2));
    }
    for (size_t i = 0; i < count; i++) {
        struct gn_hit right = brute_force(&w->scene, &rays[i]);
        counts.hits += right.object >= 0;
        counts.undecided += (hits[i].flags & GN_HIT_UNDECIDED) != 0;
        bool good = same_hit(&hits[i], &right) && same_hit(&hits[count + i], &right);
        for (size_t k = 2; k < 4; k++) good = good && hits[k * count + i].object == (right.object >= 0 ? 0 : -1);
        if (!good && counts.wrong++ < 3) {
            print_message("o %a %a %a d %a %a %a: object %d primitive %d t %a, expected %d %d %a\n", (double)rays[i].origin[0],
                          (double)rays[i].origin[1], (double)rays[i].origin[2], (double)rays[i].direction[0], (double)rays[i].direction[1],
                          (double)rays[i].direction[2], hits[i].object, hits[i].primitive, (double)hits[i].t, right.object, right.primitive,
                          (double)right.t);
        }
    }
    free(hits);
    return counts;
}

// Lattice points shoot at lattice points: through vertices, along edges, in planes, tangent to spheres; primitives coincide and touch.
static void trace_lattice(void **unused) {
    (void)unused;
    enum { RAYS = 1500 };
    static struct gn_ray rays[RAYS];
    struct world w;
    world_init(&w);
    add_sphere(&w, 2, 2, 5, 2); // rests in the cube's top
    add_cube(&w, 3, false);
    add_sphere(&w, 1, 1, 1, 1); // touches three of its sides from inside
    add_cube(&w, 3, false);     // every hit is a tie with object 1
    add_sphere(&w, 1, 1, 1, 1);
    add_sphere(&w, 5, 1, 1, 2);
    world_build(&w);
    uint64_t state = 11;
    for (int i = 0; i < RAYS; i++) {
        rays[i] = (struct gn_ray){.tmin = i % 4 ? 0 : -INFINITY, .tmax = i % 8 < 7 ? INFINITY : 1};
        for (int k = 0; k < 3; k++) {
            rays[i].origin[k] = random_whole(&state, -2, 5) * (i % 3 ? 1 : 0.5f);
            rays[i].direction[k] = random_whole(&state, 0, 3) - rays[i].origin[k];
            if (i % 5 == 0 && oracle_random(&state) % 2) rays[i].direction[k] = 0;
        }
        if (i % 16 == 1) rays[i].direction[i % 3] = 0x1p-140f;
        if (i % 16 == 3) rays[i].origin[i % 3] = nextafterf(rays[i].origin[i % 3], 9);
    }
    struct counts counts = check_rays(&w, rays, RAYS);
    print_message("%d rays, %u hits, %u undecided in fp64, %u wrong\n", RAYS, counts.hits, counts.undecided, counts.wrong);
    assert_true(counts.hits > 500 && counts.undecided > 500);
    assert_int_equal(counts.wrong, 0);
    world_finish(&w);
}

// T02, T03: a bumpy closed surface from inside and outside, aimed at its vertices and edges.
static void trace_bumpy(void **unused) {
    (void)unused;
    enum { RAYS = 300 };
    static struct gn_ray rays[RAYS];
    struct world w;
    world_init(&w);
    add_cube(&w, 5, true);
    add_sphere(&w, 0, 0, 0, 3.6f);
    world_build(&w);
    uint64_t state = 12;
    for (int i = 0; i < RAYS; i++) {
        const float *v = w.shapes[0].mesh.positions + 9 * (size_t)(oracle_random(&state) % w.shapes[0].mesh.triangle_count);
        double s = i % 2 ? oracle_uniform(&state) : 0;
        rays[i].tmin = 0, rays[i].tmax = INFINITY;
        for (int k = 0; k < 3; k++) {
            rays[i].origin[k] = (float)((oracle_uniform(&state) - 0.5) * (i % 3 ? 1 : 30));
            rays[i].direction[k] = (float)(v[k] + s * ((double)v[3 + k] - v[k])) - rays[i].origin[k];
        }
        if (i % 7 == 0) rays[i].direction[i % 3] = 0;
    }
    struct counts counts = check_rays(&w, rays, RAYS);
    assert_true(counts.hits > 200);
    assert_int_equal(counts.wrong, 0);
    world_finish(&w);
}

// A line meets a closed surface an even number of times, a half-line from inside an odd number of times; whatever it is aimed at.
static void closed_surface_parity(void **unused) {
    (void)unused;
    unsigned odd_controls = 0;
    for (int bumpy = 0; bumpy < 2; bumpy++) {
        struct world w;
        world_init(&w);
        add_cube(&w, 4, bumpy);
        world_build(&w);
        uint64_t state = 13;
        const struct scene_mesh *mesh = &w.shapes[0].mesh;
        for (int i = 0; i < 2000; i++) {
            const float *v = mesh->positions + 3 * (size_t)(oracle_random(&state) % mesh->vertex_count);
            struct gn_ray line = {.tmin = i % 2 ? 0 : -INFINITY, .tmax = INFINITY};
            for (int k = 0; k < 3; k++) {
                line.origin[k] = bumpy ? random_whole(&state, -4, 4) * 0.5f : random_whole(&state, 2, 6) * 0.5f; // inside
                line.direction[k] = v[k] - line.origin[k];
            }
            struct ref_ray ray;
            struct crossing crossing;
            assert_true(ref_ray_make(&ray, &line));
            int crossings = 0, inclusive = 0;
            for (uint32_t t = 0; t < mesh->triangle_count; t++) {
                const float *p = mesh->positions + 9 * (size_t)t;
                bool hit = triangle_cross(&crossing, &ray, (const float *const[3]){p, p + 3, p + 6});
                crossings += hit;
                inclusive += hit || memcmp(p, v, 3 * sizeof *p) == 0;
            }
            assert_int_equal(crossings % 2, i % 2);
            odd_controls += inclusive % 2 != i % 2;
        }
        world_finish(&w);
    }
    assert_true(odd_controls > 100); // counting every triangle at the vertex would not do
}

// T11, T26, T29, and intervals.
static void trace_odd_rays(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    static const float a[3] = {-1, -1, -2}, b[3] = {1, -1, -2}, c[3] = {0, 1, -2};
    for (int i = 0; i < 3; i++) { // twins: lower object, then lower primitive
        struct scene_mesh *mesh = add_mesh(&w, 3);
        if (i == 0) add_triangle(mesh, a, b, b), add_triangle(mesh, a, a, a);
        if (i > 0) add_triangle(mesh, a, c, c), add_triangle(mesh, a, b, c), add_triangle(mesh, a, b, c);
    }
    world_build(&w);
    struct gn_ray rays[40];
    int count = 0;
    const struct gn_ray good = {{0, 0, 0}, 0, {0, 0, -1}, INFINITY};
    rays[count++] = good;
    rays[count] = good, rays[count++].tmin = -INFINITY;
    int valid_hits = count;
    rays[count] = good, rays[count++].tmin = 2;
    rays[count] = good, rays[count++].tmax = 2;
    rays[count] = good, rays[count].tmin = 3, rays[count++].tmax = 1;
    rays[count] = good, rays[count].tmin = INFINITY, rays[count++].tmax = INFINITY;
    rays[count] = good, rays[count].tmin = -INFINITY, rays[count++].tmax = -INFINITY;
    int misses = count;
    static const float bad[3] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 9; k++) {
        rays[count] = good, rays[count++].origin[k / 3] = bad[k % 3];
        rays[count] = good, rays[count++].direction[k / 3] = bad[k % 3];
    }
    rays[count] = good, rays[count++].tmin = NAN;
    rays[count] = good, rays[count++].tmax = NAN;
    rays[count] = good, rays[count++].direction[2] = -0.0f;
    struct gn_hit hits[40], any[40];
    assert_true(reference_trace(hits, &w.ctx, &w.scene, &w.bvh, rays, (size_t)count, false));
    assert_true(reference_trace(any, &w.ctx, &w.scene, &w.bvh, rays, (size_t)count, true));
    for (int i = 0; i < count; i++) {
        bool hit = i < valid_hits;
        assert_int_equal(hits[i].object, hit ? 1 : -1);
        assert_int_equal(hits[i].primitive, hit ? 1 : -1);
        assert_true(hits[i].t == (hit ? 2.0f : INFINITY));
        assert_int_equal(hits[i].flags & GN_HIT_INVALID, i >= misses ? GN_HIT_INVALID : 0);
        assert_int_equal(any[i].object, hit ? 0 : -1);
        assert_int_equal(any[i].flags & GN_HIT_INVALID, i >= misses ? GN_HIT_INVALID : 0);
    }
    world_finish(&w);
}

// Without shapes everything is a miss; no rays are no fault.
static void trace_nothing(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    struct gn_ray ray = {{0, 0, 0}, 0, {0, 0, -1}, INFINITY};
    struct gn_hit hit;
    assert_true(scene_derive(&w.scene, &w.ctx));
    assert_true(reference_trace(&hit, &w.ctx, &w.scene, &w.bvh, &ray, 1, false));
    assert_int_equal(hit.object, -1);
    assert_true(reference_trace(&hit, &w.ctx, &w.scene, &w.bvh, &ray, 0, false));
    world_finish(&w);
}

// ---------------------------------------------------------------------------------------------------------------- pictures

static struct reference_film render(struct world *w, uint32_t size, uint32_t spp, uint32_t effects) {
    struct reference_film film;
    const struct reference_params params = {
        .width = size, .height = size, .spp = spp, .effects = effects, .aovs = GN_AOV_DEPTH | GN_AOV_NORMAL | GN_AOV_ID};
    if (!reference_render(&film, &w->ctx, &w->scene, &w->bvh, &params)) fail_msg("%s", w->error.message);
    return film;
}

typedef long double real;

static real dot(const real a[3], const real b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static void unit(real a[3]) {
    real length = sqrtl(dot(a, a));
    for (int i = 0; i < 3; i++) a[i] /= length;
}

// What the formulas know of a scene: a sphere and a horizontal floor, either of them absent with a NaN.
struct formula {
    real center[3], radius, floor_y, light[3], intensity;
    bool inverse_square;
};

// The nearest t in (0, limit) along d from o, or NaN; *kind 0 sphere, 1 floor. `skip` leaves out one kind.
static real formula_hit(const struct formula *f, const real o[3], const real d[3], int skip, int *kind) {
    real best = INFINITY, l[3] = {o[0] - f->center[0], o[1] - f->center[1], o[2] - f->center[2]};
    real a = dot(d, d), b = dot(l, d), root = sqrtl(b * b - a * (dot(l, l) - f->radius * f->radius));
    for (int sign = -1; sign <= 1; sign += 2) {
        real t = (-b + sign * root) / a;
        if (skip != 0 && t > 0 && t < best) best = t, *kind = 0;
    }
    real t = (f->floor_y - o[1]) / d[1];
    if (skip != 1 && t > 0 && t < best) best = t, *kind = 1;
    return best;
}

static void formula_pixel(real color[3], const struct world *w, const struct formula *f, uint32_t x, uint32_t y, uint32_t size) {
    real o[3] = {0}, d[3] = {2 * (x + 0.5L) / size - 1, 1 - 2 * (y + 0.5L) / size, -1}, p[3], n[3], l[3], v[3], r[3];
    int kind = 0, ignored;
    for (int i = 0; i < 3; i++) color[i] = 0;
    real t = formula_hit(f, o, d, -1, &kind);
    if (isinf(t)) return;
    for (int i = 0; i < 3; i++) {
        p[i] = t * d[i];
        n[i] = kind == 0 ? p[i] - f->center[i] : i == 1;
        l[i] = f->light[i] - p[i];
        v[i] = -d[i];
        color[i] = (real)w->scene.ambient[i] * w->material.ambient[i];
    }
    bool shadowed = formula_hit(f, p, l, kind, &ignored) < 1;
    real falloff = f->inverse_square ? dot(l, l) : 1;
    unit(n), unit(l), unit(v);
    real side = dot(n, v) < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) n[i] *= side;
    real cosine = dot(n, l);
    for (int i = 0; i < 3; i++) r[i] = 2 * cosine * n[i] - l[i];
    real glare = powl(fmaxl(0, dot(r, v)), w->material.shininess);
    for (int i = 0; i < 3 && cosine > 0 && !shadowed; i++) {
        color[i] += f->intensity / falloff * (w->material.diffuse[i] * cosine + w->material.specular[i] * glare);
    }
}

// The number of pixels that are off by more than 1e-6.
static unsigned differing(struct world *w, const struct formula *f, uint32_t size) {
    struct reference_film film = render(w, size, 1, EVERYTHING);
    unsigned count = 0;
    for (uint32_t i = 0; i < size * size; i++) {
        real right[3];
        formula_pixel(right, w, f, i % size, i / size, size);
        bool good = true;
        for (int k = 0; k < 3; k++) good = good && fabsl(film.color.pixels[3 * i + (uint32_t)k] - right[k]) <= 1e-6L;
        count += !good;
    }
    reference_film_finish(&film);
    return count;
}

// The seed's figures 1 and 3.
static void picture_of_sphere(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    add_sphere(&w, 0, 0, -3, 1);
    add_light(&w, -10, 10, 4, 0.8f, FALLOFF_NONE);
    world_build(&w);
    struct formula f = {{0, 0, -3}, 1, NAN, {-10, 10, 4}, 0.8f, false};
    assert_int_equal(differing(&w, &f, 128), 0);
    memset(w.material.specular, 0, sizeof w.material.specular);
    assert_int_equal(differing(&w, &f, 128), 0);
    f.center[0] = 1e-4L;
    assert_true(differing(&w, &f, 128) > 1000);
    world_finish(&w);
}

// A slanted quad as two triangles, along one diagonal or the other.
static void add_quad(struct world *w, float size, float y, bool other) {
    const float p[4][3] = {{-size, y, -size}, {size, y, -size}, {size, y, size}, {-size, y, size}};
    struct scene_mesh *mesh = add_mesh(w, 2);
    add_triangle(mesh, p[other], p[1 + other], p[2 + other]);
    add_triangle(mesh, p[2 + other], p[(3 + other) % 4], p[other]);
}

// A sphere over a floor: shadows, inverse squares; the floor twice, differently cut: nothing shadows itself.
static void picture_with_shadow(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    add_sphere(&w, 0.3f, -0.2f, -3, 0.7f);
    add_quad(&w, 1000, -1.1f, false);
    add_quad(&w, 1000, -1.1f, true);
    add_light(&w, -3, 4, -1, 9, FALLOFF_INVERSE_SQUARE);
    world_build(&w);
    struct formula f = {{0.3f, -0.2f, -3}, 0.7f, -1.1f, {-3, 4, -1}, 9, true};
    // The quad reaches beyond the last row of pixels below the horizon.
    unsigned count = differing(&w, &f, 128);
    assert_int_equal(count, 0);
    f.light[0] = -2.999L;
    assert_true(differing(&w, &f, 128) > 1000);
    world_finish(&w);
}

// Inside a hollow sphere a light inside shines everywhere, one outside nowhere.
static void picture_inside_sphere(void **unused) {
    (void)unused;
    for (int outside = 0; outside < 2; outside++) {
        struct world w;
        world_init(&w);
        add_sphere(&w, 0.1f, 0.2f, 0.3f, 3);
        add_light(&w, outside ? 20 : 0, 1, 0, 1, FALLOFF_NONE);
        world_build(&w);
        struct reference_film film = render(&w, 48, 1, EVERYTHING);
        unsigned lit = 0;
        for (size_t i = 0; i < 48 * 48; i++) lit += film.color.pixels[3 * i] > 0.2f;
        assert_int_equal(lit, outside ? 0 : 48 * 48);
        reference_film_finish(&film);
        w.scene.light_count = 1;
        film = render(&w, 48, 1, EVERYTHING & ~(unsigned)EFFECT_SHADOWS);
        for (size_t i = 0; i < 48 * 48; i++) lit += film.color.pixels[3 * i] > 0.2f;
        assert_true(lit > 500);
        reference_film_finish(&film);
        world_finish(&w);
    }
}

// Thin, slanted, far from the origin, twice: P is not exactly in the plane, and yet no point shadows itself.
static void no_acne(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    static const float p[4][3] = {
        {-700.1f, -300.7f, -900.3f}, {800.3f, -200.9f, -1100.1f}, {700.7f, 600.3f, -1500.9f}, {-1000.3f, 500.1f, -800.7f}};
    for (int i = 0; i < 2; i++) {
        struct scene_mesh *mesh = add_mesh(&w, 2);
        add_triangle(mesh, p[0], p[1], p[2]);
        add_triangle(mesh, p[2], p[3], p[0]);
    }
    add_light(&w, 10, 400, 0, 1, FALLOFF_NONE);
    world_build(&w);
    struct reference_film film = render(&w, 96, 1, EVERYTHING), bare = render(&w, 96, 1, EVERYTHING & ~(unsigned)EFFECT_SHADOWS);
    assert_memory_equal(film.color.pixels, bare.color.pixels, 96 * 96 * 3 * sizeof(float));
    assert_true(film.rays > bare.rays + 1000);
    reference_film_finish(&film), reference_film_finish(&bare);
    world_finish(&w);
}

// One pixel, seen along -z: layers, effects, falloff at distance 0, samples that fp32 cannot hold, normals without length.
static void one_pixel(void **unused) {
    (void)unused;
    static const float corners[3][3] = {{-9, -9, -1}, {9, -9, -1}, {0, 9, -1}};
    static const float away[9] = {0, 0, -2, 0, 0, -2, 0, 0, -2}, none[9] = {0}, bad[9] = {NAN, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float tilted[9] = {0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f};
    static const struct {
        const char *name;
        float depth; // of the triangle
        const float *normals;
        float light_z, intensity;
        uint32_t effects;
        float red, normal_y;
        uint32_t rays, nonfinite;
    } cases[] = {
        {"plain", 1, NULL, 1, 1, EVERYTHING, 0.2f + 2, 0, 2, 0},
        {"no specular", 1, NULL, 1, 1, EVERYTHING & ~(unsigned)EFFECT_SPECULAR, 0.2f + 1, 0, 2, 0},
        {"no diffuse", 1, NULL, 1, 1, EVERYTHING & ~(unsigned)EFFECT_DIFFUSE, 0.2f + 1, 0, 2, 0},
        {"no shadows", 1, NULL, 1, 1, EVERYTHING & ~(unsigned)EFFECT_SHADOWS, 0.2f + 2, 0, 1, 0},
        {"no triangles", 1, NULL, 1, 1, EVERYTHING & ~(unsigned)EFFECT_TRIANGLES, 0, 0, 1, 0},
        {"light behind", 1, NULL, -3, 1, EVERYTHING, 0.2f, 0, 1, 0},
        {"light at the point", 1, NULL, -1, 1, EVERYTHING, 0.2f, 0, 1, 0},
        {"light too near", 0x1p-67f, NULL, 0, 1, EVERYTHING, 0, 0, 2, 1},
        {"dark light", 1, NULL, 1, 0, EVERYTHING, 0.2f, 0, 1, 0},
        {"normals away", 1, away, 1, 1, EVERYTHING, 0.2f + 2, 0, 2, 0},
        {"no normals", 1, none, 1, 1, EVERYTHING, 0.2f + 2, 0, 2, 0},
        {"bad normals", 1, bad, 1, 1, EVERYTHING, 0.2f + 2, 0, 2, 0},
        {"tilted", 1, tilted, 1, 1, EVERYTHING & ~(unsigned)EFFECT_SPECULAR, 0.2f + 0.8f, 0.6f, 2, 0},
        {"tilted, flat", 1, tilted, 1, 1, EVERYTHING & ~(unsigned)(EFFECT_SPECULAR | EFFECT_SMOOTH_NORMALS), 0.2f + 1, 0, 2, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct world w;
        world_init(&w);
        struct scene_mesh *mesh = add_mesh(&w, 1);
        add_triangle(mesh, corners[0], corners[1], corners[2]);
        for (int k = 0; k < 9; k++) mesh->positions[k] *= cases[i].depth;
        if (cases[i].normals) {
            mesh->normals = calloc(9, sizeof(float));
            assert_non_null(mesh->normals);
            memcpy(mesh->normals, cases[i].normals, 9 * sizeof(float));
        }
        bool near = cases[i].depth < 1;
        add_light(&w, 0, 0, cases[i].light_z, cases[i].intensity, near ? FALLOFF_INVERSE_SQUARE : FALLOFF_NONE);
        world_build(&w);
        struct reference_film film = render(&w, 1, 1, cases[i].effects);
        bool hit = cases[i].effects & EFFECT_TRIANGLES;
        bool good = fabsf(film.color.pixels[0] - cases[i].red) <= 1e-6f && film.rays == cases[i].rays &&
                    film.nonfinite_pixels == cases[i].nonfinite;
        good =
            good && film.depth.pixels[0] == (hit ? cases[i].depth : INFINITY) && fabsf(film.normal.pixels[1] - cases[i].normal_y) <= 1e-6f;
        good = good && film.id.pixels[0] == (hit ? 0 : -1) && film.id.pixels[1] == (hit ? 0 : -1);
        if (!good)
            fail_msg("%s: red %g, depth %g, normal y %g, %u rays", cases[i].name, (double)film.color.pixels[0],
                     (double)film.depth.pixels[0], (double)film.normal.pixels[1], (unsigned)film.rays);
        reference_film_finish(&film);
        world_finish(&w);
    }
}

// The same bits whatever the threads and the hierarchy; another seed, other bits; the mean over samples at an edge lies between.
static void samples_and_threads(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    add_sphere(&w, 0.3f, -0.2f, -3, 0.7f);
    add_cube(&w, 2, true);
    add_light(&w, 0, 0, 1, 1, FALLOFF_NONE);
    world_build(&w);
    struct reference_params params = {.width = 40, .height = 30, .spp = 4, .seed = 5, .effects = EVERYTHING};
    struct reference_film films[4];
    for (unsigned i = 0; i < 4; i++) {
        w.ctx.host.threads = 1 + i;
        params.seed = i < 3 ? 5 : 6;
        assert_true(reference_render(&films[i], &w.ctx, &w.scene, i == 1 ? &w.odd_bvh : &w.bvh, &params));
        assert_null(films[i].depth.pixels);
    }
    size_t bytes = 40 * 30 * 3 * sizeof(float);
    assert_memory_equal(films[0].color.pixels, films[1].color.pixels, bytes);
    assert_memory_equal(films[0].color.pixels, films[2].color.pixels, bytes);
    assert_memory_not_equal(films[0].color.pixels, films[3].color.pixels, bytes);
    assert_true(films[0].rays == films[1].rays && films[0].rays > 40 * 30 * 4);
    for (unsigned i = 0; i < 4; i++) reference_film_finish(&films[i]);
    world_finish(&w);
}

static bool refuse(void *user, const struct gn_progress *state) {
    (void)state;
    ++*(int *)user;
    return false;
}

static void cancelled(void **unused) {
    (void)unused;
    struct world w;
    world_init(&w);
    add_cube(&w, 8, true);
    add_light(&w, 0, 0, 1, 1, FALLOFF_NONE);
    world_build(&w);
    int calls = 0;
    w.ctx.host = (struct gn_host){.user = &calls, .progress = refuse};
    struct reference_film film;
    const struct reference_params params = {.width = 4096, .height = 4096, .spp = 16, .effects = EVERYTHING};
    assert_false(reference_render(&film, &w.ctx, &w.scene, &w.bvh, &params));
    assert_int_equal(w.error.status, GN_CANCELLED);
    assert_true(calls >= 1);
    assert_null(film.color.pixels);
    world_finish(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trace_lattice),       cmocka_unit_test(trace_bumpy),           cmocka_unit_test(closed_surface_parity),
        cmocka_unit_test(trace_odd_rays),      cmocka_unit_test(trace_nothing),         cmocka_unit_test(picture_of_sphere),
        cmocka_unit_test(picture_with_shadow), cmocka_unit_test(picture_inside_sphere), cmocka_unit_test(no_acne),
        cmocka_unit_test(one_pixel),           cmocka_unit_test(samples_and_threads),   cmocka_unit_test(cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
