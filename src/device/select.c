// Which device `--device` means.
#include "device/select.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

// From the one most wanted; "gpu" takes the first three.
static const char *const TYPES[] = {"discrete", "integrated", "virtual", "cpu", "other"};
enum { FIRST_CPU = 3, TYPE_COUNT = 5 };

static int find_type(const struct gn_device_info *infos, uint32_t count, int first_type, int end_type) {
    for (int type = first_type; type < end_type; ++type) {
        for (uint32_t i = 0; i < count; ++i) {
            if (infos[i].usable && !strcmp(infos[i].type, TYPES[type])) return (int)i;
        }
    }
    return -1;
}

static int lower(char c) { return tolower((unsigned char)c); }

static bool contains(const char *text, const char *part) {
    for (; *text; ++text) {
        size_t length = 0;
        while (part[length] && lower(text[length]) == lower(part[length])) ++length;
        if (!part[length]) return true;
    }
    return false;
}

// Whether `uuid` begins with the hexadecimal digits of `prefix`, of which there must be one; dashes do not count.
static bool uuid_begins(const char *uuid, const char *prefix) {
    size_t digits = 0;
    for (; *prefix; ++prefix) {
        if (*prefix == '-') continue;
        if (*uuid == '-') ++uuid;
        if (lower(*prefix) != lower(*uuid)) return false;
        ++uuid;
        ++digits;
    }
    return digits > 0;
}

static bool is_number(const char *text) { return text[strspn(text, "0123456789")] == 0; }

static int find_number(uint32_t count, const char *text) {
    const unsigned long number = strtoul(text, NULL, 10);
    return number < count ? (int)number : -1;
}

// The first match that is usable, else the first match.
static int find_text(const struct gn_device_info *infos, uint32_t count, const char *selector) {
    const bool by_uuid = !strncmp(selector, "uuid:", 5);
    int first = -1;
    for (uint32_t i = 0; i < count; ++i) {
        if (!(by_uuid ? uuid_begins(infos[i].uuid, selector + 5) : contains(infos[i].name, selector))) continue;
        if (infos[i].usable) return (int)i;
        if (first < 0) first = (int)i;
    }
    return first;
}

int device_select(const struct gn_device_info *infos, uint32_t count, const char *selector) {
    if (!selector || !*selector) return find_type(infos, count, 0, TYPE_COUNT);
    if (!strcmp(selector, "gpu")) return find_type(infos, count, 0, FIRST_CPU);
    if (!strcmp(selector, "cpu")) return find_type(infos, count, FIRST_CPU, FIRST_CPU + 1);
    if (is_number(selector)) return find_number(count, selector);
    return find_text(infos, count, selector);
}
