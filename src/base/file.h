// Files: read whole, or written beside their name and renamed, so that an output is either whole or not there.
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include <stdio.h>

#include "base/context.h"

// A whole file in memory; data[size] is a zero byte that does not count. Zeroed is empty; finish accepts that.
struct file_bytes {
    char *data;
    size_t size;
};

// Reads a file. `blame` is the status on failure: GN_SCENE for assets, GN_IO for other inputs. The message names the path and the
// cause ("no such file", "is a directory", …). A pipe or device is read to its end, but not past 256 MiB.
bool file_read(struct file_bytes *out, struct context *ctx, const char *path, enum gn_status blame);
void file_bytes_finish(struct file_bytes *bytes);

// An output on its way: written to a temporary name in the same folder.
struct output_file {
    FILE *stream;
    char *path, *temporary;
};

// Opens the temporary. Fails (GN_IO) when the folder is missing or not writable, or when a file of that name is there and read-only. An
// existing non-regular target such as /dev/null or a pipe is written directly. A link is followed. "-" is not special.
bool output_begin(struct output_file *out, struct context *ctx, const char *path);

// Writes to the stream. On failure reports the path and the cause (GN_IO); output_abort is then due.
bool output_write(struct output_file *out, struct context *ctx, const void *data, size_t size);

// Flushes, syncs, checks for errors, and renames to the final name. On failure nothing is left behind. Finishes *out in any case.
bool output_commit(struct output_file *out, struct context *ctx);

// Removes the temporary; accepts a zeroed or committed value.
void output_abort(struct output_file *out);

// The suffix of a path in lower case without its dot, into suffix[capacity]; "" if there is none or it does not fit. A dot that begins
// the name begins no suffix.
void path_suffix(const char *path, char *suffix, size_t capacity);

// `name` as seen from the file `base`: unchanged if absolute, else in base's folder. To be freed. NULL: out of memory.
char *path_beside(const char *base, const char *name);

#endif
