// How two images differ, in numbers.
#include "measure/compare.h"

#include <math.h>
#include <string.h>

#include "measure/flip.h"

struct difference {
    double largest, squares;
    bool finite;
};

// The difference of two pixels. Where either has a channel that is NaN or infinite there is no number for it; `largest` is then 0 for
// pixels that are the same nevertheless, else infinite.
static struct difference pixel_difference(const float a[3], const float b[3]) {
    struct difference out = {.finite = true};
    bool same = true;
    for (int c = 0; c < 3; c++) {
        double difference = fabs((double)a[c] - (double)b[c]);
        out.largest = fmax(out.largest, difference);
        out.squares += difference * difference;
        if (!isfinite(a[c]) || !isfinite(b[c])) out.finite = false;
        if (a[c] != b[c] && !(isnan(a[c]) && isnan(b[c]))) same = false;
    }
    if (!out.finite) out = (struct difference){.largest = same ? 0 : INFINITY};
    return out;
}

static void compare_pixels(struct gn_compare_result *out, const struct image *a, const struct image *b, double tolerance) {
    double squares = 0, worst = 0;
    uint64_t finite = 0;
    for (uint32_t y = 0; y < a->height; y++)
        for (uint32_t x = 0; x < a->width; x++) {
            size_t at = 3 * ((size_t)y * a->width + x);
            struct difference difference = pixel_difference(a->pixels + at, b->pixels + at);
            if (!(difference.largest <= tolerance)) out->pixels_differing++;
            if (difference.largest > worst) {
                worst = difference.largest;
                out->worst_x = x;
                out->worst_y = y;
            }
            if (!difference.finite) continue;
            finite++;
            squares += difference.squares;
            out->max_abs = fmax(out->max_abs, difference.largest);
        }
    out->nonfinite_pixels = (uint64_t)a->width * a->height - finite;
    out->rmse = finite > 0 ? sqrt(squares / (3 * (double)finite)) : 0;
    out->psnr_db = out->rmse > 0 ? -20 * log10(out->rmse) : INFINITY;
}

bool compare_images(struct gn_compare_result *out, struct image *flip_map, struct context *ctx, const struct image *a,
                    const struct image *b, double tolerance) {
    memset(out, 0, sizeof *out);
    if (flip_map) *flip_map = (struct image){0};
    if (a->channels != 3 || b->channels != 3)
        return fail(ctx, GN_USAGE, "the images have %u and %u channels, 3 were expected", a->channels, b->channels);
    if (a->width != b->width || a->height != b->height)
        return fail(ctx, GN_USAGE, "the images differ in size: %u × %u and %u × %u pixels", a->width, a->height, b->width, b->height);
    struct image map;
    out->width = a->width;
    out->height = a->height;
    compare_pixels(out, a, b, tolerance);
    if (!flip_compare(&map, &out->flip, ctx, a, b)) return false;
    if (flip_map)
        *flip_map = map;
    else
        image_finish(&map);
    return true;
}
