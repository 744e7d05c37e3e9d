// A trefoil: a tube around the (2, 3) torus knot, closed. The frame along the curve follows the torus that the knot lies on, so that it
// closes on itself without a twist left over.
#include "shapes.h"

#define TURNS_AROUND_AXIS 2
#define TURNS_THROUGH_HOLE 3

struct frame {
    struct v3 point, side, up;
}; // side and up are unit, at right angles to the curve

static struct frame knot_frame(double t) {
    const double ring = 0.62, reach = 0.26;
    struct v2 a = circle(TURNS_AROUND_AXIS * t), b = circle(TURNS_THROUGH_HOLE * t);
    double radius = ring + reach * b.x;
    struct v3 tangent = v3(-TURNS_THROUGH_HOLE * reach * b.y * a.x - TURNS_AROUND_AXIS * radius * a.y, TURNS_THROUGH_HOLE * reach * b.x,
                           -TURNS_THROUGH_HOLE * reach * b.y * a.y + TURNS_AROUND_AXIS * radius * a.x);
    struct v3 along = v3_unit(tangent), outward = v3(b.x * a.x, b.y, b.x * a.y);
    struct v3 side = v3_unit(v3_mad(outward, -v3_dot(outward, along), along));
    return (struct frame){v3(radius * a.x, reach * b.y, radius * a.y), side, v3_cross(along, side)};
}

bool shape_torus_knot(const struct shape_params *params) {
    const double thickness = 0.145;
    uint32_t around = params->n, along = 12 * params->n;
    struct mesh mesh = {0};
    for (uint32_t i = 0; i < along; i++) {
        struct frame frame = knot_frame((double)i / along);
        for (uint32_t j = 0; j < around; j++) {
            struct v2 c = circle((double)j / around);
            struct v3 normal = v3_mad(v3_scale(frame.side, c.x), c.y, frame.up);
            mesh_vertex(&mesh, v3_mad(frame.point, thickness, normal), v3_unit(normal));
        }
    }
    for (uint32_t i = 0; i < along; i++)
        for (uint32_t j = 0; j < around; j++) {
            uint32_t here = i * around, next = (i + 1) % along * around, k = (j + 1) % around;
            mesh_quad(&mesh, here + j, here + k, next + k, next + j);
        }
    struct ply_params ply = ply_params_for(params);
    return mesh_write(&mesh, &ply);
}
