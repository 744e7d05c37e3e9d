// Binary little-endian PLY, written as a stream, and a small mesh in memory for the shapes that are built from parts.
//
// Counts go first, then all vertices, then all triangles. Errors stick: after the first one nothing more is written, and ply_end reports
// it.
#ifndef MESHGEN_PLY_H
#define MESHGEN_PLY_H

#include <stdint.h>

#include "output.h"
#include "vec.h"

struct ply {
    struct output output;
    bool normals; // vertices carry unit normals
    bool failed;
    struct v3 offset; // added to every position before it is rounded to fp32
    size_t used;      // bytes in `buffer`
    unsigned char buffer[1 << 16];
};

struct ply_params {
    const char *path;
    uint64_t vertices, triangles;
    bool normals;
    struct v3 offset;
};

// Opens the file and writes the header. False, with a message on standard error, when that fails.
bool ply_begin(struct ply *ply, const struct ply_params *params);
void ply_vertex(struct ply *ply, struct v3 position, struct v3 normal);
void ply_triangle(struct ply *ply, uint32_t a, uint32_t b, uint32_t c);
// Finishes and renames; on failure removes what was written and says why.
bool ply_end(struct ply *ply);

struct vertex {
    struct v3 position, normal;
};
struct triangle {
    uint32_t v[3];
};

// A mesh in memory. Zeroed is empty. Running out of memory sets `failed`, and mesh_write reports it.
struct mesh {
    struct vertex *vertices;
    struct triangle *triangles;
    uint32_t vertex_count, triangle_count, vertex_capacity, triangle_capacity;
    bool failed;
};

uint32_t mesh_vertex(struct mesh *mesh, struct v3 position, struct v3 normal); // its number
void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c);
// Two triangles a b c and a c d; counter-clockwise from outside.
void mesh_quad(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
// Writes the mesh (counts in *params are ignored) and empties it.
bool mesh_write(struct mesh *mesh, const struct ply_params *params);

#endif
