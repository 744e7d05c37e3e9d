// gnomon_meshgen: makes the meshes of scenes/, and large ones for benchmarks. The same arguments give the same bytes on every machine.
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"

struct shape {
    const char *name;
    bool (*make)(const struct shape_params *params);
    unsigned n, n_min, n_max;
    unsigned triangles_per_square; // triangles are this times n², so that --triangles can choose n; 0: they are not
    const char *help;
};

static const struct shape shapes[] = {
    {"teapot", shape_teapot, 10, 1, 500, 64, "Newell's teapot; n segments along a patch's edge"},
    {"terrain", shape_terrain, 64, 1, 10000, 2, "mountains over a plain; n × n squares"},
    {"bumpy_sphere", shape_bumpy_sphere, 20, 1, 4000, 12, "a closed sphere with hills; six faces of n × n squares"},
    {"shell", shape_shell, 12, 1, 4000, 24, "a hollow ball with a wall of 4e-5; twice six faces of n × n squares"},
    {"torus_knot", shape_torus_knot, 16, 3, 1000, 24, "a closed trefoil; n segments around the tube, 12·n along it"},
    {"needles", shape_needles, 160, 1, 5000000, 0, "n triangles 100 times as long as wide"},
    {"fan", shape_fan, 64, 3, 5000000, 0, "n triangles around one vertex"},
    {"flake", shape_flake, 3, 0, 6, 0, "a scene (JSON) of (9^(n+1) - 1) / 8 spheres"},
    {"dial", shape_dial, 96, 3, 10000, 0, "sundial: the plate; n segments around, as in all that follow"},
    {"dial_marks", shape_dial_marks, 96, 3, 10000, 0, "sundial: hour lines and numerals for 50 degrees north"},
    {"gnomon", shape_gnomon, 1, 1, 1, 0, "sundial: the part that casts the shadow"},
    {"table", shape_table, 96, 3, 10000, 0, "a round table top"},
    {"cup", shape_cup, 48, 3, 10000, 0, "a tea cup"},
    {"saucer", shape_saucer, 64, 3, 10000, 0, "its saucer"},
    {"backdrop", shape_backdrop, 16, 1, 10000, 0, "a wall that shades like a sky; n rows"},
};
#define SHAPE_COUNT (sizeof shapes / sizeof *shapes)

struct ply_params ply_params_for(const struct shape_params *params) {
    return (struct ply_params){.path = params->output, .normals = params->normals, .offset = params->offset};
}

static void print_help(FILE *to) {
    fputs("gnomon_meshgen SHAPE [-n N | --triangles T] -o FILE [--seed S] [--offset X,Y,Z] [--no-normals]\n"
          "Writes a binary PLY (flake: a JSON scene).\n\n"
          "  -n N              fineness; what it counts depends on the shape\n"
          "  --triangles T     the smallest N that gives at least T triangles\n"
          "  -o, --output FILE where to write\n"
          "  --seed S          of the noise [1]\n"
          "  --offset X,Y,Z    moves the shape away from the origin [0,0,0]\n"
          "  --no-normals      leaves vertex normals out\n\nshapes, with the N that they take when none is given:\n",
          to);
    for (size_t i = 0; i < SHAPE_COUNT; i++) fprintf(to, "  %-13s %5u  %s\n", shapes[i].name, shapes[i].n, shapes[i].help);
}

static bool complain(const char *what, const char *which) {
    fprintf(stderr, "gnomon_meshgen: %s '%s'; --help tells more\n", what, which);
    return false;
}

static bool parse_count(const char *text, unsigned long long low, unsigned long long high, unsigned long long *out) {
    char *end;
    errno = 0;
    if (!isdigit((unsigned char)*text)) return false;
    *out = strtoull(text, &end, 10);
    return !*end && errno == 0 && *out >= low && *out <= high;
}

static bool parse_offset(const char *text, struct v3 *out) {
    double value[3];
    for (int k = 0; k < 3; k++) {
        char *end;
        value[k] = strtod(text, &end);
        if (end == text || !isfinite(value[k]) || *end != (k < 2 ? ',' : '\0')) return false;
        text = end + 1;
    }
    *out = v3(value[0], value[1], value[2]);
    return true;
}

static bool choose_n(const struct shape *shape, unsigned long long triangles, unsigned *n) {
    if (!shape->triangles_per_square) return complain("--triangles does not go with", shape->name);
    unsigned long long chosen = shape->n_min;
    while (chosen <= shape->n_max && shape->triangles_per_square * chosen * chosen < triangles) chosen++;
    *n = (unsigned)chosen;
    return chosen <= shape->n_max || complain("too many triangles for", shape->name);
}

// One option and its value. False, with a message, if either is wrong.
static bool parse_option(const struct shape *shape, const char *option, const char *value, struct shape_params *params) {
    unsigned long long number;
    if (!value) return complain("a value is missing after", option);
    if (!strcmp(option, "-o") || !strcmp(option, "--output")) {
        params->output = value;
    } else if (!strcmp(option, "-n")) {
        if (!parse_count(value, shape->n_min, shape->n_max, &number)) {
            fprintf(stderr, "gnomon_meshgen: -n of %s is a whole number from %u to %u, not '%s'\n", shape->name, shape->n_min, shape->n_max,
                    value);
            return false;
        }
        params->n = (unsigned)number;
    } else if (!strcmp(option, "--triangles")) {
        if (!parse_count(value, 1, 1000000000ull, &number))
            return complain("--triangles takes a whole number up to 1000000000, not", value);
        return choose_n(shape, number, &params->n);
    } else if (!strcmp(option, "--seed")) {
        if (!parse_count(value, 0, UINT32_MAX, &number)) return complain("--seed takes a whole number below 2^32, not", value);
        params->seed = (uint32_t)number;
    } else if (!strcmp(option, "--offset")) {
        if (!parse_offset(value, &params->offset)) return complain("--offset takes three numbers like 1000,0,0, not", value);
    } else {
        return complain("unknown option", option);
    }
    return true;
}

static bool parse_arguments(int count, char **arguments, const struct shape *shape, struct shape_params *params) {
    for (int i = 2; i < count; i++) {
        if (!strcmp(arguments[i], "--no-normals")) {
            params->normals = false;
            continue;
        }
        if (!parse_option(shape, arguments[i], i + 1 < count ? arguments[i + 1] : NULL, params)) return false;
        i++;
    }
    return params->output || complain("no output (-o FILE) for", shape->name);
}

static const struct shape *find_shape(const char *name) {
    for (size_t i = 0; i < SHAPE_COUNT; i++)
        if (!strcmp(shapes[i].name, name)) return shapes + i;
    complain("unknown shape", name);
    return NULL;
}

// Exit codes as gnomon's: 2 wrong usage, 8 input or output failed.
int main(int count, char **arguments) {
    for (int i = 1; i < count; i++)
        if (!strcmp(arguments[i], "--help") || !strcmp(arguments[i], "-h")) {
            print_help(stdout);
            return 0;
        }
    if (count < 2) {
        print_help(stderr);
        return 2;
    }
    const struct shape *shape = find_shape(arguments[1]);
    if (!shape) return 2;
    struct shape_params params = {.n = shape->n, .seed = 1, .normals = true};
    if (!parse_arguments(count, arguments, shape, &params)) return 2;
    return shape->make(&params) ? 0 : 8;
}
