// Device work in pieces sized by measured time: never one long dispatch, never thousands of tiny ones.
#ifndef RENDER_PIECES_H
#define RENDER_PIECES_H

#include <stdint.h>

// How many workgroups the next dispatch should have. Begin with pieces_make; tell each piece's time to pieces_learn.
struct pieces {
    uint32_t groups;        // of the next dispatch
    uint32_t fixed;         // not 0: always so many
};

// `fixed` 0: measured, beginning small.
struct pieces pieces_make(uint32_t fixed);

// A dispatch of `groups` workgroups took `seconds`.
void pieces_learn(struct pieces *pieces, uint32_t groups, double seconds);

#endif
