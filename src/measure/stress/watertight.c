// Rows of closed meshes: no ray gets out, and a line goes in as often as it comes out.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bvh/scene_boxes.h"
#include "measure/stress/fill.h"
#include "measure/stress/shoot.h"

static const double ORIGIN[3] = {0, 0, 0};

// A ray from this far from the middle of a ball to a vertex, or to a point of an edge.
static void aim_from(struct world *world, struct random *random, double distance, bool at_vertex) {
    const struct world_triangle *t = &world->triangles[random_below(random, world->triangle_count)];
    uint32_t corner = random_below(random, 3);
    const float *a = world->vertices[t->v[corner]], *b = world->vertices[t->v[(corner + 1) % 3]];
    double direction[3], p[3], along = at_vertex ? 0 : random_unit(random);
    float o[3];
    random_direction(direction, random);
    for (int k = 0; k < 3; k++) {
        o[k] = (float)(distance * direction[k]);
        p[k] = (float)(a[k] + along * ((double)b[k] - a[k]));
    }
    world_aim(world, o, p);
}

// Shoots the world's rays at each tier and counts those that hit nothing.
static bool count_escapes(struct stress *s, const struct world *world, const struct scene *scene, const struct bvh *bvh) {
    struct gn_hit *hits = array_alloc(s->ctx, world->ray_count, sizeof *hits, "hits");
    bool done = hits != NULL;
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        struct tally *tally = &s->tally[tier];
        const struct shot shot = {.scene = scene, .bvh = bvh, .rays = world->rays, .count = world->ray_count, .tier = tier};
        if (!s->judged[tier]) continue;
        done = shoot(hits, &tally->ms, s, &shot);
        for (uint32_t i = 0; done && i < world->ray_count; i++) {
            const struct gn_ray *ray = &world->rays[i];
            tally->rays++;
            if (hits[i].object >= 0) continue;
            tally->leaks++;
            tally_wrong(tally, "gets out: o (%a, %a, %a) d (%a, %a, %a)", ray->origin[0], ray->origin[1], ray->origin[2], ray->direction[0],
                        ray->direction[1], ray->direction[2]);
        }
    }
    free(hits);
    return done;
}

// W01: from inside bumpy balls of 480 and 20 thousand triangles, aimed at vertices and edges. Ten times as many rays as other rows.
bool watertight_escapes(struct stress *s) {
    static const struct {
        uint32_t rows, columns;
        double bump;
    } balls[] = {{16, 16, 5}, {100, 100, 0.3}};
    bool done = true;
    for (int ball = 0; done && ball < 2; ball++) {
        struct world world = {0};
        struct scene scene = {0};
        struct bvh bvh = {0};
        fill_ball(&world, &s->random, balls[ball].rows, balls[ball].columns, 1, balls[ball].bump, ORIGIN);
        for (uint32_t i = 0; i < 5 * s->rays && !world.failed; i++) aim_from(&world, &s->random, 0.5, i % 2);
        done = world_ok(&world, s->ctx) && world_scene(&scene, s->ctx, &world) && bvh_build_scene(&bvh, s->ctx, &scene) &&
               count_escapes(s, &world, &scene, &bvh);
        bvh_finish(&bvh);
        scene_finish(&scene);
        world_finish(&world);
    }
    return done;
}

// ------------------------------------------------------------------------------------------------------------- crossings

// To count all crossings of a ray, it is shot again from each hit on. Triangles that touch are crossed at one t, at a silhouette, and
// would hide each other; so the mesh is cut into parts in which no two triangles touch, and the counts are added.
#define MOST_PARTS 64

// part[triangle]: the first part that none of its neighbours is in, greedily. Returns how many there are; MOST_PARTS + 1 if that is not
// enough.
static uint32_t colour(uint8_t *part, struct context *ctx, const struct world *world) {
    uint64_t *taken =
        array_alloc(ctx, world->vertex_count, sizeof *taken, "parts of a mesh"); // by vertex: parts that have a triangle there
    uint32_t parts = 0;
    for (uint32_t i = 0; taken && i < world->triangle_count && parts <= MOST_PARTS; i++) {
        const uint32_t *v = world->triangles[i].v;
        uint64_t near = taken[v[0]] | taken[v[1]] | taken[v[2]];
        uint32_t free_part = 0;
        while (free_part < MOST_PARTS && near >> free_part & 1) free_part++;
        if (free_part < MOST_PARTS)
            for (int k = 0; k < 3; k++) taken[v[k]] |= UINT64_C(1) << free_part;
        part[i] = (uint8_t)free_part;
        if (free_part + 1 > parts) parts = free_part + 1;
    }
    bool done = taken != NULL;
    free(taken);
    return done ? parts : MOST_PARTS + 1;
}

// Adds to crossings[ray] how often each ray meets the world, by shooting on from each hit. A triangle that is met again at the t where
// the ray goes on from, because that was rounded down, counts once.
static bool count_crossings(uint32_t *crossings, struct stress *s, const struct world *world, uint32_t tier) {
    struct scene scene = {0};
    struct bvh bvh = {0};
    uint32_t count = world->ray_count, open = count;
    struct gn_ray *rays = array_alloc(s->ctx, count, sizeof *rays, "rays");
    struct gn_hit *hits = array_alloc(s->ctx, count, sizeof *hits, "hits");
    uint32_t *number = array_alloc(s->ctx, count, sizeof *number, "rays");
    int32_t *last = array_alloc(s->ctx, count, sizeof *last, "rays");
    bool done = rays && hits && number && last && world_scene(&scene, s->ctx, world) && bvh_build_scene(&bvh, s->ctx, &scene);
    for (uint32_t i = 0; done && i < count; i++) rays[i] = world->rays[i], number[i] = i, last[i] = -1;
    while (done && open > 0) {
        const struct shot shot = {.scene = &scene, .bvh = &bvh, .rays = rays, .count = open, .tier = tier};
        uint32_t left = 0;
        done = shoot(hits, &s->tally[tier].ms, s, &shot);
        for (uint32_t i = 0; done && i < open; i++) {
            if (hits[i].object < 0) continue;
            bool again = hits[i].primitive == last[number[i]];
            crossings[number[i]] += !again;
            last[number[i]] = hits[i].primitive;
            struct gn_ray on = rays[i];
            on.tmin = again ? nextafterf(fmaxf(on.tmin, hits[i].t), INFINITY) : hits[i].t;
            number[left] = number[i];
            rays[left++] = on;
        }
        open = left;
    }
    free(rays);
    free(hits);
    free(number);
    free(last);
    bvh_finish(&bvh);
    scene_finish(&scene);
    return done;
}

// The triangles of one part, with the vertices and rays of all.
static bool take_part(struct world *out, struct context *ctx, const struct world *world, const uint8_t *part, uint32_t which) {
    if (!world_copy(out, ctx, world)) return false;
    out->triangle_count = 0;
    for (uint32_t i = 0; i < world->triangle_count; i++)
        if (part[i] == which) out->triangles[out->triangle_count++] = world->triangles[i];
    return true;
}

static bool judge_parity(struct stress *s, const struct world *world, const uint8_t *part, uint32_t parts, uint32_t tier, uint32_t wanted) {
    uint32_t *crossings = array_alloc(s->ctx, world->ray_count, sizeof *crossings, "crossings");
    bool done = crossings != NULL;
    for (uint32_t which = 0; done && which < parts; which++) {
        struct world piece;
        done = take_part(&piece, s->ctx, world, part, which) && count_crossings(crossings, s, &piece, tier);
        world_finish(&piece);
    }
    for (uint32_t i = 0; done && i < world->ray_count; i++) {
        const struct gn_ray *ray = &world->rays[i];
        s->tally[tier].rays++;
        if (crossings[i] % 2 != wanted)
            tally_wrong(&s->tally[tier], "%u crossings: o (%a, %a, %a) d (%a, %a, %a)", crossings[i], ray->origin[0], ray->origin[1],
                        ray->origin[2], ray->direction[0], ray->direction[1], ray->direction[2]);
    }
    free(crossings);
    return done;
}

// W02: rays from inside cross an odd number of times, rays from outside an even one.
bool watertight_parity(struct stress *s) {
    struct world world = {0};
    fill_ball(&world, &s->random, 12, 16, 1, 2, ORIGIN);
    uint8_t *part = array_alloc(s->ctx, world.triangle_count, sizeof *part, "parts of a mesh");
    uint32_t parts = part && world_ok(&world, s->ctx) ? colour(part, s->ctx, &world) : MOST_PARTS + 1;
    bool done = part && (parts <= MOST_PARTS || fail(s->ctx, GN_INTERNAL, "a stress case's mesh needs more than %d parts", MOST_PARTS));
    for (uint32_t outside = 0; done && outside < 2; outside++) {
        world.ray_count = 0;
        for (uint32_t i = 0; i < s->rays / 4 + 1 && !world.failed; i++) aim_from(&world, &s->random, outside ? 20 : 0.5, i % 2);
        done = world_ok(&world, s->ctx);
        for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++)
            if (s->judged[tier]) done = judge_parity(s, &world, part, parts, tier, 1 - outside);
    }
    free(part);
    world_finish(&world);
    return done;
}
