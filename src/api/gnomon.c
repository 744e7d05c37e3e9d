// The public handles for devices and scenes: a thin facade over device/, scene/, bvh/ and effects/.
#include "api/handles.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "bvh/scene_boxes.h"

#define TEXT_OF(x) #x
#define VERSION_TEXT(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

const char *gn_version(void) { return VERSION_TEXT(GN_VERSION_MAJOR, GN_VERSION_MINOR, GN_VERSION_PATCH); }

// -------------------------------------------------------------------------------------------------------------- devices

struct gn_device *gn_device_create(const struct gn_device_params *params, struct gn_error *error) {
    static const struct gn_device_params defaults;
    if (!params) params = &defaults;
    struct context ctx = context_make(params->host, error);
    double start = clock_seconds();
    struct gn_device *device = array_alloc(&ctx, 1, sizeof *device, "a device");
    if (!device) return NULL;
    if (!device_init(&device->device, &ctx, params)) {
        gn_device_destroy(device);
        return NULL;
    }
    device->startup_ms = clock_ms_since(start);
    return device;
}

void gn_device_destroy(struct gn_device *device) {
    if (!device) return;
    device_finish(&device->device);
    free(device);
}

const struct gn_device_info *gn_device_info(const struct gn_device *device) { return &device->device.info; }

bool gn_device_list(const struct gn_device_params *params, struct gn_device_info *infos, uint32_t capacity, uint32_t *count, int *selected,
                    struct gn_error *error) {
    static const struct gn_device_params defaults;
    if (!params) params = &defaults;
    *count = 0, *selected = -1;
    struct context ctx = context_make(params->host, error);
    return device_list(&ctx, params, infos, capacity, count, selected);
}

// --------------------------------------------------------------------------------------------------------------- scenes

struct gn_scene *gn_scene_load(const char *path, const struct gn_host *host, struct gn_error *error) {
    struct context ctx = context_make(host, error);
    double start = clock_seconds();
    struct gn_scene *scene = array_alloc(&ctx, 1, sizeof *scene, "a scene");
    if (!scene) return NULL;
    if (!scene_load(&scene->scene, &ctx, path)) {
        gn_scene_destroy(scene);
        return NULL;
    }
    scene->load_ms = clock_ms_since(start);
    return scene;
}

void gn_scene_destroy(struct gn_scene *scene) {
    if (!scene) return;
    bvh_finish(&scene->bvh);
    scene_finish(&scene->scene);
    free(scene);
}

void gn_scene_info(const struct gn_scene *scene, struct gn_scene_info *info) {
    const struct scene *s = &scene->scene;
    *info = (struct gn_scene_info){
        .shapes = s->shape_count,
        .materials = s->material_count,
        .lights = s->light_count,
        .triangles = scene_triangle_count(s),
        .spheres = scene_sphere_count(s),
        .width = s->film.width,
        .height = s->film.height,
        .spp = s->film.spp,
    };
}

bool scene_bvh(struct gn_scene *scene, struct context *ctx) {
    if (scene->has_bvh) return true;
    double start = clock_seconds();
    if (!bvh_build_scene(&scene->bvh, ctx, &scene->scene)) return false;
    scene->has_bvh = true;
    scene->bvh_ms = clock_ms_since(start);
    return true;
}

// ----------------------------------------------------------------------------------------------------------------- plan

bool gn_plan(struct gn_scene *scene, const struct gn_render_params *params, struct gn_effect *effects, uint32_t capacity, uint32_t *count,
             struct gn_error *error) {
    *count = 0;
    struct context ctx = context_make(params ? params->host : NULL, error);
    struct job job;
    if (!job_make(&job, &ctx, scene, params, true)) return false;
    *count = capacity < EFFECT_COUNT ? capacity : EFFECT_COUNT;
    for (uint32_t i = 0; i < *count; i++) {
        effects[i] = (struct gn_effect){.on = job.plan.effects >> i & 1};
        snprintf(effects[i].name, sizeof effects[i].name, "%s", effect_name(i));
        snprintf(effects[i].because, sizeof effects[i].because, "%s", job.plan.because[i]);
    }
    return true;
}
