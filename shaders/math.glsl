// Sines, arcs, exponentials and logarithms of our own, in fp32 and fp64: GLSL has none in fp64, and Vulkan lets the fp32 ones be off by
// thousands of ulp.
//
// The argument is brought to a small one by operations that are exact; Taylor's series do the rest, all but its first term a small share of
// the result. Errors, in fp32 as in fp64: 2 ulp for sine and cosine, 4 for the arc, 2 for exponential and logarithm. That is with divisions
// that are right to 1 ulp; the 2.5 that Vulkan allows add up to 4 to the arc. Angles are in turns, so that whole turns are whole numbers
// and no digits of π are needed. Denormal results may be 0. NaN gives anything, but never a hang.
#ifndef MATH_GLSL
#define MATH_GLSL
#include "ray.glsl"

// Head and tail of constants: TAU = 2π, ARC = 1/2π, LN2 = ln 2 (its head has so few bits that its product with an exponent is exact). Then
// the series: of sine, (sin 2πr - 2πr)/r³ in r²; of cosine, (cos 2πr - 1)/r²; of the arc, (arctan z - z)/2πz³ in z²; of the exponential,
// (e^f - 1 - f)/f² in f; of the logarithm, (2 artanh s - 2s)/s³ in s². First terms omitted: 0.1 ulp at most.
#ifdef FP64
const double TAU = 6.283185307179586lf, TAU_TAIL = 2.449293598294706e-16lf;
const double ARC = 0.15915494309189535lf, ARC_TAIL = -9.839338337591243e-18lf;
const double LN2 = 0.6931471803691238lf, LN2_TAIL = 1.9082149292705878e-10lf, INVERSE_LN2 = 1.4426950408889634lf;
const double LOWEST_EXPONENT = -746.0lf, HIGHEST_EXPONENT = 710.0lf, SMALLEST_NORMAL = 2.2250738585072014e-308lf;

double sine_series(double x) {
    return -41.341702240399760lf + x * (81.605249276075054lf + x * (-76.705859753061385lf +
           x * (42.058693944897653lf + x * (-15.094642576822990lf + x * (3.8199525848482821lf +
           x * (-0.71812230177850051lf + x * 0.10422916220813984lf))))));
}

double cosine_series(double x) {
    return -19.739208802178717lf + x * (64.939394022668291lf + x * (-85.456817206693728lf + x * (60.244641371876660lf +
           x * (-26.426256783374397lf + x * (7.9035363713184688lf + x * (-1.7143906887106721lf +
           x * (0.28200596845579122lf + x * -0.036382841142545671lf)))))));
}

double arc_series(double x) {
    double far = 0.0045472840883398667lf - x * (0.0043014844349484297lf - x * (0.0040808959767126502lf - x * (0.0038818278802901301lf -
                 x * 0.0037012776963231473lf)));
    far = 0.0063661976837236758lf - x * (0.0058946275319220495lf - x * (0.0054881014859274254lf - x * (0.0051340304223192044lf -
          x * (0.0048228770633907678lf - x * far))));
    far = 0.0106103295394596891lf - x * (0.0093620554759938433lf - x * (0.0083765759522050177lf - x * (0.0075788068138997779lf -
          x * (0.0069197801343302320lf - x * far))));
    return -0.053051647697298445lf + x * (0.031830988618379067lf - x * (0.022736420441699334lf - x * (0.017683882565766148lf -
           x * (0.014468631190172303lf - x * (0.012242687930145796lf - x * far)))));
}

double exponential_series(double x) {
    double far = 1.9841269841269841e-4lf + x * (2.4801587301587302e-5lf + x * (2.7557319223985891e-6lf + x * (2.7557319223985891e-7lf +
                 x * (2.5052108385441719e-8lf + x * (2.0876756987868099e-9lf + x * 1.6059043836821615e-10lf)))));
    return 0.5lf + x * (0.16666666666666667lf + x * (0.041666666666666667lf + x * (0.0083333333333333333lf +
           x * (0.0013888888888888889lf + x * far))));
}

double logarithm_series(double x) {
    double far = 0.13333333333333333lf + x * (0.11764705882352941lf + x * (0.10526315789473684lf + x * (0.095238095238095238lf +
                 x * (0.086956521739130435lf + x * 0.08lf))));
    return 0.66666666666666667lf + x * (0.4lf + x * (0.28571428571428571lf + x * (0.22222222222222222lf + x * (0.18181818181818182lf +
           x * (0.15384615384615385lf + x * far)))));
}

// x = m·2^exponent with 1 <= m < 2, for a normal x > 0.
double mantissa_of(double x, out double exponent) {
    uvec2 bits = unpackDouble2x32(x);
    exponent = double(int(bits.y >> 20) - 1023);
    return packDouble2x32(uvec2(bits.x, (bits.y & 0xfffffu) | 0x3ff00000u));
}
#else
const float TAU = 6.28318548, TAU_TAIL = -1.7484556e-7;
const float ARC = 0.159154937, ARC_TAIL = 6.4206214e-9;
const float LN2 = 0.693145751953125, LN2_TAIL = 1.42860682e-6, INVERSE_LN2 = 1.44269504;
const float LOWEST_EXPONENT = -104.0, HIGHEST_EXPONENT = 89.0, SMALLEST_NORMAL = 1.17549435e-38;

float sine_series(float x) { return -41.3417022 + x * (81.6052493 + x * (-76.7058598 + x * 42.0586939)); }
float cosine_series(float x) { return -19.7392088 + x * (64.9393940 + x * (-85.4568172 + x * (60.2446414 + x * -26.4262568))); }
float arc_series(float x) {
    return -0.0530516477 + x * (0.0318309886 - x * (0.0227364204 - x * (0.0176838826 - x * (0.0144686312 - x * (0.0122426879 -
           x * (0.0106103295 - x * 0.00936205548))))));
}
float exponential_series(float x) {
    return 0.5 + x * (0.166666667 + x * (0.0416666667 + x * (0.00833333333 + x * (0.00138888889 + x * 0.000198412698))));
}
float logarithm_series(float x) { return 0.666666667 + x * (0.4 + x * (0.285714286 + x * (0.222222222 + x * 0.181818182))); }

// x = m·2^exponent with 1 <= m < 2, for a normal x > 0.
float mantissa_of(float x, out float exponent) {
    uint bits = floatBitsToUint(x);
    exponent = float(int(bits >> 23) - 127);
    return uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
}
#endif

// (sin, cos) of 2πx, x finite. The nearest quarter turn k/4 is taken away, |r| <= 1/8: k comes from the number of the eighth, which is
// exact, and so is x - k/4, since either k is 0 or they are within a factor of 2 of each other. At whole quarters the result is exactly 0
// or ±1.
real2 sincos_turns(real x) {
    precise real within = abs(x) - floor(abs(x));
    int quarter = (int(floor(within * 8.0)) + 1) >> 1;
    precise real r = within - real(quarter) * 0.25;
    real r2 = r * r;
    precise real sine = r * TAU + r * (TAU_TAIL + r2 * sine_series(r2));
    precise real cosine = 1.0 + r2 * cosine_series(r2);
    real s = (quarter & 1) == 0 ? sine : cosine, c = (quarter & 1) == 0 ? cosine : sine;
    s = (quarter & 2) == 0 ? s : -s;
    c = ((quarter + 1) & 2) == 0 ? c : -c;
    return real2(x < 0.0 ? -s : s, c);
}

// The angle of (x, y), both finite, in turns from -1/2 to 1/2; 0 for (0, 0) and, on some devices, for denormals. The half-line x < 0, y =
// ±0 is at +1/2; -1/2 is where an angle rounds to, no more. For tan w = b/a, 0 <= b <= a, tan(w - π/4) = (b - a)/(b + a), which is used
// where b - a loses nothing to speak of.
real atan2_turns(real y, real x) {
    real largest = max(abs(x), abs(y));
    real scale = largest < 1e-30 ? real(1.2676506e30) : largest > 1e30 ? real(7.8886091e-31) : real(1.0); // 2^±100
    real a = largest * scale, b = min(abs(x), abs(y)) * scale;
    bool upper = b > 0.41421356 * a;
    real z = a > 0.0 ? (upper ? b - a : b) / (upper ? b + a : a) : real(0.0);
    real z2 = z * z;
    real series = z * (ARC_TAIL + z2 * arc_series(z2));
    precise real near = upper ? (series + z * ARC) + 0.125 : z * ARC + series;
    real w = abs(y) > abs(x) ? 0.25 - near : near;
    w = x < 0.0 ? 0.5 - w : w;
    return y < 0.0 ? -w : w;
}

// e^x; infinite beyond the range, 0 below it.
real exponential(real x) {
    real within = clamp(x, LOWEST_EXPONENT, HIGHEST_EXPONENT);
    real power = floor(within * INVERSE_LN2 + 0.5);
    precise real f = (within - power * LN2) - power * LN2_TAIL;
    precise real value = 1.0 + (f + f * f * exponential_series(f));
    return times_power_of_two(value, int(power));
}

// The natural logarithm of x > 0; -∞ for x <= 0. With m = 1 + f and s = f/(2 + f), ln m = 2 artanh s = f - s·(f - s²·series(s²)), where 2s
// = f - s·f.
real logarithm(real x) {
    bool denormal = x < SMALLEST_NORMAL;
    real power;
    real m = mantissa_of(denormal ? x * 1.152921504606847e18 : x, power); // 2^60
    bool upper = m > 1.4142135;
    m = upper ? m * 0.5 : m;
    power += (upper ? 1.0 : 0.0) - (denormal ? 60.0 : 0.0);
    real f = m - 1.0, s = f / (2.0 + f), s2 = s * s;
    precise real rest = s * (f - s2 * logarithm_series(s2));
    precise real value = power * LN2 + (f - (rest - power * LN2_TAIL));
    return x > 0.0 ? (x < INFINITY ? value : x) : -INFINITY;
}

#endif
