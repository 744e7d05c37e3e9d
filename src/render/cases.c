#include "render/cases.h"

#include <stdlib.h>
#include <string.h>

#include "device/kernel.h"
#include "kernels/arithmetic.h"
#include "kernels/arithmetic_fp64.h"
#include "kernels/probe.h"
#include "kernels/probe_fp64.h"
#include "render/kernels.h"
#include "shaders/shared.h"

enum { GIVEN = 4, FUNCTION_RESULTS = 2, MOST_RESULTS = ARITHMETIC_COUNT, CASES_OF_GROUP = 64 };

static size_t word_size(const struct cases *cases) { return cases->fp64 ? sizeof(uint64_t) : sizeof(uint32_t); }

bool cases_init(struct cases *out, struct context *ctx, bool fp64, uint32_t capacity) {
    *out = (struct cases){.fp64 = fp64, .capacity = capacity};
    out->given = array_alloc(ctx, capacity, sizeof *out->given, "cases");
    out->results = array_alloc(ctx, capacity, MOST_RESULTS * word_size(out), "results of cases");
    if (out->given && out->results) return true;
    cases_finish(out);
    return false;
}

void cases_finish(struct cases *cases) {
    free(cases->given);
    free(cases->results);
    *cases = (struct cases){0};
}

void cases_add(struct cases *cases, double a, double b, double c, double d) {
    if (cases->count >= cases->capacity) return;
    const double numbers[GIVEN] = {a, b, c, d};
    double *given = cases->given[cases->count++];
    for (int i = 0; i < GIVEN; ++i) given[i] = cases->fp64 ? numbers[i] : (double)(float)numbers[i];
}

double cases_result(const struct cases *cases, uint32_t i, uint32_t which) {
    const size_t at = (size_t)i * cases->result_count + which;
    float single;
    double number;
    memcpy(&single, (const char *)cases->results + at * sizeof single, sizeof single);
    if (!cases->fp64) return single;
    memcpy(&number, (const char *)cases->results + at * sizeof number, sizeof number);
    return number;
}

uint64_t cases_bits(const struct cases *cases, uint32_t i, uint32_t which) {
    const size_t at = (size_t)i * cases->result_count + which;
    return cases->fp64 ? ((const uint64_t *)cases->results)[at] : ((const uint32_t *)cases->results)[at];
}

// --------------------------------------------------------------------------------------------------------------- running

struct embedded {
    const char *name;
    const uint32_t *spirv;
    size_t size;
};

#define EMBEDDED(kernel)                                                                                                                   \
    { #kernel, kernel_##kernel, sizeof kernel_##kernel }
static const struct embedded ARITHMETIC_KERNELS[] = {EMBEDDED(arithmetic), EMBEDDED(arithmetic_fp64)};
static const struct embedded FUNCTION_KERNELS[] = {EMBEDDED(probe), EMBEDDED(probe_fp64)};

// The numbers as words of the device. Rounding a double that came from an fp32 gives that back, NaN and denormals too.
static bool fill_given(void *data, void *to, uint64_t offset, uint64_t size) {
    const struct cases *cases = data;
    const double *from = &cases->given[0][0] + offset / word_size(cases);
    if (cases->fp64) {
        memcpy(to, from, size);
        return true;
    }
    float *single = to;
    for (uint64_t i = 0; i < size / sizeof *single; ++i) single[i] = (float)from[i];
    return true;
}

static bool dispatch(struct cases *cases, struct context *ctx, struct device *device, struct kernel_params *params) {
    const size_t word = word_size(cases), given_size = cases->count * GIVEN * word, result_size = cases->count * cases->result_count * word;
    const struct buffer_params given_params = {.name = "cases", .kind = BUFFER_STORAGE, .size = given_size, .host_writes = true};
    const struct buffer_params result_params = {
        .name = "results of cases", .kind = BUFFER_STORAGE, .size = result_size, .host_reads = true};
    struct buffer given = {0}, results = {0};
    struct kernel kernel = {0};
    const struct kernel_binding bindings[] = {{.binding = 0, .buffer = &given}, {.binding = 1, .buffer = &results}};
    params->bindings = bindings;
    params->binding_count = sizeof bindings / sizeof *bindings;
    params->push_size = sizeof cases->count;
    const bool done = buffer_init(&given, ctx, device, &given_params) && buffer_init(&results, ctx, device, &result_params) &&
                      buffer_fill(&given, ctx, device, word, fill_given, cases) && kernel_init(&kernel, ctx, device, params) &&
                      kernel_run(&kernel, ctx, device, &cases->count, (cases->count + CASES_OF_GROUP - 1) / CASES_OF_GROUP, NULL) &&
                      buffer_download(&results, ctx, device, cases->results, result_size);
    kernel_finish(&kernel, device);
    buffer_finish(&results, device);
    buffer_finish(&given, device);
    return done;
}

bool cases_run_arithmetic(struct cases *cases, struct context *ctx, struct device *device) {
    const struct embedded *embedded = &ARITHMETIC_KERNELS[cases->fp64];
    struct kernel_params params = {.name = embedded->name,
                                   .spirv = embedded->spirv,
                                   .spirv_size = embedded->size,
                                   .float_controls = tier_float_controls(device, TIER_EXACT)};
    cases->result_count = ARITHMETIC_COUNT;
    return dispatch(cases, ctx, device, &params);
}

bool cases_run_function(struct cases *cases, struct context *ctx, struct device *device, uint32_t function) {
    const struct embedded *embedded = &FUNCTION_KERNELS[cases->fp64];
    const struct kernel_constant constant = {.id = 0, .value = function};
    struct kernel_params params = {
        .name = embedded->name, .spirv = embedded->spirv, .spirv_size = embedded->size, .constants = &constant, .constant_count = 1};
    cases->result_count = FUNCTION_RESULTS;
    return dispatch(cases, ctx, device, &params);
}
