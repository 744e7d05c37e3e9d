#include "reference/shade.h"

#include "scene/instances.h"
#include "shaders/shared.h"

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Vectors of fp32 range: their squares neither overflow nor underflow. A zero vector stays zero.
static void normalize(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) v[i] = length > 0 ? v[i] / length : 0;
}

static void turn(double v[3]) {
    for (int i = 0; i < 3; i++) v[i] = -v[i];
}

// A coordinate that the exact predicates accept: what is below 2^-180, a 2^-31th of the smallest fp32 number, counts as 0.
static double snap(double x) { return fabs(x) < 0x1p-180 ? 0 : x; }

// The interpolated vertex normal; false where there is none, or it has no length.
static bool vertex_normal(double n[3], const struct ref_world *world, uint32_t number, double u, double v) {
    struct scene_triangle triangle = scene_triangle_at(world->scene, number);
    const float *normals = scene_mesh_of(world->scene, triangle.object)->normals;
    if (!normals || !(world->effects & EFFECT_SMOOTH_NORMALS)) return false;
    const double weight[3] = {1 - u - v, u, v};
    for (int i = 0; i < 3; i++) {
        n[i] = 0;
        for (int k = 0; k < 3; k++) n[i] += weight[k] * normals[3 * (size_t)triangle.vertex[k] + i];
    }
    scene_place_normal(n, &world->scene->shapes[triangle.object]);
    double length2 = dot(n, n);
    if (!(length2 > 0) || isinf(length2)) return false;
    normalize(n);
    return true;
}

// The point from the weights, base added last; the normal's side from the sign of d·N, which is exact.
static void triangle_surface(struct surface *out, const struct ref_world *world, const struct ref_ray *ray) {
    const float *const v[3] = {out->crossing.v[0], out->crossing.v[1], out->crossing.v[2]};
    struct interval weights[2];
    triangle_weights(&weights[0], &weights[1], ray, &out->crossing);
    double a = interval_mid(weights[0]), b = interval_mid(weights[1]);
    for (int i = 0; i < 3; i++) {
        double e1 = (double)v[1][i] - v[0][i], e2 = (double)v[2][i] - v[0][i];
        out->p[i] = snap(v[0][i] + (a * e1 + b * e2));
    }
    double geometric[3];
    triangle_normal(geometric, v);
    if (out->crossing.side > 0) turn(geometric);
    if (!vertex_normal(out->n, world, out->crossing.number, a, b)) {
        for (int i = 0; i < 3; i++) out->n[i] = geometric[i];
    } else if (dot(out->n, geometric) < 0) {
        turn(out->n);
    }
}

// The point is brought back to the sphere along the normal.
static void sphere_surface(struct surface *out, const struct ref_ray *ray) {
    double t = interval_mid(out->crossing.t);
    const float *center = out->crossing.center;
    for (int i = 0; i < 3; i++) out->n[i] = t * ray->d[i] - (center[i] - ray->o[i]);
    normalize(out->n);
    for (int i = 0; i < 3; i++) out->p[i] = snap(center[i] + out->crossing.radius * out->n[i]);
    if (dot(out->n, ray->d) > 0) turn(out->n);
}

struct surface surface_at(const struct ref_world *world, const struct ref_ray *ray, const struct crossing *crossing) {
    struct surface out = {.crossing = *crossing};
    for (int i = 0; i < 3; i++) out.wo[i] = -ray->d[i];
    normalize(out.wo);
    if (crossing->kind == CROSSING_SPHERE)
        sphere_surface(&out, ray);
    else
        triangle_surface(&out, world, ray);
    return out;
}

// (r·v)^shininess, r the mirror image of l about n; 1 for shininess 0, even where r·v is 0.
static double highlight(const struct surface *surface, const double l[3], double cosine, double shininess) {
    double r[3];
    for (int i = 0; i < 3; i++) r[i] = 2 * cosine * surface->n[i] - l[i];
    return pow(fmax(0, dot(r, surface->wo)), shininess);
}

// What one light gives if nothing is in its way; false if that is nothing.
static bool unshadowed(double color[3], const struct ref_world *world, const struct surface *surface, const struct scene_light *light,
                       const double to_light[3]) {
    double distance2 = dot(to_light, to_light), l[3] = {to_light[0], to_light[1], to_light[2]};
    normalize(l);
    double cosine = dot(surface->n, l); // 0 where the light is at the point itself
    if (!(cosine > 0)) return false;
    const struct scene_material *material = &world->scene->materials[surface->crossing.material];
    double diffuse = world->effects & EFFECT_DIFFUSE ? cosine : 0;
    double specular = world->effects & EFFECT_SPECULAR ? highlight(surface, l, cosine, material->shininess) : 0;
    double falloff = light->falloff == FALLOFF_INVERSE_SQUARE ? distance2 : 1;
    bool any = false;
    for (int i = 0; i < 3; i++) {
        color[i] = light->intensity[i] / falloff * (diffuse * material->diffuse[i] + specular * material->specular[i]);
        any |= color[i] != 0;
    }
    return any;
}

// From the point to the light, both ends open.
static bool is_shadowed(uint64_t *rays, const struct ref_world *world, const struct surface *surface, const double to_light[3]) {
    if (!(world->effects & EFFECT_SHADOWS)) return false;
    struct ref_ray ray = {.tmin = 0, .tmax = 1};
    for (int i = 0; i < 3; i++) {
        ray.o[i] = surface->p[i];
        ray.d[i] = to_light[i];
    }
    ++*rays;
    return any_hit(world, &ray, &surface->crossing);
}

void shade(double color[3], uint64_t *rays, const struct ref_world *world, const struct surface *surface) {
    const struct scene *scene = world->scene;
    const struct scene_material *material = &scene->materials[surface->crossing.material];
    for (int i = 0; i < 3; i++) color[i] = (double)scene->ambient[i] * material->ambient[i];
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const struct scene_light *light = &scene->lights[i];
        double to_light[3], sent[3];
        if (light->type != LIGHT_POINT) continue;
        for (int k = 0; k < 3; k++) to_light[k] = snap(light->position[k] - surface->p[k]);
        if (!unshadowed(sent, world, surface, light, to_light) || is_shadowed(rays, world, surface, to_light)) continue;
        for (int k = 0; k < 3; k++) color[k] += sent[k];
    }
}
