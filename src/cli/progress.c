#include "cli/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"

#define BAR_MOST 40   // cells
#define HEARTBEAT 2.0 // seconds for which a report without a fraction says no more than that the last one still holds

static bool says_utf8(void) {
    static const char *const names[] = {"LC_ALL", "LC_CTYPE", "LANG"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *value = getenv(names[i]);
        if (value && *value) return strstr(value, "UTF-8") || strstr(value, "utf8") || strstr(value, "UTF8");
    }
    return false;
}

static bool on_terminal(void) {
    const char *term = getenv("TERM");
    return isatty(STDERR_FILENO) && term && strcmp(term, "dumb") != 0;
}

void progress_init(struct progress_view *view, enum progress_mode mode, bool quiet) {
    *view = (struct progress_view){.mode = mode, .started = clock_seconds(), .unicode = says_utf8()};
    if (mode == PROGRESS_AUTO) view->mode = quiet ? PROGRESS_NONE : on_terminal() ? PROGRESS_BAR : PROGRESS_PLAIN;
    if (view->mode == PROGRESS_BAR)
        view->first = 0.2, view->interval = 0.05;
    else
        view->first = 2, view->interval = mode == PROGRESS_AUTO ? 5 : 2;
}

static int terminal_width(void) {
    struct winsize size;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

// "3 s left", "2 min 05 s left", "" while unknown.
static void time_left(char *text, size_t capacity, double seconds) {
    text[0] = 0;
    if (!(seconds >= 0) || seconds > 1e7) return;
    long whole = (long)(seconds + 0.999);
    if (whole < 60)
        snprintf(text, capacity, "%ld s left", whole);
    else if (whole < 3600)
        snprintf(text, capacity, "%ld min %02ld s left", whole / 60, whole % 60);
    else
        snprintf(text, capacity, "%ld h %02ld min left", whole / 3600, whole / 60 % 60);
}

// A fraction that is not known draws no cells.
static void draw_bar(const struct progress_view *view, const char *stage, double fraction, const char *left) {
    char head[32], tail[48] = " …", cells[3 * BAR_MOST + 1];
    snprintf(head, sizeof head, "%-9.20s", stage);
    if (fraction >= 0) snprintf(tail, sizeof tail, " %3.0f %%  %s", 100 * fraction, left);
    int room = terminal_width() - 1 - (int)strlen(head) - (int)strlen(tail) - 2;
    int width = room < 5 || !(fraction >= 0) ? 0 : room < BAR_MOST ? room : BAR_MOST, used = 0;
    for (int i = 0; i < width; i++) {
        bool full = i < (int)(fraction * width + 0.5);
        used += snprintf(cells + used, sizeof cells - (size_t)used, "%s", view->unicode ? full ? "█" : "░" : full ? "#" : ".");
    }
    cells[used] = 0;
    char line[sizeof head + sizeof tail];
    snprintf(line, sizeof line, "%s%s", head, tail);
    if (width)
        fprintf(stderr, "\r\033[K%s %s%s", head, cells, tail);
    else
        fprintf(stderr, "\r\033[K%.*s", terminal_width() - 1, line);
}

void progress_show(struct progress_view *view, const struct gn_progress *progress) {
    if (view->mode == PROGRESS_NONE) return;
    double now = clock_seconds();
    if (progress->fraction >= 0)
        view->known = now;
    else if (now - view->known < HEARTBEAT)
        return;
    if (now - view->started < view->first || now - view->last < view->interval) return;
    view->last = now;
    char left[48];
    double fraction = progress->fraction <= 1 ? progress->fraction : 1;
    time_left(left, sizeof left, progress->seconds_left);
    if (view->mode == PROGRESS_BAR) {
        draw_bar(view, progress->stage, fraction, left);
        view->drawn = true;
    } else {
        if (fraction >= 0)
            fprintf(stderr, "gnomon: %s %.0f %%%s%s\n", progress->stage, 100 * fraction, *left ? ", " : "", left);
        else
            fprintf(stderr, "gnomon: %s …\n", progress->stage);
    }
}

void progress_clear(struct progress_view *view) {
    if (view->drawn) fputs("\r\033[K", stderr);
    view->drawn = false;
}
