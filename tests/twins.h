// One GLSL source as two kernels, fp32 and fp64, run on the same numbers, which are given as doubles. The kernels take cases.glsl in; that
// of fp64 is named <name>_fp64. And random numbers to run them on.
#ifndef TESTS_TWINS_H
#define TESTS_TWINS_H

#include "fixture.h"

#include <math.h>

struct twins {
    const char *name;
    const uint32_t *spirv[2];   // fp32, fp64
    size_t spirv_size[2];       // bytes
    uint32_t in, out;           // numbers of a case
    const struct kernel_binding *bindings;  // besides the numbers
    size_t binding_count;
};

// The kernels of which "<name>.h" and "<name>_fp64.h" are included, in the initializer of a struct twins.
#define TWINS(kernel)                                                                                                                      \
    .name = #kernel, .spirv = {kernel_##kernel, kernel_##kernel##_fp64},                                                                   \
    .spirv_size = {sizeof kernel_##kernel, sizeof kernel_##kernel##_fp64}

static inline void twins_run_words(const struct twins *twins, bool fp64, const void *in, size_t in_bytes, void *out, size_t out_bytes,
                                   uint32_t count) {
    struct device *device = fixture_device();
    struct buffer given, results;
    struct kernel kernel;
    struct kernel_binding bindings[KERNEL_BINDINGS] = {{.binding = 0, .buffer = &given}, {.binding = 1, .buffer = &results}};
    for (size_t i = 0; i < twins->binding_count; i++) bindings[2 + i] = twins->bindings[i];
    const struct buffer_params in_params = {.name = "in", .kind = BUFFER_STORAGE, .size = in_bytes, .host_writes = true};
    const struct buffer_params out_params = {.name = "out", .kind = BUFFER_STORAGE, .size = out_bytes, .host_reads = true};
    const struct kernel_params params = {.name = twins->name,
                                         .spirv = twins->spirv[fp64],
                                         .spirv_size = twins->spirv_size[fp64],
                                         .bindings = bindings,
                                         .binding_count = 2 + twins->binding_count,
                                         .push_size = sizeof count};
    fixture_assert(buffer_init(&given, fixture_context(), device, &in_params));
    fixture_assert(buffer_init(&results, fixture_context(), device, &out_params));
    fixture_assert(buffer_upload(&given, fixture_context(), device, in, in_bytes));
    fixture_assert(kernel_init(&kernel, fixture_context(), device, &params));
    fixture_assert(kernel_run(&kernel, fixture_context(), device, &count, (count + 63) / 64, NULL));
    fixture_assert(buffer_download(&results, fixture_context(), device, out, out_bytes));
    kernel_finish(&kernel, device);
    buffer_finish(&results, device);
    buffer_finish(&given, device);
    fixture_assert(device_validated(device, fixture_context()));
}

// Runs one of them: `in` holds count × twins->in numbers, which fp32 rounds, `out` count × twins->out.
static inline void twins_run(const struct twins *twins, bool fp64, const double *in, double *out, uint32_t count) {
    size_t ins = (size_t)count * twins->in, outs = (size_t)count * twins->out;
    if (fp64) {
        twins_run_words(twins, true, in, ins * sizeof *in, out, outs * sizeof *out, count);
        return;
    }
    float *numbers = malloc((ins + outs) * sizeof *numbers);
    assert_non_null(numbers);
    for (size_t i = 0; i < ins; i++) numbers[i] = (float)in[i];
    twins_run_words(twins, false, numbers, ins * sizeof *numbers, numbers + ins, outs * sizeof *numbers, count);
    for (size_t i = 0; i < outs; i++) out[i] = numbers[ins + i];
    free(numbers);
}

// How many kernels of a pair the device runs: fp32 alone, or fp64, too.
static inline int twins_count(void) { return fixture_device()->has_fp64 ? 2 : 1; }

// M. E. O'Neill's PCG, XSH-RR.
static inline uint32_t random_bits(void) {
    static uint64_t state;
    state = state * 6364136223846793005u + 1442695040888963407u;
    uint32_t folded = (uint32_t)((state >> 18 ^ state) >> 27), by = (uint32_t)(state >> 59);
    return folded >> by | folded << (-by & 31);
}

// In [low, high), of 53 bits.
static inline double random_in(double low, double high) {
    return low + (high - low) * (random_bits() * 0x1p-32 + (random_bits() >> 11) * 0x1p-53);
}

static inline void random_direction(double v[3]) {
    double length2;
    do {
        for (int i = 0; i < 3; i++) v[i] = random_in(-1, 1);
        length2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    } while (length2 > 1 || length2 < 0.01);
    for (int i = 0; i < 3; i++) v[i] /= sqrt(length2);
}

#endif
