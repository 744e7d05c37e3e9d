#include "reference/texture.h"

#include <math.h>

// The picture goes on beyond its edges: which texel is there in place of number i.
static uint32_t wrapped(double i, uint32_t size, enum texture_wrap wrap) {
    double period = wrap == WRAP_MIRROR ? 2.0 * size : size;
    if (wrap == WRAP_CLAMP) return i < 0 ? 0 : i >= size ? size - 1 : (uint32_t)i;
    double within = fmod(i, period);
    if (within < 0) within += period;
    return (uint32_t)(within < size ? within : period - 1 - within);
}

// The texel next to x (1 is the whole picture) on its lower side, and how far x is on the way from its center to the next one's.
static double lower_texel(double x, uint32_t size, bool nearest, double *way) {
    double place = x * size - 0.5, closest = floor(x * size);
    bool there = nearest || fabs(place - closest) <= 1.5e-7 * size;
    *way = there ? 0 : place - floor(place);
    return there ? closest : floor(place);
}

void texture_at(double rgba[4], const struct scene_texture *texture, bool srgb, const double uv[2]) {
    double way[2], low[2];
    low[0] = lower_texel(isfinite(uv[0]) ? uv[0] : 0, texture->width, texture->nearest, &way[0]);
    low[1] = lower_texel(isfinite(uv[1]) ? uv[1] : 0, texture->height, texture->nearest, &way[1]);
    for (int channel = 0; channel < 4; channel++) rgba[channel] = 0;
    for (int corner = 0; corner < 4; corner++) {
        int right = corner & 1, below = corner >> 1;
        double weight = (right ? way[0] : 1 - way[0]) * (below ? way[1] : 1 - way[1]);
        uint32_t x = wrapped(low[0] + right, texture->width, texture->wrap_u),
                 y = wrapped(low[1] + below, texture->height, texture->wrap_v);
        const uint8_t *texel = texture->texels + 4 * ((size_t)y * texture->width + x);
        for (int channel = 0; channel < 4; channel++)
            rgba[channel] += weight * transfer_decode(srgb && channel < 3 ? TRANSFER_SRGB : TRANSFER_LINEAR, texel[channel]);
    }
}

void map_transform(double out[2], const struct scene_map *map, const double uv[2]) {
    double u = uv[0], v = uv[1];
    for (int row = 0; row < 2; row++) {
        const float *m = map->transform + 3 * row;
        out[row] = m[0] * u + m[1] * v + m[2];
    }
}

static const double PI = 3.14159265358979323846;

void sphere_uv(double uv[2], const double n[3]) {
    double across = hypot(n[0], n[2]);
    uv[0] = across > 0 ? 0.5 + atan2(n[0], n[2]) / (2 * PI) : 0.5;
    uv[1] = atan2(across, n[1]) / PI;
}

struct tangent_frame sphere_tangents(const double n[3]) {
    return (struct tangent_frame){
        .e1 = {n[2], 0, -n[0]}, .e2 = {n[0] * n[1], n[1] * n[1] - 1, n[1] * n[2]}, .duv1 = {1, 0}, .duv2 = {0, 1}};
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static bool normalize(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3 && length > 0; i++) v[i] /= length;
    return length > 0 && isfinite(length);
}

static void cross(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// The unit vector across n towards which u grows; false if there is none.
static bool find_tangent(double t[3], const double n[3], const struct tangent_frame *f, double area) {
    if (area == 0) return false;
    for (int i = 0; i < 3; i++) t[i] = (f->e1[i] * f->duv2[1] - f->e2[i] * f->duv1[1]) / area;
    if (!normalize(t)) return false;
    double along = dot(n, t);
    for (int i = 0; i < 3; i++) t[i] -= along * n[i];
    return normalize(t);
}

// Any unit vector across n: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
static void choose_tangent(double t[3], const double n[3]) {
    double side = n[2] >= 0 ? 1 : -1, a = -1 / (side + n[2]);
    t[0] = 1 + side * n[0] * n[0] * a;
    t[1] = side * n[0] * n[1] * a;
    t[2] = -side * n[0];
}

void normal_map_apply(double n[3], const struct tangent_frame *frame, const double texel[3], double scale) {
    double area = frame->duv1[0] * frame->duv2[1] - frame->duv1[1] * frame->duv2[0], t[3], b[3], mapped[3];
    if (!find_tangent(t, n, frame, area)) choose_tangent(t, n);
    cross(b, n, t);
    double rise = 0; // of the picture along b: -∂v
    for (int i = 0; i < 3; i++) rise += b[i] * (frame->e1[i] * frame->duv2[0] - frame->e2[i] * frame->duv1[0]) * (area < 0 ? -1 : 1);
    double x = scale * (2 * texel[0] - 1), y = scale * (2 * texel[1] - 1) * (rise < 0 ? -1 : 1), z = 2 * texel[2] - 1;
    for (int i = 0; i < 3; i++) mapped[i] = x * t[i] + y * b[i] + z * n[i];
    if (!normalize(mapped)) return;
    for (int i = 0; i < 3; i++) n[i] = mapped[i];
}
