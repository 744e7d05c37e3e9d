// A bounding volume hierarchy over boxes: built with the binned surface area heuristic on all cores.
//
// Boxes are closed and exact or rounded outward, and a node's box is the exact union of its children's: a traversal that is conservative on
// boxes never loses a hit. Primitives are numbered 0 … count-1; those below `split_at` and the others (triangles and spheres, say) never
// share a leaf. Based on I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007.
#ifndef BVH_BVH_H
#define BVH_BVH_H

#include "base/context.h"

#define BVH_MAX_LEAF 8   // primitives in a leaf at most
#define BVH_MAX_DEPTH 62 // edges from the root to a leaf at most; traversal stacks rely on it

struct bvh_box {
    float min[3], max[3];
};

// Node 0 is the root. An inner node's children are nodes first and first + 1; a leaf's primitives are order[first … first + count).
struct bvh_node {
    float min[3];
    uint32_t first;
    float max[3];
    uint32_t count; // primitives; 0: an inner node
};

// Zeroed is empty: node_count 0 for a scene without shapes.
struct bvh {
    struct bvh_node *nodes;
    uint32_t *order; // a permutation of 0 … primitive_count-1
    uint32_t node_count, primitive_count;
    uint32_t depth;  // edges from the root to the deepest leaf
    double sah_cost; // Σ area over the root's area, 1 × for each inner node and 1 × for each primitive of a leaf; 0 for a flat root
    struct bvh *parts; // of a scene: the hierarchies of what its instances draw
    uint32_t part_count;
};

struct bvh_params {
    uint32_t split_at; // primitives from this number on are of the other kind
    uint32_t singles;  // the last so many have a leaf each
};

// Builds over boxes[0 … count): no NaN, min ≤ max, min < +∞, max > -∞. The same boxes give the same tree whatever the number of
// threads. Ends within BVH_MAX_DEPTH for any input: coincident, huge (1e38), flat. Takes up to 140 bytes per primitive, usually
// less than 100, the result included. GN_LIMIT when memory is missing or there are 2^31 primitives or more, GN_CANCELLED.
bool bvh_build(struct bvh *out, struct context *ctx, const struct bvh_box *boxes, uint32_t count, const struct bvh_params *params);
void bvh_finish(struct bvh *bvh);

// Whether the invariants above hold (every primitive in one leaf, boxes contain, kinds apart, depth); for tests. Writes what is
// wrong into why[capacity].
bool bvh_check(const struct bvh *bvh, const struct bvh_box *boxes, const struct bvh_params *params, char *why, size_t capacity);

#endif
