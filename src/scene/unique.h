// Equal rows found by hashing: equal positions of a mesh, equal pairs of position and normal.
#ifndef SCENE_UNIQUE_H
#define SCENE_UNIQUE_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

// Numbers the distinct rows among rows, `count` times `width` 32-bit words, in order of first appearance: row i is distinct row number[i].
// Words are compared as bits, but 0x80000000 equals 0, so that positions with 0 and -0 are equal. At most 2^31 rows.
bool unique_rows(uint32_t *number, uint32_t *distinct, struct context *ctx, const void *rows, uint32_t count, unsigned width);

#endif
