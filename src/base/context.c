// The one error of a call, messages, progress, memory.
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

// Bytes of the UTF-8 character that begins here; 0 if none does (Unicode, table 3-7). Text ends with a zero byte.
static size_t utf8_length(const unsigned char *text) {
    unsigned char first = text[0], second = first < 0x80 ? 0 : text[1];
    size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f)) return 0;
    if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f)) return 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80) return 0;
    return length;
}

// Messages quote names and files, which can hold anything: what is no text, and what would control a terminal, becomes '?'.
static void make_text(char *message) {
    unsigned char *at = (unsigned char *)message;
    while (*at) {
        size_t length = utf8_length(at);
        if (length == 0 || *at == 0x7f || (*at < ' ' && *at != '\n' && *at != '\t')) {
            *at = '?';
            length = 1;
        }
        at += length;
    }
}

bool fail(struct context *ctx, enum gn_status status, const char *format, ...) {
    if (ctx->error->status != GN_OK) return false;
    ctx->error->status = status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(ctx->error->message, sizeof ctx->error->message, format, arguments);
    va_end(arguments);
    make_text(ctx->error->message);
    return false;
}

void notify(struct context *ctx, enum gn_level level, const char *format, ...) {
    if (!ctx->host.message) return;
    char text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    make_text(text);
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
    void *memory = size == 0 || count <= SIZE_MAX / size ? calloc(count ? count : 1, size) : NULL;
    if (!memory) fail(ctx, GN_LIMIT, "no memory for %s: %zu × %zu bytes", what, count, size);
    return memory;
}
