// Growth by half, so that a large array is mostly full; realloc moves large blocks without copying them.
#include "scene/array.h"

#include <stdlib.h>

bool array_reserve(struct array *array, struct context *ctx, size_t capacity) {
    if (capacity <= array->capacity) return true;
    void *items = capacity <= SIZE_MAX / array->item_size ? realloc(array->items, capacity * array->item_size) : NULL;
    if (!items) return fail(ctx, GN_LIMIT, "no memory for %s: %zu × %zu bytes", array->what, capacity, array->item_size);
    array->items = items;
    array->capacity = capacity;
    return true;
}

void *array_push(struct array *array, struct context *ctx) {
    if (array->count == array->capacity && !array_reserve(array, ctx, array->capacity + array->capacity / 2 + 16)) return NULL;
    return (char *)array->items + array->item_size * array->count++;
}

void *array_take(struct array *array) {
    void *items = array->items;
    if (array->count == 0) {
        free(items);
        items = NULL;
    } else if (array->count < array->capacity) {
        void *fitting = realloc(items, array->count * array->item_size);
        if (fitting) items = fitting;
    }
    array->items = NULL;
    array->count = array->capacity = 0;
    return items;
}

void array_finish(struct array *array) {
    free(array->items);
    array->items = NULL;
    array->count = array->capacity = 0;
}
