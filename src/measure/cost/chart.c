#include "measure/cost/chart.h"

#include <math.h>
#include <string.h>

#include "measure/cost/html.h"
#include "measure/cost/style.h"

#define WIDTH 760.0
#define HEIGHT 430.0
#define LEFT 62.0
#define RIGHT 22.0
#define TOP 14.0
#define BOTTOM 46.0
#define ZERO_BAND 30.0 // below the axis, for errors of 0
#define DOT 5.0
#define GLYPH 6.3 // mean width of a character of a label
#define LINE 14.0 // height of one
#define GAP 3.0   // between labels

struct box {
    double x0, y0, x1, y1;
};

struct plot {
    FILE *to;
    const struct chart *chart;
    double time_low, time_high, error_low, error_high; // decades of the errors are whole
    bool has_zero;
    struct box taken[5 * CHART_MOST_POINTS + 4]; // by dots, their spreads and labels, the front and the level
    size_t taken_count;
};

// --------------------------------------------------------------------------------------------------------------- mapping

static double share(double value, double low, double high) { return log(value / low) / log(high / low); }

static double x_of(const struct plot *plot, double time) {
    return LEFT + (WIDTH - LEFT - RIGHT) * share(time, plot->time_low, plot->time_high);
}

static double floor_of(const struct plot *plot) { return HEIGHT - BOTTOM - (plot->has_zero ? ZERO_BAND : 0); }

static double y_of(const struct plot *plot, double error) {
    if (error <= 0) return HEIGHT - BOTTOM - 0.5 * ZERO_BAND;
    return floor_of(plot) - (floor_of(plot) - TOP) * share(error, plot->error_low, plot->error_high);
}

static void find_ranges(struct plot *plot) {
    double low_time = INFINITY, high_time = 0, low = INFINITY, high = 0;
    for (size_t i = 0; i < plot->chart->count; i++) {
        const struct chart_point *point = &plot->chart->points[i];
        low_time = fmin(low_time, point->low), high_time = fmax(high_time, point->high);
        if (point->error > 0) low = fmin(low, point->error), high = fmax(high, point->error);
        plot->has_zero = plot->has_zero || point->error <= 0;
    }
    if (plot->chart->level > 0) low = fmin(low, plot->chart->level), high = fmax(high, plot->chart->level);
    if (!(high > 0)) low = 0.1, high = 1;
    double spread = fmax(high_time / low_time, 1.2);
    plot->time_low = low_time / pow(spread, 0.06);
    plot->time_high = high_time * pow(spread, 0.16); // labels stand to the right of their dots
    plot->error_low = pow(10, floor(log10(low) - 0.1));
    plot->error_high = pow(10, ceil(log10(high) + 0.1));
}

// ----------------------------------------------------------------------------------------------------------------- axes

// Ticks of a logarithmic axis: ever more of the multiples of powers of ten, until there are four.
static size_t choose_ticks(double *ticks, size_t capacity, double low, double high) {
    static const double steps[][11] = {{1}, {1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 6, 8}, {1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5}};
    static const int counts[] = {1, 2, 3, 8, 11};
    size_t count = 0;
    for (size_t set = 0; set < sizeof counts / sizeof *counts && count < 4; set++) {
        count = 0;
        for (double decade = pow(10, floor(log10(low))); decade <= high && count < capacity; decade *= 10)
            for (int i = 0; i < counts[set] && count < capacity; i++)
                if (decade * steps[set][i] >= low && decade * steps[set][i] <= high) ticks[count++] = decade * steps[set][i];
    }
    return count;
}

static void draw_time_axis(const struct plot *plot) {
    double ticks[64];
    size_t count = choose_ticks(ticks, 64, plot->time_low, plot->time_high);
    for (size_t i = 0; i < count; i++) {
        char number[32];
        snprintf(number, sizeof number, "%.4g", ticks[i]);
        double x = x_of(plot, ticks[i]);
        fprintf(plot->to, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\" /><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", x,
                TOP, HEIGHT - BOTTOM, x, HEIGHT - BOTTOM + 18, number);
    }
    fprintf(plot->to, "<text class=\"name\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">time in ms →</text>\n", WIDTH - RIGHT, HEIGHT - 6);
}

static void draw_error_axis(const struct plot *plot) {
    int first = (int)lround(log10(plot->error_low)), last = (int)lround(log10(plot->error_high));
    int step = last - first > 8 ? 2 : 1;
    for (int exponent = first; exponent <= last; exponent += step) {
        double y = y_of(plot, pow(10, exponent));
        fprintf(plot->to, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\" />", LEFT, y, WIDTH - RIGHT);
        fprintf(plot->to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">10<tspan dy=\"-5\" font-size=\"9\">%s%d</tspan></text>\n",
                LEFT - 8, y + 4, exponent < 0 ? "−" : "", exponent < 0 ? -exponent : exponent);
    }
    if (plot->has_zero) {
        double y = y_of(plot, 0);
        fprintf(plot->to, "<path class=\"grid zero\" d=\"M%.1f %.1fH%.1f\" />", LEFT, y, WIDTH - RIGHT);
        fprintf(plot->to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">0</text>\n", LEFT - 8, y + 4);
    }
    fprintf(plot->to, "<text class=\"name\" transform=\"translate(12 %.1f) rotate(-90)\" text-anchor=\"end\">%s →</text>\n", TOP,
            plot->chart->error_name);
}

// ---------------------------------------------------------------------------------------------------------- what is taken

static size_t text_length(const char *text) {
    size_t length = 0;
    for (; *text; text++) length += ((unsigned char)*text & 0xc0) != 0x80;
    return length;
}

// A line across or down, or a text, that labels should not lie on.
static void take(struct plot *plot, double x0, double y0, double x1, double y1) {
    plot->taken[plot->taken_count++] = (struct box){x0 - 1.5, y0 - 1.5, x1 + 1.5, y1 + 1.5};
}

static void draw_level(struct plot *plot) {
    if (!(plot->chart->level > 0)) return;
    double y = y_of(plot, plot->chart->level), right = WIDTH - RIGHT;
    fprintf(plot->to, "<path class=\"level\" d=\"M%.1f %.1fH%.1f\" />", LEFT, y, right);
    fprintf(plot->to, "<text class=\"level\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", right - 4, y - 5,
            plot->chart->level_label);
    take(plot, LEFT, y, right, y);
    take(plot, right - 4 - GLYPH * (double)text_length(plot->chart->level_label), y - LINE, right, y);
}

// --------------------------------------------------------------------------------------------------------------- points

// The stairs below which nothing was found: from each point of the front to the right, then down to the next.
static void draw_front(struct plot *plot) {
    bool drawn[CHART_MOST_POINTS] = {false};
    double height = INFINITY, last_x = LEFT, last_y = TOP;
    fputs("<path class=\"front\" d=\"", plot->to);
    for (bool first = true;; first = false) {
        size_t next = plot->chart->count;
        for (size_t i = 0; i < plot->chart->count; i++) {
            const struct chart_point *point = &plot->chart->points[i];
            if (!point->front || drawn[i] || !(point->error < height)) continue;
            if (next == plot->chart->count || point->time < plot->chart->points[next].time) next = i;
        }
        if (next == plot->chart->count) break;
        const struct chart_point *point = &plot->chart->points[next];
        drawn[next] = true;
        height = point->error;
        double x = x_of(plot, point->time), y = y_of(plot, point->error);
        if (first)
            fprintf(plot->to, "M%.1f %.1fV%.1f", x, TOP, y);
        else
            fprintf(plot->to, "H%.1fV%.1f", x, y);
        if (!first) take(plot, last_x, last_y, x, last_y);
        take(plot, x, first ? TOP : last_y, x, y);
        last_x = x, last_y = y;
    }
    take(plot, last_x, last_y, WIDTH - RIGHT, last_y);
    fprintf(plot->to, "H%.1f\" />\n", WIDTH - RIGHT);
}

static void draw_dot(struct plot *plot, const struct chart_point *point) {
    double x = x_of(plot, point->time), y = y_of(plot, point->error);
    fprintf(plot->to, "<g class=\"c%u\"><path class=\"spread\" d=\"M%.1f %.1fH%.1f\" />", point->colour, x_of(plot, point->low), y,
            x_of(plot, point->high));
    fprintf(plot->to, "<circle%s cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"><title>", point->hollow ? " class=\"hollow\"" : "", x, y, DOT);
    html_text(plot->to, point->title);
    fputs("</title></circle></g>\n", plot->to);
    plot->taken[plot->taken_count++] = (struct box){x - DOT, y - DOT, x + DOT, y + DOT};
    take(plot, x_of(plot, point->low), y, x_of(plot, point->high), y);
}

// --------------------------------------------------------------------------------------------------------------- labels

static double overlap(const struct box *a, const struct box *b) {
    double x = fmin(a->x1, b->x1) - fmax(a->x0, b->x0), y = fmin(a->y1, b->y1) - fmax(a->y0, b->y0);
    return x > 0 && y > 0 ? x * y : 0;
}

// How bad a place is: what it covers, and what of it lies outside.
static double badness(const struct plot *plot, const struct box *box) {
    double bad = 0;
    for (size_t i = 0; i < plot->taken_count; i++) bad += overlap(box, &plot->taken[i]);
    bad += 100 * (fmax(0, box->x1 - WIDTH) + fmax(0, LEFT - box->x0) + fmax(0, box->y1 - (HEIGHT - BOTTOM)) + fmax(0, -box->y0));
    return bad;
}

// Beside its dot, at the first place around it that is free, else at the freest.
static void draw_label(struct plot *plot, const struct chart_point *point) {
    static const double places[][2] = {{1, 0},    {0.4, -0.8}, {0.4, 0.9},  {-1, 0},    {-0.4, -0.8}, {-0.4, 0.9},
                                       {0, -1.1}, {0, 1.2},    {0.8, -1.9}, {0.8, 2},   {-0.8, -1.9}, {-0.8, 2},
                                       {0.8, -3}, {0.8, 3.1},  {-0.8, -3},  {-0.8, 3.1}};
    double x = x_of(plot, point->time), y = y_of(plot, point->error), width = GLYPH * (double)text_length(point->label), best = INFINITY;
    struct box chosen = {0, 0, 0, 0};
    for (size_t i = 0; i < sizeof places / sizeof *places && best > 0; i++) {
        double across = places[i][0], left = x + across * (DOT + 4) - (across > 0 ? 0 : across < 0 ? width : 0.5 * width);
        double middle = y + places[i][1] * LINE;
        struct box box = {left - GAP, middle - 0.5 * LINE, left + width + GAP, middle + 0.5 * LINE};
        double bad = badness(plot, &box);
        if (bad < best) best = bad, chosen = box;
    }
    double middle = 0.5 * (chosen.y0 + chosen.y1);
    if (fabs(middle - y) > 1.5 * LINE)
        fprintf(plot->to, "<path class=\"lead\" d=\"M%.1f %.1fL%.1f %.1f\" />", x, y,
                x < chosen.x0   ? chosen.x0
                : x > chosen.x1 ? chosen.x1
                                : x,
                middle < y ? chosen.y1 : chosen.y0);
    fprintf(plot->to, "<text class=\"label c%u\" x=\"%.1f\" y=\"%.1f\">", point->label_colour, chosen.x0 + GAP, middle + 4);
    html_text(plot->to, point->label);
    fputs("</text>\n", plot->to);
    plot->taken[plot->taken_count++] = chosen;
}

void chart_write(FILE *to, const struct chart *chart) {
    struct plot plot = {.to = to, .chart = chart};
    if (chart->count == 0) return;
    find_ranges(&plot);
    fprintf(to, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", WIDTH, HEIGHT);
    html_text(to, chart->title);
    fprintf(to, "\">\n<style>\n%s</style>\n", chart_style);
    draw_time_axis(&plot);
    draw_error_axis(&plot);
    draw_level(&plot);
    draw_front(&plot);
    for (size_t i = 0; i < chart->count; i++) draw_dot(&plot, &chart->points[i]);
    for (size_t i = 0; i < chart->count; i++)
        if (*chart->points[i].label) draw_label(&plot, &chart->points[i]);
    fputs("</svg>\n", to);
}
