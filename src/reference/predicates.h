// Whether and where a ray crosses a triangle or a sphere, and which of two crossings comes first: decided exactly.
//
// Each decision is made in two stages. The first is fp64 with a proven bound on its error (derived beside each formula); what it leaves
// open goes to exact integers. Intervals of t are kept so that most comparisons need neither. The rules (docs/right-answer.md says why), in
// exact arithmetic on the fp32 inputs:
//
// Triangle. For an edge from p to q, f(p,q) = d·((q-o)×(p-o)); the ray crosses when U = f(v1,v2), V = f(v2,v0) and W = f(v0,v1) have one
// sign, where a zero has the sign of its limit as o moves to o + (ε, ε², ε³): exactly one of two neighbours is crossed at their common
// edge, and a closed surface an even number of times. No area, or a ray in its plane: not crossed. With D = U+V+W and N = (v1-v0)×(v2-v0),
// t = ((v0-o)·N)/(d·N), u = V/D, v = W/D.
// Sphere. F = r²(d·d) - |(c-o)×d|²; F < 0 misses, F = 0 does not; t is the smaller of ((c-o)·d ± √F)/(d·d) that lies within the interval.
// The interval is open at both ends.
#ifndef REFERENCE_PREDICATES_H
#define REFERENCE_PREDICATES_H

#include <stdbool.h>
#include <stdint.h>

#include "gnomon.h"
#include "reference/fraction.h"
#include "reference/interval.h"

// What lies at the end of a shadow ray, a light: it is not in the way. Zeroed is nothing.
struct ref_target {
    bool there;
    uint32_t object;
    int32_t index; // the primitive in it; -1: all of them
};

// A ray with exact components: every number is as exact_holds says, but for infinite bounds. d is not zero; where tmin >= tmax nothing is
// crossed.
struct ref_ray {
    double o[3], d[3];
    double tmin, tmax;
    uint32_t undecided; // decisions that the first stage left open, so far
    struct ref_target target;
    float time; // 0 when the shutter opens, below 1
};

// The exact form of a ray. False, and a zeroed *out, for one that is invalid: a NaN or infinity in o or d, d = 0, a bound that is NaN.
bool ref_ray_make(struct ref_ray *out, const struct gn_ray *ray);

// Which solution of a sphere's equation: t = ((c-o)·d ± √F)/(d·d).
enum sphere_root {
    ROOT_NEAR = -1,
    ROOT_FAR = 1,
    ROOT_OTHER = 0, // of a ray that starts on the sphere by definition: t = 2(c-o)·d/(d·d); the first one is 0
};

enum crossing_kind {
    CROSSING_NONE, // of a primitive that is known by its number alone
    CROSSING_TRIANGLE,
    CROSSING_SPHERE,
};

// Where a ray crosses a primitive.
struct crossing {
    enum crossing_kind kind;
    float v[3][3];    // vertices of a triangle, where they are at the ray's time
    float center[3];  // of a sphere, the same
    float radius;
    int side;              // of a triangle: the sign of d·N; N = (v1-v0)×(v2-v0)
    enum sphere_root root; // of a sphere
    struct interval t;     // contains the exact t; about 36 bits of it at least
    uint32_t number;       // of the primitive as the BVH has them (scene.h), as are the next three: filled by the traversal
    uint32_t object, primitive, material;
};

// Whether the ray crosses within its open interval; if so *out tells where.
bool triangle_cross(struct crossing *out, struct ref_ray *ray, const float *const v[3]);
bool sphere_cross(struct crossing *out, struct ref_ray *ray, const float center[3], float radius);

// The same for the sphere on which the ray starts.
bool sphere_cross_again(struct crossing *out, struct ref_ray *ray, const float center[3], float radius);

// The sign of t_a - t_b.
int crossing_compare(struct ref_ray *ray, const struct crossing *a, const struct crossing *b);

// Intervals of a triangle's weights u (of v1) and v (of v2), about 36 bits each.
void triangle_weights(struct interval *u, struct interval *v, const struct ref_ray *ray, const struct crossing *crossing);

// The unit normal (v1-v0)×(v2-v0), right in fp64 however thin the triangle; 0 if it has no area.
void triangle_normal(double normal[3], const float *const v[3]);

// Whether all of triangle w lies in the plane of triangle v, exactly.
bool triangle_in_plane(const float *const v[3], const float *const w[3]);

// The exact numbers behind a crossing: t; u and v of a triangle.
void crossing_t(struct fraction *t, const struct ref_ray *ray, const struct crossing *crossing);
void crossing_u(struct fraction *u, const struct ref_ray *ray, const struct crossing *crossing);
void crossing_v(struct fraction *v, const struct ref_ray *ray, const struct crossing *crossing);

// For triangle.c and sphere.c: whether out->t lies within the ray's open interval; the exact t of either kind.
bool crossing_inside(struct ref_ray *ray, const struct crossing *crossing);
void triangle_t(struct fraction *t, const struct ref_ray *ray, const struct crossing *crossing);
void sphere_t(struct fraction *t, const struct ref_ray *ray, const struct crossing *crossing);

#endif
