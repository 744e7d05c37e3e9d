#include "bvh/top.h"

#include <stdlib.h>
#include <string.h>

#include "base/threads.h"

// A set to split on the current level.
struct large {
    struct bvh_range range;
    uint32_t node;
    uint32_t first_chunk, chunk_count;
    struct bvh_grid grid;
    struct bvh_split split; // axis -1: to be cut in the middle instead
};

// A piece of a large set.
struct chunk {
    uint32_t large, begin, end;
    uint32_t left, right; // where its records are moved to
    struct bvh_bins bins;
    struct bvh_extent extents[2]; // of its records that go left and right
};

struct level {
    struct context *ctx;
    const struct bvh_workspace *workspace;
    struct bvh_watch *watch;
    struct bvh_top *out;
    struct large *large, *next;
    struct chunk *chunks;
    uint32_t large_count, next_count, chunk_count;
};

static void *array_grow(struct context *ctx, void *array, size_t count, size_t size) {
    void *grown = realloc(array, count * size);
    if (!grown) fail(ctx, GN_LIMIT, "no memory for the top of the BVH: %zu × %zu bytes", count, size);
    return grown;
}

// Room for so many more sets, each with its node, that may be small or large.
static bool level_reserve(struct level *level, size_t added) {
    struct bvh_top *out = level->out;
    struct bvh_node *nodes = array_grow(level->ctx, out->nodes, out->node_count + added, sizeof *nodes);
    if (!nodes) return false;
    out->nodes = nodes;
    struct bvh_small *small = array_grow(level->ctx, out->small, out->small_count + added, sizeof *small);
    if (!small) return false;
    out->small = small;
    level->next = array_alloc(level->ctx, added, sizeof *level->next, "BVH levels");
    return level->next != NULL;
}

static bool level_cut_into_chunks(struct level *level) {
    size_t count = 0;
    for (uint32_t i = 0; i < level->large_count; i++) count += (bvh_range_size(&level->large[i].range) - 1) / BVH_CHUNK_SIZE + 1;
    level->chunks = array_alloc(level->ctx, count, sizeof *level->chunks, "BVH bins");
    if (!level->chunks) return false;
    level->chunk_count = 0;
    for (uint32_t i = 0; i < level->large_count; i++) {
        struct large *large = &level->large[i];
        large->first_chunk = level->chunk_count;
        for (uint32_t begin = large->range.begin, end; begin < large->range.end; begin = end) {
            end = large->range.end - begin > BVH_CHUNK_SIZE ? begin + BVH_CHUNK_SIZE : large->range.end;
            level->chunks[level->chunk_count++] = (struct chunk){.large = i, .begin = begin, .end = end};
        }
        large->chunk_count = level->chunk_count - large->first_chunk;
    }
    return true;
}

static bool bin_chunks(void *data, size_t begin, size_t end, unsigned thread) {
    struct level *level = data;
    for (size_t i = begin; i < end; i++) {
        struct chunk *chunk = &level->chunks[i];
        const struct large *large = &level->large[chunk->large];
        const struct bvh_record *records = level->workspace->records[large->range.source];
        bvh_bins_clear(&chunk->bins, large->grid.bins);
        bvh_bins_add(&chunk->bins, &large->grid, &records[chunk->begin], chunk->end - chunk->begin);
    }
    return bvh_watch_go_on(level->watch, thread);
}

// Chooses the split of a large set, and the places its chunks are moved to.
static void large_plan(struct level *level, struct large *large) {
    struct chunk *chunks = &level->chunks[large->first_chunk];
    struct bvh_bins bins;
    bvh_bins_clear(&bins, large->grid.bins);
    for (uint32_t i = 0; i < large->chunk_count; i++) bvh_bins_merge(&bins, &chunks[i].bins, large->grid.bins);
    large->split.axis = -1;
    if (!bvh_depth_allows(level->workspace, large->range.depth, bvh_range_size(&large->range)) || !bvh_split_find(&large->split, &bins, large->grid.bins))
        return;
    uint32_t left = large->range.begin, right = left + large->split.left_count;
    for (uint32_t i = 0; i < large->chunk_count; i++) {
        uint32_t left_count = bvh_split_left_count(&large->split, &chunks[i].bins);
        chunks[i].left = left;
        chunks[i].right = right;
        left += left_count;
        right += chunks[i].end - chunks[i].begin - left_count;
    }
}

static uint32_t middle_of(const struct large *large) {
    uint32_t size = bvh_range_size(&large->range);
    return large->range.begin + (large->split.axis < 0 ? size / 2 : large->split.left_count);
}

// A cut leaves the records where they are: only the extents of what lies before and behind it are to be found.
static void chunk_cut(struct chunk *chunk, const struct bvh_record *records, uint32_t middle) {
    uint32_t cut = middle < chunk->begin ? chunk->begin : middle > chunk->end ? chunk->end : middle;
    chunk->extents[0] = chunk->extents[1] = bvh_extent_empty;
    bvh_extent_add(&chunk->extents[0], &records[chunk->begin], cut - chunk->begin);
    bvh_extent_add(&chunk->extents[1], &records[cut], chunk->end - cut);
}

static bool move_chunks(void *data, size_t begin, size_t end, unsigned thread) {
    struct level *level = data;
    for (size_t i = begin; i < end; i++) {
        struct chunk *chunk = &level->chunks[i];
        const struct large *large = &level->large[chunk->large];
        const struct bvh_record *from = level->workspace->records[large->range.source];
        struct bvh_record *to = level->workspace->records[1 - large->range.source];
        if (large->split.axis < 0)
            chunk_cut(chunk, from, middle_of(large));
        else
            bvh_split_move(&large->split, &large->grid, &from[chunk->begin], chunk->end - chunk->begin, &to[chunk->left], &to[chunk->right],
                           chunk->extents);
    }
    return bvh_watch_go_on(level->watch, thread);
}

static struct bvh_range part_of(const struct level *level, const struct large *large, int side) {
    struct bvh_range part = bvh_range_part(&large->range, side, middle_of(large), large->split.axis >= 0);
    for (uint32_t i = 0; i < large->chunk_count; i++) bvh_extent_merge(&part.extent, &level->chunks[large->first_chunk + i].extents[side]);
    return part;
}

// Puts a set where its size says. The node is complete but for a small set's, which the subtree fills.
static void range_enter(struct level *level, const struct bvh_range *range, uint32_t node) {
    if (bvh_range_size(range) > BVH_SUBTREE_SIZE)
        level->next[level->next_count++] = (struct large){.range = *range, .node = node};
    else
        level->out->small[level->out->small_count++] = (struct bvh_small){.range = *range, .node = node};
}

static void large_finish(struct level *level, const struct large *large) {
    struct bvh_top *out = level->out;
    struct bvh_node *node = &out->nodes[large->node];
    *node = (struct bvh_node){.first = out->node_count};
    memcpy(node->min, large->range.extent.min, sizeof node->min);
    memcpy(node->max, large->range.extent.max, sizeof node->max);
    out->node_count += 2;
    out->cost += BVH_NODE_COST * bvh_half_area(node->min, node->max);
    uint64_t work = bvh_work(bvh_range_size(&large->range));
    for (int side = 0; side < 2; side++) {
        struct bvh_range part = part_of(level, large, side);
        work -= bvh_work(bvh_range_size(&part));
        range_enter(level, &part, node->first + (uint32_t)side);
    }
    atomic_fetch_add(&level->watch->done, work);
}

// Splits the sets of one level; those of the next are in level->next.
static bool level_split(struct level *level) {
    unsigned threads = context_threads(level->ctx);
    if (!level_reserve(level, 2 * (size_t)level->large_count) || !level_cut_into_chunks(level)) return false;
    for (uint32_t i = 0; i < level->large_count; i++) level->large[i].grid = bvh_grid_make(&level->large[i].range.extent, BVH_MAX_BINS);
    if (!parallel_for(threads, level->chunk_count, 1, bin_chunks, level)) return false;
    for (uint32_t i = 0; i < level->large_count; i++) large_plan(level, &level->large[i]);
    if (!parallel_for(threads, level->chunk_count, 1, move_chunks, level)) return false;
    for (uint32_t i = 0; i < level->large_count; i++) large_finish(level, &level->large[i]);
    return true;
}

// Makes the next level the current one.
static void level_advance(struct level *level) {
    free(level->large);
    free(level->chunks);
    level->large = level->next;
    level->large_count = level->next_count;
    level->next = NULL;
    level->chunks = NULL;
    level->next_count = 0;
}

static void level_finish(struct level *level) {
    free(level->large);
    free(level->next);
    free(level->chunks);
}

bool bvh_top_build(struct bvh_top *out, struct context *ctx, const struct bvh_workspace *workspace, const struct bvh_range *root,
                   struct bvh_watch *watch) {
    *out = (struct bvh_top){0};
    struct level level = {.ctx = ctx, .workspace = workspace, .watch = watch, .out = out};
    if (!level_reserve(&level, 1)) goto fail;
    range_enter(&level, root, out->node_count++);
    for (level_advance(&level); level.large_count > 0; level_advance(&level))
        if (!level_split(&level)) goto fail;
    level_finish(&level);
    return true;
fail:
    level_finish(&level);
    bvh_top_finish(out);
    return false;
}

void bvh_top_finish(struct bvh_top *top) {
    free(top->nodes);
    free(top->small);
    *top = (struct bvh_top){0};
}
