// One step of the builder: where to cut a set of primitives in two by the surface area heuristic, and moving them there.
//
// Works on records, which are a primitive's box and number side by side, so that a pass over a set reads memory in one stream. Vectors have
// four lanes, of which three are used, so that a compiler makes one instruction of a loop over them. Knows no tree and no threads: a set
// may be binned and moved in pieces, and the pieces' results are merged in a fixed order.
#ifndef BVH_SPLIT_H
#define BVH_SPLIT_H

#include "bvh/bvh.h"

#define BVH_MAX_BINS 32

// The primitive's number is min[3] + 65536 × max[3], two whole numbers below 65536.
struct bvh_record {
    float min[4], max[4];
};

struct bvh_record bvh_record_make(const struct bvh_box *box, uint32_t number);
uint32_t bvh_record_number(const struct bvh_record *record);

// What is known of a set before it is split. Only lanes 0 to 2 mean something.
struct bvh_extent {
    float min[4], max[4];  // union of the boxes; may be infinite
    float low[4], high[4]; // bounds of (min + max) / 4, for which infinite bounds count as ±FLT_MAX: finite
};

// The empty set's: min > max, low > high.
extern const struct bvh_extent bvh_extent_empty;

void bvh_extent_add(struct bvh_extent *extent, const struct bvh_record *records, uint32_t count);
void bvh_extent_merge(struct bvh_extent *extent, const struct bvh_extent *other);

// Half the surface of a box, of which an infinite side counts as twice FLT_MAX: finite in double, 0 for a segment or a point.
double bvh_half_area(const float min[3], const float max[3]);

// How centroids map to bins: never decreasing, and where low < high, low goes to the first bin and high to the last.
struct bvh_grid {
    float low[4];
    float unit[4], scale[4]; // bin = ((min + max) / 4 - low) × unit × scale; unit is a power of two, so that scale is finite
    float last;              // number of the last bin
    int bins;                // 2 … BVH_MAX_BINS
};

struct bvh_grid bvh_grid_make(const struct bvh_extent *extent, int bins);

struct bvh_bin {
    float min[4], max[4];
};

struct bvh_bins {
    struct bvh_bin bin[3][BVH_MAX_BINS];
    uint32_t count[3][BVH_MAX_BINS];
};

void bvh_bins_clear(struct bvh_bins *bins, int count);
void bvh_bins_add(struct bvh_bins *bins, const struct bvh_grid *grid, const struct bvh_record *records, uint32_t count);
void bvh_bins_merge(struct bvh_bins *bins, const struct bvh_bins *other, int count);

// A set cut in two: the primitives whose bin on `axis` is below `bin`, and the others.
struct bvh_split {
    int axis, bin; // axis -1: none
    uint32_t left_count;
    double cost;             // left area × count + right area × count, in half areas
    struct bvh_bin parts[2]; // boxes of the left and the right part
};

// The cheapest split, and of equally cheap ones the most even. False, with axis -1, when all centroids coincide.
bool bvh_split_find(struct bvh_split *split, const struct bvh_bins *bins, int count);

// How many primitives of one piece's bins go left.
uint32_t bvh_split_left_count(const struct bvh_split *split, const struct bvh_bins *bins);

// Copies records to left[…] or right[…], keeping their order. Fills the extents of what goes left and right; their boxes are those of the
// whole set's two parts.
void bvh_split_move(const struct bvh_split *split, const struct bvh_grid *grid, const struct bvh_record *records, uint32_t count,
                    struct bvh_record *left, struct bvh_record *right, struct bvh_extent extents[2]);

#endif
