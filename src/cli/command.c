#include "cli/command.h"

#include <errno.h>
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

struct context run_context(struct run *run) {
    return context_make(&run->host, &run->error);
}

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
    const struct gn_device_params params = {
        .select = run->settings.device, .validate = run->settings.validate, .hide_fp64 = run->settings.hide_fp64, .host = &run->host};
    return gn_device_create(&params, &run->error);
}

enum gn_accuracy run_accuracy(const struct run *run) {
    return run->settings.accuracy < 0 ? GN_ROBUST : (enum gn_accuracy)run->settings.accuracy;
}

struct gn_render_params run_render_params(struct run *run) {
    const struct settings *settings = &run->settings;
    return (struct gn_render_params){
        .width = settings->size.width,
        .height = settings->size.height,
        .spp = settings->spp,
        .seed = settings->seed,
        .accuracy = run_accuracy(run),
        .aovs = settings->aovs,
        .disable = settings->disable,
        .only = settings->only_effects,
        .no_prune = settings->no_prune,
        .tile_pixels = settings->tile_pixels,
        .host = &run->host,
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
