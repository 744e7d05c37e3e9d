// Arrays that grow item by item.
#ifndef SCENE_ARRAY_H
#define SCENE_ARRAY_H

#include "base/context.h"

// Zeroed but for item_size and what is empty; array_finish accepts that.
struct array {
    void *items;
    size_t count, capacity; // items
    size_t item_size;       // bytes
    const char *what;       // for "no memory for <what>"
};

// Makes room for `capacity` items in all.
bool array_reserve(struct array *array, struct context *ctx, size_t capacity);

// A new item at the end, not initialised; NULL with GN_LIMIT reported when memory is missing. Earlier items may move.
void *array_push(struct array *array, struct context *ctx);

// Gives the items away, without spare room, and leaves the array empty. NULL when there are none.
void *array_take(struct array *array);

void array_finish(struct array *array);

#endif
