// The builder as a whole: records of all boxes, the top of the tree with all threads, then one task for each subtree, then all in one
// array.
//
// Every step keeps the order of the primitives' numbers in a set, so that cuts in the middle and between the two kinds need no sorting, and
// the same boxes give the same tree. In the result the top comes first, level by level, and then the subtrees, each in one piece.
#include "bvh/bvh.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "bvh/top.h"

#define MOST_PRIMITIVES (UINT32_MAX / 2) // a node's number is 32 bits, and there may be two nodes for each primitive

struct build {
    struct context *ctx;
    const struct bvh_box *boxes;
    uint32_t count;
    struct bvh_watch watch;
    struct bvh_workspace workspace;
    struct bvh_extent *extents; // of the chunks of the boxes
    struct bvh_top top;
    struct bvh_subtree *subtrees; // of the top's small sets
    uint32_t *bases;              // where the second node of each goes; its root goes into the top
    struct bvh_node *nodes;       // the result
};

static bool fill_records(void *data, size_t begin, size_t end, unsigned thread) {
    struct build *build = data;
    struct bvh_record *records = build->workspace.records[0];
    for (size_t i = begin; i < end; i++) records[i] = bvh_record_make(&build->boxes[i], (uint32_t)i);
    struct bvh_extent *extent = &build->extents[begin / BVH_CHUNK_SIZE];
    *extent = bvh_extent_empty;
    bvh_extent_add(extent, &records[begin], (uint32_t)(end - begin));
    return bvh_watch_go_on(&build->watch, thread);
}

// Makes the records, and of all of them the root's range.
static bool make_records(struct build *build, struct bvh_range *root) {
    uint32_t chunks = (build->count - 1) / BVH_CHUNK_SIZE + 1;
    for (int i = 0; i < 2; i++) {
        build->workspace.records[i] = array_alloc(build->ctx, build->count, sizeof(struct bvh_record), "BVH records");
        if (!build->workspace.records[i]) return false;
    }
    build->extents = array_alloc(build->ctx, chunks, sizeof *build->extents, "BVH bounds");
    build->workspace.order = array_alloc(build->ctx, build->count, sizeof *build->workspace.order, "the order of primitives");
    if (!build->extents || !build->workspace.order) return false;
    if (!parallel_for(context_threads(build->ctx), build->count, BVH_CHUNK_SIZE, fill_records, build)) return false;
    *root = (struct bvh_range){.end = build->count, .extent = bvh_extent_empty};
    for (uint32_t i = 0; i < chunks; i++) bvh_extent_merge(&root->extent, &build->extents[i]);
    return true;
}

static void free_records(struct build *build) {
    for (int i = 0; i < 2; i++) {
        free(build->workspace.records[i]);
        build->workspace.records[i] = NULL;
    }
}

static bool build_subtrees(void *data, size_t begin, size_t end, unsigned thread) {
    struct build *build = data;
    for (size_t i = begin; i < end; i++) {
        const struct bvh_range *range = &build->top.small[i].range;
        if (!bvh_subtree_build(&build->subtrees[i], &build->workspace, range)) return false;
        atomic_fetch_add(&build->watch.done, bvh_work(bvh_range_size(range)));
    }
    return bvh_watch_go_on(&build->watch, thread);
}

static bool make_subtrees(struct build *build) {
    uint32_t count = build->top.small_count;
    build->subtrees = array_alloc(build->ctx, count, sizeof *build->subtrees, "BVH subtrees");
    build->bases = array_alloc(build->ctx, count, sizeof *build->bases, "BVH subtrees");
    if (!build->subtrees || !build->bases) return false;
    if (parallel_for(context_threads(build->ctx), count, 1, build_subtrees, build)) return true;
    return fail(build->ctx, GN_LIMIT, "no memory for a subtree of the BVH of %" PRIu32 " primitives", build->count); // unless cancelled
}

// Copies a node whose subtree's second node goes to `base`.
static void place(struct bvh_node *to, const struct bvh_node *from, uint32_t base) {
    *to = *from;
    if (from->count == 0) to->first += base - 1;
}

static bool join_subtrees(void *data, size_t begin, size_t end, unsigned thread) {
    struct build *build = data;
    for (size_t i = begin; i < end; i++) {
        struct bvh_subtree *subtree = &build->subtrees[i];
        uint32_t base = build->bases[i];
        place(&build->nodes[build->top.small[i].node], &subtree->nodes[0], base);
        for (uint32_t j = 1; j < subtree->node_count; j++) place(&build->nodes[base + j - 1], &subtree->nodes[j], base);
        free(subtree->nodes);
        subtree->nodes = NULL;
    }
    return bvh_watch_go_on(&build->watch, thread);
}

// Puts the top and the subtrees into one array.
static bool join(struct build *build, struct bvh *out) {
    const struct bvh_top *top = &build->top;
    uint32_t node_count = top->node_count;
    double cost = top->cost;
    for (uint32_t i = 0; i < top->small_count; i++) {
        const struct bvh_subtree *subtree = &build->subtrees[i];
        build->bases[i] = node_count;
        node_count += subtree->node_count - 1;
        cost += subtree->cost;
        if (subtree->depth > out->depth) out->depth = subtree->depth;
    }
    build->nodes = array_alloc(build->ctx, node_count, sizeof *build->nodes, "BVH nodes");
    if (!build->nodes) return false;
    memcpy(build->nodes, top->nodes, top->node_count * sizeof *top->nodes);
    if (!parallel_for(context_threads(build->ctx), top->small_count, 1, join_subtrees, build)) return false;
    double root_area = bvh_half_area(build->nodes[0].min, build->nodes[0].max);
    out->sah_cost = root_area > 0 ? cost / root_area : 0;
    out->node_count = node_count;
    out->primitive_count = build->count;
    return true;
}

static void build_finish(struct build *build) {
    for (uint32_t i = 0; build->subtrees && i < build->top.small_count; i++) free(build->subtrees[i].nodes);
    free_records(build);
    bvh_top_finish(&build->top);
    free(build->extents);
    free(build->subtrees);
    free(build->bases);
    free(build->workspace.order);
    free(build->nodes);
}

bool bvh_build(struct bvh *out, struct context *ctx, const struct bvh_box *boxes, uint32_t count, const struct bvh_params *params) {
    *out = (struct bvh){0};
    if (count > MOST_PRIMITIVES)
        return fail(ctx, GN_LIMIT, "%" PRIu32 " primitives are more than a BVH can hold (%" PRIu32 ")", count, MOST_PRIMITIVES);
    if (count == 0) return true;
    struct build build = {.ctx = ctx, .boxes = boxes, .count = count};
    // Between the kinds; before the first single; and halves of BVH_MAX_LEAF = 2³ of them.
    build.workspace.split_at = params->split_at;
    build.workspace.single_from = count - params->singles;
    build.workspace.last_cuts = params->singles ? 5 : 1;
    struct bvh_range root;
    if (!bvh_watch_begin(&build.watch, ctx, count) || !make_records(&build, &root)) goto fail;
    if (!bvh_top_build(&build.top, ctx, &build.workspace, &root, &build.watch) || !make_subtrees(&build)) goto fail;
    free_records(&build);
    if (!join(&build, out) || !bvh_watch_end(&build.watch)) goto fail;
    out->nodes = build.nodes;
    out->order = build.workspace.order;
    build.nodes = NULL;
    build.workspace.order = NULL;
    build_finish(&build);
    return true;
fail:
    build_finish(&build);
    *out = (struct bvh){0};
    return false;
}

void bvh_finish(struct bvh *bvh) {
    for (uint32_t i = 0; i < bvh->part_count; i++) bvh_finish(&bvh->parts[i]);
    free(bvh->parts);
    free(bvh->nodes);
    free(bvh->order);
    *bvh = (struct bvh){0};
}
