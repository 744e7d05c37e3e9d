// A look at SPIR-V before a driver sees it: the header, and instructions that fill the module exactly and end with a function (SPIR-V
// specification, 2.3 Physical Layout and 2.4 Logical Layout).
#include "device/spirv.h"

enum { HEADER_WORDS = 5, MAGIC = 0x07230203, VERSION_1_0 = 0x00010000, VERSION_1_3 = 0x00010300, FUNCTION_END = 56 };

const char *spirv_fault(const uint32_t *words, size_t size) {
    const size_t count = size / sizeof *words;
    if (!words || size % sizeof *words || count < HEADER_WORDS) return "it is too short";
    if (words[0] != MAGIC) return "it does not begin with the magic number 0x07230203";
    if (words[1] < VERSION_1_0 || words[1] > VERSION_1_3) return "its version is not 1.0 to 1.3";
    uint32_t last = 0;
    for (size_t i = HEADER_WORDS, length; i < count; i += length) {
        length = words[i] >> 16;
        last = words[i] & 0xffff;
        if (length == 0) return "an instruction has no length";
        if (length > count - i) return "its end is missing";
    }
    return last == FUNCTION_END ? NULL : "its end is missing";
}
