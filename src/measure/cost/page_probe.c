// The device's arithmetic, as the probe found it: a row for each thing, fp32 and fp64 beside each other.
#include <math.h>
#include <string.h>

#include "measure/cost/html.h"
#include "measure/cost/page.h"

// The name without the type that it begins with.
static const char *plain_name(const struct gn_probe_row *row) { return strncmp(row->name, "fp", 2) == 0 ? row->name + 5 : row->name; }

static bool is_double(const struct gn_probe_row *row) { return strncmp(row->name, "fp64 ", 5) == 0; }

static bool go_together(const struct gn_probe_row *row, const struct gn_probe_row *next) {
    return strncmp(row->name, "fp32 ", 5) == 0 && is_double(next) && strcmp(plain_name(row), plain_name(next)) == 0;
}

static void write_value(FILE *to, const struct gn_probe_row *row) {
    fputs("<td>", to);
    if (row) {
        bool whole = row->value >= 0 && row->value < 1e6 && row->value == floor(row->value);
        if (whole)
            html_count(to, (uint64_t)row->value);
        else
            html_number(to, row->value);
        fputs(" <small>", to);
        html_text(to, row->unit);
        fputs("</small>", to);
    }
    fputs("</td>", to);
}

// `row` and `doubles`: of fp32 and of fp64; one of them may be NULL.
static void write_row(struct page *page, const struct gn_probe_row *row, const struct gn_probe_row *doubles) {
    const struct gn_probe_row *any = row ? row : doubles;
    uint32_t needed = (row ? row->needed_by : 0) | (doubles ? doubles->needed_by : 0);
    bool broken = (row && row->breaks) || (doubles && doubles->breaks);
    fprintf(page->to, "<tr%s><td>", broken ? " class=\"worst\"" : "");
    html_text(page->to, plain_name(any));
    fputs("</td>", page->to);
    write_value(page->to, row);
    write_value(page->to, doubles);
    fputs("<td class=\"words\">", page->to);
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        for (int accuracy = 0; accuracy < GN_ACCURACY_COUNT; accuracy++)
            if (needed >> accuracy & 1 && strcmp(page->place->tiers[accuracy].name, cost_tier_name(tier)) == 0)
                fprintf(page->to, "<span class=\"c%u\">%s</span> ", tier, cost_tier_name(tier));
    fputs("</td><td class=\"words\"><small>", page->to);
    html_text(page->to, any->meaning);
    fputs("</small></td></tr>\n", page->to);
}

void page_probe(struct page *page) {
    const struct cost_place *place = page->place;
    fputs("<h2>The device's arithmetic</h2>\n<p>What its operations really do, on many numbers each; beside it the tiers that rely on that.</p>\n"
          "<div class=\"scroll\"><table class=\"probe\">\n<thead><tr><th></th><th>fp32</th><th>fp64</th><th></th><th></th></tr></thead>\n<tbody>\n",
          page->to);
    for (uint32_t i = 0; i < place->probe_count; i++) {
        const struct gn_probe_row *row = &place->probe[i];
        bool pair = i + 1 < place->probe_count && go_together(row, row + 1);
        write_row(page, is_double(row) ? NULL : row, is_double(row) ? row : pair ? row + 1 : NULL);
        i += pair;
    }
    fputs("</tbody></table></div>\n", page->to);
}
