// The command line: one table of options for all commands, and the parser that it drives.
//
// A new option is one row in options.c and one field in `struct settings`. Help texts and error messages come from the same rows.
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include "gnomon.h"

// The commands, as bits: an option's row says which commands take it.
enum {
    COMMAND_RENDER = 1 << 0,
    COMMAND_TRACE = 1 << 1,
    COMMAND_VERIFY = 1 << 2,
    COMMAND_PLAN = 1 << 3,
    COMMAND_DEVICES = 1 << 4,
    COMMAND_COMPARE = 1 << 5,
    COMMAND_COST = 1 << 6,
    COMMAND_PROBE = 1 << 7,
    COMMAND_STRESS = 1 << 8,
    COMMAND_ALL = (1 << 9) - 1,
};

#define MOST_POSITIONALS 2

enum progress_mode { PROGRESS_AUTO, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_NONE };

struct size {
    uint32_t width, height;
};

// What the command line said; zero where it said nothing. Texts belong to argv, but for the lists of effects.
struct settings {
    const char *positionals[MOST_POSITIONALS];
    int positional_count;
    bool help, json, quiet, validate, hide_fp64, reference, no_prune, measure, stats, any;
    uint32_t verbose; // how often -v was given
    int progress;     // enum progress_mode
    uint32_t threads;
    const char *device, *output, *rays, *only;
    struct size size;
    uint32_t spp, seed, repeat, tile_pixels, rounds;
    uint32_t ray_count; // 0: the command's own
    int accuracy;       // enum gn_accuracy; negative: not given
    uint32_t aovs;      // enum gn_aov, or-ed
    char disable[1024], only_effects[1024]; // comma-separated
    double tolerance, seconds, max_error, max_time;
    double max_abs, max_flip; // negative: not given
};

// Parses argv[0 … argc) for one command, which takes `positionals` arguments called `names` ("SCENE" or "A B"). GN_USAGE, with a message
// for people, in *error on failure. `--help` anywhere wins over every fault.
bool options_parse(struct settings *out, struct gn_error *error, int argc, char **argv, uint32_t command, int positionals,
                   const char *names);

// Prints the options that `command` takes to standard output, those of every command last.
void options_print(uint32_t command);

// Whether `text` is so near to `name` that it may be a slip of the finger.
bool nearly_equal(const char *text, const char *name);

#endif
