// A ray and what it hits, in device units.
//
// A ray is brought to a safe scale when it is made: its direction is multiplied by the power of two that brings the largest component into
// [1, 2). That is exact, and keeps products of a predicate away from overflow and underflow, whatever the caller's units; box.glsl counts on it, too.
#ifndef RAY_GLSL
#define RAY_GLSL
#include "real.glsl"
#include "shared.h"

// The primitive that a ray leaves: it is not hit again where it starts. SELF_NONE for rays from nowhere.
#define SELF_NONE 0xffffffffu
#define SELF_SPHERE 0x80000000u     // or-ed to the number of a sphere; else a triangle's

struct ray {
    real3 o;
    real3 d;             // largest component in [1, 2)
    real tmin, tmax;   // open interval, in units of d
    int exponent;      // d is the direction that was given, times 2^-exponent
    uint self;
    int target_object, target_index; // what lies at the ray's end, a light: it is not hit. Object -1: nothing; index -1: all of the object
    float time;        // 0 when the shutter opens, below 1
};

struct hit {
    real t, u, v;      // +inf, 0, 0 for a miss; t in units of the ray's d
    uint primitive;     // SELF_NONE for a miss; else as `self` above: number in leaf order
    int object, index;  // object, and the primitive's number in it; -1 for a miss
};

hit hit_none() { return hit(INFINITY, 0.0, 0.0, SELF_NONE, -1, -1); }

bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool is_finite(vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
// A device may take it for zero.
bool is_denormal(vec3 v) {
    uvec3 bits = floatBitsToUint(v) & 0x7fffffffu;
    return any(lessThan(bits - 1u, uvec3(0x007fffffu)));
}
#ifdef FP64
bool is_finite(double x) { return abs(x) <= 1.797e308lf; }
#endif

real length_of(real3 v) { return sqrt(dot(v, v)); }

// 2^exponent for -126 <= exponent <= 127.
float power_of_two(int exponent) { return uintBitsToFloat(uint(exponent + 127) << 23); }

// Exponent of |x|, x normal: 2^e <= |x| < 2^(e+1). Zero and denormals give -127.
int exponent_of(float x) { return int((floatBitsToUint(x) >> 23) & 0xffu) - 127; }

#ifdef FP64
// 2^exponent for -1022 <= exponent <= 1023.
double power_of_two_double(int exponent) { return packDouble2x32(uvec2(0u, uint(exponent + 1023) << 20)); }
#define power_of_two_real power_of_two_double
#else
#define power_of_two_real power_of_two
#endif

// x·2^exponent for |exponent| <= 378, in three steps: none of them leaves the range of numbers unless the product does.
real times_power_of_two(real x, int exponent) {
    int first = exponent / 3, second = (exponent - first) / 2;
    return ((x * power_of_two_real(first)) * power_of_two_real(second)) * power_of_two_real(exponent - first - second);
}

// A ray through o (device units) along d (any scale, not zero, finite), for t in units of d as given. It has no target, and its time is 0.
#ifdef FP64
ray ray_make(dvec3 o, dvec3 d, double tmin, double tmax, uint self) {
    double largest = max(abs(d.x), max(abs(d.y), abs(d.z)));
    int exponent = clamp(int((unpackDouble2x32(largest).y >> 20) & 0x7ffu) - 1023, -1000, 1000);
    double up = power_of_two_double(-exponent), down = power_of_two_double(exponent);
    return ray(o, d * up, tmin * down, tmax * down, exponent, self, -1, -1, 0.0);
}
#else
ray ray_make(vec3 o, vec3 d, float tmin, float tmax, uint self) {
    float largest = max(abs(d.x), max(abs(d.y), abs(d.z)));
    int lift = 0;
    if (largest < 1.2e-38) { // denormal: two steps
        lift = 100;
        d *= power_of_two(lift);
        largest *= power_of_two(lift);
    }
    int exponent = clamp(exponent_of(largest), -126, 126);
    d *= power_of_two(-exponent);
    exponent -= lift;
    return ray(o, d, times_power_of_two(tmin, exponent), times_power_of_two(tmax, exponent), exponent, self, -1, -1, 0.0);
}
#endif

#endif
