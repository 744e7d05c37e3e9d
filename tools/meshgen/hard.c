// Shapes that are hard on an intersection: triangles like needles, and a closed fan around one vertex.
#include "shapes.h"

#include "noise.h"

// A sea urchin: n needles from near the centre to the unit sphere, spread by the golden angle, each some 100 times as long as wide. Its
// normals are those of the flat needles.
bool shape_needles(const struct shape_params *params) {
    const double golden = 0.38196601125010515, half_width = 1.0 / 240, inner = 0.12;
    struct mesh mesh = {0};
    for (uint32_t i = 0; i < params->n; i++) {
        double height = 1 - (2.0 * i + 1) / params->n, radius = sqrt(1 - height * height);
        struct v2 c = circle(golden * i);
        struct v3 tip = v3(radius * c.x, height, radius * c.y);
        struct v3 across = v3_unit(v3_cross(tip, fabs(height) < 0.9 ? v3(0, 1, 0) : v3(1, 0, 0)));
        struct v3 base = v3_scale(tip, inner), normal = v3_cross(across, tip);
        double length = 0.7 + 0.3 * unit_interval(hash3(i, 1, params->seed));
        uint32_t a = mesh_vertex(&mesh, v3_mad(base, -half_width, across), normal);
        uint32_t b = mesh_vertex(&mesh, v3_mad(base, half_width, across), normal);
        mesh_triangle(&mesh, a, b, mesh_vertex(&mesh, v3_scale(tip, length), normal));
    }
    struct ply_params ply = ply_params_for(params);
    return mesh_write(&mesh, &ply);
}

// A flat closed fan in the plane y = 0: n triangles around the origin to the unit circle, seen from above. A ray through the centre or
// through a spoke belongs to exactly one of them.
bool shape_fan(const struct shape_params *params) {
    struct mesh mesh = {0};
    struct v3 up = v3(0, 1, 0);
    uint32_t centre = mesh_vertex(&mesh, v3(0, 0, 0), up);
    for (uint32_t i = 0; i < params->n; i++) {
        struct v2 c = circle((double)i / params->n);
        mesh_vertex(&mesh, v3(c.x, 0, -c.y), up);
    }
    for (uint32_t i = 0; i < params->n; i++) mesh_triangle(&mesh, centre, 1 + i, 1 + (i + 1) % params->n);
    struct ply_params ply = ply_params_for(params);
    return mesh_write(&mesh, &ply);
}
