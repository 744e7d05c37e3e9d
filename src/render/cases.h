// Cases for the kernels of shaders/arithmetic.h: four numbers each, and what a device makes of them. fp32 numbers are held in doubles, too.
#ifndef RENDER_CASES_H
#define RENDER_CASES_H

#include "device/device.h"
#include "shaders/arithmetic.h"

struct cases {
    bool fp64; // the numbers' type on the device
    uint32_t capacity, count;
    uint32_t result_count; // of a case, as the last run left them
    double (*given)[4];    // a, b, c, d
    void *results;         // words of the device: uint32_t, or uint64_t for fp64
};

bool cases_init(struct cases *out, struct context *ctx, bool fp64, uint32_t capacity);
void cases_finish(struct cases *cases);

// Appends one; the numbers are rounded to fp32 where that is the type. Does nothing when the capacity is reached.
void cases_add(struct cases *cases, double a, double b, double c, double d);

// Runs arithmetic.comp (with what the kernels of the exact tier declare) or the FUNCTION_* of probe.comp over them. Needs a device with
// doubles for fp64.
bool cases_run_arithmetic(struct cases *cases, struct context *ctx, struct device *device);
bool cases_run_function(struct cases *cases, struct context *ctx, struct device *device, uint32_t function);

// Result `which` of case i: as a number, and as its bits.
double cases_result(const struct cases *cases, uint32_t i, uint32_t which);
uint64_t cases_bits(const struct cases *cases, uint32_t i, uint32_t which);

#endif
