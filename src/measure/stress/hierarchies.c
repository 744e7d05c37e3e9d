// Rows of hierarchies: that none of them changes what is hit, that the worst input is built, and that no ray takes for ever.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "bvh/scene_boxes.h"
#include "measure/stress/fill.h"
#include "measure/stress/shoot.h"

// A world on the way to the device. Zeroed is empty.
struct site {
    struct world world;
    struct scene scene;
    struct bvh bvh;
    struct gn_hit *hits;
};

static void site_finish(struct site *site) {
    world_finish(&site->world);
    scene_finish(&site->scene);
    bvh_finish(&site->bvh);
    free(site->hits);
}

// From site->world.
static bool site_make(struct site *site, struct stress *s, bool random_tree) {
    if (!world_ok(&site->world, s->ctx) || !world_scene(&site->scene, s->ctx, &site->world)) return false;
    site->hits = array_alloc(s->ctx, site->world.ray_count, sizeof *site->hits, "hits");
    return site->hits && (random_tree ? world_random_bvh(&site->bvh, s->ctx, &site->scene, &s->random)
                                      : bvh_build_scene(&site->bvh, s->ctx, &site->scene));
}

static bool site_shoot(struct site *site, struct stress *s, uint32_t tier, double *ms) {
    const struct shot shot = {
        .scene = &site->scene, .bvh = &site->bvh, .rays = site->world.rays, .count = site->world.ray_count, .tier = tier};
    return shoot(site->hits, ms, s, &shot);
}

static void compare(struct tally *tally, const struct site *right, const struct site *got, const char *what) {
    for (uint32_t i = 0; i < got->world.ray_count; i++) {
        const struct gn_hit *a = &right->hits[i], *b = &got->hits[i];
        tally->rays++;
        if (a->object != b->object || a->primitive != b->primitive || memcmp(&a->t, &b->t, sizeof a->t) != 0)
            tally_wrong(tally, "ray %u, %s: was %d/%d t %.9g, is %d/%d t %.9g", i, what, a->object, a->primitive, a->t, b->object,
                        b->primitive, b->t);
    }
}

// ------------------------------------------------------------------------------------------------------------ B11, B14

static bool displaced_ball(struct world *world, struct stress *s, uint32_t rays) {
    const double center[3] = {0.5, -0.25, 0};
    fill_ball(world, &s->random, 24, 48, 1, 0.1, center);
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        const float *v = world->vertices[random_below(&s->random, world->vertex_count)];
        double direction[3], p[3];
        float o[3];
        random_direction(direction, &s->random);
        for (int k = 0; k < 3; k++)
            o[k] = (float)(center[k] + 3 * direction[k]), p[k] = v[k] + (i % 2 ? 0 : random_in(&s->random, -0.1, 0.1));
        world_aim(world, o, p);
        if (!world->failed) world->rays[i].tmax = 4; // far beyond the ball, short of what is unrelated to it
    }
    return world_ok(world, s->ctx);
}

// B11: hierarchies at random, and an unrelated mesh behind everything: the same hits to the bit.
bool hierarchies_same_hits(struct stress *s) {
    enum { TREES = 6 };
    struct site plain = {0};
    bool done = displaced_ball(&plain.world, s, s->rays / TREES + 1) && site_make(&plain, s, false);
    for (int i = 0; done && i < TREES; i++) {
        struct site other = {0};
        done = world_copy(&other.world, s->ctx, &plain.world);
        other.world.mesh = 1;
        if (done && i % 2)
            for (int k = 0; k < 40; k++) world_lone_triangle(&other.world, (float[9]){50.0f + (float)k, 0, 9, 51, (float)k, 9, 50, 1, 60});
        done = done && site_make(&other, s, i > 0);
        for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
            if (!s->judged[tier]) continue;
            done = site_shoot(&plain, s, tier, &s->tally[tier].ms) && site_shoot(&other, s, tier, &s->tally[tier].ms);
            if (done) compare(&s->tally[tier], &plain, &other, i % 2 ? "with an unrelated mesh" : "in another hierarchy");
        }
        site_finish(&other);
    }
    site_finish(&plain);
    return done;
}

// B14: rays in the faces of boxes, in a batch and each alone: the lanes beside a ray change nothing.
bool hierarchies_lanes(struct stress *s) {
    struct site all = {0};
    fill_flat_boxes(&all.world, &s->random, 128, 0);
    bool done = site_make(&all, s, false);
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        if (!s->judged[tier]) continue;
        done = site_shoot(&all, s, tier, &s->tally[tier].ms);
        for (uint32_t i = 0; done && i < all.world.ray_count; i++) {
            struct gn_hit alone;
            const struct shot shot = {.scene = &all.scene, .bvh = &all.bvh, .rays = &all.world.rays[i], .count = 1, .tier = tier};
            done = shoot(&alone, &s->tally[tier].ms, s, &shot);
            s->tally[tier].rays++;
            if (done && memcmp(&alone, &all.hits[i], sizeof alone) != 0)
                tally_wrong(&s->tally[tier], "ray %u in a batch: %d/%d, alone %d/%d", i, all.hits[i].object, all.hits[i].primitive,
                            alone.object, alone.primitive);
        }
    }
    site_finish(&all);
    return done;
}

// ----------------------------------------------------------------------------------------------------------- B09, B12

// B09: nodes of all the worlds there are have ordered boxes of numbers: no ray meets a NaN or an inverted one.
bool hierarchies_sound_nodes(struct stress *s) {
    void (*const fills[])(struct world *, struct random *, uint32_t, uint32_t) = {
        fill_flat_boxes, fill_huge_extents, fill_degenerate, fill_tiny_sphere, fill_grains, fill_far_thing, fill_bounds_of_t};
    struct tally tally = {0};
    bool done = true;
    for (size_t i = 0; done && i < sizeof fills / sizeof *fills; i++) {
        struct site site = {0};
        fills[i](&site.world, &s->random, 1, 0);
        world_fuzz(&site.world, &s->random, 3);
        done = site_make(&site, s, false);
        for (uint32_t k = 0; done && k < site.bvh.node_count; k++) {
            tally.rays++;
            for (int axis = 0; axis < 3; axis++)
                if (!(site.bvh.nodes[k].min[axis] <= site.bvh.nodes[k].max[axis]))
                    tally_wrong(&tally, "world %zu, node %u: from %g to %g", i, k, site.bvh.nodes[k].min[axis],
                                site.bvh.nodes[k].max[axis]);
        }
        site_finish(&site);
    }
    snprintf(tally.note, sizeof tally.note, "no node is NaN or inverted");
    tally_every(s, &tally);
    return done;
}

// B12: a million boxes with one middle.
bool hierarchies_coincident(struct stress *s) {
    const uint32_t count = s->rays < FEW_RAYS ? 100000 : 1000000;
    struct bvh_box *boxes = array_alloc(s->ctx, count, sizeof *boxes, "boxes");
    struct bvh bvh = {0};
    struct tally tally = {.rays = count};
    char why[160];
    for (uint32_t i = 0; boxes && i < count; i++) {
        float half = i % 3 ? 1 : (float)(i % 7);
        boxes[i] = (struct bvh_box){{1 - half, 2 - half, 3 - half}, {1 + half, 2 + half, 3 + half}};
    }
    const struct bvh_params params = {.split_at = count};
    bool done = boxes && bvh_build(&bvh, s->ctx, boxes, count, &params);
    if (done && !bvh_check(&bvh, boxes, &params, why, sizeof why)) tally_wrong(&tally, "%s", why);
    if (done) snprintf(tally.note, sizeof tally.note, "depth %u of %u", bvh.depth, BVH_MAX_DEPTH);
    bvh_finish(&bvh);
    free(boxes);
    tally_every(s, &tally);
    return done;
}

// ------------------------------------------------------------------------------------------------------------------ B17

// A city of axis-aligned walls and floors: `side`² squares in each of three directions.
static void city(struct world *world, uint32_t side) {
    for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < side * side; i++) {
            uint32_t first = world->vertex_count;
            double at[3];
            for (int corner = 0; corner < 4; corner++) {
                at[k] = (double)(i * 7 % side);
                at[(k + 1) % 3] = (double)(i / side) + (corner == 1 || corner == 2);
                at[(k + 2) % 3] = (double)(i % side) + (corner >= 2);
                world_vertex(world, at[0], at[1], at[2]);
            }
            world_triangle(world, first, first + 1, first + 2);
            world_triangle(world, first, first + 2, first + 3);
        }
}

// Rays along the axes, beside planes and edges of the city; or, `askew`, tilted by a few degrees.
static void city_rays(struct world *world, struct random *random, uint32_t side, uint32_t rays, bool askew) {
    world->ray_count = 0;
    for (uint32_t i = 0; i < rays && !world->failed; i++) {
        float o[3], d[3];
        int axis = (int)(i % 3);
        for (int k = 0; k < 3; k++) {
            o[k] = (float)random_below(random, 2 * side) * 0.5f + 0.0625f * (float)(k + 2);
            d[k] = askew ? (float)random_in(random, -0.1, 0.1) : 0;
        }
        d[axis] = 1;
        o[axis] = -1;
        world_ray(world, o, d, 0, INFINITY);
    }
}

// The least of some times of each kind of ray, in ms; one after the other, so that what else the machine does falls on both.
static bool time_rays(double *straight, double *askew, struct site *site, struct stress *s, uint32_t tier, uint32_t side, uint32_t rays) {
    *straight = *askew = INFINITY;
    for (int i = 0; i < 14; i++) {
        double ms = 0, *least = i % 2 ? askew : straight;
        city_rays(&site->world, &s->random, side, rays, i % 2);
        if (!site_shoot(site, s, tier, &ms)) return false;
        *least = fmin(*least, ms);
    }
    return true;
}

// B17: rays along the axes of an axis-aligned mesh take no more than 2.5 times as long as others.
bool hierarchies_along_axes(struct stress *s) {
    const uint32_t side = s->rays < FEW_RAYS ? 24 : 64, rays = s->rays < FEW_RAYS ? 1000 : 8000;
    struct site site = {0};
    city(&site.world, side);
    city_rays(&site.world, &s->random, side, rays, false);
    bool done = site_make(&site, s, false);
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        double straight, askew;
        if (!s->judged[tier]) continue;
        done = time_rays(&straight, &askew, &site, s, tier, side, rays);
        if (!done) break;
        struct tally *tally = &s->tally[tier];
        tally->rays = 2 * rays;
        tally->ms = straight + askew;
        snprintf(tally->note, sizeof tally->note, "along axes %.2f times as long as askew", straight / askew);
        if (!(straight <= 2.5 * askew)) tally_wrong(tally, "%.3g ms along axes, %.3g ms askew", straight, askew);
    }
    site_finish(&site);
    return done;
}
