// Rows of the film: what becomes of sums of many samples, of bad samples, and of the numbers that leave as pixels.
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

#include "base/image.h"
#include "measure/stress/job.h"
#include "measure/stress/oracle.h"

#define PIECE 25000u // samples in a dispatch

struct film_input {
    float value;
    uint32_t times;
};

struct film_sums {
    float sum, residue;
    uint32_t samples, dropped;
};

_Static_assert(sizeof(struct film_sums) == 4 * sizeof(float), "what the kernel goes on from");

// Adds each input as often as it says, in one pixel each: sums[0 … count).
static bool add_samples(struct film_sums *sums, struct stress *s, const struct film_input *inputs, uint32_t count) {
    enum { MOST = 8 };
    struct film_input left[MOST];
    uint32_t most = 0;
    memset(sums, 0, count * sizeof *sums);
    for (uint32_t i = 0; i < count; i++) most = inputs[i].times > most ? inputs[i].times : most;
    for (uint32_t done = 0; done < most; done += PIECE) {
        for (uint32_t i = 0; i < count; i++) {
            uint32_t rest = inputs[i].times > done ? inputs[i].times - done : 0;
            left[i] = (struct film_input){inputs[i].value, rest < PIECE ? rest : PIECE};
        }
        const struct job job = {
            .fp32 = KERNEL_STRESS_FILM, .count = count, .in = &left[0].value, .out = &sums[0].sum, .in_each = 2, .out_each = 4};
        if (!job_run(s, &job) || !progress(s->ctx, "film", -1, -1)) return false;
    }
    return true;
}

// The sum of `times` equal samples, by its residue to more than fp32; right to `ulps` ulp of fp32.
static void judge_sum(struct tally *tally, const struct film_sums *sums, const struct film_input *input, double ulps) {
    double got = (double)sums->sum - sums->residue, right = (double)input->value * input->times;
    tally->rays += input->times;
    if (!(oracle_ulps(got, right) <= ulps) || sums->samples != input->times || sums->dropped != 0)
        tally_wrong(tally, "%u × %.9g: right %.10g, got %.10g of %u samples, %u dropped", input->times, input->value, right, got,
                    sums->samples, sums->dropped);
}

static bool run_sums(struct stress *s, const struct film_input *inputs, uint32_t count) {
    struct film_sums sums[8];
    struct tally tally = {0};
    if (!add_samples(sums, s, inputs, count)) return false;
    for (uint32_t i = 0; i < count; i++) judge_sum(&tally, &sums[i], &inputs[i], 0.5);
    tally_every(s, &tally);
    return true;
}

// The numbers of the row, or with few rays to spend a part of them.
static uint32_t shortened(const struct stress *s, uint32_t times) { return s->rays < FEW_RAYS ? times / 100 : times; }

// A01
bool film_many_ones(struct stress *s) { return run_sums(s, &(struct film_input){1, shortened(s, (1u << 24) + 100000)}, 1); }

// A02
bool film_tenths(struct stress *s) { return run_sums(s, &(struct film_input){0.1f, shortened(s, 1000000)}, 1); }

// A03: samples are counted to 2^24, the most that a pixel takes, and that many are one more than one less.
bool film_counts(struct stress *s) {
    const uint32_t most = shortened(s, 1u << 24);
    return run_sums(s, (struct film_input[]){{0.25f, most - 1}, {0.25f, most}}, 2);
}

// A04: what half floats lose.
bool film_small_terms(struct stress *s) {
    return run_sums(s, (struct film_input[]){{1e-3f, 100000}, {3e-8f, 50000}, {1e-30f, 50000}, {6e4f, 50000}, {1e30f, 50000}}, 5);
}

// A06: samples that are not finite are dropped and counted.
bool film_bad_samples(struct stress *s) {
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    struct film_sums sums[3];
    struct film_input inputs[3];
    struct tally tally = {0};
    for (int i = 0; i < 3; i++) inputs[i] = (struct film_input){bad[i], 100};
    if (!add_samples(sums, s, inputs, 3)) return false;
    for (int i = 0; i < 3; i++) {
        tally.rays += 100;
        if (sums[i].sum != 0 || sums[i].residue != 0 || sums[i].dropped != 100 || sums[i].samples != 100)
            tally_wrong(&tally, "100 × %g: sum %g, %u dropped", bad[i], sums[i].sum, sums[i].dropped);
    }
    tally_every(s, &tally);
    return true;
}

// ---------------------------------------------------------------------------------------------------------------- output

// The 8-bit code of a value, 0 to 1: round(255·f(value)), f the transfer of IEC 61966-2-1, in MPFR.
static int exact_code(float value) {
    mpfr_t x, exponent;
    mpfr_inits2(256, x, exponent, (mpfr_ptr)0);
    mpfr_set_flt(x, value, MPFR_RNDN);
    mpfr_set_str(exponent, "0.0031308", 10, MPFR_RNDN);
    if (mpfr_cmp(x, exponent) <= 0) {
        mpfr_set_str(exponent, "12.92", 10, MPFR_RNDN);
        mpfr_mul(x, x, exponent, MPFR_RNDN);
    } else {
        mpfr_set_ui(exponent, 5, MPFR_RNDN);
        mpfr_div_ui(exponent, exponent, 12, MPFR_RNDN);
        mpfr_pow(x, x, exponent, MPFR_RNDN);
        mpfr_mul_ui(x, x, 1055, MPFR_RNDN);
        mpfr_sub_ui(x, x, 55, MPFR_RNDN);
        mpfr_div_ui(x, x, 1000, MPFR_RNDN);
    }
    mpfr_mul_ui(x, x, 255, MPFR_RNDN);
    mpfr_add_d(x, x, 0.5, MPFR_RNDN);
    long code = mpfr_get_si(x, MPFR_RNDZ);
    mpfr_clears(x, exponent, (mpfr_ptr)0);
    return (int)code;
}

static void judge_code(struct tally *tally, float value) {
    uint8_t got = transfer_encode(TRANSFER_SRGB, value);
    int right = exact_code(value);
    tally->rays++;
    if (got != right) tally_wrong(tally, "sRGB of %a: right %d, got %d", value, right, got);
}

// A08: both sides of every threshold, found by bisection of our own codes, of the break in the curve, and numbers between.
bool film_srgb(struct stress *s) {
    struct tally tally = {0};
    for (int code = 0; code < 255; code++) {
        float low = 0, high = 1;
        while (nextafterf(low, 1) < high) {
            float middle = 0.5f * low + 0.5f * high;
            *(transfer_encode(TRANSFER_SRGB, middle) > code ? &high : &low) = middle;
        }
        judge_code(&tally, low);
        judge_code(&tally, high);
    }
    float around = 0.0031308f;
    for (int i = 0; i < 4; i++) around = nextafterf(around, 0);
    for (int i = 0; i < 8; i++, around = nextafterf(around, 1)) judge_code(&tally, around);
    for (uint32_t i = 0; i < s->rays / 4; i++) judge_code(&tally, (float)random_unit(&s->random));
    tally_every(s, &tally);
    return true;
}

// A11
bool film_bad_output(struct stress *s) {
    static const struct {
        float value;
        uint8_t code;
    } cases[] = {{NAN, 0},    {-NAN, 0},       {-0.0f, 0},     {0, 0},   {-INFINITY, 0},
                 {-1e30f, 0}, {INFINITY, 255}, {3.4e38f, 255}, {1, 255}, {0x1.000002p0f, 255}};
    struct tally tally = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int transfer = TRANSFER_SRGB; transfer <= TRANSFER_LINEAR; transfer++) {
            uint8_t got = transfer_encode((enum transfer)transfer, cases[i].value);
            tally.rays++;
            if (got != cases[i].code) tally_wrong(&tally, "the code of %g is %d, got %d", cases[i].value, cases[i].code, got);
        }
    tally_every(s, &tally);
    return true;
}
