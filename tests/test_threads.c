// Loops shared between threads.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

// Ours before cmocka's: that has a macro called fail.
#include "base/clock.h"
#include "base/threads.h"

#include <cmocka.h>

#define MOST 10000

struct tally {
    atomic_uint runs[MOST];
    atomic_uint chunks, longest, highest_thread;
    size_t fails_at; // the body fails in the chunk with this index
    long sleep_ns;   // of each chunk; of all but thread 0 with `others_sleep`
    bool others_sleep;
};

static void raise_to(atomic_uint *most, unsigned value) {
    unsigned before = atomic_load(most);
    while (before < value && !atomic_compare_exchange_weak(most, &before, value)) {}
}

static bool count_chunk(void *data, size_t begin, size_t end, unsigned thread) {
    struct tally *tally = data;
    atomic_fetch_add(&tally->chunks, 1);
    raise_to(&tally->longest, (unsigned)(end - begin));
    raise_to(&tally->highest_thread, thread);
    struct timespec rest = {.tv_nsec = tally->sleep_ns};
    if (tally->sleep_ns && (thread > 0 || !tally->others_sleep)) nanosleep(&rest, NULL);
    for (size_t i = begin; i < end; i++) atomic_fetch_add(&tally->runs[i], 1);
    return !(tally->fails_at >= begin && tally->fails_at < end);
}

static struct tally *new_tally(void) {
    struct tally *tally = calloc(1, sizeof *tally);
    assert_non_null(tally);
    tally->fails_at = SIZE_MAX;
    return tally;
}

static bool each_once(const struct tally *tally, size_t count) {
    for (size_t i = 0; i < MOST; i++)
        if (tally->runs[i] != (i < count)) return false;
    return true;
}

static void each_index_is_run_once(void **state) {
    (void)state;
    static const struct {
        unsigned threads;
        size_t count, grain;
    } cases[] = {
        {1, 10, 3}, {4, 10000, 1}, {4, 10000, 7}, {3, 9999, 100}, {8, 3, 1},          {2, 5, 1000},
        {4, 0, 1},  {0, 10, 1},    {2, 100, 0},   {300, 5000, 1}, {4, 100, SIZE_MAX}, {4, 100, SIZE_MAX / 2 + 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tally *tally = new_tally();
        assert_true(parallel_for(cases[i].threads, cases[i].count, cases[i].grain, count_chunk, tally));
        assert_true(each_once(tally, cases[i].count));
        assert_true(tally->longest <= (cases[i].grain ? cases[i].grain : 1));
        assert_true(tally->highest_thread == 0 || tally->highest_thread < cases[i].threads);
        // The check can fail: one run more or less is seen.
        tally->runs[17]++;
        assert_false(each_once(tally, cases[i].count));
        free(tally);
    }
}

static void a_failure_stops_the_dealing(void **state) {
    (void)state;
    struct tally *tally = new_tally();
    tally->fails_at = 3;
    assert_false(parallel_for(4, MOST, 1, count_chunk, tally));
    assert_in_range(tally->chunks, 4, MOST - 1);
    free(tally);
    tally = new_tally();
    tally->fails_at = MOST - 1;
    assert_false(parallel_for(4, MOST, 1, count_chunk, tally));
    assert_int_equal(tally->chunks, MOST);
    free(tally);
}

struct listener {
    unsigned calls, stop_at;
    double last;
    bool sane;
};

static bool listen(void *user, const struct gn_progress *progress) {
    struct listener *listener = user;
    listener->calls++;
    listener->sane = listener->sane && progress->fraction >= listener->last && progress->fraction <= 1;
    listener->last = progress->fraction;
    return listener->calls != listener->stop_at;
}

static void progress_is_told_and_can_cancel(void **state) {
    (void)state;
    static const struct {
        unsigned threads, stop_at;
        size_t count;
        bool others_sleep;
    } cases[] = {
        {1, 0, 100, false},  {2, 0, 100, false}, {1, 2, 1000, false},
        {2, 2, 1000, false}, {2, 0, 64, true}, // thread 0 is done at once and waits for the other, and tells of it
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tally *tally = new_tally();
        tally->sleep_ns = cases[i].others_sleep ? 300000000 : 2000000;
        tally->others_sleep = cases[i].others_sleep;
        struct listener listener = {.stop_at = cases[i].stop_at, .sane = true};
        struct gn_host host = {.user = &listener, .progress = listen, .threads = cases[i].threads};
        struct gn_error error;
        struct context ctx = context_make(&host, &error);
        double start = clock_seconds();
        bool done = parallel_for_progress(&ctx, "test", cases[i].count, 1, count_chunk, tally);
        double seconds = clock_seconds() - start;
        assert_true(done == (cases[i].stop_at == 0));
        assert_int_equal(error.status, done ? GN_OK : GN_CANCELLED);
        assert_true(listener.sane);
        if (done)
            assert_true(each_once(tally, cases[i].count));
        else
            assert_int_equal(listener.calls, cases[i].stop_at);
        // The other thread of the last case may not have got a chunk at all.
        if (tally->highest_thread > 0 || !cases[i].others_sleep) assert_in_range(listener.calls, 1, 2 + (unsigned)(seconds / 0.05));
        if (!done) assert_true(tally->chunks < cases[i].count);
        free(tally);
    }
}

static void there_is_a_processor(void **state) {
    (void)state;
    assert_in_range(threads_available(), 1, 256);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_index_is_run_once),
        cmocka_unit_test(a_failure_stops_the_dealing),
        cmocka_unit_test(progress_is_told_and_can_cancel),
        cmocka_unit_test(there_is_a_processor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
