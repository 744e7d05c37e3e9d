// Files: read whole, written whole or not at all.
#include "scratch.h"

#include <sys/resource.h>
#include <signal.h>

static void write_text(const char *path, const char *text) {
    struct output_file file;
    scratch_assert(output_begin(&file, scratch_context(), path));
    scratch_assert(output_write(&file, scratch_context(), text, strlen(text)));
    scratch_assert(output_commit(&file, scratch_context()));
}

static void assert_holds(const char *path, const char *text) {
    struct file_bytes bytes;
    scratch_assert(file_read(&bytes, scratch_context(), path, GN_IO));
    assert_string_equal(bytes.data, text);
    assert_int_equal(bytes.size, strlen(text));
    file_bytes_finish(&bytes);
}

static void reads_what_was_written(void **state) {
    (void)state;
    scratch_count(true);
    write_text(scratch_path("a.txt"), "first");
    assert_holds(scratch_path("a.txt"), "first");
    write_text(scratch_path("a.txt"), "second, longer");
    assert_holds(scratch_path("a.txt"), "second, longer");
    write_text(scratch_path("a.txt"), "");
    assert_holds(scratch_path("a.txt"), "");
    assert_int_equal(scratch_count(false), 1);
}

static void reads_long_files_and_pipes(void **state) {
    (void)state;
    size_t size = 300000;
    char *text = malloc(size);
    assert_non_null(text);
    for (size_t i = 0; i < size; i++) text[i] = (char)(i * 31 % 251);
    struct file_bytes bytes;
    scratch_assert(file_read(&bytes, scratch_context(), scratch_file("long", text, size), GN_IO));
    assert_int_equal(bytes.size, size);
    assert_memory_equal(bytes.data, text, size);
    file_bytes_finish(&bytes);
    int ends[2];
    char path[64];
    assert_int_equal(pipe(ends), 0);
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    assert_int_equal(write(ends[1], "through a pipe", 14), 14);
    close(ends[1]);
    assert_holds(path, "through a pipe");
    close(ends[0]);
    assert_holds("/dev/null", "");
    free(text);
}

static void says_what_cannot_be_read(void **state) {
    (void)state;
    struct file_bytes bytes;
    scratch_assert_fails(file_read(&bytes, scratch_context(), "/nowhere/at/all.json", GN_SCENE), GN_SCENE,
                         "/nowhere/at/all.json: cannot be opened: No such file");
    scratch_assert_fails(file_read(&bytes, scratch_context(), "/tmp", GN_IO), GN_IO, "/tmp: is a directory");
    scratch_assert_fails(file_read(&bytes, scratch_context(), "", GN_IO), GN_IO, "cannot be opened");
    scratch_assert_fails(file_read(&bytes, scratch_context(), "/dev/zero", GN_IO), GN_IO, "/dev/zero: gives more than 256 MiB");
    assert_null(bytes.data);
}

static void says_what_cannot_be_written(void **state) {
    (void)state;
    static const struct {
        const char *path, *message;
    } cases[] = {
        {"/nowhere/at/all.png", "/nowhere/at/all.png: cannot be written: its folder does not exist"},
        {"/tmp", "/tmp: cannot be written: it is a directory"},
        {"/tmp/", "/tmp/: cannot be written: it is a directory"},
        {"/proc/new.png", "/proc/new.png: cannot be written: "},
        {"/dev/null/x", "/dev/null/x: cannot be written: Not a directory"},
        {"", "cannot be written: "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct output_file file;
        scratch_assert_fails(output_begin(&file, scratch_context(), cases[i].path), GN_IO, cases[i].message);
        output_abort(&file);
    }
}

static void nothing_is_there_until_commit(void **state) {
    (void)state;
    struct output_file file;
    scratch_count(true);
    write_text(scratch_path("kept"), "old");
    scratch_assert(output_begin(&file, scratch_context(), scratch_path("kept")));
    scratch_assert(output_write(&file, scratch_context(), "new", 3));
    assert_holds(scratch_path("kept"), "old");
    assert_int_equal(scratch_count(false), 2);
    output_abort(&file);
    output_abort(&file);
    assert_holds(scratch_path("kept"), "old");
    assert_int_equal(scratch_count(false), 1);
}

// The limit on a file's size stands in for a full disk; the write that fails is one inside, or the last flush.
static void a_failed_write_leaves_nothing(void **state) {
    (void)state;
    static const size_t sizes[] = {3000, 1000000};
    char *text = calloc(1, 1000000);
    assert_non_null(text);
    struct rlimit before, small;
    signal(SIGXFSZ, SIG_IGN);
    scratch_count(true);
    write_text(scratch_path("kept"), "old");
    for (size_t i = 0; i < 2; i++) {
        struct output_file file;
        assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
        small = (struct rlimit){.rlim_cur = 1000, .rlim_max = before.rlim_max};
        scratch_assert(output_begin(&file, scratch_context(), scratch_path("kept")));
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        struct context *ctx = scratch_context();
        bool written = output_write(&file, ctx, text, sizes[i]), done = output_commit(&file, ctx);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_true(written == (i == 0));
        scratch_assert_fails(done, GN_IO, "kept: cannot be written: File too large");
        assert_holds(scratch_path("kept"), "old");
        assert_int_equal(scratch_count(false), 1);
    }
    free(text);
}

static void devices_are_written_directly(void **state) {
    (void)state;
    struct output_file file;
    write_text("/dev/null", "gone");
    scratch_assert(output_begin(&file, scratch_context(), "/dev/full"));
    assert_null(file.temporary);
    fputs("no room", file.stream);
    scratch_assert_fails(output_commit(&file, scratch_context()), GN_IO, "/dev/full: cannot be written: No space left");
    struct stat about;
    assert_int_equal(stat("/dev/full", &about), 0);
    assert_true(S_ISCHR(about.st_mode));
}

static void permissions_are_as_fopen_gives(void **state) {
    (void)state;
    struct stat about;
    scratch_count(true);
    mode_t before = umask(027);
    write_text(scratch_path("a"), "x");
    umask(before);
    assert_int_equal(stat(scratch_path("a"), &about), 0);
    assert_int_equal(about.st_mode & 0777, 0640);
    assert_int_equal(chmod(scratch_path("a"), 0604), 0);
    write_text(scratch_path("a"), "y");
    assert_int_equal(stat(scratch_path("a"), &about), 0);
    assert_int_equal(about.st_mode & 0777, 0604);
}

static void a_link_stays_a_link(void **state) {
    (void)state;
    struct stat about;
    char target[512];
    scratch_count(true);
    write_text(scratch_path("target"), "old");
    strcpy(target, scratch_path("target"));
    assert_int_equal(symlink(target, scratch_path("link")), 0);
    write_text(scratch_path("link"), "new");
    assert_int_equal(lstat(scratch_path("link"), &about), 0);
    assert_true(S_ISLNK(about.st_mode));
    assert_holds(target, "new");
}

static void the_longest_name_works(void **state) {
    (void)state;
    char name[256];
    memset(name, 'n', 255);
    name[255] = '\0';
    write_text(scratch_path(name), "x");
    assert_holds(scratch_path(name), "x");
}

static void suffixes(void **state) {
    (void)state;
    static const struct {
        const char *path, *suffix;
    } cases[] = {
        {"a.png", "png"},
        {"a.PNG", "png"},
        {"a.tar.gz", "gz"},
        {"a", ""},
        {"", ""},
        {".png", ""},
        {"b.d/a", ""},
        {"a.", ""},
        {"x/.y", ""},
        {"../a.exr", "exr"},
        {"a.b/c.D", "d"},
        {"a.sevenchr", ""},
        {"a.seven77", "seven77"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char suffix[8];
        path_suffix(cases[i].path, suffix, sizeof suffix);
        assert_string_equal(suffix, cases[i].suffix);
    }
    path_suffix("a.png", NULL, 0);
}

static void names_beside(void **state) {
    (void)state;
    static const struct {
        const char *base, *name, *path;
    } cases[] = {
        {"scene.json", "a.obj", "a.obj"},
        {"x/scene.json", "a.obj", "x/a.obj"},
        {"/x/scene.json", "y/a.obj", "/x/y/a.obj"},
        {"x/scene.json", "/y/a.obj", "/y/a.obj"},
        {"/s.json", "a", "/a"},
        {"x/s.json", "", "x/"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *path = path_beside(cases[i].base, cases[i].name);
        assert_non_null(path);
        assert_string_equal(path, cases[i].path);
        free(path);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_what_was_written),
        cmocka_unit_test(reads_long_files_and_pipes),
        cmocka_unit_test(says_what_cannot_be_read),
        cmocka_unit_test(says_what_cannot_be_written),
        cmocka_unit_test(nothing_is_there_until_commit),
        cmocka_unit_test(a_failed_write_leaves_nothing),
        cmocka_unit_test(devices_are_written_directly),
        cmocka_unit_test(permissions_are_as_fopen_gives),
        cmocka_unit_test(a_link_stays_a_link),
        cmocka_unit_test(the_longest_name_works),
        cmocka_unit_test(suffixes),
        cmocka_unit_test(names_beside),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
