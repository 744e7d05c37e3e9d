// render --max-error and --max-time: the setting is picked before the picture is rendered, and the picture checked afterwards.
#ifndef CLI_PICK_H
#define CLI_PICK_H

#include "cli/command.h"

struct picking {
    bool wanted;
    struct gn_pick_params params;
    struct gn_pick pick;
    double measured_error;
    uint64_t checked_pixels;
    double seconds; // since the program began, when the picture was there
};

// Picks, if the settings ask for it, and puts what was picked into *render.
bool picking_start(struct picking *out, struct run *run, struct gn_device *device, struct gn_scene *scene, struct gn_render_params *render);

// Measures the error of the picture.
bool picking_check(struct picking *picking, struct run *run, struct gn_scene *scene, const struct gn_picture *picture);

// Adds what came of it to the result, where there is one.
bool picking_add_json(const struct picking *picking, json_t *result);

// Says whether what was asked for was met; GN_CHECK_FAILED and false if not.
bool picking_judge(const struct picking *picking, struct run *run);

#endif
