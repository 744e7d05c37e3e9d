// Which dielectrics a ray is inside of, and which of them it sees where they overlap. C. M. Schmidt and B. Budge, "Simple nested
// dielectrics in ray traced images", journal of graphics tools 7(2), 2002.
//
// Where several overlap there is the one of the highest priority, of equal ones that of the highest number: an order of all materials, so
// that the way in and the way back agree. A surface counts if its material, taken away, leaves none above it; another one is passed as if
// it were not there, but for the list. Entries of one material stand in the list as often as they were entered.
#ifndef NESTED_GLSL
#define NESTED_GLSL
#include "shared.h"

// Highest first. `number` is a material's number + 1, 0 where there is none: then there is vacuum.
struct media { uvec4 priority, number; };

// What a ray meets at a surface.
struct media_change {
    bool counts;        // else the ray goes straight on, in `after`
    uint here, beyond;  // the material + 1 on this side and on the other, 0 for vacuum
    media after;        // the list on the other side
};

media media_none() { return media(uvec4(0u), uvec4(0u)); }

bool media_above(uint priority, uint number, uint other_priority, uint other_number) {
    return priority > other_priority || (priority == other_priority && number > other_number);
}

// With one more; if there is no room the lowest is forgotten.
media media_with(media m, uint priority, uint number) {
    for (int i = 0; i < 4; i++) {
        uint p = m.priority[i], k = m.number[i];
        bool above = media_above(priority, number, p, k);
        m.priority[i] = above ? priority : p;
        m.number[i] = above ? number : k;
        priority = above ? p : priority;
        number = above ? k : number;
    }
    return m;
}

// With one less of this number, if there is one.
media media_without(media m, uint number) {
    uvec4 next_priority = uvec4(m.priority.yzw, 0u), next_number = uvec4(m.number.yzw, 0u);
    bool found = false;
    for (int i = 0; i < 4; i++) {
        found = found || m.number[i] == number;
        m.priority[i] = found ? next_priority[i] : m.priority[i];
        m.number[i] = found ? next_number[i] : m.number[i];
    }
    return m;
}

// At the surface of `material`, coming from outside or from inside. A ray that leaves what it never entered began inside.
media_change media_cross(media m, uint material, uint priority, bool entering) {
    uint number = material + 1u;
    media rest = media_without(m, number);
    if (entering) rest = m;
    uint top = rest.number.x;
    bool counts = media_above(priority, number, rest.priority.x, top);
    media after = media_with(m, priority, number);
    if (!entering) after = rest;
    return media_change(counts, entering ? top : number, entering ? number : top, after);
}

#endif
