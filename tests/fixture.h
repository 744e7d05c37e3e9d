// A device for tests, and a helper that runs a small kernel over arrays.
//
// The device is opened at the first use, with the validation layer if that is installed; a test that asks for it is skipped where there is
// none. Every program that uses it lists fixture_silent as its last test and passes fixture_close as group teardown. Kernels for
// fixture_run follow one convention: binding 0 is a storage buffer of inputs, binding 1 one of outputs, the push constant is {uint count},
// local_size_x is 64.
#ifndef TESTS_FIXTURE_H
#define TESTS_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Ours before cmocka's: that has a macro called fail. The function of base/context.h is called as (fail)(ctx, …) in tests.
#include "device/device.h"
#include "device/kernel.h"
#include "device/memory.h"

#include <cmocka.h>

struct fixture {
    struct device device;
    struct gn_error error;
    struct context ctx;
    bool open;
};

static inline struct fixture *fixture_state(void) {
    static struct fixture fixture;
    return &fixture;
}

// A context with no error in it.
static inline struct context *fixture_context(void) {
    struct fixture *f = fixture_state();
    f->ctx = context_make(NULL, &f->error);
    return &f->ctx;
}

// Fails the test with the error's message unless `call` (which uses fixture_context) returned true.
#define fixture_assert(call)                                                                                                               \
    do {                                                                                                                                   \
        if (!(call)) fail_msg("%s: %s", #call, fixture_state()->error.message);                                                            \
    } while (0)

// The device that GNOMON_DEVICE names, else the default one.
static inline struct device *fixture_device(void) {
    struct fixture *f = fixture_state();
    if (f->open) return &f->device;
    const struct gn_device_params params = {.select = getenv("GNOMON_DEVICE"), .validate = true};
    f->open = device_init(&f->device, fixture_context(), &params);
    if (!f->open && f->error.status == GN_NO_DEVICE) {
        print_message("skipped: %s\n", f->error.message);
        skip();
    }
    if (!f->open) fail_msg("%s", f->error.message);
    return &f->device;
}

// A test: the validation layer had nothing to say so far.
static inline void fixture_silent(void **state) {
    (void)state;
    struct device *device = fixture_device();
    if (!device->validating) skip();
    fixture_assert(device_validated(device, fixture_context()));
}

static inline int fixture_close(void **state) {
    (void)state;
    struct fixture *f = fixture_state();
    if (f->open) device_finish(&f->device);
    f->open = false;
    return 0;
}

// What a kernel of the convention above is run with. Zero fields are none.
struct fixture_job {
    const char *name;
    const uint32_t *spirv;
    size_t spirv_size; // bytes
    const struct kernel_constant *constants;
    size_t constant_count;
    const void *in;
    size_t in_bytes;
    void *out;
    size_t out_bytes;
    uint32_t count; // cases; one invocation each, in groups of 64
};

// Runs it and fails the test if that fails, or if the validation layer speaks. `out` is uploaded first, so that what the kernel does not
// write stays.
static inline void fixture_run(const struct fixture_job *job) {
    struct device *device = fixture_device();
    struct buffer in, out;
    struct kernel kernel;
    const struct buffer_params in_params = {.name = "in", .kind = BUFFER_STORAGE, .size = job->in_bytes, .host_writes = true};
    const struct buffer_params out_params = {
        .name = "out", .kind = BUFFER_STORAGE, .size = job->out_bytes, .host_writes = true, .host_reads = true};
    const struct kernel_binding bindings[] = {{.binding = 0, .buffer = &in}, {.binding = 1, .buffer = &out}};
    const struct kernel_params params = {.name = job->name,
                                         .spirv = job->spirv,
                                         .spirv_size = job->spirv_size,
                                         .constants = job->constants,
                                         .constant_count = job->constant_count,
                                         .bindings = bindings,
                                         .binding_count = 2,
                                         .push_size = sizeof job->count};
    fixture_assert(buffer_init(&in, fixture_context(), device, &in_params));
    fixture_assert(buffer_init(&out, fixture_context(), device, &out_params));
    fixture_assert(buffer_upload(&in, fixture_context(), device, job->in, job->in_bytes));
    fixture_assert(buffer_upload(&out, fixture_context(), device, job->out, job->out_bytes));
    fixture_assert(kernel_init(&kernel, fixture_context(), device, &params));
    fixture_assert(kernel_run(&kernel, fixture_context(), device, &job->count, (job->count + 63) / 64, NULL));
    fixture_assert(buffer_download(&out, fixture_context(), device, job->out, job->out_bytes));
    kernel_finish(&kernel, device);
    buffer_finish(&out, device);
    buffer_finish(&in, device);
    fixture_assert(device_validated(device, fixture_context()));
}

// The kernel of tests/kernels/<name>.comp, of which "<name>.h" is included: FIXTURE_KERNEL(name) in the initializer of a job.
#define FIXTURE_KERNEL(kernel) .name = #kernel, .spirv = kernel_##kernel, .spirv_size = sizeof kernel_##kernel

#endif
