#include "cli/options.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/wrap.h"

enum kind {
    FLAG,   // bool
    COUNT,  // uint32_t, one more each time
    TEXT,   // const char *
    WHOLE,  // uint32_t from low to high
    REAL,   // double from low to high
    SIZE,   // struct size, each side from low to high
    CHOICE, // int, the index in `choices`
    SET,    // uint32_t, bit i for choice i; a comma list, may be repeated
    LIST,   // char[1024], comma-separated; may be repeated
};

// One option. Texts in help use the words of `value`.
struct option {
    const char *name;  // without its dashes
    char letter;       // its short form, or 0
    const char *value; // what stands for its value in help; NULL: it takes none
    enum kind kind;
    size_t offset;     // in struct settings
    uint32_t commands; // COMMAND_* bits
    double low, high;
    const char *choices; // separated by |
    const char *help;
};

#define AT(field) offsetof(struct settings, field)
#define PICTURE (COMMAND_RENDER | COMMAND_VERIFY)
#define RAYS (PICTURE | COMMAND_TRACE | COMMAND_PLAN)
#define MOST_WHOLE 4294967295.0

static const struct option options[] = {
    {"output", 'o', "FILE", TEXT, AT(output), COMMAND_RENDER, 0, 0, NULL,
     "write the picture here: .png (8 bit), .exr or .pfm (linear, fp32)"},
    {"output", 'o', "OUT.npy", TEXT, AT(output), COMMAND_TRACE, 0, 0, NULL,
     "write the hits here: a structured array (t, u, v, object, primitive, flags) of shape (N,)"},
    {"output", 'o', "FILE", TEXT, AT(output), COMMAND_VERIFY, 0, 0, NULL,
     "write the difference here as a picture in false colour: black is equal, the middle of the scale is the tolerance"},
    {"output", 'o', "FILE", TEXT, AT(output), COMMAND_COMPARE, 0, 0, NULL, "write the FLIP error here as a picture in false colour"},
    {"output", 'o', "REPORT.html", TEXT, AT(output), COMMAND_COST, 0, 0, NULL,
     "write a report here: charts, the pictures and their error maps, for any browser, without a network"},
    {"rays", 0, "IN.npy", TEXT, AT(rays), COMMAND_TRACE, 0, 0, NULL,
     "read the rays here: float32, shape (N, 8), each row ox oy oz tmin dx dy dz tmax"},
    {"size", 0, "WxH", SIZE, AT(size), PICTURE | COMMAND_PLAN | COMMAND_COST, 1, 65535, NULL, "pixels, e.g. 640x480 [the scene's]"},
    {"spp", 0, "N", WHOLE, AT(spp), PICTURE | COMMAND_PLAN, 1, 16777216, NULL, "samples per pixel, 1 to 16777216 [the scene's]"},
    {"case", 0, "GLOB", TEXT, AT(only), COMMAND_STRESS, 0, 0, NULL, "only the cases whose number matches, e.g. T01 or 'S*' [all]"},
    {"rays", 0, "N", WHOLE, AT(ray_count), COMMAND_STRESS, 1, 100000000, NULL,
     "what each case shoots at each tier, about [10000]; closed meshes get ten times as many"},
    {"accuracy", 0, "TIER", CHOICE, AT(accuracy), COMMAND_STRESS, 0, 0, "robust|fast|exact|fp64",
     "judge only this tier: fast, robust, exact or fp64 [all of them]"},
    {"seed", 0, "N", WHOLE, AT(seed), PICTURE | COMMAND_PLAN | COMMAND_COST | COMMAND_STRESS, 0, MOST_WHOLE, NULL, "of the random numbers, 0 to 4294967295 [0]"},
    {"accuracy", 0, "TIER", CHOICE, AT(accuracy), RAYS, 0, 0, "robust|fast|exact|fp64",
     "how hits are decided: fast, robust, exact or fp64 [robust]"},
    {"max-error", 0, "E", REAL, AT(max_error), COMMAND_RENDER, 1e-12, 1e12, NULL,
     "pick the fastest accuracy and samples per pixel with an RMSE, in linear light, of at most E; --accuracy or --spp keep theirs"},
    {"max-time", 0, "S", REAL, AT(max_time), COMMAND_RENDER, 0.001, 1e9, NULL,
     "pick those with the least error that render within S seconds, all told"},
    {"reference", 0, NULL, FLAG, AT(reference), COMMAND_RENDER | COMMAND_TRACE, 0, 0, NULL,
     "on the CPU in fp64 with exact decisions instead of on a device"},
    {"disable", 0, "EFFECT", LIST, AT(disable), PICTURE | COMMAND_PLAN, 0, 0, NULL,
     "leave an effect out; may be repeated, or a comma list (gnomon plan SCENE lists them)"},
    {"only", 0, "EFFECT", LIST, AT(only_effects), PICTURE | COMMAND_PLAN, 0, 0, NULL,
     "of what the scene calls for run only these effects, beside those of geometry (triangles, spheres, bvh, instances); as --disable"},
    {"no-prune", 0, NULL, FLAG, AT(no_prune), PICTURE | COMMAND_PLAN, 0, 0, NULL,
     "run every effect, whether the scene calls for it or not"},
    {"aov", 0, "LAYER", SET, AT(aovs), COMMAND_RENDER, 0, 0, "depth|normal|id|error|ulp|undecided",
     "also write depth, normal or id; error (the colour's, against the reference), ulp (the depth's) or undecided (rays that the tier's first "
     "stage left open); may be repeated, or a comma list. Layers of an .exr; beside a .png or .pfm: name.depth.png …"},
    {"tile-pixels", 0, "N", WHOLE, AT(tile_pixels), PICTURE, 1, MOST_WHOLE, NULL,
     "pixels of one piece of device work [measured]; the picture does not depend on it"},
    {"measure", 0, NULL, FLAG, AT(measure), COMMAND_PLAN, 0, 0, NULL,
     "measure on the device what each effect costs, and what pruning saves; --size and --spp say of which picture"},
    {"stats", 0, NULL, FLAG, AT(stats), COMMAND_RENDER | COMMAND_TRACE, 0, 0, NULL, "print where the time went, and what was counted"},
    {"any", 0, NULL, FLAG, AT(any), COMMAND_TRACE, 0, 0, NULL, "occlusion only: object is 0 for occluded, -1 for free"},
    {"repeat", 0, "N", WHOLE, AT(repeat), COMMAND_TRACE, 1, 1000000, NULL, "shoot the batch N times and report the median time [1]"},
    {"rounds", 0, "N", WHOLE, AT(rounds), COMMAND_COST, 1, 64, NULL,
     "settings take turns, and N turns of each count, the time permitting, but three at least [5]"},
    {"seconds", 0, "S", REAL, AT(seconds), COMMAND_COST, 0.1, 86400, NULL,
     "measure for about so long; what compiling takes comes on top [60]"},
    {"tolerance", 0, "E", REAL, AT(tolerance), COMMAND_VERIFY, 1e-12, 1e12, NULL,
     "a pixel differs when a colour channel, in linear light, is off by more [1/255]"},
    {"max-abs", 0, "E", REAL, AT(max_abs), COMMAND_COMPARE, 0, 1e300, NULL, "fail (exit 1) when a channel is off by more, in linear light"},
    {"max-flip", 0, "E", REAL, AT(max_flip), COMMAND_COMPARE, 0, 1, NULL, "fail (exit 1) when the mean FLIP error is larger, 0 to 1"},
    {"device", 0, "D", TEXT, AT(device), COMMAND_ALL, 0, 0, NULL,
     "the Vulkan device: index, part of its name, uuid:…, cpu or gpu [$GNOMON_DEVICE, else a GPU if there is one, else the CPU]"},
    {"json", 0, NULL, FLAG, AT(json), COMMAND_ALL, 0, 0, NULL, "one JSON object on standard output, everything else on standard error"},
    {"progress", 0, "MODE", CHOICE, AT(progress), COMMAND_ALL, 0, 0, "auto|bar|plain|none",
     "auto, bar, plain or none [auto: a bar on a terminal, a line now and then elsewhere]"},
    {"threads", 0, "N", WHOLE, AT(threads), COMMAND_ALL, 1, 256, NULL, "CPU threads of gnomon's own work [one for each core]"},
    {"validate", 0, NULL, FLAG, AT(validate), COMMAND_ALL, 0, 0, NULL, "turn the Vulkan validation layer on; its messages are errors"},
    {"hide-fp64", 0, NULL, FLAG, AT(hide_fp64), RAYS | COMMAND_COST | COMMAND_PROBE, 0, 0, NULL, "for tests: do as if the device had no doubles"},
    {"quiet", 'q', NULL, FLAG, AT(quiet), COMMAND_ALL, 0, 0, NULL, "say nothing but errors"},
    {"verbose", 'v', NULL, COUNT, AT(verbose), COMMAND_ALL, 0, 0, NULL, "say more; twice: everything"},
    {"help", 'h', NULL, FLAG, AT(help), COMMAND_ALL, 0, 0, NULL, "this text"},
};

#define OPTION_COUNT (sizeof options / sizeof *options)

// One run of the parser.
struct parser {
    struct settings *out;
    struct gn_error *error;
    int argc, next;
    char **argv;
    uint32_t command;
    bool seen[OPTION_COUNT];
};

static bool wrong(struct parser *parser, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool wrong(struct parser *parser, const char *format, ...) {
    parser->error->status = GN_USAGE;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(parser->error->message, sizeof parser->error->message, format, arguments);
    va_end(arguments);
    return false;
}

// ---------------------------------------------------------------------------------------------------------------- values

// A whole number in [low, high] at the start of `text`; *end is behind it. Digits only: no sign, no blanks.
static bool read_whole(uint32_t *out, const char *text, const char **end, double low, double high) {
    if (*text < '0' || *text > '9') return false;
    char *behind;
    errno = 0;
    unsigned long long value = strtoull(text, &behind, 10);
    *end = behind;
    if (errno || (double)value < low || (double)value > high) return false;
    *out = (uint32_t)value;
    return true;
}

static bool parse_whole(struct parser *parser, const struct option *option, const char *text) {
    const char *end;
    uint32_t *to = (uint32_t *)((char *)parser->out + option->offset);
    if (read_whole(to, text, &end, option->low, option->high) && !*end) return true;
    return wrong(parser, "--%s %s: expected a whole number from %.0f to %.0f", option->name, text, option->low, option->high);
}

static bool parse_real(struct parser *parser, const struct option *option, const char *text) {
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= option->low && value <= option->high))
        return wrong(parser, "--%s %s: expected a number from %g to %g", option->name, text, option->low, option->high);
    *(double *)((char *)parser->out + option->offset) = value;
    return true;
}

static bool parse_size(struct parser *parser, const struct option *option, const char *text) {
    const char *end;
    struct size *to = (struct size *)((char *)parser->out + option->offset);
    if (read_whole(&to->width, text, &end, option->low, option->high) && (*end == 'x' || *end == 'X') &&
        read_whole(&to->height, end + 1, &end, option->low, option->high) && !*end)
        return true;
    return wrong(parser, "--%s %s: expected WIDTHxHEIGHT, each from %.0f to %.0f, e.g. 640x480", option->name, text, option->low,
                 option->high);
}

// The index of text[0 … length) among choices such as "a|b|c", or -1.
static int choice_index(const char *choices, const char *text, size_t length) {
    for (int index = 0; choices; index++) {
        size_t size = strcspn(choices, "|");
        if (size == length && strncmp(choices, text, length) == 0) return index;
        choices = choices[size] ? choices + size + 1 : NULL;
    }
    return -1;
}

static bool wrong_choice(struct parser *parser, const struct option *option, const char *text) {
    return wrong(parser, "--%s %s: expected %s%s", option->name, text, option->kind == SET ? "a comma list of " : "one of ",
                 option->choices);
}

static bool parse_choice(struct parser *parser, const struct option *option, const char *text) {
    int index = choice_index(option->choices, text, strlen(text));
    if (index < 0) return wrong_choice(parser, option, text);
    *(int *)((char *)parser->out + option->offset) = index;
    return true;
}

static bool parse_set(struct parser *parser, const struct option *option, const char *text) {
    for (const char *item = text;; item++) {
        size_t length = strcspn(item, ",");
        int index = choice_index(option->choices, item, length);
        if (index < 0) return wrong_choice(parser, option, text);
        *(uint32_t *)((char *)parser->out + option->offset) |= 1u << index;
        item += length;
        if (!*item) return true;
    }
}

static bool parse_list(struct parser *parser, const struct option *option, const char *text) {
    char *to = (char *)parser->out + option->offset;
    size_t used = strlen(to), capacity = sizeof parser->out->disable;
    int size = snprintf(to + used, capacity - used, "%s%s", used ? "," : "", text);
    if (size >= 0 && (size_t)size < capacity - used) return true;
    return wrong(parser, "--%s: the list is too long", option->name);
}

static bool parse_value(struct parser *parser, const struct option *option, const char *text) {
    switch (option->kind) {
    case WHOLE:
        return parse_whole(parser, option, text);
    case REAL:
        return parse_real(parser, option, text);
    case SIZE:
        return parse_size(parser, option, text);
    case CHOICE:
        return parse_choice(parser, option, text);
    case SET:
        return parse_set(parser, option, text);
    case LIST:
        return parse_list(parser, option, text);
    default:
        *(const char **)((char *)parser->out + option->offset) = text;
        return true;
    }
}

// --------------------------------------------------------------------------------------------------------------- options

// Edits (insert, remove, replace) that lead from `a` to `b`; for short words.
static size_t edit_distance(const char *a, const char *b) {
    enum { MOST = 32 };
    size_t row[MOST + 1], length = strlen(b);
    if (length > MOST || strlen(a) > MOST) return MOST;
    for (size_t j = 0; j <= length; j++) row[j] = j;
    for (size_t i = 1; a[i - 1]; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= length; j++) {
            size_t best = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            if (row[j] + 1 < best) best = row[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[length];
}

bool nearly_equal(const char *text, const char *name) {
    size_t length = strlen(text);
    if (length >= 2 && strncmp(text, name, length) == 0) return true;
    return edit_distance(text, name) <= (strlen(name) < 5 ? 1 : 2);
}

static bool unknown_option(struct parser *parser, const char *argument, const char *name) {
    for (size_t i = 0; i < OPTION_COUNT; i++)
        if (options[i].commands & parser->command && nearly_equal(name, options[i].name))
            return wrong(parser, "unknown option %s; did you mean --%s?", argument, options[i].name);
    for (size_t i = 0; i < OPTION_COUNT; i++)
        if (strcmp(name, options[i].name) == 0) return wrong(parser, "option %s belongs to another command", argument);
    return wrong(parser, "unknown option %s", argument);
}

// Takes in one option. `value` is what was attached to it, or NULL; then it is the next argument, if a value is called for.
static bool take_option(struct parser *parser, const struct option *option, const char *value) {
    void *to = (char *)parser->out + option->offset;
    bool again = parser->seen[option - options];
    parser->seen[option - options] = true;
    if (!option->value) {
        if (value) return wrong(parser, "--%s takes no value", option->name);
        if (option->kind == COUNT)
            ++*(uint32_t *)to;
        else
            *(bool *)to = true;
        return true;
    }
    if (again && option->kind != SET && option->kind != LIST) return wrong(parser, "--%s is given twice", option->name);
    if (!value && parser->next < parser->argc && strncmp(parser->argv[parser->next], "--", 2) != 0) value = parser->argv[parser->next++];
    if (!value || !*value) return wrong(parser, "--%s needs a value: --%s %s", option->name, option->name, option->value);
    return parse_value(parser, option, value);
}

// --name, --name=value
static bool take_long(struct parser *parser, const char *argument) {
    char name[64];
    size_t length = strcspn(argument + 2, "=");
    const char *value = argument[2 + length] ? argument + 3 + length : NULL;
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), argument + 2);
    for (size_t i = 0; i < OPTION_COUNT; i++)
        if (options[i].commands & parser->command && strcmp(name, options[i].name) == 0) return take_option(parser, &options[i], value);
    return unknown_option(parser, argument, name);
}

// -o FILE, -oFILE, -qv
static bool take_short(struct parser *parser, const char *argument) {
    for (const char *letter = argument + 1; *letter; letter++) {
        const struct option *option = NULL;
        for (size_t i = 0; i < OPTION_COUNT; i++)
            if (options[i].commands & parser->command && options[i].letter == *letter) option = &options[i];
        if (!option) return wrong(parser, "unknown option %s", argument);
        if (option->value) return take_option(parser, option, letter[1] ? letter + 1 : NULL);
        if (!take_option(parser, option, NULL)) return false;
    }
    return true;
}

static bool take_positional(struct parser *parser, const char *argument, int positionals) {
    if (parser->out->positional_count >= positionals)
        return wrong(parser, positionals ? "unexpected argument '%s'" : "unexpected argument '%s': this command takes none", argument);
    if (!*argument) return wrong(parser, "an argument is empty");
    parser->out->positionals[parser->out->positional_count++] = argument;
    return true;
}

static bool asks_for_help(int argc, char **argv) {
    for (int i = 0; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) return true;
    return false;
}

bool options_parse(struct settings *out, struct gn_error *error, int argc, char **argv, uint32_t command, int positionals,
                   const char *names) {
    *out = (struct settings){.accuracy = -1, .max_abs = -1, .max_flip = -1};
    struct parser parser = {.out = out, .error = error, .argc = argc, .argv = argv, .command = command};
    if ((out->help = asks_for_help(argc, argv))) return true;
    bool only_positionals = false;
    while (parser.next < argc) {
        const char *argument = argv[parser.next++];
        if (only_positionals || argument[0] != '-' || !argument[1]) {
            if (!take_positional(&parser, argument, positionals)) return false;
        } else if (strcmp(argument, "--") == 0) {
            only_positionals = true;
        } else if (!(argument[1] == '-' ? take_long : take_short)(&parser, argument)) {
            return false;
        }
    }
    if (out->positional_count < positionals) return wrong(&parser, "an argument is missing; expected: %s", names);
    return true;
}

// ------------------------------------------------------------------------------------------------------------------ help

#define HELP_COLUMN 26

static void print_option(const struct option *option) {
    char left[64], letter[5] = "    ";
    if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(left, sizeof left, "  %s--%s%s%s", letter, option->name, option->value ? " " : "", option->value ? option->value : "");
    printf("%s", left);
    print_wrapped(option->help, (int)strlen(left), HELP_COLUMN);
}

void options_print(uint32_t command) {
    for (int common = 0; common < 2; common++) {
        bool first = true;
        for (size_t i = 0; i < OPTION_COUNT; i++) {
            if (!(options[i].commands & command) || (options[i].commands == COMMAND_ALL) != common) continue;
            if (first) printf(common ? "\nOptions of every command:\n" : "\nOptions:\n");
            first = false;
            print_option(&options[i]);
        }
    }
}
