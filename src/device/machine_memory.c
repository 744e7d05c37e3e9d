// How much memory this machine has left for this process.
#include "device/machine_memory.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#define CONTROL_GROUP "/sys/fs/cgroup/"

// The number that stands behind `key` at the start of a line of a file. False if it is not there, or is no number ("max").
static bool read_number(const char *path, const char *key, uint64_t *value) {
    FILE *file = fopen(path, "r");
    if (!file) return false;
    char line[256];
    bool found = false;
    while (!found && fgets(line, sizeof line, file)) {
        found = !strncmp(line, key, strlen(key)) && sscanf(line + strlen(key), "%" SCNu64, value) == 1;
    }
    fclose(file);
    return found;
}

static uint64_t difference(uint64_t limit, uint64_t used) { return limit > used ? limit - used : 0; }

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }

static uint64_t control_group_free(void) {
    uint64_t limit, used;
    if (!read_number(CONTROL_GROUP "memory.max", "", &limit)) return UINT64_MAX;
    // The cache of files counts as used, but is given up first: only "anon" is really taken.
    return read_number(CONTROL_GROUP "memory.stat", "anon ", &used) ? difference(limit, used) : limit;
}

static uint64_t address_space_free(void) {
    struct rlimit limit;
    uint64_t used;
    if (getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
    return read_number("/proc/self/status", "VmSize:", &used) ? difference(limit.rlim_cur, used * 1024) : limit.rlim_cur;
}

uint64_t machine_memory_free(void) {
    uint64_t available, bytes = least(control_group_free(), address_space_free());
    if (read_number("/proc/meminfo", "MemAvailable:", &available)) bytes = least(bytes, available * 1024);
    return bytes == UINT64_MAX ? bytes : bytes - bytes / 16;
}
