// Vectors in double, and a sine and cosine that give the same bits everywhere.
//
// Only +, −, ×, ÷ and √ are used, which IEEE 754 rounds correctly: the committed meshes can be compared byte by byte on any machine,
// whatever its C library's sin() does in the last place.
#ifndef MESHGEN_VEC_H
#define MESHGEN_VEC_H

#include <math.h>

#define PI 3.14159265358979323846

struct v2 {
    double x, y;
};
struct v3 {
    double x, y, z;
};

static inline struct v3 v3(double x, double y, double z) { return (struct v3){x, y, z}; }
static inline struct v3 v3_add(struct v3 a, struct v3 b) { return v3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline struct v3 v3_sub(struct v3 a, struct v3 b) { return v3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline struct v3 v3_scale(struct v3 a, double s) { return v3(a.x * s, a.y * s, a.z * s); }
// a + s·b
static inline struct v3 v3_mad(struct v3 a, double s, struct v3 b) { return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z); }
static inline double v3_dot(struct v3 a, struct v3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline struct v3 v3_cross(struct v3 a, struct v3 b) {
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
// The zero vector stays zero.
static inline struct v3 v3_unit(struct v3 a) {
    double length = sqrt(v3_dot(a, a));
    return length > 0 ? v3_scale(a, 1 / length) : a;
}

static inline struct v2 v2(double x, double y) { return (struct v2){x, y}; }
static inline struct v2 v2_add(struct v2 a, struct v2 b) { return v2(a.x + b.x, a.y + b.y); }
static inline struct v2 v2_sub(struct v2 a, struct v2 b) { return v2(a.x - b.x, a.y - b.y); }
static inline struct v2 v2_mad(struct v2 a, double s, struct v2 b) { return v2(a.x + s * b.x, a.y + s * b.y); }
static inline double v2_dot(struct v2 a, struct v2 b) { return a.x * b.x + a.y * b.y; }
static inline double v2_cross(struct v2 a, struct v2 b) { return a.x * b.y - a.y * b.x; }
static inline struct v2 v2_unit(struct v2 a) {
    double length = sqrt(v2_dot(a, a));
    return length > 0 ? v2(a.x / length, a.y / length) : a;
}
// A quarter turn to the left.
static inline struct v2 v2_left(struct v2 a) { return v2(-a.y, a.x); }

// (cos, sin) of an angle in turns: 0.25 is a right angle. Quarter turns are exact. Taylor series to x^17 within an eighth of a turn:
// the first term left out is below 1e-18.
static inline struct v2 circle(double turns) {
    double quarter = floor(4 * turns + 0.5);
    double x = (turns - quarter / 4) * (2 * PI), xx = x * x, sine = 1, cosine = 1;
    for (int k = 16; k >= 2; k -= 2) {
        sine = 1 - xx / (k * (k + 1)) * sine;
        cosine = 1 - xx / (k * (k - 1)) * cosine;
    }
    sine *= x;
    switch ((int)(quarter - 4 * floor(quarter / 4))) {
    case 0:
        return v2(cosine, sine);
    case 1:
        return v2(-sine, cosine);
    case 2:
        return v2(-cosine, -sine);
    default:
        return v2(sine, -cosine);
    }
}

// Point and tangent of a cubic Bézier curve, by its Bernstein form.
struct bezier2 {
    struct v2 point, tangent;
};
static inline struct bezier2 bezier2(const struct v2 c[4], double t) {
    double s = 1 - t, b[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t}, d[3] = {3 * s * s, 6 * s * t, 3 * t * t};
    struct bezier2 out = {{0, 0}, {0, 0}};
    for (int k = 0; k < 4; k++) out.point = v2_mad(out.point, b[k], c[k]);
    for (int k = 0; k < 3; k++) out.tangent = v2_mad(out.tangent, d[k], v2_sub(c[k + 1], c[k]));
    return out;
}

#endif
