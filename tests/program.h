// Runs the built program as a child: arguments, environment, signals; its exit code, what it printed, how long it took.
//
// The child works in PROGRAM_FOLDER, so that arguments are short and need no quoting: they are words separated by blanks.
#ifndef TESTS_PROGRAM_H
#define TESTS_PROGRAM_H

#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

// Ours before cmocka's: that has a macro called fail.
#include "base/clock.h"
#include "base/file.h"

#include <cmocka.h>
#include <jansson.h>

#define PROGRAM_FOLDER TEST_OUTPUT_DIR "/program"
#define PROGRAM_MOST_WORDS 32

struct program_call {
    const char *words;       // the arguments
    const char *environment; // words: NAME=value sets, NAME alone unsets [as it is]
    const char *out;         // file for standard output; "" closes it, "|" is a pipe that nobody reads [kept for the result]
    int signal, signals;     // to be sent, and how often: the first after 0.5 s, then every 0.1 s [none]
};

struct program_result {
    int code;        // exit code, or 1000 + the signal that ended it
    char *out, *err; // what it printed
    double seconds;  // from the first signal, or the start, to the end
};

static inline void program_pause(double seconds) {
    struct timespec time = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
    while (nanosleep(&time, &time) != 0 && errno == EINTR) {}
}

// Splits a copy of `words` in place; the array ends with NULL.
static inline char *program_split(const char *words, char *list[PROGRAM_MOST_WORDS + 1], int used) {
    char *copy = strdup(words);
    assert_non_null(copy);
    for (char *rest, *word = strtok_r(copy, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        assert_true(used < PROGRAM_MOST_WORDS);
        list[used++] = word;
    }
    list[used] = NULL;
    return copy;
}

static inline void program_redirect(const char *path, int stream) {
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || dup2(file, stream) < 0) _exit(126);
    close(file);
}

static inline void program_child(const struct program_call *call, char **arguments, char **variables) {
    int broken[2];
    if (chdir(PROGRAM_FOLDER) != 0) _exit(126);
    program_redirect("stderr.txt", STDERR_FILENO);
    if (!call->out)
        program_redirect("stdout.txt", STDOUT_FILENO);
    else if (!*call->out)
        close(STDOUT_FILENO);
    else if (strcmp(call->out, "|") != 0)
        program_redirect(call->out, STDOUT_FILENO);
    else if (pipe(broken) != 0 || dup2(broken[1], STDOUT_FILENO) < 0 || close(broken[0]) != 0 || close(broken[1]) != 0)
        _exit(126);
    for (; *variables; variables++) {
        char *value = strchr(*variables, '=');
        if (value) *value++ = 0;
        if (value ? setenv(*variables, value, 1) : unsetenv(*variables)) _exit(126);
    }
    signal(SIGPIPE, SIG_DFL);
    execv(TEST_PROGRAM, arguments);
    _exit(127);
}

static inline char *program_text(const char *path) {
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct file_bytes bytes;
    return file_read(&bytes, &ctx, path, GN_IO) ? bytes.data : strdup("");
}

static inline struct program_result program_run(const struct program_call *call) {
    char *arguments[PROGRAM_MOST_WORDS + 1] = {"gnomon"}, *variables[PROGRAM_MOST_WORDS + 1];
    char *words = program_split(call->words, arguments, 1),
         *names = program_split(call->environment ? call->environment : "", variables, 0);
    struct program_result result = {0};
    int status;
    mkdir(TEST_OUTPUT_DIR, 0777);
    mkdir(PROGRAM_FOLDER, 0777);
    remove(PROGRAM_FOLDER "/stdout.txt");
    double start = clock_seconds();
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) program_child(call, arguments, variables);
    if (call->signals) program_pause(0.5), start = clock_seconds();
    for (int i = 0; i < call->signals; i++) {
        if (i) program_pause(0.1);
        kill(child, call->signal);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    result.seconds = clock_seconds() - start;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    result.out = program_text(PROGRAM_FOLDER "/stdout.txt"), result.err = program_text(PROGRAM_FOLDER "/stderr.txt");
    free(words);
    free(names);
    return result;
}

static inline void program_free(struct program_result *result) {
    free(result->out);
    free(result->err);
}

// Runs it with these words and fails the test unless it ends with `code` and standard error contains `says`.
static inline struct program_result program_expect(const char *words, int code, const char *says) {
    struct program_result result = program_run(&(struct program_call){.words = words});
    if (result.code != code) fail_msg("gnomon %s: exit code %d, not %d\n%s", words, result.code, code, result.err);
    if (*says && !strstr(result.err, says)) fail_msg("gnomon %s: expected '%s' in\n%s", words, says, result.err);
    return result;
}

// What it printed, which must be one JSON object and nothing else; to be freed with json_decref.
static inline json_t *program_json(const char *words, const struct program_result *result) {
    json_error_t error;
    json_t *object = json_loads(result->out, JSON_REJECT_DUPLICATES, &error);
    if (!object || !json_is_object(object))
        fail_msg("gnomon %s: not one JSON object (%s):\n%s", words, object ? "" : error.text, result->out);
    return object;
}

// Writes a file of this text into the folder.
static inline void program_write(const char *name, const char *text) {
    char path[1024];
    mkdir(TEST_OUTPUT_DIR, 0777);
    mkdir(PROGRAM_FOLDER, 0777);
    snprintf(path, sizeof path, "%s/%s", PROGRAM_FOLDER, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

// How many files there match a pattern.
static inline int program_count(const char *pattern) {
    char path[1024];
    glob_t found;
    snprintf(path, sizeof path, "%s/%s", PROGRAM_FOLDER, pattern);
    int count = glob(path, 0, NULL, &found) == 0 ? (int)found.gl_pathc : 0;
    globfree(&found);
    return count;
}

static inline bool program_has(const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", PROGRAM_FOLDER, name);
    return access(path, F_OK) == 0;
}

#endif
