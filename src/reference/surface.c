#include "reference/surface.h"

#include <string.h>

#include "reference/texture.h"
#include "reference/vector.h"
#include "scene/instances.h"
#include "shaders/shared.h"

#define EFFECTS_WITH_UVS (EFFECT_TEXTURES | EFFECT_NORMAL_MAPS | EFFECT_ALPHA)

static void turn(double v[3]) {
    for (int i = 0; i < 3; i++) v[i] = -v[i];
}

// The interpolated vertex normal; false where there is none, or it has no length.
static bool vertex_normal(double n[3], const struct ref_world *world, const struct scene_triangle *triangle, const double weight[3]) {
    const float *normals = scene_mesh_of(world->scene, triangle->object)->normals;
    if (!normals || !(world->effects & EFFECT_SMOOTH_NORMALS)) return false;
    for (int i = 0; i < 3; i++) {
        n[i] = 0;
        for (int k = 0; k < 3; k++) n[i] += weight[k] * normals[3 * (size_t)triangle->vertex[k] + i];
    }
    scene_place_normal(n, &world->scene->shapes[triangle->object]);
    double length2 = vector_dot(n, n);
    if (!(length2 > 0) || isinf(length2)) return false;
    vector_normalize(n);
    return true;
}

// Texture coordinates, and how they run over the triangle: with the edges e1 = du1·P + dv1·Q and e2 = du2·P + dv2·Q, P and Q up to a positive factor.
static void vertex_uv(struct surface *out, const struct ref_world *world, const struct scene_triangle *triangle, const double weight[3]) {
    const float *uvs = scene_mesh_of(world->scene, triangle->object)->uvs, *uv[3];
    if (!uvs) return;
    const float (*v)[3] = (const float (*)[3])out->crossing.v;
    for (int k = 0; k < 3; k++) uv[k] = uvs + 2 * (size_t)triangle->vertex[k];
    for (int i = 0; i < 2; i++) out->uv[i] = weight[0] * uv[0][i] + weight[1] * uv[1][i] + weight[2] * uv[2][i];
    const double u1 = (double)uv[1][0] - uv[0][0], v1 = (double)uv[1][1] - uv[0][1], u2 = (double)uv[2][0] - uv[0][0], v2 = (double)uv[2][1] - uv[0][1];
    const double side = u1 * v2 - v1 * u2 < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) {
        const double e1 = (double)v[1][i] - v[0][i], e2 = (double)v[2][i] - v[0][i];
        out->du[i] = side * (v2 * e1 - v1 * e2);
        out->dv[i] = side * (u1 * e2 - u2 * e1);
    }
}

// The point from the weights, base added last; the normal's side from the sign of d·N, which is exact.
static void triangle_surface(struct surface *out, const struct ref_world *world, const struct ref_ray *ray) {
    const float *const v[3] = {out->crossing.v[0], out->crossing.v[1], out->crossing.v[2]};
    struct interval weights[2];
    triangle_weights(&weights[0], &weights[1], ray, &out->crossing);
    const double a = interval_mid(weights[0]), b = interval_mid(weights[1]), weight[3] = {1 - a - b, a, b};
    for (int i = 0; i < 3; i++) {
        double e1 = (double)v[1][i] - v[0][i], e2 = (double)v[2][i] - v[0][i];
        out->p[i] = exact_snap(v[0][i] + (a * e1 + b * e2));
    }
    struct scene_triangle triangle = scene_triangle_at(world->scene, out->crossing.number);
    triangle_normal(out->ng, v);
    out->front = out->crossing.side <= 0;
    if (!out->front) turn(out->ng);
    if (!vertex_normal(out->n, world, &triangle, weight)) {
        for (int i = 0; i < 3; i++) out->n[i] = out->ng[i];
    } else if (vector_dot(out->n, out->ng) < 0) {
        turn(out->n);
    }
    if (world->effects & EFFECTS_WITH_UVS) vertex_uv(out, world, &triangle, weight);
}

// The point is brought back to the sphere along the normal.
static void sphere_surface(struct surface *out, const struct ref_world *world, const struct ref_ray *ray) {
    double t = interval_mid(out->crossing.t);
    const float *center = out->crossing.center;
    for (int i = 0; i < 3; i++) out->ng[i] = t * ray->d[i] - (center[i] - ray->o[i]);
    vector_normalize(out->ng);
    for (int i = 0; i < 3; i++) out->p[i] = exact_snap(center[i] + out->crossing.radius * out->ng[i]);
    if (world->effects & EFFECTS_WITH_UVS) {
        const struct tangent_frame frame = sphere_tangents(out->ng);
        sphere_uv(out->uv, out->ng);
        memcpy(out->du, frame.e1, sizeof out->du);
        memcpy(out->dv, frame.e2, sizeof out->dv);
    }
    out->front = vector_dot(out->ng, ray->d) <= 0;
    if (!out->front) turn(out->ng);
    for (int i = 0; i < 3; i++) out->n[i] = out->ng[i];
}

struct surface surface_at(const struct ref_world *world, const struct ref_ray *ray, const struct crossing *crossing) {
    struct surface out = {.crossing = *crossing};
    for (int i = 0; i < 3; i++) out.wo[i] = -ray->d[i];
    vector_normalize(out.wo);
    if (crossing->kind == CROSSING_SPHERE)
        sphere_surface(&out, world, ray);
    else
        triangle_surface(&out, world, ray);
    return out;
}
