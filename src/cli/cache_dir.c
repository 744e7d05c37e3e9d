// The hash covers: the environment that selects or tunes a driver; every driver manifest (name, size, time); and the library each manifest
// names, so that a new Mesa in an old place gets a new folder. Some 20 system calls, no processes.
#include "cli/cache_dir.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

#define PATH_SIZE 1024

extern char **environ;

// FNV-1a, 64 bits (G. Fowler, L. C. Noll, K.-P. Vo).
static void mix(uint64_t *hash, const void *data, size_t size) {
    for (size_t i = 0; i < size; i++) *hash = (*hash ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
}

static void mix_text(uint64_t *hash, const char *text) { mix(hash, text, strlen(text) + 1); }

// ----------------------------------------------------------------------------------------------------------- environment

static bool starts_with(const char *text, const char *start) { return strncmp(text, start, strlen(start)) == 0; }

// The hash of each variable is added, not chained: their order in the environment means nothing.
static void mix_environment(uint64_t *hash) {
    static const char *const starts[] = {
        "VK_DRIVER_FILES=", "VK_ICD_FILENAMES=", "VK_ADD_DRIVER_FILES=", "LD_LIBRARY_PATH=", "LP_", "GALLIVM_", "MESA_LOADER_", "LIBGL_"};
    uint64_t sum = 0;
    for (char **variable = environ; *variable; variable++) {
        for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
            uint64_t own = 0xcbf29ce484222325u;
            if (!starts_with(*variable, starts[i])) continue;
            mix_text(&own, *variable);
            sum += own;
        }
    }
    mix(hash, &sum, sizeof sum);
}

// ------------------------------------------------------------------------------------------------------------- manifests

// One after the other the items of a list separated by colons: copies the first of *list to item, and moves on. False at the end.
static bool next_item(char item[PATH_SIZE], const char **list) {
    while (**list == ':') ++*list;
    size_t length = strcspn(*list, ":");
    snprintf(item, PATH_SIZE, "%.*s", (int)(length < PATH_SIZE ? length : PATH_SIZE - 1), *list);
    *list += length;
    return length > 0;
}

static bool mix_file(uint64_t *hash, const char *path) {
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) return false;
    int64_t facts[3] = {info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec};
    mix_text(hash, path);
    mix(hash, facts, sizeof facts);
    return true;
}

// The library that a manifest names. A bare name is looked for where the loader would: LD_LIBRARY_PATH and the system's folders.
static void mix_library(uint64_t *hash, const char *manifest, const char *library) {
    char path[2 * PATH_SIZE + 2], folder[PATH_SIZE];
    const char *slash = strrchr(manifest, '/');
    if (library[0] == '/') {
        mix_file(hash, library);
    } else if (strchr(library, '/')) {
        snprintf(path, sizeof path, "%.*s/%s", slash ? (int)(slash - manifest) : 1, slash ? manifest : ".", library);
        mix_file(hash, path);
    } else {
        struct utsname machine;
        char multiarch[PATH_SIZE];
        const char *own = getenv("LD_LIBRARY_PATH"), *lists[2] = {own ? own : "", multiarch};
        if (uname(&machine) != 0) machine.machine[0] = 0;
        snprintf(multiarch, sizeof multiarch, "/usr/lib/%s-linux-gnu:/usr/lib64:/usr/lib:/usr/local/lib", machine.machine);
        for (int i = 0; i < 2; i++) {
            while (next_item(folder, &lists[i])) {
                snprintf(path, sizeof path, "%s/%s", folder, library);
                if (mix_file(hash, path)) return;
            }
        }
    }
}

// A manifest, and the library in its first "library_path"; its JSON is not parsed further.
static void mix_manifest(uint64_t *hash, const char *path) {
    char text[4096], library[PATH_SIZE];
    if (!mix_file(hash, path)) return;
    FILE *file = fopen(path, "rb");
    if (!file) return;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    const char *key = strstr(text, "\"library_path\"");
    if (key && sscanf(key + 14, " : \"%1023[^\"]\"", library) == 1) mix_library(hash, path, library);
}

// All manifests of a folder. Their hashes are added: a folder has no order.
static void mix_manifests_in(uint64_t *hash, const char *folder) {
    DIR *directory = opendir(folder);
    if (!directory) return;
    uint64_t sum = 0;
    for (struct dirent *entry; (entry = readdir(directory));) {
        char path[2 * PATH_SIZE];
        size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 5, ".json") != 0) continue;
        uint64_t own = 0xcbf29ce484222325u;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        mix_manifest(&own, path);
        sum += own;
    }
    closedir(directory);
    mix(hash, &sum, sizeof sum);
}

static const char *environment(const char *name, const char *otherwise) {
    const char *value = getenv(name);
    return value && *value ? value : otherwise;
}

// Where the Vulkan loader looks (LoaderDriverInterface.md of the Khronos loader): what VK_DRIVER_FILES names, else the icd.d folders.
static void mix_drivers(uint64_t *hash) {
    char item[PATH_SIZE], folder[PATH_SIZE + 16], own_data[PATH_SIZE];
    const char *files = environment("VK_DRIVER_FILES", environment("VK_ICD_FILENAMES", ""));
    const char *added = environment("VK_ADD_DRIVER_FILES", "");
    bool chosen = *files;
    while (next_item(item, &files)) mix_manifest(hash, item);
    while (!chosen && next_item(item, &added)) mix_manifest(hash, item);
    snprintf(own_data, sizeof own_data, "%s/.local/share", environment("HOME", ""));
    const char *lists[] = {environment("XDG_CONFIG_DIRS", "/etc/xdg"), "/usr/local/etc:/etc", environment("XDG_DATA_HOME", own_data),
                           environment("XDG_DATA_DIRS", "/usr/local/share:/usr/share")};
    for (size_t i = 0; !chosen && i < sizeof lists / sizeof *lists; i++) {
        while (next_item(item, &lists[i])) {
            snprintf(folder, sizeof folder, "%s/vulkan/icd.d", item);
            mix_manifests_in(hash, folder);
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------- folder

// Makes a folder and those above it that are missing. `path` is changed on the way and restored.
static bool make_folders(char *path) {
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        mkdir(path, 0700);
        *slash = '/';
    }
    mkdir(path, 0700);
    return access(path, W_OK | X_OK) == 0;
}

void cache_dir_choose(void) {
    if (getenv("MESA_SHADER_CACHE_DIR") || getenv("MESA_SHADER_CACHE_DISABLE")) return;
    const char *cache = environment("XDG_CACHE_HOME", ""), *home = environment("HOME", "");
    uint64_t hash = 0xcbf29ce484222325u;
    char path[PATH_SIZE];
    int size;
    mix_environment(&hash);
    mix_drivers(&hash);
    if (*cache == '/')
        size = snprintf(path, sizeof path, "%s/gnomon/mesa-%016llx", cache, (unsigned long long)hash);
    else if (*home == '/' && access(home, W_OK | X_OK) == 0)
        size = snprintf(path, sizeof path, "%s/.cache/gnomon/mesa-%016llx", home, (unsigned long long)hash);
    else
        return;
    if (size > 0 && (size_t)size < sizeof path && make_folders(path)) setenv("MESA_SHADER_CACHE_DIR", path, 1);
}
