// Rows of the camera: render/camera.c against MPFR at 256 bits.
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <string.h>

#include "measure/stress/oracle.h"
#include "measure/stress/row.h"
#include "render/camera.h"

#define BITS 256

typedef mpfr_t real_vec[3];

static void vec_init(real_vec a) { mpfr_inits2(BITS, a[0], a[1], a[2], (mpfr_ptr)0); }
static void vec_clear(real_vec a) { mpfr_clears(a[0], a[1], a[2], (mpfr_ptr)0); }

static void vec_cross(real_vec out, const real_vec a, const real_vec b) {
    mpfr_t term;
    mpfr_init2(term, BITS);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        mpfr_mul(out[i], a[j], b[k], MPFR_RNDN);
        mpfr_mul(term, a[k], b[j], MPFR_RNDN);
        mpfr_sub(out[i], out[i], term, MPFR_RNDN);
    }
    mpfr_clear(term);
}

static void vec_normalize(real_vec a) {
    mpfr_t length;
    mpfr_init2(length, BITS);
    mpfr_mul(length, a[0], a[0], MPFR_RNDN);
    mpfr_fma(length, a[1], a[1], length, MPFR_RNDN);
    mpfr_fma(length, a[2], a[2], length, MPFR_RNDN);
    mpfr_sqrt(length, length, MPFR_RNDN);
    for (int k = 0; k < 3; k++) mpfr_div(a[k], a[k], length, MPFR_RNDN);
    mpfr_clear(length);
}

// The exact camera: forward, right and up, unit; and half the height of a film at distance 1.
struct exact_camera {
    real_vec forward, right, up;
    mpfr_t half_height;
};

static void exact_camera_make(struct exact_camera *out, const struct scene_camera *camera) {
    vec_init(out->forward), vec_init(out->right), vec_init(out->up);
    mpfr_init2(out->half_height, BITS);
    for (int k = 0; k < 3; k++) {
        mpfr_set_flt(out->forward[k], camera->look_at[k], MPFR_RNDN);
        mpfr_sub_d(out->forward[k], out->forward[k], (double)camera->position[k], MPFR_RNDN);
        mpfr_set_flt(out->up[k], camera->up[k], MPFR_RNDN);
    }
    vec_cross(out->right, out->forward, out->up);
    vec_normalize(out->forward);
    vec_normalize(out->right);
    vec_cross(out->up, out->right, out->forward);
    mpfr_const_pi(out->half_height, MPFR_RNDN);
    mpfr_mul_d(out->half_height, out->half_height, (double)camera->fov_y_deg, MPFR_RNDN);
    mpfr_div_ui(out->half_height, out->half_height, 360, MPFR_RNDN);
    mpfr_tan(out->half_height, out->half_height, MPFR_RNDN);
}

static void exact_camera_clear(struct exact_camera *camera) {
    vec_clear(camera->forward), vec_clear(camera->right), vec_clear(camera->up);
    mpfr_clear(camera->half_height);
}

// forward + x·right + y·up, x and y in units of half the film's height.
static void exact_direction(double out[3], const struct exact_camera *camera, double x, double y) {
    mpfr_t sum, term;
    mpfr_inits2(BITS, sum, term, (mpfr_ptr)0);
    for (int k = 0; k < 3; k++) {
        mpfr_mul_d(sum, camera->right[k], x, MPFR_RNDN);
        mpfr_mul_d(term, camera->up[k], y, MPFR_RNDN);
        mpfr_add(sum, sum, term, MPFR_RNDN);
        mpfr_mul(sum, sum, camera->half_height, MPFR_RNDN);
        mpfr_add(sum, sum, camera->forward[k], MPFR_RNDN);
        out[k] = mpfr_get_d(sum, MPFR_RNDN);
    }
    mpfr_clears(sum, term, (mpfr_ptr)0);
}

// The direction through the middle of a pixel as camera.h defines it.
static void ray_direction(float out[3], const struct camera_frame *frame, uint32_t x, uint32_t y) {
    for (int k = 0; k < 3; k++) {
        float to_pixel = (frame->corner[k] + (float)x * frame->du[k]) + (float)y * frame->dv[k];
        out[k] = to_pixel + (0.5f * frame->du[k] + 0.5f * frame->dv[k]);
    }
}

enum { WIDTH = 640, HEIGHT = 480 };

// The largest error of a pixel's direction, in pixels, over a grid of pixels.
static double worst_pixel(const struct scene_camera *camera) {
    struct camera_rays rays;
    camera_rays_make(&rays, camera, WIDTH, HEIGHT);
    struct exact_camera exact;
    double worst = 0;
    exact_camera_make(&exact, camera);
    double pixel = 2 * mpfr_get_d(exact.half_height, MPFR_RNDN) / HEIGHT;
    for (uint32_t y = 0; y < HEIGHT; y += 37)
        for (uint32_t x = 0; x < WIDTH; x += 37) {
            double right[3], off = 0;
            float got[3];
            exact_direction(right, &exact, (x + 0.5 - 0.5 * WIDTH) / (0.5 * HEIGHT), (0.5 * HEIGHT - y - 0.5) / (0.5 * HEIGHT));
            ray_direction(got, &rays.frames[0], x, y);
            for (int k = 0; k < 3; k++) off = fmax(off, fabs(got[k] - right[k]));
            worst = isfinite(off) ? fmax(worst, off / pixel) : INFINITY;
        }
    exact_camera_clear(&exact);
    return worst;
}

static void judge_pixels(struct tally *tally, const struct scene_camera *camera, double most) {
    double off = worst_pixel(camera);
    tally->rays++;
    if (!(off <= most)) tally_wrong(tally, "%g degrees: rays off by up to %g pixels", camera->fov_y_deg, off);
}

// C01: angles next to 180 degrees, where tan in fp32 is off by percents.
bool cameras_wide(struct stress *s) {
    static const float angles[] = {179.9999f, 0x1.67fffep7f, 179.9f, 179, 150, 90, 60, 45};
    struct tally tally = {0};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++)
        for (int k = 0; k < 16; k++) {
            double view[3];
            struct scene_camera camera = {.up = {0.3f, 1, -0.2f}, .fov_y_deg = angles[i]};
            random_direction(view, &s->random);
            for (int j = 0; j < 3; j++) camera.look_at[j] = (float)view[j];
            judge_pixels(&tally, &camera, 1e-3);
        }
    tally_every(s, &tally);
    return true;
}

// C02: a hundred times as far with a hundredth of the angle. Along an axis the direction's small components keep their digits; askew, a
// direction of fp32 numbers has steps of 6e-8, and that is more than a pixel.
bool cameras_narrow(struct stress *s) {
    static const float angles[] = {1, 0.01f, 1e-4f, 1e-6f};
    static const struct {
        float view[3], up[3];
    } cameras[] = {{{0, 0, -1}, {0, 1, 0}}, {{1e6f, 0, 0}, {0, 1, 0}}, {{0, -1e-6f, 0}, {0, 0, 1}}};
    struct tally tally = {0};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++)
        for (int k = 0; k < 3; k++) {
            struct scene_camera camera = {.fov_y_deg = angles[i]};
            memcpy(camera.look_at, cameras[k].view, sizeof camera.look_at);
            memcpy(camera.up, cameras[k].up, sizeof camera.up);
            judge_pixels(&tally, &camera, 1e-3);
        }
    const struct scene_camera askew = {.look_at = {1, 2, -3}, .up = {0, 1, 0}, .fov_y_deg = 1e-4f};
    snprintf(tally.note, sizeof tally.note, "askew at 1e-4 degrees a ray is off by %.2g pixels: an fp32 direction has no more",
             worst_pixel(&askew));
    tally_every(s, &tally);
    return true;
}

static double dot(const float a[3], const float b[3]) { return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2]; }

// Whether du, dv and the middle ray are at right angles and of the right lengths.
static bool is_upright(const struct camera_frame *frame, double pixel) {
    float middle[3];
    for (int k = 0; k < 3; k++) middle[k] = (frame->corner[k] + (float)WIDTH / 2 * frame->du[k]) + (float)HEIGHT / 2 * frame->dv[k];
    return fabs(dot(frame->du, frame->dv)) <= 1e-6 * pixel * pixel && fabs(dot(frame->du, middle)) <= 1e-6 * pixel &&
           fabs(dot(frame->dv, middle)) <= 1e-6 * pixel && fabs(dot(middle, middle) - 1) <= 1e-5 &&
           fabs(dot(frame->du, frame->du) / (pixel * pixel) - 1) <= 1e-5 && fabs(dot(frame->dv, frame->dv) / (pixel * pixel) - 1) <= 1e-5;
}

// C04: up along the view, exactly, against it, and nearly. Whatever is chosen instead is a camera.
bool cameras_up_along_view(struct stress *s) {
    struct tally tally = {0};
    const double pixel = 2.0 / HEIGHT;
    for (int i = 0; i < 300; i++) {
        struct scene_camera camera = {.fov_y_deg = 90};
        double view[3];
        random_direction(view, &s->random);
        if (i < 6) view[0] = i % 3 == 0, view[1] = i % 3 == 1, view[2] = i % 3 == 2;
        for (int k = 0; k < 3; k++) {
            camera.look_at[k] = (float)view[k];
            camera.up[k] = camera.look_at[k] * (i % 2 ? 1 : -1) * (i % 3 ? 1 : 1e10f);
            if (i % 5 == 4) camera.up[k] = random_ulps(&s->random, camera.up[k], 3);
        }
        struct camera_rays rays;
        camera_rays_make(&rays, &camera, WIDTH, HEIGHT);
        tally.rays++;
        if (!is_upright(&rays.frames[0], pixel))
            tally_wrong(&tally, "view (%a, %a, %a), up (%a, %a, %a)", view[0], view[1], view[2], camera.up[0], camera.up[1], camera.up[2]);
    }
    tally_every(s, &tally);
    return true;
}
