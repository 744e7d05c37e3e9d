// Parts of the report's page, each in a file of its own.
#ifndef MEASURE_COST_PAGE_H
#define MEASURE_COST_PAGE_H

#include <stdio.h>

#include "measure/cost/report.h"

#define PAGE_REST_COLOUR 4 // class of what is no tier's; a tier's is its number

struct page {
    FILE *to;
    struct context *ctx;
    const struct cost *cost;
    const struct cost_place *place;
};

// The run of a row, and the row of an axis and setting, or NULL.
const struct cost_run *page_run(const struct page *page, const struct cost_row *row);
const struct cost_row *page_find(const struct page *page, const char *axis, const char *setting);

// page_table.c: the rows of some axes.
void page_table(struct page *page, const char *const *axes, size_t count);

// page_pictures.c: the reference, every tier's picture and error map, the error maps of the other settings, the scale.
bool page_pictures(struct page *page);

// page_probe.c: what the device's arithmetic does.
void page_probe(struct page *page);

#endif
