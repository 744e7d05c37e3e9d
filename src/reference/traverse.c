#include "reference/traverse.h"

#include "scene/instances.h"
#include "shaders/shared.h"

struct ref_world ref_world_make(const struct scene *scene, const struct bvh *bvh, uint32_t effects) {
    return (struct ref_world){.scene = scene,
                              .bvh = bvh,
                              .effects = effects,
                              .triangle_count = scene_triangle_count(scene),
                              .sphere_count = scene_sphere_count(scene)};
}

// One ray on its way through the hierarchy.
struct walk {
    const struct ref_world *world;
    struct ref_ray *ray;
    const struct crossing *from;
    bool any;          // stop at the first crossing
    double inverse[3]; // 1/d; 0 where d is
    bool found;
    struct crossing best;
    double cut; // no crossing beyond it matters
};

struct box {
    double min[3], max[3];
};

// Where the ray enters a box, or +inf if it misses it: never later than exactly.
//
// (b-o)·(1/d) has three roundings: off by less than 2^-51 of itself. The pads are 2^-50, which covers their own rounding. A component d_i =
// 0 leaves containment in the closed slab. Nothing under- or overflows but where a box is infinite.
static double box_enter(const struct walk *walk, const struct box *box) {
    double enter = -INFINITY, leave = INFINITY;
    for (int i = 0; i < 3; i++) {
        double o = walk->ray->o[i], inverse = walk->inverse[i];
        if (inverse == 0) {
            if (o < box->min[i] || o > box->max[i]) return INFINITY;
            continue;
        }
        double a = (box->min[i] - o) * inverse, b = (box->max[i] - o) * inverse;
        double near = inverse > 0 ? a : b, far = inverse > 0 ? b : a;
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    enter -= fabs(enter) * 0x1p-50;
    leave += fabs(leave) * 0x1p-50;
    return enter <= leave && leave >= walk->ray->tmin && enter <= walk->cut ? enter : INFINITY;
}

// The box of what is in a node, in the scene's coordinates.
//
// In exact arithmetic an instance puts the box's middle c and half extents e at M·c + m3 and |M|·e. The vertices themselves are rounded: three products and two
// sums, then the sum with m3, product and sum of the motion, each by 2^-24 of something that is at most |M||v| + |m3| + |τ·motion|, six in all; the pad is
// 2^-21, and 2^-140 for underflow.
static struct box box_of(const struct walk *walk, const struct bvh_node *node, const struct scene_shape *placed) {
    struct box box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = node->min[i];
        box.max[i] = node->max[i];
    }
    if (!placed) return box;
    struct box out;
    for (int i = 0; i < 3; i++) {
        double moved = placed->moves ? (double)walk->ray->time * placed->motion[i] : 0, middle = moved, half = 0, size = fabs(moved);
        for (int k = 0; k < 3; k++) {
            double m = placed->type == SHAPE_INSTANCE ? placed->placement[4 * i + k] : i == k;
            middle += m * (0.5 * (box.min[k] + box.max[k]));
            half += fabs(m) * (0.5 * (box.max[k] - box.min[k]));
            size += fabs(m) * fmax(fabs(box.min[k]), fabs(box.max[k]));
        }
        double m3 = placed->type == SHAPE_INSTANCE ? placed->placement[4 * i + 3] : 0, pad = half + (size + fabs(m3)) * 0x1p-21 + 0x1p-140;
        out.min[i] = middle + m3 - pad;
        out.max[i] = middle + m3 + pad;
    }
    return out;
}

static bool same_sphere(const struct crossing *from, const float center[3], float radius) {
    if (!from || from->kind != CROSSING_SPHERE || from->radius != radius) return false;
    return from->center[0] == center[0] && from->center[1] == center[1] && from->center[2] == center[2];
}

static bool cross_sphere(struct crossing *out, const struct walk *walk, uint32_t number) {
    uint32_t object = scene_sphere_object(walk->world->scene, number - walk->world->triangle_count);
    const struct scene_shape *shape = &walk->world->scene->shapes[object];
    float center[3];
    scene_place(center, shape, shape->center, walk->ray->time);
    bool again = same_sphere(walk->from, center, shape->radius);
    bool hit = (again ? sphere_cross_again : sphere_cross)(out, walk->ray, center, shape->radius);
    out->object = object;
    out->primitive = 0;
    out->material = shape->material;
    return hit;
}

// A triangle of the scene, or of an instance.
static bool cross_triangle(struct crossing *out, const struct walk *walk, uint32_t number) {
    struct scene_triangle triangle = scene_triangle_at(walk->world->scene, number);
    const struct scene_shape *shape = &walk->world->scene->shapes[triangle.object];
    float placed[3][3];
    const float *v[3];
    for (int i = 0; i < 3; i++) {
        if (shape->instance) scene_place(placed[i], shape, triangle.v[i], walk->ray->time);
        v[i] = shape->instance ? placed[i] : triangle.v[i];
    }
    if (!triangle_cross(out, walk->ray, v)) return false;
    if (walk->from && walk->from->number == number) return false;
    if (walk->from && walk->from->kind == CROSSING_TRIANGLE) {
        const float *const own[3] = {walk->from->v[0], walk->from->v[1], walk->from->v[2]};
        if (triangle_in_plane(own, v)) return false;
    }
    out->object = triangle.object;
    out->primitive = triangle.primitive;
    out->material = triangle.material;
    return true;
}

static bool comes_first(struct walk *walk, const struct crossing *candidate) {
    if (!walk->found) return true;
    int order = crossing_compare(walk->ray, candidate, &walk->best);
    if (order != 0) return order < 0;
    if (candidate->object != walk->best.object) return candidate->object < walk->best.object;
    return candidate->primitive < walk->best.primitive;
}

static bool is_target(const struct ref_target *target, const struct crossing *candidate) {
    return target->there && target->object == candidate->object && (target->index < 0 || (uint32_t)target->index == candidate->primitive);
}

// Tests one primitive; true when the walk is over.
static bool try_primitive(struct walk *walk, uint32_t number) {
    bool is_triangle = number - walk->world->triangle_count >= walk->world->sphere_count; // also below triangle_count
    if (!(walk->world->effects & (is_triangle ? EFFECT_TRIANGLES : EFFECT_SPHERES))) return false;
    struct crossing candidate;
    if (!(is_triangle ? cross_triangle : cross_sphere)(&candidate, walk, number) || is_target(&walk->ray->target, &candidate)) return false;
    candidate.number = number;
    if (walk->any || comes_first(walk, &candidate)) {
        walk->found = true;
        walk->best = candidate;
        walk->cut = fmin(walk->cut, candidate.t.hi);
    }
    return walk->any;
}

struct waiting {
    uint32_t node;
    double enter;
};

// Depth first, the nearer child first; what was pushed is dropped if a hit has come before it. In an instance's part its triangles are numbered from `first`.
// True when the walk is over.
static bool walk_down(struct walk *walk, const struct bvh *bvh, const struct scene_shape *placed, uint32_t first);

static bool walk_instance(struct walk *walk, const struct scene_instance *instance) {
    const struct ref_world *world = walk->world;
    if (!(world->effects & EFFECT_INSTANCES)) return false;
    return walk_down(walk, &world->bvh->parts[instance->part], &world->scene->shapes[instance->shape],
                     world->triangle_count + world->sphere_count + instance->first);
}

static bool try_entry(struct walk *walk, uint32_t entry, const struct scene_shape *placed, uint32_t first) {
    uint32_t others = walk->world->triangle_count + walk->world->sphere_count;
    if (placed || entry < others) return try_primitive(walk, first + entry);
    return walk_instance(walk, &walk->world->scene->instances[entry - others]);
}

static double node_enter(const struct walk *walk, const struct bvh_node *node, const struct scene_shape *placed) {
    struct box box = box_of(walk, node, placed);
    return box_enter(walk, &box);
}

static bool walk_down(struct walk *walk, const struct bvh *bvh, const struct scene_shape *placed, uint32_t first) {
    struct waiting stack[BVH_MAX_DEPTH + 2];
    int top = 0;
    double enter = bvh->node_count > 0 ? node_enter(walk, &bvh->nodes[0], placed) : INFINITY;
    if (enter < INFINITY) stack[top++] = (struct waiting){0, enter};
    while (top > 0) {
        struct waiting next = stack[--top];
        const struct bvh_node *node = &bvh->nodes[next.node];
        if (next.enter > walk->cut) continue;
        for (uint32_t i = 0; i < node->count; i++) {
            if (try_entry(walk, bvh->order[node->first + i], placed, first)) return true;
        }
        if (node->count > 0) continue;
        struct waiting left = {node->first, node_enter(walk, &bvh->nodes[node->first], placed)};
        struct waiting right = {node->first + 1, node_enter(walk, &bvh->nodes[node->first + 1], placed)};
        bool swap = right.enter < left.enter;
        struct waiting near = swap ? right : left, far = swap ? left : right;
        if (far.enter < INFINITY) stack[top++] = far;
        if (near.enter < INFINITY) stack[top++] = near;
    }
    return false;
}

static struct walk walk_make(const struct ref_world *world, struct ref_ray *ray, const struct crossing *from, bool any) {
    struct walk walk = {.world = world, .ray = ray, .from = from, .any = any, .cut = ray->tmax};
    for (int i = 0; i < 3; i++) walk.inverse[i] = ray->d[i] != 0 ? 1 / ray->d[i] : 0;
    return walk;
}

bool closest_hit(struct crossing *out, const struct ref_world *world, struct ref_ray *ray) {
    return closest_hit_from(out, world, ray, NULL);
}

bool closest_hit_from(struct crossing *out, const struct ref_world *world, struct ref_ray *ray, const struct crossing *from) {
    struct walk walk = walk_make(world, ray, from, false);
    walk_down(&walk, world->bvh, NULL, 0);
    *out = walk.best;
    return walk.found;
}

bool any_hit(const struct ref_world *world, struct ref_ray *ray, const struct crossing *from) {
    struct walk walk = walk_make(world, ray, from, true);
    walk_down(&walk, world->bvh, NULL, 0);
    return walk.found;
}
