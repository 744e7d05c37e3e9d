// Whether a device calculates as the tiers from robust on assume: asked once, with a tiny kernel, when such a tier is first used. What a
// specification allows and a driver does are two things; a tier that would be wrong does not run.
#ifndef RENDER_ARITHMETIC_H
#define RENDER_ARITHMETIC_H

#include "render/cases.h"

// What can be wrong. Denormals may be flushed or not.
#define ARITHMETIC_FAULTS(X)                                                                                                               \
    X(0, ROUNDS, "it does not round sums and products to the nearest number")                                                              \
    X(1, CONTRACTS, "it fuses products and sums that are to be rounded one by one")                                                        \
    X(2, REORDERS, "it rearranges sums whose order is to be kept")                                                                         \
    X(3, DIVIDES, "its quotients are off by more than 2.5 ulp")                                                                            \
    X(4, ROOTS, "its square roots are off by more than 5 ulp")                                                                             \
    X(5, COMPARES, "it compares NaN or infinity as if they were numbers")
enum {
#define X(number, id, text) FAULT_##id = 1 << number,
    ARITHMETIC_FAULTS(X)
#undef X
};

// Limits that the tiers' bounds are derived from, in ulp of the exact result. Correct rounding, with room for the way the error is
// computed; ÷ as Vulkan has it; √ as 1/inversesqrt, 2 + 2.5 ulp of Vulkan (shaders/tier_exact.glsl leaves 13 u, or 6.5 ulp).
#define ROUNDED_ULP 0.5001
#define QUOTIENT_ULP 2.5001
#define ROOT_ULP 5.0

// The cases of the check.
bool arithmetic_cases_init(struct cases *out, struct context *ctx, bool fp64);

// What is wrong with the results of cases that cases_run_arithmetic has run; 0 if nothing is.
uint32_t arithmetic_faults(const struct cases *cases);

// The first fault, in words; NULL if there is none.
const char *arithmetic_fault_text(uint32_t faults);

// How far a RESULT_* up to RESULT_ROOT of case i is from the exact one, in ulp of it: +inf for NaN; 0 where the exact result is no normal
// number.
double arithmetic_error(const struct cases *cases, uint32_t i, uint32_t result);

// The same result rounded to nearest, ties to even.
double arithmetic_rounded(const struct cases *cases, uint32_t i, uint32_t result);

// What RESULT_SUM of case i, rounded in some way, is off by: exact.
double arithmetic_sum_error(const struct cases *cases, uint32_t i);

// Numbers of the type: the unit in the last place of x, and x rounded to the type.
double ulp_of(bool fp64, double x);
double round_to(bool fp64, double x);

// COMPARED_* of a and b.
uint32_t compared(double a, double b);

// Whether a device can be relied on for a tier. The first time that matters it runs the check, and keeps what it found in
// device->arithmetic; doubles with a fault are taken from the exact tier, which does without. Else GN_NO_DEVICE, with what is wrong. `fast`
// promises nothing that could break, and `robust`, the default, is not held up on software devices, where our tests run.
bool arithmetic_suffices(struct context *ctx, struct device *device, uint32_t tier);

#endif
