// See verify.h for the rule and its argument.
#include "measure/verify.h"

#include <math.h>

uint64_t verify_allowed(uint64_t pixels, uint32_t spp) {
    double fraction = fmin(VERIFY_ALLOWED_FRACTION + VERIFY_ALLOWED_FURTHER * (spp > 1 ? spp - 1 : 0), VERIFY_ALLOWED_MOST);
    uint64_t allowed = (uint64_t)(fraction * (double)pixels);
    return allowed < VERIFY_ALLOWED_LEAST ? VERIFY_ALLOWED_LEAST : allowed;
}

struct pixel_error {
    double worst;   // over the channels, absolute
    double squares; // summed over the channels
    double limits;  // worst, in units of the limit that holds at its value; +inf if something is not finite
};

// What a channel may be off where this is its right value.
static double limit_at(double right, double tolerance) {
    return fabs(right) > 1 ? fmax(tolerance, VERIFY_RELATIVE * fabs(right)) : tolerance;
}

static struct pixel_error pixel_error(const float *device, const float *reference, double tolerance) {
    struct pixel_error error = {0};
    for (int c = 0; c < 3; c++) {
        double right = reference[c], off = fabs((double)device[c] - right);
        if (!isfinite(off)) return (struct pixel_error){.limits = INFINITY};
        error.worst = fmax(error.worst, off);
        error.squares += off * off;
        error.limits = fmax(error.limits, off / limit_at(right, tolerance));
    }
    return error;
}

static void add_color(struct gn_verify_result *out, struct pixel_error error, uint32_t x, uint32_t y) {
    if (isinf(error.limits)) out->nonfinite_pixels++;
    if (!(error.limits <= 1)) out->pixels_differing++;
    if (error.worst > out->max_abs) out->max_abs = error.worst, out->worst_x = x, out->worst_y = y;
}

static void add_hit(struct gn_verify_result *out, struct verify_side device, struct verify_side reference, size_t pixel) {
    const float *ours = device.id->pixels + 2 * pixel, *right = reference.id->pixels + 2 * pixel;
    if (ours[0] == right[0] && ours[1] == right[1]) return;
    out->wrong_hits++;
    double depth = reference.depth->pixels[pixel];
    out->ties += fabs((double)device.depth->pixels[pixel] - depth) <= VERIFY_RELATIVE * depth;
}

bool verify_pictures(struct gn_verify_result *out, struct image *difference, struct context *ctx, struct verify_side device,
                     struct verify_side reference, uint32_t spp, double tolerance) {
    uint32_t width = device.color->width, height = device.color->height;
    if (reference.color->width != width || reference.color->height != height)
        return fail(ctx, GN_INTERNAL, "the device's picture and the reference's differ in size");
    if (difference && !image_init(difference, ctx, width, height, 1, "the difference")) return false;
    double squares = 0;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            size_t i = (size_t)y * width + x;
            struct pixel_error error = pixel_error(device.color->pixels + 3 * i, reference.color->pixels + 3 * i, tolerance);
            add_color(out, error, x, y);
            add_hit(out, device, reference, i);
            squares += error.squares;
            if (difference) difference->pixels[i] = (float)fmin(1, 0.5 * error.limits);
        }
    }
    out->tolerance = tolerance;
    out->pixels = (uint64_t)width * height;
    out->pixels_allowed = verify_allowed(out->pixels, spp);
    out->hits_allowed = verify_allowed(out->pixels, 1);
    out->rmse = sqrt(squares / (3 * (double)out->pixels));
    out->pass =
        out->pixels_differing <= out->pixels_allowed && out->wrong_hits - out->ties <= out->hits_allowed && out->nonfinite_pixels == 0;
    return true;
}
