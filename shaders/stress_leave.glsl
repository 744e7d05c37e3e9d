// A ray to a surface and one that leaves it, for the stress cases, as a picture's camera ray and shadow ray do. Included by
// stress_leave.comp and, with FP64 defined, by stress_leave_fp64.comp.
#ifndef STRESS_LEAVE_GLSL
#define STRESS_LEAVE_GLSL
#include "constants.glsl"
#include "stress.glsl"
#include "surface.glsl"
#include "traverse.glsl"

layout(set = 0, binding = BINDING_STATUS) buffer status_buffer { status dispatch_status; };

void put_hit(uint at, hit h, bool undecided) {
    result[at] = float(h.t);
    result[at + 1u] = intBitsToFloat(h.object);
    result[at + 2u] = intBitsToFloat(h.index);
    result[at + 3u] = undecided ? 1.0 : 0.0;
}

// Where the second ray starts, in device coordinates: three numbers, or the bits of three doubles.
#ifdef FP64
void put_start(uint at, dvec3 start) {
    for (int k = 0; k < 3; k++) {
        uvec2 bits = unpackDouble2x32(start[k]);
        result[at + 2u * uint(k)] = uintBitsToFloat(bits.x);
        result[at + 2u * uint(k) + 1u] = uintBitsToFloat(bits.y);
    }
}
#else
void put_start(uint at, vec3 start) { put3(at, start); }
#endif

// In: origin (scene units), direction, direction of the second ray, turned to the side of the surface that the first one sees. Out:
// STRESS_LEAVE_OUT numbers: first hit (t, object, index, undecided), second hit, start, direction of the second ray, shading normal.
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.count) return;
    uint from = STRESS_LEAVE_IN * i, to = STRESS_LEAVE_OUT * i;
    int steps = int(MAX_STEPS);
    precise real3 from_base = given3(from) - real3(args.base.xyz);
    ray r = ray_make(from_base * args.base.w, given3(from + 3u), 0.0, INFINITY, SELF_NONE);
    bool again = false, second = false;
    do {
        search q = traverse(r, false, args.root, steps);
        bool undecided = search_undecided(q, false);
        put_hit(second ? to + 4u : to, q.best, undecided);
        again = !second && !undecided && q.best.object >= 0;
        if (again) {
            surface s = surface_at(r, q.best);
            real3 start = leave_surface(s), direction = given3(from + 6u);
            if (dot(direction, s.ng) < 0.0) direction = -direction;
            put_start(to + 8u, start);
            put3(to + 14u, direction);
            put3(to + 17u, s.n);
            r = ray_make(start, direction, 0.0, INFINITY, leave_self(s));
        }
        second = true;
    } while (again && steps > 0);
    if (steps <= 0) atomicAdd(dispatch_status.stuck, 1u);
}

#endif
