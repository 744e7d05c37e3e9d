#include "scene/fog.h"

#include <math.h>

static double square_distance(const double a[3], const float b[3]) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += (b[i] - a[i]) * (b[i] - a[i]);
    return sum;
}

struct fog_ball scene_fog_ball(const struct scene *scene) {
    const struct scene_camera *camera = &scene->camera;
    struct fog_ball ball;
    double corner2 = 0;
    for (int i = 0; i < 3; i++) {
        bool empty = !(scene->bounds_min[i] <= scene->bounds_max[i]);
        double low = empty ? camera->position[i] : scene->bounds_min[i], high = empty ? camera->position[i] : scene->bounds_max[i];
        ball.center[i] = 0.5 * (low + high);
        corner2 += 0.25 * (high - low) * (high - low);
    }
    double eye2 = square_distance(ball.center, camera->position);
    if (camera->moves) eye2 = fmax(eye2, square_distance(ball.center, camera->position_end));
    ball.radius = 1.0001 * fmax(sqrt(corner2), sqrt(eye2) + camera->lens_radius); // and a little for what fp32 rounds
    return ball;
}
