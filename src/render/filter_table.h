// Film filters as tables from which samples are drawn; each axis by itself.
//
// A filter of radius r around the pixel's center is a density on [-r, r] of the film, in pixels. A sample's place is F⁻¹(u), F its distribution function. F⁻¹ is
// kept at knots and linear between them; it is symmetric, so one half does. Knots lie as fp32 numbers do: at w = 0 and from w = 2^-24 to 1/2, 32 to each doubling,
// since towards its ends a filter vanishes and F⁻¹ becomes steep. What is drawn is thus the filter's mean over each of some 1500 cells, 1/64 of all samples in the
// largest. The box of radius 1/2 is the identity, to the bit.
//
//     tent: 1 - |x|/r      gaussian: exp(-x²/2σ²), σ = r/4      Blackman-Harris: 4 terms, 92 dB (F. J. Harris, "On the Use of Windows", 1978, table 1)
#ifndef RENDER_FILTER_TABLE_H
#define RENDER_FILTER_TABLE_H

#include "scene/scene.h"
#include "shaders/shared.h"

struct filter_table { float knots[FILTER_KNOTS]; }; // film position in a pixel, 1/2 - r … 1/2

void filter_table_make(struct filter_table *out, enum film_filter type, float radius);

// From two random numbers, multiples of 2^-24 in [0, 1), to a film position: offset 1/2 is the pixel's center. The same fp32 operations as filter.glsl.
void filter_table_offset(float offset[2], const struct filter_table *table);

#endif
