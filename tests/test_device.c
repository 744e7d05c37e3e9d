// The device room: choosing and opening a device, buffers, images, kernels, limits, time-outs and cancellation.
//
// What ends in a lost device runs in a child process (this program with an argument), since such a device cannot be closed.
#include "fixture.h"

#include <inttypes.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "device/candidate.h"
#include "device/pipeline.h"
#include "device/select.h"
#include "device/spirv.h"
#include "device/staging.h"

#include "device_image.h"
#include "device_scale.h"
#include "device_spin.h"
#include "device_texels.h"

extern char **environ;

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static bool has(const char *text, const char *part) { return strstr(text, part) != NULL; }

// ------------------------------------------------------------------------------------------------------------------- selection

static void test_select(void **state) {
    (void)state;
    const struct gn_device_info infos[] = {
        {.name = "llvmpipe (LLVM 15.0.6, 256 bits)", .type = "cpu", .uuid = "6d657361-3232-2e33-2e36-000000000000", .usable = true},
        {.name = "NVIDIA GeForce RTX 4090", .type = "discrete", .uuid = "01234567-89ab-cdef-0123-456789abcdef", .usable = false},
        {.name = "Intel(R) Arc", .type = "integrated", .uuid = "aaaaaaaa-0000-0000-0000-000000000000", .usable = true},
        {.name = "AMD Radeon", .type = "discrete", .uuid = "AAAAAAAB-0000-0000-0000-000000000000", .usable = true},
        {.name = "NVIDIA GeForce GT 710", .type = "virtual", .uuid = "bbbbbbbb-0000-0000-0000-000000000000", .usable = true},
    };
    const struct { uint32_t count; const char *selector; int expected; } cases[] = {
        {5, NULL, 3},         {5, "", 3},           {3, NULL, 2},        {2, NULL, 0},         {0, NULL, -1},    {0, "cpu", -1},
        {5, "gpu", 3},        {3, "gpu", 2},        {2, "gpu", -1},      {5, "cpu", 0},        {5, "0", 0},      {5, "1", 1},
        {5, "4", 4},          {5, "5", -1},         {5, "4090", -1},      {5, "nvidia", 4},     {5, "LLVM", 0},   {5, "rtx", 1},
        {5, "radeon ", -1},   {5, "uuid:", -1},     {5, "uuid:6d65", 0}, {5, "uuid:a", 2},     {5, "uuid:aaaaaaab", 3},
        {5, "uuid:012345678", 1}, {5, "uuid:6D657361-3232", 0}, {5, "uuid:6d6573613232", 0},   {5, "uuid:-", -1}, {5, "-1", -1},
        {5, "99999999999999999999", -1}, {5, "uuid:01234567-89ab-cdef-0123-456789abcdef0", -1}, {5, "(r)", 2},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        const int chosen = device_select(infos, cases[i].count, cases[i].selector);
        if (chosen != cases[i].expected) fail_msg("'%s' of %u: %d, not %d", cases[i].selector, cases[i].count, chosen, cases[i].expected);
    }
}

static void test_max_loop_steps(void **state) {
    (void)state;
    const VkDriverId mesa = VK_DRIVER_ID_MESA_LLVMPIPE;
    const struct { VkDriverId driver; const char *info, *name; uint32_t version; bool few; } cases[] = {
        {mesa, "Mesa 22.3.6 (LLVM 15.0.6)", "llvmpipe", 1, true},
        {mesa, "Mesa 23.0.4", "llvmpipe", 1, true},
        {mesa, "Mesa 23.1.0", "llvmpipe", 1, false},
        {mesa, "Mesa 25.0.7-2~bpo12+1 (LLVM 19)", "llvmpipe", 1, false},
        {mesa, "", "llvmpipe", VK_MAKE_VERSION(23, 1, 2), false},
        {mesa, "", "llvmpipe", 1, true},
        {0, "", "llvmpipe (LLVM 11.0.1, 256 bits)", 1, true},
        {0, "", "GeForce", 1, false},
        {VK_DRIVER_ID_MESA_RADV, "Mesa 22.3.6", "AMD Radeon", VK_MAKE_VERSION(22, 3, 6), false},
        {VK_DRIVER_ID_GOOGLE_SWIFTSHADER, "", "SwiftShader Device (LLVM 10.0.0)", 1, false},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        const uint32_t expected = cases[i].few ? 60000 : 1u << 22;
        assert_int_equal(max_loop_steps(cases[i].driver, cases[i].info, cases[i].name, cases[i].version), expected);
    }
}

// -------------------------------------------------------------------------------------------------------------- opening, listing

// Counts warnings.
static void count_message(void *user, enum gn_level level, const char *text) {
    (void)text;
    if (level == GN_LEVEL_WARNING) ++*(int *)user;
}

// Opens a device of its own, and reports how that went.
static bool open_device(struct device *device, struct gn_error *error, const char *select, bool validate, int *warnings) {
    const struct gn_host host = {.user = warnings, .message = warnings ? count_message : NULL};
    struct context ctx = context_make(&host, error);
    return device_init(device, &ctx, &(struct gn_device_params){.select = select, .validate = validate});
}

static void test_open_and_close(void **state) {
    (void)state;
    fixture_device();
    for (int i = 0; i < 5; ++i) {
        struct device device;
        struct gn_error error;
        if (!open_device(&device, &error, getenv("GNOMON_DEVICE"), i % 2, NULL)) fail_msg("%s", error.message);
        assert_true(device.info.usable);
        assert_true(device.memory_budget > 0);
        assert_true(device.max_loop_steps >= 60000);
        assert_false(device.validating && i % 2 == 0);
        assert_int_equal(device.software, !strcmp(device.info.type, "cpu"));
        device_finish(&device);
        assert_null(device.instance);
        device_finish(&device);
    }
}

static void test_list(void **state) {
    (void)state;
    fixture_device();
    struct gn_device_info infos[MAX_CANDIDATES], first;
    uint32_t count;
    int selected;
    fixture_assert(device_list(fixture_context(), &(struct gn_device_params){0}, infos, MAX_CANDIDATES, &count, &selected));
    assert_in_range(selected, 0, count - 1);
    assert_int_equal(selected, device_select(infos, count, NULL));
    for (uint32_t i = 0; i < count; ++i) {
        assert_int_equal(infos[i].index, i);
        assert_int_equal(infos[i].usable, infos[i].reason[0] == 0);
        assert_true(!infos[i].usable || strlen(infos[i].uuid) == 36);
        assert_true(infos[i].name[0] && infos[i].driver[0] && infos[i].api[0] && infos[i].type[0]);
    }
    fixture_assert(device_list(fixture_context(), &(struct gn_device_params){.select = "no such device"}, &first, 1, &count, &selected));
    assert_int_equal(count, 1);
    assert_int_equal(selected, -1);
    assert_string_equal(first.name, infos[0].name);
}

static void test_selector_without_device(void **state) {
    (void)state;
    fixture_device();
    static const char *const selectors[] = {"no such device", "99", "uuid:ffffffffff", "uuid:"};
    for (size_t i = 0; i < COUNT(selectors); ++i) {
        struct device device;
        struct gn_error error;
        assert_false(open_device(&device, &error, selectors[i], false, NULL));
        assert_int_equal(error.status, GN_NO_DEVICE);
        assert_true(has(error.message, selectors[i]) && has(error.message, fixture_device()->info.name));
        assert_null(device.instance);
    }
}

// Runs open_device with two environment variables changed.
static bool open_with(const char *names[2], const char *value, bool validate, struct device *device, struct gn_error *error,
                      int *warnings) {
    char *old[2];
    for (int i = 0; i < 2; ++i) {
        const char *now = getenv(names[i]);
        old[i] = now ? strdup(now) : NULL;
        setenv(names[i], value, 1);
    }
    const bool opened = open_device(device, error, NULL, validate, warnings);
    for (int i = 0; i < 2; ++i) {
        if (old[i]) setenv(names[i], old[i], 1);
        else unsetenv(names[i]);
        free(old[i]);
    }
    return opened;
}

static void test_no_driver(void **state) {
    (void)state;
    struct device device;
    struct gn_error error;
    const char *names[2] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    assert_false(open_with(names, "/no/such/driver.json", false, &device, &error, NULL));
    assert_int_equal(error.status, GN_NO_DEVICE);
    assert_true(has(error.message, "mesa-vulkan-drivers"));
}

static void test_no_validation_layer(void **state) {
    (void)state;
    fixture_device();
    struct device device;
    struct gn_error error;
    int warnings = 0;
    const char *names[2] = {"VK_LAYER_PATH", "VK_ADD_LAYER_PATH"};
    if (!open_with(names, "/no/such/folder", true, &device, &error, &warnings)) fail_msg("%s", error.message);
    assert_false(device.validating);
    assert_int_equal(warnings, 1);
    device_finish(&device);
}

// The negative control of fixture_silent.
static void test_misuse_is_reported(void **state) {
    (void)state;
    if (!fixture_device()->validating) skip();
    struct device device;
    struct gn_error error;
    if (!open_device(&device, &error, getenv("GNOMON_DEVICE"), true, NULL)) fail_msg("%s", error.message);
    fixture_assert(device_validated(&device, fixture_context()));
    VkBuffer buffer = VK_NULL_HANDLE;
    const VkBufferCreateInfo empty = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
    if (vkCreateBuffer(device.handle, &empty, NULL, &buffer) == VK_SUCCESS) vkDestroyBuffer(device.handle, buffer, NULL);
    assert_false(device_validated(&device, fixture_context()));
    assert_int_equal(fixture_state()->error.status, GN_INTERNAL);
    assert_true(has(fixture_state()->error.message, "vkCreateBuffer"));
    device_finish(&device);
}

static void test_failed_calls(void **state) {
    (void)state;
    const struct { VkResult result; enum gn_status status; bool lost; const char *text; } cases[] = {
        {VK_ERROR_DEVICE_LOST, GN_DEVICE_LOST, true, "vkFoo: VK_ERROR_DEVICE_LOST"},
        {VK_ERROR_OUT_OF_DEVICE_MEMORY, GN_LIMIT, false, "vkFoo: VK_ERROR_OUT_OF_DEVICE_MEMORY"},
        {VK_ERROR_OUT_OF_HOST_MEMORY, GN_LIMIT, false, "vkFoo: VK_ERROR_OUT_OF_HOST_MEMORY"},
        {VK_ERROR_FEATURE_NOT_PRESENT, GN_SHADER, false, "vkFoo: VK_ERROR_FEATURE_NOT_PRESENT"},
        {(VkResult)-77777, GN_SHADER, false, "vkFoo: an unknown result (-77777)"},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        struct device device = {0};
        assert_false(device_fail(&device, fixture_context(), GN_SHADER, "vkFoo", cases[i].result));
        assert_int_equal(fixture_state()->error.status, cases[i].status);
        assert_true(has(fixture_state()->error.message, cases[i].text));
        assert_int_equal(device.lost, cases[i].lost);
        assert_int_equal(device_alive(&device, fixture_context()), !cases[i].lost);
    }
}

// --------------------------------------------------------------------------------------------------------------------- buffers

static bool fill_words(void *data, void *to, uint64_t offset, uint64_t size) {
    ++*(int *)data;
    for (uint64_t i = 0; i < size / 4; ++i) ((uint32_t *)to)[i] = (uint32_t)(offset / 4 + i) * 2654435761u;
    return true;
}

static void test_buffer_round_trip(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const uint64_t used = device->memory_used + (device->staging ? 0 : STAGING_BYTES);
    const struct { enum buffer_kind kind; uint64_t size; bool host_writes, host_reads; size_t granularity; } cases[] = {
        {BUFFER_TEXELS, 16, true, false, 16},        {BUFFER_STORAGE, 48, true, true, 48},
        {BUFFER_TEXELS, 4800, false, false, 48},     {BUFFER_STORAGE, 4800, false, false, 16},
        {BUFFER_STORAGE, 100, false, true, 4},       {BUFFER_TEXELS, (40u << 20) + 16, true, false, 16},
        {BUFFER_STORAGE, 48 * 1000000, false, false, 48}, {BUFFER_STORAGE, 40u << 20, false, true, 64},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        struct buffer buffer;
        int pieces = 0;
        const struct buffer_params params = {.name = "round trip", .kind = cases[i].kind, .size = cases[i].size,
                                             .host_writes = cases[i].host_writes, .host_reads = cases[i].host_reads};
        fixture_assert(buffer_init(&buffer, fixture_context(), device, &params));
        assert_true(buffer.size >= cases[i].size && buffer.size % 16 == 0);
        assert_true(!cases[i].host_reads || buffer.map);
        assert_true(cases[i].host_writes || cases[i].host_reads || !buffer.map);
        fixture_assert(buffer_fill(&buffer, fixture_context(), device, cases[i].granularity, fill_words, &pieces));
        assert_int_equal(pieces, 1 + buffer.size / (STAGING_BYTES + 1));
        uint32_t *words = malloc(cases[i].size);
        fixture_assert(buffer_download(&buffer, fixture_context(), device, words, cases[i].size));
        uint64_t wrong = 0;
        for (uint64_t k = 0; k < cases[i].size / 4; ++k) wrong += words[k] != (uint32_t)k * 2654435761u;
        assert_int_equal(wrong, 0);
        for (uint64_t k = 0; k < cases[i].size / 4; ++k) words[k] = ~words[k];
        fixture_assert(buffer_upload(&buffer, fixture_context(), device, words, cases[i].size));
        memset(words, 0, cases[i].size);
        fixture_assert(buffer_download(&buffer, fixture_context(), device, words, cases[i].size));
        for (uint64_t k = 0; k < cases[i].size / 4; ++k) wrong += words[k] != ~((uint32_t)k * 2654435761u);
        assert_int_equal(wrong, 0);
        free(words);
        buffer_finish(&buffer, device);
        buffer_finish(&buffer, device);
    }
    assert_int_equal(device->memory_used, used);
}

static void test_empty_buffer(void **state) {
    (void)state;
    struct device *device = fixture_device();
    for (int kind = BUFFER_TEXELS; kind <= BUFFER_STORAGE; ++kind) {
        struct buffer buffer;
        const struct buffer_params params = {.name = "empty", .kind = (enum buffer_kind)kind};
        fixture_assert(buffer_init(&buffer, fixture_context(), device, &params));
        assert_int_equal(buffer.size, 16);
        fixture_assert(buffer_upload(&buffer, fixture_context(), device, NULL, 0));
        fixture_assert(buffer_download(&buffer, fixture_context(), device, NULL, 0));
        buffer_finish(&buffer, device);
    }
}

static bool refuse(void *data, void *to, uint64_t offset, uint64_t size) {
    (void)to, (void)offset, (void)size;
    return (fail)(data, GN_SCENE, "refused");
}

static bool stop(void *user, const struct gn_progress *progress) {
    (void)user, (void)progress;
    return false;
}

static void test_buffer_failures(void **state) {
    (void)state;
    struct device *device = fixture_device();
    struct buffer buffer;
    char byte = 0;
    const struct buffer_params params = {.name = "big", .kind = BUFFER_STORAGE, .size = 40u << 20};
    fixture_assert(buffer_init(&buffer, fixture_context(), device, &params));
    struct context *ctx = fixture_context();
    struct gn_error *error = &fixture_state()->error;
    assert_false(buffer_fill(&buffer, ctx, device, 16, refuse, ctx));
    assert_int_equal(error->status, GN_SCENE);
    int pieces = 0;
    ctx = fixture_context();
    ctx->host.progress = stop;
    assert_false(buffer_fill(&buffer, ctx, device, 16, fill_words, &pieces));
    assert_int_equal(error->status, GN_CANCELLED);
    assert_int_equal(pieces, 1);
    const size_t granularities[] = {0, STAGING_BYTES + 1u, SIZE_MAX};
    for (size_t i = 0; i < COUNT(granularities); ++i) {
        assert_false(buffer_fill(&buffer, fixture_context(), device, granularities[i], fill_words, &pieces));
        assert_int_equal(error->status, GN_INTERNAL);
    }
    assert_false(buffer_upload(&buffer, fixture_context(), device, &byte, (40u << 20) + 1));
    assert_int_equal(error->status, GN_INTERNAL);
    assert_false(buffer_download(&buffer, fixture_context(), device, &byte, SIZE_MAX));
    assert_int_equal(error->status, GN_INTERNAL);
    buffer_finish(&buffer, device);
}

// ---------------------------------------------------------------------------------------------------------------------- limits

static void test_buffer_limits(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const VkPhysicalDeviceLimits *limits = &device->properties.limits;
    const uint64_t texels = 16 * (uint64_t)limits->maxTexelBufferElements, range = limits->maxStorageBufferRange;
    const struct { enum buffer_kind kind; uint64_t size; const char *size_text, *limit; } cases[] = {
        {BUFFER_TEXELS, 3000000000000, "3.00 TB (3000000000000 bytes)", "maxTexelBufferElements"},
        {BUFFER_STORAGE, 3000000000000, "3.00 TB (3000000000000 bytes)", "maxStorageBufferRange"},
        {BUFFER_TEXELS, texels + 1, "bytes)", "maxTexelBufferElements"},
        {BUFFER_STORAGE, range + 1, "bytes)", "maxStorageBufferRange"},
        {BUFFER_TEXELS, UINT64_MAX, "18.45 EB (18446744073709551615 bytes)", "maxTexelBufferElements"},
        {BUFFER_STAGING, UINT64_MAX, "18.45 EB (18446744073709551615 bytes)", "maxMemoryAllocationSize"},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        struct buffer buffer;
        const struct buffer_params params = {.name = "triangles", .kind = cases[i].kind, .size = cases[i].size};
        assert_false(buffer_init(&buffer, fixture_context(), device, &params));
        const char *message = fixture_state()->error.message;
        assert_int_equal(fixture_state()->error.status, GN_LIMIT);
        if (!has(message, "buffer 'triangles'")) fail_msg("%s", message);
        if (!has(message, cases[i].size_text) || !has(message, cases[i].limit)) fail_msg("%s", message);
        assert_null(buffer.handle);
        buffer_finish(&buffer, device);
    }
}

static void test_allocation_limits(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const struct buffer_params params = {.name = "nodes", .kind = BUFFER_TEXELS, .size = 64u << 20, .host_writes = true};
    const VkDeviceSize allocation = device->max_allocation;
    struct buffer buffer;
    device->max_allocation = 1000000;
    assert_false(buffer_init(&buffer, fixture_context(), device, &params));
    device->max_allocation = allocation;
    assert_string_equal(fixture_state()->error.message, "buffer 'nodes' needs 67.11 MB (67108864 bytes), "
                                                 "but the device allows 1.00 MB (1000000 bytes, maxMemoryAllocationSize)");
    const VkPhysicalDeviceMemoryProperties memory = device->memory;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) device->memory.memoryHeaps[i].size = 1 << 20;
    assert_false(buffer_init(&buffer, fixture_context(), device, &params));
    device->memory = memory;
    assert_int_equal(fixture_state()->error.status, GN_LIMIT);
    assert_true(has(fixture_state()->error.message, "heap"));
    fixture_assert(buffer_init(&buffer, fixture_context(), device, &params));
    buffer_finish(&buffer, device);
}

static uint64_t address_space(void) {
    char line[128];
    uint64_t kilobytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file) && sscanf(line, "VmSize: %" SCNu64, &kilobytes) != 1) {}
    if (file) fclose(file);
    return kilobytes * 1024;
}

// Whether a buffer can be made while this process may take only 100 MB more.
static bool make_within_limit(struct device *device, const struct buffer_params *params) {
    struct rlimit old, few;
    struct buffer buffer;
    assert_int_equal(getrlimit(RLIMIT_AS, &old), 0);
    few = old;
    few.rlim_cur = address_space() + (100u << 20);
    assert_int_equal(setrlimit(RLIMIT_AS, &few), 0);
    const bool made = buffer_init(&buffer, fixture_context(), device, params);
    setrlimit(RLIMIT_AS, &old);
    buffer_finish(&buffer, device);
    return made;
}

// A software device takes its memory from this process, which may have a limit.
static void test_process_limit(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const struct buffer_params params = {.name = "normals", .kind = BUFFER_TEXELS, .size = 200u << 20, .host_writes = true};
    struct buffer buffer;
    if (!device->software || address_space() == 0) skip();
    assert_false(make_within_limit(device, &params));
    assert_int_equal(fixture_state()->error.status, GN_LIMIT);
    assert_true(has(fixture_state()->error.message, "buffer 'normals' needs 209.72 MB (209715200 bytes)"));
    assert_true(has(fixture_state()->error.message, "this machine's memory"));
#ifndef __SANITIZE_ADDRESS__ // its malloc ends the program where others return NULL
    // What only the driver notices, or not even that.
    device->software = false;
    assert_false(make_within_limit(device, &params));
    device->software = true;
    assert_int_equal(fixture_state()->error.status, GN_LIMIT);
    assert_true(has(fixture_state()->error.message, "buffer 'normals' needs 209.72 MB (209715200 bytes), but vkAllocateMemory"));
#endif
    fixture_assert(buffer_init(&buffer, fixture_context(), device, &params));
    buffer_finish(&buffer, device);
}

static void test_image_limits(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const struct { uint32_t width, height; enum gn_status status; const char *text; } cases[] = {
        {1000000, 4, GN_LIMIT, "maxImageDimension2D"},
        {4, UINT32_MAX, GN_LIMIT, "maxImageDimension2D"},
        {16384, 16384, GN_LIMIT, "image 'film' needs 4.29 GB (4294967296 bytes)"},
        {0, 4, GN_INTERNAL, "no pixels"},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        struct storage_image image;
        const bool made =
            storage_image_init(&image, fixture_context(), device, "film", VK_FORMAT_R32G32B32A32_SFLOAT, cases[i].width, cases[i].height);
        storage_image_finish(&image, device);
        if (made && !device->software) continue;
        assert_false(made);
        assert_int_equal(fixture_state()->error.status, cases[i].status);
        if (!has(fixture_state()->error.message, cases[i].text)) fail_msg("%s", fixture_state()->error.message);
    }
}

// --------------------------------------------------------------------------------------------------------------------- kernels

static void test_specialization(void **state) {
    (void)state;
    fixture_device();
    const uint32_t in[3] = {1, 5, 7};
    const struct { size_t count; struct kernel_constant constants[2]; uint32_t factor; } cases[] = {
        {0, {{0, 0}}, 1}, {1, {{7, 3}}, 3}, {1, {{63, 1}}, UINT32_MAX}, {2, {{63, 1}, {7, 2}}, 0xfffffffeu},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        uint32_t out[4] = {9, 9, 9, 9};
        const struct fixture_job job = {FIXTURE_KERNEL(device_scale), .constants = cases[i].constants, .constant_count = cases[i].count,
                                        .in = in, .in_bytes = sizeof in, .out = out, .out_bytes = sizeof out, .count = 3};
        fixture_run(&job);
        for (int k = 0; k < 3; ++k) assert_int_equal(out[k], cases[i].factor * in[k]);
        assert_int_equal(out[3], 9);
    }
}

static void test_texels(void **state) {
    (void)state;
    enum { TEXELS = 100000 };
    struct device *device = fixture_device();
    struct buffer in, out;
    struct kernel kernel;
    const struct buffer_params in_params = {.name = "in", .kind = BUFFER_TEXELS, .size = 16 * TEXELS, .host_writes = true};
    const struct buffer_params out_params = {.name = "out", .kind = BUFFER_STORAGE, .size = 16 * TEXELS};
    const struct kernel_binding bindings[] = {{.binding = 0, .buffer = &in}, {.binding = 9, .buffer = &out}, {.binding = 5, .buffer = &in}};
    const struct kernel_params params = {FIXTURE_KERNEL(device_texels), .bindings = bindings, .binding_count = 3, .push_size = 4};
    fixture_assert(buffer_init(&in, fixture_context(), device, &in_params));
    fixture_assert(buffer_init(&out, fixture_context(), device, &out_params));
    fixture_assert(kernel_init(&kernel, fixture_context(), device, &params));
    uint32_t *words = calloc(TEXELS, 16);
    const uint32_t count = TEXELS;
    for (int round = 0; round < 3; ++round) {
        double seconds = -1;
        for (uint32_t i = 0; i < 4 * TEXELS; ++i) words[i] = i * 2654435761u + (uint32_t)round;
        fixture_assert(buffer_upload(&in, fixture_context(), device, words, 16 * TEXELS));
        fixture_assert(kernel_run(&kernel, fixture_context(), device, &count, (TEXELS + 63) / 64, &seconds));
        assert_true(seconds > 0 && seconds < 60);
        fixture_assert(buffer_download(&out, fixture_context(), device, words, 16 * TEXELS));
        for (uint32_t i = 0; i < 4 * TEXELS; ++i) assert_int_equal(words[i], (i + 4) % (4 * TEXELS) * 2654435761u + (uint32_t)round);
    }
    free(words);
    kernel_finish(&kernel, device);
    kernel_finish(&kernel, device);
    buffer_finish(&out, device);
    buffer_finish(&in, device);
}

// Whether the images hold `times` times what the kernel adds.
static bool image_holds(struct storage_image *color, struct storage_image *id, uint32_t rows, float times) {
    struct device *device = fixture_device();
    const uint32_t width = color->width;
    float *pixels = malloc((size_t)width * rows * 16);
    int32_t *ids = malloc((size_t)width * rows * 8);
    fixture_assert(storage_image_download(color, fixture_context(), device, rows, pixels));
    fixture_assert(storage_image_download(id, fixture_context(), device, rows, ids));
    bool same = true;
    for (uint32_t i = 0; i < width * rows; ++i) {
        const float x = (float)(i % width), y = (float)(i / width), *p = pixels + 4 * i;
        same = same && p[0] == times * x && p[1] == times * y && p[2] == times * (float)width && p[3] == times;
        same = same && ids[2 * i] == (int32_t)(times * x) && ids[2 * i + 1] == (int32_t)(times * -y);
    }
    free(pixels);
    free(ids);
    return same;
}

static void test_images(void **state) {
    (void)state;
    struct device *device = fixture_device();
    const uint32_t sizes[][2] = {{1, 1}, {37, 19}, {2048, 1100}};
    for (size_t i = 0; i < COUNT(sizes); ++i) {
        const uint32_t *size = sizes[i], groups = (size[0] * size[1] + 63) / 64;
        struct storage_image color, id;
        struct kernel kernel;
        const struct kernel_binding bindings[] = {{.binding = 0, .image = &color}, {.binding = 1, .image = &id}};
        const struct kernel_params params = {FIXTURE_KERNEL(device_image), .bindings = bindings, .binding_count = 2, .push_size = 8};
        fixture_assert(storage_image_init(&color, fixture_context(), device, "color", VK_FORMAT_R32G32B32A32_SFLOAT, size[0], size[1]));
        fixture_assert(storage_image_init(&id, fixture_context(), device, "id", VK_FORMAT_R32G32_SINT, size[0], size[1]));
        assert_true(image_holds(&color, &id, size[1], 0));
        fixture_assert(kernel_init(&kernel, fixture_context(), device, &params));
        fixture_assert(kernel_run(&kernel, fixture_context(), device, size, groups, NULL));
        fixture_assert(kernel_run(&kernel, fixture_context(), device, size, groups, NULL));
        assert_true(image_holds(&color, &id, size[1], 2));
        assert_true(image_holds(&color, &id, (size[1] + 1) / 2, 2));
        assert_false(size[1] > 1 && image_holds(&color, &id, size[1], 1));
        fixture_assert(storage_image_clear(&color, fixture_context(), device) && storage_image_clear(&id, fixture_context(), device));
        assert_true(image_holds(&color, &id, size[1], 0));
        assert_false(storage_image_download(&color, fixture_context(), device, size[1] + 1, NULL));
        assert_int_equal(fixture_state()->error.status, GN_INTERNAL);
        kernel_finish(&kernel, device);
        storage_image_finish(&color, device);
        storage_image_finish(&id, device);
    }
}

static void test_spirv_fault(void **state) {
    (void)state;
    uint32_t good[sizeof kernel_device_scale / 4], words[sizeof kernel_device_scale / 4];
    memcpy(good, kernel_device_scale, sizeof good);
    assert_null(spirv_fault(good, sizeof good));
    const struct { size_t size; int word; uint32_t value; const char *text; } cases[] = {
        {0, 0, 0, "short"},
        {12, 0, 0x07230203, "short"},
        {sizeof good - 1, 0, 0x07230203, "short"},
        {20, 0, 0x07230203, "end is missing"},
        {sizeof good, 0, 0x03022307, "magic"},
        {sizeof good, 1, 0x00010600, "version"},
        {sizeof good, 1, 0, "version"},
        {sizeof good, 5, 0x00000011, "no length"},
        {sizeof good, 5, 0xffff0011, "end is missing"},
        {sizeof good - 4, 0, 0x07230203, "end is missing"},
    };
    for (size_t i = 0; i < COUNT(cases); ++i) {
        memcpy(words, good, sizeof good);
        words[cases[i].word] = cases[i].value;
        const char *fault = spirv_fault(words, cases[i].size);
        if (!fault || !has(fault, cases[i].text)) fail_msg("case %zu: %s", i, fault ? fault : "no fault");
    }
}

static void test_kernel_failures(void **state) {
    (void)state;
    struct device *device = fixture_device();
    struct buffer in, out;
    struct kernel kernel;
    const struct buffer_params storage = {.name = "a", .kind = BUFFER_STORAGE, .size = 64};
    const struct kernel_binding both[] = {{.binding = 0, .buffer = &in}, {.binding = 1, .buffer = &out}}, neither[] = {{.binding = 0}};
    fixture_assert(buffer_init(&in, fixture_context(), device, &storage));
    fixture_assert(buffer_init(&out, fixture_context(), device, &storage));
    const struct kernel_params good = {FIXTURE_KERNEL(device_scale), .bindings = both, .binding_count = 2, .push_size = 4};
    struct kernel_params bad[] = {good, good, good, good, good};
    const enum gn_status status[] = {GN_SHADER, GN_INTERNAL, GN_INTERNAL, GN_INTERNAL, GN_INTERNAL};
    bad[0].spirv_size -= 4;
    bad[1].push_size = 132;
    bad[2].push_size = 2;
    bad[3].constant_count = 65;
    bad[4].bindings = neither, bad[4].binding_count = 1;
    for (size_t i = 0; i < COUNT(bad); ++i) {
        assert_false(kernel_init(&kernel, fixture_context(), device, bad + i));
        assert_int_equal(fixture_state()->error.status, status[i]);
        assert_true(has(fixture_state()->error.message, "kernel 'device_scale'"));
        kernel_finish(&kernel, device);
    }
    const uint32_t count = 0, most = device->properties.limits.maxComputeWorkGroupCount[0];
    fixture_assert(kernel_init(&kernel, fixture_context(), device, &good));
    fixture_assert(kernel_run(&kernel, fixture_context(), device, &count, 0, NULL));
    assert_false(kernel.warm);
    assert_true(most == UINT32_MAX || !kernel_run(&kernel, fixture_context(), device, &count, most + 1, NULL));
    fixture_assert(kernel_run(&kernel, fixture_context(), device, &count, 1, NULL));
    assert_true(kernel.warm);
    kernel_finish(&kernel, device);
    buffer_finish(&out, device);
    buffer_finish(&in, device);
}

// Kernels that differ in their buffers alone share a pipeline, and each keeps to its own buffers; another constant is another pipeline.
static void test_pipelines_are_kept(void **state) {
    (void)state;
    enum { KERNELS = 3 };
    struct device *device = fixture_device();
    struct buffer in, out[KERNELS];
    struct kernel kernel[KERNELS];
    const struct buffer_params storage = {.name = "a", .kind = BUFFER_STORAGE, .size = 64, .host_writes = true, .host_reads = true};
    const struct kernel_constant factors[KERNELS] = {{7, 11}, {7, 11}, {7, 13}};
    const uint32_t given = 3, count = 1;
    fixture_assert(buffer_init(&in, fixture_context(), device, &storage));
    fixture_assert(buffer_upload(&in, fixture_context(), device, &given, sizeof given));
    for (int i = 0; i < KERNELS; ++i) {
        fixture_assert(buffer_init(out + i, fixture_context(), device, &storage));
        const struct kernel_binding both[] = {{.binding = 0, .buffer = &in}, {.binding = 1, .buffer = out + i}};
        const struct kernel_params params = {FIXTURE_KERNEL(device_scale), .constants = factors + i, .constant_count = 1,
                                             .bindings = both, .binding_count = 2, .push_size = 4};
        fixture_assert(kernel_init(kernel + i, fixture_context(), device, &params));
    }
    assert_ptr_equal(kernel[0].pipeline, kernel[1].pipeline);
    assert_ptr_not_equal(kernel[0].pipeline, kernel[2].pipeline);
    for (int i = 0; i < KERNELS; ++i) {
        uint32_t result;
        fixture_assert(kernel_run(kernel + i, fixture_context(), device, &count, 1, NULL));
        fixture_assert(buffer_download(out + i, fixture_context(), device, &result, sizeof result));
        assert_int_equal(result, given * factors[i].value);
        kernel_finish(kernel + i, device);
        buffer_finish(out + i, device);
    }
    buffer_finish(&in, device);
}

// More specializations than are kept: those that go may be asked for again.
static void test_pipelines_are_limited(void **state) {
    (void)state;
    struct device *device = fixture_device();
    struct buffer buffer;
    const struct buffer_params storage = {.name = "a", .kind = BUFFER_STORAGE, .size = 64};
    const struct kernel_binding both[] = {{.binding = 0, .buffer = &buffer}, {.binding = 1, .buffer = &buffer}};
    fixture_assert(buffer_init(&buffer, fixture_context(), device, &storage));
    for (uint32_t i = 0; i < 2 * PIPELINES_KEPT; ++i) {
        struct kernel kernel;
        const struct kernel_constant factor = {7, 1000 + i};
        const struct kernel_params params = {FIXTURE_KERNEL(device_scale), .constants = &factor, .constant_count = 1, .bindings = both,
                                             .binding_count = 2, .push_size = 4};
        fixture_assert(kernel_init(&kernel, fixture_context(), device, &params));
        kernel_finish(&kernel, device);
    }
    assert_int_equal(device->pipeline_count, PIPELINES_KEPT);
    buffer_finish(&buffer, device);
}

// ---------------------------------------------------------------------------------------------------- time-outs and cancellation

// A device of the child's own, and a kernel that is busy for as long as it gets workgroups.
struct spin {
    struct device device;
    struct gn_error error;
    struct context ctx;
    struct buffer out;
    struct kernel kernel;
};

static bool spin_init(struct spin *spin) {
    const struct buffer_params out = {.name = "out", .kind = BUFFER_STORAGE, .size = 256};
    const struct kernel_binding binding = {.buffer = &spin->out};
    const struct kernel_params params = {FIXTURE_KERNEL(device_spin), .bindings = &binding, .binding_count = 1};
    if (!open_device(&spin->device, &spin->error, getenv("GNOMON_DEVICE"), false, NULL)) return false;
    spin->ctx = context_make(NULL, &spin->error);
    return buffer_init(&spin->out, &spin->ctx, &spin->device, &out) && kernel_init(&spin->kernel, &spin->ctx, &spin->device, &params) &&
           kernel_run(&spin->kernel, &spin->ctx, &spin->device, NULL, 1, NULL);
}

// Runs it; returns the seconds that took, or -1 where that was no failure with `status`.
static double spin_run(struct spin *spin, uint32_t groups, bool cancel, enum gn_status status) {
    const double start = clock_seconds();
    spin->ctx = context_make(&(struct gn_host){.progress = cancel ? stop : NULL}, &spin->error);
    if (kernel_run(&spin->kernel, &spin->ctx, &spin->device, NULL, groups, NULL)) return -1;
    if (spin->error.status == status) return clock_seconds() - start;
    fprintf(stderr, "status %d: %s\n", spin->error.status, spin->error.message);
    return -1;
}

// After a loss everything must return at once, and nothing may be started.
static bool is_dead(struct spin *spin) {
    char byte;
    struct storage_image image;
    const double start = clock_seconds();
    bool dead = spin->device.lost && spin_run(spin, 1, false, GN_DEVICE_LOST) >= 0;
    spin->ctx = context_make(NULL, &spin->error);
    dead = dead && !buffer_download(&spin->out, &spin->ctx, &spin->device, &byte, 1) && spin->error.status == GN_DEVICE_LOST;
    dead = dead && !storage_image_init(&image, &spin->ctx, &spin->device, "film", VK_FORMAT_R32G32_SINT, 1, 1);
    storage_image_finish(&image, &spin->device);
    kernel_finish(&spin->kernel, &spin->device);
    buffer_finish(&spin->out, &spin->device);
    device_finish(&spin->device);
    return dead && clock_seconds() - start < 0.5;
}

enum { FOREVER = 65535 };

static int child_timeout(struct spin *spin) {
    spin->device.dispatch_limit = 0.3;
    const double seconds = spin_run(spin, FOREVER, false, GN_DEVICE_LOST);
    if (seconds < 0.3 || seconds > 5 || !has(spin->error.message, "0.3 s") || !has(spin->error.message, "MESA_SHADER_CACHE_DIR")) return 1;
    return is_dead(spin) ? 0 : 1;
}

static int child_cancel_long(struct spin *spin) {
    const double seconds = spin_run(spin, FOREVER, true, GN_CANCELLED);
    fprintf(stderr, "cancelled after %.2f s\n", seconds);
    return seconds > 0.5 && seconds < 3 && is_dead(spin) ? 0 : 1;
}

// Work that ends soon after it was cancelled leaves the device as it was.
static int child_cancel_short(struct spin *spin) {
    uint32_t groups = 1;
    for (double seconds = 0; seconds < 0.2 && groups < FOREVER / 2;) {
        if (!kernel_run(&spin->kernel, &spin->ctx, &spin->device, NULL, groups *= 2, &seconds)) return 1;
    }
    if (groups > FOREVER / 2) return 77;
    const double seconds = spin_run(spin, groups, true, GN_CANCELLED);
    fprintf(stderr, "cancelled after %.2f s\n", seconds);
    if (seconds > 0.5) return 77;
    spin->ctx = context_make(NULL, &spin->error);
    return seconds > 0 && !spin->device.lost && kernel_run(&spin->kernel, &spin->ctx, &spin->device, NULL, 1, NULL) ? 0 : 1;
}

static const struct child { const char *name; int (*run)(struct spin *spin); } CHILDREN[] = {
    {"timeout", child_timeout}, {"cancel-long", child_cancel_long}, {"cancel-short", child_cancel_short}};

// Never returns: what was lost is still running.
static void run_child(const char *name) {
    static struct spin spin;
    int code = spin_init(&spin) ? 1 : spin.error.status == GN_NO_DEVICE ? 77 : 1;
    if (code == 1 && spin.error.status != GN_OK) fprintf(stderr, "%s\n", spin.error.message);
    for (size_t i = 0; i < COUNT(CHILDREN); ++i) {
        if (spin.kernel.warm && !strcmp(name, CHILDREN[i].name)) code = CHILDREN[i].run(&spin);
    }
    fflush(NULL);
    _Exit(code);
}

static void test_time_limits(void **state) {
    (void)state;
    bool skipped = false;
    for (size_t i = 0; i < COUNT(CHILDREN); ++i) {
        char name[32];
        pid_t child;
        int status;
        snprintf(name, sizeof name, "%s", CHILDREN[i].name);
        const double start = clock_seconds();
        assert_int_equal(posix_spawn(&child, "/proc/self/exe", NULL, NULL, (char *[]){"test_device", name, NULL}, environ), 0);
        assert_int_equal(waitpid(child, &status, 0), child);
        if (!WIFEXITED(status)) fail_msg("%s: status %#x", name, (unsigned)status);
        if (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != 77) fail_msg("%s: exit code %d", name, WEXITSTATUS(status));
        if (!(clock_seconds() - start < 30)) fail_msg("%s: it took %.1f s to end", name, clock_seconds() - start);
        skipped = skipped || WEXITSTATUS(status) == 77;
    }
    if (skipped) skip();
}

int main(int argc, char **argv) {
    if (argc > 1) run_child(argv[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_select),
        cmocka_unit_test(test_max_loop_steps),
        cmocka_unit_test(test_spirv_fault),
        cmocka_unit_test(test_open_and_close),
        cmocka_unit_test(test_list),
        cmocka_unit_test(test_selector_without_device),
        cmocka_unit_test(test_no_driver),
        cmocka_unit_test(test_no_validation_layer),
        cmocka_unit_test(test_misuse_is_reported),
        cmocka_unit_test(test_failed_calls),
        cmocka_unit_test(test_buffer_round_trip),
        cmocka_unit_test(test_empty_buffer),
        cmocka_unit_test(test_buffer_failures),
        cmocka_unit_test(test_buffer_limits),
        cmocka_unit_test(test_allocation_limits),
        cmocka_unit_test(test_process_limit),
        cmocka_unit_test(test_image_limits),
        cmocka_unit_test(test_specialization),
        cmocka_unit_test(test_texels),
        cmocka_unit_test(test_images),
        cmocka_unit_test(test_kernel_failures),
        cmocka_unit_test(test_pipelines_are_kept),
        cmocka_unit_test(test_pipelines_are_limited),
        cmocka_unit_test(test_time_limits),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
