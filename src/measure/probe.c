#include "measure/probe.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "device/float_controls.h"
#include "measure/probe_tests.h"
#include "render/kernels.h"
#include "shaders/shared.h"

struct probe {
    struct context *ctx;
    struct device *device;
    struct cases cases[2];           // of fp32 and of fp64
    const struct probe_test *ran[2]; // whose results they hold
    struct gn_probe_row *rows;
    uint32_t capacity, count;
};

static void add_row(struct probe *p, const struct gn_probe_row *row) {
    if (p->count < p->capacity) p->rows[p->count++] = *row;
}

// ------------------------------------------------------------------------------------------------------------------ running

static bool same_run(const struct probe_test *a, const struct probe_test *b) {
    return a && a->result.function == b->result.function && a->samples == b->samples && a->low == b->low && a->high == b->high;
}

static bool run(struct probe *p, const struct probe_test *test, bool fp64) {
    struct cases *cases = &p->cases[fp64];
    if (same_run(p->ran[fp64], test)) return true;
    probe_samples_fill(cases, test->samples, test->low, test->high);
    if (test->result.function == PROBE_ARITHMETIC ? !cases_run_arithmetic(cases, p->ctx, p->device)
                                                  : !cases_run_function(cases, p->ctx, p->device, test->result.function))
        return false;
    p->ran[fp64] = test;
    return true;
}

// What the errors of a test come to.
struct summary {
    double largest;
    uint32_t worst; // the case of it
    uint32_t wrong; // cases with an error
    uint32_t judged;
};

static struct summary summarize(const struct cases *cases, const struct probe_test *test) {
    struct summary summary = {0};
    for (uint32_t i = 0; i < cases->count; ++i) {
        const double error = test->error(cases, i, test->result);
        if (error < 0) continue;
        summary.judged++;
        summary.wrong += error > 0;
        if (error > summary.largest) summary.largest = error, summary.worst = i;
    }
    return summary;
}

static void describe(struct gn_probe_row *row, const struct probe_test *test, const struct cases *cases, const struct summary *summary) {
    const double *worst = cases->given[summary->worst];
    const bool two = test->result.function == FUNCTION_POW || (test->result.function == FUNCTION_ATAN && test->result.which == 1);
    if (test->describe)
        test->describe(row->detail, sizeof row->detail, cases, test->result);
    else if (test->value == PROBE_LARGEST && summary->largest > 0 && two)
        snprintf(row->detail, sizeof row->detail, "worst of %u at %.9g, %.9g", summary->judged, worst[0], worst[1]);
    else if (test->value == PROBE_LARGEST && summary->largest > 0 && summary->judged > 1)
        snprintf(row->detail, sizeof row->detail, "worst of %u at %.9g", summary->judged, worst[0]);
}

static bool measure(struct probe *p, const struct probe_test *test, bool fp64) {
    struct gn_probe_row row = {.limit = test->limit, .needed_by = fp64 ? test->needed_by_64 : test->needed_by};
    if (!run(p, test, fp64)) return false;
    const struct summary summary = summarize(&p->cases[fp64], test);
    snprintf(row.name, sizeof row.name, "%s %s", fp64 ? "fp64" : "fp32", test->name);
    snprintf(row.meaning, sizeof row.meaning, "%s", test->meaning);
    if (test->value == PROBE_COUNT) {
        row.value = summary.wrong;
        snprintf(row.unit, sizeof row.unit, "of %u", summary.judged);
    } else {
        row.value = summary.largest;
        snprintf(row.unit, sizeof row.unit, "%s", test->unit);
    }
    describe(&row, test, &p->cases[fp64], &summary);
    if (!(row.value <= row.limit)) row.breaks = row.needed_by;
    add_row(p, &row);
    return true;
}

// --------------------------------------------------------------------------------------------------------------- properties

static void add_property(struct probe *p, const char *name, double value, const char *detail, const char *meaning) {
    struct gn_probe_row row = {.value = value};
    snprintf(row.name, sizeof row.name, "%s", name);
    snprintf(row.detail, sizeof row.detail, "%s", detail);
    snprintf(row.meaning, sizeof row.meaning, "%s", meaning);
    add_row(p, &row);
}

// What can be declared of fp32, fp64 or both; 0, 1 or 2 of the two.
static void add_declaration(struct probe *p, const char *name, VkBool32 single, VkBool32 doubles, const char *meaning) {
    const char *of = single && doubles ? "of fp32 and fp64" : single ? "of fp32" : doubles ? "of fp64" : "of neither";
    add_property(p, name, (single ? 1 : 0) + (doubles ? 1 : 0), of, meaning);
}

static void add_properties(struct probe *p) {
    const struct device *device = p->device;
    const VkPhysicalDeviceFloatControlsProperties *floats = &device->float_controls;
    const bool special = tier_float_controls(device, TIER_EXACT) & FLOAT_SPECIAL_32;
    add_property(p, "doubles", device->has_fp64, "", "fp64 needs them, exact uses them");
    add_property(p, "64-bit integers", device->has_int64, "", "gnomon does without");
    add_property(p, "subgroup size", device->subgroup_size, "", "rays that step together");
    add_declaration(p, "rounding can be declared", floats->shaderRoundingModeRTEFloat32, floats->shaderRoundingModeRTEFloat64,
                    "RoundingModeRTE: robust, exact and fp64 do");
    add_declaration(p, "NaN can be declared", floats->shaderSignedZeroInfNanPreserveFloat32, floats->shaderSignedZeroInfNanPreserveFloat64,
                    special ? "SignedZeroInfNanPreserve: exact and fp64 do" : "SignedZeroInfNanPreserve: not done here");
    add_declaration(p, "denormals can be kept", floats->shaderDenormPreserveFloat32, floats->shaderDenormPreserveFloat64,
                    "DenormPreserve: gnomon does not ask");
    add_declaration(p, "denormals can be flushed", floats->shaderDenormFlushToZeroFloat32, floats->shaderDenormFlushToZeroFloat64,
                    "DenormFlushToZero: gnomon does not ask");
}

// ------------------------------------------------------------------------------------------------------------------ the whole

static bool measure_all(struct probe *p) {
    for (size_t i = 0; i < PROBE_TEST_COUNT; ++i) {
        const struct probe_test *test = &PROBE_TESTS[i];
        if (!progress(p->ctx, "probe", (double)i / (double)PROBE_TEST_COUNT, -1)) return false;
        if (test->types & PROBE_SINGLE && !measure(p, test, false)) return false;
        if (test->types & PROBE_DOUBLE && p->device->has_fp64 && !measure(p, test, true)) return false;
    }
    return true;
}

bool probe_measure(struct gn_probe_row *rows, uint32_t capacity, uint32_t *count, struct context *ctx, struct device *device) {
    struct probe p = {.ctx = ctx, .device = device, .rows = rows, .capacity = capacity};
    const bool done =
        cases_init(&p.cases[0], ctx, false, PROBE_CASES) && cases_init(&p.cases[1], ctx, true, PROBE_CASES) && measure_all(&p);
    if (done) add_properties(&p);
    cases_finish(&p.cases[0]);
    cases_finish(&p.cases[1]);
    *count = done ? p.count : 0;
    return done;
}

// What a tier stands on, where the device keeps it.
static const char *const KEPT[GN_ACCURACY_COUNT] = {
    [GN_FAST] = "asks for no more than Vulkan promises",
    [GN_ROBUST] = "precise products and sums stay apart, and in their order; quotients pad boxes as they should",
    [GN_EXACT] = "rounding, order, quotients and comparisons are as its error bounds assume",
    [GN_FP64] = "rounding, order, quotients and comparisons of doubles are as they should",
};
static const char *const NAMES[GN_ACCURACY_COUNT] = {[GN_FAST] = "fast", [GN_ROBUST] = "robust", [GN_EXACT] = "exact", [GN_FP64] = "fp64"};

void probe_judge(struct gn_probe_tier tiers[GN_ACCURACY_COUNT], const struct gn_probe_row *rows, uint32_t count, bool has_fp64) {
    for (int accuracy = 0; accuracy < GN_ACCURACY_COUNT; ++accuracy) {
        struct gn_probe_tier *tier = &tiers[accuracy];
        *tier = (struct gn_probe_tier){.available = accuracy != GN_FP64 || has_fp64};
        tier->ok = tier->available;
        snprintf(tier->name, sizeof tier->name, "%s", NAMES[accuracy]);
        snprintf(tier->because, sizeof tier->because, "%s", tier->available ? KEPT[accuracy] : "the device has no doubles (shaderFloat64)");
        for (uint32_t i = 0; i < count && tier->ok; ++i) {
            if (!(rows[i].breaks >> accuracy & 1)) continue;
            tier->ok = false;
            snprintf(tier->because, sizeof tier->because, "%s: %.4g %s, and may be %.4g at most", rows[i].name, rows[i].value, rows[i].unit,
                     rows[i].limit);
        }
    }
}
