// Excerpts and spelling.
#include "scene/words.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

// Bytes of the UTF-8 character at `at` (RFC 3629), or 0.
static size_t utf8_length(const unsigned char *at, size_t size) {
    if (at[0] < 0x80) return 1;
    size_t length = at[0] >= 0xc2 && at[0] < 0xe0 ? 2 : (at[0] & 0xf0) == 0xe0 ? 3 : at[0] >= 0xf0 && at[0] < 0xf5 ? 4 : 0;
    if (length == 0 || length > size) return 0;
    for (size_t i = 1; i < length; i++)
        if ((at[i] & 0xc0) != 0x80) return 0;
    if ((at[0] == 0xe0 && at[1] < 0xa0) || (at[0] == 0xf0 && at[1] < 0x90)) return 0; // longer than need be
    if ((at[0] == 0xed && at[1] > 0x9f) || (at[0] == 0xf4 && at[1] > 0x8f)) return 0; // a surrogate; beyond U+10FFFF
    return length;
}

struct excerpt excerpt_make(const char *bytes, size_t size) {
    static const char cut[] = "…";
    struct excerpt out = {""};
    size_t used = 0;
    for (size_t i = 0; i < size;) {
        const unsigned char *at = (const unsigned char *)bytes + i;
        size_t length = utf8_length(at, size - i);
        if (used + (length ? length : 1) + sizeof cut > sizeof out.text) {
            memcpy(out.text + used, cut, sizeof cut);
            break;
        }
        bool printable = length > 0 && *at >= 0x20 && *at != 0x7f && !(at[0] == 0xc2 && at[1] < 0xa0);
        if (printable)
            memcpy(out.text + used, at, length);
        else
            out.text[used] = '?', length = length ? length : 1;
        used += printable ? length : 1;
        i += length;
    }
    return out;
}

struct excerpt excerpt_word(const char *word) {
    return excerpt_make(word, strlen(word));
}

#define LONGEST_NAME 40

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c; }

// Fewest insertions, deletions and substitutions from a to b, letters in any case (V. I. Levenshtein 1966, by the usual table, one row at a
// time).
static size_t edit_distance(const char *a, const char *b) {
    size_t m = strlen(a), n = strlen(b), row[LONGEST_NAME + 1];
    if (m > LONGEST_NAME || n > LONGEST_NAME) return SIZE_MAX;
    for (size_t j = 0; j <= n; j++) row[j] = j;
    for (size_t i = 1; i <= m; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t substituted = diagonal + (lower(a[i - 1]) != lower(b[j - 1]));
            diagonal = row[j];
            row[j] = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            if (substituted < row[j]) row[j] = substituted;
        }
    }
    return row[n];
}

struct nearest nearest_to(const char *wanted) {
    return (struct nearest){.wanted = wanted, .distance = SIZE_MAX};
}

void nearest_offer(struct nearest *nearest, const char *known) {
    size_t distance = edit_distance(nearest->wanted, known);
    size_t length = strlen(known);
    if (distance >= nearest->distance || distance >= length || distance > 1 + length / 3) return;
    nearest->best = known;
    nearest->distance = distance;
}

struct hint nearest_hint(const struct nearest *nearest) {
    struct hint hint = {""};
    if (nearest->best) snprintf(hint.text, sizeof hint.text, "; did you mean '%s'?", excerpt_word(nearest->best).text);
    return hint;
}
