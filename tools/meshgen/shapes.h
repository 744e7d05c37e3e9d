// The shapes that gnomon_meshgen makes. Each function writes one file and returns whether that worked.
//
// All are in a right-handed space with y up, wound counter-clockwise from outside, and of about unit size unless said otherwise.
#ifndef MESHGEN_SHAPES_H
#define MESHGEN_SHAPES_H

#include "ply.h"

struct shape_params {
    const char *output; // path
    unsigned n;         // fineness; each shape says what it counts
    uint32_t seed;
    bool normals;     // write unit vertex normals
    struct v3 offset; // added to all positions
};

struct ply_params ply_params_for(const struct shape_params *params);

bool shape_teapot(const struct shape_params *params);       // n: segments of a patch's edge
bool shape_terrain(const struct shape_params *params);      // n × n squares
bool shape_bumpy_sphere(const struct shape_params *params); // six faces of n × n squares
bool shape_shell(const struct shape_params *params);        // two spheres of six faces of n × n squares
bool shape_torus_knot(const struct shape_params *params);   // n around the tube, 12·n along
bool shape_needles(const struct shape_params *params);      // n triangles
bool shape_fan(const struct shape_params *params);          // n triangles
bool shape_flake(const struct shape_params *params);        // n: depth
bool shape_dial(const struct shape_params *params);         // n segments around, as for all below
bool shape_dial_marks(const struct shape_params *params);
bool shape_gnomon(const struct shape_params *params);
bool shape_table(const struct shape_params *params);
bool shape_cup(const struct shape_params *params);
bool shape_saucer(const struct shape_params *params);
bool shape_backdrop(const struct shape_params *params);

#endif
