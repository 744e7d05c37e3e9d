#include "reference/traverse.h"

#include "shaders/shared.h"

struct ref_world ref_world_make(const struct scene *scene, const struct bvh *bvh, uint32_t effects) {
    return (struct ref_world){.scene = scene, .bvh = bvh, .effects = effects, .triangle_count = scene_triangle_count(scene)};
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

// Where the ray enters a box, or +inf if it misses it: never later than exactly.
//
// (b-o)·(1/d) has three roundings: off by less than 2^-51 of itself. The pads are 2^-50, which covers their own rounding. A component d_i =
// 0 leaves containment in the closed slab. Nothing under- or overflows but where a box is infinite.
static double box_enter(const struct walk *walk, const struct bvh_node *node) {
    double enter = -INFINITY, leave = INFINITY;
    for (int i = 0; i < 3; i++) {
        double o = walk->ray->o[i], inverse = walk->inverse[i];
        if (inverse == 0) {
            if (o < node->min[i] || o > node->max[i]) return INFINITY;
            continue;
        }
        double a = (node->min[i] - o) * inverse, b = (node->max[i] - o) * inverse;
        double near = inverse > 0 ? a : b, far = inverse > 0 ? b : a;
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    enter -= fabs(enter) * 0x1p-50;
    leave += fabs(leave) * 0x1p-50;
    return enter <= leave && leave >= walk->ray->tmin && enter <= walk->cut ? enter : INFINITY;
}

static bool same_sphere(const struct crossing *from, const float center[3], float radius) {
    if (!from || !from->center || from->radius != radius) return false;
    return from->center[0] == center[0] && from->center[1] == center[1] && from->center[2] == center[2];
}

static bool cross_sphere(struct crossing *out, const struct walk *walk, uint32_t number) {
    uint32_t object = scene_sphere_object(walk->world->scene, number - walk->world->triangle_count);
    const struct scene_shape *shape = &walk->world->scene->shapes[object];
    bool again = same_sphere(walk->from, shape->center, shape->radius);
    bool hit = (again ? sphere_cross_again : sphere_cross)(out, walk->ray, shape->center, shape->radius);
    out->object = object;
    out->primitive = 0;
    out->material = shape->material;
    return hit;
}

static bool cross_triangle(struct crossing *out, const struct walk *walk, uint32_t number) {
    struct scene_triangle triangle = scene_triangle_at(walk->world->scene, number);
    const float *const v[3] = {triangle.v[0], triangle.v[1], triangle.v[2]};
    if (!triangle_cross(out, walk->ray, v)) return false;
    if (walk->from && walk->from->number == number) return false;
    if (walk->from && walk->from->v[0]) {
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
    bool is_triangle = number < walk->world->triangle_count;
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

// Depth first, the nearer child first; what was pushed is dropped if a hit has come before it.
static void walk_down(struct walk *walk) {
    const struct bvh *bvh = walk->world->bvh;
    struct waiting stack[BVH_MAX_DEPTH + 2];
    int top = 0;
    double enter = bvh->node_count > 0 ? box_enter(walk, &bvh->nodes[0]) : INFINITY;
    if (enter < INFINITY) stack[top++] = (struct waiting){0, enter};
    while (top > 0) {
        struct waiting next = stack[--top];
        const struct bvh_node *node = &bvh->nodes[next.node];
        if (next.enter > walk->cut) continue;
        for (uint32_t i = 0; i < node->count; i++) {
            if (try_primitive(walk, bvh->order[node->first + i])) return;
        }
        if (node->count > 0) continue;
        struct waiting left = {node->first, box_enter(walk, &bvh->nodes[node->first])};
        struct waiting right = {node->first + 1, box_enter(walk, &bvh->nodes[node->first + 1])};
        bool swap = right.enter < left.enter;
        struct waiting near = swap ? right : left, far = swap ? left : right;
        if (far.enter < INFINITY) stack[top++] = far;
        if (near.enter < INFINITY) stack[top++] = near;
    }
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
    walk_down(&walk);
    *out = walk.best;
    return walk.found;
}

bool any_hit(const struct ref_world *world, struct ref_ray *ray, const struct crossing *from) {
    struct walk walk = walk_make(world, ray, from, true);
    walk_down(&walk);
    return walk.found;
}
