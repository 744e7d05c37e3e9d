// gnomon devices: what Vulkan offers, and which device would be used, and why.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cache_dir.h"
#include "cli/command.h"

#define MOST_DEVICES 64

struct listing {
    struct gn_device_info *infos;
    uint32_t count;
    int selected; // index, or -1
};

static const struct gn_device_info *selected_info(const struct listing *listing) {
    for (uint32_t i = 0; i < listing->count; i++)
        if (listing->selected >= 0 && listing->infos[i].index == (uint32_t)listing->selected) return &listing->infos[i];
    return NULL;
}

static json_t *device_json(const struct gn_device_info *info) {
    const struct json_member members[] = {
        {"index", json_integer(info->index)},   {"name", json_words(info->name)},
        {"type", json_words(info->type)},       {"driver", json_words(info->driver)},
        {"api", json_words(info->api)},         {"uuid", json_words(info->uuid)},
        {"usable", json_boolean(info->usable)}, {"reason", info->usable ? json_null() : json_words(info->reason)},
        {"fp64", json_boolean(info->has_fp64)}, {"int64", json_boolean(info->has_int64)},
    };
    return JSON_MEMBERS(members);
}

static json_t *as_json(const struct listing *listing) {
    json_t *devices = json_array();
    for (uint32_t i = 0; i < listing->count; i++) json_array_append_new(devices, device_json(&listing->infos[i]));
    const struct json_member members[] = {
        {"devices", devices},
        {"selected", listing->selected >= 0 ? json_integer(listing->selected) : json_null()},
    };
    return JSON_MEMBERS(members);
}

// Why this device is the one.
static void print_choice(const struct run *run, const struct listing *listing) {
    const struct gn_device_info *info = selected_info(listing);
    if (!info) return;
    printf("\nUsed: %" PRIu32 ", ", info->index);
    if (run->settings.device)
        printf("chosen by %s %s.\n", run->device_from_environment ? "GNOMON_DEVICE" : "--device", run->settings.device);
    else if (strcmp(info->type, "cpu") == 0)
        printf("in software: there is no usable GPU. --device or GNOMON_DEVICE choose another.\n");
    else
        printf("a GPU. --device or GNOMON_DEVICE choose another, e.g. --device cpu.\n");
}

static void print(const struct run *run, const struct listing *listing) {
    int name = 4, driver = 6;
    for (uint32_t i = 0; i < listing->count; i++) {
        int a = (int)strlen(listing->infos[i].name), b = (int)strlen(listing->infos[i].driver);
        name = a > name ? a : name, driver = b > driver ? b : driver;
    }
    printf("  INDEX TYPE       %-*s  %-*s  %-9s UUID\n", name, "NAME", driver, "DRIVER", "VULKAN");
    for (uint32_t i = 0; i < listing->count; i++) {
        const struct gn_device_info *info = &listing->infos[i];
        printf("%c %5" PRIu32 " %-10s %-*s  %-*s  %-9s %s\n", info == selected_info(listing) ? '*' : ' ', info->index, info->type, name,
               info->name, driver, info->driver, info->api, info->uuid);
        if (!info->usable) printf("        cannot be used: %s\n", info->reason);
    }
    print_choice(run, listing);
}

static bool list(struct run *run, struct listing *listing) {
    const struct gn_device_params params = {.select = run->settings.device, .validate = run->settings.validate, .host = &run->host};
    if (!gn_device_list(&params, listing->infos, MOST_DEVICES, &listing->count, &listing->selected, &run->error)) return false;
    if (listing->count == 0)
        return run_fail(run, GN_NO_DEVICE, "there is no Vulkan driver; on Debian and Ubuntu: apt install mesa-vulkan-drivers");
    if (!run->settings.json)
        print(run, listing);
    else if (!run_result(run, as_json(listing)))
        return false;
    if (listing->selected >= 0) return true;
    if (run->settings.device) return run_fail(run, GN_NO_DEVICE, "'%s' is none of these devices", run->settings.device);
    return run_fail(run, GN_NO_DEVICE, "none of these devices can be used");
}

bool command_devices(struct run *run) {
    struct context ctx = run_context(run);
    struct listing listing = {.infos = array_alloc(&ctx, MOST_DEVICES, sizeof *listing.infos, "the list of devices")};
    if (!listing.infos) return false;
    cache_dir_choose();
    bool done = list(run, &listing);
    free(listing.infos);
    return done;
}
