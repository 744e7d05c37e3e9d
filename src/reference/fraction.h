// The t of a hit as an exact number, (p + root·√f) / m, and how two of them compare: by signs and squares, no root is taken.
#ifndef REFERENCE_FRACTION_H
#define REFERENCE_FRACTION_H

#include "reference/exact.h"

struct fraction {
    struct exact p;
    struct exact m; // > 0
    struct exact f; // >= 0; not read where root is 0
    int root;       // -1, 0 or 1
};

// The sign of a - b.
int fraction_compare(const struct fraction *a, const struct fraction *b);

// The sign of a - x, for an x that exact_holds.
int fraction_compare_number(const struct fraction *a, double x);

#endif
