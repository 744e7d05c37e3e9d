#include "reference/environment.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

// Where the picture has a direction, in texels from its upper left corner. The column may lie outside.
static void place_of(double *x, double *y, const struct sky *sky, const double way[3]) {
    double longitude = atan2(way[0], -way[2]) / (2 * PI) + sky->turns; // from the middle of the picture
    *x = (0.5 + longitude) * sky->width;
    *y = atan2(hypot(way[0], way[2]), way[1]) / PI * sky->height;
}

static uint32_t column_at(const struct sky *sky, double x) {
    double column = fmod(floor(x), sky->width);
    return (uint32_t)(column < 0 ? column + sky->width : column);
}

static uint32_t row_at(const struct sky *sky, double y) { return y < 0 ? 0 : y >= sky->height ? sky->height - 1 : (uint32_t)y; }

// What a texel's tent of the width of two texels has at a distance from its center, or all of it where its center counts as hit.
static double weight_at(double distance, bool there) { return there ? fabs(distance) < 0.5 : fmax(0, 1 - fabs(distance)); }

void environment_radiance(double rgb[3], const struct sky *sky, const double way[3]) {
    double x, y;
    place_of(&x, &y, sky, way);
    bool there_x = fabs(x - floor(x) - 0.5) <= 1.5e-7 * sky->width, there_y = fabs(y - floor(y) - 0.5) <= 1.5e-7 * sky->height;
    for (int k = 0; k < 3; k++) rgb[k] = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            double column = floor(x) + i, row = floor(y) + j;
            double weight = weight_at(x - (column + 0.5), there_x) * weight_at(y - (row + 0.5), there_y);
            const struct sky_texel *texel = sky->texels + (size_t)row_at(sky, row) * sky->width + column_at(sky, column);
            for (int k = 0; k < 3; k++) rgb[k] += weight * (double)texel->radiance[k];
        }
}

static double row_share(const struct sky *sky, uint32_t row) {
    return (double)sky->rows[row].until - (row ? (double)sky->rows[row - 1].until : 0);
}

static double column_share(const struct sky *sky, uint32_t row, uint32_t column) {
    const struct sky_texel *texel = sky->texels + (size_t)row * sky->width + column;
    return (double)texel->until - (column ? (double)texel[-1].until : 0);
}

// The density of a texel: its share of all samples over its solid angle, 2π/width · (cos a - cos b) = 2π/width · 2 sin((a + b)/2) sin((b -
// a)/2).
static double texel_pdf(const struct sky *sky, uint32_t row, uint32_t column) {
    double step = PI / sky->height, angle = 4 * PI / sky->width * sin((row + 0.5) * step) * sin(0.5 * step);
    return row_share(sky, row) * column_share(sky, row, column) / angle;
}

double environment_pdf(const struct sky *sky, const double way[3]) {
    double x, y;
    place_of(&x, &y, sky, way);
    return texel_pdf(sky, row_at(sky, y), column_at(sky, x));
}

// The middle of the step of 2^-24 in which u lies, as a place in a share that begins at `before`.
static double place_within(float u, double before, double share) { return (u - before + 0x1p-25) / share; }

// The first of `count` numbers, each `stride` floats from the next, that is above u.
static uint32_t pick(const float *until, size_t stride, uint32_t count, float u) {
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (until[stride * middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void environment_sample(double way[3], double *pdf, const struct sky *sky, const float u[2]) {
    uint32_t row = pick(&sky->rows->until, sizeof *sky->rows / sizeof(float), sky->height, u[1]);
    const struct sky_texel *texels = sky->texels + (size_t)row * sky->width;
    uint32_t column = pick(&texels->until, sizeof *texels / sizeof(float), sky->width, u[0]);
    double down = place_within(u[1], row ? (double)sky->rows[row - 1].until : 0, row_share(sky, row));
    double across = place_within(u[0], column ? (double)texels[column - 1].until : 0, column_share(sky, row, column));
    double upper = cos(PI * row / sky->height), lower = cos(PI * (row + 1.0) / sky->height);
    double cosine = upper + down * (lower - upper), sine = sqrt(fmax(0, 1 - cosine * cosine));
    double longitude = 2 * PI * ((column + across) / sky->width - 0.5 - sky->turns);
    way[0] = sine * sin(longitude);
    way[1] = cosine;
    way[2] = -sine * cos(longitude);
    *pdf = texel_pdf(sky, row, column);
}
