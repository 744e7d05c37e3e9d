#include "measure/stress/job.h"

// Mapped or not, whatever the kernel declares stands at a binding: those that a job does not need are its input.
struct job_buffers {
    struct buffer in, out, status;
};

static void buffers_finish(struct job_buffers *b, struct device *device) {
    buffer_finish(&b->in, device);
    buffer_finish(&b->out, device);
    buffer_finish(&b->status, device);
}

static bool buffers_make(struct job_buffers *b, struct stress *s, const struct job *job) {
    size_t in = (size_t)job->count * job->in_each * sizeof *job->in, out = (size_t)job->count * job->out_each * sizeof *job->out;
    struct buffer_params given = {.name = "given numbers", .kind = BUFFER_STORAGE, .size = in, .host_writes = true};
    struct buffer_params result = {.name = "results", .kind = BUFFER_STORAGE, .size = out, .host_writes = true, .host_reads = true};
    struct buffer_params status = {
        .name = "status", .kind = BUFFER_STORAGE, .size = sizeof(struct status), .host_writes = true, .host_reads = true};
    const struct status nothing = {0};
    return buffer_init(&b->in, s->ctx, s->device, &given) && buffer_init(&b->out, s->ctx, s->device, &result) &&
           buffer_init(&b->status, s->ctx, s->device, &status) && buffer_upload(&b->in, s->ctx, s->device, job->in, in) &&
           buffer_upload(&b->out, s->ctx, s->device, job->out, out) &&
           buffer_upload(&b->status, s->ctx, s->device, &nothing, sizeof nothing);
}

static bool run_kernel(struct stress *s, const struct job *job, struct job_buffers *buffers) {
    struct kernel kernel = {0};
    struct kernel_binding bindings[BINDING_COUNT];
    size_t count = job->ds ? device_scene_bindings(job->ds, bindings, true) : 0;
    bindings[count++] = (struct kernel_binding){BINDING_RAYS, &buffers->in, NULL};
    bindings[count++] = (struct kernel_binding){BINDING_HITS, &buffers->out, NULL};
    if (job->ds) bindings[count++] = (struct kernel_binding){BINDING_STATUS, &buffers->status, NULL};
    struct stress_args args = {.base = {0, 0, 0, 1}, .count = job->count, .what = job->what};
    if (job->ds) args.base = (vec4){job->ds->base[0], job->ds->base[1], job->ds->base[2], job->ds->scale}, args.root = job->ds->root;
    const struct kernel_specialization constants = {.tier = job->tier, .effects = job->effects, .knobs = {[KNOB_POWER] = job->power}};
    bool done = render_kernel_init(&kernel, s->ctx, s->device, job->tier == TIER_FP64 ? job->fp64 : job->fp32, &constants, bindings, count,
                                   sizeof args) &&
                kernel_run(&kernel, s->ctx, s->device, &args, (job->count + GROUP_SIZE - 1) / GROUP_SIZE, NULL);
    kernel_finish(&kernel, s->device);
    return done;
}

bool job_run(struct stress *s, const struct job *job) {
    struct job_buffers buffers = {0};
    struct status status = {0};
    bool done = buffers_make(&buffers, s, job) && run_kernel(s, job, &buffers) &&
                buffer_download(&buffers.out, s->ctx, s->device, job->out, (size_t)job->count * job->out_each * sizeof *job->out) &&
                buffer_download(&buffers.status, s->ctx, s->device, &status, sizeof status);
    buffers_finish(&buffers, s->device);
    if (done && status.stuck)
        done = fail(s->ctx, GN_LIMIT, "%u rays of a stress case need more traversal steps than this driver allows", status.stuck);
    return done && device_validated(s->device, s->ctx);
}
