// Nested dielectrics: a list that is searched, where the shader keeps a sorted one.
#include "reference/dielectric.h"

static bool is_above(struct ref_medium a, struct ref_medium b) {
    return a.priority != b.priority ? a.priority > b.priority : a.number > b.number;
}

// Where the highest (sign 1) or the lowest (-1) entry is; count must not be 0.
static uint32_t find_end(const struct ref_media *media, int sign) {
    uint32_t end = 0;
    for (uint32_t i = 1; i < media->count; i++) {
        bool above = is_above(media->entries[i], media->entries[end]);
        if (sign > 0 ? above : is_above(media->entries[end], media->entries[i])) end = i;
    }
    return end;
}

static struct ref_medium top_of(const struct ref_media *media) {
    return media->count ? media->entries[find_end(media, 1)] : (struct ref_medium){0, 0};
}

static void enter(struct ref_media *media, struct ref_medium medium) {
    if (media->count < REF_MEDIA) {
        media->entries[media->count++] = medium;
        return;
    }
    struct ref_medium *lowest = &media->entries[find_end(media, -1)];
    if (is_above(medium, *lowest)) *lowest = medium;
}

static void leave(struct ref_media *media, struct ref_medium medium) {
    for (uint32_t i = media->count; i-- > 0;) {
        if (media->entries[i].number != medium.number) continue;
        media->entries[i] = media->entries[--media->count];
        return;
    }
}

struct ref_media_change ref_media_cross(const struct ref_media *media, uint32_t material, uint32_t priority, bool entering) {
    const struct ref_medium medium = {priority, material + 1};
    struct ref_media_change change = {.after = *media};
    if (!entering) leave(&change.after, medium);
    const struct ref_medium other = top_of(&change.after);
    if (entering) enter(&change.after, medium);
    change.counts = is_above(medium, other);
    change.here = entering ? other.number : medium.number;
    change.beyond = entering ? medium.number : other.number;
    return change;
}

uint32_t ref_media_top(const struct ref_media *media) { return top_of(media).number; }
