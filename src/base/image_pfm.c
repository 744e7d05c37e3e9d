// PFM, the portable float map: "PF" or "Pf", width, height and scale as text, one space character, then fp32 rows, the lowest first.
// A negative scale says little-endian. After Paul Debevec's description of the format (HDRShop).
#include <stdio.h>
#include <string.h>

#include "base/image_codec.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "rows are written as they lie in memory");

// ---- reading

struct pfm_header {
    uint32_t width, height, channels;
    bool big_endian;
    size_t size;
};

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The next word of the header into word[capacity]; *at moves to the character after it.
static bool next_word(const struct file_bytes *bytes, size_t *at, char *word, size_t capacity) {
    while (*at < bytes->size && is_space(bytes->data[*at])) ++*at;
    size_t length = 0;
    while (*at < bytes->size && !is_space(bytes->data[*at]) && length + 1 < capacity) word[length++] = bytes->data[(*at)++];
    word[length] = '\0';
    return length > 0 && *at < bytes->size && is_space(bytes->data[*at]);
}

static bool parse_size(const char *word, uint32_t *out) {
    uint32_t value = 0;
    for (const char *c = word; *c; c++) {
        if (*c < '0' || *c > '9' || value > 99999999) return false;
        value = 10 * value + (uint32_t)(*c - '0');
    }
    *out = value;
    return true;
}

// A decimal number other than 0; only its sign matters. By hand: strtod depends on the locale.
static bool parse_scale(const char *word, bool *negative) {
    *negative = *word == '-';
    if (*word == '-' || *word == '+') word++;
    size_t mantissa = strspn(word, "0123456789.");
    bool zero = strspn(word, "0.") >= mantissa;
    word += mantissa;
    if (*word == 'e' || *word == 'E') word += 1 + strspn(word + 1, "+-0123456789");
    return !zero && *word == '\0';
}

static bool parse_header(struct pfm_header *out, const struct file_bytes *bytes) {
    char word[32];
    bool little_endian;
    *out = (struct pfm_header){0};
    if (!next_word(bytes, &out->size, word, sizeof word)) return false;
    if (strcmp(word, "PF") != 0 && strcmp(word, "Pf") != 0) return false;
    out->channels = word[1] == 'F' ? 3 : 1;
    if (!next_word(bytes, &out->size, word, sizeof word) || !parse_size(word, &out->width)) return false;
    if (!next_word(bytes, &out->size, word, sizeof word) || !parse_size(word, &out->height)) return false;
    if (!next_word(bytes, &out->size, word, sizeof word) || !parse_scale(word, &little_endian)) return false;
    out->big_endian = !little_endian;
    out->size++; // the one space character
    return true;
}

static float load_float(const unsigned char *b, bool big_endian) {
    uint32_t bits = big_endian ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]
                               : (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

bool image_decode_pfm(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    *out = (struct image){0};
    struct pfm_header header;
    if (!parse_header(&header, bytes))
        return fail(ctx, GN_IO, "%s: has a malformed PFM header; expected PF or Pf, width, height and a scale other than 0", path);
    if (!image_init_announced(out, ctx, path, header.width, header.height, bytes->size, 0.25)) return false;
    uint64_t row = (uint64_t)header.width * header.channels * 4, need = row * header.height, have = bytes->size - header.size;
    if (have != need) {
        image_finish(out);
        return fail(ctx, GN_IO, "%s: has %ju bytes of pixels where %u × %u pixels of %u channels need %ju", path, (uintmax_t)have,
                    header.width, header.height, header.channels, (uintmax_t)need);
    }
    const unsigned char *rows = (const unsigned char *)bytes->data + header.size;
    float *pixel = out->pixels;
    for (uint32_t y = 0; y < header.height; y++)
        for (uint32_t x = 0; x < header.width; x++, pixel += 3)
            for (uint32_t c = 0; c < 3; c++) {
                size_t sample = (size_t)x * header.channels + (header.channels == 3 ? c : 0);
                pixel[c] = load_float(rows + (size_t)(header.height - 1 - y) * row + 4 * sample, header.big_endian);
            }
    return true;
}

// ---- writing

bool image_write_pfm(const struct image *image, struct context *ctx, const char *path) {
    struct output_file file;
    if (!image_check_writable(image, ctx, path) || !output_begin(&file, ctx, path)) return false;
    char header[64];
    int length = snprintf(header, sizeof header, "P%c\n%u %u\n-1.0\n", image->channels == 3 ? 'F' : 'f', image->width, image->height);
    bool done = output_write(&file, ctx, header, (size_t)length);
    size_t row = (size_t)image->width * image->channels;
    for (uint32_t y = image->height; done && y-- > 0;) done = output_write(&file, ctx, image->pixels + y * row, row * sizeof(float));
    if (done) return output_commit(&file, ctx);
    output_abort(&file);
    return false;
}
