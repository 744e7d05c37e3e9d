// The physical layout of a module (SPIR-V specification, 2.3 and 2.4): header, capabilities, extensions, …, entry points, execution modes,
// … A declaration is a capability, an extension and an execution mode: two places, found in one pass and filled in a second.
#include "device/float_controls.h"

#include <stdbool.h>
#include <string.h>

#include "device/spirv.h"

enum { HEADER_WORDS = 5, OP_EXTENSION = 10, OP_ENTRY_POINT = 15, OP_EXECUTION_MODE = 16, OP_CAPABILITY = 17, CAPABILITY_FLOAT64 = 10 };

// "SPV_KHR_float_controls" with its zero byte, in little-endian words.
#define NAME_WORDS 6
static const char EXTENSION[NAME_WORDS * sizeof(uint32_t)] = "SPV_KHR_float_controls";

static const struct declaration {
    uint32_t control, capability, mode, bits;
} DECLARATIONS[] = {
    {FLOAT_NEAREST_32, 4467, 4462, 32},
    {FLOAT_NEAREST_64, 4467, 4462, 64},
    {FLOAT_SPECIAL_32, 4466, 4461, 32},
    {FLOAT_SPECIAL_64, 4466, 4461, 64},
};
#define DECLARATION_COUNT (sizeof DECLARATIONS / sizeof *DECLARATIONS)

// ---------------------------------------------------------------------------------------------------------------- device

// Where the modes of different widths depend on each other, rounding is declared for both or for none (we use no 16-bit floats).
uint32_t float_controls_accepted(const VkPhysicalDeviceFloatControlsProperties *properties) {
    const bool together = properties->roundingModeIndependence == VK_SHADER_FLOAT_CONTROLS_INDEPENDENCE_NONE;
    const bool nearest32 = properties->shaderRoundingModeRTEFloat32, nearest64 = properties->shaderRoundingModeRTEFloat64;
    uint32_t accepted = 0;
    if (nearest32 && (nearest64 || !together)) accepted |= FLOAT_NEAREST_32;
    if (nearest64 && (nearest32 || !together)) accepted |= FLOAT_NEAREST_64;
    if (properties->shaderSignedZeroInfNanPreserveFloat32) accepted |= FLOAT_SPECIAL_32;
    if (properties->shaderSignedZeroInfNanPreserveFloat64) accepted |= FLOAT_SPECIAL_64;
    return accepted;
}

// ---------------------------------------------------------------------------------------------------------------- module

// Words of a module, by number of the first: the two places, and what is left to declare.
struct places {
    size_t capabilities_end, entry_points_end;
    uint32_t controls;
};

static uint32_t length_of(uint32_t word) { return word >> 16; }
static uint32_t code_of(uint32_t word) { return word & 0xffff; }

// The declarations that a capability of the module makes unnecessary.
static uint32_t declared_by(uint32_t capability) {
    uint32_t controls = 0;
    for (size_t i = 0; i < DECLARATION_COUNT; ++i)
        if (DECLARATIONS[i].capability == capability) controls |= DECLARATIONS[i].control;
    return controls;
}

static bool find_places(struct places *out, const uint32_t *words, size_t count, uint32_t controls) {
    *out = (struct places){.capabilities_end = HEADER_WORDS};
    uint32_t declared = 0;
    bool doubles = false;
    for (size_t i = HEADER_WORDS; i < count; i += length_of(words[i])) {
        const uint32_t code = code_of(words[i]), end = length_of(words[i]);
        if (code == OP_CAPABILITY) {
            if (end != 2) return false;
            out->capabilities_end = i + end;
            doubles = doubles || words[i + 1] == CAPABILITY_FLOAT64;
            declared |= declared_by(words[i + 1]);
        }
        if (code == OP_ENTRY_POINT) {
            if (end < 4) return false;
            out->entry_points_end = i + end;
        }
    }
    out->controls = controls & ~declared & (doubles ? FLOAT_ALL : FLOAT_NEAREST_32 | FLOAT_SPECIAL_32);
    return out->entry_points_end >= out->capabilities_end;
}

// Where the copy stands; without `out` it only counts.
struct writer {
    uint32_t *out;
    size_t count;
};

static void put(struct writer *writer, const uint32_t *words, size_t count) {
    if (writer->out) memcpy(writer->out + writer->count, words, count * sizeof *words);
    writer->count += count;
}

static void put_capabilities(struct writer *writer, uint32_t controls) {
    uint32_t last = 0;
    for (size_t i = 0; i < DECLARATION_COUNT; ++i) {
        if (!(controls & DECLARATIONS[i].control) || DECLARATIONS[i].capability == last) continue;
        last = DECLARATIONS[i].capability;
        put(writer, (uint32_t[]){2u << 16 | OP_CAPABILITY, last}, 2);
    }
    uint32_t name[NAME_WORDS];
    memcpy(name, EXTENSION, sizeof name);
    put(writer, &(uint32_t){(1u + NAME_WORDS) << 16 | OP_EXTENSION}, 1);
    put(writer, name, NAME_WORDS);
}

static void put_modes(struct writer *writer, uint32_t controls, uint32_t entry_point) {
    for (size_t i = 0; i < DECLARATION_COUNT; ++i) {
        if (!(controls & DECLARATIONS[i].control)) continue;
        put(writer, (uint32_t[]){4u << 16 | OP_EXECUTION_MODE, entry_point, DECLARATIONS[i].mode, DECLARATIONS[i].bits}, 4);
    }
}

size_t float_controls_declare(uint32_t *out, const uint32_t *words, size_t size, uint32_t controls) {
    const size_t count = size / sizeof *words;
    struct places places;
    struct writer writer = {.out = out};
    if (spirv_fault(words, size) || !find_places(&places, words, count, controls)) return 0;
    put(&writer, words, places.capabilities_end);
    if (places.controls) put_capabilities(&writer, places.controls);
    put(&writer, words + places.capabilities_end, places.entry_points_end - places.capabilities_end);
    for (size_t i = HEADER_WORDS; i < places.entry_points_end; i += length_of(words[i]))
        if (code_of(words[i]) == OP_ENTRY_POINT) put_modes(&writer, places.controls, words[i + 2]);
    put(&writer, words + places.entry_points_end, count - places.entry_points_end);
    return writer.count * sizeof *words;
}
