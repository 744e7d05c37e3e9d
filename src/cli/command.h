// What the commands share: the table's row, the state of one run, and a few ways to say things.
//
// A command is a file with one function: it fills run->result when --json is on, prints for people when it is not, and returns false with
// run->error set. It never exits and never prints JSON itself; main.c does, once. GN_CHECK_FAILED keeps the result: its answer is no.
#ifndef CLI_COMMAND_H
#define CLI_COMMAND_H

#include "base/context.h"
#include "cli/json.h"
#include "cli/options.h"
#include "cli/progress.h"

// What a picture may be called.
#define PICTURE_SUFFIXES "png|exr|pfm"

struct run {
    const struct command *command;
    struct settings settings;
    struct progress_view view;
    struct gn_host host; // for every call of the library
    struct gn_error error;
    bool device_from_environment; // settings.device is GNOMON_DEVICE
    double started;               // clock_seconds() when the program began
    json_t *result;               // with --json: what will be printed
};

struct command {
    const char *name;
    uint32_t bit;          // COMMAND_*
    int positionals;       // how many
    const char *arguments; // for the usage line, e.g. "SCENE -o FILE"
    const char *names;     // of the positional arguments, e.g. "SCENE"
    const char *summary;   // one line
    const char *about;     // paragraphs
    const char *examples;  // lines
    bool (*run)(struct run *run);
};

bool command_render(struct run *run);
bool command_trace(struct run *run);
bool command_verify(struct run *run);
bool command_plan(struct run *run);
bool command_devices(struct run *run);
bool command_compare(struct run *run);
bool command_probe(struct run *run);
bool command_cost(struct run *run);
bool command_stress(struct run *run);

// A context that reports to run->error, for the parts of the library that are not behind gnomon.h.
struct context run_context(struct run *run);

// Reports a fault of the command's own. Returns false.
bool run_fail(struct run *run, enum gn_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));

// A line for people on standard error, unless -q. The newline is added.
void run_say(struct run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Takes over the result of --json; NULL means that it could not be made.
bool run_result(struct run *run, json_t *result);

// Opens the device that the settings ask for; before that, gives the driver its cache folder.
struct gn_device *run_device(struct run *run);

// The accuracy that the settings ask for, or the default.
enum gn_accuracy run_accuracy(const struct run *run);

// What the settings say of rendering.
struct gn_render_params run_render_params(struct run *run);

// Whether an output can be written at all: asked before the long work. `suffixes`: such as "png|exr|pfm", or NULL for any name.
bool run_check_output(struct run *run, const char *path, const char *suffixes);

// Writes a picture; signals wait until the file is whole.
bool run_save(struct run *run, struct gn_picture *picture, const char *path);

// Milliseconds since the program began.
double run_ms(const struct run *run);

#endif
