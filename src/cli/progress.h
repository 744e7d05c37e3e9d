// How far the work is, on standard error: a bar on a terminal, lines elsewhere. And the place where Ctrl-C is noticed.
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

#include "cli/options.h"

struct progress_view {
    enum progress_mode mode; // never AUTO
    bool unicode;            // the terminal takes it
    bool drawn;              // a bar stands on the current line
    double started, last;    // clock_seconds() of the start and of the last drawing
    double known;            // the same of the last report that knew its fraction
    double first, interval;  // seconds before the first drawing, and between two
};

// Chooses how to show progress: `mode` as asked for; `quiet` shows nothing.
void progress_init(struct progress_view *view, enum progress_mode mode, bool quiet);

// Shows it, at most 20 times a second.
void progress_show(struct progress_view *view, const struct gn_progress *progress);

// Takes the bar away, before something else is written.
void progress_clear(struct progress_view *view);

#endif
