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

#endif
