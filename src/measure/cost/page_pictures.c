// The pictures: where each setting differs from the reference, in false colour on one logarithmic scale.
#include <string.h>

#include "measure/compare.h"
#include "measure/cost/html.h"
#include "measure/cost/page.h"
#include "measure/layers.h"

#define RAMP 256 // pixels of the scale

static bool write_picture(struct page *page, const struct image *image, const char *alternative) {
    return html_image(page->to, page->ctx, image, page->place->transfer, alternative);
}

static bool write_error_map(struct page *page, const struct cost_run *run) {
    struct image error = {0}, view = {0};
    bool done = layer_of_error(&error, page->ctx, &run->color, &page->cost->targets[run->config.target].color) &&
                view_of_error(&view, page->ctx, &error) && html_image(page->to, page->ctx, &view, TRANSFER_SRGB, "where it is wrong");
    image_finish(&error);
    image_finish(&view);
    return done;
}

static void write_caption(struct page *page, const char *name, const struct cost_run *run) {
    fputs("<figcaption>", page->to);
    html_text(page->to, name);
    if (run) {
        fputs(" · RMSE ", page->to);
        html_number(page->to, run->rmse);
        fputs(", largest ", page->to);
        html_number(page->to, run->max_abs);
    }
    fputs("</figcaption></figure>\n", page->to);
}

static bool write_tier(struct page *page, const struct cost_row *row) {
    const struct cost_run *run = page_run(page, row);
    fputs("<figure><div class=\"pair\">", page->to);
    if (!write_picture(page, &run->color, row->setting) || !write_error_map(page, run)) return false;
    fputs("</div>", page->to);
    write_caption(page, row->setting, run);
    return true;
}

static bool write_change(struct page *page, const struct cost_row *row) {
    char name[80];
    fputs("<figure>", page->to);
    if (!write_error_map(page, page_run(page, row))) return false;
    snprintf(name, sizeof name, "%s: %s", row->axis, row->setting);
    write_caption(page, name, page_run(page, row));
    return true;
}

// What the colours of the error maps mean: errors from 1e-7 to 1, by decades.
static bool write_scale(struct page *page) {
    struct image ramp, view = {0};
    if (!image_init(&ramp, page->ctx, RAMP, 1, 1, "the scale")) return false;
    for (int i = 0; i < RAMP; i++) ramp.pixels[i] = (float)i / (RAMP - 1);
    fputs("<div class=\"scale\">", page->to);
    bool done = heat_map(&view, page->ctx, &ramp) && html_image(page->to, page->ctx, &view, TRANSFER_SRGB, "the scale of the error maps");
    fputs("<div><span>10⁻⁷</span><span>10⁻⁶</span><span>10⁻⁵</span><span>10⁻⁴</span><span>10⁻³</span><span>0.01</span><span>0.1</span>"
          "<span>1</span></div></div>\n",
          page->to);
    image_finish(&ramp);
    image_finish(&view);
    return done;
}

bool page_pictures(struct page *page) {
    const struct cost *cost = page->cost;
    fputs("<h2>Where it is wrong</h2>\n<div class=\"pictures tiers\">\n<figure>", page->to);
    if (!write_picture(page, &cost->targets[COST_CENTRES].color, "the reference's picture")) return false;
    write_caption(page, "the reference", NULL);
    fputs("<div><p>Beside each picture, and below where only one thing was changed: the largest difference of a colour channel from the "
          "reference, pixel by pixel. Black is right to 10⁻⁷, which is what rounding a colour to fp32 leaves.</p>\n",
          page->to);
    if (!write_scale(page)) return false;
    fputs("</div>\n", page->to);
    for (uint32_t i = 0; i < cost->row_count; i++)
        if (strcmp(cost->rows[i].axis, "tier") == 0 && !write_tier(page, &cost->rows[i])) return false;
    fputs("</div>\n<h3>One thing changed</h3>\n<div class=\"pictures\">\n", page->to);
    for (uint32_t i = 0; i < cost->row_count; i++) {
        const struct cost_row *row = &cost->rows[i];
        bool changed = row->front == COST_FRONT_ARITHMETIC && !row->base && strcmp(row->axis, "tier") != 0;
        if (changed && !write_change(page, row)) return false;
    }
    fputs("</div>\n", page->to);
    return true;
}
