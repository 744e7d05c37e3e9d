// gnomon, the program: finds the command, parses its options, runs it, and says how it went. The only place that exits.
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/help.h"
#include "cli/interrupt.h"

// --------------------------------------------------------------------------------------------------------------- callbacks

static bool on_progress(void *user, const struct gn_progress *progress) {
    struct run *run = user;
    if (interrupt_requested()) return false;
    progress_show(&run->view, progress);
    return true;
}

static void on_message(void *user, enum gn_level level, const char *text) {
    struct run *run = user;
    if (run->settings.quiet || (level == GN_LEVEL_INFO && run->settings.verbose < 1) ||
        (level == GN_LEVEL_DEBUG && run->settings.verbose < 2))
        return;
    run_say(run, "gnomon: %s%s", level == GN_LEVEL_WARNING ? "warning: " : "", text);
}

// ------------------------------------------------------------------------------------------------------------------ ending

static json_t *error_json(const struct gn_error *error) {
    const struct json_member members[] = {{"status", json_integer(error->status)}, {"message", json_words(error->message)}};
    return JSON_MEMBERS(members);
}

// Prints the one JSON object: the result, and what went wrong, if something did. A check that failed has said so in its result.
static bool print_json(struct run *run) {
    json_t *result = run->result ? run->result : json_object();
    run->result = NULL;
    if (run->error.status > GN_CHECK_FAILED || (run->error.status && json_object_size(result) == 0))
        json_object_set_new(result, "error", error_json(&run->error));
    bool printed = json_dumpf(result, stdout, JSON_REAL_PRECISION(12)) == 0 && putchar('\n') != EOF;
    json_decref(result);
    return printed;
}

static void print_error(struct run *run) {
    const char *name = run->command ? run->command->name : "";
    progress_clear(&run->view);
    fprintf(stderr, "gnomon%s%s: %s\n", *name ? " " : "", name, run->error.message);
    if (run->error.status == GN_USAGE) fprintf(stderr, "(gnomon %s%s--help says what there is)\n", name, *name ? " " : "");
}

// Ends the run: result, error, standard output complete or not. Returns the exit code.
static int finish(struct run *run) {
    progress_clear(&run->view);
    if (run->error.status == GN_CANCELLED) run_fail(run, GN_CANCELLED, "interrupted");
    errno = 0;
    bool printed = !run->settings.json || print_json(run);
    printed = fflush(stdout) == 0 && !ferror(stdout) && printed;
    if (!printed && run->error.status <= GN_CHECK_FAILED)
        run_fail(run, GN_IO, "cannot write to standard output: %s", errno ? strerror(errno) : "it is not open for writing");
    if (run->error.status) print_error(run);
    // A device that hangs, or was left at work, may not be waited for; exit() would, or would pull its libraries from under it.
    if (run->error.status == GN_DEVICE_LOST || run->error.status == GN_CANCELLED) _Exit((int)run->error.status);
    return (int)run->error.status;
}

// --------------------------------------------------------------------------------------------------------------- beginning

// A standard stream that is closed would be the number of the next file that is opened: an output, say, into which messages then go.
static void keep_standard_streams(void) {
    for (int stream = 0; stream <= 2; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) return;
}

static bool has_argument(int argc, char **argv, const char *argument) {
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], argument) == 0) return true;
    return false;
}

static bool no_command(struct run *run, const char *name) {
    const struct command *near = command_near(name);
    const char *dot = strrchr(name, '.');
    if (name[0] == '-') return run_fail(run, GN_USAGE, "unknown option %s; a command comes first, e.g. gnomon render SCENE -o FILE", name);
    if (command_planned(name)) return run_fail(run, GN_USAGE, "the command '%s' is not in this version yet", name);
    if (near) return run_fail(run, GN_USAGE, "there is no command '%s'; did you mean %s?", name, near->name);
    if (dot) return run_fail(run, GN_USAGE, "there is no command '%s'; did you mean gnomon render %s -o FILE?", name, name);
    return run_fail(run, GN_USAGE, "there is no command '%s'", name);
}

// gnomon help [COMMAND]
static bool help(struct run *run, int argc, char **argv) {
    const struct command *command = argc > 0 ? command_find(argv[0]) : NULL;
    if (argc > 0 && argv[0][0] != '-' && !command) return no_command(run, argv[0]);
    run->settings.json = false;
    if (command)
        help_command(command);
    else
        help_overview();
    return true;
}

static bool run_command(struct run *run, int argc, char **argv) {
    const struct command *command = run->command;
    bool json = run->settings.json;
    bool parsed = options_parse(&run->settings, &run->error, argc, argv, command->bit, command->positionals, command->names);
    if (parsed && run->settings.help) {
        run->settings.json = false;
        help_command(command);
        return true;
    }
    run->settings.json = json;
    if (!parsed) return false;
    if (!run->settings.device) {
        run->settings.device = getenv("GNOMON_DEVICE");
        if (run->settings.device && !*run->settings.device) run->settings.device = NULL;
        run->device_from_environment = run->settings.device != NULL;
    }
    progress_init(&run->view, (enum progress_mode)run->settings.progress, run->settings.quiet);
    interrupt_install(run->settings.json, run->view.mode == PROGRESS_BAR);
    run->host = (struct gn_host){.user = run, .progress = on_progress, .message = on_message, .threads = run->settings.threads};
    return command->run(run);
}

static bool start(struct run *run, int argc, char **argv) {
    const char *name = argc > 1 ? argv[1] : "";
    run->settings.json = has_argument(argc, argv, "--json");
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) return help(run, argc - 2, argv + 2);
    if (strcmp(name, "--version") == 0 || strcmp(name, "version") == 0) {
        run->settings.json = false;
        help_version();
        return true;
    }
    if (argc < 2) {
        help_overview();
        return run_fail(run, GN_USAGE, "a command is missing, e.g. gnomon render SCENE -o FILE");
    }
    run->command = command_find(name);
    if (!run->command) return no_command(run, name);
    return run_command(run, argc - 2, argv + 2);
}

int main(int argc, char **argv) {
    struct run run = {.started = clock_seconds()};
    keep_standard_streams();
    start(&run, argc, argv);
    return finish(&run);
}
