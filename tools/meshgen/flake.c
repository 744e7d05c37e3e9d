// A sphere flake (Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 1987) as a scene: every sphere carries nine of a third
// of its size, six around its equator and three above. Depth 3 gives 1 + 9 + 81 + 729 = 820 spheres.
#include "shapes.h"

static const char head[] =
    "{\n"
    "  \"version\": 1,\n"
    "  \"camera\": {\"position\": [2.6, 2.5, 3.9], \"look_at\": [0, 0.06, 0], \"up\": [0, 1, 0], \"fov_y_deg\": 40},\n"
    "  \"film\": {\"width\": 448, \"height\": 448, \"spp\": 1, \"transfer\": \"srgb\"},\n"
    "  \"background\": [0.012, 0.016, 0.03],\n"
    "  \"ambient\": [0.09, 0.1, 0.14],\n"
    "  \"materials\": {\n"
    "    \"level0\": {\"ambient\": [0.86, 0.56, 0.22], \"diffuse\": [0.72, 0.42, 0.13], \"specular\": [0.6, 0.5, 0.3], \"shininess\": "
    "60},\n"
    "    \"level1\": {\"ambient\": [0.78, 0.33, 0.2], \"diffuse\": [0.66, 0.22, 0.11], \"specular\": [0.5, 0.4, 0.35], \"shininess\": "
    "50},\n"
    "    \"level2\": {\"ambient\": [0.5, 0.25, 0.42], \"diffuse\": [0.42, 0.14, 0.32], \"specular\": [0.45, 0.4, 0.5], \"shininess\": "
    "40},\n"
    "    \"level3\": {\"ambient\": [0.25, 0.35, 0.6], \"diffuse\": [0.13, 0.24, 0.52], \"specular\": [0.4, 0.45, 0.5], \"shininess\": "
    "30},\n"
    "    \"floor\": {\"ambient\": [0.34, 0.36, 0.42], \"diffuse\": [0.3, 0.31, 0.36], \"specular\": [0, 0, 0], \"shininess\": 1}\n"
    "  },\n"
    "  \"lights\": [\n"
    "    {\"type\": \"point\", \"position\": [-6, 9, 5], \"intensity\": [0.95, 0.87, 0.74], \"falloff\": \"none\"},\n"
    "    {\"type\": \"point\", \"position\": [8, 4, 2], \"intensity\": [0.16, 0.22, 0.36], \"falloff\": \"none\"}\n"
    "  ],\n"
    "  \"shapes\": [\n"
    "    {\"type\": \"triangle\", \"vertices\": [[-40, -1, -40], [-40, -1, 40], [40, -1, 40]], \"material\": \"floor\"},\n"
    "    {\"type\": \"triangle\", \"vertices\": [[-40, -1, -40], [40, -1, 40], [40, -1, -40]], \"material\": \"floor\"}";

// Where a sphere's children go: `axis` points away from the parent; the other two complete a right-handed frame.
struct flake_frame {
    struct v3 axis, side, front;
};

static void put_flake(FILE *file, struct v3 centre, double radius, struct flake_frame frame, unsigned level, unsigned depth) {
    fprintf(file, ",\n    {\"type\": \"sphere\", \"center\": [%.6f, %.6f, %.6f], \"radius\": %.6f, \"material\": \"level%u\"}", centre.x,
            centre.y, centre.z, radius, level < 3 ? level : 3);
    for (unsigned k = 0; level < depth && k < 9; k++) {
        struct v2 turn = circle(k < 6 ? k / 6.0 : (2 * k + 1) / 6.0 + 0.25), rise = circle(k < 6 ? 0.0 : 1 / 6.0);
        struct v3 level_part = v3_mad(v3_scale(frame.side, turn.x), turn.y, frame.front);
        struct v3 axis = v3_unit(v3_mad(v3_scale(level_part, rise.x), rise.y, frame.axis));
        struct v3 side = v3_unit(v3_cross(v3_mad(v3_scale(frame.front, turn.x), -turn.y, frame.side), axis));
        struct flake_frame child = {axis, side, v3_cross(axis, side)};
        put_flake(file, v3_mad(centre, radius * 4 / 3, axis), radius / 3, child, level + 1, depth);
    }
}

bool shape_flake(const struct shape_params *params) {
    struct output output;
    if (!output_open(&output, params->output)) return false;
    fputs(head, output.file);
    struct flake_frame upright = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    put_flake(output.file, params->offset, 1, upright, 0, params->n);
    fputs("\n  ]\n}\n", output.file);
    return output_close(&output, true);
}
