// The cases of arithmetic.h: numbers in, results out, as bits, so that nothing on the way rounds, flushes or mends them.
#ifndef CASES_GLSL
#define CASES_GLSL
#include "arithmetic.h"
#include "real.glsl"

#ifdef FP64
#define WORD uvec2
#else
#define WORD uint
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform push { uint case_count; };
layout(set = 0, binding = 0) readonly buffer given_buffer { WORD given[]; };
layout(set = 0, binding = 1) writeonly buffer result_buffer { WORD results[]; };

#ifdef FP64
real number_of(uvec2 word) { return packDouble2x32(word); }
uvec2 word_of(real number) { return unpackDouble2x32(number); }
#else
real number_of(uint word) { return uintBitsToFloat(word); }
uint word_of(real number) { return floatBitsToUint(number); }
#endif

#endif
