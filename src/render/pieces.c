#include "render/pieces.h"

#define TARGET_SECONDS 0.07     // a dispatch: long enough to drown its overhead, short enough to be stopped after
#define FIRST_GROUPS 64
#define MOST_GROUPS 65535       // every Vulkan device allows so many

struct pieces pieces_make(uint32_t fixed) {
    if (fixed > MOST_GROUPS) fixed = MOST_GROUPS;
    return (struct pieces){.groups = fixed ? fixed : FIRST_GROUPS, .fixed = fixed};
}

// Grows at most fourfold a piece, so that one lucky measurement does not make a dispatch of seconds; shrinks at once.
void pieces_learn(struct pieces *pieces, uint32_t groups, double seconds) {
    if (pieces->fixed || groups == 0) return;
    double ideal = seconds > 0 ? groups * (TARGET_SECONDS / seconds) : MOST_GROUPS;
    double most = 4.0 * groups > pieces->groups ? 4.0 * groups : pieces->groups; // a short last piece teaches nothing
    if (ideal > most) ideal = most;
    pieces->groups = ideal < 1 ? 1 : ideal > MOST_GROUPS ? MOST_GROUPS : (uint32_t)ideal;
}
