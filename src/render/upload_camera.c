#include "render/upload_camera.h"

#include <string.h>

#include "render/filter_table.h"

#define READERS (EFFECT_FILTER | EFFECT_DEPTH_OF_FIELD | EFFECT_MOTION_BLUR)

static void put(struct word4 *to, const float v[3]) { memcpy(to->w, v, 3 * sizeof *v); }

bool upload_camera(struct buffer *out, struct context *ctx, struct device *device, const struct upload_camera_params *params) {
    const struct camera_rays *rays = params->rays;
    struct word4 words[CAMERA_WORDS] = {0};
    bool used = params->effects & READERS;
    struct buffer_params buffer = {.name = "camera", .kind = BUFFER_TEXELS, .size = used ? sizeof words : sizeof *words, .host_writes = true};
    if (!buffer_init(out, ctx, device, &buffer)) return false;
    if (!used) return true;
    float first[4] = {0, 0, 0, rays->lens * params->scale};
    for (int i = 0; i < 3; i++) first[i] = rays->travel[i] * params->scale;
    memcpy(words[0].w, first, sizeof first);
    memcpy(words[1].w, &rays->aim, sizeof rays->aim);
    struct filter_table filter;
    filter_table_make(&filter, params->film->filter, params->film->filter_radius);
    memcpy(words + CAMERA_FILTER_WORD, filter.knots, sizeof filter.knots);
    for (int i = 0; i <= CAMERA_FRAMES; i++) {
        struct word4 *frame = words + CAMERA_FRAMES_WORD + 3 * i;
        put(frame, rays->frames[i].corner);
        put(frame + 1, rays->frames[i].du);
        put(frame + 2, rays->frames[i].dv);
    }
    return buffer_upload(out, ctx, device, words, sizeof words);
}
