// x^y for x >= 0, y >= 0, with 0^0 = 1 (pow leaves it undefined). In fp32 by the built-in pow, which Vulkan lets be wrong by hundreds of ulp, or where the knob
// says so by our own logarithm and exponential, to 4 ulp; in fp64, where GLSL has none, always by our own.
//
// log2 x: x = m·2^e with m in [√½, √2), log2 m = 2/ln 2 · artanh s, s = (m-1)/(m+1); artanh s = s + s³/3 + s⁵/5 + …, |s| < 0.1716.
// 2^z: the integer part of z by the exponent, the rest by Taylor's series of e^(f ln 2), |f| <= ½.
#ifndef POWER_GLSL
#define POWER_GLSL
#include "real.glsl"
#include "shared.h"

#ifdef FP64
// log2 of a normal x > 0; the series' first omitted term is below 2^-56.
double log2_double(double x) {
    uvec2 bits = unpackDouble2x32(x);
    int exponent = int(bits.y >> 20) - 1023;
    double m = packDouble2x32(uvec2(bits.x, (bits.y & 0xfffffu) | 0x3ff00000u));
    if (m > 1.4142135623730951lf) {
        m *= 0.5lf;
        exponent++;
    }
    double s = (m - 1.0lf) / (m + 1.0lf), s2 = s * s, sum = 1.0lf / 23.0lf;
    for (int k = 21; k > 0; k -= 2) sum = sum * s2 + 1.0lf / double(k);
    return double(exponent) + 2.0lf * s * sum * 1.4426950408889634lf;
}

// 2^z for -1000 <= z <= 1000.
double exp2_double(double z) {
    double whole = floor(z + 0.5lf), f = (z - whole) * 0.6931471805599453lf, sum = 1.0lf;
    for (int k = 14; k > 0; k--) sum = sum * f / double(k) + 1.0lf;
    return sum * packDouble2x32(uvec2(0u, uint(int(whole) + 1023) << 20));
}

double power(double x, double y) {
    if (y == 0.0lf) return 1.0lf;
    if (x < 1e-300lf) return 0.0lf;
    double z = y * log2_double(x);
    return z < -1000.0lf ? 0.0lf : exp2_double(min(z, 1000.0lf));
}
#else
// An unevaluated sum. 2^z to u = 2^-24 wants z = y·log2 x to some 2^-24, absolutely, and |z| is up to 149: fp32 has not enough digits for log2 x.
struct pair { float hi, lo; };

// a·b exactly, but for underflow. Halves of 12 bits are cut off by a mask, so that all four products are exact (T. J. Dekker, "A floating-point technique for
// extending the available precision", 1971).
pair product(float a, float b) {
    precise float ah = uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u), bh = uintBitsToFloat(floatBitsToUint(b) & 0xfffff000u);
    precise float al = a - ah, bl = b - bh;
    precise float p = a * b;
    precise float rest = (((ah * bh - p) + ah * bl) + al * bh) + al * bl;
    return pair(p, rest);
}

// log2 of x > 0 to a relative error of 2^-28 (measured; then x^y is right to 2.6 ulp). s is corrected by what its division left over (the derivative of artanh s
// is 1 + s² + …), so that the largest error is the rounding of the series behind its first term, 0.01 of the whole. Its first omitted term is below 2^-34.
pair log2_pair(float x) {
    float lift = x < 1.17549435e-38 ? 16777216.0 : 1.0; // denormals; 2^24
    uint bits = floatBitsToUint(x * lift);
    float exponent = float(int(bits >> 23) - 127 - (lift > 1.0 ? 24 : 0));
    float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
    if (m > 1.41421356) {
        m *= 0.5;
        exponent += 1.0;
    }
    precise float f = m - 1.0;              // exact
    precise float g = m + 1.0;
    precise float g_rest = m - (g - 1.0);   // exact: of the sum's rounding
    float s = f / g;
    pair sg = product(s, g);
    precise float s2 = s * s;
    precise float s_rest = (((f - sg.hi) - sg.lo) - s * g_rest) / g * (1.0 + s2);
    precise float series = s * (s2 * (1.0 / 3.0 + s2 * (1.0 / 5.0 + s2 * (1.0 / 7.0 + s2 * (1.0 / 9.0 + s2 * (1.0 / 11.0))))));
    const float c = 2.88539004, c_rest = 3.85192598e-8;  // 2/ln 2
    pair first = product(c, s);
    precise float sum = exponent + first.hi;
    precise float sum_rest = first.hi - (sum - exponent);
    precise float rest = sum_rest + (first.lo + (c_rest * s + c * (s_rest + series)));
    precise float hi = sum + rest;
    precise float lo = rest - (hi - sum);
    return pair(hi, lo);
}

// 2^(z.hi + z.lo) for -151 < z < 129; the first omitted term of the series is below 2^-27.
float exp2_pair(pair z) {
    float whole = floor(z.hi + 0.5);
    precise float x = ((z.hi - whole) + z.lo) * 0.693147181;
    precise float sum = 1.0 + x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0)))))));
    int exponent = int(whole), first = clamp(exponent, -126, 127);
    return sum * uintBitsToFloat(uint(first + 127) << 23) * uintBitsToFloat(uint(exponent - first + 127) << 23);
}

// For x > 0. Beyond 2^34 a larger y changes nothing: x^y is 0, 1 or infinite.
float power_own(float x, float y) {
    y = min(y, 17179869184.0);
    pair l = log2_pair(x), z = product(y, l.hi);
    z.lo += y * l.lo;
    if (z.hi < -150.5) return 0.0;
    return z.hi > 128.5 ? uintBitsToFloat(0x7f800000u) : exp2_pair(z);
}

float power(float x, float y) { return y == 0.0 ? 1.0 : x > 0.0 ? (CHOSEN_POWER == POWER_OWN ? power_own(x, y) : pow(x, y)) : 0.0; }
#endif

#endif
