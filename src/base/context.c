#include "base/context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"

struct context context_make(const struct gn_host *host, struct gn_error *error) {
    struct context ctx = {.error = error};
    if (host) ctx.host = *host;
    memset(error, 0, sizeof *error);
    return ctx;
}

bool fail(struct context *ctx, enum gn_status status, const char *format, ...) {
    if (ctx->error->status != GN_OK) return false;
    ctx->error->status = status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(ctx->error->message, sizeof ctx->error->message, format, arguments);
    va_end(arguments);
    return false;
}

void notify(struct context *ctx, enum gn_level level, const char *format, ...) {
    if (!ctx->host.message) return;
    char text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ctx->host.message(ctx->host.user, level, text);
}

bool progress(struct context *ctx, const char *stage, double fraction, double seconds_left) {
    if (!ctx->host.progress) return true;
    struct gn_progress state = {.stage = stage, .fraction = fraction, .seconds_left = seconds_left};
    if (ctx->host.progress(ctx->host.user, &state)) return true;
    return fail(ctx, GN_CANCELLED, "cancelled");
}

unsigned context_threads(const struct context *ctx) { return ctx->host.threads ? ctx->host.threads : threads_available(); }

void *array_alloc(struct context *ctx, size_t count, size_t size, const char *what) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) fail(ctx, GN_LIMIT, "no memory for %s: %zu × %zu bytes", what, count, size);
    return memory;
}
