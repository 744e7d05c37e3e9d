// The type of numbers that rays, hits and shading are computed in: fp32, or with FP64 defined fp64. One source serves both; the error bounds are multiples of the
// unit roundoff.
#ifndef REAL_GLSL
#define REAL_GLSL

#ifdef FP64
#define real double
#define real2 dvec2
#define real3 dvec3
#define real4 dvec4
#define REAL_UNIT 1.1102230246251565e-16lf      // 2^-53
#define REAL_TINY 6.4e-58lf                     // 2^-190: below it, bits may have been lost on the way (tier_exact.glsl)
#define REAL_LARGE 1e150lf                      // its square is finite
#define REAL_CUBE_LARGE 1e100lf                 // the product of three, times 100, is finite
#define REAL_SQRT_LARGE 1e75lf
#define REAL_MAX 1.79e308lf
#define INFINITY packDouble2x32(uvec2(0u, 0x7ff00000u))
#else
#define real float
#define real2 vec2
#define real3 vec3
#define real4 vec4
#define REAL_UNIT 5.9604644775390625e-8         // 2^-24
#define REAL_TINY 7.5231638e-37                 // 2^-120: below it, underflow may have lost bits
#define REAL_LARGE 1e18
#define REAL_CUBE_LARGE 1e12
#define REAL_SQRT_LARGE 1e9
#define REAL_MAX 3.4e38
#define INFINITY uintBitsToFloat(0x7f800000u)
#endif

#endif
