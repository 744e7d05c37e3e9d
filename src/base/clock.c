// Time from CLOCK_MONOTONIC.
#include "base/clock.h"

#include <time.h>

double clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double clock_ms_since(double start) { return 1e3 * (clock_seconds() - start); }
