// Work shared between CPU threads: a loop over chunks, nothing more.
#ifndef BASE_THREADS_H
#define BASE_THREADS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/context.h"

// Cores this process may run on, at least 1.
unsigned threads_available(void);

// Calls body(data, begin, end, thread) for chunks that cover [0, count), each at most `grain` long, on `threads`
// threads (this one included; thread numbers are 0 … threads-1). Chunks are dealt dynamically; each is run exactly once unless a
// body returns false, which stops the dealing. Returns whether every chunk was run and returned true.
bool parallel_for(unsigned threads, size_t count, size_t grain, bool (*body)(void *data, size_t begin, size_t end, unsigned thread),
                  void *data);

// The same, with progress(ctx, stage, …) reported by this thread about 20 times a second, also while the others work.
// Returns false with GN_CANCELLED set when cancelled; a body that fails leaves the reporting to the caller.
bool parallel_for_progress(struct context *ctx, const char *stage, size_t count, size_t grain,
                           bool (*body)(void *data, size_t begin, size_t end, unsigned thread), void *data);

#endif
