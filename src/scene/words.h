// Words for messages: what a file says, fit to be printed, and the known name that an unknown one was perhaps meant to be.
#ifndef SCENE_WORDS_H
#define SCENE_WORDS_H

#include <stddef.h>

#define EXCERPT_SIZE 64

// A short printable copy of bytes[0 … size) of anything: control characters and what is not UTF-8 become '?', a long text is cut.
struct excerpt {
    char text[EXCERPT_SIZE];
};
struct excerpt excerpt_make(const char *bytes, size_t size);
struct excerpt excerpt_word(const char *word);

// The known name nearest to `wanted`: offer each, then read `best`, NULL if none is near.
struct nearest {
    const char *wanted;
    const char *best;
    size_t distance; // edits between wanted and best
};
struct nearest nearest_to(const char *wanted);
void nearest_offer(struct nearest *nearest, const char *known);

// "; did you mean 'best'?", or nothing.
struct hint {
    char text[EXCERPT_SIZE + 32];
};
struct hint nearest_hint(const struct nearest *nearest);

#endif
