// gnomon: a headless ray tracer in Vulkan compute shaders, as a library.
//
// Three handles: a device (Vulkan, opened once), a scene (loaded once), a picture (what a render gives back). Everything
// else is a parameter structure in which zero is the default, so that `struct gn_render_params p = {0};` is a good start.
// Errors are values: a function that can fail takes a `struct gn_error *`, fills it with a status and one message for
// people, and returns NULL or false. The library never exits, never prints, and keeps no global state; messages, progress
// and cancellation go through the callbacks of `struct gn_host`. A handle is used by one thread at a time.
//
// Units: lengths are scene units, angles are degrees where the name ends in `_deg` and radians elsewhere, times are
// milliseconds where the name ends in `_ms`. Pictures are row-major, top row first.
#ifndef GNOMON_H
#define GNOMON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

#define GN_VERSION_MAJOR 0
#define GN_VERSION_MINOR 1
#define GN_VERSION_PATCH 0

// The version of the library that is linked, "major.minor.patch".
const char *gn_version(void);

// What came of a call. The values are the program's exit codes.
enum gn_status {
    GN_OK = 0,
    GN_CHECK_FAILED = 1,   // a comparison was made and its answer is no
    GN_USAGE = 2,          // an argument makes no sense
    GN_SCENE = 3,          // the scene or one of its assets is at fault
    GN_NO_DEVICE = 4,      // no suitable Vulkan device
    GN_SHADER = 5,         // the driver refused a shader or a pipeline
    GN_DEVICE_LOST = 6,    // the device was lost, or did not answer in time
    GN_LIMIT = 7,          // a device limit or memory; the message names the buffer, its size and the limit
    GN_IO = 8,             // reading or writing a file failed
    GN_INTERNAL = 9,       // a fault of gnomon's own
    GN_SKIPPED = 77,       // could not be tried here
    GN_CANCELLED = 130,    // the progress callback asked to stop
};

struct gn_error {
    enum gn_status status;
    char message[2048];    // one message, UTF-8, no newline at its end; names file, line and column where there are any
};

// How a message is meant.
enum gn_level { GN_LEVEL_WARNING, GN_LEVEL_INFO, GN_LEVEL_DEBUG };

struct gn_progress {
    const char *stage;     // what is being done: "scene", "bvh", "trace", …
    double fraction;       // of this stage, 0 to 1
    double seconds_left;   // of this stage, estimated; negative while unknown
};

// What the caller lends the library. Zero fields take the default in brackets.
struct gn_host {
    void *user;                                                             // passed to the callbacks
    bool (*progress)(void *user, const struct gn_progress *progress);       // false cancels [never cancelled]
    void (*message)(void *user, enum gn_level level, const char *text);     // [messages are dropped]
    unsigned threads;                                                       // CPU threads [one for each core]
};

// ---------------------------------------------------------------------------------------------------------------- device

struct gn_device;   // one Vulkan device, opened for compute

struct gn_device_info {
    uint32_t index;        // in the order the Vulkan loader gives
    char name[256];
    char type[16];         // "discrete", "integrated", "virtual", "cpu", "other"
    char driver[256];      // name and version, for people
    char api[16];          // "1.3.230"
    char uuid[37];         // lower-case hexadecimal, 8-4-4-4-12
    bool usable;           // has what gnomon needs
    char reason[256];      // why not, if not
    bool has_fp64, has_int64;
};

struct gn_device_params {
    const char *select;    // index, part of the name, "uuid:…", "cpu" or "gpu" [a GPU if there is one, else the CPU]
    bool validate;         // turn the Khronos validation layer on; its messages become errors [off]
    bool hide_fp64;        // for tests: do as if the device had no doubles
    const struct gn_host *host;
};

// Opens a device. Returns NULL and fills *error (GN_NO_DEVICE, also when `select` names none) on failure.
struct gn_device *gn_device_create(const struct gn_device_params *params, struct gn_error *error);

// Closes a device; NULL is allowed. All its pictures stay valid: they live in host memory.
void gn_device_destroy(struct gn_device *device);

// What is known of an open device; valid until it is destroyed.
const struct gn_device_info *gn_device_info(const struct gn_device *device);

// Lists all Vulkan devices into infos[0 … *count), at most `capacity`; *selected is the index that `params` would
// choose, or -1. Returns false only when Vulkan itself cannot be started.
bool gn_device_list(const struct gn_device_params *params, struct gn_device_info *infos, uint32_t capacity,
                    uint32_t *count, int *selected, struct gn_error *error);

// ----------------------------------------------------------------------------------------------------------------- scene

struct gn_scene;    // a scene in host memory

// Loads a scene (.json, format version 1) or a model (.obj, .ply, .stl, .gltf, .glb, and what Assimp reads), checks it,
// and resolves its files. A model without camera or light gets a framed camera and default lights. NULL and *error (GN_SCENE,
// GN_IO, GN_LIMIT) on failure.
struct gn_scene *gn_scene_load(const char *path, const struct gn_host *host, struct gn_error *error);

// Frees a scene; NULL is allowed.
void gn_scene_destroy(struct gn_scene *scene);

struct gn_scene_info {
    uint32_t shapes, materials, lights;
    uint64_t triangles, spheres;
    uint32_t width, height, spp;   // of the film, before any override
};
void gn_scene_info(const struct gn_scene *scene, struct gn_scene_info *info);

// ---------------------------------------------------------------------------------------------------------------- render

// How decisions are made. The default is the watertight tier.
enum gn_accuracy { GN_ROBUST = 0, GN_FAST, GN_EXACT, GN_FP64, GN_ACCURACY_COUNT };

// "robust", "fast", …; NULL where there is no such accuracy.
const char *gn_accuracy_name(enum gn_accuracy accuracy);

// Extra layers of a picture, or-ed together.
enum gn_aov {
    GN_AOV_DEPTH = 1,      // distance along the ray from the camera, scene units; +inf where nothing is hit; 1 channel
    GN_AOV_NORMAL = 2,     // unit shading normal in world space, towards the viewer; 0 where nothing is hit; 3 channels
    GN_AOV_ID = 4,         // object and primitive of the first sample's hit, -1 for none; 2 channels
    // Where accuracy is lost. The first two render the picture once more with the reference; none is there without a device.
    GN_AOV_ERROR = 8,      // absolute difference of the colour to the reference's; 3 channels
    GN_AOV_ULP = 16,       // difference of the depth to the reference's in ulp of that; +inf where one hits and the other does not; 1 channel
    GN_AOV_UNDECIDED = 32, // rays of the pixel that the tier's first stage left undecided, over all samples; 1 channel
};

// Milliseconds. startup: opening the device; pipeline: making kernels; upload: filling the device's memory; reference: rendering once more
// for the layers that compare; total: all of these and what lies between them, from gn_render's or gn_trace's point of view.
struct gn_time { double total, startup, scene, bvh, pipeline, upload, trace, reference, output; };

struct gn_render_params {
    uint32_t width, height;         // pixels [the scene's]
    uint32_t spp;                   // samples per pixel [the scene's]
    uint32_t seed;                  // of the sampler
    enum gn_accuracy accuracy;      // [robust]
    uint32_t aovs;                  // enum gn_aov, or-ed
    const char *disable;            // effects to leave out, comma-separated names [none]
    const char *only;               // effects to run where the scene calls for them, beside those of geometry, comma-separated names [all]
    bool no_prune;                  // run every effect, whether the scene calls for it or not
    uint32_t tile_pixels;           // pixels of one piece of device work; the picture does not depend on it [measured]
    const struct gn_host *host;
};

struct gn_render_stats {
    char accuracy[16];
    char effects[1024];             // names of the effects that ran, comma-separated
    uint64_t rays;                  // all kinds
    uint64_t nonfinite_pixels;      // samples that came out NaN or infinite and were dropped, counted by pixel
    uint64_t undecided_rays;        // whose decision needed more than the tier's first stage
    uint64_t second_stage_rays;     // of these, how many fp64 on the device decided
    uint64_t host_rays;             // and how many were left to exact arithmetic on the host
    struct gn_time time_ms;         // `output` is filled by gn_picture_save
    double mrays_per_s;             // rays / trace time
};

struct gn_picture;  // a finished picture in host memory, linear light, fp32

// One effect, and whether a scene calls for it.
struct gn_effect {
    char name[32];
    bool on;                        // it runs; else it is pruned
    char because[160];              // why, for people
};

// Says what gn_render would run with the same scene and parameters: fills effects[0 … *count), at most `capacity`; all there
// are when `capacity` is 64. GN_USAGE when `disable` or `only` names no effect.
bool gn_plan(struct gn_scene *scene, const struct gn_render_params *params, struct gn_effect *effects, uint32_t capacity,
             uint32_t *count, struct gn_error *error);

// What a picture takes that runs some of the effects.
struct gn_plan_side {
    double pipeline_ms;             // making its kernel
    double trace_ms;                // median over the rounds
    uint64_t rays;
    uint64_t device_bytes;          // of its buffers and images
};

struct gn_plan_buffer {
    char name[32];
    uint64_t bytes, limit;          // limit: what the device lets a buffer of its kind have; 0: none of its own
};

#define GN_PLAN_EFFECTS 64          // as many as gn_plan may list
#define GN_PLAN_BUFFERS 32

struct gn_plan_cost {
    struct gn_plan_side pruned, full;   // with the effects that the scene calls for, and with all of them
    struct {
        bool measured;
        struct gn_plan_side side;
    } without[GN_PLAN_EFFECTS];         // in gn_plan's order: without one effect of those that are on; not the ones of geometry
    uint32_t rounds;
    struct gn_plan_buffer buffers[GN_PLAN_BUFFERS]; // of the pruned picture
    uint32_t buffer_count;
};

// Measures what the effects cost that gn_plan lists: renders with them, with all, and without each, in turns. Kernels are compiled, so
// pipeline_ms says what that takes only where the driver does not find them in a cache of its own.
bool gn_plan_measure(struct gn_device *device, struct gn_scene *scene, const struct gn_render_params *params, struct gn_plan_cost *cost,
                     struct gn_error *error);

// Renders. `device` NULL renders on the CPU in fp64 (the reference), with the same sample positions and random numbers.
// NULL and *error (GN_USAGE, GN_SHADER, GN_DEVICE_LOST, GN_LIMIT, GN_CANCELLED) on failure.
struct gn_picture *gn_render(struct gn_device *device, struct gn_scene *scene, const struct gn_render_params *params,
                             struct gn_error *error);

// Frees a picture; NULL is allowed.
void gn_picture_destroy(struct gn_picture *picture);
uint32_t gn_picture_width(const struct gn_picture *picture);
uint32_t gn_picture_height(const struct gn_picture *picture);
const struct gn_render_stats *gn_picture_stats(const struct gn_picture *picture);

// The picture's layer `aov`, or with 0 its colour (3 channels, linear RGB); NULL if it was not asked for.
// width × height × channels floats, row-major, top row first, channels interleaved.
const float *gn_picture_pixels(const struct gn_picture *picture, uint32_t aov);

// Writes the picture; the suffix says how: .png (8 bit, the film's transfer), .exr (linear, AOVs as layers), .pfm (linear).
// For .png and .pfm every AOV goes to its own file beside it (name.depth.png, …). Either whole or not there.
bool gn_picture_save(struct gn_picture *picture, const char *path, struct gn_error *error);

// ----------------------------------------------------------------------------------------------------------------- trace

struct gn_ray { float origin[3], tmin, direction[3], tmax; };      // open interval, t in units of the direction

#define GN_HIT_INVALID   1u     // flag bit 0: the ray had a NaN, an infinity or no direction
#define GN_HIT_UNDECIDED 2u     // flag bit 1: the decision needed more than the tier's first stage

struct gn_hit {
    float t, u, v;              // t is +inf for a miss; u and v weigh the triangle's second and third vertex
    int32_t object, primitive;  // index in the scene's shapes, triangle in its mesh; both -1 for a miss
    uint32_t flags;             // GN_HIT_*
};

struct gn_trace_params {
    enum gn_accuracy accuracy;  // [robust]
    bool any;                   // occlusion only: object is 0 for occluded, -1 for free; nothing else is meaningful
    uint32_t repeat;            // shoot the batch so often, report the median time [1]
    const struct gn_host *host;
};

struct gn_trace_stats {
    char accuracy[16];
    uint64_t rays, hits, undecided_rays;
    uint64_t second_stage_rays, host_rays;  // what decided the undecided ones, as in gn_render_stats
    struct gn_time time_ms;     // `trace` is the shooting alone
    double mrays_per_s;
};

// Shoots rays[0 … count) and fills hits[0 … count). `device` NULL uses the CPU reference, whose decisions are exact.
bool gn_trace(struct gn_device *device, struct gn_scene *scene, const struct gn_trace_params *params,
              const struct gn_ray *rays, struct gn_hit *hits, size_t count, struct gn_trace_stats *stats,
              struct gn_error *error);

// --------------------------------------------------------------------------------------------------------------- measure

struct gn_verify_params {
    struct gn_render_params render; // what is rendered, on both sides
    double tolerance;               // of a colour channel, in linear light [1/255]
};

struct gn_verify_result {
    bool pass;
    uint64_t pixels;
    uint64_t pixels_differing;      // a colour channel is off by more than the tolerance
    uint64_t wrong_hits;            // the first sample hit another object or primitive
    uint64_t ties;                  // of the wrong hits, those at the same depth: surfaces that coincide
    uint64_t nonfinite_pixels;      // of the device; one is enough to fail
    uint64_t pixels_allowed;        // that may differ: rounding may decide otherwise at an edge; more of them with more samples
    uint64_t hits_allowed;          // of wrong hits that are no ties
    double tolerance;
    double max_abs, rmse;           // over all colour channels
    uint32_t worst_x, worst_y;      // where max_abs is
    struct gn_render_stats device, reference;
};

// Renders with the device and with the reference, and compares pixel by pixel. On success *result is filled, pass or
// not, and *difference, if asked for, receives the difference in false colour: the middle of the scale is the tolerance, its end twice that.
bool gn_verify(struct gn_device *device, struct gn_scene *scene, const struct gn_verify_params *params,
               struct gn_verify_result *result, struct gn_picture **difference, struct gn_error *error);

struct gn_compare_result {
    uint32_t width, height;
    double max_abs, rmse, psnr_db, flip;    // psnr_db is +inf for equal images; flip is the mean FLIP error, 0 to 1
    uint64_t pixels_differing, nonfinite_pixels;
    uint32_t worst_x, worst_y;
};

// Compares two image files of the same size (.png, .exr, .pfm); a pixel differs when it is not equal. *heat, if asked for, receives the FLIP error in false colour.
bool gn_compare(const char *path_a, const char *path_b, struct gn_compare_result *result, struct gn_picture **heat,
                struct gn_error *error);

// One thing that the probe measured.
struct gn_probe_row {
    char name[40];          // "fp32 quotient"
    double value;
    double limit;           // that the tiers in needed_by set it
    char unit[24];          // of the value: "ulp", "of 65536", …
    char detail[120];       // what else was seen, for people
    char meaning[160];      // what it is, and what stands or falls with it
    uint32_t needed_by;     // tiers that rely on it: 1 << enum gn_accuracy, or-ed
    uint32_t breaks;        // those of them for which it is too much
};

struct gn_probe_tier {
    char name[8];
    bool available;         // the device has what it needs
    bool ok;                // available, and the device keeps what it needs
    char because[240];      // why, or why not
};

#define GN_PROBE_ROWS 128   // more than there are

// Measures what the device's arithmetic really does: fills rows[0 … *count), at most `capacity`, and what they mean for each tier,
// tiers[enum gn_accuracy]. True as well when tiers are not ok. Some two seconds on a CPU.
bool gn_probe(struct gn_device *device, const struct gn_host *host, struct gn_probe_row *rows, uint32_t capacity, uint32_t *count,
              struct gn_probe_tier tiers[GN_ACCURACY_COUNT], struct gn_error *error);

// ------------------------------------------------------------------------------------------------------------------ cost

// What accuracy costs: settings of one axis at a time (the tier, the offset rule, the samples per pixel, …) and of all together, each with
// its time on this device and its error against the reference, on a lattice of the picture's pixels that is as dense as the time allows.
struct gn_cost; // the result of a measurement

struct gn_cost_params {
    uint32_t width, height; // pixels of the picture in question [the scene's]
    uint32_t seed;          // of the sampler
    uint32_t rounds;        // settings take turns, and this is how many turns count, 1 to 64; the time permitting, but three at least [5]
    double seconds;         // to measure, about; what compiling takes comes on top [60]
    const struct gn_host *host;
};

struct gn_cost_row {
    char axis[16], setting[48];     // "tier" "exact", "samples" "16 per pixel"; the last axis is "together"
    char accuracy[16];              // the tier
    uint32_t pixels, spp;           // rendered
    bool converged;                 // the error is against very many samples, and that of sampling in it; else against the same ones
    bool base;                      // what the other rows of this axis are to be compared with
    bool pareto;                    // of the rows with the same kind of error, none is as fast and as close, and better in one of these
    double time_ms;                 // median of the rounds
    double time_low_ms, time_high_ms;   // quartiles
    double picture_ms;              // the median, scaled to all pixels of the picture
    double rmse, max_abs, flip;     // of the picture against the reference's: linear light, FLIP as gn_compare says
    uint64_t nonfinite_pixels;
    double differing_per_million;   // pixels off by more than 1/255
    double wrong_per_million;       // decisions of the tier about camera rays and rays to lights
    double t_ulp_max, t_ulp_mean;   // of the tier's t, where the right primitive was hit
};

// Something that was not measured, and why; `setting` is "" for a whole axis.
struct gn_cost_skipped {
    char axis[16], setting[48], because[256];
};

// Measures. NULL and *error on failure.
struct gn_cost *gn_cost_measure(struct gn_device *device, struct gn_scene *scene, const struct gn_cost_params *params, struct gn_error *error);
void gn_cost_destroy(struct gn_cost *cost);

// What came of it; valid until it is destroyed.
const struct gn_cost_row *gn_cost_rows(const struct gn_cost *cost, uint32_t *count);
const struct gn_cost_skipped *gn_cost_skipped(const struct gn_cost *cost, uint32_t *count);

// What gn_probe found on the device: tiers[enum gn_accuracy].
const struct gn_probe_row *gn_cost_probe(const struct gn_cost *cost, uint32_t *count, const struct gn_probe_tier **tiers);

struct gn_cost_summary {
    uint32_t width, height;     // of the picture
    uint32_t stride[2];         // every so manieth of its pixels was rendered, across and down: for the errors of arithmetic, of sampling
    uint32_t reference_spp;     // of the latter
    uint32_t rounds;            // that were taken
    uint64_t rays;              // whose decisions were judged
};
void gn_cost_summary(const struct gn_cost *cost, struct gn_cost_summary *summary);

// Writes a report: one HTML file with charts, pictures and their error maps, for any browser, without a network.
bool gn_cost_save(const struct gn_cost *cost, const char *path, struct gn_error *error);

// ------------------------------------------------------------------------------------------------------------------ pick

// Which accuracy and how many samples per pixel meet an error at the least time, or have the least error within a time: found on a sample
// of the picture's pixels, rendered by the device and by the reference.
//
// The error is the RMSE of linear values over pixels and channels. Where the samples per pixel are up to gnomon, it is against very many
// samples per pixel, so that the error of sampling is in it; where they are given, against the reference with the same samples.
struct gn_pick_params {
    struct gn_render_params render; // the picture; where spp is not 0 it is given
    bool keep_accuracy;             // its accuracy is, too
    double max_error;               // what is asked for [nothing]
    double max_seconds;             // from the call on, for picking, rendering and checking [as long as it takes]
};

struct gn_pick_candidate {
    enum gn_accuracy accuracy;
    uint32_t spp;
    double error, seconds;          // expected
    bool measured;                  // the error was, on the sample; else it is extrapolated from fewer samples per pixel
};

struct gn_pick {
    struct gn_pick_candidate picked, candidates[96];
    uint32_t count;                 // of the candidates
    bool met;                       // what was asked for; else what was picked comes nearest
    char because[320];              // why it was picked, for people
    double reference_seconds;       // that the reference takes for a sample of a pixel
};

// Picks. Exactly one of max_error and max_seconds may be 0. That nothing meets what is asked for is no failure: see `met`.
bool gn_pick(struct gn_device *device, struct gn_scene *scene, const struct gn_pick_params *params, struct gn_pick *pick, struct gn_error *error);

// The error of the picture that gn_render made with what was picked, by the same measure, on other pixels than those that were looked at
// when picking: about as many as the reference renders in `seconds`; *pixels says how many.
bool gn_pick_check(struct gn_scene *scene, const struct gn_pick_params *params, const struct gn_pick *pick, const struct gn_picture *picture,
                   double seconds, double *measured_error, uint64_t *pixels, struct gn_error *error);

// ---------------------------------------------------------------------------------------------------------------- stress

// The numerically hard cases, each accuracy tier against exact arithmetic.
struct gn_stress; // what came of them

struct gn_stress_params {
    const char *cases;      // shell pattern of their numbers, e.g. "T0*" [all]
    uint32_t accuracies;    // bits 1 << enum gn_accuracy [all]
    uint32_t rays;          // what each case shoots at each tier, about [10000]
    uint32_t seed;          // of the random numbers
    const struct gn_host *host;
};

// A case at a tier.
struct gn_stress_result {
    const char *id, *text, *accuracy;
    bool waits;             // it was not run: for want of an effect, or of something that the device lacks; the note says what
    bool pass;              // no worse than is known of the tier
    uint64_t rays;          // or whatever the case counts: numbers, boxes, samples
    uint64_t wrong;         // of them: a hit, its object and primitive, or a number is not the exact answer's
    uint64_t allowed;       // that may be wrong; 0 for the exact tier
    uint64_t leaks;         // of the wrong ones: rays that went through a closed surface
    double ms;              // of shooting; 0 where nothing was measured
    char note[240];
};

// Runs them. NULL and *error when that was not possible: GN_USAGE for a pattern that no case matches, a fault of the device, cancelled. What a
// tier gets wrong is no failure.
struct gn_stress *gn_stress_run(struct gn_device *device, const struct gn_stress_params *params, struct gn_error *error);
void gn_stress_destroy(struct gn_stress *stress);

// The results, valid until they are destroyed: case by case, `tiers` for each. gn_stress_passed: whether all of them do.
const struct gn_stress_result *gn_stress_results(const struct gn_stress *stress, uint32_t *count, uint32_t *tiers);
bool gn_stress_passed(const struct gn_stress *stress);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
