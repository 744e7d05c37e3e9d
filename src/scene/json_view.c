// What a scene file says of the way it is seen: camera, film, paths.
#include <math.h>
#include <string.h>

#include "scene/json_parts.h"

// ------------------------------------------------------------------------------------------------------------------- camera

static bool same3(const float a[3], const float b[3]) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// The vector across the view and up; false when `up` is along the view, as far as fp64 can tell (render/camera.c).
static bool across_view(double out[3], const float position[3], const float look_at[3], const float up[3]) {
    double view[3], upward[3];
    for (int i = 0; i < 3; i++) view[i] = (double)look_at[i] - position[i], upward[i] = up[i];
    cross(out, view, upward);
    return dot(out, out) > 1e-24 * dot(view, view) * dot(upward, upward);
}

// The vector across moves in a straight line from one end to the other: does it stay clear of 0?
static bool stays_across(const double a[3], const double b[3]) {
    double area[3];
    cross(area, a, b);
    return dot(a, b) > 0 || dot(area, area) > 1e-24 * dot(a, a) * dot(b, b);
}

static bool read_camera_motion(struct scene_camera *out, const struct json_at *camera) {
    static const char *const keys[] = {"position", "look_at", NULL};
    struct json_at at;
    double first[3], last[3];
    memcpy(out->position_end, out->position, sizeof out->position);
    memcpy(out->look_at_end, out->look_at, sizeof out->look_at);
    if (!at_member(&at, camera, "motion")) return true;
    if (!at_object(&at, keys) || !at_get_float3(&at, "position", RANGE_ANY, out->position_end) ||
        !at_get_float3(&at, "look_at", RANGE_ANY, out->look_at_end))
        return false;
    if (same3(out->position_end, out->look_at_end))
        return at_fail(&at, "takes the camera to what it looks at, expected a point to look at elsewhere");
    out->moves = !same3(out->position, out->position_end) || !same3(out->look_at, out->look_at_end);
    if (!out->moves) return true;
    if (across_view(first, out->position, out->look_at, out->up) && across_view(last, out->position_end, out->look_at_end, out->up) &&
        stays_across(first, last))
        return true;
    return at_fail(&at, "takes the view along 'up', expected a motion on which it stays across");
}

static bool read_lens(struct scene_camera *out, const struct json_at *at) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += ((double)out->look_at[i] - out->position[i]) * ((double)out->look_at[i] - out->position[i]);
    out->focus_distance = (float)fmin(sqrt(square), 3e38);
    return at_get_float(at, "lens_radius", RANGE_NOT_NEGATIVE, &out->lens_radius) &&
           at_get_float(at, "focus_distance", RANGE_POSITIVE, &out->focus_distance);
}

static bool read_camera(struct scene_camera *out, const struct json_at *at) {
    static const char *const keys[] = {"position", "look_at", "up", "fov_y_deg", "lens_radius", "focus_distance", "motion", NULL};
    static const float zero[3] = {0};
    double across[3];
    *out = (struct scene_camera){.up = {0, 1, 0}, .look_at = {0, 0, -1}, .fov_y_deg = 40};
    if (!at_object(at, keys) || !at_require(at, "position", "3 numbers") || !at_require(at, "look_at", "3 numbers")) return false;
    if (!at_get_float3(at, "position", RANGE_ANY, out->position) || !at_get_float3(at, "look_at", RANGE_ANY, out->look_at) ||
        !at_get_float3(at, "up", RANGE_ANY, out->up) || !at_get_float(at, "fov_y_deg", RANGE_FIELD_OF_VIEW, &out->fov_y_deg))
        return false;
    struct json_at member;
    if (same3(out->position, out->look_at) && at_member(&member, at, "look_at"))
        return at_fail(&member, "is the camera's position, expected a point to look at elsewhere");
    if (same3(out->up, zero) && at_member(&member, at, "up")) return at_fail(&member, "is zero, expected a direction such as [0,1,0]");
    if (at_member(&member, at, "up") && !across_view(across, out->position, out->look_at, out->up))
        return at_fail(&member, "is along the view, expected a direction across it");
    return read_lens(out, at) && read_camera_motion(out, at);
}

bool part_camera(struct scene_camera *out, const struct json_at *root, bool *found) {
    struct json_at at;
    *found = at_member(&at, root, "camera");
    return !*found || read_camera(out, &at);
}

// --------------------------------------------------------------------------------------------------------------------- film

// "tent", or {"type": "tent", "radius": 1}.
static bool read_filter(struct scene_film *out, const struct json_at *film) {
    static const char *const keys[] = {"type", "radius", NULL};
    static const char *const types[] = {
        [FILTER_BOX] = "box", [FILTER_TENT] = "tent", [FILTER_GAUSSIAN] = "gaussian", [FILTER_BLACKMAN_HARRIS] = "blackman_harris", NULL};
    static const float radii[] = {[FILTER_BOX] = 0.5f, [FILTER_TENT] = 1, [FILTER_GAUSSIAN] = 1.5f, [FILTER_BLACKMAN_HARRIS] = 1.5f};
    struct json_at at;
    int type = FILTER_BOX;
    if (!at_member(&at, film, "filter")) return true;
    const bool named = json_is_string(at.value);
    if (named ? !at_get_choice(film, "filter", types, &type)
              : !at_object(&at, keys) || !at_require(&at, "type", "the name of a filter") || !at_get_choice(&at, "type", types, &type))
        return false;
    out->filter = (enum film_filter)type;
    out->filter_radius = radii[type];
    return named || at_get_float(&at, "radius", RANGE_FILTER, &out->filter_radius);
}

bool part_film(struct scene_film *out, const struct json_at *root) {
    static const char *const keys[] = {"width", "height", "spp", "transfer", "filter", NULL};
    static const char *const transfers[] = {[TRANSFER_SRGB] = "srgb", [TRANSFER_LINEAR] = "linear", NULL};
    int transfer = out->transfer;
    struct json_at at;
    if (!at_member(&at, root, "film")) return true;
    if (!at_object(&at, keys) || !at_get_count(&at, "width", 1, 65535, &out->width) ||
        !at_get_count(&at, "height", 1, 65535, &out->height) || !at_get_count(&at, "spp", 1, 16777216, &out->spp) ||
        !at_get_choice(&at, "transfer", transfers, &transfer))
        return false;
    out->transfer = (enum transfer)transfer;
    return read_filter(out, &at);
}

// -------------------------------------------------------------------------------------------------------------------- paths

bool part_paths(struct scene_paths *out, const struct json_at *root) {
    static const char *const keys[] = {"max_depth", "indirect", "roulette_depth", NULL};
    struct json_at at;
    if (!at_member(&at, root, "paths")) return true;
    return at_object(&at, keys) && at_get_count(&at, "max_depth", 0, 1000, &out->max_depth) &&
           at_get_bool(&at, "indirect", &out->indirect) && at_get_count(&at, "roulette_depth", 0, 1000, &out->roulette_depth);
}
