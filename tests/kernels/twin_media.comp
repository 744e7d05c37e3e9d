// In, 24 numbers a case: of 8 surfaces material, priority, 1 for entering. Out, 24: of each whether it counts, what is here and beyond.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "nested.glsl"
#include "twin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    media inside = media_none();
    for (uint k = 0u; k < 8u; k++) {
        uint at = 24u * i + 3u * k;
        media_change change = media_cross(inside, uint(given[at]), uint(given[at + 1u]), given[at + 2u] != 0.0);
        result[at] = change.counts ? 1.0 : 0.0;
        result[at + 1u] = float(change.here);
        result[at + 2u] = float(change.beyond);
        inside = change.after;
    }
}
