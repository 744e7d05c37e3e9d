#include "output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static void discard(struct output *output) {
    if (output->file) fclose(output->file);
    free(output->path);
    free(output->temporary);
    memset(output, 0, sizeof *output);
}

bool output_open(struct output *output, const char *path) {
    memset(output, 0, sizeof *output);
    size_t length = strlen(path);
    output->path = malloc(length + 1);
    output->temporary = malloc(length + 5);
    if (output->path && output->temporary) {
        memcpy(output->path, path, length + 1);
        memcpy(output->temporary, path, length);
        memcpy(output->temporary + length, ".tmp", 5);
        output->file = fopen(output->temporary, "wb");
    }
    if (output->file) return true;
    fprintf(stderr, "gnomon_meshgen: cannot write %s: %s\n", path, strerror(errno));
    discard(output);
    return false;
}

bool output_close(struct output *output, bool complete) {
    bool written = complete && !ferror(output->file);
    if (fclose(output->file) != 0) written = false;
    output->file = NULL;
    if (written && rename(output->temporary, output->path) == 0) {
        discard(output);
        return true;
    }
    fprintf(stderr, "gnomon_meshgen: cannot write %s: %s\n", output->path, strerror(errno));
    remove(output->temporary);
    discard(output);
    return false;
}
