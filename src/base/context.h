// The context of a call: what the caller lends (callbacks, threads) and where the one error goes.
//
// Every fallible function takes a `struct context *` after its object and returns bool. Whoever finds a fault reports it with
// fail(), once, in words that say what to do; callers only pass false on. A context belongs to one thread; workers
// report to the thread that started them.
#ifndef BASE_CONTEXT_H
#define BASE_CONTEXT_H

#include <stdarg.h>

#include "gnomon.h"

struct context {
    struct gn_host host;    // callbacks may be NULL
    struct gn_error *error; // never NULL
};

// A context that lends what *host lends (NULL: nothing) and reports to *error, which is cleared.
struct context context_make(const struct gn_host *host, struct gn_error *error);

// Reports a fault: sets status and message, unless one is set already. Always returns false: `return fail(ctx, …)`.
bool fail(struct context *ctx, enum gn_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));

// Tells the caller something that is not a fault.
void notify(struct context *ctx, enum gn_level level, const char *format, ...) __attribute__((format(printf, 3, 4)));

// Tells how far a stage is. Returns false, with GN_CANCELLED set, when the caller wants to stop. Cheap: call it some
// 20 times a second or more. `seconds_left` negative: unknown.
bool progress(struct context *ctx, const char *stage, double fraction, double seconds_left);

// CPU threads to use, at least 1.
unsigned context_threads(const struct context *ctx);

// count × size zeroed bytes, or NULL with GN_LIMIT reported: "no memory for <what>: <bytes> bytes".
void *array_alloc(struct context *ctx, size_t count, size_t size, const char *what);

#endif
