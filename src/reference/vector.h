// Three numbers as a direction or a color.
#ifndef REFERENCE_VECTOR_H
#define REFERENCE_VECTOR_H

#include <math.h>

static inline double vector_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Unit; a zero vector stays zero.
static inline void vector_normalize(double v[3]) {
    double length = sqrt(vector_dot(v, v));
    for (int i = 0; i < 3; i++) v[i] = length > 0 ? v[i] / length : 0;
}

// The unit vector between two unit ones; zero where there is none.
static inline void vector_half(double h[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) h[i] = a[i] + b[i];
    vector_normalize(h);
}

// The mirror image of a about the unit vector n.
static inline void vector_mirror(double r[3], const double n[3], const double a[3]) {
    double across = vector_dot(n, a);
    for (int i = 0; i < 3; i++) r[i] = 2 * across * n[i] - a[i];
    vector_normalize(r);
}

// Two unit vectors that make a frame with the unit vector n. T. Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
static inline void vector_tangents(double t[3], double b[3], const double n[3]) {
    double side = n[2] >= 0 ? 1 : -1, a = -1 / (side + n[2]), c = n[0] * n[1] * a;
    t[0] = 1 + side * n[0] * n[0] * a, t[1] = side * c, t[2] = -side * n[0];
    b[0] = c, b[1] = side + n[1] * n[1] * a, b[2] = -n[1];
}

// (sine·cos 2πv, sine·sin 2πv, cosine) in the frame of `axis`.
static inline void vector_around(double w[3], const double axis[3], double sine, double cosine, double v) {
    double t[3], b[3], angle = 2 * 3.14159265358979323846 * v, x = sine * cos(angle), y = sine * sin(angle);
    vector_tangents(t, b, axis);
    for (int i = 0; i < 3; i++) w[i] = x * t[i] + y * b[i] + cosine * axis[i];
    vector_normalize(w);
}

#endif
