// gn_verify and gn_compare: make or read two pictures, and let measure/ say how they differ.
#include "api/handles.h"

#include <stdlib.h>

#include "measure/compare.h"
#include "measure/verify.h"

// A picture that is one image in false colour.
static struct gn_picture *picture_of(struct context *ctx, const struct image *values) {
    struct gn_picture *picture = array_alloc(ctx, 1, sizeof *picture, "a picture");
    if (!picture) return NULL;
    picture->transfer = TRANSFER_SRGB;
    if (heat_map(&picture->color, ctx, values)) return picture;
    gn_picture_destroy(picture);
    return NULL;
}

bool gn_verify(struct gn_device *device, struct gn_scene *scene, const struct gn_verify_params *params, struct gn_verify_result *result,
               struct gn_picture **difference, struct gn_error *error) {
    static const struct gn_verify_params defaults;
    if (!params) params = &defaults;
    *result = (struct gn_verify_result){0};
    if (difference) *difference = NULL;
    struct context ctx = context_make(params->render.host, error);
    if (!device) return fail(&ctx, GN_USAGE, "verifying compares a device with the reference: a device is needed");
    struct gn_render_params render = params->render;
    render.aovs |= GN_AOV_ID | GN_AOV_DEPTH;
    struct image values = {0};
    struct gn_picture *theirs = NULL, *ours = gn_render(device, scene, &render, error);
    if (!ours || !(theirs = gn_render(NULL, scene, &render, error))) goto done;

    result->device = ours->stats, result->reference = theirs->stats;
    result->nonfinite_pixels = ours->stats.nonfinite_pixels;
    double tolerance = params->tolerance > 0 ? params->tolerance : VERIFY_TOLERANCE;
    uint32_t spp = render.spp ? render.spp : scene->scene.film.spp;
    struct verify_side a = {&ours->color, &ours->id, &ours->depth}, b = {&theirs->color, &theirs->id, &theirs->depth};
    if (!verify_pictures(result, difference ? &values : NULL, &ctx, a, b, spp, tolerance)) goto done;
    if (difference && !(*difference = picture_of(&ctx, &values))) goto done;

done:
    image_finish(&values);
    gn_picture_destroy(theirs);
    gn_picture_destroy(ours);
    return error->status == GN_OK;
}

bool gn_compare(const char *path_a, const char *path_b, struct gn_compare_result *result, struct gn_picture **heat,
                struct gn_error *error) {
    *result = (struct gn_compare_result){0};
    if (heat) *heat = NULL;
    struct context ctx = context_make(NULL, error);
    struct image a = {0}, b = {0}, values = {0};
    bool done = image_read(&a, &ctx, path_a) && image_read(&b, &ctx, path_b) &&
                compare_images(result, heat ? &values : NULL, &ctx, &a, &b, 0) && (!heat || (*heat = picture_of(&ctx, &values)));
    image_finish(&values);
    image_finish(&b);
    image_finish(&a);
    return done;
}
