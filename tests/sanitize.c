// Part of every program of the sanitized build: lets LeakSanitizer tell a driver's leaks from ours.
//
// The Vulkan loader unloads the drivers with the instance, and a leak from an unloaded library has no name that could be suppressed.
// So nothing is unloaded, and what leaks in the libraries below, or is allocated by them, is not counted.
#pragma GCC visibility push(default)
int dlclose(void *handle);
const char *__lsan_default_suppressions(void);
const char *__lsan_default_options(void);

int dlclose(void *handle) {
    (void)handle;
    return 0;
}

const char *__lsan_default_suppressions(void) {
    return "leak:libvulkan_\n"
           "leak:libvulkan.so\n"
           "leak:libVkLayer\n"
           "leak:libLLVM\n";
}

const char *__lsan_default_options(void) { return "print_suppressions=0"; }
