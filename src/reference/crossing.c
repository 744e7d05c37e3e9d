// Rays, and crossings compared: with the bounds of the ray, and with one another.
#include "reference/predicates.h"

bool ref_ray_make(struct ref_ray *out, const struct gn_ray *ray) {
    *out = (struct ref_ray){.tmin = 0};
    bool moves = false;
    for (int i = 0; i < 3; i++) {
        if (!isfinite(ray->origin[i]) || !isfinite(ray->direction[i])) return false;
        moves |= ray->direction[i] != 0;
    }
    if (!moves || isnan(ray->tmin) || isnan(ray->tmax)) return false;
    *out = (struct ref_ray){.tmin = ray->tmin, .tmax = ray->tmax};
    for (int i = 0; i < 3; i++) {
        out->o[i] = ray->origin[i];
        out->d[i] = ray->direction[i];
    }
    return true;
}

void crossing_t(struct fraction *t, const struct ref_ray *ray, const struct crossing *crossing) {
    if (crossing->kind == CROSSING_SPHERE)
        sphere_t(t, ray, crossing);
    else
        triangle_t(t, ray, crossing);
}

// The sign of t - bound.
static int compare_bound(struct ref_ray *ray, const struct crossing *crossing, double bound) {
    if (crossing->t.lo > bound) return 1;
    if (crossing->t.hi < bound) return -1;
    if (isinf(bound)) return bound < 0 ? 1 : -1; // t is finite, its interval may not be
    ray->undecided++;
    struct fraction t;
    crossing_t(&t, ray, crossing);
    return fraction_compare_number(&t, bound);
}

bool crossing_inside(struct ref_ray *ray, const struct crossing *crossing) {
    return compare_bound(ray, crossing, ray->tmin) > 0 && compare_bound(ray, crossing, ray->tmax) < 0;
}

int crossing_compare(struct ref_ray *ray, const struct crossing *a, const struct crossing *b) {
    if (a->t.hi < b->t.lo) return -1;
    if (a->t.lo > b->t.hi) return 1;
    ray->undecided++;
    struct fraction ta, tb;
    crossing_t(&ta, ray, a);
    crossing_t(&tb, ray, b);
    return fraction_compare(&ta, &tb);
}
