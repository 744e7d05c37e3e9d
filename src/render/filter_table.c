#include "render/filter_table.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

// What lies left of s·r - r, 0 ≤ s ≤ 1, in a filter of weight 1.
static double gaussian_share(double s) {
    const double edge = 4 / sqrt(2); // r in units of √2·σ
    return (erfc(edge * (1 - s)) - erfc(edge)) / (2 * erf(edge));
}

static double blackman_harris_share(double s) {
    static const double a[] = {0.35875, 0.48829, 0.14128, 0.01168};
    double sum = a[0] * s / 2;
    for (int k = 1; k < 4; k++) sum += (k % 2 ? -1 : 1) * a[k] * sin(k * PI * s) / (2 * k * PI);
    return sum / a[0];
}

static double invert(double (*share)(double s), double w) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (share(middle) <= w) low = middle;
        else high = middle;
    }
    return low;
}

// s where the share is w, 0 ≤ w ≤ 1/2.
static double find_share(enum film_filter type, double w) {
    if (w == 0 || w == 0.5) return 2 * w;
    switch (type) {
    case FILTER_BOX: return 2 * w;
    case FILTER_TENT: return sqrt(2 * w);
    case FILTER_GAUSSIAN: return invert(gaussian_share, w);
    case FILTER_BLACKMAN_HARRIS: return invert(blackman_harris_share, w);
    }
    return 2 * w;
}

// Where on [0, 1/2] a knot lies; those after the last one, which nothing lies beyond, with it.
static double knot_place(int knot) {
    if (knot == 0) return 0;
    int doubling = (knot - 1) / FILTER_CELLS, cell = (knot - 1) % FILTER_CELLS;
    return fmin(ldexp(1 + (double)cell / FILTER_CELLS, doubling - 24), 0.5);
}

void filter_table_make(struct filter_table *out, enum film_filter type, float radius) {
    for (int i = 0; i < FILTER_KNOTS; i++) out->knots[i] = (float)(0.5 + radius * (find_share(type, knot_place(i)) - 1));
}

// Each assignment rounds.
static float offset_of(const struct filter_table *table, float u) {
    float w = u < 0.5f ? u : 1.0f - u, share = 0;
    int knot = 0;
    if (w > 0) {
        int exponent;
        float place = (frexpf(w, &exponent) * 2 - 1) * FILTER_CELLS; // in its doubling, exact
        int cell = (int)place;
        knot = 1 + (exponent + 23) * FILTER_CELLS + cell;
        share = place - (float)cell;
    }
    float width = table->knots[knot + 1] - table->knots[knot];
    float part = share * width;
    float offset = table->knots[knot] + part;
    return u < 0.5f ? offset : 1.0f - offset;
}

void filter_table_offset(float offset[2], const struct filter_table *table) {
    for (int i = 0; i < 2; i++) offset[i] = offset_of(table, offset[i]);
}
