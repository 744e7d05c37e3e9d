// Radiance pictures (.hdr): a text header, then rows of four bytes a pixel, three mantissas with one exponent, each row in one of two kinds
// of run-length code. After G. Ward, "Real Pixels", Graphics Gems II, 1991, and the description of the format in Radiance's reference
// manual.
//
// Values are as the file has them: EXPOSURE= and the like do not count. A mantissa m with exponent e is m · 2^(e - 136), as most programs
// have it.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/image_codec.h"

// A run of the older code can be of any length; what counts is that a small file claims no terabytes.
#define MOST_PIXELS_PER_BYTE 65536.0

struct hdr {
    struct context *ctx;
    const char *path;
    const unsigned char *at, *end;
    bool from_below, from_right; // the first row is the lowest one, the first pixel the rightmost
    uint64_t width, height;
};

static bool hdr_fail(const struct hdr *hdr, const char *what) {
    return fail(hdr->ctx, GN_IO, "%s: is not a valid Radiance file: %s", hdr->path, what);
}

// ------------------------------------------------------------------------------------------------------------------- header

// The next line without its end, cut to fit; false at the end of the file.
static bool next_line(struct hdr *hdr, char *line, size_t capacity) {
    const unsigned char *newline = memchr(hdr->at, '\n', (size_t)(hdr->end - hdr->at));
    if (!newline) return false;
    size_t length = (size_t)(newline - hdr->at);
    if (length > capacity - 1) length = capacity - 1;
    memcpy(line, hdr->at, length);
    line[length] = '\0';
    line[strcspn(line, "\r")] = '\0';
    hdr->at = newline + 1;
    return true;
}

// "-Y 512 +X 1024": rows from the top, pixels from the left.
static bool parse_resolution(struct hdr *hdr, const char *line) {
    char vertical, horizontal, rest;
    unsigned long height, width;
    if (sscanf(line, "%cY %5lu %cX %5lu%c", &vertical, &height, &horizontal, &width, &rest) != 4) return false;
    if ((vertical != '-' && vertical != '+') || (horizontal != '-' && horizontal != '+')) return false;
    hdr->from_below = vertical == '+', hdr->from_right = horizontal == '-';
    hdr->width = width, hdr->height = height;
    return true;
}

static bool parse_header(struct hdr *hdr) {
    char line[128];
    do {
        if (!next_line(hdr, line, sizeof line)) return hdr_fail(hdr, "its header has no end");
        if (strncmp(line, "FORMAT=", 7) == 0 && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
            return hdr_fail(hdr, "it is in another FORMAT than 32-bit_rle_rgbe");
    } while (line[0]);
    if (!next_line(hdr, line, sizeof line) || !parse_resolution(hdr, line))
        return hdr_fail(hdr, "its size is not given as in '-Y 512 +X 1024'");
    return true;
}

// --------------------------------------------------------------------------------------------------------------------- rows

// One of the four components of a row: runs of up to 127 equal bytes, or up to 128 different ones.
static bool read_component(struct hdr *hdr, unsigned char *component) {
    for (size_t x = 0; x < hdr->width;) {
        if (hdr->end - hdr->at < 2) return false;
        const bool run = *hdr->at > 128;
        const size_t count = run ? *hdr->at - 128u : *hdr->at;
        hdr->at++;
        if (count == 0 || count > hdr->width - x || (size_t)(hdr->end - hdr->at) < (run ? 1 : count)) return false;
        for (size_t i = 0; i < count; i++) component[4 * (x + i)] = hdr->at[run ? 0 : i];
        hdr->at += run ? 1 : count;
        x += count;
    }
    return true;
}

// The older code, or none: four bytes a pixel, and after a pixel 1, 1, 1, n which repeats it; another such gives the next higher digit of
// n.
static bool read_pixels(struct hdr *hdr, unsigned char *row) {
    unsigned shift = 0;
    for (size_t x = 0; x < hdr->width; hdr->at += 4) {
        if (hdr->end - hdr->at < 4) return false;
        if (hdr->at[0] != 1 || hdr->at[1] != 1 || hdr->at[2] != 1) {
            memcpy(row + 4 * x++, hdr->at, 4);
            shift = 0;
            continue;
        }
        if (x == 0 || shift > 16) return false;
        const size_t count = (size_t)hdr->at[3] << shift;
        if (count > hdr->width - x) return false;
        for (size_t i = 0; i < count; i++, x++) memcpy(row + 4 * x, row + 4 * (x - 1), 4);
        shift += 8;
    }
    return true;
}

static bool read_row(struct hdr *hdr, unsigned char *row) {
    const unsigned char *at = hdr->at;
    const bool coded = hdr->width >= 8 && hdr->width < 32768 && hdr->end - at >= 4 && at[0] == 2 && at[1] == 2 && at[2] < 128;
    if (!coded) return read_pixels(hdr, row);
    if ((at[2] << 8 | at[3]) != (int)hdr->width) return false;
    hdr->at += 4;
    for (int c = 0; c < 4; c++)
        if (!read_component(hdr, row + c)) return false;
    return true;
}

static void decode_row(const struct hdr *hdr, float *out, const unsigned char *row) {
    for (size_t x = 0; x < hdr->width; x++) {
        const unsigned char *rgbe = row + 4 * x;
        float *to = out + 3 * (hdr->from_right ? hdr->width - 1 - x : x);
        const float unit = rgbe[3] > 0 ? ldexpf(1, rgbe[3] - 136) : 0;
        for (int c = 0; c < 3; c++) to[c] = rgbe[c] * unit;
    }
}

static bool read_rows(struct hdr *hdr, struct image *out, unsigned char *row) {
    for (size_t y = 0; y < hdr->height; y++) {
        if (!read_row(hdr, row)) return hdr_fail(hdr, "it ends early, or its rows are damaged");
        decode_row(hdr, out->pixels + 3 * hdr->width * (hdr->from_below ? hdr->height - 1 - y : y), row);
    }
    return true;
}

bool image_decode_hdr(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    const unsigned char *data = (const unsigned char *)bytes->data;
    struct hdr hdr = {.ctx = ctx, .path = path, .at = data, .end = data + bytes->size};
    *out = (struct image){0};
    if (!parse_header(&hdr) || !image_init_announced(out, ctx, path, hdr.width, hdr.height, bytes->size, MOST_PIXELS_PER_BYTE))
        return false;
    unsigned char *row = array_alloc(ctx, (size_t)hdr.width, 4, "a row of a picture");
    const bool done = row && read_rows(&hdr, out, row);
    free(row);
    if (!done) image_finish(out);
    return done;
}
