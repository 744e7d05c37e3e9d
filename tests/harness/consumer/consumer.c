// A program of somebody who installed gnomon: its own `fail` and `progress` must not meet the library's.
#include <stdio.h>

#include <gnomon.h>

static int failures;
void fail(const char *what);
void fail(const char *what) { failures += fprintf(stderr, "%s\n", what) > 0; }

int main(void) {
    struct gn_device_info infos[16];
    struct gn_error error;
    uint32_t count = 0;
    int selected = -1;
    if (!gn_device_list(NULL, infos, 16, &count, &selected, &error)) fail(error.message);
    struct gn_scene *scene = gn_scene_load("no such scene.json", NULL, &error);
    if (scene || error.status == GN_OK) fail("a scene that is not there was loaded");
    printf("gnomon %s, %u devices\n", gn_version(), count);
    return failures != 0;
}
