// A folder of its own for a test's files, and the ways in which tests handle them.
//
// The folder is made by scratch_open (group setup) and removed with all that is in it by scratch_close (group teardown).
#ifndef TESTS_SCRATCH_H
#define TESTS_SCRATCH_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

// Ours before cmocka's: that has a macro called fail. The function of base/context.h is called as (fail)(ctx, …) in tests.
#include "base/file.h"

#include <cmocka.h>

struct scratch {
    char folder[256], path[512];
    struct gn_error error;
    struct context ctx;
};

static inline struct scratch *scratch_state(void) {
    static struct scratch scratch;
    return &scratch;
}

// A context with no error in it.
static inline struct context *scratch_context(void) {
    struct scratch *s = scratch_state();
    s->ctx = context_make(NULL, &s->error);
    return &s->ctx;
}

// Fails the test with the error's message unless `call` (which uses scratch_context) returned true.
#define scratch_assert(call)                                                                                                               \
    do {                                                                                                                                   \
        if (!(call)) fail_msg("%s: %s", #call, scratch_state()->error.message);                                                            \
    } while (0)

// Fails the test unless `call` (which uses scratch_context) returned false with this status and a message that contains `text`.
#define scratch_assert_fails(call, wanted, text)                                                                                           \
    do {                                                                                                                                   \
        assert_false(call);                                                                                                                \
        if (scratch_state()->error.status != (wanted) || !strstr(scratch_state()->error.message, (text)))                                  \
            fail_msg("%s: status %d, message \"%s\", expected \"%s\"", #call, (int)scratch_state()->error.status,                          \
                     scratch_state()->error.message, (text));                                                                              \
    } while (0)

// The path of a file in the folder; good until the next call.
static inline const char *scratch_path(const char *name) {
    struct scratch *s = scratch_state();
    int length = snprintf(s->path, sizeof s->path, "%s/%s", s->folder, name);
    assert_in_range(length, 1, sizeof s->path - 1);
    return s->path;
}

// Makes a file of these bytes and returns its path.
static inline const char *scratch_file(const char *name, const void *bytes, size_t size) {
    const char *path = scratch_path(name);
    (void)!remove(path); // to overwrite it would make some file systems wait for the disk
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
    return path;
}

// How many files are in the folder; removes them when asked to.
static inline int scratch_count(bool clear) {
    struct scratch *s = scratch_state();
    DIR *folder = opendir(s->folder);
    assert_non_null(folder);
    int count = 0;
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        count++;
        if (clear) (void)!remove(scratch_path(entry->d_name));
    }
    closedir(folder);
    return count;
}

static inline int scratch_open(void **state) {
    (void)state;
    struct scratch *s = scratch_state();
    mkdir(TEST_OUTPUT_DIR, 0777);
    snprintf(s->folder, sizeof s->folder, "%s/scratch.XXXXXX", TEST_OUTPUT_DIR);
    return mkdtemp(s->folder) ? 0 : -1;
}

static inline int scratch_close(void **state) {
    (void)state;
    scratch_count(true);
    return rmdir(scratch_state()->folder);
}

#endif
