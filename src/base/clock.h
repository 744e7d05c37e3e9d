// Wall-clock time, monotonic.
#ifndef BASE_CLOCK_H
#define BASE_CLOCK_H

// Seconds since some fixed moment.
double clock_seconds(void);

// Milliseconds since `start` (a value of clock_seconds).
double clock_ms_since(double start);

#endif
