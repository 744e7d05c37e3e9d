// What a device makes of expressions that it may rearrange, and of GLSL's functions: one of them in each kernel, so that none borrows from
// another. Included by probe.comp, and with FP64 defined by probe_fp64.comp.
#ifndef PROBE_GLSL
#define PROBE_GLSL
#include "cases.glsl"

layout(constant_id = 0) const uint FUNCTION = FUNCTION_MULTIPLY_ADD;

#ifndef FP64
real2 function_of_fp32(real a, real b) {
    switch (FUNCTION) {
    case FUNCTION_TO_INTEGER: return vec2(intBitsToFloat(int(a)), uintBitsToFloat(uint(a)));
    case FUNCTION_EXP: return vec2(exp2(a), exp(a));
    case FUNCTION_LOG: return vec2(log2(a), log(a));
    case FUNCTION_POW: return vec2(pow(a, b), 0.0);
    case FUNCTION_SIN: return vec2(sin(a), cos(a));
    case FUNCTION_ATAN: return vec2(atan(a), atan(a, b));
    case FUNCTION_ACOS: return vec2(acos(a), asin(a));
    }
    return vec2(0.0);
}
#endif

real2 function_of(real a, real b, real c) {
    switch (FUNCTION) {
    case FUNCTION_MULTIPLY_ADD: return real2(a * b + c, 0.0);
    case FUNCTION_CANCEL: return real2((a + b) - b, 0.0);
    case FUNCTION_FMA: return real2(fma(a, b, c), 0.0);
    case FUNCTION_EXTREMES: return real2(min(a, b), max(a, b));
    case FUNCTION_CLAMP: return real2(clamp(a, b, c), 0.0);
    case FUNCTION_CLASS: return real2(isnan(a), isinf(a));
    case FUNCTION_FRACT: return real2(fract(a), 0.0);
    case FUNCTION_INVERSE_ROOT: return real2(inversesqrt(a), 0.0);
    case FUNCTION_LENGTH: return real2(length(real3(a, b, c)), 0.0);
    case FUNCTION_NORMALIZE: return real2(normalize(real3(a, b, c)).x, 0.0);
    }
#ifdef FP64
    // As bits: a compiler may take the way there and back for none at all (Mesa 25.0 does).
    return real2(packDouble2x32(uvec2(floatBitsToUint(float(a)), 0u)), 0.0);
#else
    return function_of_fp32(a, b);
#endif
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= case_count) return;
    real2 value = function_of(number_of(given[4u * number]), number_of(given[4u * number + 1u]), number_of(given[4u * number + 2u]));
    results[2u * number] = word_of(value.x);
    results[2u * number + 1u] = word_of(value.y);
}

#endif
