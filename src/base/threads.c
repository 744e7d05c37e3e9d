#define _GNU_SOURCE // sched_getaffinity
#include "base/threads.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"

#define MOST_THREADS 256

unsigned threads_available(void) {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    int count = CPU_COUNT(&set);
    return count < 1 ? 1 : count > MOST_THREADS ? MOST_THREADS : (unsigned)count;
}

struct loop {
    size_t count, grain;
    bool (*body)(void *data, size_t begin, size_t end, unsigned thread);
    void *data;
    atomic_size_t next, done;
    atomic_bool failed;
};

struct worker { struct loop *loop; unsigned number; pthread_t thread; };

// Runs one chunk; false when there is none left or the loop has failed.
static bool loop_step(struct loop *loop, unsigned thread) {
    if (atomic_load(&loop->failed)) return false;
    size_t begin = atomic_fetch_add(&loop->next, loop->grain);
    if (begin >= loop->count) return false;
    size_t end = loop->count - begin < loop->grain ? loop->count : begin + loop->grain;
    if (!loop->body(loop->data, begin, end, thread)) atomic_store(&loop->failed, true);
    else atomic_fetch_add(&loop->done, end - begin);
    return true;
}

static void *work(void *argument) {
    struct worker *worker = argument;
    while (loop_step(worker->loop, worker->number)) {}
    return NULL;
}

// The calling thread works, too, and with `watch` reports between its chunks.
static bool loop_run(struct loop *loop, unsigned threads, struct context *watch, const char *stage) {
    struct worker workers[MOST_THREADS];
    if (threads > MOST_THREADS) threads = MOST_THREADS;
    unsigned started = 0;
    for (unsigned i = 1; i < threads && i * loop->grain < loop->count; i++) {
        workers[started] = (struct worker){.loop = loop, .number = i};
        if (pthread_create(&workers[started].thread, NULL, work, &workers[started]) != 0) break;
        started++;
    }
    double start = clock_seconds(), reported = start;
    bool cancelled = false;
    while (!cancelled && loop_step(loop, 0)) {
        double now = clock_seconds();
        if (watch && now - reported > 0.05) {
            reported = now;
            double fraction = (double)atomic_load(&loop->done) / (double)loop->count;
            double left = fraction > 0 ? (now - start) * (1 - fraction) / fraction : -1;
            if (!progress(watch, stage, fraction, left)) cancelled = true;
        }
    }
    if (cancelled) atomic_store(&loop->failed, true);
    for (unsigned i = 0; i < started; i++) pthread_join(workers[i].thread, NULL);
    return !atomic_load(&loop->failed);
}

bool parallel_for(unsigned threads, size_t count, size_t grain,
                  bool (*body)(void *data, size_t begin, size_t end, unsigned thread), void *data) {
    struct loop loop = {.count = count, .grain = grain ? grain : 1, .body = body, .data = data};
    return loop_run(&loop, threads, NULL, NULL);
}

bool parallel_for_progress(struct context *ctx, const char *stage, size_t count, size_t grain,
                           bool (*body)(void *data, size_t begin, size_t end, unsigned thread), void *data) {
    struct loop loop = {.count = count, .grain = grain ? grain : 1, .body = body, .data = data};
    return loop_run(&loop, context_threads(ctx), ctx, stage);
}
