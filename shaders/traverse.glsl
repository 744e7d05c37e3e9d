// Traversal of the bounding volume hierarchy: closest hit or any hit, one function, one call site in each kernel.
//
// While-while after T. Aila and S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009: an inner loop over nodes down to a
// leaf, then a loop over the leaf's primitives; software devices execute both sides of an `if`, but loops skip work. Nearer child first; the
// farther one goes on the stack.
// An instance is met as a leaf of the scene's hierarchy: the traversal goes on in the hierarchy of what it draws, and comes back by a mark on the stack.
// Every loop is bounded by `steps`, which the caller owns; running out is reported, never silent.
#ifndef TRAVERSE_GLSL
#define TRAVERSE_GLSL
#include "constants.glsl"
#include "instance.glsl"
#include "tier_exact.glsl"
#include "tier_fast.glsl"
#include "tier_robust.glsl"
#include "words.glsl"

// The search so far. For tiers without error bounds lo = hi = best.t; in the exact tier best.t lies in [lo, hi], and `maybe` is where the nearest crossing that is
// not certain may begin. A maybe never shortens the ray.
struct search {
    hit best;
    real lo, hi, maybe;
};

// From farther away than this, 2^60 times the scene's size, a direction component that box.glsl takes for 0 moves a ray all the same.
const real FAR = 1.152921504606847e18;

search search_nothing() { return search(hit_none(), INFINITY, INFINITY, INFINITY); }

// Whether something that could change the answer was left open.
bool search_undecided(search q, bool any) {
    if (TIER != TIER_EXACT || q.maybe == INFINITY) return false;
    return any ? q.best.object < 0 : q.maybe <= q.hi;
}

// A crossing at t, as far as the tier knows. Equal t: the lower object, then the lower primitive.
void consider(inout search q, ray r, hit c) {
    bool inside = c.t > r.tmin && c.t < r.tmax;
    bool lower = c.object < q.best.object || (c.object == q.best.object && c.index < q.best.index);
    if (inside && (c.t < q.best.t || (c.t == q.best.t && lower))) {
        q.best = c;
        q.hi = c.t;
    }
}

// A crossing in the exact tier.
void consider_verdict(inout search q, ray r, verdict c, hit candidate) {
    bool possible = c.hi > r.tmin && c.lo < r.tmax && c.lo <= q.hi;
    bool closer = c.certain && c.lo > r.tmin && c.hi < r.tmax && c.hi < q.lo;
    if (possible && !closer && c.lo < q.maybe) q.maybe = c.lo;
    if (closer) {
        q.best = candidate;
        q.lo = c.lo;
        q.hi = c.hi;
    }
}

// Whether a primitive is what the ray is shot at.
bool is_target(ray r, int object, int index) {
    return HAS_SOFT_SHADOWS && object == r.target_object && (index == r.target_index || r.target_index < 0);
}

void test_triangle(uint slot, ray r, shear s, level l, inout search q) {
    uvec4 w0 = triangle_word(TRIANGLE_WORDS * slot);
    uvec4 w1 = triangle_word(TRIANGLE_WORDS * slot + 1u);
    uvec4 w2 = triangle_word(TRIANGLE_WORDS * slot + 2u);
    real3 v0 = level_vertex(l, uintBitsToFloat(w0.xyz)), v1 = level_vertex(l, uintBitsToFloat(w1.xyz)), v2 = level_vertex(l, uintBitsToFloat(w2.xyz));
    uint number = HAS_INSTANCES ? slot + l.offset : slot;
    int object = HAS_INSTANCES && l.is_placed ? l.object : int(w0.w);
    if (number == r.self || is_target(r, object, int(w1.w))) return;
    if (TIER == TIER_EXACT) {
        verdict c = triangle_exact(r.o, s, v0, v1, v2);
        consider_verdict(q, r, c, hit(c.tuv.x, c.tuv.y, c.tuv.z, number, object, int(w1.w)));
    } else {
        real3 tuv = TIER == TIER_FAST ? triangle_fast(r.o, r.d, v0, v1, v2) : triangle_robust(r.o, s, v0, v1, v2);
        consider(q, r, hit(tuv.x, tuv.y, tuv.z, number, object, int(w1.w)));
    }
}

// A ray that starts on the sphere leaves its root at t = 0 out: the other one is 2 (l·d)/(d·d).
real2 sphere_from_itself(ray r, real3 center) {
    real3 l = center - r.o;
    return real2(-INFINITY, 2.0 * dot(l, r.d) / dot(r.d, r.d));
}

void test_sphere_exact(uint number, ray r, real3 center, real radius, int object, inout search q) {
    bool again = r.self == (number | SELF_SPHERE);
    verdict c;
    if (!again) {
        c = sphere_exact(r.o, r.d, center, radius, -1.0);
        consider_verdict(q, r, c, hit(c.tuv.x, 0.0, 0.0, number | SELF_SPHERE, object, 0));
    }
    if (again) c = sphere_exact_again(r.o, r.d, center);
    else c = sphere_exact(r.o, r.d, center, radius, 1.0);
    consider_verdict(q, r, c, hit(c.tuv.x, 0.0, 0.0, number | SELF_SPHERE, object, 0));
}

void test_sphere(uint number, ray r, inout search q) {
    uvec4 w0 = sphere_word(SPHERE_WORDS * number);
    uvec4 w1 = sphere_word(SPHERE_WORDS * number + 1u);
    real3 center = sphere_center(w0, w1, r.time);
    real radius = real(uintBitsToFloat(w0.w));
    if (is_target(r, int(w1.x), 0)) return;
    if (TIER == TIER_EXACT) {
        test_sphere_exact(number, r, center, radius, int(w1.x), q);
        return;
    }
    real2 roots = TIER == TIER_FAST ? sphere_fast(r.o, r.d, center, radius) : sphere_robust(r.o, r.d, center, radius);
    if (r.self == (number | SELF_SPHERE)) roots = sphere_from_itself(r, center);
    real t = roots.x > r.tmin ? roots.x : roots.y;
    consider(q, r, hit(t, 0.0, 0.0, number | SELF_SPHERE, int(w1.x), 0));
}

const uint STACK_ENTRIES = HAS_INSTANCES ? 2 * STACK_SIZE : STACK_SIZE;

// Shoots r. `any`: stops at the first hit. `steps` is counted down by every loop; at 0 the answer is not to be trusted. A driver may also end a loop
// by itself (lavapipe before Mesa 23.1 does, after 65535 iterations of all lanes together): each loop's own condition is checked behind it.
search traverse(ray r, bool any, uint root, inout int steps) {
    search q = search_nothing();
    bool too_far = TIER == TIER_EXACT && root != REF_NONE && !(largest(r.o) <= FAR);
    if (too_far) q.maybe = -REAL_MAX;
    level l = level_scene(r);
    shear s;
    if (TIER != TIER_FAST && HAS_TRIANGLES) s = shear_make(r.d);

    uint stack[STACK_ENTRIES];
    stack[0] = REF_NONE;
    int top = 1;
    uint ref = too_far ? REF_NONE : root;
    do {
        steps--;
        while (HAS_BVH && (ref & REF_LEAF) == 0u && steps > 0) {
            uvec4 w0 = node_word(NODE_WORDS * ref);
            uvec4 w1 = node_word(NODE_WORDS * ref + 1u);
            uvec4 w2 = node_word(NODE_WORDS * ref + 2u);
            uvec4 w3 = node_word(NODE_WORDS * ref + 3u);
            real limit = min(r.tmax, q.hi);
            if (HAS_INSTANCES) limit = limit * l.t_scale + T_SLACK;
            real left = box_enter(real3(uintBitsToFloat(w0.xyz)), real3(uintBitsToFloat(w1.xyz)), l.box, l.t_min, limit);
            real right = box_enter(real3(uintBitsToFloat(w2.xyz)), real3(uintBitsToFloat(w3.xyz)), l.box, l.t_min, limit);
            bool swap = right < left;
            uint near_ref = swap ? w1.w : w0.w, far_ref = swap ? w0.w : w1.w;
            bool enter_near = min(left, right) < INFINITY, enter_far = max(left, right) < INFINITY;
            if (enter_far) {
                stack[top] = far_ref;
                top++;
            }
            if (!enter_near) top--;
            ref = enter_near ? near_ref : stack[top];
            steps--;
        }
        if ((ref & REF_LEAF) == 0u) steps = 0;
        bool is_leaf = ref != REF_NONE;
        if (HAS_INSTANCES && is_leaf && (ref & REF_INSTANCE) != 0u) {
            is_leaf = false;
            if (ref == REF_RETURN) {
                l = level_scene(r);
                top--;
                ref = stack[top];
            } else {
                l = level_instance(r, ref & REF_FIRST_MASK, ref);
                stack[top] = REF_RETURN;
                top++;
            }
        }
        if (is_leaf) {
            uint first = ref & REF_FIRST_MASK;
            uint end = first + ((ref >> REF_COUNT_SHIFT) & 7u) + 1u;
            if (HAS_TRIANGLES && (!HAS_SPHERES || (ref & REF_SPHERES) == 0u)) {
                do {
                    test_triangle(first, r, s, l, q);
                    first++;
                    steps--;
                } while (first < end && steps > 0);
            }
            if (HAS_SPHERES && (!HAS_TRIANGLES || (ref & REF_SPHERES) != 0u)) {
                do {
                    test_sphere(first, r, q);
                    first++;
                    steps--;
                } while (first < end && steps > 0);
            }
            if (first < end) steps = 0;
            top--;
            ref = any && q.best.object >= 0 ? REF_NONE : stack[top];
        }
    } while (ref != REF_NONE && steps > 0);
    if (ref != REF_NONE) steps = 0;
    return q;
}

#endif
