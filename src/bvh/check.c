// Whether a hierarchy is what bvh.h promises. Believes nothing: every number is checked before it is used as an index.
#include "bvh/bvh.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bvh/split.h"

struct check {
    const struct bvh *bvh;
    const struct bvh_box *boxes;
    const struct bvh_params *params;
    unsigned char *node_seen;  // node_count
    unsigned char *place_seen; // places in `order`
    unsigned char *primitive_seen;
    uint32_t leaf_primitives, depth;
    double cost;
    char *why;
    size_t capacity;
};

static bool wrong(struct check *check, const char *format, uint32_t number) {
    snprintf(check->why, check->capacity, format, number);
    return false;
}

static bool same_box(const struct bvh_node *node, const float min[3], const float max[3]) {
    for (int axis = 0; axis < 3; axis++)
        if (!(node->min[axis] == min[axis] && node->max[axis] == max[axis])) return false;
    return true;
}

static void box_grow(struct bvh_box *box, const float min[3], const float max[3]) {
    for (int axis = 0; axis < 3; axis++) {
        box->min[axis] = fminf(box->min[axis], min[axis]);
        box->max[axis] = fmaxf(box->max[axis], max[axis]);
    }
}

static const struct bvh_box empty_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

// One primitive of a leaf, at `place` in the order.
static bool check_primitive(struct check *check, uint32_t place, struct bvh_box *box) {
    uint32_t primitive = check->bvh->order[place];
    if (check->place_seen[place]++) return wrong(check, "place %" PRIu32 " of the order is in two leaves", place);
    if (primitive >= check->bvh->primitive_count) return wrong(check, "the order names primitive %" PRIu32, primitive);
    if (check->primitive_seen[primitive]++) return wrong(check, "primitive %" PRIu32 " is in two places", primitive);
    box_grow(box, check->boxes[primitive].min, check->boxes[primitive].max);
    return true;
}

static bool check_leaf(struct check *check, uint32_t number, uint32_t depth) {
    const struct bvh_node *node = &check->bvh->nodes[number];
    uint32_t split_at = check->params->split_at;
    if (node->count > BVH_MAX_LEAF) return wrong(check, "leaf %" PRIu32 " is too large", number);
    if (node->first > check->bvh->primitive_count || node->count > check->bvh->primitive_count - node->first)
        return wrong(check, "leaf %" PRIu32 " ends behind the order", number);
    struct bvh_box box = empty_box;
    for (uint32_t i = 0; i < node->count; i++)
        if (!check_primitive(check, node->first + i, &box)) return false;
    for (uint32_t i = 1; i < node->count; i++)
        if ((check->bvh->order[node->first + i] < split_at) != (check->bvh->order[node->first] < split_at))
            return wrong(check, "leaf %" PRIu32 " holds both kinds", number);
    for (uint32_t i = 0; i < node->count && node->count > 1; i++)
        if (check->bvh->order[node->first + i] >= check->bvh->primitive_count - check->params->singles)
            return wrong(check, "leaf %" PRIu32 " holds a primitive that must have one for itself", number);
    if (!same_box(node, box.min, box.max)) return wrong(check, "the box of leaf %" PRIu32 " is not its primitives'", number);
    check->leaf_primitives += node->count;
    check->cost += bvh_half_area(node->min, node->max) * node->count;
    if (depth > check->depth) check->depth = depth;
    return true;
}

// The node and all below it; the depth, which is checked first, bounds the recursion.
static bool check_node(struct check *check, uint32_t number, uint32_t depth) {
    if (depth > BVH_MAX_DEPTH) return wrong(check, "node %" PRIu32 " is too deep", number);
    if (check->node_seen[number]++) return wrong(check, "node %" PRIu32 " has two parents", number);
    const struct bvh_node *node = &check->bvh->nodes[number];
    if (node->count > 0) return check_leaf(check, number, depth);
    if (node->first >= check->bvh->node_count - 1) return wrong(check, "a child of node %" PRIu32 " is not there", number);
    const struct bvh_node *children = &check->bvh->nodes[node->first];
    struct bvh_box box = empty_box;
    for (int side = 0; side < 2; side++) box_grow(&box, children[side].min, children[side].max);
    if (!same_box(node, box.min, box.max)) return wrong(check, "the box of node %" PRIu32 " is not its children's", number);
    check->cost += bvh_half_area(node->min, node->max);
    return check_node(check, node->first, depth + 1) && check_node(check, node->first + 1, depth + 1);
}

static bool check_all(struct check *check) {
    const struct bvh *bvh = check->bvh;
    if (!check_node(check, 0, 0)) return false;
    for (uint32_t i = 0; i < bvh->node_count; i++)
        if (!check->node_seen[i]) return wrong(check, "node %" PRIu32 " has no parent", i);
    if (check->leaf_primitives != bvh->primitive_count)
        return wrong(check, "the leaves hold %" PRIu32 " primitives", check->leaf_primitives);
    if (check->depth != bvh->depth) return wrong(check, "the depth is %" PRIu32, check->depth);
    double root_area = bvh_half_area(bvh->nodes[0].min, bvh->nodes[0].max);
    double cost = root_area > 0 ? check->cost / root_area : 0;
    if (!(fabs(cost - bvh->sah_cost) <= 1e-9 * cost))
        return wrong(check, "sah_cost is not the cost of these %" PRIu32 " nodes", bvh->node_count);
    return true;
}

bool bvh_check(const struct bvh *bvh, const struct bvh_box *boxes, const struct bvh_params *params, char *why, size_t capacity) {
    struct check check = {.bvh = bvh, .boxes = boxes, .params = params, .why = why, .capacity = capacity};
    if ((bvh->node_count == 0) != (bvh->primitive_count == 0)) return wrong(&check, "there are %" PRIu32 " nodes", bvh->node_count);
    if (bvh->node_count == 0) return true;
    check.node_seen = calloc(bvh->node_count, 1);
    check.place_seen = calloc(bvh->primitive_count, 1);
    check.primitive_seen = calloc(bvh->primitive_count, 1);
    bool memory = check.node_seen && check.place_seen && check.primitive_seen;
    bool right = memory ? check_all(&check) : wrong(&check, "no memory to check %" PRIu32 " nodes", bvh->node_count);
    free(check.node_seen);
    free(check.place_seen);
    free(check.primitive_seen);
    return right;
}
