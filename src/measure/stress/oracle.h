// The exact answer to a ray, in GMP: right-answer.md taken literally, over every primitive of a small world. Shares nothing with what
// it judges.
//
// Every fp32 number times 2^149 is an integer, and every expression here is homogeneous, so that integers are enough. Triangles that
// fp64, with a bound on its error, can rule out are not looked at more closely; `plain` switches that off, to judge the judge.
#ifndef MEASURE_STRESS_ORACLE_H
#define MEASURE_STRESS_ORACLE_H

#include "measure/stress/world.h"

struct oracle_answer {
    bool valid; // false: the ray is to be flagged, and misses
    bool hit;
    int32_t object, primitive; // -1 for a miss
    double t, u, v;            // the exact values to 2^-50 relative; +inf, 0, 0 for a miss
};

#define ORACLE_NO_SELF UINT32_MAX

struct oracle_params {
    const uint32_t *self; // by ray: the primitive that it starts on, a triangle's number or triangle_count + a sphere's, or ORACLE_NO_SELF.
                          // The triangle is not hit again, the sphere at its other root, t = 2 (c-o)·d / d·d, alone [none]
    bool plain;           // integers for every primitive
    unsigned threads;     // [1]
};

// Answers the world's rays: answers[0 … ray_count).
bool oracle_answer(struct oracle_answer *answers, struct context *ctx, const struct world *world, const struct oracle_params *params);

// How many times the ray crosses anything in its interval; a point where it touches a sphere counts once.
uint32_t oracle_crossings(const struct world *world, const struct gn_ray *ray);

// The sign of the edge function f(p, q) of a ray, +1 or -1, or 0 where p, q and d are such that even the infinitesimal displacement
// decides nothing.
int oracle_edge_sign(const float o[3], const float d[3], const float p[3], const float q[3]);

// Whether the closed ray (tmin <= t <= tmax) touches the closed box.
bool oracle_box(const float box_min[3], const float box_max[3], const struct gn_ray *ray);

// How far `got` is from the right value in units of the last fp32 place of that; +inf where one of them is not finite and the other is.
// A right value that is nearer to infinity than to any fp32 number is infinite.
double oracle_ulps(double got, double right);

#endif
