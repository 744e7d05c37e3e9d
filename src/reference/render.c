// Pictures, as `gnomon render --reference` makes them: every pixel by itself, sample by sample, on all cores.
#include <stdatomic.h>

#include "base/threads.h"
#include "reference/reference.h"
#include "reference/sampler.h"
#include "reference/path.h"
#include "render/base.h"
#include "render/camera.h"
#include "render/filter_table.h"

// Rays between two looks at whether to stop.
#define CHUNK_SAMPLES 4096

struct picture {
    struct reference_film *film;
    const struct scene *scene;
    const struct reference_params *params;
    struct path_world world;
    struct camera_rays camera;
    struct filter_table filter;
    atomic_uint_fast64_t rays, nonfinite_pixels;
};

// What the samples of one pixel add up to.
struct pixel {
    double color[3], normal[3], depth;
    uint32_t finite, hits;     // samples
    int32_t object, primitive; // of sample 0
    uint64_t rays;
};

// A sample that fp32 cannot hold is dropped.
static void add_color(struct pixel *pixel, const double color[3]) {
    for (int i = 0; i < 3; i++) {
        if (!isfinite((float)color[i])) return;
    }
    for (int i = 0; i < 3; i++) pixel->color[i] += color[i];
    pixel->finite++;
}

static struct camera_sample draw_sample(const struct picture *picture, uint32_t x, uint32_t y, uint32_t number) {
    const struct reference_params *params = picture->params;
    const struct draws draws = {.seed = params->seed, .x = x, .y = y, .number = number, .independent = params->independent_samples};
    struct camera_sample sample = {.offset = {0.5f, 0.5f}};
    if (params->effects & EFFECT_ANTIALIASING) sampler_film(sample.offset, params->independent_samples, params->seed, x, y, number, params->spp);
    if (params->effects & EFFECT_FILTER) filter_table_offset(sample.offset, &picture->filter);
    float u[2];
    if (params->effects & EFFECT_DEPTH_OF_FIELD) {
        sampler_draw(u, &draws, SAMPLER_PAIR_LENS);
        camera_disk_point(sample.lens, u);
    }
    if (params->effects & EFFECT_MOTION_BLUR) {
        sampler_draw(u, &draws, SAMPLER_PAIR_TIME);
        sample.time = u[0];
    }
    return sample;
}

// The origin's sum is exact but for components a billion times smaller than the base, which fp64 rounds.
static bool make_ray(struct ref_ray *out, const struct picture *picture, uint32_t x, uint32_t y, uint32_t number) {
    const struct camera_sample sample = draw_sample(picture, x, y, number);
    const struct gn_ray from = camera_ray(&picture->camera, x, y, &sample);
    if (!ref_ray_make(out, &from)) return false;
    out->time = sample.time;
    for (int i = 0; i < 3; i++) out->o[i] += picture->camera.base[i];
    return true;
}

static void add_sample(struct pixel *pixel, const struct picture *picture, uint32_t x, uint32_t y, uint32_t sample) {
    const struct reference_params *params = picture->params;
    const struct draws draws = {.seed = params->seed, .x = x, .y = y, .number = sample, .independent = params->independent_samples};
    struct ref_ray ray;
    struct path_result result;
    if (make_ray(&ray, picture, x, y, sample)) {
        path_follow(&result, &picture->world, &ray, &draws);
    } else {
        path_miss(&result, &picture->world);
    }
    pixel->rays += result.rays;
    add_color(pixel, result.radiance);
    if (!result.hit) return;
    pixel->depth += result.depth;
    for (int i = 0; i < 3; i++) pixel->normal[i] += result.surface.n[i];
    pixel->hits++;
    if (sample > 0) return;
    pixel->object = (int32_t)result.surface.crossing.object;
    pixel->primitive = (int32_t)result.surface.crossing.primitive;
}

static void store(struct reference_film *film, size_t index, const struct pixel *pixel) {
    for (int i = 0; i < 3; i++) {
        film->color.pixels[3 * index + i] = pixel->finite ? (float)(pixel->color[i] / pixel->finite) : 0;
        if (film->normal.pixels) film->normal.pixels[3 * index + i] = pixel->hits ? (float)(pixel->normal[i] / pixel->hits) : 0;
    }
    if (film->depth.pixels) film->depth.pixels[index] = pixel->hits ? (float)(pixel->depth / pixel->hits) : INFINITY;
    if (film->id.pixels) {
        film->id.pixels[2 * index] = (float)pixel->object;
        film->id.pixels[2 * index + 1] = (float)pixel->primitive;
    }
}

static bool render_some(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    struct picture *picture = data;
    const struct reference_params *params = picture->params;
    uint32_t width = picture->film->color.width, stride = params->lattice.stride ? params->lattice.stride : 1;
    uint64_t rays = 0, nonfinite = 0;
    for (size_t index = begin; index < end; index++) {
        struct pixel pixel = {.object = -1, .primitive = -1};
        uint32_t x = params->lattice.x + stride * (uint32_t)(index % width), y = params->lattice.y + stride * (uint32_t)(index / width);
        for (uint32_t sample = 0; sample < params->spp; sample++) add_sample(&pixel, picture, x, y, sample);
        store(picture->film, index, &pixel);
        rays += pixel.rays;
        nonfinite += pixel.finite < params->spp;
    }
    atomic_fetch_add(&picture->rays, rays);
    atomic_fetch_add(&picture->nonfinite_pixels, nonfinite);
    return true;
}

static bool film_init(struct reference_film *out, struct context *ctx, const struct reference_params *params) {
    uint32_t width = lattice_side(params->width, params->lattice.x, params->lattice.stride);
    uint32_t height = lattice_side(params->height, params->lattice.y, params->lattice.stride);
    if (!image_init(&out->color, ctx, width, height, 3, "the picture")) return false;
    if (params->aovs & GN_AOV_DEPTH && !image_init(&out->depth, ctx, width, height, 1, "the depth layer")) return false;
    if (params->aovs & GN_AOV_NORMAL && !image_init(&out->normal, ctx, width, height, 3, "the normal layer")) return false;
    return !(params->aovs & GN_AOV_ID) || image_init(&out->id, ctx, width, height, 2, "the id layer");
}

bool reference_render(struct reference_film *out, struct context *ctx, const struct scene *scene, const struct bvh *bvh,
                      const struct reference_params *params) {
    *out = (struct reference_film){.rays = 0};
    struct picture picture = {.film = out, .scene = scene, .params = params};
    if (!film_init(out, ctx, params) || !path_world_init(&picture.world, ctx, scene, bvh, params->effects)) goto fail;
    float base[3];
    scene_base(base, scene, scene->camera.position);
    camera_rays_make(&picture.camera, &scene->camera, params->width, params->height);
    camera_rays_rebase(&picture.camera, base);
    filter_table_make(&picture.filter, scene->film.filter, scene->film.filter_radius);
    size_t grain = CHUNK_SAMPLES / params->spp;
    const bool done = parallel_for_progress(ctx, "reference", (size_t)out->color.width * out->color.height, grain, render_some, &picture);
    path_world_finish(&picture.world);
    if (!done) goto fail;
    out->rays = picture.rays;
    out->nonfinite_pixels = picture.nonfinite_pixels;
    return true;
fail:
    reference_film_finish(out);
    return false;
}

void reference_film_finish(struct reference_film *film) {
    image_finish(&film->color);
    image_finish(&film->depth);
    image_finish(&film->normal);
    image_finish(&film->id);
}
