// texture.glsl and normal_map.glsl against the reference, in fp32 and in fp64, and both against answers that are known.
#include "twins.h"

#include "reference/texture.h"
#include "render/upload_textures.h"
#include "shaders/shared.h"
#include "twin_tangent.h"
#include "twin_tangent_fp64.h"
#include "twin_texture.h"
#include "twin_texture_fp64.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define CASES 8192

// ------------------------------------------------------------------------------------------------------------- textures

// Numbers in and out of an invocation.
enum { TEXTURE, SRGB, U, V, IN };
enum { RED, ALPHA = 3, OUT };

static const struct { uint32_t width, height; } SIZES[] = {{1, 1}, {2, 2}, {4, 8}, {3, 5}, {7, 1}, {1, 9}, {257, 129}, {641, 3}, {4096, 1}};
#define VARIANTS 10 // wraps of u, of v, and the nearest texel
#define TEXTURES (COUNT(SIZES) * VARIANTS)

// Random textures of each size, with every wrap of u and of v; the tenth of a size takes the nearest texel.
static void make_textures(struct scene *scene) {
    *scene = (struct scene){.textures = calloc(TEXTURES, sizeof *scene->textures), .texture_count = TEXTURES};
    assert_non_null(scene->textures);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        struct scene_texture *t = &scene->textures[i];
        uint32_t variant = i % VARIANTS;
        *t = (struct scene_texture){.width = SIZES[i / VARIANTS].width, .height = SIZES[i / VARIANTS].height, .nearest = variant == 9};
        t->wrap_u = (enum texture_wrap)(variant % 3), t->wrap_v = (enum texture_wrap)(variant / 3 % 3);
        size_t bytes = 4 * (size_t)t->width * t->height;
        t->texels = malloc(bytes);
        assert_non_null(t->texels);
        for (size_t k = 0; k < bytes; k++) t->texels[k] = (uint8_t)random_bits();
    }
}

static void free_textures(struct scene *scene) {
    for (uint32_t i = 0; i < scene->texture_count; i++) free(scene->textures[i].texels);
    free(scene->textures);
}

static void lookup(const struct scene *scene, bool fp64, double in[][IN], double out[][OUT], uint32_t count) {
    struct device_textures textures;
    struct kernel_binding bindings[DEVICE_TEXTURES_BINDINGS];
    fixture_assert(device_textures_init(&textures, fixture_context(), fixture_device(), scene, EFFECT_TEXTURES));
    device_textures_bindings(&textures, bindings);
    const struct twins twins = {TWINS(twin_texture), .in = IN, .out = OUT, .bindings = bindings, .binding_count = DEVICE_TEXTURES_BINDINGS};
    twins_run(&twins, fp64, in[0], out[0], count);
    device_textures_finish(&textures, fixture_device());
}

static double decoded(const struct scene_texture *t, uint32_t x, uint32_t y, int channel, bool srgb) {
    const uint8_t *texel = t->texels + 4 * ((size_t)y * t->width + x);
    return transfer_decode(srgb && channel < 3 ? TRANSFER_SRGB : TRANSFER_LINEAR, texel[channel]);
}

// U08: the coordinates of a texel's center, rounded to fp32, give the texel to the last bit, whatever the size. A little beside it is
// another color.
static void check_centers(const struct scene *scene, bool fp64, double shift) {
    static double in[CASES][IN], out[CASES][OUT];
    static uint32_t place[CASES][2];
    for (int i = 0; i < CASES; i++) {
        uint32_t number = random_bits() % TEXTURES;
        const struct scene_texture *t = &scene->textures[number];
        uint32_t x = place[i][0] = random_bits() % t->width, y = place[i][1] = random_bits() % t->height;
        in[i][TEXTURE] = number, in[i][SRGB] = i & 1;
        in[i][U] = (float)((x + 0.5) / t->width + shift), in[i][V] = (float)((y + 0.5) / t->height);
    }
    lookup(scene, fp64, in, out, CASES);
    int wrong = 0;
    for (int i = 0; i < CASES; i++) {
        const struct scene_texture *t = &scene->textures[(int)in[i][TEXTURE]];
        bool same = true;
        for (int k = 0; k < OUT; k++) same &= out[i][k] == decoded(t, place[i][0], place[i][1], k, in[i][SRGB] == 1);
        double rgba[4];
        texture_at(rgba, t, in[i][SRGB] == 1, &in[i][U]);
        for (int k = 0; k < OUT; k++) same &= rgba[k] == decoded(t, place[i][0], place[i][1], k, in[i][SRGB] == 1);
        wrong += !same;
        if (!same && shift == 0) fail_msg("fp%d texel %u, %u of %u x %u", fp64 ? 64 : 32, place[i][0], place[i][1], t->width, t->height);
    }
    if (shift != 0) assert_true(wrong > CASES / 2);
}

static void centers_are_their_texels(void **state) {
    (void)state;
    struct scene scene;
    make_textures(&scene);
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        check_centers(&scene, fp64, 0);
        check_centers(&scene, fp64, 0x1p-21);
    }
    free_textures(&scene);
}

// Anywhere: what the weights may be off by, since a coordinate has 24 bits (53), and a few roundings of the colors. The control is a
// texture that wraps or decodes in another way.
static void lookups_agree_with_the_reference(void **state) {
    (void)state;
    static double in[CASES][IN], out[CASES][OUT];
    struct scene scene;
    make_textures(&scene);
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        for (int i = 0; i < CASES; i++) {
            double size = i % 4 == 0 ? 1000 : i % 4 == 1 ? 3 : 1;
            in[i][TEXTURE] = random_bits() % TEXTURES, in[i][SRGB] = i & 1;
            for (int k = U; k <= V; k++) in[i][k] = (float)random_in(-size, size);
        }
        lookup(&scene, fp64, in, out, CASES);
        int caught = 0, checked = 0;
        for (int i = 0; i < CASES; i++) {
            const struct scene_texture *t = &scene.textures[(int)in[i][TEXTURE]];
            double x = in[i][U] * t->width, y = in[i][V] * t->height, unit = fp64 ? 0x1p-52 : 0x1p-23;
            double limit = 8 * unit + 2 * unit * (fabs(x) + fabs(y) + t->width + t->height), rgba[4], other[4], worst = 0, worst_other = 0;
            if (t->nearest && (fabs(x - round(x)) <= limit || fabs(y - round(y)) <= limit)) continue;
            struct scene_texture changed = *t;
            changed.wrap_u = (enum texture_wrap)((t->wrap_u + 1) % 3);
            texture_at(rgba, t, in[i][SRGB] == 1, &in[i][U]);
            texture_at(other, &changed, in[i][SRGB] != 1, &in[i][U]);
            for (int k = 0; k < OUT; k++) {
                worst = fmax(worst, fabs(out[i][k] - rgba[k]));
                worst_other = fmax(worst_other, fabs(out[i][k] - other[k]));
                if (!(fabs(out[i][k] - rgba[k]) <= limit))
                    fail_msg("fp%d (%a, %a) of texture %g: channel %d is %g, not %g", fp64 ? 64 : 32, in[i][U], in[i][V], in[i][TEXTURE], k,
                             out[i][k], rgba[k]);
            }
            caught += worst_other > limit;
            checked++;
        }
        assert_true(checked > CASES * 9 / 10 && caught > checked * 9 / 10);
    }
    free_textures(&scene);
}

// Odd coordinates, on a row of four texels or a checkerboard of two by two. The answer is the mean of two texels, which may be the same.
struct odd {
    const char *name;
    uint32_t width, height;
    bool nearest;
    enum texture_wrap wrap;
    double u, v;
    uint32_t texel[2]; // by number
};

static const struct odd ODD[] = {
    {"U03: just left of 0, nearest", 4, 1, true, WRAP_REPEAT, -1e-9, 0.5, {3, 3}},
    {"U03: just left of 0", 4, 1, false, WRAP_REPEAT, -0x1p-60, 0.5, {3, 0}},
    {"U03: just left of 0, mirrored", 4, 1, true, WRAP_MIRROR, -1e-9, 0.5, {0, 0}},
    {"0", 4, 1, false, WRAP_REPEAT, 0, 0.5, {3, 0}},
    {"0, clamped", 4, 1, false, WRAP_CLAMP, 0, 0.5, {0, 0}},
    {"1", 4, 1, false, WRAP_REPEAT, 1, 0.5, {3, 0}},
    {"1, nearest", 4, 1, true, WRAP_REPEAT, 1, 0.5, {0, 0}},
    {"1, clamped", 4, 1, false, WRAP_CLAMP, 1, 0.5, {3, 3}},
    {"1, clamped, nearest", 4, 1, true, WRAP_CLAMP, 1, 0.5, {3, 3}},
    {"1, mirrored, nearest", 4, 1, true, WRAP_MIRROR, 1, 0.5, {3, 3}},
    {"1 + 1/8, mirrored", 4, 1, false, WRAP_MIRROR, 1.125, 0.5, {3, 3}},
    {"-1/4, mirrored", 4, 1, false, WRAP_MIRROR, -0.25, 0.5, {0, 1}},
    {"5, clamped", 4, 1, false, WRAP_CLAMP, 5, 0.5, {3, 3}},
    {"-5, clamped", 4, 1, false, WRAP_CLAMP, -5, 0.5, {0, 0}},
    {"below 1, nearest", 4, 1, true, WRAP_REPEAT, 1 - 0x1p-24, 0.5, {3, 3}},
    {"U04: 1e6 + 0.1, which fp32 has as 1e6 + 1/8", 4, 1, false, WRAP_REPEAT, 1000000.125, 0.5, {0, 0}},
    {"1e30", 4, 1, true, WRAP_REPEAT, 1e30, 0.5, {0, 0}},
    {"-1e30, mirrored", 4, 1, true, WRAP_MIRROR, -1e30, 0.5, {0, 0}},
    {"-1e30, clamped", 4, 1, true, WRAP_CLAMP, -1e30, 0.5, {0, 0}},
    {"NaN counts as 0", 4, 1, true, WRAP_REPEAT, NAN, 0.5, {0, 0}},
    {"infinity counts as 0", 4, 1, true, WRAP_CLAMP, INFINITY, 0.5, {0, 0}},
    {"NaN in v", 2, 2, true, WRAP_MIRROR, 0.25, NAN, {0, 0}},
    {"U07: checkers on a floor at v = 0", 2, 2, true, WRAP_REPEAT, 0.25, 0, {0, 0}},
    {"U07: at -0", 2, 2, true, WRAP_REPEAT, 0.25, -0.0, {0, 0}},
    {"U07: at 1/2", 2, 2, true, WRAP_REPEAT, 0.25, 0.5, {2, 2}},
    {"U07: at 1", 2, 2, true, WRAP_REPEAT, 0.25, 1, {0, 0}},
    {"U07: at 7, and at an edge of u", 2, 2, true, WRAP_REPEAT, 0.5, 7, {1, 1}},
};

static void odd_coordinates(void **state) {
    (void)state;
    static double in[COUNT(ODD)][IN], out[COUNT(ODD)][OUT];
    static uint8_t texels[16] = {0, 10, 20, 255, 50, 60, 70, 255, 100, 120, 140, 0, 255, 254, 253, 128};
    struct scene_texture textures[COUNT(ODD)];
    const struct scene scene = {.textures = textures, .texture_count = COUNT(ODD)};
    for (uint32_t i = 0; i < COUNT(ODD); i++) {
        textures[i] = (struct scene_texture){.width = ODD[i].width, .height = ODD[i].height, .nearest = ODD[i].nearest, .texels = texels};
        textures[i].wrap_u = textures[i].wrap_v = ODD[i].wrap;
        in[i][TEXTURE] = i, in[i][U] = ODD[i].u, in[i][V] = ODD[i].v;
    }
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        lookup(&scene, fp64, in, out, COUNT(ODD));
        for (uint32_t i = 0; i < COUNT(ODD); i++) {
            double rgba[4];
            texture_at(rgba, &textures[i], false, &in[i][U]);
            for (int k = 0; k < OUT; k++) {
                double right = 0.5 * (transfer_decode(TRANSFER_LINEAR, texels[4 * ODD[i].texel[0] + (uint32_t)k]) +
                                      transfer_decode(TRANSFER_LINEAR, texels[4 * ODD[i].texel[1] + (uint32_t)k]));
                if (!(fabs(out[i][k] - right) <= 1e-7)) fail_msg("fp%d %s: channel %d is %g", fp64 ? 64 : 32, ODD[i].name, k, out[i][k]);
                if (!(fabs(rgba[k] - right) <= 1e-7)) fail_msg("reference, %s: channel %d is %g", ODD[i].name, k, rgba[k]);
            }
        }
    }
}

static void no_texture_no_texels(void **state) {
    (void)state;
    struct scene scene;
    struct device_textures textures;
    make_textures(&scene);
    fixture_assert(device_textures_init(&textures, fixture_context(), fixture_device(), &scene, 0));
    assert_true(textures.texels.size == 16 && textures.textures.size == 16);
    device_textures_finish(&textures, fixture_device());
    device_textures_finish(&textures, fixture_device());
    free_textures(&scene);
}

// ----------------------------------------------------------------------------------------------------------- normals, spheres

// Numbers in and out of an invocation.
struct tangent_in {
    double n[3], e1[3], e2[3], duv1[2], duv2[2], texel[3], scale;
};
struct tangent_out {
    double mapped[3], on_sphere[3], uv[2], transformed[2];
};

static void map_normals(bool fp64, const struct tangent_in *in, struct tangent_out *out, uint32_t count) {
    const struct scene none = {0};
    struct device_textures textures;
    struct kernel_binding bindings[DEVICE_TEXTURES_BINDINGS];
    fixture_assert(device_textures_init(&textures, fixture_context(), fixture_device(), &none, 0));
    device_textures_bindings(&textures, bindings);
    const struct twins twins = {TWINS(twin_tangent), .in = sizeof *in / sizeof(double), .out = sizeof *out / sizeof(double),
                                .bindings = bindings, .binding_count = DEVICE_TEXTURES_BINDINGS};
    twins_run(&twins, fp64, (const double *)in, (double *)out, count);
    device_textures_finish(&textures, fixture_device());
}

static double distance(const double *a, const double *b, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

static struct tangent_frame frame_of(const struct tangent_in *in) {
    struct tangent_frame frame;
    memcpy(frame.e1, in->e1, sizeof frame.e1);
    memcpy(frame.e2, in->e2, sizeof frame.e2);
    memcpy(frame.duv1, in->duv1, sizeof frame.duv1);
    memcpy(frame.duv2, in->duv2, sizeof frame.duv2);
    return frame;
}

// Each to the nearest fp32. Volatile: GCC 12.2, when it does some in one go, leaves others as they are.
static void round_numbers(double *numbers, size_t count) {
    for (size_t i = 0; i < count; i++) {
        volatile float rounded = (float)numbers[i];
        numbers[i] = rounded;
    }
}

// A triangle whose texture coordinates are neither next to a line nor its normal next to its tangent: there the answer would hang on the
// last bits.
static void random_tangents(struct tangent_in *in, bool fp64) {
    do {
        random_direction(in->n);
        random_direction(in->e1);
        random_direction(in->e2);
        for (int k = 0; k < 2; k++) in->duv1[k] = random_in(-1, 1), in->duv2[k] = random_in(-1, 1);
        for (int k = 0; k < 3; k++) in->texel[k] = random_in(k == 2 ? 0.6 : 0, 1);
        in->scale = random_in(0, 2);
        round_numbers(in->e1, 3); // these are a map's words, too
        round_numbers(in->e2, 3);
        if (!fp64) round_numbers((double *)in, sizeof *in / sizeof(double));
        double right[3], length = 0, along = 0;
        for (int k = 0; k < 3; k++) right[k] = in->e1[k] * in->duv2[1] - in->e2[k] * in->duv1[1];
        for (int k = 0; k < 3; k++) length += right[k] * right[k], along += right[k] * in->n[k];
        if (length > 0.01 && along * along < 0.9 * length && fabs(in->duv1[0] * in->duv2[1] - in->duv1[1] * in->duv2[0]) > 0.01) return;
    } while (true);
}

static void normals_and_spheres_agree_with_the_reference(void **state) {
    (void)state;
    static struct tangent_in in[CASES];
    static struct tangent_out out[CASES];
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        double limit = fp64 ? 1e-13 : 2e-5, uv_limit = fp64 ? 1e-15 : 3e-7;
        int caught = 0;
        for (int i = 0; i < CASES; i++) random_tangents(&in[i], fp64);
        map_normals(fp64, in, out, CASES);
        for (int i = 0; i < CASES; i++) {
            struct tangent_frame frame = frame_of(&in[i]), sphere = sphere_tangents(in[i].n), mirrored = frame;
            mirrored.duv1[1] = -frame.duv1[1], mirrored.duv2[1] = -frame.duv2[1];
            double mapped[3], on_sphere[3], other[3], uv[2], transformed[2];
            memcpy(mapped, in[i].n, sizeof mapped), memcpy(on_sphere, in[i].n, sizeof mapped), memcpy(other, in[i].n, sizeof mapped);
            normal_map_apply(mapped, &frame, in[i].texel, in[i].scale);
            normal_map_apply(other, &mirrored, in[i].texel, in[i].scale);
            normal_map_apply(on_sphere, &sphere, in[i].texel, in[i].scale);
            sphere_uv(uv, in[i].n);
            struct scene_map map;
            for (int k = 0; k < 3; k++) map.transform[k] = (float)in[i].e1[k], map.transform[3 + k] = (float)in[i].e2[k];
            map_transform(transformed, &map, in[i].duv1);
            if (!(distance(out[i].mapped, mapped, 3) <= limit)) fail_msg("normal off by %g", distance(out[i].mapped, mapped, 3));
            if (!(distance(out[i].on_sphere, on_sphere, 3) <= limit * 10))
                fail_msg("sphere off by %g", distance(out[i].on_sphere, on_sphere, 3));
            if (!(distance(out[i].uv, uv, 2) <= uv_limit)) fail_msg("(%a, %a) is off by %g", uv[0], uv[1], distance(out[i].uv, uv, 2));
            if (!(distance(out[i].transformed, transformed, 2) <= uv_limit))
                fail_msg("fp%d: (%a, %a) is transformed to (%a, %a)", fp64 ? 64 : 32, transformed[0], transformed[1], out[i].transformed[0],
                         out[i].transformed[1]);
            caught += distance(out[i].mapped, other, 3) > limit;
        }
        assert_true(caught > CASES * 9 / 10);
    }
}

struct known_normal {
    const char *name;
    struct tangent_in in;
    double right[3]; // of map_normal; 0 for any unit vector across n
};

#define FLOOR_UP .n = {0, 0, 1}, .e1 = {1, 0, 0}, .e2 = {0, 1, 0}, .scale = 1
static const struct known_normal KNOWN[] = {
    {"flat", {FLOOR_UP, .duv1 = {1, 0}, .duv2 = {0, -1}, .texel = {0.5, 0.5, 1}}, {0, 0, 1}},
    {"red: along u", {FLOOR_UP, .duv1 = {1, 0}, .duv2 = {0, -1}, .texel = {1, 0.5, 0.5}}, {1, 0, 0}},
    {"green: up the picture", {FLOOR_UP, .duv1 = {1, 0}, .duv2 = {0, -1}, .texel = {0.5, 1, 0.5}}, {0, 1, 0}},
    {"red, mirrored", {FLOOR_UP, .duv1 = {-1, 0}, .duv2 = {0, -1}, .texel = {1, 0.5, 0.5}}, {-1, 0, 0}},
    {"green, mirrored", {FLOOR_UP, .duv1 = {-1, 0}, .duv2 = {0, -1}, .texel = {0.5, 1, 0.5}}, {0, 1, 0}},
    {"green, upside down", {FLOOR_UP, .duv1 = {1, 0}, .duv2 = {0, 1}, .texel = {0.5, 1, 0.5}}, {0, -1, 0}},
    {"red, tiny coordinates", {FLOOR_UP, .duv1 = {1e-12, 0}, .duv2 = {0, -1e-12}, .texel = {1, 0.5, 0.5}}, {1, 0, 0}},
    {"scale 0", {.n = {0, 0, 1}, .e1 = {1, 0, 0}, .e2 = {0, 1, 0}, .duv1 = {1, 0}, .duv2 = {0, 1}, .texel = {1, 0, 0.75}}, {0, 0, 1}},
    {"a texel that says nothing", {FLOOR_UP, .duv1 = {1, 0}, .duv2 = {0, -1}, .texel = {0.5, 0.5, 0.5}}, {0, 0, 1}},
    {"U06: coordinates without area", {FLOOR_UP, .duv1 = {0, 0}, .duv2 = {0, 0}, .texel = {1, 0.5, 0.5}}, {0, 0, 0}},
    {"U06: on a line", {FLOOR_UP, .duv1 = {1, 2}, .duv2 = {2, 4}, .texel = {0.5, 1, 0.5}}, {0, 0, 0}},
    {"normal along the tangent",
     {.n = {1, 0, 0}, .e1 = {1, 0, 0}, .e2 = {0, 1, 0}, .duv1 = {1, 0}, .duv2 = {0, 1}, .texel = {1, 0.5, 0.5}, .scale = 1},
     {0, 0, 0}},
};

static void normals_that_are_known(void **state) {
    (void)state;
    struct tangent_in in[COUNT(KNOWN)];
    struct tangent_out out[COUNT(KNOWN)];
    for (size_t i = 0; i < COUNT(KNOWN); i++) in[i] = KNOWN[i].in;
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        map_normals(fp64, in, out, COUNT(KNOWN));
        for (size_t i = 0; i < COUNT(KNOWN); i++) {
            struct tangent_frame frame = frame_of(&in[i]);
            double n[3];
            memcpy(n, in[i].n, sizeof n);
            normal_map_apply(n, &frame, in[i].texel, in[i].scale);
            const double *answers[2] = {out[i].mapped, n};
            for (int who = 0; who < 2; who++) {
                const double *m = answers[who], zero[3] = {0, 0, 0};
                double across = m[0] * in[i].n[0] + m[1] * in[i].n[1] + m[2] * in[i].n[2];
                bool any = distance(KNOWN[i].right, zero, 3) == 0;
                bool good = any ? fabs(distance(m, zero, 3) - 1) <= 1e-6 && fabs(across) <= 1e-6 : distance(m, KNOWN[i].right, 3) <= 1e-6;
                if (!good) fail_msg("fp%d %s: (%g, %g, %g)", who ? 0 : fp64 ? 64 : 32, KNOWN[i].name, m[0], m[1], m[2]);
            }
        }
    }
}

struct known_uv {
    const char *name;
    double n[3], uv[2];
};

static const struct known_uv SPHERE[] = {
    {"the middle", {0, 0, 1}, {0.5, 0.5}},
    {"right of it", {1, 0, 0}, {0.75, 0.5}},
    {"left of it", {-1, 0, 0}, {0.25, 0.5}},
    {"U01: the seam", {0, 0, -1}, {1, 0.5}},
    {"U01: the seam at -0", {-0.0, 0, -1}, {1, 0.5}},
    {"U01: beside the seam", {-1e-20, 0, -1}, {0, 0.5}},
    {"U02: the north pole", {0, 1, 0}, {0.5, 0}},
    {"U02: the south pole", {0, -1, 0}, {0.5, 1}},
    {"U02: the south pole at -0", {-0.0, -1, -0.0}, {0.5, 1}},
    {"U05: next to the pole", {1e-4, 1, 0}, {0.75, 3.1830988512e-5}},
};

static void spheres_that_are_known(void **state) {
    (void)state;
    struct tangent_in in[COUNT(SPHERE)] = {0};
    struct tangent_out out[COUNT(SPHERE)];
    for (size_t i = 0; i < COUNT(SPHERE); i++) memcpy(in[i].n, SPHERE[i].n, sizeof in[i].n);
    for (int fp64 = 0; fp64 < twins_count(); fp64++) {
        map_normals(fp64, in, out, COUNT(SPHERE));
        for (size_t i = 0; i < COUNT(SPHERE); i++) {
            double u = out[i].uv[0], v = out[i].uv[1];
            if (!(fabs(u - SPHERE[i].uv[0]) <= 1e-7 && fabs(v - SPHERE[i].uv[1]) <= 2e-7 * SPHERE[i].uv[1]))
                fail_msg("fp%d %s: (%a, %a)", fp64 ? 64 : 32, SPHERE[i].name, u, v);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(centers_are_their_texels),
        cmocka_unit_test(lookups_agree_with_the_reference),
        cmocka_unit_test(odd_coordinates),
        cmocka_unit_test(no_texture_no_texels),
        cmocka_unit_test(normals_and_spheres_agree_with_the_reference),
        cmocka_unit_test(normals_that_are_known),
        cmocka_unit_test(spheres_that_are_known),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
