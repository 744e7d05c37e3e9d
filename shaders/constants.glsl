// Specialization constants that are no effects (those come from the table in shared.h).
#ifndef CONSTANTS_GLSL
#define CONSTANTS_GLSL
#include "shared.h"

layout(constant_id = CONSTANT_TIER) const uint TIER = TIER_ROBUST;
layout(constant_id = CONSTANT_AOVS) const uint AOVS = 0u;
layout(constant_id = CONSTANT_MAX_STEPS) const uint MAX_STEPS = 60000u;
layout(constant_id = CONSTANT_ANY_HIT) const bool ANY_HIT = false;
layout(constant_id = CONSTANT_RESOLVE) const bool RESOLVE = false;

#endif
