#include "measure/cost/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------------------------------------------------------- text

// Length of the UTF-8 character at `text`, 0 if there is none (RFC 3629; overlong forms and surrogates are not looked for).
static size_t character_length(const unsigned char *text) {
    size_t length = text[0] < 0x80 ? 1 : (text[0] & 0xe0) == 0xc0 ? 2 : (text[0] & 0xf0) == 0xe0 ? 3 : (text[0] & 0xf8) == 0xf0 ? 4 : 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80) return 0;
    return length;
}

static const char *escaped(char character) {
    switch (character) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    default:
        return NULL;
    }
}

void html_text(FILE *to, const char *text) {
    while (*text) {
        size_t length = character_length((const unsigned char *)text);
        const char *entity = escaped(*text);
        if (entity)
            fputs(entity, to);
        else if (length == 0 || (unsigned char)*text < ' ')
            fputc('?', to);
        else
            fwrite(text, 1, length, to);
        text += length ? length : 1;
    }
}

// -------------------------------------------------------------------------------------------------------------- pictures

static void base64(FILE *to, const unsigned char *data, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t bits = (uint32_t)data[i] << 16 | (left > 1 ? (uint32_t)data[i + 1] << 8 : 0) | (left > 2 ? (uint32_t)data[i + 2] : 0);
        char four[4] = {digits[bits >> 18], digits[bits >> 12 & 63], left > 1 ? digits[bits >> 6 & 63] : '=', left > 2 ? digits[bits & 63] : '='};
        fwrite(four, 1, 4, to);
    }
}

bool html_image(FILE *to, struct context *ctx, const struct image *image, enum transfer transfer, const char *alternative) {
    struct file_bytes png;
    if (!image_encode_png(&png, ctx, image, transfer)) return false;
    fprintf(to, "<img width=\"%u\" height=\"%u\" alt=\"", image->width, image->height);
    html_text(to, alternative);
    fputs("\" src=\"data:image/png;base64,", to);
    base64(to, (const unsigned char *)png.data, png.size);
    fputs("\" />", to);
    file_bytes_finish(&png);
    return true;
}

// --------------------------------------------------------------------------------------------------------------- numbers

static void put_exponent(FILE *to, int exponent) {
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char digits[16];
    snprintf(digits, sizeof digits, "%d", abs(exponent));
    fputs(exponent < 0 ? "·10⁻" : "·10", to);
    for (const char *digit = digits; *digit; digit++) fputs(raised[*digit - '0'], to);
}

void html_number(FILE *to, double value) {
    double size = fabs(value);
    if (!isfinite(value)) {
        fputs(isnan(value) ? "not a number" : value > 0 ? "∞" : "−∞", to);
    } else if (value == 0) {
        fputs("0", to);
    } else if (size < 1e-3 || size >= 1e6) {
        char digits[32];
        snprintf(digits, sizeof digits, "%.2e", value);
        fprintf(to, "%.*s", (int)strcspn(digits, "e"), digits);
        put_exponent(to, atoi(strchr(digits, 'e') + 1));
    } else if (size >= 1000) {
        if (value < 0) fputs("−", to);
        html_count(to, (uint64_t)llround(size));
    } else {
        fprintf(to, "%.*f", size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : size >= 0.1 ? 3 : 4, value);
    }
}

void html_count(FILE *to, uint64_t value) {
    uint64_t unit = 1;
    while (value / unit >= 1000) unit *= 1000;
    fprintf(to, "%u", (unsigned)(value / unit));
    while ((unit /= 1000) > 0) fprintf(to, " %03u", (unsigned)(value / unit % 1000));
}
