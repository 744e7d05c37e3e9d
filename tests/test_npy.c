// .npy files: what NumPy writes and reads, and what every kind of wrong file is answered with.
#include "scratch.h"

#include "base/npy.h"

// A file of version 1, 2 or 3 with this header, padded with spaces to `align` bytes, and `size` bytes of data 0, 1, 2, …
static const char *make_file(unsigned version, const char *header, size_t align, size_t size) {
    unsigned char bytes[4096] = {0x93, 'N', 'U', 'M', 'P', 'Y', (unsigned char)version, 0};
    size_t start = version == 1 ? 10 : 12, end = (start + strlen(header) + align) / align * align, length = end - start;
    assert_true(end + size <= sizeof bytes);
    for (size_t i = 8; i < start; i++) bytes[i] = (unsigned char)(length >> 8 * (i - 8));
    memset(bytes + start, ' ', length);
    memcpy(bytes + start, header, strlen(header));
    bytes[end - 1] = '\n';
    for (size_t i = 0; i < size; i++) bytes[end + i] = (unsigned char)i;
    return scratch_file("a.npy", bytes, end + size);
}

static void reads_every_way_to_write_it(void **state) {
    (void)state;
    static const struct {
        unsigned version;
        const char *header;
        size_t align;
    } cases[] = {
        {1, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", 64},
        {1, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", 16},
        {2, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", 64},
        {3, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", 64},
        {1, "{'shape': (2, 3), 'descr': '<f4', 'fortran_order': False}", 1},
        {1, "{\"fortran_order\":False,\"shape\":(2,3),\"descr\":\"<f4\"}", 1},
        {1, " {\n 'descr' :\t'<f4' , 'fortran_order' : False , 'shape' : ( 2 , 3 , ) , } ", 64},
        {1, "{'descr': '<f4', 'fortran_order': False, 'shape': (2L, 3L), }", 64},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float *data;
        size_t rows;
        const char *path = make_file(cases[i].version, cases[i].header, cases[i].align, 24);
        scratch_assert(npy_read_f32(&data, &rows, scratch_context(), path, 3));
        assert_int_equal(rows, 2);
        for (unsigned char k = 0; k < 24; k++) assert_int_equal(((unsigned char *)data)[k], k);
        free(data);
    }
}

#define GOOD "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"

static void refuses_what_is_not_expected(void **state) {
    (void)state;
    static const struct {
        const char *header;
        size_t size;
        const char *message;
    } cases[] = {
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", 48, "has elements of type '<f8', expected '<f4'"},
        {"{'descr': '>f4', 'fortran_order': False, 'shape': (2, 3), }", 24, "has elements of type '>f4', expected '<f4'"},
        {"{'descr': '|O', 'fortran_order': False, 'shape': (2, 3), }", 24, "has elements of type '|O'"},
        {"{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (6,), }", 24, "has elements of type [('x', '<f4')], expected '<f4'"},
        {"{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }", 24, "is in Fortran order"},
        {"{'descr': '<f4', 'fortran_order': 0, 'shape': (2, 3), }", 24, "fortran_order is 0, expected False"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 2), }", 24, "has shape (3, 2), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (6,), }", 24, "has shape (6,), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (), }", 4, "has shape (), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 1), }", 24, "has shape (2, 3, 1), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (-2, 3), }", 24, "has shape (-2, 3), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2 3), }", 24, "has shape (2 3), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': [2, 3], }", 24, "has shape [2, 3], expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': 6, }", 24, "has shape 6, expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (,), }", 24, "has shape (,), expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (9999999999999999999999, 3), }", 24, "expected (N, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (999999999999999999, 3), }", 24, "need more: it is truncated"},
        {GOOD, 23, "has 23 bytes of data where its 2 rows of 12 bytes need more: it is truncated"},
        {GOOD, 0, "has 0 bytes of data where its 2 rows of 12 bytes need more"},
        {GOOD, 25, "has 25 bytes of data where its 2 rows of 12 bytes need less"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 3), }", 4, "need less"},
        {"{'descr': '<f4', 'fortran_order': False}", 24, "is no dictionary of descr, fortran_order and shape"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), 'more': 1}", 24, "is no dictionary of"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), 'shape': (2, 3)}", 24, "is no dictionary of"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)", 24, "is no dictionary of"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3}", 24, "is no dictionary of"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)} 1", 24, "is no dictionary of"},
        {"{'descr': '<f4' 'fortran_order': False, 'shape': (2, 3)}", 24, "is no dictionary of"},
        {"{'descr': , 'fortran_order': False, 'shape': (2, 3)}", 24, "is no dictionary of"},
        {"{'descr: '<f4'}", 24, "is no dictionary of"},
        {"{descr: '<f4'}", 24, "is no dictionary of"},
        {"{}", 24, "is no dictionary of"},
        {"", 24, "is no dictionary of"},
        {"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[", 24, "is no dictionary of"},
        {"{'descr': ((((((((((((((((((((((((((((((((((((((((((", 24, "is no dictionary of"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float *data = (float *)&data;
        size_t rows = 1;
        const char *path = make_file(1, cases[i].header, 64, cases[i].size);
        scratch_assert_fails(npy_read_f32(&data, &rows, scratch_context(), path, 3), GN_IO, cases[i].message);
        assert_true(strstr(scratch_state()->error.message, path) == scratch_state()->error.message);
        assert_null(data);
        assert_int_equal(rows, 0);
    }
}

static void refuses_other_files(void **state) {
    (void)state;
    static const struct {
        const char *bytes;
        size_t size;
        const char *message;
    } cases[] = {
        {"", 0, "is no .npy file"},
        {"\x93NUMPY\x01", 7, "is no .npy file"},
        {"PK\x03\x04 and so on", 15, "is no .npy file"},
        {"\x93NUMPY\x04\x00\x10\x00\x00\x00 ", 13, "is .npy version 4.0; 1, 2 and 3 are known"},
        {"\x93NUMPY\x00\x00\x10\x00\x00\x00 ", 13, "is .npy version 0.0"},
        {"\x93NUMPY\x02\x00\x10\x00\x00", 11, "ends inside its header"},
        {"\x93NUMPY\x01\x00\xff\xff{}", 12, "ends inside its header: 65535 bytes of header after byte 10, the file has 12"},
        {"\x93NUMPY\x02\x00\xff\xff\xff\xff{}", 14, "ends inside its header: 4294967295 bytes of header after byte 12, the file has 14"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float *data;
        size_t rows;
        const char *path = scratch_file("b.npy", cases[i].bytes, cases[i].size);
        scratch_assert_fails(npy_read_f32(&data, &rows, scratch_context(), path, 3), GN_IO, cases[i].message);
    }
    float *data;
    size_t rows;
    scratch_assert_fails(npy_read_f32(&data, &rows, scratch_context(), scratch_path("none.npy"), 3), GN_IO, "cannot be opened");
}

// A file cut anywhere is refused; a changed byte gives an error or an array of the right size, never a crash.
static void survives_damage(void **state) {
    (void)state;
    struct file_bytes bytes;
    float *data;
    size_t rows;
    scratch_assert(file_read(&bytes, scratch_context(), make_file(1, GOOD, 64, 24), GN_IO));
    for (size_t size = 0; size < bytes.size; size++) {
        const char *path = scratch_file("cut.npy", bytes.data, size);
        scratch_assert_fails(npy_read_f32(&data, &rows, scratch_context(), path, 3), GN_IO, path);
    }
    uint32_t random = 1, accepted = 0;
    for (int i = 0; i < 3000; i++) {
        random = random * 747796405u + 2891336453u;
        size_t at = (random >> 8) % bytes.size;
        char before = bytes.data[at];
        bytes.data[at] = (char)(random >> 24);
        const char *path = scratch_file("flip.npy", bytes.data, bytes.size);
        bytes.data[at] = before;
        if (npy_read_f32(&data, &rows, scratch_context(), path, 3)) {
            accepted++;
            assert_int_equal(rows, 2);
            free(data);
        } else {
            assert_int_equal(scratch_state()->error.status, GN_IO);
        }
    }
    assert_in_range(accepted, 1, 2999); // bytes of data and of padding do no harm, the others do
    file_bytes_finish(&bytes);
}

// Compares a file with this header, padded to 128 or 192 bytes as NumPy pads it, and these data.
static void assert_file_is(const char *path, const char *header, size_t start, const void *data, size_t size) {
    struct file_bytes bytes;
    char expected[256] = "\x93NUMPY\x01";
    expected[8] = (char)(start - 10);
    memset(expected + 10, ' ', start - 10);
    memcpy(expected + 10, header, strlen(header));
    expected[start - 1] = '\n';
    scratch_assert(file_read(&bytes, scratch_context(), path, GN_IO));
    assert_int_equal(bytes.size, start + size);
    assert_memory_equal(bytes.data, expected, start);
    assert_memory_equal(bytes.data + start, data, size);
    file_bytes_finish(&bytes);
}

static void writes_what_numpy_reads(void **state) {
    (void)state;
    static const float rays[2][8] = {{1, 2, 3, 0, 0, 0, -1, 1e30f}, {4, 5, 6, 0, 0, 1, 0, 2}};
    static const struct gn_hit hits[2] = {{1.5f, 0.25f, 0.5f, 3, 70000, 2}, {2, 0, 0, -1, -1, 1}};
    scratch_assert(npy_write_f32(rays[0], 2, 8, scratch_context(), scratch_path("rays.npy")));
    assert_file_is(scratch_path("rays.npy"), "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 8), }", 128, rays, sizeof rays);
    scratch_assert(npy_write_hits(hits, 2, scratch_context(), scratch_path("hits.npy")));
    assert_file_is(scratch_path("hits.npy"),
                   "{'descr': [('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('object', '<i4'), ('primitive', '<i4'), ('flags', '<u4')], "
                   "'fortran_order': False, 'shape': (2,), }",
                   192, hits, sizeof hits);
    scratch_assert_fails(npy_write_hits(hits, 2, scratch_context(), "/dev/full"), GN_IO, "/dev/full: cannot be written: No space left");
    scratch_assert_fails(npy_write_hits(hits, 2, scratch_context(), "/no/such.npy"), GN_IO, "its folder does not exist");
}

static void reads_back_what_it_writes(void **state) {
    (void)state;
    static const size_t counts[] = {0, 1, 1000};
    float rays[1000][8];
    struct gn_hit hits[1000];
    for (int i = 0; i < 1000; i++) {
        for (int k = 0; k < 8; k++) rays[i][k] = (float)(8 * i + k);
        hits[i] = (struct gn_hit){(float)i, 0.5f, 0.25f, i, -i, (uint32_t)i};
    }
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        float *data;
        struct gn_hit *records;
        size_t count = 77;
        scratch_assert(npy_write_f32(rays[0], counts[i], 8, scratch_context(), scratch_path("rays.npy")));
        scratch_assert(npy_read_f32(&data, &count, scratch_context(), scratch_path("rays.npy"), 8));
        assert_int_equal(count, counts[i]);
        assert_non_null(data);
        assert_memory_equal(data, rays, count * sizeof *rays);
        free(data);
        scratch_assert(npy_write_hits(hits, counts[i], scratch_context(), scratch_path("hits.npy")));
        scratch_assert(npy_read_hits(&records, &count, scratch_context(), scratch_path("hits.npy")));
        assert_int_equal(count, counts[i]);
        assert_memory_equal(records, hits, count * sizeof *hits);
        free(records);
        scratch_assert_fails(npy_read_f32(&data, &count, scratch_context(), scratch_path("hits.npy"), 6), GN_IO,
                             "has elements of type [('t', '<f4'), ");
    }
    struct gn_hit *records;
    size_t count;
    const char *path = make_file(1,
                                 "{'descr': [('u', '<f4'), ('t', '<f4'), ('v', '<f4'), ('object', '<i4'), ('primitive', '<i4'), "
                                 "('flags', '<u4')], 'fortran_order': False, 'shape': (1,), }",
                                 64, 24);
    scratch_assert_fails(npy_read_hits(&records, &count, scratch_context(), path), GN_IO,
                         "has elements of type [('u', '<f4'), ('t', '<f4')");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_every_way_to_write_it), cmocka_unit_test(refuses_what_is_not_expected),
        cmocka_unit_test(refuses_other_files),         cmocka_unit_test(survives_damage),
        cmocka_unit_test(writes_what_numpy_reads),     cmocka_unit_test(reads_back_what_it_writes),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
