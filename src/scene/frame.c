// Framing: three-quarter view, key light and fill light, as photographers have it.
#include "scene/frame.h"

#include <float.h>
#include <math.h>

#include "scene/instances.h"

#define FOV_DEG 36.0
#define AZIMUTH_DEG 30.0 // to the right of the front
#define ELEVATION_DEG 18.0
#define MARGIN 1.04 // of the ball's apparent radius

static const double DEGREE = 3.14159265358979323846 / 180;

static void widen(struct scene_ball *ball, const float *point, double radius) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += (point[i] - ball->center[i]) * (point[i] - ball->center[i]);
    ball->radius = fmax(ball->radius, sqrt(square) + radius);
}

// Where a mesh is when the shutter opens.
static void widen_mesh(struct scene_ball *ball, const struct scene_shape *shape, const struct scene_mesh *mesh) {
    for (size_t k = 0; k < 3 * (size_t)mesh->triangle_count; k++) {
        float placed[3];
        scene_place(placed, shape, mesh->positions + 3 * (size_t)mesh->indices[k], 0);
        widen(ball, placed, 0);
    }
}

struct scene_ball scene_ball(const struct scene *scene) {
    struct scene_ball ball = {.radius = 0};
    if (scene->bounds_min[0] <= scene->bounds_max[0])
        for (int i = 0; i < 3; i++) ball.center[i] = 0.5 * ((double)scene->bounds_min[i] + scene->bounds_max[i]);
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct scene_shape *shape = &scene->shapes[i];
        if (shape->type == SHAPE_SPHERE)
            widen(&ball, shape->center, shape->radius);
        else
            widen_mesh(&ball, shape, scene_mesh_of(scene, i));
    }
    if (ball.radius == 0) ball.radius = 1;
    return ball;
}

// Stores in fp32; false when a coordinate does not fit.
static bool store(float to[3], const double from[3]) {
    for (int i = 0; i < 3; i++) {
        if (!(fabs(from[i]) <= FLT_MAX)) return false;
        to[i] = (float)from[i];
    }
    return true;
}

bool frame_camera(struct scene_camera *camera, struct context *ctx, const struct scene_ball *ball, int up_axis) {
    const double azimuth = AZIMUTH_DEG * DEGREE, elevation = ELEVATION_DEG * DEGREE;
    // Not so near that fp32 cannot tell the camera from what it looks at.
    double size = 0;
    for (int i = 0; i < 3; i++) size = fmax(size, fabs(ball->center[i]));
    const double distance = fmax(MARGIN * ball->radius / sin(0.5 * FOV_DEG * DEGREE), 1e-4 * size);
    // The front is +z where y is up, and -y where z is up.
    const double right = cos(elevation) * sin(azimuth), up = sin(elevation), front = cos(elevation) * cos(azimuth);
    const double from[3] = {right, up_axis == 1 ? up : -front, up_axis == 1 ? front : up};
    double position[3];
    for (int i = 0; i < 3; i++) position[i] = ball->center[i] + distance * from[i];
    *camera = (struct scene_camera){.fov_y_deg = (float)FOV_DEG};
    camera->up[up_axis] = 1;
    return (store(camera->look_at, ball->center) && store(camera->position, position)) ||
           fail(ctx, GN_SCENE, "the scene is too large to frame it: expected a camera, or coordinates below 1e37");
}

static void unit(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] = length > 0 ? v[i] / length : 0;
}

static void cross(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

bool frame_view(struct scene_camera *camera, const double position[3], const double view[3], const double up[3], double fov_y_deg) {
    double across[3], look_at[3], upward[3] = {up[0], up[1], up[2]}, forward[3] = {view[0], view[1], view[2]};
    unit(forward);
    unit(upward);
    cross(across, forward, upward);
    // A point so far away that its rounding to fp32 does not turn the view.
    const double distance = fmax(1, sqrt(position[0] * position[0] + position[1] * position[1] + position[2] * position[2]));
    for (int i = 0; i < 3; i++) look_at[i] = position[i] + distance * forward[i];
    *camera = (struct scene_camera){.fov_y_deg = (float)fov_y_deg};
    return store(camera->position, position) && store(camera->look_at, look_at) && store(camera->up, upward) && camera->fov_y_deg > 0 &&
           camera->fov_y_deg < 180 && across[0] * across[0] + across[1] * across[1] + across[2] * across[2] > 1e-12;
}

void frame_lights(struct scene_light lights[2], const struct scene_camera *camera, const struct scene_ball *ball) {
    // In units of the radius: to the right, up, and towards the camera.
    static const struct {
        double place[3];
        float intensity;
    } plan[2] = {{{-2.0, 2.6, 3.4}, 0.78f}, {{3.4, 0.4, 2.0}, 0.16f}};
    double back[3], up[3], right[3];
    for (int i = 0; i < 3; i++) back[i] = (double)camera->position[i] - camera->look_at[i], up[i] = camera->up[i];
    unit(back);
    cross(right, up, back);
    unit(right);
    cross(up, back, right);
    for (int k = 0; k < 2; k++) {
        lights[k] = (struct scene_light){.type = LIGHT_POINT, .falloff = FALLOFF_NONE};
        for (int i = 0; i < 3; i++) {
            const double offset = plan[k].place[0] * right[i] + plan[k].place[1] * up[i] + plan[k].place[2] * back[i];
            lights[k].position[i] = (float)fmax(-FLT_MAX, fmin(FLT_MAX, ball->center[i] + ball->radius * offset));
            lights[k].intensity[i] = plan[k].intensity;
        }
    }
}

void frame_exposure(struct scene_light *lights, uint32_t count, const struct scene_ball *ball) {
    double total = 0;
    for (uint32_t k = 0; k < count; k++) {
        double square = 0, brightest = 0;
        for (int i = 0; i < 3; i++) {
            square += (lights[k].position[i] - ball->center[i]) * (lights[k].position[i] - ball->center[i]);
            brightest = fmax(brightest, lights[k].intensity[i]);
        }
        square = fmax(square, ball->radius * ball->radius); // a light inside shines on what is about a radius away
        total += lights[k].falloff == FALLOFF_NONE || lights[k].type == LIGHT_DIRECTIONAL ? brightest : brightest / square;
    }
    if (!(total > 0)) return;
    for (uint32_t k = 0; k < count; k++)
        for (int i = 0; i < 3; i++) lights[k].intensity[i] = (float)fmin(FLT_MAX, lights[k].intensity[i] / total);
}
