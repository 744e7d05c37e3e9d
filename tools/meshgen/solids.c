#include "solids.h"

#define ARC_STEPS 4 // segments of a rounded corner

struct ring {
    struct v2 point, normal;
}; // of a profile: (radius, height) and the outward normal there
struct rings {
    struct ring at[LATHE_MAX_CORNERS * (ARC_STEPS + 1)];
    unsigned count;
};

static void put_ring(struct rings *rings, struct v2 point, struct v2 normal) {
    rings->at[rings->count++] = (struct ring){point, v2_unit(normal)};
}

// The rings of one corner between the directions it is entered and left by: an arc tangent to both, or two normals at one point.
static void put_corner(struct rings *rings, struct corner corner, struct v2 in, struct v2 out) {
    struct v2 point = {corner.radius, corner.height}, n0 = v2_left(in), n1 = v2_left(out);
    double turn = v2_cross(in, out), side = turn < 0 ? 1 : -1;
    double cut = corner.rounding * fabs(turn) / (1 + v2_dot(in, out)); // R·tan(angle/2): how far the arc begins before the corner
    struct v2 centre = v2_mad(v2_mad(point, -cut, in), -side * corner.rounding, n0);
    for (int k = 0; corner.rounding > 0 && k <= ARC_STEPS; k++) {
        double t = (double)k / ARC_STEPS;
        struct v2 n = v2_unit(v2_mad(v2_mad(v2(0, 0), 1 - t, n0), t, n1));
        put_ring(rings, v2_mad(centre, side * corner.rounding, n), n);
    }
    if (corner.rounding > 0) return;
    put_ring(rings, point, n0);
    put_ring(rings, point, n1);
}

static struct v2 corner_direction(const struct corner *from, const struct corner *to) {
    return v2_unit(v2(to->radius - from->radius, to->height - from->height));
}

static void put_profile(struct rings *rings, const struct corner *profile, unsigned count, bool closed) {
    rings->count = 0;
    for (unsigned k = 0; k < count; k++) {
        const struct corner *here = profile + k, *before = profile + (k + count - 1) % count, *after = profile + (k + 1) % count;
        if (closed || (k > 0 && k + 1 < count)) {
            put_corner(rings, *here, corner_direction(before, here), corner_direction(here, after));
        } else {
            struct v2 along = k == 0 ? corner_direction(here, after) : corner_direction(before, here);
            put_ring(rings, v2(here->radius, here->height), v2_left(along));
        }
    }
}

// Vertices of a ring around the axis, one at a pole. Returns the first one's number.
static uint32_t put_circle(struct mesh *mesh, struct ring ring, unsigned count) {
    uint32_t first = mesh->vertex_count;
    for (unsigned k = 0; k < count; k++) {
        struct v2 c = circle((double)k / count);
        struct v3 position = v3(ring.point.x * c.x, ring.point.y, -ring.point.x * c.y);
        mesh_vertex(mesh, position, v3_unit(v3(ring.normal.x * c.x, ring.normal.y, -ring.normal.x * c.y)));
    }
    return first;
}

void add_band(struct mesh *mesh, uint32_t upper, unsigned upper_count, uint32_t lower, unsigned lower_count) {
    unsigned count = upper_count > lower_count ? upper_count : lower_count;
    for (unsigned k = 0; k < count; k++) {
        unsigned next = (k + 1) % count;
        if (upper_count == 1)
            mesh_triangle(mesh, upper, lower + k, lower + next);
        else if (lower_count == 1)
            mesh_triangle(mesh, upper + k, lower, upper + next);
        else
            mesh_quad(mesh, upper + k, lower + k, lower + next, upper + next);
    }
}

void add_lathe(struct mesh *mesh, const struct corner *profile, unsigned count, bool ring, unsigned segments) {
    struct rings rings;
    put_profile(&rings, profile, count, ring);
    uint32_t above = 0, first = mesh->vertex_count;
    unsigned above_count = 0;
    for (unsigned k = 0; k < rings.count; k++) {
        unsigned here_count = rings.at[k].point.x > 0 ? segments : 1;
        uint32_t here = put_circle(mesh, rings.at[k], here_count);
        struct v2 step = k ? v2_sub(rings.at[k].point, rings.at[k - 1].point) : v2(0, 0);
        if (v2_dot(step, step) > 0) add_band(mesh, above, above_count, here, here_count);
        above = here;
        above_count = here_count;
    }
    if (ring) add_band(mesh, above, segments, first, segments);
}

// How the outline of a plate looks at the two ends of its segment from point k to the next.
struct wall {
    struct v2 end[2], normal[2], mitre[2];
};

static struct v2 outward(struct v2 from, struct v2 to) {
    struct v2 along = v2_unit(v2_sub(to, from));
    return v2(along.y, -along.x);
}

static struct wall wall_at(const struct v2 *outline, unsigned k, unsigned count) {
    struct wall wall;
    struct v2 own = outward(outline[k], outline[(k + 1) % count]);
    for (unsigned e = 0; e < 2; e++) {
        unsigned here = (k + e) % count, before = (here + count - 1) % count, after = (here + 1) % count;
        struct v2 other = e == 0 ? outward(outline[before], outline[here]) : outward(outline[here], outline[after]);
        struct v2 sum = v2_add(own, other);
        double cosine = v2_dot(own, other);
        wall.end[e] = outline[here];
        wall.normal[e] = cosine > 0.9 ? v2_unit(sum) : own;
        wall.mitre[e] = v2(sum.x / (1 + cosine), sum.y / (1 + cosine)); // moves both neighbouring segments by 1
    }
    return wall;
}

// A strip between heights z0 and z1 along one segment, inset by i0 and i1; the normal leans by `lean` towards z.
static void add_wall_strip(struct mesh *mesh, const struct wall *wall, double i0, double z0, double i1, double z1, double lean) {
    uint32_t v[2][2];
    for (int e = 0; e < 2; e++) {
        struct v3 normal = v3_unit(v3(wall->normal[e].x, wall->normal[e].y, lean));
        struct v2 low = v2_mad(wall->end[e], -i0, wall->mitre[e]), high = v2_mad(wall->end[e], -i1, wall->mitre[e]);
        v[e][0] = mesh_vertex(mesh, v3(low.x, low.y, z0), normal);
        v[e][1] = mesh_vertex(mesh, v3(high.x, high.y, z1), normal);
    }
    mesh_quad(mesh, v[0][0], v[1][0], v[1][1], v[0][1]);
}

static void add_walls(struct mesh *mesh, const struct v2 *outline, unsigned count, double thickness, double bevel) {
    double z = thickness / 2;
    for (unsigned k = 0; k < count; k++) {
        struct wall wall = wall_at(outline, k, count);
        add_wall_strip(mesh, &wall, bevel, -z, 0, bevel - z, -1);
        add_wall_strip(mesh, &wall, 0, bevel - z, 0, z - bevel, 0);
        add_wall_strip(mesh, &wall, 0, z - bevel, bevel, z, 1);
    }
}

// One side of a plate: the strip between the inset outline and the inset hole.
static void add_face(struct mesh *mesh, const struct v2 *outline, const struct v2 *hole, unsigned count, double z, double bevel) {
    struct v3 normal = v3(0, 0, z > 0 ? 1 : -1);
    uint32_t first = mesh->vertex_count;
    for (unsigned k = 0; k < count; k++) {
        struct wall outer = wall_at(outline, k, count), inner = wall_at(hole, k, count);
        struct v2 o = v2_mad(outer.end[0], -bevel, outer.mitre[0]), i = v2_mad(inner.end[0], bevel, inner.mitre[0]);
        mesh_vertex(mesh, v3(o.x, o.y, z), normal);
        mesh_vertex(mesh, v3(i.x, i.y, z), normal);
    }
    for (unsigned k = 0; k < count; k++) {
        uint32_t here = first + 2 * k, next = first + 2 * ((k + 1) % count);
        if (z > 0)
            mesh_quad(mesh, here, next, next + 1, here + 1);
        else
            mesh_quad(mesh, here, here + 1, next + 1, next);
    }
}

void add_plate(struct mesh *mesh, const struct v2 *outline, const struct v2 *hole, unsigned count, double thickness, double bevel) {
    struct v2 reversed[256]; // the hole as its walls see it: clockwise, the solid on the left
    for (unsigned k = 0; k < count; k++) reversed[k] = hole[count - 1 - k];
    add_face(mesh, outline, hole, count, thickness / 2, bevel);
    add_face(mesh, outline, hole, count, -thickness / 2, bevel);
    add_walls(mesh, outline, count, thickness, bevel);
    add_walls(mesh, reversed, count, thickness, bevel);
}

void add_prism(struct mesh *mesh, const struct v2 *polygon, unsigned count, double bottom, double top) {
    uint32_t lid = mesh->vertex_count;
    for (unsigned k = 0; k < count; k++) mesh_vertex(mesh, on_dial(polygon[k], top), v3(0, 1, 0));
    for (unsigned k = 2; k < count; k++) mesh_triangle(mesh, lid, lid + k - 1, lid + k);
    uint32_t base = mesh->vertex_count;
    for (unsigned k = 0; k < count; k++) mesh_vertex(mesh, on_dial(polygon[k], bottom), v3(0, -1, 0));
    for (unsigned k = 2; k < count; k++) mesh_triangle(mesh, base, base + k, base + k - 1);
    for (unsigned k = 0; k < count; k++) {
        struct v2 from = polygon[k], to = polygon[(k + 1) % count];
        struct v3 normal = on_dial(outward(from, to), 0);
        uint32_t a = mesh_vertex(mesh, on_dial(from, bottom), normal), b = mesh_vertex(mesh, on_dial(to, bottom), normal);
        uint32_t c = mesh_vertex(mesh, on_dial(to, top), normal), d = mesh_vertex(mesh, on_dial(from, top), normal);
        mesh_quad(mesh, a, b, c, d);
    }
}

// A ring of a bar at point k, at right angles to the curve there. Returns its first vertex.
static uint32_t put_bar_ring(struct mesh *mesh, const struct v2 *points, unsigned k, unsigned count, double radius, unsigned around) {
    struct v2 left = v2_left(v2_unit(v2_sub(points[k + 1 < count ? k + 1 : k], points[k > 0 ? k - 1 : k])));
    uint32_t first = mesh->vertex_count;
    for (unsigned j = 0; j < around; j++) {
        struct v2 c = circle((double)j / around);
        struct v3 normal = v3_unit(v3(c.x * left.x, c.x * left.y, c.y));
        mesh_vertex(mesh, v3_mad(v3(points[k].x, points[k].y, 0), radius, normal), normal);
    }
    return first;
}

// Closes an end with copies of its ring's vertices, so that the edge stays sharp. `forward` is the way out of the bar there.
static void add_cap(struct mesh *mesh, uint32_t ring, unsigned around, struct v2 forward, bool last) {
    uint32_t first = mesh->vertex_count;
    struct v2 out = v2_unit(forward);
    for (unsigned j = 0; j < around && !mesh->failed; j++) mesh_vertex(mesh, mesh->vertices[ring + j].position, v3(out.x, out.y, 0));
    for (unsigned j = 2; j < around; j++) {
        if (last)
            mesh_triangle(mesh, first, first + j - 1, first + j);
        else
            mesh_triangle(mesh, first, first + j, first + j - 1);
    }
}

void add_bar(struct mesh *mesh, const struct v2 *points, const double *radius, unsigned count, unsigned around) {
    uint32_t first = mesh->vertex_count, here = 0;
    for (unsigned k = 0; k < count; k++) {
        here = put_bar_ring(mesh, points, k, count, radius[k], around);
        for (unsigned j = 0; k > 0 && j < around; j++) {
            uint32_t before = here - around, next = (j + 1) % around;
            mesh_quad(mesh, before + j, before + next, here + next, here + j);
        }
    }
    add_cap(mesh, first, around, v2_sub(points[0], points[1]), false);
    add_cap(mesh, here, around, v2_sub(points[count - 1], points[count - 2]), true);
}
