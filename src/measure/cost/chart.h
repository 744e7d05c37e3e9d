// A chart of error against time as inline SVG, both axes logarithmic, with the Pareto front drawn. Knows nothing of what the points are.
#ifndef MEASURE_COST_CHART_H
#define MEASURE_COST_CHART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define CHART_MOST_POINTS 64

struct chart_point {
    double time, low, high; // ms; low to high is drawn as a line
    double error;           // 0 stands on a line of its own below the axis
    uint32_t colour;        // class "c0", "c1", …
    uint32_t label_colour;  // likewise
    bool hollow, front;
    char label[48]; // beside it [none]
    char title[96]; // said when the pointer is over it
};

struct chart {
    const char *title; // for those who do not see it
    const char *error_name;
    struct chart_point points[CHART_MOST_POINTS];
    size_t count;
    double level;            // an error that is drawn as a line across [none]
    const char *level_label; // what it is
};

// Writes <svg>…</svg>, which is a file of its own, too, if it is cut out; nothing where there is no point.
void chart_write(FILE *to, const struct chart *chart);

#endif
