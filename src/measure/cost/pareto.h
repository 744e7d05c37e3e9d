// The Pareto front: of some points with a time and an error, those that no other beats in both.
#ifndef MEASURE_PARETO_H
#define MEASURE_PARETO_H

#include <stdbool.h>
#include <stddef.h>

struct pareto_point {
    double time, error; // less is better; NaN or infinite: never on the front
    bool front;         // the result
};

// Sets `front` of points[0 … count): no other point is as fast and as close, and better in one of the two. What differs by a factor of `same`
// (1 or more) at most counts as equal, so that noise puts nobody off the front; of equal points all are on it.
void pareto_mark(struct pareto_point *points, size_t count, double same);

#endif
