// Rows of rays: a small world is filled, varied in all the ways that leave the question the same, shot at through the library's own
// path in every tier, and judged by the oracle ray by ray.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bvh/scene_boxes.h"
#include "measure/stress/oracle.h"
#include "measure/stress/row.h"
#include "measure/stress/shoot.h"

// ------------------------------------------------------------------------------------------------------------- variants

static bool vary_nothing(struct world *world, struct random *random) {
    (void)world, (void)random;
    return true;
}

static bool vary_numbers(struct world *world, struct random *random) {
    world_fuzz(world, random, 3);
    return true;
}

// A scale of 2^±60, or as near to that as the world's numbers allow.
static bool vary_scale(struct world *world, struct random *random) {
    int sign = random_bits(random) & 1 ? 1 : -1;
    for (int k = 60; k > 0; k -= 7)
        if (world_scale(world, sign * k)) return true;
    return world_scale(world, -sign * 10);
}

static bool vary_axes(struct world *world, struct random *random) {
    world_turn(world, random_below(random, 48));
    world_shuffle(world, random);
    return true;
}

static bool vary_clutter(struct world *world, struct random *random) {
    world_clutter(world, random, 64);
    return true;
}

// How a world is varied, and what that leaves to compare with.
struct variant {
    bool (*vary)(struct world *world, struct random *random);
    bool fuzz;      // moves numbers
    bool same_hits; // the plain world's hits are to come out again
    bool random_tree;
    bool any; // occlusion is shot, too
};

static const struct variant variants[] = {
    {vary_nothing, .any = true},
    {vary_scale, .same_hits = true},
    {vary_scale, .same_hits = true},
    {vary_nothing, .same_hits = true, .random_tree = true},
    {.vary = vary_axes},
    {vary_axes, .random_tree = true},
    {.vary = vary_clutter},
    {vary_numbers, .fuzz = true, .any = true},
    {vary_numbers, .fuzz = true},
    {vary_numbers, .fuzz = true, .random_tree = true},
    {vary_numbers, .fuzz = true},
};

enum { VARIANTS = sizeof variants / sizeof *variants };

// --------------------------------------------------------------------------------------------------------------- judging

static void describe(char *text, size_t capacity, const struct gn_ray *ray, const struct oracle_answer *right, const struct gn_hit *hit) {
    snprintf(text, capacity, "o (%a, %a, %a) d (%a, %a, %a): right %d/%d t %.9g, got %d/%d t %.9g%s", ray->origin[0], ray->origin[1],
             ray->origin[2], ray->direction[0], ray->direction[1], ray->direction[2], right->object, right->primitive, right->t,
             hit->object, hit->primitive, hit->t, hit->flags & GN_HIT_INVALID ? " (invalid)" : "");
}

// The largest error of t, u and v in fp32 places.
static double number_error(const struct oracle_answer *right, const struct gn_hit *hit) {
    return fmax(oracle_ulps(hit->t, right->t), fmax(oracle_ulps(hit->u, right->u), oracle_ulps(hit->v, right->v)));
}

static bool decision_is_right(const struct oracle_answer *right, const struct gn_hit *hit, bool any) {
    bool flagged = (hit->flags & GN_HIT_INVALID) != 0;
    if (flagged == right->valid) return false;
    if (any) return hit->object == (right->hit ? 0 : -1);
    return hit->object == right->object && hit->primitive == right->primitive && (right->hit || (isinf(hit->t) && hit->t > 0));
}

// Whether a wrong answer shows a hole: it misses, or hits far behind, a surface that the line goes through. Where the line enters and
// leaves at about one t it grazes an edge that it may as well pass by.
static bool is_leak(const struct world *world, const struct gn_ray *ray, const struct oracle_answer *right, const struct gn_hit *hit,
                    bool any) {
    bool behind = !any && hit->t > 1.001 * right->t && oracle_ulps(hit->t, right->t) > 8;
    if (!right->hit || (hit->object >= 0 && !behind)) return false;
    struct gn_ray there = *ray;
    there.tmin = fmaxf(ray->tmin, (float)(0.999 * right->t));
    there.tmax = fminf(ray->tmax, (float)(1.001 * right->t));
    return oracle_crossings(world, &there) % 2 == 1;
}

static void judge(struct tally *tally, uint32_t tier, bool closed, const struct world *world, const struct oracle_answer *answers,
                  const struct gn_hit *hits, bool any) {
    for (uint32_t i = 0; i < world->ray_count; i++) {
        const struct oracle_answer *right = &answers[i];
        const struct gn_hit *hit = &hits[i];
        bool wrong = !decision_is_right(right, hit, any);
        if (!any && !wrong && right->hit) {
            double error = number_error(right, hit);
            tally->ulps = fmax(tally->ulps, oracle_ulps(hit->t, right->t));
            wrong = tier == TIER_EXACT && !(error <= 1);
        }
        tally->rays++;
        if (!wrong) continue;
        if (closed && is_leak(world, &world->rays[i], right, hit, any)) tally->leaks++;
        char text[sizeof tally->first];
        describe(text, sizeof text, &world->rays[i], right, hit);
        tally_wrong(tally, "%s%s", any ? "occlusion: " : "", text);
    }
}

// ----------------------------------------------------------------------------------------------------------- one variant

// A world on its way through the tiers. Zeroed is empty.
struct stage {
    struct world world;
    struct scene scene;
    struct bvh bvh;
    struct oracle_answer *answers;
    struct gn_hit *hits;
};

static void stage_finish(struct stage *stage) {
    world_finish(&stage->world);
    scene_finish(&stage->scene);
    bvh_finish(&stage->bvh);
    free(stage->answers);
    free(stage->hits);
}

// Fills all of it but the hits from stage->world.
static bool stage_make(struct stage *stage, struct stress *s, bool random_tree) {
    struct context *ctx = s->ctx;
    struct world *world = &stage->world;
    stage->answers = array_alloc(ctx, world->ray_count, sizeof *stage->answers, "the answers of a case");
    stage->hits = array_alloc(ctx, world->ray_count, sizeof *stage->hits, "the hits of a case");
    if (!stage->answers || !stage->hits || !world_scene(&stage->scene, ctx, world)) return false;
    const struct oracle_params params = {.threads = context_threads(ctx)};
    return (random_tree ? world_random_bvh(&stage->bvh, ctx, &stage->scene, &s->random)
                        : bvh_build_scene(&stage->bvh, ctx, &stage->scene)) &&
           oracle_answer(stage->answers, ctx, world, &params);
}

static bool same_hit(const struct gn_hit *a, const struct gn_hit *b) { return a->object == b->object && a->primitive == b->primitive; }

// Shoots at one tier; *plain is the plain world's hits, filled by it and read by those that are to come out the same.
static bool shoot_tier(struct stress *s, struct stage *stage, const struct variant *variant, uint32_t tier, struct gn_hit *plain) {
    struct tally *tally = &s->tally[tier];
    uint32_t count = stage->world.ray_count;
    for (int any = 0; any <= (variant->any ? 1 : 0); any++) {
        const struct shot shot = {
            .scene = &stage->scene, .bvh = &stage->bvh, .rays = stage->world.rays, .count = count, .tier = tier, .any = any};
        if (!shoot(stage->hits, &tally->ms, s, &shot)) return false;
        judge(tally, tier, s->row->flags & RAYS_CLOSED, &stage->world, stage->answers, stage->hits, any);
        for (uint32_t i = 0; i < count && !any && variant->same_hits; i++)
            *(variant->random_tree ? &tally->shaken : &tally->scaled) += !same_hit(&plain[i], &stage->hits[i]);
        for (uint32_t i = 0; i < count && !any && variant == variants; i++) plain[i] = stage->hits[i];
    }
    return true;
}

static bool run_variant(struct stress *s, const struct world *base, const struct variant *variant, uint32_t rays,
                        struct gn_hit *const plain[TIER_COUNT]) {
    struct stage stage = {0};
    bool done = world_copy(&stage.world, s->ctx, base);
    if (done && variant->fuzz) world_more_rays(&stage.world, &s->random, rays, 0);
    if (done && variant->vary(&stage.world, &s->random)) {
        done = world_ok(&stage.world, s->ctx) && stage_make(&stage, s, variant->random_tree);
        for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++)
            if (s->judged[tier]) done = shoot_tier(s, &stage, variant, tier, plain[tier]);
    }
    stage_finish(&stage);
    return done;
}

static bool run_part(struct stress *s, uint32_t part, uint32_t rays) {
    struct world base = {0};
    struct gn_hit *plain[TIER_COUNT] = {NULL};
    s->row->fill(&base, &s->random, rays, part);
    if (!(s->row->flags & RAYS_AS_THEY_ARE)) world_more_rays(&base, &s->random, rays, 3);
    bool done = world_ok(&base, s->ctx);
    for (int tier = 0; tier < TIER_COUNT; tier++) {
        plain[tier] = done ? array_alloc(s->ctx, base.ray_count, sizeof **plain, "the hits of a case") : NULL;
        done = plain[tier] != NULL;
    }
    for (int i = 0; done && i < VARIANTS; i++)
        if (!variants[i].fuzz || !(s->row->flags & RAYS_AS_THEY_ARE)) done = run_variant(s, &base, &variants[i], rays, plain);
    for (int tier = 0; tier < TIER_COUNT; tier++) free(plain[tier]);
    world_finish(&base);
    return done;
}

bool run_rays(struct stress *s) {
    uint32_t parts = s->row->parts ? s->row->parts : 1, rays = s->rays / (parts * VARIANTS);
    for (uint32_t part = 0; part < parts; part++)
        if (!run_part(s, part, rays ? rays : 1)) return false;
    return true;
}
