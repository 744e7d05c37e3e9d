// Images as OpenEXR: what we write, what others write, and what nobody should.
#include "image_fixture.h"

#include <math.h>
#include <openexr.h>

// The initializers of OpenEXR 3.3 name the first fields only.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

static void layers_come_back(void **state) {
    (void)state;
    static const struct { uint32_t width, height; } cases[] = {{1, 1}, {17, 5}, {3, 40}, {100, 33}};
    const float odd[] = {INFINITY, -INFINITY, NAN, -0.0f, 0x1p-149f, -1e30f};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct image colour = noise_image(cases[i].width, cases[i].height, 3), depth = noise_image(cases[i].width, cases[i].height, 1),
                     back;
        struct image normal = noise_image(cases[i].width, cases[i].height, 3), id = noise_image(cases[i].width, cases[i].height, 2);
        for (size_t k = 0; k < 6 && i > 0; k++) colour.pixels[k] = odd[k];
        const struct image_layer layers[] = {{&colour, {"R", "G", "B"}},
                                             {&depth, {"Z"}},
                                             {&normal, {"normal.X", "normal.Y", "normal.Z"}},
                                             {&id, {"id.object", "id.primitive"}}};
        const char *path = scratch_path("a.exr");
        scratch_assert(image_write_exr(layers, 4, scratch_context(), path));
        scratch_assert(image_read(&back, scratch_context(), path));
        assert_int_equal(back.width, colour.width);
        assert_int_equal(back.height, colour.height);
        assert_memory_equal(back.pixels, colour.pixels, (size_t)colour.width * colour.height * 3 * sizeof(float));
        image_finish(&back);
        // The other layers come back when they are called R, G and B.
        const struct image_layer renamed[] = {{&colour, {"x", "y", "z"}}, {&normal, {"R", "G", "B"}}};
        scratch_assert(image_write_exr(renamed, 2, scratch_context(), path));
        scratch_assert(image_read(&back, scratch_context(), path));
        assert_memory_equal(back.pixels, normal.pixels, (size_t)colour.width * colour.height * 3 * sizeof(float));
        image_finish(&back);
        const struct image_layer grey = {&depth, {"Y"}};
        scratch_assert(image_write_exr(&grey, 1, scratch_context(), path));
        scratch_assert(image_read(&back, scratch_context(), path));
        for (size_t k = 0; k < (size_t)depth.width * depth.height * 3; k++) assert_true(back.pixels[k] == depth.pixels[k / 3]);
        image_finish(&back);
        image_finish(&colour);
        image_finish(&depth);
        image_finish(&normal);
        image_finish(&id);
    }
}

static void wrong_layers_are_refused(void **state) {
    (void)state;
    struct image image = noise_image(4, 4, 3), other = noise_image(4, 5, 3), empty = {0};
    const struct image_layer layers[] = {{&image, {"R", "G", "B"}}, {&other, {"x", "y", "z"}}, {&image, {"R", "G"}}, {&empty, {"R"}}};
    scratch_count(true);
    scratch_assert_fails(image_write_exr(layers, 2, scratch_context(), scratch_path("a.exr")), GN_INTERNAL, "of one size");
    scratch_assert_fails(image_write_exr(layers + 2, 1, scratch_context(), scratch_path("a.exr")), GN_INTERNAL, "have names");
    scratch_assert_fails(image_write_exr(layers + 3, 1, scratch_context(), scratch_path("a.exr")), GN_INTERNAL, "of one size");
    scratch_assert_fails(image_write_exr(layers, 0, scratch_context(), scratch_path("a.exr")), GN_INTERNAL, "of one size");
    const struct image_layer twice[] = {layers[0], layers[0]};
    scratch_assert_fails(image_write_exr(twice, 2, scratch_context(), scratch_path("a.exr")), GN_INTERNAL, "cannot be encoded as EXR");
    scratch_assert_fails(image_write_exr(layers, 1, scratch_context(), "/dev/full"), GN_IO, "/dev/full: cannot be written: No space left");
    scratch_assert_fails(image_write_exr(layers, 1, scratch_context(), "/no/a.exr"), GN_IO, "/no/a.exr: cannot be written: its folder");
    assert_int_equal(scratch_count(false), 0);
    image_finish(&image);
    image_finish(&other);
}

// ---- files of others

// How to make a file; the samples are small whole numbers, which every type holds, and every compression keeps where it is exact.
struct foreign_exr {
    const char *what;
    const char *channels; // one letter for each channel, in alphabetical order
    exr_pixel_type_t type;
    exr_compression_t compression;
    int tile;   // width and height of tiles; 0: scan lines
    int levels; // exr_tile_level_mode_t
    int width, height, left, top, sampling;
    double tolerance;
    const char *message; // how it is refused; NULL if it is read
};

#define PLAIN "BGR", EXR_PIXEL_FLOAT
static const struct foreign_exr FOREIGN[] = {
    {"plain", PLAIN, EXR_COMPRESSION_NONE, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"RLE", PLAIN, EXR_COMPRESSION_RLE, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"ZIPS", PLAIN, EXR_COMPRESSION_ZIPS, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"ZIP", PLAIN, EXR_COMPRESSION_ZIP, 0, 0, 7, 50, 0, 0, 1, 0, NULL},
    {"PIZ", PLAIN, EXR_COMPRESSION_PIZ, 0, 0, 37, 50, 0, 0, 1, 0, NULL},
    {"PXR24", PLAIN, EXR_COMPRESSION_PXR24, 0, 0, 7, 50, 0, 0, 1, 0, NULL},
    {"B44", "BGR", EXR_PIXEL_HALF, EXR_COMPRESSION_B44, 0, 0, 8, 40, 0, 0, 1, 32, NULL},
    {"B44A", "BGR", EXR_PIXEL_HALF, EXR_COMPRESSION_B44A, 0, 0, 8, 40, 0, 0, 1, 32, NULL},
    {"half", "BGR", EXR_PIXEL_HALF, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"half, alpha", "ABGR", EXR_PIXEL_HALF, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"half PIZ", "BGR", EXR_PIXEL_HALF, EXR_COMPRESSION_PIZ, 0, 0, 37, 50, 0, 0, 1, 0, NULL},
    {"uint", "BGR", EXR_PIXEL_UINT, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"grey", "Y", EXR_PIXEL_HALF, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"grey and alpha", "AY", EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"many channels", "ABCDEGRZ", EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, NULL},
    {"window elsewhere", PLAIN, EXR_COMPRESSION_ZIP, 0, 0, 7, 37, -3, 11, 1, 0, NULL},
    {"window above", PLAIN, EXR_COMPRESSION_ZIP, 0, 0, 7, 37, 5, -20, 1, 0, NULL},
    {"tiles", PLAIN, EXR_COMPRESSION_ZIP, 4, EXR_TILE_ONE_LEVEL, 10, 9, 0, 0, 1, 0, NULL},
    {"tiles of half", "BGR", EXR_PIXEL_HALF, EXR_COMPRESSION_PIZ, 16, EXR_TILE_ONE_LEVEL, 33, 17, -5, 2, 1, 0, NULL},
    {"a large tile", PLAIN, EXR_COMPRESSION_NONE, 64, EXR_TILE_ONE_LEVEL, 10, 9, 0, 0, 1, 0, NULL},
    {"no colour", "UVW", EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, "has no channels R, G, B, nor Y"},
    {"no blue", "GR", EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIP, 0, 0, 7, 5, 0, 0, 1, 0, "has no channels R, G, B, nor Y"},
    {"subsampled", PLAIN, EXR_COMPRESSION_NONE, 0, 0, 8, 4, 0, 0, 2, 0, "is subsampled, which is not supported"},
};

static float foreign_sample(const struct foreign_exr *f, size_t channel, int x, int y) {
    return (float)((x * 3 + y * 5 + (int)channel * 40 + x * y % 7) % (f->type == EXR_PIXEL_HALF ? 200 : 1000));
}

#define CHECK(call) assert_int_equal((call), EXR_ERR_SUCCESS)

static void make_header(exr_context_t exr, const struct foreign_exr *f, exr_storage_t storage) {
    int part;
    exr_attr_box2i_t window = {.min = {.x = f->left, .y = f->top}, .max = {.x = f->left + f->width - 1, .y = f->top + f->height - 1}};
    exr_attr_v2f_t centre = {.x = 0, .y = 0};
    CHECK(exr_add_part(exr, "part", storage, &part));
    CHECK(exr_initialize_required_attr(exr, part, &window, &window, 1, &centre, 1, EXR_LINEORDER_INCREASING_Y, f->compression));
    for (const char *c = f->channels; *c; c++) {
        char name[2] = {*c, 0};
        CHECK(exr_add_channel(exr, part, name, f->type, EXR_PERCEPTUALLY_LOGARITHMIC, f->sampling, f->sampling));
    }
    if (f->tile)
        CHECK(exr_set_tile_descriptor(exr, part, (uint32_t)f->tile, (uint32_t)f->tile, (exr_tile_level_mode_t)f->levels,
                                      EXR_TILE_ROUND_DOWN));
}

// Fills one chunk, whose corner is pixel (left, top) of the image, and writes it.
static void write_chunk(exr_context_t exr, const struct foreign_exr *f, const exr_chunk_info_t *chunk, int left, int top) {
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    size_t channels = strlen(f->channels), count = (size_t)chunk->width * (size_t)chunk->height;
    float *samples = calloc(channels * count, sizeof *samples);
    assert_non_null(samples);
    for (size_t c = 0; c < channels; c++)
        for (size_t i = 0; i < count; i++)
            samples[c * count + i] = foreign_sample(f, c, left + (int)(i % (size_t)chunk->width), top + (int)(i / (size_t)chunk->width));
    CHECK(exr_encoding_initialize(exr, 0, chunk, &encoder));
    for (size_t c = 0; c < channels; c++) {
        encoder.channels[c].encode_from_ptr = (const uint8_t *)(samples + c * count);
        encoder.channels[c].user_pixel_stride = sizeof(float);
        encoder.channels[c].user_line_stride = (int32_t)sizeof(float) * chunk->width;
        encoder.channels[c].user_bytes_per_element = sizeof(float);
        encoder.channels[c].user_data_type = EXR_PIXEL_FLOAT;
    }
    CHECK(exr_encoding_choose_default_routines(exr, 0, &encoder));
    CHECK(exr_encoding_run(exr, 0, &encoder));
    CHECK(exr_encoding_destroy(exr, &encoder));
    free(samples);
}

static const char *write_foreign(const struct foreign_exr *f) {
    const char *path = scratch_path("foreign.exr");
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t exr;
    exr_chunk_info_t chunk;
    int32_t lines;
    CHECK(exr_start_write(&exr, path, EXR_WRITE_FILE_DIRECTLY, &how));
    make_header(exr, f, f->tile ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE);
    CHECK(exr_write_header(exr));
    if (f->tile) {
        for (int y = 0; y < f->height; y += f->tile)
            for (int x = 0; x < f->width; x += f->tile) {
                CHECK(exr_write_tile_chunk_info(exr, 0, x / f->tile, y / f->tile, 0, 0, &chunk));
                write_chunk(exr, f, &chunk, x, y);
            }
    } else {
        CHECK(exr_get_scanlines_per_chunk(exr, 0, &lines));
        for (int y = 0; y < f->height; y += lines) {
            CHECK(exr_write_scanline_chunk_info(exr, 0, y + f->top, &chunk));
            write_chunk(exr, f, &chunk, 0, y);
        }
    }
    CHECK(exr_finish(&exr));
    return scratch_path("foreign.exr");
}

static void assert_image_is(const struct image *image, const struct foreign_exr *f) {
    assert_int_equal(image->width, f->width);
    assert_int_equal(image->height, f->height);
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            for (int c = 0; c < 3; c++) {
                const char *name = strchr(f->channels, "RGB"[c]);
                if (!name) name = strchr(f->channels, 'Y');
                float expected = foreign_sample(f, (size_t)(name - f->channels), x, y), found = image->pixels[3 * (y * f->width + x) + c];
                if (!(fabsf(found - expected) <= (float)f->tolerance))
                    fail_msg("%s: (%d, %d) channel %d is %g, expected %g", f->what, x, y, c, (double)found, (double)expected);
            }
}

static void files_of_others_are_read(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof FOREIGN / sizeof *FOREIGN; i++) {
        const char *path = write_foreign(&FOREIGN[i]);
        struct image image;
        if (FOREIGN[i].message) {
            assert_read_fails(path, FOREIGN[i].message);
            continue;
        }
        if (!image_read(&image, scratch_context(), path)) fail_msg("%s: %s", FOREIGN[i].what, scratch_state()->error.message);
        assert_image_is(&image, &FOREIGN[i]);
        image_finish(&image);
    }
}

// Files that have a header only: deep ones, and one of two parts.
static void other_kinds_are_refused(void **state) {
    (void)state;
    static const struct {
        exr_storage_t storage;
        int parts;
        const char *message;
    } cases[] = {
        {EXR_STORAGE_DEEP_SCANLINE, 1, "has deep pixels, which are not supported"},
        {EXR_STORAGE_SCANLINE, 2, "has 2 parts; a file of one part was expected"},
    };
    const struct foreign_exr plain = {"", PLAIN, EXR_COMPRESSION_ZIPS, 0, 0, 3, 1, 0, 0, 1, 0, NULL};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
        exr_context_t exr;
        CHECK(exr_start_write(&exr, scratch_path("other.exr"), EXR_WRITE_FILE_DIRECTLY, &how));
        make_header(exr, &plain, cases[i].storage);
        if (cases[i].parts == 2) {
            int part;
            CHECK(exr_add_part(exr, "second", cases[i].storage, &part));
            CHECK(exr_initialize_required_attr_simple(exr, part, 3, 1, EXR_COMPRESSION_ZIPS));
            CHECK(exr_add_channel(exr, part, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
        }
        CHECK(exr_write_header(exr));
        struct file_bytes bytes;
        scratch_assert(file_read(&bytes, scratch_context(), scratch_path("other.exr"), GN_IO));
        // The library would not keep a file without pixels: this is a copy, and then some room for the tables it has not written.
        char *longer = calloc(1, bytes.size + 1000);
        assert_non_null(longer);
        memcpy(longer, bytes.data, bytes.size);
        assert_read_fails(scratch_file("copy.exr", longer, bytes.size + 1000), cases[i].message);
        free(longer);
        file_bytes_finish(&bytes);
        exr_finish(&exr);
    }
}

static void damage_does_no_harm(void **state) {
    (void)state;
    int refused = 0;
    for (size_t i = 0; i < sizeof FOREIGN / sizeof *FOREIGN; i++)
        if (!FOREIGN[i].message) refused += damage_file(write_foreign(&FOREIGN[i]), (uint32_t)i * 100000, 60);
    assert_in_range(refused, 100, 60 * sizeof FOREIGN / sizeof *FOREIGN);
}

// Finds bytes in a file.
static char *find(const struct file_bytes *bytes, const char *what, size_t size) {
    for (size_t at = 0; at + size <= bytes->size; at++)
        if (memcmp(bytes->data + at, what, size) == 0) return bytes->data + at;
    fail_msg("not found: %s", what);
    return NULL;
}

static void a_file_that_claims_too_much_is_refused(void **state) {
    (void)state;
    static const struct {
        int32_t right, bottom;
    } cases[] = {{INT32_MAX, INT32_MAX}, {INT32_MAX - 1, 0}, {65535, 65535}, {16383, 16383}, {-1, -1}, {-1, 4}, {INT32_MIN, INT32_MIN}};
    struct file_bytes bytes;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scratch_assert(file_read(&bytes, scratch_context(), write_foreign(&FOREIGN[i % 2 ? 3 : 17]), GN_IO));
        char *window = find(&bytes, "dataWindow\0box2i\0\x10\0\0\0", 21) + 21;
        memcpy(window + 8, &cases[i].right, 4);
        memcpy(window + 12, &cases[i].bottom, 4);
        assert_read_fails(scratch_file("big.exr", bytes.data, bytes.size), "big.exr: ");
        file_bytes_finish(&bytes);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_come_back),         cmocka_unit_test(wrong_layers_are_refused),
        cmocka_unit_test(files_of_others_are_read), cmocka_unit_test(other_kinds_are_refused),
        cmocka_unit_test(damage_does_no_harm),      cmocka_unit_test(a_file_that_claims_too_much_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
