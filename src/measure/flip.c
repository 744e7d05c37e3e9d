// FLIP after Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating Images",
// HPG 2020 (low dynamic range). Section and equation numbers are that paper's.
//
// Colour: both images go to an opponent space, are blurred as the eye blurs each of its channels, and are compared in CIELab. Features:
// edges and points are sought in both images' luminance. The second amplifies the first, pixel by pixel.
//
// All the paper's filters are products of a function of x and one of y, or sums of two such products. So each is a filter along rows,
// then one along columns. A band of rows is filtered at a time, with the rows above and below that it needs, which keeps the memory
// small and the bands independent of each other: threads share them out.
#include "measure/flip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"

#define PI 3.14159265358979323846
// A monitor of 3840 pixels on 0.7 m, seen from 0.7 m away (section 4.1).
#define PIXELS_PER_DEGREE (3840 * PI / 180)
// The widest filter's: 3 standard deviations, rounded up (blue-yellow: 9.05 pixels; features: 8.24).
#define RADIUS 10
#define TAPS (2 * RADIUS + 1)
#define BAND 32

// ---- colour spaces

// From linear sRGB to X/Xn, Y/Yn, Z/Zn, and back; from the primaries and white point of IEC 61966-2-1, rows scaled to give 1 for white.
static const double TO_XYZ[3][3] = {{1013504.0 / 2335869, 878810.0 / 2335869, 443555.0 / 2335869},
                                    {87098.0 / 409605, 175762.0 / 245763, 12673.0 / 175545},
                                    {15836.0 / 892167, 878810.0 / 8029503, 7008169.0 / 8029503}};
static const double FROM_XYZ[3][3] = {{3.0803990906794647, -1.5373831775700935, -0.543015913109371},
                                      {-0.921223358860277, 1.8759675015077206, 0.0452558573525563},
                                      {0.052873938970364444, -0.20397695888897657, 1.151103019918612}};

static void multiply(const double matrix[3][3], const double in[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
}

// To 0…1; NaN gives 0.
static double clamp(double value) { return value > 0 ? value < 1 ? value : 1 : 0; }

// The linearised opponent space YCxCz (section 4.1.1, equation 3).
static void opponent_from_pixel(const float pixel[3], double out[3]) {
    double rgb[3] = {clamp((double)pixel[0]), clamp((double)pixel[1]), clamp((double)pixel[2])}, xyz[3];
    multiply(TO_XYZ, rgb, xyz);
    out[0] = 116 * xyz[1] - 16;
    out[1] = 500 * (xyz[0] - xyz[1]);
    out[2] = 200 * (xyz[1] - xyz[2]);
}

static double lab_curve(double t) { return t > 216.0 / 24389 ? cbrt(t) : 841.0 / 108 * t + 4.0 / 29; }

// CIELab, its chromas scaled with lightness for the Hunt effect (section 4.1.3).
static void hunt_lab_from_rgb(const double rgb[3], double out[3]) {
    double xyz[3];
    multiply(TO_XYZ, rgb, xyz);
    double x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]), lightness = 116 * y - 16;
    out[0] = lightness;
    out[1] = 0.01 * lightness * 500 * (x - y);
    out[2] = 0.01 * lightness * 200 * (y - z);
}

static void hunt_lab_from_opponent(const double opponent[3], double out[3]) {
    double y = (opponent[0] + 16) / 116, xyz[3] = {y + opponent[1] / 500, y, y - opponent[2] / 200}, rgb[3];
    multiply(FROM_XYZ, xyz, rgb);
    for (int i = 0; i < 3; i++) rgb[i] = clamp(rgb[i]);
    hunt_lab_from_rgb(rgb, out);
}

// HyAB (Abasi et al. 2020): city blocks between lightness and chroma, Euclid within chroma (equation 6).
static double hyab(const double a[3], const double b[3]) { return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]); }

// ---- filters

// What is filtered along rows, as which filter of which opponent channel.
enum plane { ACHROMATIC, RED_GREEN, BLUE_YELLOW, BLUE_YELLOW_WIDE, SMOOTH, EDGE, POINT, PLANE_COUNT };
static const int PLANE_CHANNEL[PLANE_COUNT] = {0, 1, 2, 2, 0, 0, 0};

// What is then filtered along columns: the plane, and the filter.
enum { RESPONSE_COUNT = 8 };
enum { EDGE_X = 4, EDGE_Y, POINT_X, POINT_Y };
static const enum plane RESPONSE[RESPONSE_COUNT][2] = {{ACHROMATIC, ACHROMATIC},
                                                       {RED_GREEN, RED_GREEN},
                                                       {BLUE_YELLOW, BLUE_YELLOW},
                                                       {BLUE_YELLOW_WIDE, BLUE_YELLOW_WIDE},
                                                       {EDGE, SMOOTH},
                                                       {SMOOTH, EDGE},
                                                       {POINT, SMOOTH},
                                                       {SMOOTH, POINT}};

struct flip {
    const struct image *images[2];
    struct image *map;
    double filters[PLANE_COUNT][TAPS];
    double share[2]; // of the two Gaussians in the blue-yellow filter
    double largest;  // colour difference that there is, to the power 0.7
};

// A Gaussian of weight 1 in all. Returns the sum before.
static double make_gaussian(double taps[TAPS], double deviation, int radius) {
    double sum = 0;
    for (int i = -radius; i <= radius; i++) sum += taps[RADIUS + i] = exp(-0.5 * i * i / (deviation * deviation));
    for (int i = 0; i < TAPS; i++) taps[i] /= sum;
    return sum;
}

// Scales the positive taps to the sum 1 and the negative ones to -1.
static void balance(double taps[TAPS]) {
    double sums[2] = {0, 0};
    for (int i = 0; i < TAPS; i++) sums[taps[i] < 0] += fabs(taps[i]);
    for (int i = 0; i < TAPS; i++)
        if (taps[i] != 0) taps[i] /= sums[taps[i] < 0];
}

// exp(-π² x²/b), x in degrees, is the blur of a contrast sensitivity function (section 4.1.2, table 1): its deviation in pixels.
static double csf_deviation(double b) { return PIXELS_PER_DEGREE * sqrt(b / 2) / PI; }

static void make_filters(struct flip *flip) {
    const double a[2] = {34.1, 13.5}, b[2] = {0.04, 0.025}; // of blue-yellow, the one sum of two Gaussians
    make_gaussian(flip->filters[ACHROMATIC], csf_deviation(0.0047), RADIUS);
    make_gaussian(flip->filters[RED_GREEN], csf_deviation(0.0053), RADIUS);
    for (int i = 0; i < 2; i++) {
        double sum = make_gaussian(flip->filters[BLUE_YELLOW + i], csf_deviation(b[i]), RADIUS);
        flip->share[i] = a[i] * sqrt(PI / b[i]) * sum * sum;
    }
    double all = flip->share[0] + flip->share[1];
    for (int i = 0; i < 2; i++) flip->share[i] /= all;
    // Derivatives of a Gaussian as wide as the eye's detectors: 0.082 degrees (section 4.2.1).
    double deviation = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    int radius = (int)ceil(3 * deviation);
    make_gaussian(flip->filters[SMOOTH], deviation, radius);
    for (int i = -radius; i <= radius; i++) {
        double x = i / deviation, gaussian = flip->filters[SMOOTH][RADIUS + i];
        flip->filters[EDGE][RADIUS + i] = -x * gaussian;
        flip->filters[POINT][RADIUS + i] = (x * x - 1) * gaussian;
    }
    balance(flip->filters[EDGE]);
    balance(flip->filters[POINT]);
}

static void filter_row(double *out, const double *padded, const double taps[TAPS], size_t width) {
    for (size_t x = 0; x < width; x++) {
        double sum = 0;
        for (size_t i = 0; i < TAPS; i++) sum += taps[i] * padded[x + i];
        out[x] = sum;
    }
}

static void filter_columns(double *out, const double *rows, const double taps[TAPS], size_t width) {
    memset(out, 0, width * sizeof *out);
    for (size_t i = 0; i < TAPS; i++)
        for (size_t x = 0; x < width; x++) out[x] += taps[i] * rows[i * width + x];
}

// ---- the error of a pixel

// What both images have at a pixel.
struct sight {
    double lab[3], edge, point;
};

static struct sight see(const struct flip *flip, const double *responses, size_t width, size_t x) {
    double r[RESPONSE_COUNT];
    for (size_t i = 0; i < RESPONSE_COUNT; i++) r[i] = responses[i * width + x];
    double opponent[3] = {r[0], r[1], flip->share[0] * r[2] + flip->share[1] * r[3]};
    // The features are those of Y as 0…1, where the filters saw 116·Y - 16.
    struct sight sight = {.edge = hypot(r[EDGE_X], r[EDGE_Y]) / 116, .point = hypot(r[POINT_X], r[POINT_Y]) / 116};
    hunt_lab_from_opponent(opponent, sight.lab);
    return sight;
}

// The colour difference, compressed so that 0.4 of the largest that there is becomes 0.95 (section 4.1.4).
static double colour_error(const struct sight *a, const struct sight *b, double largest) {
    double error = pow(hyab(a->lab, b->lab), 0.7), knee = 0.4 * largest;
    return error < knee ? 0.95 / knee * error : 0.95 + (error - knee) / (largest - knee) * 0.05;
}

static double feature_error(const struct sight *a, const struct sight *b) {
    return sqrt(fmax(fabs(a->edge - b->edge), fabs(a->point - b->point)) / sqrt(2)); // equation 14, with the exponent 0.5
}

// ---- bands of rows

// For an image and the rows of a band with RADIUS more on either side: PLANE_COUNT planes, filtered along rows. At the border, pixels
// repeat.
static void filter_band(const struct flip *flip, const struct image *image, size_t first, size_t rows, double *planes, double *padded) {
    size_t width = image->width, stride = width + 2 * RADIUS;
    for (size_t i = 0; i < rows; i++) {
        size_t y = first + i < RADIUS ? 0 : first + i - RADIUS;
        if (y >= image->height) y = image->height - 1;
        for (size_t x = 0; x < stride; x++) {
            size_t from = x < RADIUS ? 0 : x - RADIUS;
            double opponent[3];
            opponent_from_pixel(image->pixels + 3 * (y * width + (from < width ? from : width - 1)), opponent);
            for (size_t c = 0; c < 3; c++) padded[c * stride + x] = opponent[c];
        }
        for (size_t p = 0; p < PLANE_COUNT; p++)
            filter_row(planes + (p * rows + i) * width, padded + (size_t)PLANE_CHANNEL[p] * stride, flip->filters[p], width);
    }
}

static void compare_row(const struct flip *flip, double *const responses[2], float *out, size_t width) {
    for (size_t x = 0; x < width; x++) {
        struct sight a = see(flip, responses[0], width, x), b = see(flip, responses[1], width, x);
        out[x] = (float)pow(colour_error(&a, &b, flip->largest), 1 - feature_error(&a, &b)); // equation 15
    }
}

static bool compare_band(void *data, size_t begin, size_t end, unsigned thread) {
    (void)thread;
    const struct flip *flip = data;
    size_t width = flip->map->width, rows = end - begin + 2 * RADIUS, plane = rows * width;
    double *memory = calloc(2 * PLANE_COUNT * plane + 2 * RESPONSE_COUNT * width + 3 * (width + 2 * RADIUS), sizeof *memory);
    if (!memory) return false;
    double *planes[2] = {memory, memory + PLANE_COUNT * plane};
    double *responses[2] = {planes[1] + PLANE_COUNT * plane, planes[1] + PLANE_COUNT * plane + RESPONSE_COUNT * width};
    double *padded = responses[1] + RESPONSE_COUNT * width;
    for (size_t k = 0; k < 2; k++) filter_band(flip, flip->images[k], begin, rows, planes[k], padded);
    for (size_t y = 0; y < end - begin; y++) {
        for (size_t k = 0; k < 2; k++)
            for (size_t i = 0; i < RESPONSE_COUNT; i++) {
                const double *above = planes[k] + RESPONSE[i][0] * plane + y * width;
                filter_columns(responses[k] + i * width, above, flip->filters[RESPONSE[i][1]], width);
            }
        compare_row(flip, responses, flip->map->pixels + (begin + y) * width, width);
    }
    free(memory);
    return true;
}

bool flip_compare(struct image *map, double *mean, struct context *ctx, const struct image *a, const struct image *b) {
    struct flip flip = {.images = {a, b}, .map = map};
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double lab_green[3], lab_blue[3];
    hunt_lab_from_rgb(green, lab_green);
    hunt_lab_from_rgb(blue, lab_blue);
    flip.largest = pow(hyab(lab_green, lab_blue), 0.7);
    make_filters(&flip);
    *mean = 0;
    if (!image_init(map, ctx, a->width, a->height, 1, "the FLIP map")) return false;
    if (!parallel_for_progress(ctx, "flip", a->height, BAND, compare_band, &flip)) {
        image_finish(map);
        return fail(ctx, GN_LIMIT, "no memory to compare images %u pixels wide", a->width);
    }
    size_t count = (size_t)map->width * map->height;
    for (size_t i = 0; i < count; i++) *mean += (double)map->pixels[i];
    if (count > 0) *mean /= (double)count;
    return true;
}
