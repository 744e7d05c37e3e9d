// The page from top to bottom: what it comes to, two charts with their tables, the pictures, how it was measured.
#include "measure/cost/report.h"

#include <locale.h>
#include <math.h>
#include <string.h>

#include "measure/cost/chart.h"
#include "measure/cost/html.h"
#include "measure/cost/page.h"
#include "measure/cost/style.h"

// ------------------------------------------------------------------------------------------------------------------ head

static void write_head(struct page *page) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n<title>What accuracy costs: ",
          page->to);
    html_text(page->to, page->place->scene);
    fprintf(page->to, "</title>\n<style>\n%s%s</style>\n</head>\n<body>\n<main>\n", chart_style, cost_style);
}

// "6 320 triangles · ", nothing of which there are none.
static void write_kind(FILE *to, uint64_t count, const char *name) {
    if (count == 0) return;
    html_count(to, count);
    fprintf(to, " %s%s · ", name, count == 1 ? "" : "s");
}

static void write_facts(struct page *page) {
    const struct cost_place *place = page->place;
    fputs("<p class=\"over\">gnomon · what accuracy costs</p>\n<h1>", page->to);
    html_text(page->to, place->scene);
    fputs("</h1>\n<p class=\"facts\">", page->to);
    write_kind(page->to, place->triangles, "triangle");
    write_kind(page->to, place->spheres, "sphere");
    write_kind(page->to, place->lights, "light");
    fprintf(page->to, "%u × %u pixels<br />\n", page->cost->params.width, page->cost->params.height);
    html_text(page->to, place->device.name);
    fputs(" · ", page->to);
    html_text(page->to, place->device.driver);
    fputs(" · Vulkan ", page->to);
    html_text(page->to, place->device.api);
    fputs("</p>\n", page->to);
}

static void write_ratio(struct page *page, const struct cost_row *row, const struct cost_row *base) {
    fprintf(page->to, "%.2f", page_run(page, row)->median / page_run(page, base)->median);
}

// What it comes to, in a sentence for each tier.
static void write_lead(struct page *page) {
    const struct cost *cost = page->cost;
    const struct cost_row *robust = page_find(page, "tier", "robust");
    fputs("<p class=\"lead\">", page->to);
    for (uint32_t i = 0; i < cost->row_count; i++) {
        const struct cost_row *row = &cost->rows[i];
        if (strcmp(row->axis, "tier") != 0 || !robust) continue;
        const struct cost_decisions *decisions = &cost->decisions[page_run(page, row)->config.tier];
        fprintf(page->to, "<b class=\"c%u\">%s</b> ", page_run(page, row)->config.tier, row->setting);
        if (row == robust) {
            fputs("takes ", page->to);
            html_number(page->to, page_run(page, row)->median);
            fputs(" ms", page->to);
        } else {
            fputs("takes ", page->to);
            write_ratio(page, row, robust);
            fputs(" times as long as robust", page->to);
        }
        fputs(", and decides ", page->to);
        if (decisions->wrong == 0)
            fputs("no ray wrongly. ", page->to);
        else {
            html_number(page->to, 1e6 * (double)decisions->wrong / (double)decisions->rays);
            fputs(" rays in a million wrongly. ", page->to);
        }
    }
    fputs("</p>\n", page->to);
}

// ---------------------------------------------------------------------------------------------------------------- charts

static void add_point(struct page *page, struct chart *chart, uint32_t number, uint32_t colour, const char *label, const char *title) {
    const struct cost_run *run = &page->cost->runs[number];
    if (chart->count == CHART_MOST_POINTS) return;
    struct chart_point *point = &chart->points[chart->count++];
    *point = (struct chart_point){
        .time = run->median, .low = run->low, .high = run->high, .error = run->rmse, .colour = colour, .label_colour = colour};
    snprintf(point->label, sizeof point->label, "%s", label);
    snprintf(point->title, sizeof point->title, "%s: %.4g ms, RMSE %.3g", title, run->median, run->rmse);
    for (uint32_t i = 0; i < page->cost->row_count; i++)
        if (page->cost->rows[i].run == number && page->cost->rows[i].pareto) point->front = true;
}

// Every run once, by the name of the first row that has it: a tier's is its own, others' begin with their axis.
static void draw_arithmetic(struct page *page) {
    static struct chart empty;
    struct chart chart = empty;
    chart.title = "Error of arithmetic against time";
    chart.error_name = "RMSE against the reference";
    bool seen[COST_MOST_ROWS] = {false};
    for (uint32_t i = 0; i < page->cost->row_count; i++) {
        const struct cost_row *row = &page->cost->rows[i];
        char name[80];
        if (row->front != COST_FRONT_ARITHMETIC || seen[row->run]) continue;
        seen[row->run] = true;
        bool tier = strcmp(row->axis, "tier") == 0;
        snprintf(name, sizeof name, "%s%s%s", tier ? "" : row->axis, tier ? "" : ": ", row->setting);
        add_point(page, &chart, row->run, tier ? page_run(page, row)->config.tier : PAGE_REST_COLOUR, name, name);
    }
    chart_write(page->to, &chart);
}

// Tiers by colour, the samples written beside the slowest of each number; the independent sampler hollow.
static void draw_sampling(struct page *page) {
    static struct chart empty;
    struct chart chart = empty;
    const struct cost *cost = page->cost;
    const struct cost_row *codes = page_find(page, "output", "8-bit code");
    chart.title = "Error of sampling against time";
    chart.error_name = "RMSE against very many samples";
    if (codes) chart.level = page_run(page, codes)->rmse, chart.level_label = "what 8-bit codes lose";
    uint32_t slowest[COST_LADDER] = {0};
    for (uint32_t i = 0; i < cost->row_count; i++) {
        if (strcmp(cost->rows[i].axis, "together") != 0) continue;
        for (uint32_t rung = 0; rung < cost->rungs; rung++)
            if (page_run(page, &cost->rows[i])->config.spp == cost_rung(rung) &&
                page_run(page, &cost->rows[i])->median > page_run(page, &cost->rows[slowest[rung]])->median * (slowest[rung] > 0))
                slowest[rung] = i;
    }
    for (uint32_t i = 0; i < cost->row_count; i++) {
        const struct cost_row *row = &cost->rows[i];
        const struct cost_config *config = &page_run(page, row)->config;
        bool independent = strcmp(row->axis, "sampler") == 0 && config->knobs[KNOB_SAMPLER] == SAMPLER_INDEPENDENT;
        if (strcmp(row->axis, "together") != 0 && !independent) continue;
        char label[24] = "";
        for (uint32_t rung = 0; rung < cost->rungs; rung++)
            if (!independent && slowest[rung] == i) snprintf(label, sizeof label, "%u per pixel", config->spp);
        add_point(page, &chart, row->run, config->tier, label, row->setting);
        struct chart_point *point = &chart.points[chart.count - 1];
        point->hollow = independent;
        point->label_colour = PAGE_REST_COLOUR;
    }
    chart_write(page->to, &chart);
}

static void write_key(struct page *page, bool independent) {
    fputs("<ul class=\"key\">", page->to);
    for (uint32_t tier = 0; tier < TIER_COUNT; tier++)
        if (page_find(page, "tier", cost_tier_name(tier)))
            fprintf(page->to, "<li class=\"c%u\"><span>%s</span></li>", tier, cost_tier_name(tier));
    if (independent)
        fprintf(page->to, "<li class=\"c%u hollow\"><span>robust, independent samples</span></li>", TIER_ROBUST);
    else
        fprintf(page->to, "<li class=\"c%u\"><span>robust with one thing changed</span></li>", PAGE_REST_COLOUR);
    fputs("</ul>\n", page->to);
}

// --------------------------------------------------------------------------------------------------------------- chapters

static void write_arithmetic(struct page *page) {
    static const char *const axes[] = {"tier", "offset", "normalize", "power", "output"};
    fputs("<h2>Arithmetic</h2>\n<p>One ray through the centre of each pixel, the same on the device and in the reference: whatever differs "
          "is "
          "arithmetic. Lower is closer, left is faster; the line is the Pareto front, below which nothing was found.</p>\n<figure>",
          page->to);
    write_key(page, false);
    draw_arithmetic(page);
    fputs("</figure>\n", page->to);
    page_table(page, axes, sizeof axes / sizeof *axes);
}

static void write_sampling(struct page *page) {
    static const char *const axes[] = {"samples", "sampler", "sum", "together"};
    fprintf(page->to,
            "<h2>Samples</h2>\n<p>The same against a picture with %u samples per pixel, at other places: the error is that of sampling, "
            "too. Where the "
            "curves of the tiers lie on each other, a more accurate tier buys nothing that one sees.</p>\n<figure>",
            page->cost->targets[COST_SAMPLES].spp);
    write_key(page, true);
    draw_sampling(page);
    fputs("</figure>\n", page->to);
    page_table(page, axes, sizeof axes / sizeof *axes);
    fprintf(page->to,
            "<p class=\"note\">The rows of <b>sum</b> have the reference's own %u samples, so that nothing but the sum is in error.</p>\n",
            page->cost->targets[COST_SAMPLES].spp);
}

static void write_method(struct page *page) {
    const struct cost *cost = page->cost;
    const struct cost_target *targets = cost->targets;
    fputs("<h2>How it was measured</h2>\n<p>Times are those of the device's work, compilation and transfers aside: the median of ",
          page->to);
    fprintf(
        page->to,
        "%u rounds, in which all settings take turns, with the quartiles beside it. Rendered was every %u. pixel of the picture in both "
        "directions, for the errors of sampling every %u.; the reference is fp64 on the CPU with exact decisions, and took %.1f and %.1f "
        "s. ",
        cost->rounds, targets[COST_CENTRES].lattice.stride, targets[COST_SAMPLES].lattice.stride, 1e-3 * targets[COST_CENTRES].ms,
        1e-3 * targets[COST_SAMPLES].ms);
    fputs("Wrong decisions are those of the tier about ", page->to);
    html_count(page->to, cost->decisions[TIER_ROBUST].rays);
    fputs(" camera rays and rays to lights; the ulp of t are over the camera rays that hit the right primitive. RMSE is over linear light, "
          "FLIP "
          "(Andersson et al. 2020) over what a screen shows. ● marks the Pareto front: nothing else with the same kind of error is as fast "
          "and as "
          "close, and better in one of the two by more than 5 %, the noise.</p>\n",
          page->to);
    for (uint32_t i = 0; i < cost->skipped_count; i++) {
        fputs("<p class=\"note\">Not measured: ", page->to);
        html_text(page->to, cost->skipped[i].axis);
        if (*cost->skipped[i].setting) fputs(" ", page->to);
        html_text(page->to, cost->skipped[i].setting);
        fputs(": ", page->to);
        html_text(page->to, cost->skipped[i].because);
        fputs(".</p>\n", page->to);
    }
    fprintf(page->to, "<footer>gnomon %s</footer>\n</main>\n</body>\n</html>\n", gn_version());
}

static bool write_page(struct page *page) {
    write_head(page);
    write_facts(page);
    write_lead(page);
    write_arithmetic(page);
    write_sampling(page);
    if (!page_pictures(page)) return false;
    page_probe(page);
    write_method(page);
    return true;
}

bool cost_report(const struct cost *cost, struct context *ctx, const struct cost_place *place, const char *path) {
    struct output_file file;
    if (!output_begin(&file, ctx, path)) return false;
    // Numbers in HTML and SVG have a point, whatever the caller's language.
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0), before = plain ? uselocale(plain) : (locale_t)0;
    struct page page = {.to = file.stream, .ctx = ctx, .cost = cost, .place = place};
    bool written = write_page(&page);
    if (plain) {
        uselocale(before);
        freelocale(plain);
    }
    if (written) return output_commit(&file, ctx);
    output_abort(&file);
    return false;
}
