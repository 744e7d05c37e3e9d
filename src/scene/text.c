// Places are found by counting when a message needs one: reading itself keeps no count.
#include "scene/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/number.h"
#include "scene/words.h"

struct text_place text_place(const char *begin, const char *at) {
    struct text_place place = {.line = 1, .column = 1};
    const char *line = begin;
    for (const char *newline; line < at && (newline = memchr(line, '\n', (size_t)(at - line))); line = newline + 1) place.line++;
    for (; line < at; line++) place.column += (*line & 0xc0) != 0x80; // not the rest of a UTF-8 character
    return place;
}

bool text_fail(const struct text *text, const char *at, const char *format, ...) {
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    struct text_place place = text_place(text->begin, at);
    return fail(text->ctx, GN_SCENE, "%s:%zu:%zu: %s", text->path, place.line, place.column, message);
}

void text_warn(const struct text *text, const char *at, const char *format, ...) {
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    struct text_place place = text_place(text->begin, at);
    notify(text->ctx, GN_LEVEL_WARNING, "%s:%zu:%zu: %s", text->path, place.line, place.column, message);
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
static bool is_space(char c) { return is_blank(c) || c == '\n'; }

// Bytes of a backslash and the line end behind it, or 0.
static size_t continuation(const char *at) {
    if (at[0] != '\\') return 0;
    return at[1] == '\n' ? 2 : at[1] == '\r' && at[2] == '\n' ? 3 : 0;
}

void text_skip_blanks(struct text *text) {
    for (size_t length; is_blank(*text->at) || continuation(text->at);) {
        length = continuation(text->at);
        text->at += length ? length : 1;
    }
}

void text_skip_space(struct text *text) {
    while (is_space(*text->at)) text->at++;
}

// Whether the line end at `newline` has a backslash before it.
static bool is_continued(const struct text *text, const char *newline) {
    const char *last = newline;
    if (last > text->at && last[-1] == '\r') last--;
    return last > text->at && last[-1] == '\\';
}

void text_next_line(struct text *text, bool continued) {
    bool again;
    do {
        const char *newline = memchr(text->at, '\n', (size_t)(text->end - text->at));
        again = continued && newline && is_continued(text, newline);
        text->at = newline ? newline + 1 : text->end;
    } while (again);
}

bool text_line_ends(const struct text *text) { return text->at == text->end || *text->at == '\n' || *text->at == '#'; }

size_t text_word(const struct text *text) {
    const char *at = text->at;
    while (at < text->end && !is_space(*at) && !continuation(at)) at++;
    return (size_t)(at - text->at);
}

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c; }

bool text_accept(struct text *text, const char *word) {
    const size_t length = strlen(word);
    if (text_word(text) != length) return false;
    for (size_t i = 0; i < length; i++)
        if (lower(text->at[i]) != lower(word[i])) return false;
    text->at += length;
    return true;
}

char *text_rest(struct text *text) {
    while (is_blank(*text->at)) text->at++;
    const char *newline = memchr(text->at, '\n', (size_t)(text->end - text->at)), *end = newline ? newline : text->end;
    size_t length = (size_t)(end - text->at);
    while (length > 0 && is_blank(text->at[length - 1])) length--;
    char *rest = strndup(text->at, length);
    if (!rest) fail(text->ctx, GN_LIMIT, "no memory for a name");
    text->at = end;
    return rest;
}

bool text_expected(const struct text *text, const char *at, const char *what) {
    struct text here = *text;
    here.at = at;
    size_t length = text_word(&here);
    if (at == text->end) return text_fail(text, at, "expected %s, found the end of the file", what);
    if (length == 0 || *at == '#') return text_fail(text, at, "expected %s, found the end of the line", what);
    return text_fail(text, at, "expected %s, found '%s'", what, excerpt_make(at, length).text);
}

// Whether a number may end before `at`.
static bool is_number_end(const struct text *text, const char *at) {
    return at == text->end || is_space(*at) || *at == '#' || continuation(at);
}

bool text_float(struct text *text, float *out, const char *what) {
    const char *end = number_f32(out, text->at);
    if (!end || !is_number_end(text, end)) {
        char expected[96];
        snprintf(expected, sizeof expected, "a number (%s)", what);
        return text_expected(text, text->at, expected);
    }
    if (!isfinite(*out))
        return text_fail(text, text->at, "%s is %s, expected a finite number within the range of fp32", what,
                         excerpt_make(text->at, (size_t)(end - text->at)).text);
    text->at = end;
    return true;
}

bool text_integer(struct text *text, int64_t *out, const char *what) {
    const char *end = number_i64(out, text->at);
    if (!end || !is_number_end(text, end)) {
        char expected[96];
        snprintf(expected, sizeof expected, "an integer (%s)", what);
        return text_expected(text, text->at, expected);
    }
    text->at = end;
    return true;
}

bool text_progress(const struct text *text) {
    return progress(text->ctx, "scene", (double)(text->at - text->begin) / ((double)(text->end - text->begin) + 1), -1);
}
