// An output file: written beside its name and renamed, so that it is whole or not there.
#ifndef MESHGEN_OUTPUT_H
#define MESHGEN_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

struct output {
    FILE *file;
    char *path, *temporary;
};

// Opens the temporary file. False, with a message on standard error, when that fails; nothing is left then.
bool output_open(struct output *output, const char *path);

// Closes and renames. With `complete` false, or when writing failed, the temporary is removed instead, and the answer is false.
bool output_close(struct output *output, bool complete);

#endif
