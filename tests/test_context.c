// Errors and messages: the first one stays, and what is said is text.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

// Ours before cmocka's: that has a macro called fail. The function is called as (fail)(ctx, …) here.
#include "base/context.h"

#include <cmocka.h>

static void the_first_error_stays(void **state) {
    (void)state;
    struct gn_error error = {.status = GN_IO, .message = "old"};
    struct context ctx = context_make(NULL, &error);
    assert_int_equal(error.status, GN_OK);
    assert_string_equal(error.message, "");
    assert_false((fail)(&ctx, GN_SCENE, "%d is wrong", 7));
    assert_false((fail)(&ctx, GN_IO, "later"));
    assert_int_equal(error.status, GN_SCENE);
    assert_string_equal(error.message, "7 is wrong");
}

static void keep(void *user, enum gn_level level, const char *text) {
    assert_int_equal(level, GN_LEVEL_WARNING);
    strcpy(user, text);
}

static void messages_are_text(void **state) {
    (void)state;
    static const struct {
        const char *in, *out;
    } cases[] = {
        {"plain", "plain"},
        {"é × … 🙂", "é × … 🙂"},
        {"a\nb\tc", "a\nb\tc"},
        {"\x1b[31mred\x7f\r", "?[31mred??"},
        {"\xff\xfe", "??"},
        {"\x80x", "?x"},
        {"\xc3", "?"},
        {"\xe2\x80", "??"},
        {"\xf0\x9f\x99", "???"},
        {"\xc0\xaf", "??"},           // overlong
        {"\xe0\x80\xaf", "???"},      // overlong
        {"\xf0\x80\x80\xaf", "????"}, // overlong
        {"\xed\xa0\x80", "???"},      // a surrogate
        {"\xf4\x90\x80\x80", "????"}, // beyond U+10FFFF
        {"\xed\x9f\xbf\xf4\x8f\xbf\xbf", "\xed\x9f\xbf\xf4\x8f\xbf\xbf"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[64] = "";
        struct gn_error error;
        struct gn_host host = {.user = text, .message = keep};
        struct context ctx = context_make(&host, &error);
        assert_false((fail)(&ctx, GN_IO, "%s", cases[i].in));
        assert_string_equal(error.message, cases[i].out);
        notify(&ctx, GN_LEVEL_WARNING, "%s", cases[i].in);
        assert_string_equal(text, cases[i].out);
    }
}

static void a_message_cut_inside_a_character_is_text(void **state) {
    (void)state;
    char name[4096] = "";
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    memset(name, 'x', 2045);
    strcat(name, "🙂🙂");
    assert_false((fail)(&ctx, GN_IO, "%s", name));
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
    assert_string_equal(error.message + 2045, "??");
}

static void too_much_memory_is_an_error(void **state) {
    (void)state;
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    assert_null(array_alloc(&ctx, SIZE_MAX / 2, 16, "the film"));
    assert_int_equal(error.status, GN_LIMIT);
    assert_non_null(strstr(error.message, "no memory for the film: "));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_error_stays),
        cmocka_unit_test(messages_are_text),
        cmocka_unit_test(a_message_cut_inside_a_character_is_text),
        cmocka_unit_test(too_much_memory_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
