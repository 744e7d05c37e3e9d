// The compiled predicates: what their sources call `precise` carries NoContraction in SPIR-V, and nothing in them is left to a built-in
// function.
//
// The kernels are those that run, compiled once more with the names of functions and variables in them.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/context.h"
#include "base/file.h"
#include "device/spirv.h"

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

enum {
    OP_NAME = 5,
    OP_EXTENDED = 12,
    OP_FUNCTION = 54,
    OP_FUNCTION_END = 56,
    OP_CALL = 57,
    OP_LOAD = 61,
    OP_STORE = 62,
    OP_DECORATE = 71,
    OP_ADD = 129,
    OP_SUBTRACT = 131,
    OP_MULTIPLY = 133,
    OP_DIVIDE = 136,
    OP_SCALE = 142, // vector times scalar
    OP_DOT = 148,
    NO_CONTRACTION = 42,
};

static const char *const KERNELS[] = {TEST_BUILD_DIR "/named/trace_refine.spv", TEST_BUILD_DIR "/named/render.spv"};

// A module, and by id: where it is named, where it is the result of an instruction, whether it is decorated. Word 0 is none.
struct module {
    uint32_t *words;
    size_t count, bound;
    size_t *name, *definition;
    bool *decorated;
};

static uint32_t code_of(const struct module *m, size_t at) { return m->words[at] & 0xffff; }
static uint32_t length_of(const struct module *m, size_t at) { return m->words[at] >> 16; }

// Of floats: what may be fused or rearranged.
static bool is_arithmetic(uint32_t code) {
    return code == OP_ADD || code == OP_SUBTRACT || code == OP_MULTIPLY || code == OP_DIVIDE || code == OP_SCALE || code == OP_DOT;
}

// The result of an instruction within a function; 0 if it has none that matters here.
static uint32_t result_of(const struct module *m, size_t at) {
    const uint32_t code = code_of(m, at);
    const bool has_result =
        code == OP_EXTENDED || code == OP_CALL || code == OP_LOAD || (code >= 77 && code <= 84) || (code >= 109 && code <= 150);
    return has_result && length_of(m, at) > 2 ? m->words[at + 2] : 0;
}

static void module_read(struct module *m, const char *path) {
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct file_bytes bytes;
    if (!file_read(&bytes, &ctx, path, GN_IO)) fail_msg("%s", error.message);
    *m = (struct module){.words = malloc(bytes.size), .count = bytes.size / 4};
    assert_non_null(m->words);
    memcpy(m->words, bytes.data, bytes.size);
    assert_null(spirv_fault(m->words, bytes.size));
    file_bytes_finish(&bytes);
    m->bound = m->words[3];
    m->name = calloc(m->bound, sizeof *m->name), m->definition = calloc(m->bound, sizeof *m->definition);
    m->decorated = calloc(m->bound, sizeof *m->decorated);
    assert_true(m->name && m->definition && m->decorated);
    for (size_t i = 5; i < m->count; i += length_of(m, i)) {
        if (code_of(m, i) == OP_NAME) m->name[m->words[i + 1]] = i + 2;
        if (code_of(m, i) == OP_DECORATE && m->words[i + 2] == NO_CONTRACTION) m->decorated[m->words[i + 1]] = true;
        if (result_of(m, i)) m->definition[result_of(m, i)] = i;
    }
}

static void module_free(struct module *m) {
    free(m->words);
    free(m->name);
    free(m->definition);
    free(m->decorated);
}

static const char *name_of(const struct module *m, uint32_t id) { return m->name[id] ? (const char *)(m->words + m->name[id]) : ""; }

// Where the function begins that is called so in GLSL; 0 if it is not there.
static size_t find_function(const struct module *m, const char *function) {
    const size_t length = strlen(function);
    for (size_t i = 5; i < m->count; i += length_of(m, i)) {
        if (code_of(m, i) != OP_FUNCTION) continue;
        const char *name = name_of(m, m->words[i + 2]);
        if (strncmp(name, function, length) == 0 && name[length] == '(') return i;
    }
    return 0;
}

// ------------------------------------------------------------------------------------------------------------ whole functions

struct tally {
    uint32_t precise, free; // operations that are decorated, and that are not
    uint32_t built_in;      // dot, cross, length, fma, …
};

static struct tally count_function(const struct module *m, size_t begin) {
    struct tally tally = {0};
    for (size_t i = begin; code_of(m, i) != OP_FUNCTION_END; i += length_of(m, i)) {
        if (code_of(m, i) == OP_EXTENDED || code_of(m, i) == OP_DOT) tally.built_in++;
        if (!is_arithmetic(code_of(m, i))) continue;
        if (m->decorated[m->words[i + 2]])
            tally.precise++;
        else
            tally.free++;
    }
    return tally;
}

// Every operation is decorated, none is built in; `operations` of them at least.
static void test_functions(void **state) {
    (void)state;
    static const struct {
        const char *function;
        uint32_t operations;
    } rows[] = {{"sheared", 5}, {"edge_function", 3}, {"cross_precise", 7}, {"dot_precise", 5}, {"cross_double", 3}, {"dot_double", 5}};
    struct module m;
    module_read(&m, KERNELS[0]);
    for (size_t i = 0; i < COUNT(rows); ++i) {
        const size_t begin = find_function(&m, rows[i].function);
        if (!begin) fail_msg("there is no function %s", rows[i].function);
        const struct tally tally = count_function(&m, begin);
        if (tally.free || tally.built_in || tally.precise < rows[i].operations)
            fail_msg("%s: %u operations are precise, %u are not, %u are built in", rows[i].function, tally.precise, tally.free,
                     tally.built_in);
    }
    // The control: a function that is not precise, and uses dot and cross.
    const struct tally fast = count_function(&m, find_function(&m, "triangle_fast"));
    assert_true(fast.free > 3 && fast.precise == 0 && fast.built_in > 3);
    module_free(&m);
}

// ------------------------------------------------------------------------------------------------------------------ variables

// Operations on the way to a value, up to what is loaded or called.
static void count_value(const struct module *m, uint32_t value, struct tally *tally) {
    const size_t at = value < m->bound ? m->definition[value] : 0;
    const uint32_t code = at ? code_of(m, at) : 0;
    if (!at || code == OP_LOAD || code == OP_CALL) return;
    if (is_arithmetic(code)) {
        if (m->decorated[value])
            tally->precise++;
        else
            tally->free++;
    }
    // Operands of a composite's extraction are numbers, not values; taken for values they name types and constants, which have no
    // definition here.
    for (size_t k = 3; k < length_of(m, at); ++k)
        if (!(code == 81 && k > 3) && !(code == 79 && k > 4)) count_value(m, m->words[at + k], tally);
}

// Over all that is stored in the function's variable of this name; false if there is none.
static bool count_variable(const struct module *m, size_t begin, const char *variable, struct tally *tally) {
    bool found = false;
    for (size_t i = begin; code_of(m, i) != OP_FUNCTION_END; i += length_of(m, i)) {
        if (code_of(m, i) != OP_STORE || strcmp(name_of(m, m->words[i + 1]), variable) != 0) continue;
        count_value(m, m->words[i + 2], tally);
        found = true;
    }
    return found;
}

static void check_variables(const struct module *m, const char *function, const char *variables) {
    char copy[128], *rest;
    const size_t begin = find_function(m, function);
    if (!begin) fail_msg("there is no function %s", function);
    snprintf(copy, sizeof copy, "%s", variables);
    for (char *variable = strtok_r(copy, " ", &rest); variable; variable = strtok_r(NULL, " ", &rest)) {
        struct tally tally = {0};
        if (!count_variable(m, begin, variable, &tally)) fail_msg("%s has no variable %s", function, variable);
        if (tally.free || !tally.precise)
            fail_msg("%s, %s: %u operations are precise, %u are not", function, variable, tally.precise, tally.free);
    }
}

static void test_variables(void **state) {
    (void)state;
    static const struct {
        size_t kernel;
        const char *function, *variables;
    } rows[] = {
        {0, "triangle_exact", "a b c det depth inverse t"},
        {0, "triangle_robust", "a b c det depth"},
        {0, "sphere_exact", "l r2a f"},
        {0, "sphere_exact_again", "l"},
        {0, "sphere_robust", "l f c"},
        {0, "refine_triangle", "e1 e2 from origin_again p0_again start moved sum"},
        {0, "refine_sphere", "l f c"},
        {0, "loses_bits", "part rest scaled unscaled"},
        {1, "leave_robust", "start away"},
        {1, "camera_between", "way part at"},
        {1, "camera_position", "part at"},
        {1, "camera_direction", "to_pixel within direction"},
        {1, "camera_lens_point", "scaled at"},
        {1, "camera_inverse", "inverse rest"},
        {1, "camera_disk_point", "turn t sine cosine point"},
        {1, "filter_offset", "width part offset mirrored"},
    };
    struct module modules[COUNT(KERNELS)];
    for (size_t i = 0; i < COUNT(KERNELS); ++i) module_read(&modules[i], KERNELS[i]);
    for (size_t i = 0; i < COUNT(rows); ++i) check_variables(&modules[rows[i].kernel], rows[i].function, rows[i].variables);
    // The control: variables that are not precise.
    struct tally fast = {0};
    const size_t begin = find_function(&modules[0], "triangle_fast");
    assert_true(count_variable(&modules[0], begin, "t", &fast) && count_variable(&modules[0], begin, "e1", &fast));
    assert_true(fast.free > 1 && fast.precise == 0);
    for (size_t i = 0; i < COUNT(KERNELS); ++i) module_free(&modules[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_functions), cmocka_unit_test(test_variables)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
