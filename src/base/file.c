// Files read whole; outputs written under a temporary name beside their own and renamed when they are complete.
#define _XOPEN_SOURCE 700 // realpath
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"

// What a pipe or a device may give: some never end.
#define STREAM_LIMIT ((size_t)256 << 20)

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// Makes room for `capacity` bytes and the zero after them.
static bool bytes_reserve(struct file_bytes *bytes, struct context *ctx, const char *path, size_t capacity) {
    char *data = capacity < SIZE_MAX ? realloc(bytes->data, capacity + 1) : NULL;
    if (!data) return fail(ctx, GN_LIMIT, "%s: no memory to read it: %zu bytes", path, capacity);
    bytes->data = data;
    return true;
}

static bool stream_read(struct file_bytes *out, struct context *ctx, FILE *stream, const char *path, enum gn_status blame) {
    struct stat about;
    if (fstat(fileno(stream), &about) != 0) return fail(ctx, blame, "%s: cannot be read: %s", path, strerror(errno));
    if (S_ISDIR(about.st_mode)) return fail(ctx, blame, "%s: is a directory, a file was expected", path);
    bool regular = S_ISREG(about.st_mode);
    // One byte more than a regular file has, so that its end is seen without growing.
    size_t capacity = regular && (uintmax_t)about.st_size < SIZE_MAX / 4 ? (size_t)about.st_size + 1 : 65536;
    do {
        if (out->size == capacity) capacity *= 2;
        if (!bytes_reserve(out, ctx, path, capacity)) return false;
        out->size += fread(out->data + out->size, 1, capacity - out->size, stream);
        if (!regular && out->size > STREAM_LIMIT) return fail(ctx, blame, "%s: gives more than 256 MiB; only a regular file may", path);
    } while (out->size == capacity);
    if (ferror(stream)) return fail(ctx, blame, "%s: cannot be read: %s", path, strerror(errno));
    out->data[out->size] = '\0';
    return true;
}

bool file_read(struct file_bytes *out, struct context *ctx, const char *path, enum gn_status blame) {
    *out = (struct file_bytes){0};
    FILE *stream = fopen(path, "rb");
    if (!stream) return fail(ctx, blame, "%s: cannot be opened: %s", path, strerror(errno));
    bool done = stream_read(out, ctx, stream, path, blame);
    fclose(stream);
    if (!done) file_bytes_finish(out);
    return done;
}

void file_bytes_finish(struct file_bytes *bytes) {
    free(bytes->data);
    *bytes = (struct file_bytes){0};
}

// Opens `.name.<hex>.tmp` in the folder of out->path. Not mkstemp, which makes a file that only its owner can read: the permissions
// here are fopen's, and asking for the umask would mean to change it for all threads.
static int temporary_open(struct output_file *out) {
    const char *name = file_name(out->path);
    int folder_length = (int)(name - out->path);
    size_t capacity = strlen(out->path) + 32;
    out->temporary = malloc(capacity);
    if (!out->temporary) return -1;
    unsigned number = (unsigned)getpid() * 2654435761u ^ (unsigned)(uintptr_t)out ^ (unsigned)(uint64_t)(clock_seconds() * 1e9);
    int descriptor = -1;
    for (int attempt = 0; attempt < 100 && descriptor < 0; attempt++) {
        // A name is at most 255 bytes, so a long one is cut.
        snprintf(out->temporary, capacity, "%.*s.%.200s.%08x.tmp", folder_length, out->path, name, number++);
        descriptor = open(out->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno != EEXIST) break;
    }
    if (descriptor >= 0) return descriptor;
    free(out->temporary);
    out->temporary = NULL;
    return -1;
}

// `old`: what is there under that name already, or NULL. On failure errno says why.
static bool open_beside(struct output_file *out, const char *path, const struct stat *old) {
    out->path = old ? realpath(path, NULL) : strdup(path);
    if (!out->path || (old && access(out->path, W_OK) != 0)) return false;
    if (*file_name(path) == '\0') {
        errno = *path ? EISDIR : ENOENT;
        return false;
    }
    int descriptor = temporary_open(out);
    if (descriptor < 0) return false;
    if (old) (void)!fchmod(descriptor, old->st_mode & 0777); // as overwriting would leave it; where that is refused, no harm is done
    out->stream = fdopen(descriptor, "wb");
    if (!out->stream) close(descriptor);
    return out->stream != NULL;
}

static bool open_directly(struct output_file *out, const char *path) {
    out->path = strdup(path);
    if (!out->path) return false;
    out->stream = fopen(path, "wb");
    return out->stream != NULL;
}

bool output_begin(struct output_file *out, struct context *ctx, const char *path) {
    *out = (struct output_file){0};
    struct stat about;
    bool exists = stat(path, &about) == 0;
    if (exists && S_ISDIR(about.st_mode)) return fail(ctx, GN_IO, "%s: cannot be written: it is a directory", path);
    bool direct = exists && !S_ISREG(about.st_mode);
    if (direct ? open_directly(out, path) : open_beside(out, path, exists ? &about : NULL)) return true;
    int cause = errno;
    output_abort(out);
    return fail(ctx, GN_IO, "%s: cannot be written: %s", path, cause == ENOENT ? "its folder does not exist" : strerror(cause));
}

bool output_write(struct output_file *out, struct context *ctx, const void *data, size_t size) {
    if (fwrite(data, 1, size, out->stream) == size) return true;
    return fail(ctx, GN_IO, "%s: cannot be written: %s", out->path, strerror(errno));
}

bool output_commit(struct output_file *out, struct context *ctx) {
    errno = 0;
    bool done = fflush(out->stream) == 0 && !ferror(out->stream);
    if (done && out->temporary) done = fsync(fileno(out->stream)) == 0;
    int cause = errno;
    if (fclose(out->stream) != 0 && done) {
        done = false;
        cause = errno;
    }
    out->stream = NULL;
    if (done && out->temporary && rename(out->temporary, out->path) != 0) {
        done = false;
        cause = errno;
    }
    if (!done) fail(ctx, GN_IO, "%s: cannot be written: %s", out->path, cause ? strerror(cause) : "an earlier write failed");
    if (done) {
        free(out->temporary); // the name is gone: nothing to remove
        out->temporary = NULL;
    }
    output_abort(out);
    return done;
}

void output_abort(struct output_file *out) {
    if (out->stream) fclose(out->stream);
    if (out->temporary) unlink(out->temporary);
    free(out->temporary);
    free(out->path);
    *out = (struct output_file){0};
}

void path_suffix(const char *path, char *suffix, size_t capacity) {
    if (capacity == 0) return;
    suffix[0] = '\0';
    const char *name = file_name(path), *dot = strrchr(name, '.');
    if (!dot || dot == name || strlen(dot + 1) >= capacity) return;
    size_t length = strlen(dot + 1);
    for (size_t i = 0; i <= length; i++) { // by hand: tolower depends on the locale
        char letter = dot[1 + i];
        suffix[i] = letter >= 'A' && letter <= 'Z' ? (char)(letter + ('a' - 'A')) : letter;
    }
}

char *path_beside(const char *base, const char *name) {
    size_t folder = name[0] == '/' ? 0 : (size_t)(file_name(base) - base), length = strlen(name);
    char *path = malloc(folder + length + 1);
    if (!path) return NULL;
    memcpy(path, base, folder);
    memcpy(path + folder, name, length + 1);
    return path;
}
