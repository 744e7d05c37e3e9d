#include "reference/resolve.h"

#include <math.h>

#include "base/threads.h"
#include "reference/rounding.h"
#include "scene/instances.h"

struct job {
    struct resolve_answer *answers;
    const struct ref_world *world;
    const struct resolve_ray *rays;
};

// The primitive a ray starts on, in the form that the traversal compares with: a sphere by itself, a triangle by its number alone.
static struct crossing start_of(const struct ref_world *world, uint32_t self, float time) {
    struct crossing from = {.number = self};
    if (self < world->triangle_count || self >= world->triangle_count + world->sphere_count) return from;
    const struct scene_shape *shape = &world->scene->shapes[scene_sphere_object(world->scene, self - world->triangle_count)];
    from.kind = CROSSING_SPHERE;
    from.radius = shape->radius;
    scene_place(from.center, shape, shape->center, time);
    return from;
}

static struct resolve_answer resolve(const struct ref_world *world, const struct resolve_ray *r) {
    struct resolve_answer answer = {.hit = {.t = INFINITY, .object = -1, .primitive = -1}};
    struct ref_ray ray = {{r->o[0], r->o[1], r->o[2]}, {r->d[0], r->d[1], r->d[2]}, r->tmin, r->tmax, 0, r->target, r->time};
    struct crossing crossing, from = start_of(world, r->self, r->time);
    if (r->any) {
        answer.hit.object = any_hit(world, &ray, &from) ? 0 : -1;
        return answer;
    }
    if (!closest_hit_from(&crossing, world, &ray, &from)) return answer;
    crossing_round(&answer.hit, &ray, &crossing);
    answer.hit.object = (int32_t)crossing.object;
    answer.hit.primitive = (int32_t)crossing.primitive;
    answer.number = crossing.number;
    return answer;
}

static bool resolve_some(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    struct job *job = data;
    for (size_t i = begin; i < end; i++) job->answers[i] = resolve(job->world, &job->rays[i]);
    return true;
}

bool resolve_rays(struct resolve_answer *answers, struct context *ctx, const struct ref_world *world, const struct resolve_ray *rays,
                  size_t count) {
    struct job job = {.answers = answers, .world = world, .rays = rays};
    return parallel_for(context_threads(ctx), count, 16, resolve_some, &job);
}
