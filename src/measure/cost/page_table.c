// The table of some axes: a group of rows for each.
#include <string.h>

#include "measure/cost/html.h"
#include "measure/cost/page.h"

static const struct {
    const char *axis, *text;
} MEANINGS[] = {
    {"tier", "how rays are decided, and the arithmetic around it"},
    {"offset", "how a ray leaves a surface: by a fixed share of the scene's size, by the bound on the error of the point, or by that and without "
               "hitting the same primitive again"},
    {"normalize", "vectors to unit length by the built-in inverse root, or scaled first, then by root and division"},
    {"power", "x to the power of y in highlights: built in, or our own to 4 ulp"},
    {"output", "what the file keeps; the time of encoding is in it"},
    {"sum", "adding up the samples of a pixel, in fp32"},
    {"samples", "per pixel"},
    {"sampler", "Owen-scrambled Sobol points, or independent ones"},
    {"together", "each tier with each number of samples"},
};

const struct cost_run *page_run(const struct page *page, const struct cost_row *row) { return &page->cost->runs[row->run]; }

const struct cost_row *page_find(const struct page *page, const char *axis, const char *setting) {
    for (uint32_t i = 0; i < page->cost->row_count; i++)
        if (strcmp(page->cost->rows[i].axis, axis) == 0 && strcmp(page->cost->rows[i].setting, setting) == 0) return &page->cost->rows[i];
    return NULL;
}

static const struct cost_row *base_of(const struct page *page, const char *axis) {
    for (uint32_t i = 0; i < page->cost->row_count; i++)
        if (page->cost->rows[i].base && strcmp(page->cost->rows[i].axis, axis) == 0) return &page->cost->rows[i];
    return NULL;
}

static void write_group(struct page *page, const char *axis) {
    fprintf(page->to, "<tr class=\"group\"><td colspan=\"8\"><b>%s</b>", axis);
    for (size_t i = 0; i < sizeof MEANINGS / sizeof *MEANINGS; i++)
        if (strcmp(MEANINGS[i].axis, axis) == 0) fprintf(page->to, " · %s", MEANINGS[i].text);
    fputs("</td></tr>\n", page->to);
}

static void write_cell(struct page *page, double value) {
    fputs("<td>", page->to);
    html_number(page->to, value);
    fputs("</td>", page->to);
}

static void write_row(struct page *page, const struct cost_row *row, const struct cost_row *base) {
    const struct cost_run *run = page_run(page, row);
    const struct cost_decisions *decisions = &page->cost->decisions[run->config.tier];
    fprintf(page->to, "<tr%s><td>", row->pareto ? " class=\"on\"" : "");
    html_text(page->to, row->setting);
    fputs("</td><td>", page->to);
    html_number(page->to, run->median);
    fputs("</td><td><small>", page->to);
    html_number(page->to, run->low);
    fputs(" – ", page->to);
    html_number(page->to, run->high);
    fputs("</small></td>", page->to);
    if (base)
        fprintf(page->to, "<td>%.2f</td>", run->median / page_run(page, base)->median);
    else
        fputs("<td></td>", page->to);
    write_cell(page, 1e6 * (double)decisions->wrong / (double)decisions->rays);
    fputs("<td>", page->to);
    html_number(page->to, decisions->ulp_max);
    fputs(" <small>/ ", page->to);
    html_number(page->to, decisions->ulp_mean);
    fputs("</small></td>", page->to);
    write_cell(page, run->rmse);
    write_cell(page, run->flip);
    fputs("</tr>\n", page->to);
    if (run->nonfinite_pixels)
        fprintf(page->to, "<tr class=\"worst\"><td colspan=\"8\">in %llu pixels samples came out NaN or infinite</td></tr>\n",
                (unsigned long long)run->nonfinite_pixels);
}

void page_table(struct page *page, const char *const *axes, size_t count) {
    fputs("<div class=\"scroll\"><table>\n<thead><tr><th></th><th>time<br />ms</th><th>quartiles</th><th>times<br />the base</th>"
          "<th>wrong in<br />a million</th><th>ulp of t<br />max / mean</th><th>RMSE</th><th>FLIP</th></tr></thead>\n<tbody>\n",
          page->to);
    for (size_t i = 0; i < count; i++) {
        const struct cost_row *base = base_of(page, axes[i]);
        if (base) write_group(page, axes[i]);
        for (uint32_t k = 0; k < page->cost->row_count; k++)
            if (strcmp(page->cost->rows[k].axis, axes[i]) == 0) write_row(page, &page->cost->rows[k], base);
    }
    fputs("</tbody></table></div>\n", page->to);
}
