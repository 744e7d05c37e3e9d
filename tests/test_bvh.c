// The hierarchy: its invariants on random and degenerate boxes, the same bits for any number of threads, queries against brute force,
// quality against a full sweep, cancelling, and missing memory.
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

// Ours before cmocka's: that has a macro called fail.
#include "bvh/bvh.h"

#include <cmocka.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED true
#else
#define SANITIZED false
#endif

// ---- families of boxes ----

// splitmix64 (Steele, Lea, Flood 2014).
static uint64_t random_bits(uint64_t *state) {
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static float random_unit(uint64_t *state) { return (float)(random_bits(state) >> 40) * 0x1p-24f; }

static uint32_t random_below(uint64_t *state, uint32_t limit) { return (uint32_t)(random_bits(state) % limit); }

typedef struct bvh_box make_box(uint32_t number, uint32_t count, uint64_t *state);

// A cube in the unit cube, its corner and side multiplied by `scale`.
static struct bvh_box cube(uint64_t *state, float side, float scale) {
    struct bvh_box box;
    for (int axis = 0; axis < 3; axis++) {
        box.min[axis] = (random_unit(state) - 0.5f) * scale;
        box.max[axis] = box.min[axis] + side * scale;
    }
    return box;
}

static struct bvh_box box_soup(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count;
    return cube(state, 0.01f, 1);
}
static struct bvh_box box_huge(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count;
    return cube(state, 0.01f, FLT_MAX);
}
static struct bvh_box box_all_over(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count;
    struct bvh_box box = cube(state, 0, FLT_MAX);
    for (int axis = 0; axis < 3; axis++) box.max[axis] = random_bits(state) % 2 ? FLT_MAX : box.max[axis];
    return box;
}
static struct bvh_box box_denormal(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count;
    return cube(state, 0.01f, 1e-40f);
}
static struct bvh_box box_any_size(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count;
    return cube(state, 0.1f, ldexpf(1, (int)random_below(state, 270) - 145));
}
static struct bvh_box box_infinite(uint32_t number, uint32_t count, uint64_t *state) {
    (void)count;
    struct bvh_box box = cube(state, 0.01f, 1);
    int axis = (int)(number % 3);
    if (random_below(state, 4) == 0) box.min[axis] = -INFINITY;
    if (random_below(state, 4) == 0) box.max[axis] = INFINITY;
    return box;
}
static struct bvh_box box_same(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count, (void)state;
    return (struct bvh_box){{1, 2, 3}, {4, 5, 6}};
}
static struct bvh_box box_point(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count, (void)state;
    return (struct bvh_box){{7, 7, 7}, {7, 7, 7}};
}
static struct bvh_box box_two_places(uint32_t number, uint32_t count, uint64_t *state) {
    (void)count, (void)state;
    float x = (float)(number % 2);
    return (struct bvh_box){{x, 0, 0}, {x, 0, 0}};
}
static struct bvh_box box_nested(uint32_t number, uint32_t count, uint64_t *state) {
    (void)count, (void)state;
    float half = (float)(number + 1);
    return (struct bvh_box){{-half, -half, -half}, {half, half, half}};
}
static struct bvh_box box_line(uint32_t number, uint32_t count, uint64_t *state) {
    (void)count, (void)state;
    return (struct bvh_box){{(float)number, 0, 0}, {(float)number, 0, 0}};
}
static struct bvh_box box_plane(uint32_t number, uint32_t count, uint64_t *state) {
    (void)count, (void)state;
    float x = (float)(number % 200), z = (float)(number / 200);
    return (struct bvh_box){{x, -0.0f, z}, {x + 1, 0.0f, z + 1}};
}
// Each twice as far as the one before, over and over: a tree wants to be as deep as there are exponents.
static struct bvh_box box_doubling(uint32_t number, uint32_t count, uint64_t *state) {
    (void)count, (void)state;
    float x = ldexpf(1 + 0.001f * (float)(number / 270), (int)(number % 270) - 145);
    return (struct bvh_box){{x, 0, 0}, {x, x, 0}};
}
// One enormous box among tiny ones.
static struct bvh_box box_stadium(uint32_t number, uint32_t count, uint64_t *state) {
    return number == count / 2 ? (struct bvh_box){{-1e38f, -1e38f, -1e38f}, {1e38f, 1e38f, 1e38f}} : cube(state, 0.01f, 1e-3f);
}
static struct bvh_box box_zeros(uint32_t number, uint32_t count, uint64_t *state) {
    (void)number, (void)count;
    struct bvh_box box;
    for (int axis = 0; axis < 3; axis++) {
        box.min[axis] = random_bits(state) % 2 ? -0.0f : 0.0f;
        box.max[axis] = random_bits(state) % 2 ? -0.0f : 0.0f;
    }
    return box;
}

struct family {
    const char *name;
    make_box *make;
    uint32_t count, split_at;
};

static const struct family families[] = {
    {"one", box_soup, 1, 1},
    {"one of the second kind", box_soup, 1, 0},
    {"two", box_soup, 2, 2},
    {"two kinds", box_soup, 2, 1},
    {"two kinds in one place", box_same, 2, 1},
    {"a full leaf", box_same, BVH_MAX_LEAF, BVH_MAX_LEAF},
    {"one more than a leaf", box_same, BVH_MAX_LEAF + 1, BVH_MAX_LEAF + 1},
    {"largest subtree", box_soup, 4096, 4096},
    {"smallest top", box_soup, 4097, 4097},
    {"soup", box_soup, 40000, 40000},
    {"soup of two kinds", box_soup, 18000, 9000},
    {"soup and one of the second kind", box_soup, 18000, 17999},
    {"huge", box_huge, 18000, 9000},
    {"all over", box_all_over, 18000, 9000},
    {"denormal", box_denormal, 18000, 9000},
    {"of any size", box_any_size, 18000, 13500},
    {"infinite", box_infinite, 18000, 9000},
    {"all the same", box_same, 18000, 18000},
    {"all the same, two kinds", box_same, 18000, 5555},
    {"one point", box_point, 18000, 9000},
    {"two places", box_two_places, 18000, 7},
    {"nested", box_nested, 18000, 9000},
    {"line", box_line, 18000, 18000},
    {"plane", box_plane, 18000, 18000},
    {"doubling", box_doubling, 18000, 18000},
    {"stadium", box_stadium, 18000, 18000},
    {"zeros of both signs", box_zeros, 18000, 9000},
    {"coincident, a million", box_same, 1000000, 1000000},
};
#define FAMILY_COUNT (sizeof families / sizeof families[0])

static struct bvh_box *family_boxes(const struct family *family) {
    uint64_t state = 1;
    struct bvh_box *boxes = malloc(family->count * sizeof *boxes);
    assert_non_null(boxes);
    for (uint32_t i = 0; i < family->count; i++) boxes[i] = family->make(i, family->count, &state);
    return boxes;
}

static struct bvh built(const struct bvh_box *boxes, uint32_t count, uint32_t split_at, unsigned threads) {
    struct gn_host host = {.threads = threads};
    struct gn_error error;
    struct context ctx = context_make(&host, &error);
    struct bvh bvh;
    if (!bvh_build(&bvh, &ctx, boxes, count, &(struct bvh_params){.split_at = split_at})) fail_msg("%s", error.message);
    return bvh;
}

// ---- invariants and determinism ----

static void assert_same_tree(const struct bvh *a, const struct bvh *b) {
    assert_int_equal(a->node_count, b->node_count);
    assert_memory_equal(a->nodes, b->nodes, a->node_count * sizeof *a->nodes);
    assert_memory_equal(a->order, b->order, a->primitive_count * sizeof *a->order);
    assert_true(a->sah_cost == b->sah_cost);
    assert_int_equal(a->depth, b->depth);
}

static void test_families(void **unused) {
    (void)unused;
    for (size_t i = 0; i < FAMILY_COUNT; i++) {
        const struct family *family = &families[i];
        struct bvh_box *boxes = family_boxes(family);
        struct bvh_params params = {.split_at = family->split_at};
        struct bvh first = built(boxes, family->count, family->split_at, 1);
        char why[256] = "";
        if (!bvh_check(&first, boxes, &params, why, sizeof why)) fail_msg("%s: %s", family->name, why);
        assert_true(isfinite(first.sah_cost));
        unsigned most_threads = family->count > 100000 ? 2 : 5;
        for (unsigned threads = 2; threads <= most_threads; threads++) {
            struct bvh other = built(boxes, family->count, family->split_at, threads);
            assert_same_tree(&first, &other);
            bvh_finish(&other);
        }
        bvh_finish(&first);
        free(boxes);
    }
}

static void test_empty(void **unused) {
    (void)unused;
    struct bvh bvh = built(NULL, 0, 0, 2);
    char why[256] = "";
    assert_int_equal(bvh.node_count, 0);
    assert_true(bvh_check(&bvh, NULL, &(struct bvh_params){0}, why, sizeof why));
    bvh_finish(&bvh);
}

// Some family must come close to the deepest tree, or the bound was not tried.
static void test_depth_is_tried(void **unused) {
    (void)unused;
    uint32_t deepest = 0;
    for (size_t i = 0; i < FAMILY_COUNT; i++) {
        if (families[i].count > 100000) continue;
        struct bvh_box *boxes = family_boxes(&families[i]);
        struct bvh bvh = built(boxes, families[i].count, families[i].split_at, 2);
        if (bvh.depth > deepest) deepest = bvh.depth;
        bvh_finish(&bvh);
        free(boxes);
    }
    print_message("deepest tree: %u\n", deepest);
    assert_in_range(deepest, 45, BVH_MAX_DEPTH);
}

// ---- bvh_check itself: every kind of damage is found ----

static void damage_nothing(struct bvh *bvh) { (void)bvh; }
static void damage_order_twice(struct bvh *bvh) { bvh->order[1] = bvh->order[0]; }
static void damage_order_far(struct bvh *bvh) { bvh->order[1] = bvh->primitive_count; }
static void damage_order_swap(struct bvh *bvh) {
    uint32_t last = bvh->primitive_count - 1, swap = bvh->order[0];
    bvh->order[0] = bvh->order[last];
    bvh->order[last] = swap;
}
static struct bvh_node *first_leaf(struct bvh *bvh) {
    uint32_t i = 0;
    while (bvh->nodes[i].count == 0) i++;
    return &bvh->nodes[i];
}
static void damage_leaf_first(struct bvh *bvh) { first_leaf(bvh)->first = bvh->primitive_count; }
static void damage_leaf_large(struct bvh *bvh) { first_leaf(bvh)->count = BVH_MAX_LEAF + 1; }
static void damage_leaf_less(struct bvh *bvh) { first_leaf(bvh)->first++; }
static void damage_leaf_box(struct bvh *bvh) { first_leaf(bvh)->min[1] = nextafterf(first_leaf(bvh)->min[1], -INFINITY); }
static void damage_nan(struct bvh *bvh) { first_leaf(bvh)->max[2] = NAN; }
static void damage_box(struct bvh *bvh) { bvh->nodes[0].max[0] = nextafterf(bvh->nodes[0].max[0], INFINITY); }
static void damage_child(struct bvh *bvh) { bvh->nodes[0].first = bvh->node_count - 1; }
static void damage_cycle(struct bvh *bvh) { bvh->nodes[bvh->nodes[0].first].first = 0; }
static void damage_depth(struct bvh *bvh) { bvh->depth++; }
static void damage_cost(struct bvh *bvh) { bvh->sah_cost = NAN; }
static void damage_node_count(struct bvh *bvh) { bvh->node_count--; }

static const struct {
    const char *name;
    void (*damage)(struct bvh *bvh);
    bool right;
} damages[] = {
    {"nothing", damage_nothing, true},
    {"a primitive twice", damage_order_twice, false},
    {"a primitive that is not there", damage_order_far, false},
    {"two primitives swapped", damage_order_swap, false},
    {"a leaf behind the order", damage_leaf_first, false},
    {"a large leaf", damage_leaf_large, false},
    {"a leaf moved", damage_leaf_less, false},
    {"a leaf's box too large", damage_leaf_box, false},
    {"NaN", damage_nan, false},
    {"the root's box too large", damage_box, false},
    {"a child that is not there", damage_child, false},
    {"a cycle", damage_cycle, false},
    {"the depth", damage_depth, false},
    {"the cost", damage_cost, false},
    {"a node less", damage_node_count, false},
};

static void test_check_finds_damage(void **unused) {
    (void)unused;
    const struct family family = {"plane", box_plane, 1000, 500};
    struct bvh_box *boxes = family_boxes(&family);
    for (size_t i = 0; i < sizeof damages / sizeof damages[0]; i++) {
        struct bvh bvh = built(boxes, family.count, family.split_at, 1);
        char why[256] = "";
        damages[i].damage(&bvh);
        bool right = bvh_check(&bvh, boxes, &(struct bvh_params){.split_at = family.split_at}, why, sizeof why);
        if (right != damages[i].right) fail_msg("%s: %s", damages[i].name, right ? "not found" : why);
        bvh_finish(&bvh);
    }
    free(boxes);
}

static void test_check_finds_mixed_kinds(void **unused) {
    (void)unused;
    const struct family family = {"all the same", box_same, 8, 8};
    struct bvh_box *boxes = family_boxes(&family);
    struct bvh bvh = built(boxes, family.count, family.split_at, 1);
    char why[256] = "";
    assert_true(bvh_check(&bvh, boxes, &(struct bvh_params){.split_at = 8}, why, sizeof why));
    assert_false(bvh_check(&bvh, boxes, &(struct bvh_params){.split_at = 7}, why, sizeof why));
    bvh_finish(&bvh);
    free(boxes);
}

// ---- queries ----

static bool overlap(const float a_min[3], const float a_max[3], const struct bvh_box *b) {
    for (int axis = 0; axis < 3; axis++)
        if (a_max[axis] < b->min[axis] || b->max[axis] < a_min[axis]) return false;
    return true;
}

struct found {
    uint64_t count, sum;
};

static void found_add(struct found *found, uint32_t primitive) {
    found->count++;
    found->sum += (uint64_t)primitive * primitive;
}

static struct found find_in_tree(const struct bvh *bvh, const struct bvh_box *boxes, const struct bvh_box *query) {
    struct found found = {0};
    uint32_t stack[BVH_MAX_DEPTH + 1], size = 0;
    stack[size++] = 0;
    while (size > 0) {
        const struct bvh_node *node = &bvh->nodes[stack[--size]];
        if (!overlap(node->min, node->max, query)) continue;
        for (uint32_t i = 0; i < node->count; i++) {
            const struct bvh_box *box = &boxes[bvh->order[node->first + i]];
            if (overlap(box->min, box->max, query)) found_add(&found, bvh->order[node->first + i]);
        }
        if (node->count > 0) continue;
        stack[size++] = node->first + 1;
        stack[size++] = node->first;
    }
    return found;
}

static struct found find_by_force(const struct bvh_box *boxes, uint32_t count, const struct bvh_box *query) {
    struct found found = {0};
    for (uint32_t i = 0; i < count; i++)
        if (overlap(boxes[i].min, boxes[i].max, query)) found_add(&found, i);
    return found;
}

// Small and large, in the units of the family: from the corner of one primitive to that of another, or to its own opposite.
static struct bvh_box random_query(const struct bvh_box *boxes, uint32_t count, uint64_t *state) {
    const struct bvh_box *a = &boxes[random_below(state, count)];
    const struct bvh_box *b = random_below(state, 2) ? a : &boxes[random_below(state, count)];
    struct bvh_box query;
    for (int axis = 0; axis < 3; axis++) {
        query.min[axis] = fminf(a->max[axis], b->min[axis]);
        query.max[axis] = fmaxf(a->max[axis], b->min[axis]);
    }
    return query;
}

static void test_queries(void **unused) {
    (void)unused;
    uint64_t state = 2, total = 0;
    for (size_t i = 0; i < FAMILY_COUNT; i++) {
        if (families[i].count > 100000) continue;
        struct bvh_box *boxes = family_boxes(&families[i]);
        struct bvh bvh = built(boxes, families[i].count, families[i].split_at, 2);
        for (int j = 0; j < 40; j++) {
            struct bvh_box query = random_query(boxes, families[i].count, &state);
            struct found tree = find_in_tree(&bvh, boxes, &query), force = find_by_force(boxes, families[i].count, &query);
            if (tree.count != force.count || tree.sum != force.sum) fail_msg("%s: a query lost a primitive", families[i].name);
            total += force.count;
        }
        bvh_finish(&bvh);
        free(boxes);
    }
    assert_true(total > 1000);
}

// ---- quality ----

// A terrain of hills, its triangles in random order.
static struct bvh_box *terrain_boxes(uint32_t side, uint32_t *count) {
    uint64_t state = 3;
    *count = 2 * side * side;
    struct bvh_box *boxes = malloc(*count * sizeof *boxes);
    assert_non_null(boxes);
    for (uint32_t i = 0; i < *count; i++) {
        boxes[i] = (struct bvh_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (uint32_t corner = 0; corner < 3; corner++) {
            uint32_t step = corner + i % 2; // of the corners (0,0) (1,0) (0,1) (1,1), the first or the last three
            float x = (float)(i / 2 % side + step % 2) / (float)side, z = (float)(i / 2 / side + step / 2) / (float)side;
            float point[3] = {x, 0.1f * sinf(20 * x) * sinf(15 * z), z};
            for (int axis = 0; axis < 3; axis++) {
                boxes[i].min[axis] = fminf(boxes[i].min[axis], point[axis]);
                boxes[i].max[axis] = fmaxf(boxes[i].max[axis], point[axis]);
            }
        }
    }
    for (uint32_t i = *count - 1; i > 0; i--) {
        uint32_t j = random_below(&state, i + 1);
        struct bvh_box swap = boxes[i];
        boxes[i] = boxes[j];
        boxes[j] = swap;
    }
    return boxes;
}

static double half_area(const struct bvh_box *box) {
    double size[3];
    for (int axis = 0; axis < 3; axis++) size[axis] = (double)box->max[axis] - (double)box->min[axis];
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

static struct bvh_box union_of(const struct bvh_box *boxes, uint32_t count) {
    struct bvh_box all = boxes[0];
    for (uint32_t i = 1; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            all.min[axis] = fminf(all.min[axis], boxes[i].min[axis]);
            all.max[axis] = fmaxf(all.max[axis], boxes[i].max[axis]);
        }
    }
    return all;
}

static int compare_centroids(const struct bvh_box *a, const struct bvh_box *b, int axis) {
    double x = (double)a->min[axis] + (double)a->max[axis], y = (double)b->min[axis] + (double)b->max[axis];
    return (x > y) - (x < y);
}
static int compare_x(const void *a, const void *b) { return compare_centroids(a, b, 0); }
static int compare_y(const void *a, const void *b) { return compare_centroids(a, b, 1); }
static int compare_z(const void *a, const void *b) { return compare_centroids(a, b, 2); }
static int (*const comparisons[3])(const void *, const void *) = {compare_x, compare_y, compare_z};

// The best split of sorted boxes into the first *left and the others, by trying all.
static double best_split(const struct bvh_box *boxes, uint32_t count, uint32_t *left) {
    double *areas = malloc(count * sizeof *areas), best = INFINITY;
    assert_non_null(areas);
    struct bvh_box box = boxes[count - 1];
    for (uint32_t i = count - 1; i > 0; i--) {
        box = union_of((struct bvh_box[]){box, boxes[i]}, 2);
        areas[i] = half_area(&box) * (count - i);
    }
    box = boxes[0];
    for (uint32_t i = 1; i < count; i++) {
        box = union_of((struct bvh_box[]){box, boxes[i - 1]}, 2);
        double cost = half_area(&box) * i + areas[i];
        if (cost < best) *left = i;
        if (cost < best) best = cost;
    }
    free(areas);
    return best;
}

// Cost of a plain tree: by a full sweep of all axes, or by medians of the axes in turn. Reorders the boxes.
static double plain_cost(struct bvh_box *boxes, uint32_t count, bool sweep, int turn) {
    struct bvh_box all = union_of(boxes, count);
    double area = half_area(&all), best = sweep ? INFINITY : 0;
    uint32_t left = count / 2;
    int best_axis = turn;
    if (count == 1) return area;
    for (int axis = 0; sweep && axis < 3; axis++) {
        uint32_t axis_left = 0;
        qsort(boxes, count, sizeof *boxes, comparisons[axis]);
        double cost = best_split(boxes, count, &axis_left);
        if (!(cost < best)) continue;
        best = cost;
        best_axis = axis;
        left = axis_left;
    }
    if (count <= (sweep ? BVH_MAX_LEAF : 2) && area * count <= area + best) return area * count;
    qsort(boxes, count, sizeof *boxes, comparisons[best_axis]);
    return area + plain_cost(boxes, left, sweep, (turn + 1) % 3) + plain_cost(&boxes[left], count - left, sweep, (turn + 1) % 3);
}

static void test_quality(void **unused) {
    (void)unused;
    uint32_t count;
    struct bvh_box *boxes = terrain_boxes(60, &count);
    struct bvh bvh = built(boxes, count, count, 2);
    struct bvh_box root = union_of(boxes, count);
    double sweep = plain_cost(boxes, count, true, 0) / half_area(&root), median = plain_cost(boxes, count, false, 0) / half_area(&root);
    print_message("SAH cost: ours %.3f, full sweep %.3f, medians %.3f\n", bvh.sah_cost, sweep, median);
    const double limit = 1.03 * sweep;
    assert_true(bvh.sah_cost <= limit);
    assert_false(median <= limit);
    bvh_finish(&bvh);
    free(boxes);
}

// ---- progress, cancelling, memory ----

struct witness {
    uint32_t calls, stop_at; // the call that says no; 0: none
    double last;             // fraction
    clock_t stopped;         // processor time at the last call
    bool forward;            // no fraction was less than the one before
};

static bool witness_progress(void *user, const struct gn_progress *state) {
    struct witness *witness = user;
    witness->calls++;
    if (strcmp(state->stage, "bvh") != 0 || !(state->fraction >= witness->last && state->fraction <= 1)) witness->forward = false;
    witness->last = state->fraction;
    witness->stopped = clock();
    return witness->calls != witness->stop_at;
}

#define WATCHED (SANITIZED ? 50000 : 400000)

// Builds, and cancels at report number `stop_at`. Returns whether it was done; *late is the processor time, in seconds, after the last
// report.
static bool watched_build(const struct bvh_box *boxes, uint32_t stop_at, double *late) {
    struct witness witness = {.stop_at = stop_at, .forward = true};
    struct gn_host host = {.user = &witness, .progress = witness_progress, .threads = 1 + stop_at % 3};
    struct gn_error error;
    struct context ctx = context_make(&host, &error);
    struct bvh bvh;
    bool done = bvh_build(&bvh, &ctx, boxes, WATCHED, &(struct bvh_params){.split_at = WATCHED});
    *late = (double)(clock() - witness.stopped) / CLOCKS_PER_SEC;
    assert_true(witness.forward);
    assert_int_equal(error.status, done ? GN_OK : GN_CANCELLED);
    if (done) assert_true(witness.last == 1 && witness.calls >= 2);
    if (!done) assert_true(witness.calls == stop_at && bvh.nodes == NULL && bvh.order == NULL && bvh.node_count == 0);
    bvh_finish(&bvh);
    return done;
}

// Cancels at the first report, at the second, …, until a build gets through; each time at once.
static void test_cancel(void **unused) {
    (void)unused;
    const struct family family = {"soup", box_soup, WATCHED, WATCHED};
    struct bvh_box *boxes = family_boxes(&family);
    clock_t start = clock();
    double late;
    assert_true(watched_build(boxes, 0, &late));
    const double limit = 0.25 * (double)(clock() - start) / CLOCKS_PER_SEC;
    for (uint32_t stop_at = 1; !watched_build(boxes, stop_at, &late); stop_at++)
        if (!(late <= limit)) fail_msg("cancelled %g s late", late);
    free(boxes);
}

static bool build_within(const struct bvh_box *boxes, size_t bytes) {
    struct rlimit old;
    struct gn_error error;
    struct context ctx = context_make(&(struct gn_host){.threads = 2}, &error);
    struct bvh bvh;
    assert_int_equal(getrlimit(RLIMIT_AS, &old), 0);
    assert_int_equal(setrlimit(RLIMIT_AS, &(struct rlimit){.rlim_cur = bytes, .rlim_max = old.rlim_max}), 0);
    bool done = bvh_build(&bvh, &ctx, boxes, WATCHED, &(struct bvh_params){.split_at = WATCHED});
    assert_int_equal(setrlimit(RLIMIT_AS, &old), 0);
    assert_int_equal(error.status, done ? GN_OK : GN_LIMIT);
    if (!done) assert_true(strstr(error.message, "no memory for") && bvh.nodes == NULL && bvh.order == NULL && bvh.node_count == 0);
    bvh_finish(&bvh);
    return done;
}

// Builds with more and more memory: each step must either report what is missing or be complete.
static void test_memory(void **unused) {
    (void)unused;
    if (SANITIZED) skip();
    const struct family family = {"soup", box_soup, WATCHED, WATCHED};
    struct bvh_box *boxes = family_boxes(&family);
    unsigned long pages = 0;
    FILE *statm = fopen("/proc/self/statm", "r");
    if (!statm || fscanf(statm, "%lu", &pages) != 1) skip();
    fclose(statm);
    uint32_t failed = 0;
    for (size_t extra = 0; !build_within(boxes, pages * 4096 + extra); extra += 2 << 20) failed++;
    assert_in_range(failed, 5, 200);
    free(boxes);
}

static void test_too_many(void **unused) {
    (void)unused;
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct bvh bvh;
    assert_false(bvh_build(&bvh, &ctx, NULL, UINT32_MAX, &(struct bvh_params){0}));
    assert_int_equal(error.status, GN_LIMIT);
    assert_int_equal(bvh.node_count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory), // first: others leave free memory in the heap
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_families),
        cmocka_unit_test(test_depth_is_tried),
        cmocka_unit_test(test_queries),
        cmocka_unit_test(test_quality),
        cmocka_unit_test(test_check_finds_damage),
        cmocka_unit_test(test_check_finds_mixed_kinds),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_too_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
