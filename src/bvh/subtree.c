#include "bvh/subtree.h"

#include <stdlib.h>
#include <string.h>

// Constant during a build, and the bins that every node of it uses.
struct subtree_build {
    const struct bvh_workspace *workspace;
    struct bvh_subtree *out;
    struct bvh_bins bins;
};

// The depth that halving down to leaves takes, and the levels of the last cuts, must be left to the larger side.
bool bvh_depth_allows(const struct bvh_workspace *workspace, uint32_t depth, uint32_t count) {
    uint32_t levels = 0;
    for (uint32_t n = count - 1; n > BVH_MAX_LEAF; n -= n / 2) levels++;
    return depth + 1 + levels + workspace->last_cuts <= BVH_MAX_DEPTH;
}

struct bvh_range bvh_range_part(const struct bvh_range *range, int side, uint32_t middle, bool moved) {
    return (struct bvh_range){.begin = side ? middle : range->begin,
                              .end = side ? range->end : middle,
                              .depth = range->depth + 1,
                              .source = moved ? 1 - range->source : range->source,
                              .extent = bvh_extent_empty};
}

// Leaves the records where they are.
static void cut_range(struct bvh_range parts[2], const struct bvh_workspace *workspace, const struct bvh_range *range, uint32_t middle) {
    for (int side = 0; side < 2; side++) {
        parts[side] = bvh_range_part(range, side, middle, false);
        bvh_extent_add(&parts[side].extent, &workspace->records[range->source][parts[side].begin], bvh_range_size(&parts[side]));
    }
}

static void split_range(struct bvh_range parts[2], const struct bvh_workspace *workspace, const struct bvh_range *range,
                        const struct bvh_split *split, const struct bvh_grid *grid) {
    const struct bvh_record *from = workspace->records[range->source];
    struct bvh_record *to = workspace->records[1 - range->source];
    uint32_t middle = range->begin + split->left_count;
    struct bvh_extent extents[2];
    bvh_split_move(split, grid, &from[range->begin], bvh_range_size(range), &to[range->begin], &to[middle], extents);
    for (int side = 0; side < 2; side++) {
        parts[side] = bvh_range_part(range, side, middle, true);
        parts[side].extent = extents[side];
    }
}

// The first place in a range whose primitive has this number or a higher one.
static uint32_t find_number(const struct bvh_workspace *workspace, const struct bvh_range *range, uint32_t number) {
    const struct bvh_record *records = workspace->records[range->source];
    uint32_t i = range->begin;
    while (i < range->end && bvh_record_number(&records[i]) < number) i++;
    return i;
}

// Where a set that is small enough for a leaf must be cut all the same; 0: nowhere. *single: a primitive that has a leaf for itself is the reason.
static uint32_t forced_cut(bool *single, const struct bvh_workspace *workspace, const struct bvh_range *range) {
    uint32_t kind = find_number(workspace, range, workspace->split_at), first = find_number(workspace, range, workspace->single_from);
    *single = first < range->end;
    if (kind > range->begin && kind < range->end) return kind;
    if (first == range->end) return 0;
    return first > range->begin ? first : range->begin + bvh_range_size(range) / 2;
}

// About one bin for four primitives: more would be empty in small sets, which are most of all.
static int bins_for(uint32_t count) { return count < 4 * (BVH_MAX_BINS - 4) ? 4 + (int)count / 4 : BVH_MAX_BINS; }

// Divides a range in two as the heuristic says, or as it must. False when it is to be a leaf.
static bool divide(struct bvh_range parts[2], struct subtree_build *build, const struct bvh_range *range, double area) {
    const struct bvh_workspace *workspace = build->workspace;
    uint32_t count = bvh_range_size(range);
    if (count == 1) return false;
    struct bvh_grid grid = bvh_grid_make(&range->extent, bins_for(count));
    struct bvh_split split = {.axis = -1};
    if (bvh_depth_allows(workspace, range->depth, count)) {
        bvh_bins_clear(&build->bins, grid.bins);
        bvh_bins_add(&build->bins, &grid, &workspace->records[range->source][range->begin], count);
        bvh_split_find(&split, &build->bins, grid.bins);
    }
    if (count <= BVH_MAX_LEAF && (split.axis < 0 || area * count <= BVH_NODE_COST * area + split.cost)) {
        bool single;
        uint32_t cut = forced_cut(&single, workspace, range);
        if (cut == 0) return false;
        if (single && split.axis >= 0)
            split_range(parts, workspace, range, &split, &grid);
        else
            cut_range(parts, workspace, range, cut);
    } else if (split.axis < 0) {
        cut_range(parts, workspace, range, range->begin + count / 2);
    } else {
        split_range(parts, workspace, range, &split, &grid);
    }
    return true;
}

static void leaf_make(struct subtree_build *build, struct bvh_node *node, const struct bvh_range *range, double area) {
    const struct bvh_workspace *workspace = build->workspace;
    node->first = range->begin;
    node->count = bvh_range_size(range);
    for (uint32_t i = range->begin; i < range->end; i++) workspace->order[i] = bvh_record_number(&workspace->records[range->source][i]);
    build->out->cost += area * node->count;
    if (range->depth > build->out->depth) build->out->depth = range->depth;
}

static void node_build(struct subtree_build *build, uint32_t number, const struct bvh_range *range) {
    struct bvh_node *node = &build->out->nodes[number];
    memcpy(node->min, range->extent.min, sizeof node->min);
    memcpy(node->max, range->extent.max, sizeof node->max);
    double area = bvh_half_area(node->min, node->max);
    struct bvh_range parts[2];
    if (!divide(parts, build, range, area)) {
        leaf_make(build, node, range, area);
        return;
    }
    build->out->cost += BVH_NODE_COST * area;
    node->first = build->out->node_count;
    node->count = 0;
    build->out->node_count += 2;
    for (uint32_t side = 0; side < 2; side++) node_build(build, node->first + side, &parts[side]);
}

bool bvh_subtree_build(struct bvh_subtree *out, const struct bvh_workspace *workspace, const struct bvh_range *range) {
    *out = (struct bvh_subtree){0};
    size_t count = bvh_range_size(range);
    out->nodes = malloc((2 * count - 1) * sizeof *out->nodes);
    if (!out->nodes) return false;
    struct subtree_build build = {.workspace = workspace, .out = out};
    out->node_count = 1;
    node_build(&build, 0, range);
    struct bvh_node *fitted = realloc(out->nodes, out->node_count * sizeof *fitted);
    if (fitted) out->nodes = fitted;
    return true;
}
