// Solids of revolution, plates and prisms: what a carpenter and a turner can make. All are closed; edges are sharp where corners say so.
#ifndef MESHGEN_SOLIDS_H
#define MESHGEN_SOLIDS_H

#include "ply.h"

// A corner of a turned profile: distance from the axis, height, and the radius of its rounding (0: a sharp edge).
struct corner {
    double radius, height, rounding;
};

#define LATHE_MAX_CORNERS 48

// Turns a profile around the y axis. It runs with the solid on its right: from the axis at the top, outward and down, to the axis at the
// bottom; or, if `ring`, around a section that does not touch the axis, from its first corner back to it.
void add_lathe(struct mesh *mesh, const struct corner *profile, unsigned count, bool ring, unsigned segments);

// Triangles of the band between two rings of vertices that go around the y axis, counter-clockwise seen from above; a ring of one vertex is
// a pole.
void add_band(struct mesh *mesh, uint32_t upper, unsigned upper_count, uint32_t lower, unsigned lower_count);

// A plate in the plane z = 0 with a hole of as many points (at most 256) as its outline, both counter-clockwise: point k of the one faces
// point k of the other. Its edges are bevelled. Walls are smooth where the outline turns by less than some 25 degrees.
void add_plate(struct mesh *mesh, const struct v2 *outline, const struct v2 *hole, unsigned count, double thickness, double bevel);

// A point of the plane y = 0 as the dial sees it: east is +x, north is −z.
static inline struct v3 on_dial(struct v2 p, double height) { return v3(p.x, height, -p.y); }

// An upright prism over a convex polygon, counter-clockwise seen from above, points (east, north).
void add_prism(struct mesh *mesh, const struct v2 *polygon, unsigned count, double bottom, double top);

// A round bar along the points, with a flat cap at each end; radius[k] at point k. The points lie in the plane z = 0.
void add_bar(struct mesh *mesh, const struct v2 *points, const double *radius, unsigned count, unsigned around);

#endif
