// What the kernels compute that ask a device how it calculates: read by C and by GLSL. Apart from shared.h because no other kernel has a use
// for it.
//
// All of them work on cases of four numbers a, b, c, d, one invocation a case: binding 0 holds the numbers, binding 1 receives the results,
// the push constant is the number of cases. A number is its bits: one word of fp32, or two of fp64, the lower one first.
#ifndef GNOMON_ARITHMETIC_H
#define GNOMON_ARITHMETIC_H

// arithmetic.comp: all of these for each case, in this order. With `precise`: what the exact and fp64 tiers stand on.
#define ARITHMETIC(X)                                                       \
    X(0, SUM, "a + b")                                                      \
    X(1, DIFFERENCE, "a - b")                                               \
    X(2, PRODUCT, "a * b")                                                  \
    X(3, QUOTIENT, "a / b")                                                 \
    X(4, ROOT, "sqrt(|a|)")                                                 \
    X(5, AREA, "edge_function((a, b), (c, d)): a d - b c, three roundings") \
    X(6, SUM_ERROR, "what a + b is off by: Knuth's two-sum")                \
    X(7, PRODUCT_ERROR, "what a * b is off by: Dekker's two-product")       \
    X(8, COMPARED, "a with b: COMPARED_* bits, as a number")                \
    X(9, PRODUCT_COMPARED, "c * d with a, the same")

#define ARITHMETIC_COUNT 10

#define COMPARED_LESS 1u
#define COMPARED_LESS_EQUAL 2u
#define COMPARED_GREATER 4u
#define COMPARED_GREATER_EQUAL 8u
#define COMPARED_EQUAL 16u
#define COMPARED_NOT_EQUAL 32u
#define COMPARED_NOT_LESS 64u           // !(a < b)
#define COMPARED_NOT_GREATER_EQUAL 128u // !(a >= b)

// probe.comp: the specialization constant 0 says which of these to compute, without `precise`. Two results a case; the second is 0 where one
// is named.
#define FUNCTIONS(X)                             \
    X(0, MULTIPLY_ADD, "a * b + c")              \
    X(1, CANCEL, "(a + b) - b")                  \
    X(2, FMA, "fma(a, b, c)")                    \
    X(3, EXTREMES, "min(a, b), max(a, b)")       \
    X(4, CLAMP, "clamp(a, b, c)")                \
    X(5, CLASS, "isnan(a), isinf(a)")            \
    X(6, FRACT, "fract(a)")                      \
    X(7, INVERSE_ROOT, "inversesqrt(a)")         \
    X(8, LENGTH, "length(a, b, c)")              \
    X(9, NORMALIZE, "normalize(a, b, c).x")      \
    X(10, NARROW, "float(a), as bits")           \
    X(11, TO_INTEGER, "int(a), uint(a), as bits") \
    X(12, EXP, "exp2(a), exp(a)")                \
    X(13, LOG, "log2(a), log(a)")                \
    X(14, POW, "pow(a, b)")                      \
    X(15, SIN, "sin(a), cos(a)")                 \
    X(16, ATAN, "atan(a), atan(a, b)")           \
    X(17, ACOS, "acos(a), asin(a)")

// From this one on they are not in probe_fp64.comp.
#define FIRST_FUNCTION_OF_FP32 FUNCTION_TO_INTEGER

#ifdef GL_core_profile
#define X(number, id, text) const uint RESULT_##id = number;
ARITHMETIC(X)
#undef X
#define X(number, id, text) const uint FUNCTION_##id = number;
FUNCTIONS(X)
#undef X
#else
enum {
#define X(number, id, text) RESULT_##id = number,
    ARITHMETIC(X)
#undef X
#define X(number, id, text) FUNCTION_##id = number,
    FUNCTIONS(X)
#undef X
};
#endif

#endif
