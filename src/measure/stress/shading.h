// Functions of stress_shading.comp against their right answers, or what must hold of whatever they give.
#ifndef MEASURE_STRESS_SHADING_H
#define MEASURE_STRESS_SHADING_H

#include "measure/stress/job.h"

#define FP32_UNIT 0x1p-24 // roundoff

// Arguments, right answers and how far from them fp32 may be; a slack below 0: any number.
struct shading_case {
    float in[STRESS_SHADING_IN];
    double right[STRESS_SHADING_OUT], slack[STRESS_SHADING_OUT];
};

// A function, the effects that it is compiled with, cases for it, and what holds of in and out beside the right answers [nothing].
struct shading {
    uint32_t what, effects;
    void (*make)(struct shading_case *out, struct random *random, uint32_t i);
    bool (*holds)(const float *in, const float *out);
};

// In fp32, where fast, robust and exact run the same code, and in fp64, whose results come rounded to fp32.
bool run_shading(struct stress *s, const struct shading *shading);

void expect(struct shading_case *out, int k, double right, double slack);

double dot_of(const float a[3], const float b[3]);
bool is_unit(const float v[3], double slack);

// A unit vector, rounded; on the side of n unless that is NULL, with a cosine of at least `least`.
void unit_about(float out[3], struct random *random, const float *n, double least);

#endif
