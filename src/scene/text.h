// A text being read, and messages that say where in it: what the readers of OBJ, MTL, STL and PLY share.
#ifndef SCENE_TEXT_H
#define SCENE_TEXT_H

#include <stdint.h>

#include "base/context.h"

struct text {
    struct context *ctx;
    const char *path;             // for messages
    const char *begin, *at, *end; // *end is 0
};

// Line and column of `at`, both from 1; a column is a character, not a byte.
struct text_place {
    size_t line, column;
};
struct text_place text_place(const char *begin, const char *at);

// GN_SCENE "path:line:column: …" for the place `at`. Returns false.
bool text_fail(const struct text *text, const char *at, const char *format, ...) __attribute__((format(printf, 3, 4)));

// The same as a warning.
void text_warn(const struct text *text, const char *at, const char *format, ...) __attribute__((format(printf, 3, 4)));

// GN_SCENE "path:line:column: expected <what>, found '<what stands there>'". Returns false.
bool text_expected(const struct text *text, const char *at, const char *what);

// Skips blanks up to the end of the line: a line goes on behind a backslash at its end, and ends before a '#'.
void text_skip_blanks(struct text *text);
// Skips blanks and line ends.
void text_skip_space(struct text *text);
// To the beginning of the next line. With `continued`, a line goes on behind a backslash at its end here, too.
void text_next_line(struct text *text, bool continued);
// Whether the line ends here: at a line end, a comment, or the end of the text.
bool text_line_ends(const struct text *text);

// The word here, up to white space: its length, 0 at the end. Does not move.
size_t text_word(const struct text *text);
// Skips the word if it is `word`, in any case of letters.
bool text_accept(struct text *text, const char *word);

// A copy of the rest of the line, white space around it removed; to be freed. Moves to the line's end. NULL when memory is missing.
char *text_rest(struct text *text);

// A number here, and its end: finite, the nearest fp32. `what` it is, e.g. "x of a vertex".
bool text_float(struct text *text, float *out, const char *what);
// An integer here, and its end.
bool text_integer(struct text *text, int64_t *out, const char *what);

// Reports how far reading is. False when cancelled.
bool text_progress(const struct text *text);

#endif
