// Decimal numbers become the nearest fp32, in every locale, in text and in JSON.
#include "scratch.h"

#include <locale.h>
#include <math.h>

#include "scene/json_read.h"
#include "scene/number.h"

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// Length 0: the whole text.
static const struct {
    const char *text;
    uint32_t bits;
    size_t length;
} numbers[] = {
    {"0", 0x00000000, 0},
    {"-0", 0x80000000, 0},
    {"+1.5", 0x3fc00000, 0},
    {".5", 0x3f000000, 0},
    {"5.", 0x40a00000, 0},
    {"1e", 0x3f800000, 1},
    {"1e+", 0x3f800000, 1},
    {"1.2.3", 0x3f99999a, 3},
    {"-2.5E-1x", 0xbe800000, 7},
    {"0x10", 0x00000000, 1},
    {"1,5", 0x3f800000, 1},
    // 2^24 + 1 is midway: to even. A little more or less in a far digit decides.
    {"16777217", 0x4b800000, 0},
    {"16777217.000000000000000000000000000000000001", 0x4b800001, 0},
    {"16777216.999999999999999999999999999999999999", 0x4b800000, 0},
    {"16777219", 0x4b800002, 0},
    // 1 + 2^-24 and its neighbours in fp64: rounding twice gives 1 for the second, too.
    {"1.000000059604644775390625", 0x3f800000, 0},
    {"1.0000000596046447753906250000000000001", 0x3f800001, 0},
    {"1.00000005960464477539062499999999", 0x3f800000, 0},
    // The ends of the range: FLT_MAX, midway to 2^128, the smallest numbers, midway to 0.
    {"340282346638528859811704183484516925440", 0x7f7fffff, 0},
    {"340282356779733661637539395458142568447", 0x7f7fffff, 0},
    {"340282356779733661637539395458142568448", 0x7f800000, 0},
    {"1e39", 0x7f800000, 0},
    {"-1e999999999999999999999", 0xff800000, 0},
    {"1.1754943508222875e-38", 0x00800000, 0},
    {"1.401298464324817e-45", 0x00000001, 0},
    {"0.7006492321624085354618e-45", 0x00000000, 0},
    {"0.7006492321624085354619e-45", 0x00000001, 0},
    {"1e-999999999999999999999", 0x00000000, 0},
    {"0.00000000000000000000000000000000000000000000000000000000001e59", 0x3f800000, 0},
    {"100000000000000000000000000000000000000000000000000000000000e-59", 0x3f800000, 0},
    {"inf", 0x7f800000, 0},
    {"-Infinity", 0xff800000, 0},
};

static void rounds_once(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        float value;
        const char *end = number_f32(&value, numbers[i].text);
        const size_t length = numbers[i].length ? numbers[i].length : strlen(numbers[i].text);
        if (!end || bits_of(value) != numbers[i].bits || (size_t)(end - numbers[i].text) != length)
            fail_msg("'%s' gives %08x and %d characters", numbers[i].text, bits_of(value), end ? (int)(end - numbers[i].text) : -1);
    }
    static const char *const none[] = {"", "-", "+", ".", "e5", "x", "-.e1", "in", " 1"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        float value;
        if (number_f32(&value, none[i])) fail_msg("'%s' is a number", none[i]);
    }
    float value;
    assert_non_null(number_f32(&value, "nan"));
    assert_true(isnan(value));
}

// A small generator, so that every run is the same.
static uint32_t next_random(uint64_t *state) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 32);
}

// Random digits, and digits around the midpoints of random floats; glibc's strtof is right for all.
static void agrees_with_strtof(void **state) {
    (void)state;
    uint64_t random = 1;
    int naive = 0;
    for (int i = 0; i < 300000; i++) {
        char text[128];
        const uint32_t bits = next_random(&random) & 0x7fffffff;
        float low;
        memcpy(&low, &bits, sizeof low);
        if (i % 2)
            snprintf(text, sizeof text, "%u.%ue%d", next_random(&random), next_random(&random), (int)(next_random(&random) % 80) - 45);
        else if (isfinite(low) && isfinite(nextafterf(low, INFINITY)))
            snprintf(text, sizeof text, "%.*e", (int)(next_random(&random) % 25) + 5, 0.5 * ((double)low + nextafterf(low, INFINITY)));
        else
            continue;
        float value;
        assert_non_null(number_f32(&value, text));
        const float right = strtof(text, NULL);
        naive += (float)strtod(text, NULL) != right;
        if (bits_of(value) != bits_of(right)) fail_msg("'%s' gives %08x, expected %08x", text, bits_of(value), bits_of(right));
    }
    assert_true(naive > 0); // or the cases are too easy
}

static void reads_integers(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int64_t value;
        size_t length;
    } cases[] = {{"0", 0, 1},
                 {"-12/3", -12, 3},
                 {"+7 ", 7, 2},
                 {"9223372036854775807", INT64_MAX, 19},
                 {"9223372036854775808", INT64_MAX, 19},
                 {"-9223372036854775808", INT64_MIN, 20},
                 {"-99999999999999999999999", INT64_MIN, 24},
                 {"1.5", 1, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int64_t value;
        const char *end = number_i64(&value, cases[i].text);
        assert_non_null(end);
        assert_true(value == cases[i].value);
        assert_int_equal(end - cases[i].text, cases[i].length);
    }
    int64_t value;
    assert_null(number_i64(&value, "-"));
    assert_null(number_i64(&value, "x"));
}

// jansson gives an fp64, which is rounded again.
static void json_rounds_once(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        const char *t = numbers[i].text;
        char document[256];
        float value;
        if (numbers[i].length || strchr("+.i", t[0]) || t[1] == 'I' || t[strlen(t) - 1] == '.' || !isfinite(atof(t))) continue; // not JSON
        snprintf(document, sizeof document, "{\"a\\\"]\": [\"x,{\", {}, [], {\"b\": %s}]}", t);
        struct json_file file;
        scratch_assert(json_file_init(&file, scratch_context(), scratch_file("number.json", document, strlen(document))));
        struct json_at root = at_root(&file), list;
        assert_true(at_member(&list, &root, "a\"]"));
        const struct json_at object = at_item(&list, 3);
        if ((numbers[i].bits & 0x7fffffff) == 0x7f800000) {
            scratch_assert_fails(at_get_float(&object, "b", RANGE_ANY, &value), GN_SCENE, "number.json:1:32: a\"][3].b is ");
        } else {
            scratch_assert(at_get_float(&object, "b", RANGE_ANY, &value));
            if (bits_of(value) != numbers[i].bits) fail_msg("'%s' gives %08x", t, bits_of(value));
        }
        json_file_finish(&file);
    }
}

// Where the locale has a decimal comma.
static void no_locale_has_a_say(void **state) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "pt_BR.UTF-8"};
    const char *set = NULL;
    for (size_t i = 0; i < sizeof names / sizeof *names && !set; i++) set = setlocale(LC_NUMERIC, names[i]);
    if (!set) {
        print_message("skipped: no locale with a decimal comma is installed\n");
        skip();
    }
    rounds_once(state);
    json_rounds_once(state);
    setlocale(LC_NUMERIC, "C");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounds_once),      cmocka_unit_test(agrees_with_strtof),  cmocka_unit_test(reads_integers),
        cmocka_unit_test(json_rounds_once), cmocka_unit_test(no_locale_has_a_say),
    };
    return cmocka_run_group_tests_name("numbers", tests, scratch_open, scratch_close);
}
