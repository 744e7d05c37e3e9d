// GLSL functions, each alone in a small kernel, against fp64 twins written here, on random and nasty inputs.
//
// Thresholds are in ulp of the fp32 result or relative; beside each stands a negative control: a twin made wrong by a little more than the
// threshold must be caught.
#include "fixture.h"

#include <math.h>

#include "reference/sampler.h"
#include "shaders/shared.h"
#include "twin_box.h"
#include "twin_camera.h"
#include "twin_film.h"
#include "twin_leave.h"
#include "twin_normalize.h"
#include "twin_phong.h"
#include "twin_power.h"
#include "twin_ray.h"
#include "twin_sampler.h"
#include "twin_scalar.h"
#include "twin_sphere.h"
#include "twin_triangle.h"

#define CASES 4096

// --------------------------------------------------------------------------------------------------------------- inputs

static uint32_t random_state;

static uint32_t random_bits(void) {
    random_state = random_state * 747796405u + 2891336453u;
    uint32_t word = ((random_state >> ((random_state >> 28) + 4)) ^ random_state) * 277803737u;
    return (word >> 22) ^ word;
}

static float random_unit(void) { return (float)(random_bits() >> 8) * 0x1p-24f; }
static float random_in(float low, float high) { return low + (high - low) * random_unit(); }

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void random_vector(float v[3], float size) {
    for (int i = 0; i < 3; i++) v[i] = random_in(-size, size);
}

static double dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void random_direction(float v[3]) {
    double d[3], length;
    do {
        for (int i = 0; i < 3; i++) d[i] = random_in(-1, 1);
        length = sqrt(dot3(d, d));
    } while (length > 1 || length < 0.1);
    for (int i = 0; i < 3; i++) v[i] = (float)(d[i] / length);
}

static void widen(double to[3], const float from[3]) {
    for (int i = 0; i < 3; i++) to[i] = from[i];
}

static void cross3(double out[3], const double a[3], const double b[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// Distance in ulp of `right`, at least the smallest normal one.
static double ulps(float got, double right) {
    float near = fabsf((float)right);
    double ulp = near < 0x1p-126f ? 0x1p-149 : ldexp(1, ilogbf(near) - 23);
    return fabs((double)got - right) / ulp;
}

#define RUN(kernel_array, input, output, cases)                                                                                             \
    fixture_run(&(struct fixture_job){.name = #kernel_array, .spirv = kernel_array, .spirv_size = sizeof kernel_array, .in = input,          \
                                      .in_bytes = sizeof input, .out = output, .out_bytes = sizeof output, .count = cases})

// ---------------------------------------------------------------------------------------------------------------- tests

static void sampler_has_the_same_bits(void **state) {
    (void)state;
    static float in[CASES * 5], out[CASES * 6];
    for (uint32_t i = 0; i < CASES; i++) {
        uint32_t words[5] = {random_bits() >> random_bits() % 32, i % 512, i / 512, random_bits() >> random_bits() % 32, i % 3};
        memcpy(&in[5 * i], words, sizeof words);
    }
    RUN(kernel_twin_sampler, in, out, CASES);
    uint32_t control = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        uint32_t words[5], bits[2], other[2], independent[2];
        memcpy(words, &in[5 * i], sizeof words);
        sampler_bits(bits, words[0], words[1], words[2], words[3], words[4]);
        sampler_bits(other, words[0], words[1], words[2], words[3] + 1, words[4]);
        sampler_independent_bits(independent, words[0], words[1], words[2], words[3], words[4]);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(bits_of(out[6 * i + k]), bits[k]);
            assert_int_equal(bits_of(out[6 * i + 4 + k]), independent[k]);
            assert_true(out[6 * i + 2 + k] == (float)(bits[k] >> 8) * 0x1p-24f && out[6 * i + 2 + k] < 1.0f);
            control += bits[k] != other[k];
        }
    }
    assert_true(control > CASES);
}

// Every 16 consecutive samples of a pixel fall into 16 different cells of 4 × 4: what makes the points better than random ones.
static void sampler_is_stratified(void **state) {
    (void)state;
    for (uint32_t pixel = 0; pixel < 64; pixel++) {
        uint32_t cells = 0;
        for (uint32_t i = 0; i < 16; i++) {
            uint32_t bits[2];
            sampler_bits(bits, 7, pixel, 3, i, SAMPLER_PAIR_FILM);
            cells |= 1u << (bits[0] >> 30 << 2 | bits[1] >> 30);
        }
        assert_int_equal(cells, 0xffff);
    }
}

// 2^16 independent numbers in 256 cells, chi-squared with 255 degrees of freedom: from 163 to 374 with a probability of 1 - 1e-5; the points of Sobol, which are
// far too even for that, are the control. Neighbours do not follow each other: the correlation of pairs is within 4.5 deviations of 0.
static void independent_samples_are_random(void **state) {
    (void)state;
    enum { COUNT = 1 << 16, CELLS = 256 };
    double cells[2][CELLS] = {{0}}, chi[2] = {0, 0}, correlation = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t bits[2], even[2];
        sampler_independent_bits(bits, 5, 17, 4, i, SAMPLER_PAIR_FILM);
        sampler_bits(even, 5, 17, 4, i, SAMPLER_PAIR_FILM);
        cells[0][bits[0] >> 28 << 4 | bits[1] >> 28]++;
        cells[1][even[0] >> 28 << 4 | even[1] >> 28]++;
        correlation += (bits[0] * 0x1p-32 - 0.5) * (bits[1] * 0x1p-32 - 0.5);
    }
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < CELLS; i++) chi[k] += (cells[k][i] - COUNT / CELLS) * (cells[k][i] - COUNT / CELLS) / (COUNT / CELLS);
    assert_true(chi[0] > 163 && chi[0] < 374);
    assert_false(chi[1] > 163 && chi[1] < 374);
    assert_true(fabs(correlation) <= 4.5 * sqrt(COUNT) / 12);
}

static void camera_direction_is_to_the_bit(void **state) {
    (void)state;
    static float in[CASES * 13], out[CASES * 3];
    for (int i = 0; i < CASES; i++) {
        for (int k = 0; k < 9; k++) in[13 * i + k] = random_in(-1, 1) * (k < 3 ? 1.0f : 0x1p-9f);
        in[13 * i + 9] = (float)(random_bits() % 16384);
        in[13 * i + 10] = (float)(random_bits() % 16384);
        in[13 * i + 11] = random_unit();
        in[13 * i + 12] = random_unit();
    }
    RUN(kernel_twin_camera, in, out, CASES);
    int contracted = 0;
    for (int i = 0; i < CASES; i++) {
        const float *c = &in[13 * i], *du = c + 3, *dv = c + 6, x = c[9], y = c[10], a = c[11], b = c[12];
        for (int k = 0; k < 3; k++) {
            float right = ((c[k] + x * du[k]) + y * dv[k]) + (a * du[k] + b * dv[k]);
            assert_int_equal(bits_of(out[3 * i + k]), bits_of(right));
            contracted += fmaf(y, dv[k], c[k] + x * du[k]) + (a * du[k] + b * dv[k]) != right;
        }
    }
    assert_true(contracted > 0); // the order of roundings matters, so the comparison can fail
}

// t, u, v of a triangle in fp64.
static void triangle_twin(double tuv[3], const float *ray, const float *v) {
    double o[3], d[3], v0[3], v1[3], v2[3], e1[3], e2[3], s[3], p[3], q[3];
    widen(o, ray);
    widen(d, ray + 3);
    widen(v0, v);
    widen(v1, v + 3);
    widen(v2, v + 6);
    for (int i = 0; i < 3; i++) {
        e1[i] = v1[i] - v0[i];
        e2[i] = v2[i] - v0[i];
        s[i] = o[i] - v0[i];
    }
    cross3(p, d, e2);
    cross3(q, s, e1);
    double det = dot3(e1, p);
    if (fabs(det) < 1e-2 * sqrt(dot3(e1, e1) * dot3(e2, e2) * dot3(d, d))) det = 0; // thin or grazing: judged elsewhere
    tuv[0] = dot3(e2, q) / det;
    tuv[1] = dot3(s, p) / det;
    tuv[2] = dot3(d, q) / det;
}

static void triangles_agree_with_fp64(void **state) {
    (void)state;
    static float in[CASES * 15], out[CASES * 6];
    for (int i = 0; i < CASES; i++) {
        float *c = &in[15 * i];
        random_vector(c, 4);
        for (int k = 0; k < 3; k++) random_vector(c + 6 + 3 * k, 1);
        float u = random_in(-0.3f, 1), v = random_in(-0.3f, 1); // towards a point of the triangle's plane, inside or a little outside
        for (int k = 0; k < 3; k++) c[3 + k] = c[6 + k] + u * (c[9 + k] - c[6 + k]) + v * (c[12 + k] - c[6 + k]) - c[k];
    }
    RUN(kernel_twin_triangle, in, out, CASES);
    int wrong = 0, caught = 0, hits = 0;
    for (int i = 0; i < CASES; i++) {
        double right[3];
        triangle_twin(right, &in[15 * i], &in[15 * i + 6]);
        double w = 1 - right[1] - right[2], margin = fmin(w, fmin(right[1], right[2]));
        if (fabs(margin) < 1e-3 || !isfinite(right[0])) continue; // decisions near an edge are judged elsewhere
        for (int tier = 0; tier < 2; tier++) {
            const float *got = &out[6 * i + 3 * tier];
            wrong += isinf(got[0]) != (margin < 0);
            if (margin < 0 || isinf(got[0])) continue;
            hits++;
            bool good = fabs(got[1] - right[1]) <= 2e-3 && fabs(got[2] - right[2]) <= 2e-3 && fabs(got[0] - right[0]) <= 2e-3 * right[0];
            wrong += !good;
            caught += fabs(got[1] + 3e-3 - right[1]) > 2e-3;
        }
    }
    assert_int_equal(wrong, 0);
    assert_true(hits > CASES / 4 && caught > hits * 9 / 10);
}

struct triangle_case { const char *name; float ray[6], v[9]; bool hit_fast, hit_robust; };

static const struct triangle_case TRIANGLES[] = {
    {"in front", {0.25f, 0.25f, 1, 0, 0, -1}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, true},
    {"other winding", {0.25f, 0.25f, 1, 0, 0, -1}, {0, 0, 0, 0, 1, 0, 1, 0, 0}, true, true},
    {"beside", {0.75f, 0.75f, 1, 0, 0, -1}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, false, false},
    {"no area", {0.25f, 0, 1, 0, 0, -1}, {0, 0, 0, 1, 0, 0, 0.5f, 0, 0}, false, false},
    {"a point", {0, 0, 1, 0, 0, -1}, {0, 0, 0, 0, 0, 0, 0, 0, 0}, false, false},
    {"in the plane", {-1, 0.25f, 0, 1, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, false, false},
    {"NaN vertex", {0.25f, 0.25f, 1, 0, 0, -1}, {NAN, 0, 0, 1, 0, 0, 0, 1, 0}, false, false},
    {"NaN last vertex", {0.25f, 0.25f, 1, 0, 0, -1}, {0, 0, 0, 1, 0, 0, 0, NAN, 0}, false, false},
    {"minus zero direction", {0.25f, 0.25f, 1, -0.0f, 0, -1}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, true},
    {"grazing", {-1, 0.25f, 1e-6f, 1, 0, -1e-6f}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, true},
    {"from afar", {0.3f, 0.3f, 1e7f, 0, 0, -1}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, true, true},
    {"tiny", {0.25e-6f, 0.25e-6f, 1e-6f, 0, 0, -1}, {0, 0, 0, 1e-6f, 0, 0, 0, 1e-6f, 0}, true, true},
};

static void triangles_at_the_edge_of_meaning(void **state) {
    (void)state;
    enum { COUNT = sizeof TRIANGLES / sizeof TRIANGLES[0] };
    float in[COUNT * 15], out[COUNT * 6];
    for (int i = 0; i < COUNT; i++) {
        memcpy(&in[15 * i], TRIANGLES[i].ray, sizeof TRIANGLES[i].ray);
        memcpy(&in[15 * i + 6], TRIANGLES[i].v, sizeof TRIANGLES[i].v);
    }
    RUN(kernel_twin_triangle, in, out, COUNT);
    for (int i = 0; i < COUNT; i++) {
        if (isfinite(out[6 * i]) != TRIANGLES[i].hit_fast || isfinite(out[6 * i + 3]) != TRIANGLES[i].hit_robust)
            fail_msg("%s: t is %g (fast), %g (robust)", TRIANGLES[i].name, out[6 * i], out[6 * i + 3]);
    }
}

// Rays at the vertices of a closed, bumpy sphere from inside, where it is seen without folds: the robust test never lets one out, the fast one does
// (the control).
static void robust_triangles_are_watertight(void **state) {
    (void)state;
    enum { N = 16, RAYS = 512, TESTS = RAYS * 8 };
    static float vertex[N * N][3], in[TESTS * 15], out[TESTS * 6];
    int count = 0;
    for (int i = 0; i < N * N; i++) {
        double theta = 3.14159265358979 * (1 + i / N) / (N + 1), phi = 6.28318530717959 * (i % N) / N, r = 1 + 0.1 * random_unit();
        vertex[i][0] = (float)(r * sin(theta) * cos(phi));
        vertex[i][1] = (float)(r * sin(theta) * sin(phi));
        vertex[i][2] = (float)(r * cos(theta));
    }
    // The six triangles around an inner vertex, twice two more to fill eight.
    static const int AROUND[7][2] = {{0, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, 0}, {-1, 1}, {0, 1}};
    for (int k = 0; k < RAYS; k++) {
        int row = 1 + (int)(random_bits() % (N - 2)), column = (int)(random_bits() % N), centre = row * N + column;
        float o[3];
        random_vector(o, 0.1f);
        for (int t = 0; t < 8; t++, count++) {
            const int *a = AROUND[t % 6], *b = AROUND[t % 6 + 1];
            float *c = &in[15 * count];
            memcpy(c, o, sizeof o);
            for (int i = 0; i < 3; i++) c[3 + i] = vertex[centre][i] - o[i];
            memcpy(c + 6, vertex[centre], sizeof o);
            memcpy(c + 9, vertex[(row + a[0]) * N + (column + a[1] + N) % N], sizeof o);
            memcpy(c + 12, vertex[(row + b[0]) * N + (column + b[1] + N) % N], sizeof o);
        }
    }
    RUN(kernel_twin_triangle, in, out, TESTS);
    int leaks[2] = {0, 0};
    for (int k = 0; k < RAYS; k++) {
        for (int tier = 0; tier < 2; tier++) {
            bool hit = false;
            for (int t = 0; t < 8; t++) hit = hit || isfinite(out[6 * (8 * k + t) + 3 * tier]);
            leaks[tier] += !hit;
        }
    }
    assert_int_equal(leaks[1], 0);
    assert_true(leaks[0] > 0);
}

// The textbook's discriminant in fp32: what cancels.
static float discriminant_fp32(const float *c) {
    volatile float a = 0, b = 0, l2 = 0;
    for (int k = 0; k < 3; k++) {
        volatile float l = c[6 + k] - c[k];
        a += c[3 + k] * c[3 + k];
        b += l * c[3 + k];
        l2 += l * l;
    }
    return b * b - a * (l2 - c[9] * c[9]);
}

static void spheres_agree_with_fp64(void **state) {
    (void)state;
    static float in[CASES * 10], out[CASES * 4];
    for (int i = 0; i < CASES; i++) {
        float *c = &in[10 * i], target[3], distance = i % 2 ? 5.0f : 1500.0f;
        random_direction(c);
        for (int k = 0; k < 3; k++) c[k] *= distance;
        random_vector(target, 1);
        for (int k = 0; k < 3; k++) c[3 + k] = target[k] - c[k];
        random_vector(c + 6, 0.1f);
        c[9] = 1;
    }
    RUN(kernel_twin_sphere, in, out, CASES);
    int wrong = 0, textbook = 0, hits = 0;
    for (int i = 0; i < CASES; i++) {
        double o[3], d[3], l[3], x[3];
        widen(o, &in[10 * i]);
        widen(d, &in[10 * i + 3]);
        for (int k = 0; k < 3; k++) l[k] = in[10 * i + 6 + k] - o[k];
        cross3(x, l, d);
        double a = dot3(d, d), f = a - dot3(x, x), near = (dot3(l, d) - sqrt(fmax(f, 0))) / a;
        if (fabs(f) < 1e-2 * a) continue;
        const float *got = &out[4 * i];
        wrong += isfinite(got[2]) != (f > 0) || (f > 0 && !(fabs(got[2] - near) <= 2e-4 * near));
        wrong += isfinite(got[0]) != (f > 0);
        textbook += (discriminant_fp32(&in[10 * i]) >= 0) != (f > 0);
        hits += f > 0;
    }
    assert_int_equal(wrong, 0);
    assert_true(hits > CASES / 4);
    assert_true(textbook > 0); // the same threshold catches it
}

static void boxes_are_never_missed(void **state) {
    (void)state;
    static float in[CASES * 14], out[CASES];
    for (int i = 0; i < CASES; i++) { // point boxes, and directions computed towards them; some with a zero component or an origin on a face
        float *c = &in[14 * i];
        random_vector(c, 1);
        memcpy(c + 3, c, 3 * sizeof *c);
        random_vector(c + 6, 4);
        float t = random_in(1, 2);
        for (int k = 0; k < 3; k++) {
            if (i % 4 == k) c[6 + k] = c[k];
            c[3 + k] = c[k];
            c[9 + k] = (c[k] - c[6 + k]) / t;
            // The box is what lies between the point and where the rounded direction leads: it certainly touches the ray.
            float end = (float)(c[6 + k] + (double)t * c[9 + k]);
            if (end < c[k]) c[k] = nextafterf(end, -INFINITY);
            else c[3 + k] = nextafterf(end, INFINITY);
        }
        c[12] = 0;
        c[13] = INFINITY;
    }
    RUN(kernel_twin_box, in, out, CASES);
    for (int i = 0; i < CASES; i++) assert_true(isfinite(out[i]));
}

struct box_case { const char *name; float c[14]; bool enters; };

static const struct box_case BOXES[] = {
    {"zero component, origin on the lower face", {0, -1, -1, 1, 1, 1, 0, 0, -5, 0, 0, 1, 0, INFINITY}, true},
    {"zero component, origin on the upper face", {-1, -1, -1, 0, 1, 1, 0, 0, -5, 0, 0, 1, 0, INFINITY}, true},
    {"minus zero component, origin on the upper face", {-1, -1, -1, 0, 1, 1, 0, 0, -5, -0.0f, 0, 1, 0, INFINITY}, true},
    {"zero component, origin beside", {0.5f, -1, -1, 1, 1, 1, 0, 0, -5, 0, 0, 1, 0, INFINITY}, false},
    {"denormal component, inside the slab", {-1, -1, -1, 1, 1, 1, 0, 0, -5, 1e-40f, 0, 1, 0, INFINITY}, true},
    {"inside", {-1, -1, -1, 1, 1, 1, 0, 0, 0, 1, 0.3f, 0.2f, 0, INFINITY}, true},
    {"behind", {-1, -1, -1, 1, 1, 1, 0, 0, 5, 0, 0, 1, 0, INFINITY}, false},
    {"too far", {-1, -1, -1, 1, 1, 1, 0, 0, -5, 0, 0, 1, 0, 3}, false},
    {"too near", {-1, -1, -1, 1, 1, 1, 0, 0, -5, 0, 0, 1, 7, 9}, false},
    {"a corner", {0, 0, 0, 1, 1, 1, -1, -1, -1, 1, 1, 1, 0, INFINITY}, true},
    {"flat", {-1, -1, 0, 1, 1, 0, 0.5f, 0.5f, -5, 0, 0, 1, 0, INFINITY}, true},
    {"negative bounds", {-1, -1, -1, 1, 1, 1, 0, 0, 5, 0, 0, 1, -INFINITY, -1}, true},
};

static void boxes_at_the_edge_of_meaning(void **state) {
    (void)state;
    enum { COUNT = sizeof BOXES / sizeof BOXES[0] };
    float in[COUNT * 14], out[COUNT];
    for (int i = 0; i < COUNT; i++) memcpy(&in[14 * i], BOXES[i].c, sizeof BOXES[i].c);
    RUN(kernel_twin_box, in, out, COUNT);
    for (int i = 0; i < COUNT; i++)
        if ((out[i] < INFINITY) != BOXES[i].enters) fail_msg("%s: enters at %g", BOXES[i].name, out[i]);
}

// One light of unit intensity, in fp64; the interface contract's light model.
static void phong_twin(double rgb[3], const float *c) {
    double n[3], l[3], v[3], r[3];
    widen(n, c + 7);
    widen(l, c + 10);
    widen(v, c + 13);
    double cosine = dot3(n, l);
    for (int i = 0; i < 3; i++) r[i] = 2 * cosine * n[i] - l[i];
    double gloss = pow(fmin(fmax(dot3(r, v), 0), 1), c[6]);
    for (int i = 0; i < 3; i++) rgb[i] = cosine > 0 ? c[i] * cosine + c[3 + i] * gloss : 0;
}

static void phong_agrees_with_fp64(void **state) {
    (void)state;
    static float in[CASES * 16], out[CASES * 3];
    for (int i = 0; i < CASES; i++) {
        float *c = &in[16 * i];
        for (int k = 0; k < 6; k++) c[k] = random_unit();
        c[6] = i % 8 == 0 ? 0 : random_in(0, 64);
        for (int k = 0; k < 3; k++) random_direction(c + 7 + 3 * k);
    }
    RUN(kernel_twin_phong, in, out, CASES);
    int lit = 0, caught = 0;
    for (int i = 0; i < CASES; i++) {
        double right[3];
        phong_twin(right, &in[16 * i]);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(out[3 * i + k] - right[k]) <= 1e-4);
            lit += right[k] > 0;
            caught += fabs(out[3 * i + k] + 2e-4 - right[k]) > 1e-4;
        }
    }
    assert_true(lit > CASES && caught == 3 * CASES);
}

struct scalar_case { const char *name; float x, y; double power, falloff; };

static const struct scalar_case SCALARS[] = {
    {"0^0, light at the point", 0, 0, 1, 1},
    {"0^n", 0, 32, 0, 1},
    {"x^0", 0.5f, 0, 1, 0},
    {"1^n", 1, 1e6f, 1, 1e-12},
    {"x^2", 0.25f, 2, 0.0625, 0.25},
    {"falloff beyond fp32's squares", 1, 1e18f, 1, 1e-36},
    {"light at the point, with falloff", 1, 0, 1, 0},
};

static void powers_and_falloff(void **state) {
    (void)state;
    enum { COUNT = sizeof SCALARS / sizeof SCALARS[0] };
    float in[2 * COUNT], out[2 * COUNT];
    for (int i = 0; i < COUNT; i++) {
        in[2 * i] = SCALARS[i].x;
        in[2 * i + 1] = SCALARS[i].y;
    }
    RUN(kernel_twin_scalar, in, out, COUNT);
    for (int i = 0; i < COUNT; i++) {
        if (!(ulps(out[2 * i], SCALARS[i].power) <= 16)) fail_msg("%s: power is %g", SCALARS[i].name, out[2 * i]);
        if (!(ulps(out[2 * i + 1], SCALARS[i].falloff) <= 8)) fail_msg("%s: falloff is %g", SCALARS[i].name, out[2 * i + 1]);
    }
}

// x^y where the sizes of x and y make it hard, each in turn: everyday exponents, x next to 1 with large ones, results next to underflow, x above 1.
static void hard_power(float *x, float *y, int i) {
    *x = random_in(1e-6f, 1), *y = random_in(0, 64);
    if (i % 4 == 1) *x = 1 - random_unit() * ldexpf(1, -(int)(random_bits() % 24)), *y = ldexpf(random_unit(), (int)(random_bits() % 24));
    if (i % 4 == 2) *y = -120 / log2f(*x) * random_in(0.9f, 1);
    if (i % 4 == 3) *x = ldexpf(*x, (int)(random_bits() % 100)), *y = random_in(0, 1.2f);
}

static void own_power_is_right_to_4_ulp(void **state) {
    (void)state;
    enum { COUNT = 16 * CASES };
    static float in[2 * COUNT], out[COUNT];
    for (int i = 0; i < COUNT; i++) hard_power(&in[2 * i], &in[2 * i + 1], i);
    static const float ends[][2] = {{0, 0}, {0, 3}, {1, 1e30f}, {0.9f, 1e30f}, {NAN, 2}, {0x1p-126f, 1}, {2, 127}, {2, 128}, {0.25f, 0.5f}};
    static const float right_ends[] = {1, 0, 1, 0, 0, 0x1p-126f, 0x1p127f, INFINITY, 0.5f};
    memcpy(in, ends, sizeof ends);
    const struct kernel_constant own = {CONSTANT_POWER, POWER_OWN};
    fixture_run(&(struct fixture_job){FIXTURE_KERNEL(twin_power), .constants = &own, .constant_count = 1, .in = in, .in_bytes = sizeof in,
                                      .out = out, .out_bytes = sizeof out, .count = COUNT});
    int caught = 0, cases = 0;
    for (int i = 0; i < COUNT; i++) {
        double right = pow(in[2 * i], in[2 * i + 1]);
        if (i < (int)(sizeof right_ends / sizeof *right_ends)) {
            if (out[i] != right_ends[i]) fail_msg("%g^%g is %g", in[2 * i], in[2 * i + 1], out[i]);
        } else if (right >= 0x1p-126 && right < 0x1p127) {
            if (!(ulps(out[i], right) <= 4)) fail_msg("%a^%a is off by %g ulp", in[2 * i], in[2 * i + 1], ulps(out[i], right));
            caught += ulps(out[i], right * (1 + 8 * 0x1p-23)) > 4;
            cases++;
        }
    }
    assert_true(cases > COUNT * 9 / 10 && caught > cases / 2);
}

static void normalize_survives_any_length(void **state) {
    (void)state;
    static float in[CASES * 3], out[CASES * 6];
    for (int i = 0; i < CASES; i++) {
        random_direction(&in[3 * i]);
        for (int k = 0; k < 3; k++) in[3 * i + k] = ldexpf(in[3 * i + k], i % 200 - 100);
    }
    RUN(kernel_twin_normalize, in, out, CASES);
    int fast_fails = 0;
    for (int i = 0; i < CASES; i++) {
        double v[3];
        widen(v, &in[3 * i]);
        double length = sqrt(dot3(v, v));
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(out[6 * i + 3 + k] - v[k] / length) <= 3e-7);
            fast_fails += !(fabs(out[6 * i + k] - v[k] / length) <= 3e-7);
        }
    }
    assert_true(fast_fails > 0); // squares over- and underflow: the control
    const float nothing[3] = {0, 0, 0};
    float zero[6];
    RUN(kernel_twin_normalize, nothing, zero, 1);
    assert_true(zero[3] == 0 && zero[4] == 0 && zero[5] == 0);
}

// The start lies on n's side of every point that p may really be, and not much farther than that takes.
static void leaving_a_surface(void **state) {
    (void)state;
    static float in[CASES * 9], out[CASES * 3];
    for (int i = 0; i < CASES; i++) {
        float *c = &in[9 * i], size = ldexpf(1, i % 40 - 30);
        random_vector(c, size);
        for (int k = 0; k < 3; k++) c[3 + k] = fabsf(c[k]) * 0x1p-22f * random_unit();
        random_direction(c + 6);
        if (i % 5 == 0) memcpy(c + 6, (float[3]){0, 0, 1}, 3 * sizeof *c);
    }
    RUN(kernel_twin_leave, in, out, CASES);
    for (int i = 0; i < CASES; i++) {
        const float *c = &in[9 * i];
        double moved = 0, worst = 0, size = 0;
        for (int k = 0; k < 3; k++) {
            moved += ((double)out[3 * i + k] - c[k]) * c[6 + k];
            worst += fabs(c[6 + k]) * c[3 + k];
            size += fabs(c[k]);
        }
        assert_true(moved >= worst);
        assert_true(moved <= 2 * worst + size * 0x1p-21);
    }
}

static void rays_come_to_a_safe_scale(void **state) {
    (void)state;
    enum { COUNT = 270 };
    float in[COUNT * 5], out[COUNT * 6];
    for (int i = 0; i < COUNT; i++) {
        float c[5] = {ldexpf(1.25f, i - 140), ldexpf(-0.75f, i - 140), 0, 0, ldexpf(1, 20 - i / 8)};
        memcpy(&in[5 * i], c, sizeof c);
    }
    RUN(kernel_twin_ray, in, out, COUNT);
    for (int i = 0; i < COUNT; i++) {
        const float *r = &out[6 * i], *c = &in[5 * i];
        if (c[0] < 0x1p-126f) continue; // a device may flush denormals
        assert_true(r[0] >= 1 && (r[0] < 2 || c[0] >= 0x1p127f));
        assert_true((double)r[0] == ldexp(c[0], -(int)r[5]));
        if (isfinite(r[4]) && r[4] >= 0x1p-126f) assert_true((double)r[4] == ldexp(c[4], (int)r[5]));
    }
}

static void film_keeps_its_digits(void **state) {
    (void)state;
    float in[] = {0.1f, 60000, 1, 60000, NAN, 3, INFINITY, 2}, out[16];
    RUN(kernel_twin_film, in, out, 4);
    assert_true(ulps(out[0], 60000 * (double)0.1f) <= 1);
    assert_true(out[4] == 60000.0f);
    assert_true(out[8] == 0 && out[11] == 3);
    assert_true(out[12] == 0 && out[15] == 2);
    volatile float plain = 0; // the control: fp32 without compensation is off by more
    for (int i = 0; i < 60000; i++) plain = plain + 0.1f;
    assert_true(ulps(plain, 60000 * (double)0.1f) > 1);
}

int main(void) {
    random_state = 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampler_has_the_same_bits),
        cmocka_unit_test(sampler_is_stratified),
        cmocka_unit_test(independent_samples_are_random),
        cmocka_unit_test(camera_direction_is_to_the_bit),
        cmocka_unit_test(triangles_agree_with_fp64),
        cmocka_unit_test(triangles_at_the_edge_of_meaning),
        cmocka_unit_test(robust_triangles_are_watertight),
        cmocka_unit_test(spheres_agree_with_fp64),
        cmocka_unit_test(boxes_are_never_missed),
        cmocka_unit_test(boxes_at_the_edge_of_meaning),
        cmocka_unit_test(phong_agrees_with_fp64),
        cmocka_unit_test(powers_and_falloff),
        cmocka_unit_test(own_power_is_right_to_4_ulp),
        cmocka_unit_test(normalize_survives_any_length),
        cmocka_unit_test(leaving_a_surface),
        cmocka_unit_test(rays_come_to_a_safe_scale),
        cmocka_unit_test(film_keeps_its_digits),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
