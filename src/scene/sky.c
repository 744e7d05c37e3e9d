#include "scene/sky.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

// 2^24: random numbers are multiples of its inverse. Texels in a row are far fewer.
#define STEPS 16777216.0
#define MOST (1u << 20)

// Radiance: positive, finite.
static float radiance_of(float value, float scale) {
    double radiance = (double)value * scale;
    return radiance > FLT_MAX ? FLT_MAX : radiance > 0 ? (float)radiance : 0;
}

static void fill_radiance(struct sky *sky, const struct scene_environment *environment) {
    size_t count = (size_t)sky->width * sky->height;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) sky->texels[i].radiance[k] = radiance_of(environment->texels[3 * i + (size_t)k], environment->scale);
}

// Of linear light with the primaries of Rec. 709.
static double luminance(const struct sky_texel *t) {
    return 0.2126 * (double)t->radiance[0] + 0.7152 * (double)t->radiance[1] + 0.0722 * (double)t->radiance[2];
}

// The mean of a bilinear interpolation over a texel: of itself and its neighbours in the proportion 1 : 6 : 1, along each axis.
static double mean_along_row(const struct sky *sky, uint32_t row, uint32_t column) {
    const struct sky_texel *texels = sky->texels + (size_t)row * sky->width;
    uint32_t left = column ? column - 1 : sky->width - 1, right = column + 1 < sky->width ? column + 1 : 0;
    return (luminance(texels + left) + 6 * luminance(texels + column) + luminance(texels + right)) / 8;
}

static double mean_luminance(const struct sky *sky, uint32_t row, uint32_t column) {
    uint32_t above = row ? row - 1 : 0, below = row + 1 < sky->height ? row + 1 : row;
    return (mean_along_row(sky, above, column) + 6 * mean_along_row(sky, row, column) + mean_along_row(sky, below, column)) / 8;
}

// Shares of `count` things that are worth `worth`, summed up to each: multiples of 2^-24, at least one for whatever is worth anything, the
// rest in proportion. Where nothing is, all have the same.
static void share_out(double *until, double *worth, uint32_t count) {
    double sum = 0, worthy = 0, so_far = 0, ones = 0;
    for (uint32_t i = 0; i < count; i++) sum += worth[i];
    bool all = !(sum > 0);
    for (uint32_t i = 0; i < count; i++) {
        if (all) worth[i] = 1;
        worthy += worth[i] > 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        so_far += worth[i];
        ones += worth[i] > 0;
        until[i] = (ones + floor((STEPS - worthy) * (so_far / (all ? worthy : sum)))) / STEPS;
    }
}

// 1 - cos of the angle from the nearer pole, where edge `edge` of `height` rows is; beyond the equator for the middle row's other edge.
static double edge_at(uint32_t edge, uint32_t height, bool upper_half) {
    double half_angle = 0.5 * PI * (upper_half ? edge : height - edge) / height, sine = sin(half_angle);
    return 2 * sine * sine;
}

static double row_height(const struct sky *sky, uint32_t row) {
    bool upper = 2 * (uint64_t)row < sky->height;
    return fabs(edge_at(row + 1, sky->height, upper) - edge_at(row, sky->height, upper));
}

// What rows are worth; and the shares of the texels in each.
static void fill_columns(struct sky *sky, double *row_worth, double *worth, double *until) {
    for (uint32_t row = 0; row < sky->height; row++) {
        double sum = 0;
        for (uint32_t i = 0; i < sky->width; i++) sum += worth[i] = mean_luminance(sky, row, i);
        row_worth[row] = sum * row_height(sky, row);
        share_out(until, worth, sky->width);
        for (uint32_t i = 0; i < sky->width; i++) sky->texels[(size_t)row * sky->width + i].until = (float)until[i];
    }
}

static void fill_rows(struct sky *sky, const double *until) {
    for (uint32_t row = 0; row < sky->height; row++) {
        bool upper = 2 * (uint64_t)row < sky->height;
        double share = until[row] - (row ? until[row - 1] : 0);
        sky->rows[row] = (struct sky_row){.until = (float)until[row],
                                          .density = (float)(share * sky->width / (2 * PI * row_height(sky, row))),
                                          .upper_edge = (float)edge_at(row, sky->height, upper),
                                          .lower_edge = (float)edge_at(row + 1, sky->height, upper)};
    }
}

bool sky_init(struct sky *out, struct context *ctx, const struct scene_environment *environment) {
    *out = (struct sky){.width = environment->width, .height = environment->height};
    if (out->width > MOST || out->height > MOST)
        return fail(ctx, GN_LIMIT, "the environment has %u × %u texels; %u a side is the most", out->width, out->height, MOST);
    out->turns = (float)(fmod((double)environment->rotation_deg, 360) / 360);
    out->texels = array_alloc(ctx, (size_t)out->width * out->height, sizeof *out->texels, "the environment");
    out->rows = array_alloc(ctx, out->height, sizeof *out->rows, "the environment");
    double *numbers = array_alloc(ctx, 2 * ((size_t)out->width + out->height), sizeof *numbers, "the environment");
    bool ok = out->texels && out->rows && numbers;
    if (ok) {
        double *worth = numbers, *until = worth + out->width, *row_worth = until + out->width, *row_until = row_worth + out->height;
        fill_radiance(out, environment);
        fill_columns(out, row_worth, worth, until);
        share_out(row_until, row_worth, out->height);
        fill_rows(out, row_until);
    }
    free(numbers);
    if (!ok) sky_finish(out);
    return ok;
}

void sky_finish(struct sky *sky) {
    free(sky->texels);
    free(sky->rows);
    *sky = (struct sky){0};
}
