// Rows of where things are: directions that are sampled, places in a picture, normals that a picture bends. Against MPFR at 256 bits, or
// against whole numbers and fp64 where these are exact.
#include <math.h>
#include <mpfr.h>
#include <string.h>

#include "measure/stress/shading.h"

#define BITS 256
#define LAST 0x1.fffffep-1f // the largest random number

// The angle of (x, y), in turns.
static double exact_turns(double y, double x) {
    mpfr_t a, b, turn;
    mpfr_inits2(BITS, a, b, turn, (mpfr_ptr)0);
    mpfr_set_d(a, y, MPFR_RNDN);
    mpfr_set_d(b, x, MPFR_RNDN);
    mpfr_atan2(a, a, b, MPFR_RNDN);
    mpfr_const_pi(turn, MPFR_RNDN);
    mpfr_mul_2ui(turn, turn, 1, MPFR_RNDN);
    mpfr_div(a, a, turn, MPFR_RNDN);
    double value = mpfr_get_d(a, MPFR_RNDN);
    mpfr_clears(a, b, turn, (mpfr_ptr)0);
    return value;
}

// --------------------------------------------------------------------------------------------------------------- sampling

// C07: the texel that u is in, for the largest u below 1 and for others.
static void picked(struct shading_case *out, struct random *random, uint32_t i) {
    float u = i % 2 ? LAST : (float)(random_bits(random) >> 8) * 0x1p-24f;
    float count = (float)(1 + random_below(random, i % 4 < 2 ? 16384 : 64));
    out->in[0] = u, out->in[1] = count, out->in[2] = (float)(i % 3), out->in[3] = 1;
    double place = (double)u * count, off = fabs(place - round(place)); // fp32 may round up to a whole number, but not to the last
    bool doubtful = off < count * FP32_UNIT && u < LAST;
    expect(out, 0, doubtful ? round(place) - 0.5 : floor(place), doubtful ? 0.5 : 0);
    expect(out, 1, 0, -1);
}

// C10: a sphere of 1e-4 radii, of fewer and of more, from the origin: the density, and a point that is not off by more than the distance's
// rounding.
static void small_light(struct shading_case *out, struct random *random, uint32_t i) {
    float *center = out->in, distance = (float)pow(10, random_in(random, -3, 3));
    double x = i % 2 ? 1e-4 : pow(10, random_in(random, -15, -0.5));
    unit_about(center, random, NULL, 0);
    for (int k = 0; k < 3; k++) center[k] *= distance;
    out->in[3] = (float)(x * distance);
    for (int k = 4; k < 6; k++) out->in[k] = i % 5 == 0 ? LAST : (float)(random_bits(random) >> 8) * 0x1p-24f;
    mpfr_t q, pi;
    mpfr_inits2(BITS, q, pi, (mpfr_ptr)0);
    mpfr_set_flt(q, out->in[3], MPFR_RNDN);
    mpfr_sqr(q, q, MPFR_RNDN);
    mpfr_div_d(q, q, dot_of(center, center), MPFR_RNDN);
    mpfr_ui_sub(q, 1, q, MPFR_RNDN);
    mpfr_sqrt(q, q, MPFR_RNDN);
    mpfr_ui_sub(q, 1, q, MPFR_RNDN);
    mpfr_const_pi(pi, MPFR_RNDN);
    mpfr_mul(q, q, pi, MPFR_RNDN);
    mpfr_mul_2ui(q, q, 1, MPFR_RNDN);
    mpfr_ui_div(q, 1, q, MPFR_RNDN);
    double pdf = mpfr_get_d(q, MPFR_RNDN);
    mpfr_clears(q, pi, (mpfr_ptr)0);
    for (int k = 0; k < 3; k++) expect(out, k, 0, -1);
    expect(out, 3, pdf, 32 * FP32_UNIT * pdf);
    expect(out, 4, 1, 0);
}

static bool is_on_the_light(const float *in, const float *out) {
    double d2 = dot_of(in, in), off = 0;
    for (int k = 0; k < 3; k++) off += ((double)out[k] - in[k]) * ((double)out[k] - in[k]);
    return fabs(sqrt(off) - in[3]) <= 16 * FP32_UNIT * sqrt(d2);
}

// C11: directions about z with a density of the cosine.
static void around(struct shading_case *out, struct random *random, uint32_t i) {
    for (int k = 0; k < 2; k++) out->in[k] = i % 8 == (uint32_t)k ? LAST : i % 8 == 2 ? 0 : (float)(random_bits(random) >> 8) * 0x1p-24f;
    mpfr_t angle, sine, cosine;
    mpfr_inits2(BITS, angle, sine, cosine, (mpfr_ptr)0);
    mpfr_const_pi(angle, MPFR_RNDN);
    mpfr_mul_d(angle, angle, 2 * (double)out->in[1], MPFR_RNDN);
    mpfr_sin_cos(sine, cosine, angle, MPFR_RNDN);
    const double s = sqrt(out->in[0]), direction[3] = {s * mpfr_get_d(cosine, MPFR_RNDN), s * mpfr_get_d(sine, MPFR_RNDN),
                                                       sqrt(1 - (double)out->in[0])};
    mpfr_clears(angle, sine, cosine, (mpfr_ptr)0);
    for (int k = 0; k < 3; k++) expect(out, k, direction[k], 8 * FP32_UNIT * fabs(direction[k]));
}

static bool is_a_direction(const float *in, const float *out) {
    (void)in;
    return is_unit(out, 4 * FP32_UNIT);
}

// --------------------------------------------------------------------------------------------------- directions in a picture

// Angle around from `zero`'s axis, and down from +y; the squares of numbers below 1e-18 may vanish.
static void expect_uv(struct shading_case *out, double zero) {
    const float *n = out->in;
    double around = 0.5 + (n[0] == 0 && n[2] == 0 ? 0 : exact_turns(n[0], zero * n[2]));
    double down = 2 * exact_turns(hypot(n[0], n[2]), n[1]);
    expect(out, 0, around, n[0] == 0 && n[2] == 0 ? 0 : 8 * FP32_UNIT);
    expect(out, 1, down, down == 1 ? 0 : 12 * FP32_UNIT * down + 1e-17);
}

// H15: directions that are unit but for 2^-23, at the poles and next to them: no arc cosine, no NaN.
static void near_pole(struct shading_case *out, struct random *random, uint32_t i) {
    static const float off[] = {0, 1e-4f, 1e-20f, 1e-3f, -1e-7f};
    out->in[0] = off[random_below(random, 5)], out->in[2] = off[random_below(random, 5)];
    out->in[1] = (float)(i % 2 ? -1 : 1) * (1 + (float)((int)(i % 5) - 2) * 0x1p-23f);
    expect_uv(out, -1);
}

// U02: the pole itself, whatever its zeros' signs: the middle.
static void pole(struct shading_case *out, struct random *random, uint32_t i) {
    out->in[0] = random_bits(random) & 1 ? 0.0f : -0.0f, out->in[2] = random_bits(random) & 1 ? 0.0f : -0.0f;
    out->in[1] = i % 2 ? 1 : -1;
    expect(out, 0, 0.5, 0);
    expect(out, 1, i % 2 ? 0 : 1, 0);
}

// U05: latitudes, next to the poles, next to the equator, anywhere.
static void latitudes(struct shading_case *out, struct random *random, uint32_t i) {
    double down = i % 3 == 0 ? pow(10, random_in(random, -7, 0)) : i % 3 == 1 ? 0.25 + random_in(random, -1e-5, 1e-5) : random_unit(random);
    double angle = down * 3.141592653589793, turn = random_in(random, -3, 3);
    out->in[0] = (float)(sin(angle) * sin(turn)), out->in[1] = (float)cos(angle), out->in[2] = (float)(sin(angle) * cos(turn));
    expect_uv(out, 1);
}

// U01: on both sides of the seam.
static void seam(struct shading_case *out, struct random *random, uint32_t i) {
    static const float nasty[] = {0.0f, -0.0f, 1e-30f, -1e-30f, 1e-8f, -1e-8f, 1e-4f, -1e-4f};
    out->in[0] = i % 2 ? nasty[i / 2 % 8] : (float)random_in(random, -1e-3, 1e-3);
    out->in[2] = -1;
    expect(out, 0, 0, -1);
    expect(out, 1, 0.5, 4 * FP32_UNIT);
}

// Within the picture, and around the seam no farther away than rounding.
static bool meets_the_seam(const float *in, const float *out) {
    double right = 0.5 + exact_turns(in[0], in[2]), off = fabs(out[0] - right);
    return out[0] >= 0 && out[0] <= 1 && fmin(off, 1 - off) <= 4 * FP32_UNIT;
}

// ----------------------------------------------------------------------------------------------------------------- texels

static void set_texels(struct shading_case *out, float x, uint32_t count, uint32_t wrap, bool nearest) {
    out->in[0] = x, out->in[1] = (float)count, out->in[2] = (float)wrap, out->in[3] = nearest;
    for (int k = 0; k < 3; k++) expect(out, k, 0, -1);
}

// The place between texel centers that the coordinate has, exactly: how far the one that was found is from it, and that it is within the
// picture.
static bool is_the_place(const float *in, const float *out) {
    double x = in[0], count = in[1], part = x - floor(x), within_two = x - 2 * floor(0.5 * x);
    bool repeats = in[2] == TEXTURE_REPEATS;
    if (in[2] == TEXTURE_MIRRORS) part = within_two > 1 ? 2 - within_two : within_two;
    if (in[2] == TEXTURE_CLAMPS) part = fmin(fmax(x, 0), 1);
    double place = part * count - 0.5, first = out[0], second = out[1];
    if (first < 0 || first >= count || second < 0 || second >= count || !(out[2] >= 0 && out[2] < 1)) return false;
    if (!repeats) place = fmin(fmax(place, 0), count - 1);
    double found = first + (second == first ? 0 : out[2]), off = fabs(found - place);
    if (repeats) off = fmin(off, count - off);
    bool neighbours = second == first || second == first + 1 || (repeats && first == count - 1 && second == 0);
    return neighbours && off <= 8 * FP32_UNIT * count;
}

// U03: next to nothing below 0, of which fract makes 1.
static void below_zero(struct shading_case *out, struct random *random, uint32_t i) {
    float x = i % 4 == 0 ? -1e-9f : -(float)pow(10, random_in(random, -30, -6));
    set_texels(out, x, 2 + random_below(random, 4095), i % 3, false);
}

// U04: what fp32 has left of a fraction behind as much as 1e7 is what counts.
static void large(struct shading_case *out, struct random *random, uint32_t i) {
    float x = i % 4 == 0 ? 1e6f + 0.1f : (float)((i % 2 ? 1 : -1) * pow(10, random_in(random, 2, 8)));
    set_texels(out, x, 2 + random_below(random, 4095), i % 3, false);
}

// U07: where squares begin, at whole numbers and between them, the one that begins is met.
static void checker(struct shading_case *out, struct random *random, uint32_t i) {
    uint32_t count = 1u << random_below(random, 11), texel = random_below(random, count), whole = i % 3 ? random_below(random, 64) : 0;
    set_texels(out, (float)whole + (float)texel / (float)count, count, i % 3 ? TEXTURE_REPEATS : TEXTURE_CLAMPS, true);
    expect(out, 0, texel, 0);
}

// U08: the centers, of pictures of any size, give their texel and nothing of its neighbours.
static void centers(struct shading_case *out, struct random *random, uint32_t i) {
    static const uint32_t sizes[] = {3, 5, 1, 2, 256, 1024};
    uint32_t count = i % 8 < 6 ? sizes[i % 8] : 1 + random_below(random, 8192), texel = random_below(random, count);
    set_texels(out, (float)((texel + 0.5) / count), count, i / 8 % 3, false);
    expect(out, 0, texel, 0);
    expect(out, 2, 0, 0);
}

// ---------------------------------------------------------------------------------------------------------------- normals

// U06: texture coordinates without an area, all the same or on a line, and edges without a length.
static void no_area(struct shading_case *out, struct random *random, uint32_t i) {
    float *e1 = out->in + 3, *e2 = out->in + 6, *duv = out->in + 9, *texel = out->in + 13;
    unit_about(out->in, random, NULL, 0);
    for (int k = 0; k < 3; k++) {
        e1[k] = i % 7 == 0 ? 0 : (float)random_in(random, -1, 1);
        e2[k] = i % 7 == 1 ? e1[k] : (float)random_in(random, -1, 1);
        texel[k] = (float)random_below(random, 256) / 255;
    }
    for (int k = 0; k < 4; k++) duv[k] = i % 4 == 0 ? 0 : (float)(k % 2 + 1) * 0.25f * (float)(i % 4 == 1 ? 1 : k / 2 + 1);
    for (int k = 0; k < 3; k++) expect(out, k, 0, -1);
}

// Unit, and as far from the normal as the texel says, in whatever frame.
static bool leans_as_told(const float *in, const float *out) {
    double m[3], length;
    for (int k = 0; k < 3; k++) m[k] = 2.0 * in[13 + k] - 1;
    length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    return is_unit(out, 4 * FP32_UNIT) && fabs(dot_of(in, out) - m[2] / length) <= 32 * FP32_UNIT;
}

// ------------------------------------------------------------------------------------------------------------------- rows

bool places_picked(struct stress *s) { return run_shading(s, &(struct shading){SHADING_TEXELS, EFFECT_TEXTURES, picked, NULL}); }
bool places_small_light(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_SPHERE_LIGHT, EFFECT_SOFT_SHADOWS, small_light, is_on_the_light});
}
bool places_hemisphere(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_COSINE, EFFECT_INDIRECT, around, is_a_direction});
}
bool places_near_pole(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_SKY_UV, EFFECT_ENVIRONMENT, near_pole, NULL});
}
bool places_seam(struct stress *s) { return run_shading(s, &(struct shading){SHADING_SPHERE_UV, EFFECT_TEXTURES, seam, meets_the_seam}); }
bool places_pole(struct stress *s) { return run_shading(s, &(struct shading){SHADING_SPHERE_UV, EFFECT_TEXTURES, pole, NULL}); }
bool places_latitudes(struct stress *s) { return run_shading(s, &(struct shading){SHADING_SPHERE_UV, EFFECT_TEXTURES, latitudes, NULL}); }
bool places_below_zero(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_TEXELS, EFFECT_TEXTURES, below_zero, is_the_place});
}
bool places_large(struct stress *s) { return run_shading(s, &(struct shading){SHADING_TEXELS, EFFECT_TEXTURES, large, is_the_place}); }
bool places_checker(struct stress *s) { return run_shading(s, &(struct shading){SHADING_TEXELS, EFFECT_TEXTURES, checker, NULL}); }
bool places_centers(struct stress *s) { return run_shading(s, &(struct shading){SHADING_TEXELS, EFFECT_TEXTURES, centers, NULL}); }
bool places_no_area(struct stress *s) {
    return run_shading(s, &(struct shading){SHADING_BEND, EFFECT_NORMAL_MAPS, no_area, leans_as_told});
}
