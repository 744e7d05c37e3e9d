// Loops shared between threads: each takes the next chunk until none is left.
#define _GNU_SOURCE // sched_getaffinity, pthread_clockjoin_np
#include "base/threads.h"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"

#define MOST_THREADS 256

unsigned threads_available(void) {
    cpu_set_t set;
    // The set holds 1024 processors; on a larger machine the call fails.
    long count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > MOST_THREADS ? MOST_THREADS : (unsigned)count;
}

struct loop {
    size_t count, grain;
    bool (*body)(void *data, size_t begin, size_t end, unsigned thread);
    void *data;
    atomic_size_t next, done;
    atomic_bool failed;
};

struct worker {
    struct loop *loop;
    unsigned number;
    pthread_t thread;
};

// Runs one chunk; false when there is none left or the loop has failed.
static bool loop_step(struct loop *loop, unsigned thread) {
    if (atomic_load(&loop->failed)) return false;
    size_t begin = atomic_fetch_add(&loop->next, loop->grain);
    if (begin >= loop->count) return false;
    size_t end = loop->count - begin < loop->grain ? loop->count : begin + loop->grain;
    if (!loop->body(loop->data, begin, end, thread))
        atomic_store(&loop->failed, true);
    else
        atomic_fetch_add(&loop->done, end - begin);
    return true;
}

static void *work(void *argument) {
    struct worker *worker = argument;
    while (loop_step(worker->loop, worker->number)) {}
    return NULL;
}

// Tells the caller of a loop how far it is, not more often than every REPORT_SECONDS.
struct report {
    struct context *ctx;
    const char *stage;
    double start, last;
};

#define REPORT_SECONDS 0.05

// False when the caller wants to stop.
static bool report_progress(struct report *report, const struct loop *loop) {
    double now = clock_seconds();
    if (!report->ctx || now - report->last < REPORT_SECONDS) return true;
    report->last = now;
    double fraction = (double)atomic_load(&loop->done) / (double)loop->count;
    return progress(report->ctx, report->stage, fraction, fraction > 0 ? (now - report->start) * (1 - fraction) / fraction : -1);
}

// Waits for a worker to end, and reports meanwhile.
static void join_reporting(pthread_t thread, struct report *report, struct loop *loop) {
    struct timespec until;
    do {
        if (!report_progress(report, loop)) atomic_store(&loop->failed, true);
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_nsec += (long)(REPORT_SECONDS * 1e9);
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
    } while (pthread_clockjoin_np(thread, NULL, CLOCK_MONOTONIC, &until) == ETIMEDOUT);
}

// The calling thread works, too, and reports between its chunks.
static bool loop_run(struct loop *loop, unsigned threads, struct report *report) {
    struct worker workers[MOST_THREADS];
    if (threads > MOST_THREADS) threads = MOST_THREADS;
    unsigned started = 0;
    for (unsigned i = 1; i < threads && i * loop->grain < loop->count; i++) {
        workers[started] = (struct worker){.loop = loop, .number = i};
        if (pthread_create(&workers[started].thread, NULL, work, &workers[started]) != 0) break;
        started++;
    }
    while (loop_step(loop, 0))
        if (!report_progress(report, loop)) atomic_store(&loop->failed, true);
    for (unsigned i = 0; i < started; i++) join_reporting(workers[i].thread, report, loop);
    return !atomic_load(&loop->failed);
}

static struct loop loop_of(size_t count, size_t grain, bool (*body)(void *data, size_t begin, size_t end, unsigned thread), void *data) {
    if (grain < 1) grain = 1;
    if (grain > count) grain = count; // so that `next` cannot pass the end of size_t
    return (struct loop){.count = count, .grain = grain, .body = body, .data = data};
}

bool parallel_for(unsigned threads, size_t count, size_t grain, bool (*body)(void *data, size_t begin, size_t end, unsigned thread),
                  void *data) {
    struct loop loop = loop_of(count, grain, body, data);
    struct report silent = {0};
    return loop_run(&loop, threads, &silent);
}

bool parallel_for_progress(struct context *ctx, const char *stage, size_t count, size_t grain,
                           bool (*body)(void *data, size_t begin, size_t end, unsigned thread), void *data) {
    struct loop loop = loop_of(count, grain, body, data);
    double now = clock_seconds();
    struct report report = {.ctx = ctx, .stage = stage, .start = now, .last = now};
    return loop_run(&loop, context_threads(ctx), &report);
}
