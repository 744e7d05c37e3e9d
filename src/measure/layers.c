#include "measure/layers.h"

#include <math.h>
#include <string.h>

#include "measure/compare.h"

#define LEAST_ERROR 1e-7 // black: what fp32 rounds off a colour
#define DECADES 7        // from there to 1
#define ULP_BITS 12
#define COUNT_BITS 4

float ulp_distance(float a, float b) {
    if (!isfinite(a) || !isfinite(b)) return isfinite(a) == isfinite(b) ? 0 : INFINITY;
    uint32_t bits_a, bits_b;
    memcpy(&bits_a, &a, sizeof a);
    memcpy(&bits_b, &b, sizeof b);
    return (float)(bits_a > bits_b ? bits_a - bits_b : bits_b - bits_a);
}

bool layer_of_error(struct image *out, struct context *ctx, const struct image *color, const struct image *reference) {
    if (!image_init(out, ctx, color->width, color->height, 3, "the picture of errors")) return false;
    size_t count = (size_t)out->width * out->height * 3;
    for (size_t i = 0; i < count; i++) out->pixels[i] = fabsf(color->pixels[i] - reference->pixels[i]);
    return true;
}

bool layer_of_ulp(struct image *out, struct context *ctx, const struct image *depth, const struct image *reference) {
    if (!image_init(out, ctx, depth->width, depth->height, 1, "the picture of ulp")) return false;
    size_t count = (size_t)out->width * out->height;
    for (size_t i = 0; i < count; i++) out->pixels[i] = ulp_distance(depth->pixels[i], reference->pixels[i]);
    return true;
}

// ---------------------------------------------------------------------------------------------------------- false colour

// The largest channel of each pixel, through `scale`, which brings it to 0 … 1, through the heat map.
static bool view(struct image *out, struct context *ctx, const struct image *values, double (*scale)(double value)) {
    struct image scaled;
    if (!image_init(&scaled, ctx, values->width, values->height, 1, "the picture of a layer")) return false;
    size_t count = (size_t)scaled.width * scaled.height;
    for (size_t i = 0; i < count; i++) {
        double largest = 0;
        for (uint32_t c = 0; c < values->channels; c++) {
            double value = values->pixels[values->channels * i + c];
            largest = value <= largest ? largest : value; // NaN is kept, and shown as white
        }
        double shown = scale(largest);
        scaled.pixels[i] = shown <= 1 ? (float)fmax(shown, 0) : 1;
    }
    bool done = heat_map(out, ctx, &scaled);
    image_finish(&scaled);
    return done;
}

static double scale_of_error(double error) { return error > 0 ? log10(error / LEAST_ERROR) / DECADES : isnan(error) ? 1 : 0; }
static double scale_of_ulp(double ulp) { return log2(1 + ulp) / ULP_BITS; }
static double scale_of_count(double count) { return log2(1 + count) / COUNT_BITS; }

bool view_of_error(struct image *out, struct context *ctx, const struct image *error) { return view(out, ctx, error, scale_of_error); }
bool view_of_ulp(struct image *out, struct context *ctx, const struct image *ulp) { return view(out, ctx, ulp, scale_of_ulp); }
bool view_of_undecided(struct image *out, struct context *ctx, const struct image *undecided) {
    return view(out, ctx, undecided, scale_of_count);
}
