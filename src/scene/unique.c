// A hash table with open addressing, at most two thirds full; each slot holds the first row of its kind.
#include "scene/unique.h"

#include <stdlib.h>
#include <string.h>

#define EMPTY UINT32_MAX

// Word i of a row; 0x80000000, the bits of -0, becomes 0.
static uint32_t row_word(const unsigned char *row, unsigned i) {
    uint32_t word;
    memcpy(&word, row + i * sizeof word, sizeof word);
    return word == 0x80000000u ? 0 : word;
}

static uint64_t row_hash(const unsigned char *row, unsigned width) {
    uint64_t hash = 0;
    for (unsigned i = 0; i < width; i++) {
        hash = (hash ^ row_word(row, i)) * UINT64_C(0x9e3779b97f4a7c15); // 2^64 / golden ratio: Fibonacci hashing
        hash ^= hash >> 32;
    }
    return hash;
}

static bool rows_equal(const unsigned char *a, const unsigned char *b, unsigned width) {
    for (unsigned i = 0; i < width; i++)
        if (row_word(a, i) != row_word(b, i)) return false;
    return true;
}

bool unique_rows(uint32_t *number, uint32_t *distinct, struct context *ctx, const void *rows, uint32_t count, unsigned width) {
    *distinct = 0;
    const unsigned char *bytes = rows;
    const size_t stride = width * sizeof(uint32_t);
    size_t slots = 16;
    while (slots < (size_t)count + count / 2) slots *= 2;
    uint32_t *table = array_alloc(ctx, slots, sizeof *table, "a table of equal vertices");
    if (!table) return false;
    for (size_t i = 0; i < slots; i++) table[i] = EMPTY;
    for (uint32_t i = 0; i < count; i++) {
        const unsigned char *row = bytes + i * stride;
        size_t slot = (size_t)row_hash(row, width) & (slots - 1);
        while (table[slot] != EMPTY && !rows_equal(bytes + table[slot] * stride, row, width)) slot = (slot + 1) & (slots - 1);
        if (table[slot] == EMPTY) {
            table[slot] = i;
            number[i] = (*distinct)++;
        } else {
            number[i] = number[table[slot]];
        }
    }
    free(table);
    return true;
}
