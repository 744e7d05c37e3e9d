// The 8-bit codes of linear light, against the same formulas in 200 bits.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>

#include <mpfr.h>

// Ours before cmocka's: that has a macro called fail.
#include "base/image.h"

#include <cmocka.h>

#define BITS 200

// floor(255·f(v) + 1/2) for a v of 0…1, f after IEC 61966-2-1 or the identity.
static unsigned exact_code(enum transfer transfer, float value) {
    mpfr_t v, limit;
    mpfr_inits2(BITS, v, limit, (mpfr_ptr)NULL);
    mpfr_set_flt(v, value, MPFR_RNDN);
    mpfr_set_str(limit, "0.0031308", 10, MPFR_RNDN);
    if (transfer == TRANSFER_SRGB && mpfr_lessequal_p(v, limit)) {
        mpfr_mul_ui(v, v, 1292, MPFR_RNDN);
        mpfr_div_ui(v, v, 100, MPFR_RNDN);
    } else if (transfer == TRANSFER_SRGB) {
        mpfr_set_ui(limit, 5, MPFR_RNDN);
        mpfr_div_ui(limit, limit, 12, MPFR_RNDN);
        mpfr_pow(v, v, limit, MPFR_RNDN);
        mpfr_mul_ui(v, v, 1055, MPFR_RNDN);
        mpfr_sub_ui(v, v, 55, MPFR_RNDN);
        mpfr_div_ui(v, v, 1000, MPFR_RNDN);
    }
    mpfr_mul_ui(v, v, 255, MPFR_RNDN);
    mpfr_add_d(v, v, 0.5, MPFR_RNDN);
    unsigned code = (unsigned)mpfr_get_ui(v, MPFR_RNDD);
    mpfr_clears(v, limit, (mpfr_ptr)NULL);
    return code;
}

// The fp32 number nearest to the linear value of a code.
static float exact_linear(enum transfer transfer, unsigned code) {
    mpfr_t v, power;
    mpfr_inits2(BITS, v, power, (mpfr_ptr)NULL);
    mpfr_set_ui(v, code, MPFR_RNDN);
    mpfr_div_ui(v, v, 255, MPFR_RNDN);
    if (transfer == TRANSFER_SRGB && mpfr_cmp_d(v, 0.04045) <= 0) {
        mpfr_mul_ui(v, v, 100, MPFR_RNDN);
        mpfr_div_ui(v, v, 1292, MPFR_RNDN);
    } else if (transfer == TRANSFER_SRGB) {
        mpfr_mul_ui(v, v, 1000, MPFR_RNDN);
        mpfr_add_ui(v, v, 55, MPFR_RNDN);
        mpfr_div_ui(v, v, 1055, MPFR_RNDN);
        mpfr_set_ui(power, 12, MPFR_RNDN);
        mpfr_div_ui(power, power, 5, MPFR_RNDN);
        mpfr_pow(v, v, power, MPFR_RNDN);
    }
    float value = mpfr_get_flt(v, MPFR_RNDN);
    mpfr_clears(v, power, (mpfr_ptr)NULL);
    return value;
}

static float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

typedef uint8_t encoder(enum transfer transfer, float value);

// What a table with every threshold one unit in the last place too low would give.
static uint8_t encode_off_by_one_ulp(enum transfer transfer, float value) { return transfer_encode(transfer, nextafterf(value, 2)); }

// Where the encoder passes from below `code` to `code` or more: the bits of the first number there.
static uint32_t threshold_of(encoder *encode, enum transfer transfer, unsigned code) {
    uint32_t below = 0, above = 0x3f800000; // 0 and 1
    while (above - below > 1) {
        uint32_t middle = below + (above - below) / 2;
        if (encode(transfer, float_of(middle)) >= code)
            above = middle;
        else
            below = middle;
    }
    return above;
}

// How many of the 255 steps are not where exact arithmetic has them.
static unsigned wrong_steps(encoder *encode, enum transfer transfer) {
    unsigned wrong = 0;
    for (unsigned code = 1; code <= 255; code++) {
        uint32_t first = threshold_of(encode, transfer, code);
        float here = float_of(first), before = float_of(first - 1);
        bool right = encode(transfer, here) == code && encode(transfer, before) == code - 1;
        right = right && exact_code(transfer, here) == code && exact_code(transfer, before) == code - 1;
        wrong += !right;
    }
    return wrong;
}

static void every_step_is_exact(void **state) {
    (void)state;
    assert_int_equal(wrong_steps(transfer_encode, TRANSFER_SRGB), 0);
    assert_int_equal(wrong_steps(transfer_encode, TRANSFER_LINEAR), 0);
    // The check can fail: a step one unit in the last place off is seen, each of them.
    assert_int_equal(wrong_steps(encode_off_by_one_ulp, TRANSFER_SRGB), 255);
    assert_int_equal(wrong_steps(encode_off_by_one_ulp, TRANSFER_LINEAR), 255);
}

static void any_number_has_its_code(void **state) {
    (void)state;
    uint32_t random = 1;
    for (int i = 0; i < 20000; i++) {
        random = random * 747796405u + 2891336453u;
        float value = float_of((random ^ random >> 15) % 0x3f800001);
        assert_int_equal(transfer_encode(TRANSFER_SRGB, value), exact_code(TRANSFER_SRGB, value));
        assert_int_equal(transfer_encode(TRANSFER_LINEAR, value), exact_code(TRANSFER_LINEAR, value));
    }
}

static void codes_never_fall(void **state) {
    (void)state;
    for (int transfer = TRANSFER_SRGB; transfer <= TRANSFER_LINEAR; transfer++) {
        uint8_t last = 0;
        for (uint32_t bits = 0; bits <= 0x7f800000; bits += 997) {
            uint8_t code = transfer_encode((enum transfer)transfer, float_of(bits));
            assert_true(code >= last);
            last = code;
        }
        assert_int_equal(last, 255);
    }
}

static void odd_numbers_are_clamped(void **state) {
    (void)state;
    const struct {
        float value;
        uint8_t srgb, linear;
    } cases[] = {
        {NAN, 0, 0},       {-NAN, 0, 0}, {INFINITY, 255, 255}, {-INFINITY, 0, 0},          {0.0f, 0, 0},  {-0.0f, 0, 0},
        {0x1p-149f, 0, 0}, {-1, 0, 0},   {1, 255, 255},        {0x1.fffffep-1f, 255, 255}, {2, 255, 255}, {0x1.fffffep127f, 255, 255},
        {0.5f, 188, 128}, // 127.5 is rounded up
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(transfer_encode(TRANSFER_SRGB, cases[i].value), cases[i].srgb);
        assert_int_equal(transfer_encode(TRANSFER_LINEAR, cases[i].value), cases[i].linear);
    }
}

static void decoding_is_exact_and_inverse(void **state) {
    (void)state;
    for (int transfer = TRANSFER_SRGB; transfer <= TRANSFER_LINEAR; transfer++)
        for (unsigned code = 0; code < 256; code++) {
            float value = transfer_decode((enum transfer)transfer, (uint8_t)code), exact = exact_linear((enum transfer)transfer, code);
            assert_true(value == exact);
            assert_int_equal(transfer_encode((enum transfer)transfer, value), code);
            assert_false(nextafterf(value, 2) == exact);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_step_is_exact),     cmocka_unit_test(any_number_has_its_code),       cmocka_unit_test(codes_never_fall),
        cmocka_unit_test(odd_numbers_are_clamped), cmocka_unit_test(decoding_is_exact_and_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
