// What accuracy costs on this scene and this device: settings, each measured for its time and for its error against the reference.
//
// A setting is a row: a position of one axis (the tier, a knob, the samples per pixel, …), or one of all together. Rows that come to the same
// render share a run. All runs take turns round by round, so that whatever else the machine does hits all alike; the first turn, in which
// drivers compile, only fills the picture that is judged.
//
// Two targets are rendered by the reference, each on a lattice of the picture's pixels (render/lattice.h), as dense as the time allows:
// CENTRES, one ray through each pixel's centre, against which only arithmetic is in error; and SAMPLES, very many samples per pixel, against
// which a setting with fewer is in error by its sampling, too, or with the same samples by its arithmetic alone.
#ifndef MEASURE_COST_H
#define MEASURE_COST_H

#include "base/image.h"
#include "bvh/bvh.h"
#include "device/device.h"
#include "render/lattice.h"
#include "scene/scene.h"
#include "shaders/shared.h"

#define COST_MOST_ROWS 96
#define COST_MOST_ROUNDS 64
#define COST_LADDER 4            // rungs of samples per pixel: 1, 4, 16, 64, as far as the time allows
#define COST_REFERENCE_SAMPLES 4 // of the reference for one of the last rung

enum cost_target_name { COST_CENTRES, COST_SAMPLES, COST_TARGETS };

// What rows are compared with each other on a Pareto front: those whose error is against the same thing.
enum cost_front { COST_FRONT_ARITHMETIC, COST_FRONT_SUM, COST_FRONT_SAMPLING, COST_FRONTS };

// What a run renders.
struct cost_config {
    uint32_t tier;              // TIER_*
    uint32_t knobs[KNOB_COUNT]; // positions
    uint32_t spp;
    enum cost_target_name target;
    bool same_samples; // as the target; else other ones, so that both are wrong by themselves
    bool codes;        // the picture is judged as an 8-bit file has it, and encoding that counts
};

struct cost_run {
    struct cost_config config;
    struct image color;             // of the first turn
    double times[COST_MOST_ROUNDS]; // ms
    double median, low, high;       // ms: median and quartiles
    double rmse, max_abs, flip;     // against the target
    uint64_t nonfinite_pixels;      // with samples that were dropped
    uint64_t differing_pixels;      // off by more than 1/255
    uint64_t rays, undecided_rays;
};

struct cost_row {
    char axis[16], setting[48];
    uint32_t run; // its number
    enum cost_front front;
    bool base;    // what the other rows of the axis are compared with
    bool pareto;  // no other of its front is at least as fast and as close, and better in one of these
};

// An axis that is not measured, or a position of it.
struct cost_skipped {
    char axis[16], setting[48], because[256];
};

struct cost_target {
    struct lattice lattice; // of the whole picture
    uint32_t spp, seed;
    struct image color;     // the reference's
    double ms;              // it took
};

// Decisions of a tier about a batch of rays: camera rays, and rays from what they hit to the lights.
struct cost_decisions {
    bool measured;
    uint64_t rays, wrong, ties; // ties: another primitive, at exactly the same t
    uint64_t compared;          // camera rays that hit the right primitive: their t is compared
    double ulp_max, ulp_mean;
};

struct cost_params {
    uint32_t width, height, seed; // of the picture
    uint32_t effects;             // EFFECT_* bits that run
    uint32_t rounds;              // turns that count, at most COST_MOST_ROUNDS; at least 3 are taken if this is not less
    double seconds;               // to measure, about
};

// Zeroed is empty; cost_finish accepts a half-made one.
struct cost {
    struct cost_params params;
    struct cost_target targets[COST_TARGETS];
    struct cost_run *runs; // run_count
    struct cost_row *rows; // row_count
    struct cost_skipped skipped[16];
    uint32_t run_count, row_count, skipped_count, rounds;
    uint32_t rungs; // of the ladder
    double reference_speed, device_speed; // by trial: seconds for one sample of one pixel, by the reference and by the robust tier
    struct cost_decisions decisions[TIER_COUNT];
};

// What everything is measured with; borrowed, `whole` may be the same as `ctx`.
struct cost_bench {
    struct context *ctx;   // of the single steps, which do not tell how far they are
    struct context *whole; // of the whole, which does
    struct device *device;
    const struct scene *scene;
    const struct bvh *bvh;
};

bool cost_measure(struct cost *out, struct context *ctx, struct device *device, const struct scene *scene, const struct bvh *bvh,
                  const struct cost_params *params);
void cost_finish(struct cost *cost);

// The steps of cost_measure, each in a file of its own.
// targets.c: how fast the reference and the device are, and the rungs that there is time for.
bool cost_try(struct cost *cost, const struct cost_bench *bench);
// settings.c: the rows and runs that this scene and device call for.
bool cost_list(struct cost *cost, const struct cost_bench *bench);
// targets.c: how dense the lattices may be, and the reference's pictures.
bool cost_aim(struct cost *cost, const struct cost_bench *bench);
// decisions.c: every tier's decisions about a batch of rays.
bool cost_decide(struct cost *cost, const struct cost_bench *bench);
// rounds.c: the runs, first for their pictures, then for their times.
bool cost_run_all(struct cost *cost, const struct cost_bench *bench);
// pareto.c: marks the rows that no other beats.
void cost_mark_pareto(struct cost *cost);

// The name of a tier, of a knob, and of one of its positions into text[capacity] (false: there are no more).
const char *cost_tier_name(uint32_t tier);
const char *cost_knob_name(enum knob knob);
bool cost_position_name(char *text, size_t capacity, enum knob knob, uint32_t position);

// Samples per pixel of a rung.
static inline uint32_t cost_rung(uint32_t rung) { return 1u << 2 * rung; }

// Parts of the time there is: the reference's pictures, the batch of rays, the rounds.
#define COST_SHARE_CENTRES 0.10
#define COST_SHARE_SAMPLES 0.25
#define COST_SHARE_DECISIONS 0.10
#define COST_SHARE_ROUNDS 0.50

#endif
