// Film filters: where a sample lies, drawn from the filter itself, so that all samples count the same (M. Ernst, M. Stamminger, G. Greiner, "Filter Importance
// Sampling", 2006). A sequence of fp32 operations that render/filter_table.c has, too, so that the reference shoots the same ray to the bit.
#ifndef FILTER_GLSL
#define FILTER_GLSL
#include "shared.h"

// Where a random number falls in the table of knots (render/filter_table.h).
struct filter_cell {
    uint knot;      // the cell is from this knot to the next
    float share;    // of the way between them, 0 <= share < 1
    bool beyond;    // beyond the center: on the other side, by symmetry
};

// u is a multiple of 2^-24, 0 <= u < 1: nothing is rounded.
filter_cell filter_cell_of(float u) {
    bool beyond = u >= 0.5;
    uint bits = floatBitsToUint(beyond ? 1.0 - u : u);
    const uint shift = 23u - FILTER_CELL_BITS;
    const uint before = (103u << FILTER_CELL_BITS) - 1u; // 2^-24 is knot 1
    uint knot = bits == 0u ? 0u : (bits >> shift) - before;
    float share = float(bits & ((1u << shift) - 1u)) * (1.0 / float(1u << shift));
    return filter_cell(knot, share, beyond);
}

// The film position in pixels, 0.5 at the pixel's center, between the cell's knots.
float filter_offset(filter_cell cell, float low, float high) {
    precise float width = high - low;
    precise float part = cell.share * width;
    precise float offset = low + part;
    precise float mirrored = 1.0 - offset;
    return cell.beyond ? mirrored : offset;
}

#endif
