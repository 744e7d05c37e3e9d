#include "render/camera.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

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

struct camera_rays camera_rays_make(const struct scene_camera *camera, uint32_t width, uint32_t height) {
    struct vec position = vec_from(camera->position);
    struct vec forward = normalize(sub(vec_from(camera->look_at), position));
    struct vec right = normalize(cross(forward, choose_up(vec_from(camera->up), forward)));
    struct vec up = cross(right, forward);
    double half_height = tan(0.5 * camera->fov_y_deg * (PI / 180.0));
    if (camera->fov_y_deg == 90.0f) half_height = 1.0; // tan(pi/4) is 1 - 1 ulp in fp64
    double pixel = 2.0 * half_height / height;
    double half_width = half_height * width / height;

    struct camera_rays rays;
    for (int i = 0; i < 3; i++) rays.position[i] = camera->position[i];
    store(rays.corner, add(forward, add(scale(right, -half_width), scale(up, half_height))));
    store(rays.du, scale(right, pixel));
    store(rays.dv, scale(up, -pixel));
    return rays;
}

// Each assignment rounds.
struct gn_ray camera_ray(const struct camera_rays *camera, uint32_t x, uint32_t y, const float offset[2]) {
    struct gn_ray ray = {.tmin = 0, .tmax = INFINITY};
    for (int i = 0; i < 3; i++) {
        float right = (float)x * camera->du[i], down = (float)y * camera->dv[i];
        float to_pixel = camera->corner[i] + right;
        to_pixel = to_pixel + down;
        float within_right = offset[0] * camera->du[i], within_down = offset[1] * camera->dv[i];
        float within = within_right + within_down;
        ray.origin[i] = camera->position[i];
        ray.direction[i] = to_pixel + within;
    }
    return ray;
}
