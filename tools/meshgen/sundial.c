// The parts of scenes/demo.json: a horizontal sundial for 50° north on a tea table.
//
// On a horizontal dial the style, the edge that casts the shadow, rises northward at the latitude φ from the foot where all hour lines
// meet. The line of the hour angle H leaves the foot in the direction (east, north) = (sin φ · sin H, cos H) (Waugh, "Sundials", 1973, ch.
// 5). The dial's centre is the origin, its face is y = 0, east is +x and north −z; its radius is 1.
#include "shapes.h"

#include "solids.h"

#define LATITUDE (50.0 / 360) // turns
#define FOOT_NORTH (-0.3)     // the foot lies south of the dial's centre
#define INK 0.006             // how far marks rise above the face
#define LAYER 0.0004          // where marks overlap one is this much higher, so that no two faces coincide

static bool write_part(struct mesh *mesh, const struct shape_params *params) {
    struct ply_params ply = ply_params_for(params);
    return mesh_write(mesh, &ply);
}

bool shape_dial(const struct shape_params *params) {
    static const struct corner profile[] = {
        {0, 0, 0},           {1, 0, 0.03},        {1, -0.1, 0.03},      {0.93, -0.115, 0.012}, {0.9, -0.17, 0.045},
        {0.96, -0.2, 0.025}, {0.96, -0.27, 0.03}, {0.9, -0.275, 0.005}, {0.9, -0.29, 0},       {0, -0.29, 0},
    };
    struct mesh mesh = {0};
    add_lathe(&mesh, profile, sizeof profile / sizeof *profile, false, params->n);
    return write_part(&mesh, params);
}

// ------------------------------------------------------------------------------------------------------------ hour marks

// A place on the dial to write at: where, and which way the letters' right and top are.
struct place {
    struct v2 origin, right, up;
};

static struct v2 at_place(const struct place *place, double x, double y) {
    return v2_mad(v2_mad(place->origin, x, place->right), y, place->up);
}

static struct place place_towards(struct v2 origin, struct v2 up) { return (struct place){origin, {up.y, -up.x}, up}; }

// A stroke from (x0, y0) to (x1, y1) whose ends are level, `width` wide.
static void add_stroke(struct mesh *mesh, const struct place *place, double x0, double y0, double x1, double y1, double width, double top) {
    double half = width / 2;
    const struct v2 polygon[4] = {at_place(place, x0 - half, y0), at_place(place, x0 + half, y0), at_place(place, x1 + half, y1),
                                  at_place(place, x1 - half, y1)};
    add_prism(mesh, polygon, 4, -INK, top);
}

#define LETTER_HEIGHT 0.115
#define THICK 0.024
#define THIN 0.011
#define SERIF 0.009

static double digit_width(char digit) { return digit == 'I' ? 0.046 : digit == 'V' ? 0.096 : 0.1; }

// One Roman digit with its left edge at x.
static void add_digit(struct mesh *mesh, const struct place *place, char digit, double x) {
    double width = digit_width(digit);
    double left = x + 0.018, right = x + width - 0.018, middle = x + width / 2;
    const double low = 0.003, high = LETTER_HEIGHT - 0.003; // within the serifs, whose ends they do not share
    if (digit == 'I') add_stroke(mesh, place, middle, low, middle, high, THICK, INK);
    if (digit == 'V') {
        add_stroke(mesh, place, middle, 0, left, high, THICK, INK);
        add_stroke(mesh, place, middle + 0.004, low, right, high - low, THIN, INK - LAYER);
    }
    if (digit == 'X') {
        add_stroke(mesh, place, right, low, left, high, THICK, INK);
        add_stroke(mesh, place, left, 2 * low, right, high - low, THIN, INK - LAYER);
    }
    for (int end = digit == 'V'; end < 2; end++) {
        double y = end ? LETTER_HEIGHT - SERIF : 0;
        const struct v2 serif[4] = {at_place(place, x + 0.002, y), at_place(place, x + width - 0.002, y),
                                    at_place(place, x + width - 0.002, y + SERIF), at_place(place, x + 0.002, y + SERIF)};
        add_prism(mesh, serif, 4, -INK, INK + LAYER);
    }
}

static void add_numeral(struct mesh *mesh, struct place place, const char *numeral) {
    double width = 0, x = 0;
    for (const char *digit = numeral; *digit; digit++) width += digit_width(*digit);
    for (const char *digit = numeral; *digit; digit++) {
        add_digit(mesh, &place, *digit, x - width / 2);
        x += digit_width(*digit);
    }
}

static struct v2 hour_direction(double hours_after_noon) {
    struct v2 hour = circle(hours_after_noon / 24);
    return v2_unit(v2(circle(LATITUDE).y * hour.y, hour.x));
}

// Where the line of an hour meets the circle of a radius around the dial's centre.
static struct v2 on_hour_line(double hours_after_noon, double radius) {
    struct v2 foot = {0, FOOT_NORTH}, d = hour_direction(hours_after_noon);
    double b = v2_dot(foot, d), c = v2_dot(foot, foot) - radius * radius;
    return v2_mad(foot, -b + sqrt(b * b - c), d);
}

// A bar along the line of an hour.
static void add_tick(struct mesh *mesh, double hour, struct v2 from, struct v2 to) {
    const double half = 0.004;
    struct v2 side = v2_left(hour_direction(hour));
    const struct v2 polygon[4] = {v2_mad(from, half, side), v2_mad(from, -half, side), v2_mad(to, -half, side), v2_mad(to, half, side)};
    add_prism(mesh, polygon, 4, -INK, INK);
}

static void add_circle(struct mesh *mesh, double inner, double outer, unsigned segments) {
    const struct corner section[4] = {{inner, INK + LAYER, 0}, {outer, INK + LAYER, 0}, {outer, -INK, 0}, {inner, -INK, 0}};
    add_lathe(mesh, section, 4, true, segments);
}

bool shape_dial_marks(const struct shape_params *params) {
    static const char *numerals[] = {"V", "VI", "VII", "VIII", "IX", "X", "XI", "XII", "I", "II", "III", "IIII", "V", "VI", "VII"};
    struct mesh mesh = {0};
    for (int k = 0; k < 15; k++) {
        struct v2 base = on_hour_line(k - 7, 0.755);
        add_numeral(&mesh, place_towards(base, v2_unit(base)), numerals[k]);
        add_tick(&mesh, k - 7, v2_mad(v2(0, FOOT_NORTH), 0.17, hour_direction(k - 7)), on_hour_line(k - 7, 0.724));
    }
    for (int quarter = -28; quarter <= 28; quarter++) {
        double hour = quarter / 4.0;
        if (quarter % 4) add_tick(&mesh, hour, on_hour_line(hour, quarter % 2 ? 0.69 : 0.67), on_hour_line(hour, 0.724));
    }
    add_circle(&mesh, 0.648, 0.656, params->n);
    add_circle(&mesh, 0.72, 0.728, params->n);
    add_circle(&mesh, 0.905, 0.92, params->n);
    return write_part(&mesh, params);
}

// ---------------------------------------------------------------------------------------------------------------- gnomon

#define STYLE_LENGTH 1.06
#define PLATE 0.034   // thickness
#define SIDE_STEPS 24 // points on each of the three sides

// The outline, north to the right: foot, along the base, up the hollow back to the tip, down the style. Moved inward by `inset` in a way
// that keeps its points in step.
static unsigned gnomon_outline(struct v2 *points, double inset) {
    struct v2 style = circle(LATITUDE);
    struct v2 foot = v2(2.6 * inset, inset), heel = v2(0.62 - 1.1 * inset, inset);
    struct v2 tip = v2_mad(v2(style.x * STYLE_LENGTH, style.y * STYLE_LENGTH), -4.2 * inset, v2(0.72, 1.12));
    const struct v2 back[4] = {heel, v2(heel.x - 0.12, 0.22), v2(heel.x + 0.12, 0.42), tip};
    unsigned count = 0;
    for (int k = 0; k < SIDE_STEPS; k++) points[count++] = v2_mad(foot, (double)k / SIDE_STEPS, v2_sub(heel, foot));
    for (int k = 0; k < SIDE_STEPS; k++) points[count++] = bezier2(back, (double)k / SIDE_STEPS).point;
    for (int k = 0; k < SIDE_STEPS; k++) points[count++] = v2_mad(tip, (double)k / SIDE_STEPS, v2_sub(foot, tip));
    return count;
}

// The scroll that fills the opening: an S of two spirals, each the other turned by half a turn about the middle.
static void add_scroll(struct mesh *mesh) {
    enum { STEPS = 80 };
    const struct v2 middle = {0.44, 0.2}, lean = circle(LATITUDE);
    const double size = 0.085, turns = 1.3;
    struct v2 points[STEPS + 1];
    double radius[STEPS + 1];
    for (int k = 0; k <= STEPS; k++) {
        double s = 2.0 * k / STEPS - 1, reach = fabs(s), side = s < 0 ? -1 : 1;
        struct v2 turn = circle(turns * reach), arm = {lean.x * turn.x - lean.y * turn.y, lean.x * turn.y + lean.y * turn.x};
        points[k] = v2_mad(v2_mad(middle, side * size, lean), -side * size * (1 - 0.75 * reach), arm);
        radius[k] = 0.014 - 0.006 * reach;
    }
    add_bar(mesh, points, radius, STEPS + 1, 8);
}

// From the plane of the plate (north, up) to the dial.
static void stand_on_dial(struct mesh *mesh) {
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct vertex *v = mesh->vertices + i;
        v->position = v3(v->position.z, v->position.y, -(v->position.x + FOOT_NORTH));
        v->normal = v3(v->normal.z, v->normal.y, -v->normal.x);
    }
}

bool shape_gnomon(const struct shape_params *params) {
    struct v2 outline[3 * SIDE_STEPS], hole[3 * SIDE_STEPS];
    struct mesh mesh = {0};
    unsigned count = gnomon_outline(outline, 0);
    gnomon_outline(hole, 0.05);
    add_plate(&mesh, outline, hole, count, PLATE, 0.006);
    add_scroll(&mesh);
    stand_on_dial(&mesh);
    return write_part(&mesh, params);
}

// ------------------------------------------------------------------------------------------------------------- tea table

bool shape_table(const struct shape_params *params) {
    static const struct corner profile[] = {
        {0, 0, 0}, {4, 0, 0.05}, {4, -0.1, 0.05}, {3.9, -0.13, 0.02}, {3.8, -0.28, 0.1}, {3.5, -0.34, 0}, {0, -0.34, 0},
    };
    struct mesh mesh = {0};
    add_lathe(&mesh, profile, sizeof profile / sizeof *profile, false, params->n);
    return write_part(&mesh, params);
}

bool shape_cup(const struct shape_params *params) {
    static const struct corner profile[] = {
        // inside, rim, outside, foot
        {0, 0.06, 0},       {0.2, 0.075, 0.14}, {0.36, 0.3, 0.3},     {0.43, 0.52, 0.004}, {0.455, 0.52, 0.004},
        {0.385, 0.29, 0.3}, {0.225, 0.05, 0.1}, {0.215, 0.03, 0.008}, {0.235, 0, 0.006},   {0, 0, 0},
    };
    static const struct v2 ear[4] = {{0.39, 0.44}, {0.72, 0.56}, {0.66, 0.16}, {0.33, 0.17}};
    enum { STEPS = 28 };
    struct v2 points[STEPS + 1];
    double radius[STEPS + 1];
    struct mesh mesh = {0};
    for (int k = 0; k <= STEPS; k++) {
        points[k] = bezier2(ear, (double)k / STEPS).point;
        radius[k] = 0.024 + 0.012 * fabs(2.0 * k / STEPS - 1);
    }
    add_lathe(&mesh, profile, sizeof profile / sizeof *profile, false, params->n);
    add_bar(&mesh, points, radius, STEPS + 1, 14);
    return write_part(&mesh, params);
}

bool shape_saucer(const struct shape_params *params) {
    static const struct corner profile[] = {
        {0, 0.03, 0},        {0.25, 0.03, 0.01}, {0.27, 0.045, 0.01}, {0.4, 0.055, 0.12}, {0.7, 0.12, 0.01},
        {0.705, 0.1, 0.008}, {0.42, 0.02, 0.12}, {0.33, 0, 0.01},     {0, 0, 0},
    };
    struct mesh mesh = {0};
    add_lathe(&mesh, profile, sizeof profile / sizeof *profile, false, params->n);
    return write_part(&mesh, params);
}

// A wall, y from −1 to 1 and sixteen times as wide, whose normals turn from one light to another on the way up: a plane that shades like
// an evening sky. Scale it evenly: a transform turns normals, too.
bool shape_backdrop(const struct shape_params *params) {
    const double half_width = 16;
    const struct v3 low = v3(-0.75, 0.15, 0.65), high = v3(0.8, 0.25, 0.55);
    struct mesh mesh = {0};
    for (unsigned k = 0; k <= params->n; k++) {
        double t = (double)k / params->n, y = 2 * t - 1;
        struct v3 normal = v3_unit(v3_add(v3_scale(low, 1 - t), v3_scale(high, t)));
        mesh_vertex(&mesh, v3(-half_width, y, 0), normal);
        mesh_vertex(&mesh, v3(half_width, y, 0), normal);
    }
    for (uint32_t k = 0; k < params->n; k++) mesh_quad(&mesh, 2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2);
    return write_part(&mesh, params);
}
