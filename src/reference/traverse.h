// The closest hit and any hit of a ray in a scene, through its bounding volume hierarchy; exact.
#ifndef REFERENCE_TRAVERSE_H
#define REFERENCE_TRAVERSE_H

#include "bvh/bvh.h"
#include "reference/predicates.h"
#include "scene/scene.h"

// What rays are shot into.
struct ref_world {
    const struct scene *scene;
    const struct bvh *bvh;
    uint32_t effects;        // EFFECT_TRIANGLES, EFFECT_SPHERES and EFFECT_INSTANCES: what can be hit at all
    uint32_t triangle_count; // primitives from this number on are spheres
    uint32_t sphere_count;   // and from triangle_count + sphere_count on triangles of instances; in bvh->order, instances
};

struct ref_world ref_world_make(const struct scene *scene, const struct bvh *bvh, uint32_t effects);

// The crossing with the smallest t; of equal ones that with the lowest object, then the lowest primitive.
bool closest_hit(struct crossing *out, const struct ref_world *world, struct ref_ray *ray);

// The same for a ray that starts on a primitive, as below.
bool closest_hit_from(struct crossing *out, const struct ref_world *world, struct ref_ray *ray, const struct crossing *from);

// Whether there is any crossing. A ray that starts on a primitive leaves it out: `from` (or NULL) says which. A triangle is left out with
// all that lies in its plane (or alone, if `from` has its number but not its vertices), a sphere with the one crossing at the start.
bool any_hit(const struct ref_world *world, struct ref_ray *ray, const struct crossing *from);

#endif
