// gnomon compare: how two picture files differ.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "cli/command.h"

// Whether `value` keeps to `limit`; a negative limit was not given. What is not a number keeps to none.
static bool keeps(double value, double limit) { return limit < 0 || value <= limit; }

static json_t *as_json(const struct gn_compare_result *result, bool pass) {
    const struct json_member members[] = {
        {"pass", json_boolean(pass)},
        {"width", json_integer(result->width)},
        {"height", json_integer(result->height)},
        {"max_abs", json_number(result->max_abs)},
        {"rmse", json_number(result->rmse)},
        {"psnr_db", json_number(result->psnr_db)},
        {"flip", json_number(result->flip)},
        {"pixels_differing", json_integer((json_int_t)result->pixels_differing)},
        {"nonfinite_pixels", json_integer((json_int_t)result->nonfinite_pixels)},
        {"worst_x", json_integer(result->worst_x)},
        {"worst_y", json_integer(result->worst_y)},
    };
    return JSON_MEMBERS(members);
}

static void print(const struct gn_compare_result *result) {
    printf("pixels      %" PRIu32 " × %" PRIu32 ", %" PRIu64 " of them differ\n", result->width, result->height, result->pixels_differing);
    if (result->nonfinite_pixels) printf("not finite  %" PRIu64 " pixels\n", result->nonfinite_pixels);
    printf("max         %.6g at (%" PRIu32 ", %" PRIu32 ")\n", result->max_abs, result->worst_x, result->worst_y);
    printf("RMSE        %.6g\n", result->rmse);
    if (isinf(result->psnr_db))
        printf("PSNR        infinite\n");
    else
        printf("PSNR        %.2f dB\n", result->psnr_db);
    printf("FLIP        %.6f\n", result->flip);
}

bool command_compare(struct run *run) {
    const struct settings *settings = &run->settings;
    if (settings->output && !run_check_output(run, settings->output, PICTURE_SUFFIXES)) return false;
    struct gn_compare_result result;
    struct gn_picture *heat = NULL;
    bool done = gn_compare(settings->positionals[0], settings->positionals[1], &result, settings->output ? &heat : NULL, &run->error) &&
                (!heat || run_save(run, heat, settings->output));
    gn_picture_destroy(heat);
    if (!done) return false;
    bool pass = keeps(result.max_abs, settings->max_abs) && keeps(result.flip, settings->max_flip);
    if (!settings->json)
        print(&result);
    else if (!run_result(run, as_json(&result, pass)))
        return false;
    return pass ||
           run_fail(run, GN_CHECK_FAILED, "the pictures differ by more than allowed: max %.3g, FLIP %.3g", result.max_abs, result.flip);
}
