#include "reference/path.h"

#include <string.h>

#include "reference/bsdf.h"
#include "reference/dielectric.h"
#include "reference/fog.h"
#include "reference/material.h"
#include "reference/vector.h"
#include "scene/area_lights.h"
#include "shaders/shared.h"

static const double PI = 3.14159265358979323846;

// Where a path is: on a surface, or in fog.
struct vertex {
    struct surface surface;
    struct ref_material material;
    double v[3]; // unit, to where the path came from
    bool in_fog;
};

struct path {
    const struct path_world *world;
    const struct draws *draws;
    struct path_result *out;
    double throughput[3];
    double pdf;     // per solid angle, of the sample that the ray was made from; 0: no light sample could have been in its place
    uint32_t depth; // rays after the camera's
    uint32_t rays;  // in all
    float time;     // of the sample
    struct ref_media inside;
};

static double length(const double v[3]) { return sqrt(vector_dot(v, v)); }
static bool is_black(const double c[3]) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }

static void multiply(double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) a[i] *= b[i];
}

static void scale(double a[3], double factor) {
    for (int i = 0; i < 3; i++) a[i] *= factor;
}

static bool has(const struct path *p, uint32_t effects) { return p->world->world.effects & effects; }
static const struct scene *scene_of(const struct path *p) { return p->world->world.scene; }

// Adds what arrives along the path.
static void gather(struct path *p, const double light[3]) {
    for (int i = 0; i < 3; i++) p->out->radiance[i] += p->throughput[i] * light[i];
}

// The power heuristic: the weight of a sample of density a where the other way to find it has density b.
static double mis_weight(double a, double b) { return a * a / (a * a + b * b); }

static bool is_specular(const struct ref_material *m) { return m->bsdf.model == MODEL_DIELECTRIC || m->bsdf.model == MODEL_MIRROR; }

static bool goes_on(const struct path *p) { return has(p, EFFECT_INDIRECT) && p->depth < scene_of(p)->paths.max_depth; }

// ---------------------------------------------------------------------------------------------------------------- light

static bool sample_light(struct ref_light_sample *out, const struct path *p, const struct vertex *at, uint32_t light) {
    float u[2], choice[2];
    sampler_draw_of_ray(u, p->draws, p->depth, SAMPLER_PAIR_LIGHTS + 2 * light);
    sampler_draw_of_ray(choice, p->draws, p->depth, SAMPLER_PAIR_LIGHTS + 2 * light + 1);
    if (light < scene_of(p)->light_count) return ref_light_sample(out, &p->world->lights, light, at->surface.p, u, choice[0]);
    *out = (struct ref_light_sample){.infinite = true};
    environment_sample(out->way, &out->pdf, &p->world->sky, u);
    environment_radiance(out->radiance, &p->world->sky, out->way);
    return out->pdf > 0;
}

// What a light sample adds if nothing is in its way, but for the path's throughput.
static void light_adds(double out[3], const struct path *p, const struct vertex *at, const struct ref_light_sample *sample) {
    double l[3] = {sample->way[0], sample->way[1], sample->way[2]}, other = 0, distance = length(l);
    for (int i = 0; i < 3; i++) l[i] = distance > 0 ? l[i] / distance : 0;
    if (at->in_fog) {
        const double from[3] = {-at->v[0], -at->v[1], -at->v[2]};
        other = ref_fog_phase(vector_dot(from, l), scene_of(p)->fog.anisotropy);
        for (int i = 0; i < 3; i++) out[i] = PI * other;
    } else {
        ref_bsdf_eval(out, &at->material.bsdf, at->surface.n, at->v, l);
        if (goes_on(p)) other = ref_bsdf_pdf(&at->material.bsdf, at->surface.n, at->v, l);
        if (sample->pdf > 0 && vector_dot(at->surface.ng, l) <= 0) out[0] = out[1] = out[2] = 0;
    }
    multiply(out, sample->radiance);
    if (sample->pdf > 0) scale(out, (goes_on(p) ? mis_weight(sample->pdf, other) : 1) / (PI * sample->pdf));
    if (has(p, EFFECT_FOG)) scale(out, ref_fog_lets_through(&p->world->fog, at->surface.p, l, sample->infinite ? INFINITY : distance));
}

static bool is_hole(const struct path *p, const struct ref_ray *ray, const struct crossing *crossing) {
    if (!has(p, EFFECT_ALPHA)) return false;
    struct surface surface = surface_at(&p->world->world, ray, crossing);
    float u[2];
    sampler_draw(u, p->draws, SAMPLER_PAIR_ALPHA + p->rays);
    return !(u[0] < ref_material_alpha(&p->world->world, &surface));
}

// Lets a ray go on from a hole in a surface, to the same end.
static void pass_through(struct ref_ray *ray, struct crossing *from, const struct path *p, const struct crossing *hole) {
    const struct surface surface = surface_at(&p->world->world, ray, hole);
    for (int i = 0; i < 3; i++) {
        if (ray->tmax < INFINITY) ray->d[i] = exact_snap(ray->d[i] + (ray->o[i] - surface.p[i]) / ray->tmax);
        ray->o[i] = surface.p[i];
    }
    *from = *hole;
}

// Whether light does not come through. The ray is that of a light sample.
static bool is_shadowed(struct path *p, struct ref_ray *ray, const struct crossing *from) {
    struct crossing hit, last;
    if (!has(p, EFFECT_ALPHA)) {
        p->rays++;
        return any_hit(&p->world->world, ray, from);
    }
    while (closest_hit_from(&hit, &p->world->world, ray, from)) {
        const bool hole = is_hole(p, ray, &hit);
        p->rays++;
        if (!hole) return true;
        pass_through(ray, &last, p, &hit);
        from = &last;
    }
    p->rays++;
    return false;
}

static void ask_light(struct path *p, const struct vertex *at, uint32_t light) {
    struct ref_light_sample sample;
    double adds[3];
    if (!sample_light(&sample, p, at, light)) return;
    light_adds(adds, p, at, &sample);
    multiply(adds, p->throughput);
    if (is_black(adds)) return;
    struct ref_ray ray = {.tmin = 0, .tmax = sample.infinite ? INFINITY : 1, .time = p->time, .target = sample.target};
    for (int i = 0; i < 3; i++) ray.o[i] = at->surface.p[i], ray.d[i] = exact_snap(sample.way[i]);
    if (has(p, EFFECT_SHADOWS) && is_shadowed(p, &ray, at->in_fog ? NULL : &at->surface.crossing)) return;
    for (int i = 0; i < 3; i++) p->out->radiance[i] += adds[i];
}

static void ask_lights(struct path *p, const struct vertex *at) {
    if (!has(p, EFFECT_DIFFUSE | EFFECT_SPECULAR | EFFECT_BLINN | EFFECT_GGX | EFFECT_FOG)) return;
    const uint32_t count = scene_of(p)->light_count + (has(p, EFFECT_ENVIRONMENT) ? 1 : 0);
    for (uint32_t light = 0; light < count; light++) ask_light(p, at, light);
}

// ------------------------------------------------------------------------------------------------------------- arrivals

static void add_sky(struct path *p, const struct ref_ray *ray) {
    double sent[3] = {scene_of(p)->background[0], scene_of(p)->background[1], scene_of(p)->background[2]};
    if (has(p, EFFECT_ENVIRONMENT)) {
        environment_radiance(sent, &p->world->sky, ray->d);
        if (has(p, EFFECT_INDIRECT) && p->pdf > 0) scale(sent, mis_weight(p->pdf, environment_pdf(&p->world->sky, ray->d)));
    }
    gather(p, sent);
}

static void add_emission(struct path *p, const struct vertex *at, const struct ref_ray *ray) {
    double sent[3];
    memcpy(sent, at->material.emission, sizeof sent);
    const uint32_t light = scene_light_of(scene_of(p), at->surface.crossing.object);
    if (has(p, EFFECT_SOFT_SHADOWS) && has(p, EFFECT_INDIRECT) && p->pdf > 0 && light != NO_LIGHT_NUMBER)
        scale(sent, mis_weight(p->pdf, ref_light_pdf(&p->world->lights, light, ray->o, at->surface.crossing.primitive)));
    gather(p, sent);
}

static void note_first(struct path_result *out, const struct vertex *at, const struct ref_ray *camera) {
    double way[3];
    for (int i = 0; i < 3; i++) way[i] = at->surface.p[i] - camera->o[i];
    out->hit = true;
    out->surface = at->surface;
    out->depth = length(way);
}

static void absorb_on_the_way(struct path *p, double distance) {
    const uint32_t number = ref_media_top(&p->inside);
    if (number == 0) return;
    for (int i = 0; i < 3; i++) p->throughput[i] *= ref_absorb(scene_of(p)->materials[number - 1].absorption[i], distance);
}

static void arrive(struct path *p, struct vertex *at, const struct ref_ray *ray, const struct crossing *hit) {
    *at = (struct vertex){.surface = surface_at(&p->world->world, ray, hit)};
    memcpy(at->v, at->surface.wo, sizeof at->v);
    ref_material_at(&at->material, &p->world->world, &at->surface);
    if (has(p, EFFECT_ABSORPTION)) absorb_on_the_way(p, interval_mid(hit->t) * length(ray->d));
    if (has(p, EFFECT_EMISSION)) add_emission(p, at, ray);
    double ambient[3];
    for (int i = 0; i < 3; i++) ambient[i] = at->material.ambient[i] * scene_of(p)->ambient[i];
    gather(p, ambient);
    if (!is_specular(&at->material)) ask_lights(p, at);
}

// Whether fog scatters the path before its ray comes to `hit` (NULL: to nothing); *at is then where.
static bool fog_scatters(struct vertex *at, const struct path *p, const struct ref_ray *ray, const struct crossing *hit) {
    if (!has(p, EFFECT_FOG)) return false;
    float u[2];
    double direction[3], distance, speed = length(ray->d);
    for (int i = 0; i < 3; i++) direction[i] = ray->d[i] / speed;
    sampler_draw(u, p->draws, SAMPLER_PAIR_FOG + p->rays);
    if (!ref_fog_scatters(&distance, &p->world->fog, ray->o, direction, hit ? interval_mid(hit->t) * speed : INFINITY, u[0])) return false;
    *at = (struct vertex){.in_fog = true};
    for (int i = 0; i < 3; i++) at->surface.p[i] = exact_snap(ray->o[i] + distance * direction[i]), at->v[i] = -direction[i];
    return true;
}

// ------------------------------------------------------------------------------------------------------------- going on

// The index of refraction of a material + 1, or of vacuum.
static double ior_of(const struct path *p, uint32_t number) { return number > 0 ? scene_of(p)->materials[number - 1].ior : 1; }

// Through a dielectric's surface, or back from it.
static void go_through_glass(struct ref_sample *out, struct path *p, const struct vertex *at, float choice) {
    const struct ref_material *m = &at->material;
    const struct surface *surface = &at->surface;
    if (m->thin) {
        ref_dielectric_sheet_sample(out, surface->n, surface->ng, at->v, m->bsdf.ior, m->bsdf.diffuse, choice);
        return;
    }
    const struct ref_media_change change = ref_media_cross(&p->inside, m->number, m->priority, surface->front);
    *out = (struct ref_sample){.wi = {-at->v[0], -at->v[1], -at->v[2]}, .weight = {1, 1, 1}, .transmitted = true};
    if (change.counts)
        ref_dielectric_sample(out, surface->n, surface->ng, at->v, ior_of(p, change.here), ior_of(p, change.beyond), m->bsdf.diffuse, choice);
    if (out->transmitted) p->inside = change.after;
}

// The direction in which the path goes on, and what it is worth; false where it ends.
static bool choose_way(struct ref_sample *out, struct path *p, const struct vertex *at, const float choice[2]) {
    const struct ref_bsdf *bsdf = &at->material.bsdf;
    const struct surface *surface = &at->surface;
    float u[2];
    sampler_draw_of_ray(u, p->draws, p->depth, SAMPLER_PAIR_DIRECTION);
    *out = (struct ref_sample){.weight = {1, 1, 1}};
    if (at->in_fog) {
        const double from[3] = {-at->v[0], -at->v[1], -at->v[2]};
        if (has(p, EFFECT_INDIRECT)) ref_fog_sample(out->wi, &out->pdf, from, scene_of(p)->fog.anisotropy, u);
        return has(p, EFFECT_INDIRECT);
    }
    if (bsdf->model == MODEL_DIELECTRIC) {
        if (has(p, EFFECT_REFRACTION)) go_through_glass(out, p, at, choice[0]);
        return has(p, EFFECT_REFRACTION);
    }
    return ref_bsdf_sample(out, bsdf, surface->n, surface->ng, at->v, u, choice[0]);
}

// The path's next ray; false where it ends.
static bool next_ray(struct ref_ray *ray, struct path *p, const struct vertex *at) {
    struct ref_sample sample;
    float choice[2];
    if (p->depth >= scene_of(p)->paths.max_depth) return false;
    sampler_draw_of_ray(choice, p->draws, p->depth, SAMPLER_PAIR_CHOICE);
    if (!choose_way(&sample, p, at, choice)) return false;
    p->pdf = sample.pdf;
    multiply(p->throughput, sample.weight);
    p->depth++;
    if (p->depth >= scene_of(p)->paths.roulette_depth) {
        const double stay = fmin(0.95, fmax(p->throughput[0], fmax(p->throughput[1], p->throughput[2])));
        if (!(choice[1] < stay)) return false;
        scale(p->throughput, 1 / stay);
    }
    if (is_black(p->throughput)) return false;
    *ray = (struct ref_ray){.tmin = 0, .tmax = INFINITY, .time = p->time};
    for (int i = 0; i < 3; i++) ray->o[i] = at->surface.p[i], ray->d[i] = exact_snap(sample.wi[i]);
    return true;
}

// How a path's ray ends.
enum end { END_NOWHERE, END_SURFACE, END_FOG };

// Shoots the path's ray, on through holes: to a surface that is there (*hit), into fog (*at), or to nothing.
static enum end shoot(struct crossing *hit, struct vertex *at, struct path *p, struct ref_ray *ray, const struct crossing *from) {
    struct crossing last;
    for (;;) {
        const bool found = closest_hit_from(hit, &p->world->world, ray, from), in_fog = fog_scatters(at, p, ray, found ? hit : NULL);
        const bool hole = found && !in_fog && is_hole(p, ray, hit);
        p->rays++;
        if (!hole) return in_fog ? END_FOG : found ? END_SURFACE : END_NOWHERE;
        pass_through(ray, &last, p, hit);
        from = &last;
    }
}

// Without what the scene switches off by itself, or lacks.
static uint32_t effects_in(const struct scene *scene, uint32_t effects) {
    if (!scene->shadows) effects &= ~(uint32_t)EFFECT_SHADOWS;
    if (!scene->paths.indirect) effects &= ~(uint32_t)EFFECT_INDIRECT;
    if (scene->environment.width == 0) effects &= ~(uint32_t)EFFECT_ENVIRONMENT;
    return effects;
}

bool path_world_init(struct path_world *out, struct context *ctx, const struct scene *scene, const struct bvh *bvh, uint32_t effects) {
    effects = effects_in(scene, effects);
    *out = (struct path_world){.world = ref_world_make(scene, bvh, effects), .fog = ref_fog_make(scene)};
    const bool done = ref_lights_init(&out->lights, ctx, scene, effects) &&
                      (!(effects & EFFECT_ENVIRONMENT) || sky_init(&out->sky, ctx, &scene->environment));
    if (!done) path_world_finish(out);
    return done;
}

void path_world_finish(struct path_world *world) {
    ref_lights_finish(&world->lights);
    sky_finish(&world->sky);
}

void path_follow(struct path_result *out, const struct path_world *world, const struct ref_ray *camera, const struct draws *draws) {
    struct path p = {.world = world, .draws = draws, .out = out, .throughput = {1, 1, 1}, .time = camera->time};
    struct ref_ray ray = *camera;
    struct vertex at;
    struct crossing left, hit;
    const struct crossing *from = NULL;
    enum end end;
    *out = (struct path_result){.hit = false};
    do {
        end = shoot(&hit, &at, &p, &ray, from);
        if (end == END_NOWHERE) add_sky(&p, &ray);
        if (end == END_SURFACE) arrive(&p, &at, &ray, &hit);
        if (end == END_SURFACE && p.depth == 0) note_first(out, &at, camera);
        if (end == END_FOG) {
            for (int i = 0; i < 3; i++) p.throughput[i] *= scene_of(&p)->fog.albedo[i];
            ask_lights(&p, &at);
        }
        left = at.surface.crossing;
        from = end == END_FOG ? NULL : &left;
    } while (end != END_NOWHERE && next_ray(&ray, &p, &at));
    out->rays = p.rays;
}

void path_miss(struct path_result *out, const struct path_world *world) {
    *out = (struct path_result){.rays = 1};
    for (int i = 0; i < 3; i++) out->radiance[i] = world->world.scene->background[i];
}
