// x^y for x >= 0, y >= 0, with 0^0 = 1 (pow leaves it undefined); in fp64 by our own logarithm and exponential, which GLSL does not have.
#ifndef POWER_GLSL
#define POWER_GLSL
#include "real.glsl"

#ifdef FP64
// log2 of a normal x > 0: x = m·2^e with m in [√½, √2), log m = 2 artanh((m-1)/(m+1)); the series' first omitted term is below 2^-56.
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

// 2^z for -1000 <= z <= 1000: the integer part by the exponent, the rest by Taylor's series.
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
float power(float x, float y) { return y == 0.0 ? 1.0 : x > 0.0 ? pow(x, y) : 0.0; }
#endif

#endif
