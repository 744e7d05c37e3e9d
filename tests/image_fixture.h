// What the tests of image formats share: images to write, and files damaged in every way.
#ifndef TESTS_IMAGE_FIXTURE_H
#define TESTS_IMAGE_FIXTURE_H

#include "scratch.h"

#include "base/image.h"

// A number of 0…1 for each counter.
static inline float noise(uint32_t counter) {
    counter = counter * 747796405u + 2891336453u;
    counter ^= counter >> 15;
    counter *= 2654435761u;
    return (float)(counter >> 8) * 0x1p-24f;
}

static inline struct image noise_image(uint32_t width, uint32_t height, uint32_t channels) {
    struct image image;
    scratch_assert(image_init(&image, scratch_context(), width, height, channels, "a test"));
    for (uint32_t i = 0; i < width * height * channels; i++) image.pixels[i] = noise(i);
    return image;
}

static inline void assert_read_fails(const char *path, const char *message) {
    struct image image;
    scratch_assert_fails(image_read(&image, scratch_context(), path), GN_IO, message);
    assert_non_null(strstr(scratch_state()->error.message, path));
    assert_null(image.pixels);
}

// A file cut somewhere is refused; one with changed bytes is refused or gives some image, but does no harm. Returns how many were refused.
static inline int damage_file(const char *path, uint32_t seed, int changes) {
    struct file_bytes bytes;
    struct image image;
    int refused = 0;
    scratch_assert(file_read(&bytes, scratch_context(), path, GN_IO));
    // Large files at every few bytes only, but everywhere near the end.
    for (size_t size = 0; size < bytes.size; size += size + 40 < bytes.size ? 1 + bytes.size / 500 : 1)
        assert_read_fails(scratch_file("cut", bytes.data, size), "cut");
    for (int i = 0; i < changes; i++) {
        char before[3];
        size_t at[3];
        for (int k = 0; k < 3; k++) { // one change to three
            uint32_t random = (uint32_t)(noise(seed++) * 0x1p24f);
            at[k] = k > 0 && i % (k + 1) ? at[0] : random % bytes.size;
            before[k] = bytes.data[at[k]];
            bytes.data[at[k]] = (char)(random >> 16);
        }
        const char *changed = scratch_file("changed", bytes.data, bytes.size);
        struct codes codes;
        (void)codes_decode(&codes, scratch_context(), changed, &bytes, TRANSFER_SRGB);
        codes_finish(&codes);
        for (int k = 3; k-- > 0;) bytes.data[at[k]] = before[k];
        if (image_read(&image, scratch_context(), changed)) {
            image_finish(&image);
            continue;
        }
        refused++;
        assert_true(scratch_state()->error.status == GN_IO || scratch_state()->error.status == GN_LIMIT);
        assert_null(image.pixels);
    }
    file_bytes_finish(&bytes);
    return refused;
}

#endif
