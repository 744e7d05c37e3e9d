#include "render/upload_camera.h"

#include <string.h>

#include "render/filter_table.h"

bool upload_camera(struct buffer *out, struct context *ctx, struct device *device, const struct scene *scene, uint32_t effects) {
    struct word4 words[CAMERA_WORDS] = {0};
    bool used = effects & EFFECT_FILTER;
    struct buffer_params params = {.name = "camera", .kind = BUFFER_TEXELS, .size = used ? sizeof words : sizeof *words, .host_writes = true};
    if (!buffer_init(out, ctx, device, &params)) return false;
    if (!used) return true;
    struct filter_table filter;
    filter_table_make(&filter, scene->film.filter, scene->film.filter_radius);
    memcpy(words + CAMERA_FILTER, filter.knots, sizeof filter.knots);
    return buffer_upload(out, ctx, device, words, sizeof words);
}
