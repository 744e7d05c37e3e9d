#include "bvh/split.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define FOUR(value) value, value, value, value

const struct bvh_extent bvh_extent_empty = {{FOUR(INFINITY)}, {FOUR(-INFINITY)}, {FOUR(INFINITY)}, {FOUR(-INFINITY)}};

// Written so that they become one instruction each. NaN does not occur.
static inline float least(float a, float b) { return a < b ? a : b; }
static inline float most(float a, float b) { return a > b ? a : b; }

struct bvh_record bvh_record_make(const struct bvh_box *box, uint32_t number) {
    return (struct bvh_record){.min = {box->min[0], box->min[1], box->min[2], (float)(number % 65536)},
                               .max = {box->max[0], box->max[1], box->max[2], (float)(number / 65536)}};
}

uint32_t bvh_record_number(const struct bvh_record *record) { return (uint32_t)record->min[3] + 65536 * (uint32_t)record->max[3]; }

// Neither the sum nor the difference of two of these overflows.
static inline float centroid(const struct bvh_record *record, int lane) {
    return most(0.25f * record->min[lane], -0.25f * FLT_MAX) + least(0.25f * record->max[lane], 0.25f * FLT_MAX);
}

static inline void centroid_add(float low[restrict 4], float high[restrict 4], const struct bvh_record *restrict record) {
    for (int lane = 0; lane < 4; lane++) {
        low[lane] = least(centroid(record, lane), low[lane]);
        high[lane] = most(centroid(record, lane), high[lane]);
    }
}

static inline void box_add(float min[restrict 4], float max[restrict 4], const float other_min[restrict 4],
                           const float other_max[restrict 4]) {
    for (int lane = 0; lane < 4; lane++) {
        min[lane] = least(other_min[lane], min[lane]);
        max[lane] = most(other_max[lane], max[lane]);
    }
}

void bvh_extent_add(struct bvh_extent *extent, const struct bvh_record *records, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        box_add(extent->min, extent->max, records[i].min, records[i].max);
        centroid_add(extent->low, extent->high, &records[i]);
    }
}

void bvh_extent_merge(struct bvh_extent *extent, const struct bvh_extent *other) {
    box_add(extent->min, extent->max, other->min, other->max);
    box_add(extent->low, extent->high, other->low, other->high);
}

static inline double side_length(float min, float max) {
    double length = (double)max - (double)min;
    return length < 2.0 * FLT_MAX ? length : 2.0 * FLT_MAX; // also for ∞ - ∞
}

double bvh_half_area(const float min[3], const float max[3]) {
    double x = side_length(min[0], max[0]), y = side_length(min[1], max[1]), z = side_length(min[2], max[2]);
    return x * y + y * z + z * x;
}

struct bvh_grid bvh_grid_make(const struct bvh_extent *extent, int bins) {
    struct bvh_grid grid = {.bins = bins, .last = (float)(bins - 1)};
    for (int axis = 0; axis < 3; axis++) {
        float length = extent->high[axis] - extent->low[axis];
        grid.low[axis] = extent->low[axis];
        grid.unit[axis] = length < 1 ? 0x1p100f : 1;
        grid.scale[axis] = length > 0 ? (float)bins / (length * grid.unit[axis]) : 0;
    }
    return grid;
}

static inline int bin_of(const struct bvh_grid *grid, const struct bvh_record *record, int lane) {
    return (int)least((centroid(record, lane) - grid->low[lane]) * grid->unit[lane] * grid->scale[lane], grid->last);
}

void bvh_bins_clear(struct bvh_bins *bins, int count) {
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < count; i++) {
            bins->bin[axis][i] = (struct bvh_bin){{FOUR(INFINITY)}, {FOUR(-INFINITY)}};
            bins->count[axis][i] = 0;
        }
    }
}

void bvh_bins_add(struct bvh_bins *bins, const struct bvh_grid *grid, const struct bvh_record *records, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const struct bvh_record record = records[i];
        int numbers[4];
        for (int lane = 0; lane < 4; lane++) numbers[lane] = bin_of(grid, &record, lane);
        for (int axis = 0; axis < 3; axis++) {
            struct bvh_bin *bin = &bins->bin[axis][numbers[axis]];
            box_add(bin->min, bin->max, record.min, record.max);
            bins->count[axis][numbers[axis]]++;
        }
    }
}

void bvh_bins_merge(struct bvh_bins *bins, const struct bvh_bins *other, int count) {
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < count; i++) {
            box_add(bins->bin[axis][i].min, bins->bin[axis][i].max, other->bin[axis][i].min, other->bin[axis][i].max);
            bins->count[axis][i] += other->count[axis][i];
        }
    }
}

// Left minus right, without its sign.
static uint32_t unevenness(uint32_t left, uint32_t right) { return left > right ? left - right : right - left; }

// Tries the splits along one axis: first the right sides from the end, then the left sides from the beginning (Wald 2007, section 3.3).
static void sweep(struct bvh_split *best, uint32_t *best_unevenness, const struct bvh_bins *bins, int count, int axis) {
    const struct bvh_bin *bin = bins->bin[axis];
    struct bvh_bin left = bin[0], right = bin[count - 1];
    uint32_t left_count = 0, right_count[BVH_MAX_BINS + 1];
    double right_cost[BVH_MAX_BINS];
    right_count[count] = 0;
    for (int i = count - 1; i > 0; i--) {
        box_add(right.min, right.max, bin[i].min, bin[i].max);
        right_count[i] = right_count[i + 1] + bins->count[axis][i];
        right_cost[i] = right_count[i] * bvh_half_area(right.min, right.max);
    }
    for (int i = 1; i < count; i++) {
        box_add(left.min, left.max, bin[i - 1].min, bin[i - 1].max);
        left_count += bins->count[axis][i - 1];
        if (left_count == 0 || right_count[i] == 0) continue;
        double cost = left_count * bvh_half_area(left.min, left.max) + right_cost[i];
        uint32_t uneven = unevenness(left_count, right_count[i]);
        if (cost > best->cost || (cost == best->cost && uneven >= *best_unevenness)) continue;
        *best = (struct bvh_split){.axis = axis, .bin = i, .left_count = left_count, .cost = cost};
        *best_unevenness = uneven;
    }
}

static struct bvh_bin bins_union(const struct bvh_bin *bins, int begin, int end) {
    struct bvh_bin box = bins[begin];
    for (int i = begin + 1; i < end; i++) box_add(box.min, box.max, bins[i].min, bins[i].max);
    return box;
}

bool bvh_split_find(struct bvh_split *split, const struct bvh_bins *bins, int count) {
    uint32_t uneven = UINT32_MAX;
    *split = (struct bvh_split){.axis = -1, .cost = INFINITY};
    for (int axis = 0; axis < 3; axis++) sweep(split, &uneven, bins, count, axis);
    if (split->axis < 0) return false;
    split->parts[0] = bins_union(bins->bin[split->axis], 0, split->bin);
    split->parts[1] = bins_union(bins->bin[split->axis], split->bin, count);
    return true;
}

uint32_t bvh_split_left_count(const struct bvh_split *split, const struct bvh_bins *bins) {
    uint32_t count = 0;
    for (int i = 0; i < split->bin; i++) count += bins->count[split->axis][i];
    return count;
}

void bvh_split_move(const struct bvh_split *split, const struct bvh_grid *grid, const struct bvh_record *records, uint32_t count,
                    struct bvh_record *left, struct bvh_record *right, struct bvh_extent extents[2]) {
    struct bvh_record *to[2] = {left, right};
    for (int side = 0; side < 2; side++) {
        extents[side] = bvh_extent_empty;
        memcpy(extents[side].min, split->parts[side].min, sizeof extents[side].min);
        memcpy(extents[side].max, split->parts[side].max, sizeof extents[side].max);
    }
    for (uint32_t i = 0; i < count; i++) {
        const struct bvh_record record = records[i];
        int side = bin_of(grid, &record, split->axis) >= split->bin;
        *to[side]++ = record;
        centroid_add(extents[side].low, extents[side].high, &record);
    }
}
