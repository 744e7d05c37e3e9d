#include "measure/cost/pareto.h"

#include <math.h>

#include "measure/cost/cost.h"

// Times that differ by less than this factor are the same, as far as rounds on a busy machine can tell.
#define NOISE 1.05

// Never in a circle: each step of one would make the product of time and error smaller.
static bool beats(const struct pareto_point *a, const struct pareto_point *b, double same) {
    bool no_worse = a->time <= same * b->time && a->error <= same * b->error;
    return no_worse && (same * a->time < b->time || same * a->error < b->error);
}

void pareto_mark(struct pareto_point *points, size_t count, double same) {
    for (size_t i = 0; i < count; i++) {
        points[i].front = isfinite(points[i].time) && isfinite(points[i].error);
        for (size_t k = 0; k < count && points[i].front; k++) points[i].front = !beats(&points[k], &points[i], same);
    }
}

void cost_mark_pareto(struct cost *cost) {
    for (int front = 0; front < COST_FRONTS; front++) {
        struct pareto_point points[COST_MOST_ROWS];
        uint32_t rows[COST_MOST_ROWS];
        size_t count = 0;
        for (uint32_t i = 0; i < cost->row_count; i++) {
            if (cost->rows[i].front != (enum cost_front)front) continue;
            const struct cost_run *run = &cost->runs[cost->rows[i].run];
            points[count] = (struct pareto_point){.time = run->median, .error = run->rmse};
            rows[count++] = i;
        }
        pareto_mark(points, count, NOISE);
        for (size_t i = 0; i < count; i++) cost->rows[rows[i]].pareto = points[i].front;
    }
}
