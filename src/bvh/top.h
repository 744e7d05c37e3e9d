// The upper part of the builder: splits large sets level by level, with all threads on one level, until each is small enough for one
// thread.
//
// The sets of a level are cut into chunks of a fixed size. The chunks are binned in parallel, the bins of a set are merged in the order of
// its chunks, the split is chosen, and the chunks are moved in parallel to places that follow from their bins. So nothing depends on the
// number of threads.
#ifndef BVH_TOP_H
#define BVH_TOP_H

#include "bvh/subtree.h"
#include "bvh/watch.h"

#define BVH_SUBTREE_SIZE 4096u // primitives that are few enough for one thread
#define BVH_CHUNK_SIZE 16384u  // primitives of a piece of a large set

// A small set, and the node of the top that it is to become.
struct bvh_small {
    struct bvh_range range;
    uint32_t node;
};

// Zeroed is empty.
struct bvh_top {
    struct bvh_node *nodes; // level by level; those of small sets have only their place
    struct bvh_small *small;
    uint32_t node_count, small_count;
    double cost; // Σ half area × BVH_NODE_COST of its inner nodes
};

// Splits the root, which is all records of the workspace. GN_LIMIT, GN_CANCELLED.
bool bvh_top_build(struct bvh_top *out, struct context *ctx, const struct bvh_workspace *workspace, const struct bvh_range *root,
                   struct bvh_watch *watch);
void bvh_top_finish(struct bvh_top *top);

#endif
