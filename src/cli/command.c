#include "cli/command.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "cli/cache_dir.h"
#include "cli/interrupt.h"

struct context run_context(struct run *run) { return context_make(&run->host, &run->error); }

bool run_fail(struct run *run, enum gn_status status, const char *format, ...) {
    run->error.status = status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(run->error.message, sizeof run->error.message, format, arguments);
    va_end(arguments);
    return false;
}

void run_say(struct run *run, const char *format, ...) {
    if (run->settings.quiet) return;
    progress_clear(&run->view);
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

bool run_result(struct run *run, json_t *result) {
    run->result = result;
    return result ? true : run_fail(run, GN_LIMIT, "no memory for the result");
}

double run_ms(const struct run *run) { return clock_ms_since(run->started); }

// --------------------------------------------------------------------------------------------------- settings as parameters

struct gn_device *run_device(struct run *run) {
    cache_dir_choose();
    const struct gn_device_params params = {.select = run->settings.device, .validate = run->settings.validate, .host = &run->host};
    return gn_device_create(&params, &run->error);
}

struct gn_render_params run_render_params(struct run *run) {
    const struct settings *settings = &run->settings;
    return (struct gn_render_params){
        .width = settings->size.width, .height = settings->size.height, .spp = settings->spp, .seed = settings->seed,
        .accuracy = (enum gn_accuracy)settings->accuracy, .aovs = settings->aovs, .disable = settings->disable,
        .no_prune = settings->no_prune, .tile_pixels = settings->tile_pixels, .host = &run->host,
    };
}

// --------------------------------------------------------------------------------------------------------------- outputs

static bool suffix_in(const char *suffix, const char *suffixes) {
    for (size_t length = strlen(suffix); length;) {
        if (strncmp(suffixes, suffix, length) == 0 && (!suffixes[length] || suffixes[length] == '|')) return true;
        if (!(suffixes = strchr(suffixes, '|'))) return false;
        suffixes++;
    }
    return false;
}

bool run_check_output(struct run *run, const char *path, const char *suffixes) {
    char suffix[16];
    struct stat info;
    path_suffix(path, suffix, sizeof suffix);
    if (suffixes && !suffix_in(suffix, suffixes))
        return run_fail(run, GN_USAGE, "-o %s: the suffix of the name says which format to write; expected one of %s", path, suffixes);
    bool exists = stat(path, &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) return run_fail(run, GN_IO, "%s: cannot be written: it is a directory", path);
    if (exists && access(path, W_OK) != 0) return run_fail(run, GN_IO, "%s: cannot be written: %s", path, strerror(errno));
    if (exists && !S_ISREG(info.st_mode)) return true;
    char *folder = path_beside(path, ".");
    if (!folder) return run_fail(run, GN_LIMIT, "no memory for a path");
    bool writable = access(folder, W_OK | X_OK) == 0;
    int cause = errno;
    free(folder);
    if (writable) return true;
    return run_fail(run, GN_IO, "%s: cannot be written: %s", path, cause == ENOENT ? "its folder does not exist" : strerror(cause));
}

bool run_save(struct run *run, struct gn_picture *picture, const char *path) {
    interrupt_hold();
    bool saved = gn_picture_save(picture, path, &run->error);
    interrupt_release();
    return saved;
}

// ------------------------------------------------------------------------------------------------------------------ JSON

// The length of the UTF-8 character at `text`, or 0 if it is none. Overlong forms and surrogates are left to json_string.
static size_t character_length(const unsigned char *text) {
    size_t length = text[0] < 0x80 ? 1 : text[0] >> 5 == 6 ? 2 : text[0] >> 4 == 14 ? 3 : text[0] >> 3 == 30 ? 4 : 0;
    for (size_t i = 1; i < length; i++)
        if (text[i] >> 6 != 2) return 0;
    return length;
}

json_t *json_words(const char *text) {
    json_t *value = json_string(text);
    if (value) return value;
    char *copy = malloc(strlen(text) + 1), *to = copy;
    if (!copy) return NULL;
    while (*text) {
        char character[5] = "";
        size_t length = character_length((const unsigned char *)text);
        memcpy(character, text, length);
        json_t *valid = length ? json_string(character) : NULL;
        if (valid) memcpy(to, character, length);
        else *to = '?', length = 1;
        json_decref(valid);
        to += length, text += length;
    }
    *to = 0;
    value = json_string(copy);
    free(copy);
    return value;
}

json_t *json_number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

json_t *json_ms(double ms) { return json_number(round(1e3 * ms) / 1e3); }

json_t *json_names(const char *list) {
    json_t *names = json_array();
    while (*list) {
        size_t length = strcspn(list, ",");
        json_array_append_new(names, json_stringn(list, length));
        list += length + (list[length] != 0);
    }
    return names;
}
