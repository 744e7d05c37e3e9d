// Newell's teapot (1975; Crow, "The Origins of the Teapot", IEEE CG&A 1987): 32 bicubic Bézier patches, in the proportions of the data
// that everybody uses.
//
// Newell's 306 control points are symmetric, so a few numbers are enough. Twenty-four patches are surfaces of revolution: a profile
// (radius, height) times four quarter circles, each approximated by the Bézier curve (1, 0) (1, 0.56) (0.56, 1) (0, 1). The other eight are
// the handle and the spout: half a tube each, mirrored at the plane y = 0 of the data. (One published number, 0.78 for 0.784, is a slip.)
// The data has z up; here y is up, and the spout points to +x. The pot is open where the lid sits, and handle and spout pass through the
// body.
#include "shapes.h"

#include "solids.h"

#define CIRCLE 0.56

struct profile_patch {
    struct v2 c[4];
}; // radius, height

static const struct profile_patch body[] = {
    // from the rim's inner edge, over it, down to the middle of the bottom
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},
    {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}},
    {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0}, {0, 0}}},
};
static const struct profile_patch lid[] = {
    // from the knob's top to the lid's edge
    {{{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}}},
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},
};

// Half a tube: rows along it, and in each row the four control points (x, −y, z) across; the first and the last have y = 0.
struct tube_patch {
    struct v3 c[4][4];
};

static const struct tube_patch handle[] = {
    {{{{-1.6, 0, 2.025}, {-1.6, 0.3, 2.025}, {-1.5, 0.3, 2.25}, {-1.5, 0, 2.25}},
      {{-2.3, 0, 2.025}, {-2.3, 0.3, 2.025}, {-2.5, 0.3, 2.25}, {-2.5, 0, 2.25}},
      {{-2.7, 0, 2.025}, {-2.7, 0.3, 2.025}, {-3, 0.3, 2.25}, {-3, 0, 2.25}},
      {{-2.7, 0, 1.8}, {-2.7, 0.3, 1.8}, {-3, 0.3, 1.8}, {-3, 0, 1.8}}}},
    {{{{-2.7, 0, 1.8}, {-2.7, 0.3, 1.8}, {-3, 0.3, 1.8}, {-3, 0, 1.8}},
      {{-2.7, 0, 1.575}, {-2.7, 0.3, 1.575}, {-3, 0.3, 1.35}, {-3, 0, 1.35}},
      {{-2.5, 0, 1.125}, {-2.5, 0.3, 1.125}, {-2.65, 0.3, 0.9375}, {-2.65, 0, 0.9375}},
      {{-2, 0, 0.9}, {-2, 0.3, 0.9}, {-1.9, 0.3, 0.6}, {-1.9, 0, 0.6}}}},
};
static const struct tube_patch spout[] = {
    {{{{1.7, 0, 1.425}, {1.7, 0.66, 1.425}, {1.7, 0.66, 0.6}, {1.7, 0, 0.6}},
      {{2.6, 0, 1.425}, {2.6, 0.66, 1.425}, {3.1, 0.66, 0.825}, {3.1, 0, 0.825}},
      {{2.3, 0, 2.1}, {2.3, 0.25, 2.1}, {2.4, 0.25, 2.025}, {2.4, 0, 2.025}},
      {{2.7, 0, 2.4}, {2.7, 0.25, 2.4}, {3.3, 0.25, 2.4}, {3.3, 0, 2.4}}}},
    {{{{2.7, 0, 2.4}, {2.7, 0.25, 2.4}, {3.3, 0.25, 2.4}, {3.3, 0, 2.4}},
      {{2.8, 0, 2.475}, {2.8, 0.25, 2.475}, {3.525, 0.25, 2.49375}, {3.525, 0, 2.49375}},
      {{2.9, 0, 2.475}, {2.9, 0.15, 2.475}, {3.45, 0.15, 2.5125}, {3.45, 0, 2.5125}},
      {{2.8, 0, 2.4}, {2.8, 0.15, 2.4}, {3.2, 0.15, 2.4}, {3.2, 0, 2.4}}}},
};

// Point and tangent of the "circle" of the data, k of 4·n steps from +x towards −z.
static struct bezier2 round_at(unsigned k, unsigned n) {
    const struct v2 quarter[4] = {{1, 0}, {1, CIRCLE}, {CIRCLE, 1}, {0, 1}};
    struct bezier2 b = bezier2(quarter, (double)(k % n) / n);
    for (unsigned turn = 0; turn < k / n; turn++) b = (struct bezier2){v2_left(b.point), v2_left(b.tangent)};
    return b;
}

// One vertex of a surface of revolution. Its normal is the cross product of the two derivatives divided by the radius, which stays
// right where the radius is zero: the poles of the lid and of the bottom.
static uint32_t revolved_vertex(struct mesh *mesh, struct bezier2 profile, struct bezier2 round) {
    struct v3 position = v3(profile.point.x * round.point.x, profile.point.y, -profile.point.x * round.point.y);
    double swept = v2_cross(round.point, round.tangent);
    struct v3 normal = v3(-profile.tangent.y * round.tangent.y, profile.tangent.x * swept, -profile.tangent.y * round.tangent.x);
    return mesh_vertex(mesh, position, v3_unit(normal));
}

// A row of vertices around the axis; only one where the radius is zero. Returns the first one's number.
static uint32_t revolved_row(struct mesh *mesh, const struct v2 c[4], double t, unsigned n) {
    struct bezier2 profile = bezier2(c, t);
    unsigned count = profile.point.x > 0 ? 4 * n : 1;
    uint32_t first = mesh->vertex_count;
    for (unsigned k = 0; k < count; k++) revolved_vertex(mesh, profile, round_at(k, n));
    return first;
}

static void add_revolved(struct mesh *mesh, const struct profile_patch *patches, unsigned count, unsigned n) {
    uint32_t above = revolved_row(mesh, patches[0].c, 0, n);
    for (unsigned k = 1; k <= count * n; k++) {
        unsigned patch = (k - 1) / n;
        uint32_t row = revolved_row(mesh, patches[patch].c, (double)(k - patch * n) / n, n);
        add_band(mesh, above, row - above, row, mesh->vertex_count - row);
        above = row;
    }
}

static struct v3 bezier3(const struct v3 c[4], double t, struct v3 *tangent) {
    double s = 1 - t, b[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t}, d[3] = {3 * s * s, 6 * s * t, 3 * t * t};
    struct v3 point = {0, 0, 0};
    *tangent = v3(0, 0, 0);
    for (int k = 0; k < 4; k++) point = v3_mad(point, b[k], c[k]);
    for (int k = 0; k < 3; k++) *tangent = v3_mad(*tangent, d[k], v3_sub(c[k + 1], c[k]));
    return point;
}

// A vertex of a tube at (along, across), both 0 to 1. `side` is 1 for the half that the data gives and −1 for its mirror image.
static void tube_vertex(struct mesh *mesh, const struct tube_patch *patch, double along, double across, double side) {
    struct v3 row[4], slope[4], tangent_across, tangent_along, unused;
    for (int k = 0; k < 4; k++) {
        const struct v3 column[4] = {patch->c[0][k], patch->c[1][k], patch->c[2][k], patch->c[3][k]};
        row[k] = bezier3(column, along, &slope[k]);
    }
    struct v3 p = bezier3(row, across, &tangent_across);
    tangent_along = bezier3(slope, across, &unused);
    struct v3 normal = v3_unit(v3_cross(tangent_along, tangent_across));
    mesh_vertex(mesh, v3(p.x, p.z, side * p.y), v3(normal.x, normal.z, side * normal.y));
}

static void add_tube(struct mesh *mesh, const struct tube_patch *patches, unsigned count, unsigned n) {
    uint32_t first = mesh->vertex_count;
    for (unsigned k = 0; k <= count * n; k++) {
        unsigned patch = k ? (k - 1) / n : 0;
        double along = (double)(k - patch * n) / n;
        for (unsigned j = 0; j < n; j++) tube_vertex(mesh, &patches[patch], along, (double)j / n, 1);
        for (unsigned j = n; j > 0; j--) tube_vertex(mesh, &patches[patch], along, (double)j / n, -1);
    }
    for (unsigned k = 0; k < count * n; k++)
        for (unsigned j = 0; j < 2 * n; j++) {
            uint32_t row = first + k * 2 * n, a = row + j, b = row + (j + 1) % (2 * n);
            mesh_quad(mesh, a, b, b + 2 * n, a + 2 * n);
        }
}

bool shape_teapot(const struct shape_params *params) {
    struct mesh mesh = {0};
    add_revolved(&mesh, body, sizeof body / sizeof *body, params->n);
    add_revolved(&mesh, lid, sizeof lid / sizeof *lid, params->n);
    add_tube(&mesh, handle, sizeof handle / sizeof *handle, params->n);
    add_tube(&mesh, spout, sizeof spout / sizeof *spout, params->n);
    struct ply_params ply = ply_params_for(params);
    return mesh_write(&mesh, &ply);
}
