// Images in memory, as PNG, JPEG, Radiance and PFM.
#include "image_fixture.h"

#include <math.h>
#include <spng.h>
#include <turbojpeg.h>

// ---- memory

static void too_large_is_refused(void **state) {
    (void)state;
    struct image image;
    scratch_assert_fails(image_init(&image, scratch_context(), UINT32_MAX, UINT32_MAX, 3, "the film"), GN_LIMIT, "no memory for the film");
    assert_null(image.pixels);
    image_finish(&image);
    scratch_assert(image_init(&image, scratch_context(), 2, 3, 4, "a test"));
    for (int i = 0; i < 24; i++) assert_true(image.pixels[i] == 0);
    image_finish(&image);
    image_finish(&image);
    assert_int_equal(image.width, 0);
}

static void writers_refuse_what_they_cannot_hold(void **state) {
    (void)state;
    static const struct { uint32_t width, height, channels; } cases[] = {{0, 1, 3}, {1, 0, 3}, {1, 1, 2}, {1, 1, 4}, {1, 1, 0}};
    scratch_count(true);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct image image = noise_image(cases[i].width, cases[i].height, cases[i].channels);
        scratch_assert_fails(image_write_png(&image, scratch_context(), scratch_path("a.png"), TRANSFER_SRGB), GN_INTERNAL, "cannot hold");
        scratch_assert_fails(image_write_pfm(&image, scratch_context(), scratch_path("a.pfm")), GN_INTERNAL, "cannot hold");
        image_finish(&image);
    }
    assert_int_equal(scratch_count(false), 0);
}

static void failed_writes_leave_nothing(void **state) {
    (void)state;
    struct image image = noise_image(64, 64, 3);
    scratch_count(true);
    scratch_assert_fails(image_write_png(&image, scratch_context(), "/dev/full", TRANSFER_SRGB), GN_IO,
                         "/dev/full: cannot be written: No space left");
    scratch_assert_fails(image_write_pfm(&image, scratch_context(), "/dev/full"), GN_IO, "/dev/full: cannot be written: No space left");
    scratch_assert_fails(image_write_png(&image, scratch_context(), "/no/a.png", TRANSFER_SRGB), GN_IO,
                         "/no/a.png: cannot be written: its folder");
    scratch_assert_fails(image_write_pfm(&image, scratch_context(), "/no/a.pfm"), GN_IO, "/no/a.pfm: cannot be written: its folder");
    assert_int_equal(scratch_count(false), 0);
    image_finish(&image);
}

// ---- PNG

static void png_comes_back(void **state) {
    (void)state;
    static const struct {
        uint32_t width, height, channels;
        enum transfer transfer;
    } cases[] = {
        {1, 1, 3, TRANSFER_SRGB},     {1, 1, 1, TRANSFER_SRGB},     {17, 5, 3, TRANSFER_SRGB},  {5, 17, 1, TRANSFER_SRGB},
        {300, 200, 3, TRANSFER_SRGB}, {1, 500, 3, TRANSFER_LINEAR}, {7, 3, 3, TRANSFER_LINEAR}, {7, 3, 1, TRANSFER_LINEAR},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct image image = noise_image(cases[i].width, cases[i].height, cases[i].channels), back;
        uint32_t channels = cases[i].channels;
        enum transfer transfer = cases[i].transfer;
        scratch_assert(image_write_png(&image, scratch_context(), scratch_path("a.png"), transfer));
        scratch_assert(image_read(&back, scratch_context(), scratch_path("a.png")));
        assert_int_equal(back.width, image.width);
        assert_int_equal(back.height, image.height);
        assert_int_equal(back.channels, 3);
        for (size_t p = 0; p < (size_t)image.width * image.height; p++)
            for (size_t c = 0; c < 3; c++) {
                float value = image.pixels[p * channels + (channels == 3 ? c : 0)];
                assert_true(back.pixels[3 * p + c] == transfer_decode(transfer, transfer_encode(transfer, value)));
            }
        image_finish(&image);
        image_finish(&back);
    }
}

// A PNG file as others write it: 8 samples of the bit depth, packed into `pixels`, 2 × (8 / channels / 2) pixels.
struct foreign_png {
    const char *what;
    uint32_t width, height;
    uint8_t bit_depth, color_type, interlace;
    uint32_t gamma; // 100000 times; 0 for none
    unsigned char pixels[16];
    size_t size;
    uint8_t transparent;  // with tRNS
    uint16_t expected[6]; // the first two pixels' codes, out of `full`
    double full;
    enum transfer transfer;
};

static const char *write_foreign(const struct foreign_png *p) {
    spng_ctx *png = spng_ctx_new(SPNG_CTX_ENCODER);
    assert_non_null(png);
    struct spng_ihdr ihdr = {p->width, p->height, p->bit_depth, p->color_type, 0, 0, p->interlace};
    struct spng_plte palette = {.n_entries = 4, .entries = {{1, 2, 3, 0}, {10, 20, 30, 0}, {100, 110, 120, 0}, {255, 254, 253, 0}}};
    struct spng_trns transparency = {.n_type3_entries = 1};
    size_t size;
    int error;
    assert_int_equal(spng_set_option(png, SPNG_ENCODE_TO_BUFFER, 1), 0);
    assert_int_equal(spng_set_ihdr(png, &ihdr), 0);
    if (p->color_type == SPNG_COLOR_TYPE_INDEXED) assert_int_equal(spng_set_plte(png, &palette), 0);
    if (p->transparent) assert_int_equal(spng_set_trns(png, &transparency), 0);
    if (p->gamma) assert_int_equal(spng_set_gama_int(png, p->gamma), 0);
    assert_int_equal(spng_encode_image(png, p->pixels, p->size, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE), 0);
    void *bytes = spng_get_png_buffer(png, &size, &error);
    assert_non_null(bytes);
    const char *path = scratch_file("foreign.png", bytes, size);
    free(bytes);
    spng_ctx_free(png);
    return path;
}

static const struct foreign_png FOREIGN[] = {
    {"grey 8", 2, 1, 8, 0, 0, 0, {10, 200}, 2, 0, {10, 10, 10, 200, 200, 200}, 255, TRANSFER_SRGB},
    {"grey 1", 2, 1, 1, 0, 0, 0, {0x40}, 1, 0, {0, 0, 0, 255, 255, 255}, 255, TRANSFER_SRGB},
    {"grey 2", 2, 1, 2, 0, 0, 0, {0x60}, 1, 0, {85, 85, 85, 170, 170, 170}, 255, TRANSFER_SRGB},
    {"grey 4", 2, 1, 4, 0, 0, 0, {0x3f}, 1, 0, {51, 51, 51, 255, 255, 255}, 255, TRANSFER_SRGB},
    {"grey 16", 2, 1, 16, 0, 0, 0, {0x34, 0x12, 0xff, 0xff}, 4, 0, {0x1234, 0x1234, 0x1234, 65535, 65535, 65535}, 65535, TRANSFER_SRGB},
    {"grey alpha 8", 2, 1, 8, 4, 0, 0, {10, 0, 200, 255}, 4, 0, {10, 10, 10, 200, 200, 200}, 255, TRANSFER_SRGB},
    {"grey alpha 16", 2, 1, 16, 4, 0, 0, {1, 2, 0, 0, 3, 4, 0, 1}, 8, 0, {513, 513, 513, 1027, 1027, 1027}, 65535, TRANSFER_SRGB},
    {"rgb 8", 2, 1, 8, 2, 0, 0, {1, 2, 3, 4, 5, 6}, 6, 0, {1, 2, 3, 4, 5, 6}, 255, TRANSFER_SRGB},
    {"rgb 8 with a colour transparent", 2, 1, 8, 2, 0, 0, {0, 0, 0, 4, 5, 6}, 6, 1, {0, 0, 0, 4, 5, 6}, 255, TRANSFER_SRGB},
    {"rgb 16", 2, 1, 16, 2, 0, 0, {1, 0, 2, 0, 3, 0, 0, 1, 0, 2, 0, 3}, 12, 0, {1, 2, 3, 256, 512, 768}, 65535, TRANSFER_SRGB},
    {"rgba 8", 2, 1, 8, 6, 0, 0, {1, 2, 3, 0, 4, 5, 6, 255}, 8, 0, {1, 2, 3, 4, 5, 6}, 255, TRANSFER_SRGB},
    {"rgba 16", 2, 1, 16, 6, 0, 0, {1, 0, 2, 0, 3, 0, 0, 0, 4, 0, 5, 0, 6, 0, 9, 9}, 16, 0, {1, 2, 3, 4, 5, 6}, 65535, TRANSFER_SRGB},
    {"palette 8", 2, 1, 8, 3, 0, 0, {3, 1}, 2, 0, {255, 254, 253, 10, 20, 30}, 255, TRANSFER_SRGB},
    {"palette 2", 2, 1, 2, 3, 0, 0, {0x20}, 1, 0, {1, 2, 3, 100, 110, 120}, 255, TRANSFER_SRGB},
    {"palette with an entry transparent", 2, 1, 8, 3, 0, 0, {0, 1}, 2, 1, {1, 2, 3, 10, 20, 30}, 255, TRANSFER_SRGB},
    {"interlaced", 2, 2, 8, 2, 1, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 12, 0, {1, 2, 3, 4, 5, 6}, 255, TRANSFER_SRGB},
    {"linear", 2, 1, 8, 2, 0, 100000, {1, 2, 3, 4, 5, 6}, 6, 0, {1, 2, 3, 4, 5, 6}, 255, TRANSFER_LINEAR},
    {"linear 16",
     2,
     1,
     16,
     0,
     0,
     100000,
     {0x34, 0x12, 0xff, 0xff},
     4,
     0,
     {0x1234, 0x1234, 0x1234, 65535, 65535, 65535},
     65535,
     TRANSFER_LINEAR},
    {"gamma 1/2.2", 2, 1, 8, 2, 0, 45455, {1, 2, 3, 4, 5, 6}, 6, 0, {1, 2, 3, 4, 5, 6}, 255, TRANSFER_SRGB},
};

static void png_of_others_is_read(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof FOREIGN / sizeof *FOREIGN; i++) {
        const struct foreign_png *p = &FOREIGN[i];
        struct image image;
        scratch_assert(image_read(&image, scratch_context(), write_foreign(p)));
        assert_int_equal(image.width, p->width);
        assert_int_equal(image.height, p->height);
        for (int k = 0; k < 6; k++) {
            double encoded = p->expected[k] / p->full, linear = p->transfer == TRANSFER_LINEAR ? encoded : srgb_decode(encoded);
            if (!(fabs((double)image.pixels[k] - linear) <= 1e-7 * linear))
                fail_msg("%s: sample %d is %.9g, expected %.9g", p->what, k, (double)image.pixels[k], linear);
        }
        image_finish(&image);
    }
}

static void damaged_png_does_no_harm(void **state) {
    (void)state;
    struct image image = noise_image(6, 5, 3);
    scratch_assert(image_write_png(&image, scratch_context(), scratch_path("a.png"), TRANSFER_SRGB));
    assert_in_range(damage_file(scratch_path("a.png"), 1, 1500), 1000, 1500);
    for (size_t i = 0; i < sizeof FOREIGN / sizeof *FOREIGN; i++) damage_file(write_foreign(&FOREIGN[i]), (uint32_t)i * 10000, 100);
    image_finish(&image);
}

// The CRC of a chunk (PNG specification, annex D).
static uint32_t crc_of(const unsigned char *bytes, size_t size) {
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return ~crc;
}

static void store_big_endian(unsigned char *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> (24 - 8 * i));
}

static void png_that_claims_too_much_is_refused(void **state) {
    (void)state;
    static const struct {
        uint32_t width, height;
        const char *message;
    } cases[] = {
        {2147483647, 2147483647, "is not a valid PNG file: "},
        {65536, 65536, "announces 65536 × 65536 pixels"},
        {16384, 16384, "which cannot be in a file of"},
        {0, 5, "is not a valid PNG file: "},
        {6, 6, "is not a valid PNG file: "},
    };
    struct image image = noise_image(6, 5, 3);
    struct file_bytes bytes;
    scratch_assert(image_write_png(&image, scratch_context(), scratch_path("a.png"), TRANSFER_SRGB));
    scratch_assert(file_read(&bytes, scratch_context(), scratch_path("a.png"), GN_IO));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char *header = (unsigned char *)bytes.data;
        store_big_endian(header + 16, cases[i].width);
        store_big_endian(header + 20, cases[i].height);
        store_big_endian(header + 29, crc_of(header + 12, 17));
        assert_read_fails(scratch_file("big.png", bytes.data, bytes.size), cases[i].message);
    }
    file_bytes_finish(&bytes);
    image_finish(&image);
}

// ---- PFM

static void pfm_comes_back(void **state) {
    (void)state;
    static const struct { uint32_t width, height, channels; } cases[] = {{1, 1, 3}, {1, 1, 1}, {17, 5, 3}, {5, 17, 1}};
    const float odd[] = {INFINITY, -INFINITY, NAN, -0.0f, 0x1p-149f, -1e30f};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct image image = noise_image(cases[i].width, cases[i].height, cases[i].channels), back;
        for (size_t k = 0; k < 6 && i >= 2; k++) image.pixels[k] = odd[k];
        scratch_assert(image_write_pfm(&image, scratch_context(), scratch_path("a.pfm")));
        scratch_assert(image_read(&back, scratch_context(), scratch_path("a.pfm")));
        assert_int_equal(back.width, image.width);
        assert_int_equal(back.height, image.height);
        for (size_t k = 0; k < (size_t)image.width * image.height * 3; k++)
            assert_memory_equal(&back.pixels[k], &image.pixels[image.channels == 3 ? k : k / 3], sizeof(float));
        image_finish(&image);
        image_finish(&back);
    }
}

static void pfm_is_written_as_the_format_says(void **state) {
    (void)state;
    float pixels[] = {1, 2, 3, 4, 5, 6}, expected[] = {4, 5, 6, 1, 2, 3}; // the lowest row first
    struct image image = {.width = 1, .height = 2, .channels = 3, .pixels = pixels};
    struct file_bytes bytes;
    scratch_assert(image_write_pfm(&image, scratch_context(), scratch_path("a.pfm")));
    scratch_assert(file_read(&bytes, scratch_context(), scratch_path("a.pfm"), GN_IO));
    assert_int_equal(bytes.size, 12 + sizeof expected);
    assert_memory_equal(bytes.data, "PF\n1 2\n-1.0\n", 12);
    assert_memory_equal(bytes.data + 12, expected, sizeof expected);
    file_bytes_finish(&bytes);
}

// A header and then the two floats 1 and 2 in both byte orders.
static void pfm_of_others_is_read(void **state) {
    (void)state;
#define LITTLE "\x00\x00\x80\x3f\x00\x00\x00\x40"
#define BIG "\x3f\x80\x00\x00\x40\x00\x00\x00"
    static const struct {
        const char *header, *data;
    } cases[] = {
        {"Pf\n1 2\n-1.0\n", LITTLE},
        {"Pf\n1 2\n1.0\n", BIG},
        {"Pf 1 2 1 ", BIG},
        {"Pf\r\n1\t2\r\n-1\n", LITTLE},
        {"Pf\n1 2\n+1e-3\n", BIG},
        {"Pf\n1 2\n-0.5\n", LITTLE},
        {"Pf\n1 2\n-100E+2\n", LITTLE},
        {"Pf\n\n 1 \n 2 \n\n-.1\n", LITTLE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char bytes[64];
        size_t header = strlen(cases[i].header);
        memcpy(bytes, cases[i].header, header);
        memcpy(bytes + header, cases[i].data, 8);
        struct image image;
        scratch_assert(image_read(&image, scratch_context(), scratch_file("a.pfm", bytes, header + 8)));
        assert_int_equal(image.width, 1);
        assert_int_equal(image.height, 2);
        for (int c = 0; c < 3; c++) assert_true(image.pixels[c] == 2 && image.pixels[3 + c] == 1);
        image_finish(&image);
    }
}

static void malformed_pfm_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *bytes, *message;
    } cases[] = {
        {"PF", "malformed PFM header"},
        {"PF\n", "malformed PFM header"},
        {"PG\n1 1\n-1\n", "is neither PNG, OpenEXR, JPEG, Radiance (.hdr) nor PFM"},
        {"PFx\n1 1\n-1\n", "malformed PFM header"},
        {"PF\n1\n", "malformed PFM header"},
        {"PF\n1 1 -1", "malformed PFM header"},
        {"PF\n-1 1\n-1\n", "malformed PFM header"},
        {"PF\n1.5 1\n-1\n", "malformed PFM header"},
        {"PF\n1 x\n-1\n", "malformed PFM header"},
        {"PF\n1 1\n0\n", "malformed PFM header"},
        {"PF\n1 1\n-0.00\n", "malformed PFM header"},
        {"PF\n1 1\nnan\n", "malformed PFM header"},
        {"PF\n1 1\n-\n", "malformed PFM header"},
        {"PF\n1 1\n-1x\n", "malformed PFM header"},
        {"PF\n11111111111111111111111111111111111111111111 1\n-1\n", "malformed PFM header"},
        {"PF\n0 1\n-1\n", "announces an empty image"},
        {"PF\n999999999 999999999\n-1\n", "announces 999999999 × 999999999 pixels; the limit is"},
        {"PF\n4294967297 1\n-1\n", "malformed PFM header"},
        {"PF\n16000 16000\n-1\n", "which cannot be in a file of 18 bytes"},
        {"PF\n1 1\n-1\n123456789012", NULL},
        {"PF\n1 1\n-1\n12345678901", "has 11 bytes of pixels where 1 × 1 pixels of 3 channels need 12"},
        {"PF\n1 1\n-1\n1234567890123", "has 13 bytes of pixels where"},
        {"Pf\n1 1\n-1\n123456789012", "has 12 bytes of pixels where 1 × 1 pixels of 1 channels need 4"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *path = scratch_file("a.pfm", cases[i].bytes, strlen(cases[i].bytes));
        struct image image;
        if (cases[i].message)
            assert_read_fails(path, cases[i].message);
        else
            scratch_assert(image_read(&image, scratch_context(), path));
        if (!cases[i].message) image_finish(&image);
    }
}

static void damaged_pfm_does_no_harm(void **state) {
    (void)state;
    struct image image = noise_image(3, 2, 3);
    scratch_assert(image_write_pfm(&image, scratch_context(), scratch_path("a.pfm")));
    assert_in_range(damage_file(scratch_path("a.pfm"), 1, 1500), 100, 1499);
    image_finish(&image);
}

// ---- Radiance

#define HDR_HEAD "#?RADIANCE\n# by hand\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n"

// Row 0 of 8 pixels in the newer code: red 128 everywhere, green 0 … 7, blue 5 runs and single ones, exponent 129: values m/128.
#define HDR_ROW "\x02\x02\x00\x08\x88\x80\x08\x00\x01\x02\x03\x04\x05\x06\x07\x85\x40\x03\x01\x02\x03\x88\x81"

static void hdr_is_read(void **state) {
    (void)state;
    static const struct {
        const char *size, *row;
        size_t row_size;
        uint32_t width, height, x, y;
        float red, green, blue;
    } cases[] = {
        {"-Y 1 +X 8\n", HDR_ROW, sizeof HDR_ROW - 1, 8, 1, 6, 0, 1, 6 / 128.0f, 2 / 128.0f},
        {"-Y 1 +X 8\r\n", HDR_ROW, sizeof HDR_ROW - 1, 8, 1, 4, 0, 1, 4 / 128.0f, 0.5f},
        {"-Y 1 -X 8\n", HDR_ROW, sizeof HDR_ROW - 1, 8, 1, 1, 0, 1, 6 / 128.0f, 2 / 128.0f},
        // without code, 3 pixels; the last is 0
        {"-Y 1 +X 3\n", "\x80\x40\x01\x88\x01\x02\x03\x81\x09\x09\x09\x00", 12, 3, 1, 0, 0, 128, 64, 1},
        {"-Y 1 +X 3\n", "\x80\x40\x01\x88\x01\x02\x03\x81\x09\x09\x09\x00", 12, 3, 1, 2, 0, 0, 0, 0},
        {"-Y 3 +X 1\n", "\x80\x40\x01\x88\x01\x02\x03\x81\x09\x09\x09\x00", 12, 1, 3, 0, 0, 128, 64, 1},
        {"+Y 3 +X 1\n", "\x80\x40\x01\x88\x01\x02\x03\x81\x09\x09\x09\x00", 12, 1, 3, 0, 2, 128, 64, 1},
        // the older code: one pixel, then as many as 2 + 1 · 256 more of it
        {"-Y 1 +X 259\n", "\x80\x40\x20\x81\x01\x01\x01\x02\x01\x01\x01\x01", 12, 259, 1, 258, 0, 1, 0.5f, 0.25f},
        // the largest and the smallest values
        {"-Y 1 +X 1\n", "\xff\x01\x00\xff", 4, 1, 1, 0, 0, 0xffp119f, 0x1p119f, 0},
        {"-Y 1 +X 1\n", "\xff\x01\x00\x01", 4, 1, 1, 0, 0, 0xffp-135f, 0x1p-135f, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char bytes[256] = HDR_HEAD;
        struct image image;
        strcat(bytes, cases[i].size);
        const size_t size = strlen(bytes);
        memcpy(bytes + size, cases[i].row, cases[i].row_size);
        scratch_assert(image_read(&image, scratch_context(), scratch_file("a.hdr", bytes, size + cases[i].row_size)));
        const float *p = image.pixels + 3 * (cases[i].y * cases[i].width + cases[i].x);
        if (image.width != cases[i].width || image.height != cases[i].height || p[0] != cases[i].red || p[1] != cases[i].green ||
            p[2] != cases[i].blue)
            fail_msg("case %zu: %u × %u, (%g, %g, %g)", i, image.width, image.height, (double)p[0], (double)p[1], (double)p[2]);
        image_finish(&image);
    }
}

static void malformed_hdr_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *bytes, *message;
    } cases[] = {
        {"#?", "its header has no end"},
        {"#?RADIANCE\n\n", "its size is not given as in"},
        {"#?RADIANCE\n\n+X 1 -Y 1\n", "its size is not given as in"},
        {"#?RADIANCE\n\n-Y 1 +X 1 x\n", "its size is not given as in"},
        {"#?RADIANCE\n\n-Y 0 +X 1\n", "announces an empty image"},
        {"#?RADIANCE\n\n-Y -1 +X 1\n", "the limit is 65536 on a side"},
        {"#?RADIANCE\n\n-Y 65536 +X 65536\n", "the limit is 65536 on a side"},
        {"#?RADIANCE\n\n-Y 16384 +X 16384\n", "which cannot be in a file of"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "in another FORMAT than 32-bit_rle_rgbe"},
        {"#?RADIANCE\n\n-Y 1 +X 1\nabc", "it ends early, or its rows are damaged"},
        {"#?RADIANCE\n\n-Y 1 +X 2\n\1\1\1\2", "it ends early, or its rows are damaged"},     // nothing to repeat
        {"#?RADIANCE\n\n-Y 1 +X 2\nabcd\1\1\1\2", "it ends early, or its rows are damaged"}, // too often
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_read_fails(scratch_file("a.hdr", cases[i].bytes, strlen(cases[i].bytes)), cases[i].message);
}

static void damaged_hdr_does_no_harm(void **state) {
    (void)state;
    static const char bytes[] = HDR_HEAD "-Y 2 +X 8\n" HDR_ROW HDR_ROW;
    assert_in_range(damage_file(scratch_file("a.hdr", bytes, sizeof bytes - 1), 1, 1500), 100, 1499);
}

// ---- JPEG

// A picture in one colour, or a grey ramp, as libjpeg-turbo writes it.
static const char *write_jpeg(bool grey, int subsampling, int flags) {
    enum { SIDE = 32 };
    unsigned char pixels[3 * SIDE * SIDE], *bytes = NULL;
    unsigned long size = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) pixels[i] = (unsigned char)(grey ? 8 * (i % SIDE) : i % 3 == 0 ? 200 : i % 3 == 1 ? 100 : 20);
    tjhandle jpeg = tjInitCompress();
    assert_non_null(jpeg);
    assert_int_equal(tjCompress2(jpeg, pixels, SIDE, 0, SIDE, grey ? TJPF_GRAY : TJPF_RGB, &bytes, &size, subsampling, 100, flags), 0);
    const char *path = scratch_file("a.jpg", bytes, size);
    tjFree(bytes);
    tjDestroy(jpeg);
    return path;
}

static void jpeg_is_read(void **state) {
    (void)state;
    static const int subsamplings[] = {TJSAMP_444, TJSAMP_420, TJSAMP_GRAY};
    for (int i = 0; i < 6; i++) {
        struct image image;
        const bool grey = subsamplings[i / 2] == TJSAMP_GRAY;
        scratch_assert(image_read(&image, scratch_context(), write_jpeg(grey, subsamplings[i / 2], i % 2 ? TJFLAG_PROGRESSIVE : 0)));
        assert_int_equal(image.width, 32);
        for (size_t p = 0; p < 32 * 32; p++)
            for (size_t c = 0; c < 3; c++) {
                const int code = grey ? 8 * (int)(p % 32) : c == 0 ? 200 : c == 1 ? 100 : 20;
                assert_in_range(transfer_encode(TRANSFER_SRGB, image.pixels[3 * p + c]), code > 2 ? code - 2 : 0, code + 2);
            }
        image_finish(&image);
    }
}

static void damaged_jpeg_does_no_harm(void **state) {
    (void)state;
    for (int progressive = 0; progressive < 2; progressive++) {
        char path[512];
        snprintf(path, sizeof path, "%s", write_jpeg(false, TJSAMP_420, progressive ? TJFLAG_PROGRESSIVE : 0));
        assert_in_range(damage_file(path, 1, 1000), 100, 999);
    }
}

// ---- codes

static void codes_are_those_of_the_file(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof FOREIGN / sizeof *FOREIGN; i++) {
        struct file_bytes bytes;
        struct codes codes;
        if (FOREIGN[i].width != 2) continue;
        const char *path = write_foreign(&FOREIGN[i]);
        scratch_assert(file_read(&bytes, scratch_context(), path, GN_IO));
        scratch_assert(codes_decode(&codes, scratch_context(), path, &bytes, TRANSFER_LINEAR));
        for (int k = 0; k < 6; k++) {
            const double expected = FOREIGN[i].expected[k] * 255.0 / FOREIGN[i].full, code = codes.pixels[k + k / 3];
            if (!(fabs(code - expected) <= 1)) fail_msg("%s, code %d: %g, expected %g", FOREIGN[i].what, k, code, expected);
        }
        const bool alpha = FOREIGN[i].color_type & 4;
        if (codes.pixels[3] != (alpha || FOREIGN[i].transparent ? 0 : 255)) fail_msg("%s: alpha %d", FOREIGN[i].what, codes.pixels[3]);
        if (!alpha) assert_int_equal(codes.pixels[7], 255);
        codes_finish(&codes);
        file_bytes_finish(&bytes);
    }
}

static void linear_values_become_codes(void **state) {
    (void)state;
    static const char bytes[] = HDR_HEAD "-Y 1 +X 1\n\x40\xff\x00\x81"; // 0.5, 1.99, 0
    const struct file_bytes file = {.data = (char *)bytes, .size = sizeof bytes - 1};
    for (int transfer = 0; transfer < 2; transfer++) {
        struct codes codes;
        scratch_assert(codes_decode(&codes, scratch_context(), "a.hdr", &file, (enum transfer)transfer));
        const uint8_t expected[4] = {transfer == TRANSFER_SRGB ? 188 : 128, 255, 0, 255};
        assert_memory_equal(codes.pixels, expected, 4);
        codes_finish(&codes);
    }
}

static void other_files_are_refused(void **state) {
    (void)state;
    assert_read_fails(scratch_file("empty", "", 0), "is neither PNG, OpenEXR, JPEG, Radiance (.hdr) nor PFM (0 bytes)");
    assert_read_fails(scratch_file("text", "hello", 5), "is neither PNG, OpenEXR, JPEG, Radiance (.hdr) nor PFM (5 bytes)");
    assert_read_fails("/nowhere/a.png", "cannot be opened: No such file");
    assert_read_fails("/tmp", "is a directory");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(too_large_is_refused),
        cmocka_unit_test(writers_refuse_what_they_cannot_hold),
        cmocka_unit_test(failed_writes_leave_nothing),
        cmocka_unit_test(png_comes_back),
        cmocka_unit_test(png_of_others_is_read),
        cmocka_unit_test(damaged_png_does_no_harm),
        cmocka_unit_test(png_that_claims_too_much_is_refused),
        cmocka_unit_test(pfm_comes_back),
        cmocka_unit_test(pfm_is_written_as_the_format_says),
        cmocka_unit_test(pfm_of_others_is_read),
        cmocka_unit_test(malformed_pfm_is_refused),
        cmocka_unit_test(damaged_pfm_does_no_harm),
        cmocka_unit_test(hdr_is_read),
        cmocka_unit_test(malformed_hdr_is_refused),
        cmocka_unit_test(damaged_hdr_does_no_harm),
        cmocka_unit_test(jpeg_is_read),
        cmocka_unit_test(damaged_jpeg_does_no_harm),
        cmocka_unit_test(codes_are_those_of_the_file),
        cmocka_unit_test(linear_values_become_codes),
        cmocka_unit_test(other_files_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
