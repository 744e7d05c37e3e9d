// Declarations of floats in SPIR-V: every kernel with every set of them is valid, holds them and nothing else that is new; broken modules
// do no harm.
#include <fcntl.h>
#include <glob.h>
#include <setjmp.h>
#include <spawn.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/context.h"
#include "base/file.h"
#include "device/float_controls.h"
#include "device/spirv.h"

#include <cmocka.h>

extern char **environ;

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

#define MOST_MODULES 32

// The compiled kernels of shaders/.
static struct module {
    const char *name;
    uint32_t *words;
    size_t size;
    bool doubles; // they use
} modules[MOST_MODULES];
static size_t module_count;
static const struct module *small_one; // arithmetic.comp

static void read_module(const char *path) {
    struct gn_error error;
    struct context ctx = context_make(NULL, &error);
    struct file_bytes bytes;
    assert_true(module_count < MOST_MODULES);
    assert_true(file_read(&bytes, &ctx, path, GN_IO));
    struct module *module = &modules[module_count++];
    *module = (struct module){.name = strrchr(path, '/') + 1, .words = malloc(bytes.size), .size = bytes.size};
    assert_non_null(module->words);
    memcpy(module->words, bytes.data, bytes.size);
    for (size_t i = 5; i < module->size / 4; i += module->words[i] >> 16)
        if ((module->words[i] & 0xffff) == 17 && module->words[i + 1] == 10) module->doubles = true;
    if (strcmp(module->name, "arithmetic.spv") == 0) small_one = module;
    free(bytes.data);
}

static glob_t paths;

static int read_modules(void **state) {
    (void)state;
    mkdir(TEST_OUTPUT_DIR, 0777);
    assert_int_equal(glob(TEST_BUILD_DIR "/kernels/*.spv", 0, NULL, &paths), 0);
    for (size_t i = 0; i < paths.gl_pathc; ++i) read_module(paths.gl_pathv[i]);
    assert_non_null(small_one);
    return 0;
}

static int free_modules(void **state) {
    (void)state;
    for (size_t i = 0; i < module_count; ++i) free(modules[i].words);
    globfree(&paths);
    return 0;
}

// To be freed.
static uint32_t *declare(size_t *size, const uint32_t *words, size_t old_size, uint32_t controls) {
    *size = float_controls_declare(NULL, words, old_size, controls);
    uint32_t *out = malloc(*size ? *size : 1);
    assert_non_null(out);
    assert_int_equal(float_controls_declare(out, words, old_size, controls), *size);
    return out;
}

// FLOAT_* that a module declares, by execution modes; *extra is the bytes of all that declares them.
static uint32_t declared(const uint32_t *words, size_t size, size_t *extra) {
    uint32_t controls = 0;
    *extra = 0;
    for (size_t i = 5; i < size / 4; i += words[i] >> 16) {
        const uint32_t code = words[i] & 0xffff, length = words[i] >> 16;
        const bool mode = code == 16 && (words[i + 2] == 4461 || words[i + 2] == 4462), wide = mode && words[i + 3] == 64;
        const bool capability = code == 17 && (words[i + 1] == 4466 || words[i + 1] == 4467);
        const bool extension = code == 10 && strcmp((const char *)(words + i + 1), "SPV_KHR_float_controls") == 0;
        if (mode)
            controls |= words[i + 2] == 4462 ? (wide ? FLOAT_NEAREST_64 : FLOAT_NEAREST_32) : (wide ? FLOAT_SPECIAL_64 : FLOAT_SPECIAL_32);
        if (mode || capability || extension) *extra += 4 * length;
    }
    return controls;
}

static void test_declares(void **state) {
    (void)state;
    for (size_t m = 0; m < module_count; ++m) {
        const struct module *module = &modules[m];
        for (uint32_t controls = 0; controls <= FLOAT_ALL; ++controls) {
            size_t size, again_size, extra;
            uint32_t *out = declare(&size, module->words, module->size, controls);
            uint32_t *again = declare(&again_size, out, size, FLOAT_ALL & controls);
            assert_null(spirv_fault(out, size));
            assert_int_equal(declared(out, size, &extra), module->doubles ? controls : controls & (FLOAT_NEAREST_32 | FLOAT_SPECIAL_32));
            assert_int_equal(size, module->size + extra);
            assert_int_equal(again_size, size);
            assert_memory_equal(again, out, size);
            free(again);
            free(out);
        }
    }
}

// ----------------------------------------------------------------------------------------------------------------- validity

// The exit code of spirv-val.
static int validate(const void *words, size_t size) {
    const char *path = TEST_OUTPUT_DIR "/module.spv";
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(words, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    char *arguments[] = {"spirv-val", "--target-env", "vulkan1.1", (char *)path, NULL};
    posix_spawn_file_actions_t actions;
    assert_int_equal(posix_spawn_file_actions_init(&actions), 0);
    assert_int_equal(posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0), 0);
    assert_int_equal(posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO), 0);
    pid_t child;
    int status;
    assert_int_equal(posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void test_valid(void **state) {
    (void)state;
    for (size_t m = 0; m < module_count; ++m) {
        for (uint32_t controls = 1; controls <= FLOAT_ALL; controls = 2 * controls + 1) {
            size_t size;
            uint32_t *out = declare(&size, modules[m].words, modules[m].size, controls);
            if (validate(out, size) != 0) fail_msg("%s with %u is not valid", modules[m].name, controls);
            free(out);
        }
    }
    // The check must be able to fail: an execution mode without its capability is not valid.
    size_t size;
    uint32_t *out = declare(&size, small_one->words, small_one->size, FLOAT_NEAREST_32);
    for (size_t i = 5; i < size / 4; i += out[i] >> 16)
        if ((out[i] & 0xffff) == 17 && out[i + 1] == 4467) out[i + 1] = 1;
    assert_int_not_equal(validate(out, size), 0);
    free(out);
}

// ------------------------------------------------------------------------------------------------------------------- faults

// Makes and frees, for the sanitizers to watch; the size is exact, so that a word read or written beyond it is caught.
static size_t try_declaring(const uint32_t *words, size_t count) {
    uint32_t *copy = malloc(4 * count + !count);
    assert_non_null(copy);
    memcpy(copy, words, 4 * count);
    size_t size;
    free(declare(&size, copy, 4 * count, FLOAT_ALL));
    free(copy);
    return size;
}

static void test_malformed(void **state) {
    (void)state;
    const size_t count = small_one->size / 4;
    for (size_t i = 0; i < 64; ++i) assert_int_equal(try_declaring(small_one->words, i), 0);
    assert_int_equal(try_declaring(small_one->words, count - 1), 0);
    assert_int_equal(float_controls_declare(NULL, NULL, 0, FLOAT_ALL), 0);
    assert_int_equal(float_controls_declare(NULL, small_one->words, small_one->size - 2, FLOAT_ALL), 0);
    assert_true(try_declaring(small_one->words, count) > small_one->size);

    const uint32_t header[5] = {0x07230203, 0x00010300, 0, 8, 0}, end = 1u << 16 | 56;
    const struct {
        const char *what;
        uint32_t words[8];
        size_t count;
    } cases[] = {
        {"no entry point", {2u << 16 | 17, 1, end}, 3},
        {"a capability without its number", {1u << 16 | 17, 4u << 16 | 15, 5, 1, 0, end}, 6},
        {"an entry point without its name", {2u << 16 | 17, 1, 3u << 16 | 15, 5, 1, end}, 6},
        {"a capability behind the entry point", {4u << 16 | 15, 5, 1, 0, 2u << 16 | 17, 1, end}, 7},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        uint32_t words[13];
        memcpy(words, header, sizeof header);
        memcpy(words + 5, cases[i].words, 4 * cases[i].count);
        if (try_declaring(words, 5 + cases[i].count)) fail_msg("accepted: %s", cases[i].what);
    }
    uint32_t good[10] = {0x07230203, 0x00010300, 0, 8, 0, 4u << 16 | 15, 5, 1, 0, 1u << 16 | 56};
    assert_true(try_declaring(good, 10) > sizeof good);
}

static void test_damaged(void **state) {
    (void)state;
    const size_t count = small_one->size / 4;
    uint32_t *words = malloc(small_one->size), random = 1;
    assert_non_null(words);
    for (int i = 0; i < 2000; ++i) {
        memcpy(words, small_one->words, small_one->size);
        for (int k = 0; k < 3; ++k) {
            random = random * 747796405u + 2891336453u;
            words[(random >> 8) % (k ? 160 : count)] ^= 1u << (random & 31);
        }
        try_declaring(words, count);
    }
    free(words);
}

// ------------------------------------------------------------------------------------------------------------------- devices

static void test_accepted(void **state) {
    (void)state;
    enum { NONE = VK_SHADER_FLOAT_CONTROLS_INDEPENDENCE_NONE, ONLY_32 = VK_SHADER_FLOAT_CONTROLS_INDEPENDENCE_32_BIT_ONLY };
    const struct {
        int independence;
        bool nearest32, nearest64, special32, special64;
        uint32_t accepted;
    } cases[] = {
        {ONLY_32, true, true, true, true, FLOAT_ALL},
        {ONLY_32, true, false, true, false, FLOAT_NEAREST_32 | FLOAT_SPECIAL_32},
        {ONLY_32, false, true, false, true, FLOAT_NEAREST_64 | FLOAT_SPECIAL_64},
        {NONE, true, true, false, false, FLOAT_NEAREST_32 | FLOAT_NEAREST_64},
        {NONE, true, false, true, true, FLOAT_SPECIAL_32 | FLOAT_SPECIAL_64},
        {NONE, false, true, true, true, FLOAT_SPECIAL_32 | FLOAT_SPECIAL_64},
        {ONLY_32, false, false, false, false, 0},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        const VkPhysicalDeviceFloatControlsProperties properties = {
            .roundingModeIndependence = (VkShaderFloatControlsIndependence)cases[i].independence,
            .shaderRoundingModeRTEFloat32 = cases[i].nearest32,
            .shaderRoundingModeRTEFloat64 = cases[i].nearest64,
            .shaderSignedZeroInfNanPreserveFloat32 = cases[i].special32,
            .shaderSignedZeroInfNanPreserveFloat64 = cases[i].special64,
        };
        assert_int_equal(float_controls_accepted(&properties), cases[i].accepted);
    }
    const VkPhysicalDeviceFloatControlsProperties silent = {0};
    assert_int_equal(float_controls_accepted(&silent), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_declares), cmocka_unit_test(test_valid),    cmocka_unit_test(test_malformed),
        cmocka_unit_test(test_damaged),  cmocka_unit_test(test_accepted),
    };
    return cmocka_run_group_tests(tests, read_modules, free_modules);
}
