// The constructions of hard-cases.md: each fills a world with the shapes and rays of a row. About `rays` rays where the row is a
// family; `part` numbers the members of a row that has several worlds.
#ifndef MEASURE_STRESS_FILL_H
#define MEASURE_STRESS_FILL_H

#include "measure/stress/world.h"

#define FILL(name) void fill_##name(struct world *world, struct random *random, uint32_t rays, uint32_t part)

FILL(shared_diagonal);
FILL(bumpy_vertices);
FILL(bumpy_edges);
FILL(grid_midpoints);
FILL(fan);
FILL(same_side);
FILL(needles);
FILL(collinear);
FILL(degenerate);
FILL(tiny_sphere);
FILL(huge_sphere);
FILL(long_directions);
FILL(origin_in_plane);
FILL(ray_in_plane);
FILL(grazing);
FILL(far_above);
FILL(far_aside);
FILL(far_mesh);
FILL(cube);
FILL(twins);
FILL(not_finite);
FILL(negative_zero);
FILL(turned_quad);
FILL(uv_sphere);
FILL(vertex_grid);

FILL(sphere_limb);
FILL(sphere_limb_far);
FILL(sphere_limb_very_far);
FILL(far_sphere);
FILL(tangent);
FILL(leaving_sphere);
FILL(touching_sphere);
FILL(just_inside);
FILL(scaled_direction);
FILL(distant_camera);
FILL(cancelling);

FILL(flat_boxes);
FILL(bounds_of_t);
FILL(grains);
FILL(huge_extents);
FILL(denormal_directions);
FILL(origin_on_box);
FILL(far_city);
FILL(far_thing);
FILL(far_camera);

FILL(any_scale);
FILL(size_and_place);
FILL(large_triangles);
FILL(small_triangles);
FILL(thin_shell);
FILL(distant_rectangle);
FILL(planet);

// A closed surface around `center` of rows × columns quads, each cut in two, with one vertex at either pole: radius times 1 to 1 +
// bump. Returns the number of its first vertex; it has 2 + (rows - 1) · columns of them.
uint32_t fill_ball(struct world *world, struct random *random, uint32_t rows, uint32_t columns, double radius, double bump,
                   const double center[3]);

#endif
