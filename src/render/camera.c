#include "render/camera.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
#define LARGEST_LENS 0x1p100 // over a pixel: what is larger is blurred beyond seeing

struct vec { double x, y, z; };

static struct vec vec_from(const float v[3]) { return (struct vec){v[0], v[1], v[2]}; }
static struct vec sub(struct vec a, struct vec b) { return (struct vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static struct vec scale(struct vec a, double s) { return (struct vec){a.x * s, a.y * s, a.z * s}; }
static struct vec add(struct vec a, struct vec b) { return (struct vec){a.x + b.x, a.y + b.y, a.z + b.z}; }
static double dot(struct vec a, struct vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static struct vec cross(struct vec a, struct vec b) { return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
// Lengths of fp32 vectors neither overflow nor underflow in fp64.
static struct vec normalize(struct vec a) { return scale(a, 1.0 / sqrt(dot(a, a))); }

// `up` made usable: where it is (nearly) parallel to the view (a scene file's own never is), the axis that is farthest from the view stands in.
static struct vec choose_up(struct vec up, struct vec forward) {
    struct vec side = cross(forward, up);
    if (dot(side, side) > 1e-24 * dot(up, up)) return up;
    double x = fabs(forward.x), y = fabs(forward.y), z = fabs(forward.z);
    if (z <= x && z <= y) return (struct vec){0, 0, 1};
    return y <= x ? (struct vec){0, 1, 0} : (struct vec){1, 0, 0};
}

static void store(float to[3], struct vec v) {
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

// Half the film's height at distance 1, and a pixel's.
static double half_height_of(const struct scene_camera *camera) {
    return camera->fov_y_deg == 90.0f ? 1.0 : tan(0.5 * camera->fov_y_deg * (PI / 180.0)); // tan(pi/4) is 1 - 1 ulp in fp64
}

static double pixel_of(const struct scene_camera *camera, uint32_t height) { return 2.0 * half_height_of(camera) / height; }

static struct vec between(const float a[3], const float b[3], double time) { return add(vec_from(a), scale(sub(vec_from(b), vec_from(a)), time)); }

// The frame when the shutter has been open for `time`; false where the camera is at what it looks at.
static bool make_frame(struct camera_frame *out, const struct scene_camera *camera, double time, uint32_t width, uint32_t height) {
    struct vec view = sub(vec_from(camera->look_at), vec_from(camera->position));
    if (camera->moves) view = sub(between(camera->look_at, camera->look_at_end, time), between(camera->position, camera->position_end, time));
    if (!(dot(view, view) > 0)) return false;
    struct vec forward = normalize(view);
    struct vec right = normalize(cross(forward, choose_up(vec_from(camera->up), forward)));
    struct vec up = cross(right, forward);
    double half_height = half_height_of(camera), pixel = pixel_of(camera, height);
    double half_width = half_height * width / height;
    store(out->corner, add(forward, add(scale(right, -half_width), scale(up, half_height))));
    store(out->du, scale(right, pixel));
    store(out->dv, scale(up, -pixel));
    return true;
}

void camera_rays_make(struct camera_rays *out, const struct scene_camera *camera, uint32_t width, uint32_t height) {
    *out = (struct camera_rays){0};
    for (int i = 0; i < 3; i++) {
        out->position[i] = camera->position[i];
        if (camera->moves) out->travel[i] = camera->position_end[i] - camera->position[i];
    }
    make_frame(&out->frames[0], camera, 0, width, height);
    for (int i = 1; i <= CAMERA_FRAMES; i++)
        if (!camera->moves || !make_frame(&out->frames[i], camera, (double)i / CAMERA_FRAMES, width, height)) out->frames[i] = out->frames[i - 1];
    if (!(camera->lens_radius > 0)) return;
    double lens = camera->lens_radius / pixel_of(camera, height);
    out->lens = (float)fmin(lens, LARGEST_LENS);
    out->aim = (float)fmin(lens / camera->focus_distance, LARGEST_LENS);
}

void camera_rays_rebase(struct camera_rays *camera, const float base[3]) {
    for (int i = 0; i < 3; i++) {
        camera->base[i] = base[i];
        camera->position[i] = (float)((double)camera->position[i] - base[i]);
    }
}

// ---------------------------------------------------------------------------------------------- fp32: each assignment rounds

static float between_frames(float a, float b, float share) {
    float way = b - a;
    float part = share * way;
    return a + part;
}

static struct camera_frame frame_at(const struct camera_rays *camera, float time) {
    float frames = time * CAMERA_FRAMES; // exact
    int first = (int)frames;
    float share = frames - (float)first;
    const struct camera_frame *a = &camera->frames[first], *b = a + 1;
    struct camera_frame frame;
    for (int i = 0; i < 3; i++) {
        frame.corner[i] = between_frames(a->corner[i], b->corner[i], share);
        frame.du[i] = between_frames(a->du[i], b->du[i], share);
        frame.dv[i] = between_frames(a->dv[i], b->dv[i], share);
    }
    return frame;
}

// A component of a film position, of a point of the lens, relative to the middle.
static float across(float right, float du, float down, float dv) {
    float first = right * du, second = down * dv;
    return first + second;
}

struct gn_ray camera_ray(const struct camera_rays *camera, uint32_t x, uint32_t y, const struct camera_sample *sample) {
    struct gn_ray ray = {.tmin = 0, .tmax = INFINITY};
    struct camera_frame frame = frame_at(camera, sample->time);
    float lens[2], aim[2];
    for (int i = 0; i < 2; i++) {
        lens[i] = sample->lens[i] * camera->lens;
        aim[i] = sample->lens[i] * camera->aim;
    }
    for (int i = 0; i < 3; i++) {
        float du = frame.du[i], dv = frame.dv[i];
        float right = (float)x * du, down = (float)y * dv;
        float to_pixel = frame.corner[i] + right;
        to_pixel = to_pixel + down;
        float direction = to_pixel + across(sample->offset[0], du, sample->offset[1], dv);
        float way = sample->time * camera->travel[i];
        float middle = camera->position[i] + way;
        ray.direction[i] = direction - across(aim[0], du, aim[1], dv);
        ray.origin[i] = middle + across(lens[0], du, lens[1], dv);
    }
    return ray;
}

// 1/x for 2^-24 ≤ x ≤ 1: a first guess from the exponent's complement, off by 12 % at most, and three steps of Newton's, each of which squares the error.
static float inverse_of(float x) {
    uint32_t bits;
    float inverse;
    memcpy(&bits, &x, sizeof bits);
    bits = 0x7ef311c7u - bits;
    memcpy(&inverse, &bits, sizeof inverse);
    for (int i = 0; i < 3; i++) {
        float product = x * inverse;
        float rest = 2.0f - product;
        inverse = inverse * rest;
    }
    return inverse;
}

// Horner's scheme.
static float polynomial(const float coefficients[5], float t) {
    float sum = coefficients[0];
    for (int i = 1; i < 5; i++) {
        float product = sum * t;
        sum = product + coefficients[i];
    }
    return sum;
}

// The distance from the middle is that of the square, the angle pi/4 times how far around the square's side; its sine and cosine are Taylor's, to 3e-8.
void camera_disk_point(float point[2], const float u[2]) {
    static const float sines[] = {3.13361689e-7f, -3.65762042e-5f, 0.00249039457f, -0.0807455122f, 0.785398163f};
    static const float cosines[] = {3.59086045e-6f, -0.000325991887f, 0.0158543442f, -0.308425138f, 1};
    float at[2] = {2 * u[0] - 1, 2 * u[1] - 1}; // exact
    int along = fabsf(at[0]) > fabsf(at[1]) ? 0 : 1;
    float r = at[along], side = at[1 - along];
    float turn = (r < 0 ? -side : side) * inverse_of(fmaxf(fabsf(r), 0x1p-24f)); // in the middle 0/0 is 0
    float t = turn * turn;
    float sine = polynomial(sines, t) * turn;
    point[along] = r * polynomial(cosines, t);
    point[1 - along] = r * sine;
}
