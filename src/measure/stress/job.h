// Pieces of the shaders run alone: numbers in, numbers out, one invocation a case.
#ifndef MEASURE_STRESS_JOB_H
#define MEASURE_STRESS_JOB_H

#include "measure/stress/row.h"
#include "render/kernels.h"
#include "render/upload.h"

// Zero fields are none.
struct job {
    enum kernel_name fp32, fp64; // the kernel, and the one for the tier fp64
    uint32_t tier;
    uint32_t effects; // EFFECT_* bits; what is absent is compiled out
    uint32_t count;   // invocations
    uint32_t what;    // STRESS_*, the function
    uint32_t power;   // position of the knob of that name [what the tier has]
    const float *in;  // in_each · count
    float *out;       // out_each · count; what the kernel does not write stays
    uint32_t in_each, out_each;
    struct device_scene *ds; // what rays are shot at
};

bool job_run(struct stress *s, const struct job *job);

#endif
