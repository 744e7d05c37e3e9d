// One thread's part of the builder: splits a set to the end, and numbers its nodes from 0.
#ifndef BVH_SUBTREE_H
#define BVH_SUBTREE_H

#include "bvh/split.h"

#define BVH_NODE_COST 1.0 // of a visit to an inner node, relative to the test of a primitive

// A set of primitives on its way to become a node. Its records are in the order of the primitives' numbers.
struct bvh_range {
    uint32_t begin, end; // in the records
    uint32_t depth;      // edges from the root of the whole tree
    uint32_t source;     // which of the two arrays of records holds them: 0 or 1
    struct bvh_extent extent;
};

// The two arrays that records are moved between, and what leaves are made of.
struct bvh_workspace {
    struct bvh_record *records[2];
    uint32_t *order;   // of the result
    uint32_t split_at; // as in struct bvh_params
    uint32_t single_from; // primitives from this number on have a leaf each
    uint32_t last_cuts;   // levels that cuts take where a leaf would do but for what must not share one
};

// Zeroed is empty.
struct bvh_subtree {
    struct bvh_node *nodes; // an inner node's `first` counts from nodes[0], a leaf's is a place in `order`
    uint32_t node_count;
    uint32_t depth; // of the deepest leaf, edges from the root of the whole tree
    double cost;    // Σ half area × BVH_NODE_COST of inner nodes + Σ half area × primitives of leaves
};

// Builds the tree of a range into *out, which the caller frees (`nodes`). False, with *out zeroed and nothing reported, when memory is
// missing.
bool bvh_subtree_build(struct bvh_subtree *out, const struct bvh_workspace *workspace, const struct bvh_range *range);

static inline uint32_t bvh_range_size(const struct bvh_range *range) { return range->end - range->begin; }

// The left (side 0) or right part of a range divided at `middle`, its extent yet empty. `moved`: its records go to the other array.
struct bvh_range bvh_range_part(const struct bvh_range *range, int side, uint32_t middle, bool moved);

// Whether a node at this depth may be split as unevenly as it may come: halving the larger side suffices after that.
bool bvh_depth_allows(const struct bvh_workspace *workspace, uint32_t depth, uint32_t count);

#endif
