#include "reference/fog.h"

#include <math.h>

#include "reference/vector.h"

static const double PI = 3.14159265358979323846;

struct ref_fog ref_fog_make(const struct scene *scene) { return (struct ref_fog){.ball = scene_fog_ball(scene), .density = scene->fog.density}; }

double ref_fog_transmittance(double density, double way) { return density > 0 ? exp(-density * way) : 1; }

double ref_fog_distance(double density, float u) { return density > 0 ? -log1p(-(double)u) / density : INFINITY; }

void ref_fog_span(double span[2], const struct ref_fog *fog, const double origin[3], const double way[3], double end) {
    double to_center[3], across2 = fog->ball.radius * fog->ball.radius;
    for (int i = 0; i < 3; i++) to_center[i] = fog->ball.center[i] - origin[i];
    double middle = vector_dot(to_center, way);
    for (int i = 0; i < 3; i++) across2 -= (to_center[i] - middle * way[i]) * (to_center[i] - middle * way[i]);
    double half = across2 > 0 ? sqrt(across2) : 0;
    span[0] = fmax(middle - half, 0);
    span[1] = fmin(middle + half, end);
}

double ref_fog_lets_through(const struct ref_fog *fog, const double origin[3], const double way[3], double end) {
    double span[2];
    ref_fog_span(span, fog, origin, way, end);
    return ref_fog_transmittance(fog->density, fmax(span[1] - span[0], 0));
}

bool ref_fog_scatters(double *distance, const struct ref_fog *fog, const double origin[3], const double way[3], double end, float u) {
    double span[2], far = ref_fog_distance(fog->density, u);
    ref_fog_span(span, fog, origin, way, end);
    *distance = span[0] + far;
    return far < span[1] - span[0];
}

double ref_fog_phase(double cosine, double g) { return (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cosine, 1.5)); }

// The inverse of the distribution, cos = (1 + g² - ((1 - g²)/(1 + g·t))²)/2g with t = 2u - 1, has g divided out.
void ref_fog_sample(double scattered[3], double *pdf, const double way[3], double g, const float u[2]) {
    double t = 2.0 * u[0] - 1, n = 1 + g * t;
    double cosine = (t + g * (t * t + 3) / 2 + g * g * t + g * g * g * (t * t - 1) / 2) / (n * n);
    cosine = fmin(fmax(cosine, -1), 1);
    vector_around(scattered, way, sqrt(1 - cosine * cosine), cosine, u[1]);
    *pdf = ref_fog_phase(cosine, g);
}
