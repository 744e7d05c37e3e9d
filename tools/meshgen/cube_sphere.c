// Closed spheres on the lattice of a cube's surface: bumpy_sphere and shell.
//
// The points (x, y, z), 0 … n each, on the surface of a cube are numbered layer by layer: the whole bottom layer, the rims of the layers
// between, the whole top layer. So a vertex's number is a formula, every vertex is shared by all its triangles, and nothing has to be
// kept in memory: ten million triangles are written as fast as they are computed.
#include "shapes.h"

#include <stdlib.h>

#include "noise.h"

struct lattice {
    uint32_t n;
    double *tangent;
}; // tangent[i] = tan(π/4 · (2i/n − 1)): squares of more even size on the sphere

static uint32_t lattice_count(uint32_t n) { return 6 * n * n + 2; }

static uint32_t rim_number(uint32_t n, uint32_t x, uint32_t y) {
    if (y == 0) return x;
    if (x == n) return n + y;
    return y == n ? 3 * n - x : 4 * n - y;
}

static uint32_t lattice_number(uint32_t n, const uint32_t p[3]) {
    uint32_t square = (n + 1) * (n + 1);
    if (p[2] == 0) return p[1] * (n + 1) + p[0];
    if (p[2] < n) return square + (p[2] - 1) * 4 * n + rim_number(n, p[0], p[1]);
    return square + (n - 1) * 4 * n + p[1] * (n + 1) + p[0];
}

static bool lattice_init(struct lattice *lattice, uint32_t n) {
    lattice->n = n;
    lattice->tangent = malloc((n + 1) * sizeof *lattice->tangent);
    if (!lattice->tangent) fprintf(stderr, "gnomon_meshgen: out of memory\n");
    for (uint32_t i = 0; lattice->tangent && i <= n; i++) {
        struct v2 c = circle((2.0 * i / n - 1) / 8);
        lattice->tangent[i] = c.y / c.x;
    }
    return lattice->tangent != NULL;
}

static struct v3 lattice_direction(const struct lattice *lattice, uint32_t x, uint32_t y, uint32_t z) {
    return v3_unit(v3(lattice->tangent[x], lattice->tangent[y], lattice->tangent[z]));
}

// What a sphere looks like in one direction.
typedef struct vertex (*surface_fn)(struct v3 direction, const void *data);

static void put_layer(struct ply *ply, const struct lattice *lattice, uint32_t z, surface_fn surface, const void *data) {
    uint32_t n = lattice->n;
    bool whole = z == 0 || z == n;
    for (uint32_t y = 0; whole && y <= n; y++)
        for (uint32_t x = 0; x <= n; x++) {
            struct vertex v = surface(lattice_direction(lattice, x, y, z), data);
            ply_vertex(ply, v.position, v.normal);
        }
    for (uint32_t k = 0; !whole && k < 4 * n; k++) {
        uint32_t along = k % n, side = k / n;
        uint32_t x = side == 0 ? along : side == 1 ? n : side == 2 ? n - along : 0;
        uint32_t y = side == 0 ? 0 : side == 1 ? along : side == 2 ? n : n - along;
        struct vertex v = surface(lattice_direction(lattice, x, y, z), data);
        ply_vertex(ply, v.position, v.normal);
    }
}

static void put_vertices(struct ply *ply, const struct lattice *lattice, surface_fn surface, const void *data) {
    for (uint32_t z = 0; z <= lattice->n; z++) put_layer(ply, lattice, z, surface, data);
}

// The number of the lattice point at (i, j) of a face; axes u, v and the face's own follow each other in the order x y z x y.
static uint32_t face_point(uint32_t n, unsigned axis, uint32_t level, uint32_t i, uint32_t j) {
    uint32_t p[3];
    p[axis] = level;
    p[(axis + 1) % 3] = i;
    p[(axis + 2) % 3] = j;
    return lattice_number(n, p);
}

// All triangles of the lattice, vertex numbers from `first`; seen counter-clockwise from outside, or from inside if `inward`.
static void put_triangles(struct ply *ply, uint32_t n, uint32_t first, bool inward) {
    for (unsigned face = 0; face < 6; face++)
        for (uint32_t j = 0; j < n; j++)
            for (uint32_t i = 0; i < n; i++) {
                unsigned axis = face / 2;
                uint32_t level = face % 2 ? n : 0;
                uint32_t a = first + face_point(n, axis, level, i, j), b = first + face_point(n, axis, level, i + 1, j);
                uint32_t c = first + face_point(n, axis, level, i + 1, j + 1), d = first + face_point(n, axis, level, i, j + 1);
                bool turned = (level == 0) != inward;
                ply_triangle(ply, a, turned ? c : b, turned ? b : c);
                ply_triangle(ply, a, turned ? d : c, turned ? c : d);
            }
}

// A sphere of radius 1 with hills: radius r(d) = 1 + h·noise(f·d). Its surface is |x| − r(x/|x|) = 0, whose gradient gives the normal.
static struct vertex bumpy_surface(struct v3 d, const void *data) {
    const struct shape_params *params = data;
    const double frequency = 2.5, height = 0.22;
    unsigned octaves = noise_octaves(frequency * (PI / 2) / params->n, 8);
    struct noise noise = noise_fractal(v3_scale(d, frequency), octaves, 0.5, params->seed);
    double radius = 1 + height * noise.value;
    struct v3 slope = v3_scale(noise.gradient, height * frequency);
    struct v3 tangential = v3_mad(slope, -v3_dot(slope, d), d);
    return (struct vertex){v3_scale(d, radius), v3_unit(v3_mad(v3_scale(d, radius), -1, tangential))};
}

bool shape_bumpy_sphere(const struct shape_params *params) {
    struct lattice lattice;
    struct ply ply;
    struct ply_params header = ply_params_for(params);
    header.vertices = lattice_count(params->n);
    header.triangles = 12 * (uint64_t)params->n * params->n;
    if (!lattice_init(&lattice, params->n)) return false;
    bool done = ply_begin(&ply, &header);
    if (done) {
        put_vertices(&ply, &lattice, bumpy_surface, params);
        put_triangles(&ply, params->n, 0, false);
        done = ply_end(&ply);
    }
    free(lattice.tangent);
    return done;
}

static struct vertex outer_surface(struct v3 d, const void *data) { return (void)data, (struct vertex){d, d}; }

static struct vertex inner_surface(struct v3 d, const void *data) {
    return (struct vertex){v3_scale(d, 1 - *(const double *)data), v3_scale(d, -1)};
}

// A hollow ball whose wall is a 25 000th of its radius: what leaves one wall must not slip through the other.
bool shape_shell(const struct shape_params *params) {
    const double gap = 4e-5;
    struct lattice lattice;
    struct ply ply;
    struct ply_params header = ply_params_for(params);
    header.vertices = 2 * lattice_count(params->n);
    header.triangles = 24 * (uint64_t)params->n * params->n;
    if (!lattice_init(&lattice, params->n)) return false;
    bool done = ply_begin(&ply, &header);
    if (done) {
        put_vertices(&ply, &lattice, outer_surface, NULL);
        put_vertices(&ply, &lattice, inner_surface, &gap);
        put_triangles(&ply, params->n, 0, false);
        put_triangles(&ply, params->n, lattice_count(params->n), true);
        done = ply_end(&ply);
    }
    free(lattice.tangent);
    return done;
}
