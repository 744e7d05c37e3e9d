// Every so manieth pixel of a picture, across and down: a small picture of the very rays that the whole one has there. What is measured on it holds for the
// whole, at a fraction of the time.
#ifndef RENDER_LATTICE_H
#define RENDER_LATTICE_H

#include <stdint.h>

// Pixel (i, j) of the small picture is pixel (x + i·stride, y + j·stride) of the whole. Zeroed is every pixel.
struct lattice {
    uint32_t stride; // 0 is 1
    uint32_t x, y;   // less than stride
};

// Pixels of the small picture along a side of the whole that has `side` pixels and where it begins at `first`.
static inline uint32_t lattice_side(uint32_t side, uint32_t first, uint32_t stride) {
    if (stride <= 1) return side;
    return first < side ? (side - first + stride - 1) / stride : 0;
}

#endif
