// In: FILTER_KNOTS knots, then random numbers. Out: film positions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "filter.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    filter_cell cell = filter_cell_of(given[FILTER_KNOTS + i]);
    result[i] = filter_offset(cell, given[cell.knot], given[cell.knot + 1u]);
}
