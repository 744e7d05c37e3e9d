#include "bvh/watch.h"

#include "base/clock.h"

#define INTERVAL 0.05 // seconds between two reports

uint64_t bvh_work(uint32_t count) {
    uint64_t levels = 0;
    for (uint32_t n = count; n > 0; n /= 2) levels++;
    return count * levels;
}

static bool report(struct bvh_watch *watch) {
    double fraction = (double)atomic_load(&watch->done) / (double)watch->work;
    watch->reported = clock_seconds();
    double left = fraction > 0 ? (watch->reported - watch->start) * (1 - fraction) / fraction : -1;
    return progress(watch->ctx, "bvh", fraction, left);
}

bool bvh_watch_begin(struct bvh_watch *watch, struct context *ctx, uint32_t count) {
    *watch = (struct bvh_watch){.ctx = ctx, .start = clock_seconds(), .work = bvh_work(count)};
    return report(watch);
}

bool bvh_watch_go_on(struct bvh_watch *watch, unsigned thread) {
    return thread != 0 || clock_seconds() - watch->reported < INTERVAL || report(watch);
}

bool bvh_watch_end(struct bvh_watch *watch) { return progress(watch->ctx, "bvh", 1, 0); }
