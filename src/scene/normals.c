// Vertex normals where a file has none.
//
// Around each distinct position stands a ring of faces. Faces that share an edge there and meet by less than the crease angle are joined;
// each group of joined faces becomes one vertex. Its normal is the sum of the faces' unit normals, each weighted by the angle that the face
// has at the vertex (G. Thürmer and C. A. Wüthrich, "Computing vertex normals from polygonal facets", 1998): how a flat region is cut into
// triangles then changes nothing. Rings are independent: all cores work on them, and the result does not depend on how many.
#include "scene/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "scene/unique.h"

static const double PI = 3.14159265358979323846;

// One face seen from the vertex in its middle.
struct spoke {
    double normal[3]; // unit; 0 for a degenerate face
    double angle;     // radians
    uint32_t parent;  // union-find over the ring
    uint32_t group;   // number within the ring
};

// One edge of a face of the ring that ends at the middle.
struct rim {
    uint32_t vertex, spoke;
};

struct smoothing {
    const struct scene_mesh *mesh;
    const uint32_t *number; // of each vertex's distinct position
    uint32_t ring_count;    // distinct positions
    uint32_t *ring_first;   // ring_count + 1; ring r has corners[ring_first[r] …]
    uint32_t *corners;      // 3 × triangle_count: 3 · triangle + corner, by ring, ascending
    uint32_t *groups;       // for each entry of corners its group within the ring
    uint32_t *vertex_first; // ring_count + 1: groups of the rings before
    struct scene_mesh out;  // what is being made
    double least_cosine;    // of two faces that are joined
    unsigned threads;
    struct scratch {
        struct spoke *spokes;
        struct rim *rims;
    } * scratch; // for each thread, as long as the longest ring needs
};

static void sub(double out[3], const float *a, const float *b) {
    for (int i = 0; i < 3; i++) out[i] = (double)a[i] - b[i];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static const float *corner_position(const struct scene_mesh *mesh, size_t triangle, unsigned corner) {
    return mesh->positions + 3 * (size_t)mesh->indices[3 * triangle + corner % 3];
}

static struct spoke spoke_make(const struct scene_mesh *mesh, uint32_t corner, uint32_t self) {
    struct spoke spoke = {.parent = self};
    const size_t triangle = corner / 3;
    const unsigned k = corner % 3;
    double a[3], b[3];
    sub(a, corner_position(mesh, triangle, k + 1), corner_position(mesh, triangle, k));
    sub(b, corner_position(mesh, triangle, k + 2), corner_position(mesh, triangle, k));
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double length = sqrt(dot(n, n));
    if (!(length > 0)) return spoke;
    for (int i = 0; i < 3; i++) spoke.normal[i] = n[i] / length;
    spoke.angle = atan2(length, dot(a, b));
    return spoke;
}

static uint32_t root(struct spoke *spokes, uint32_t i) {
    while (spokes[i].parent != i) i = spokes[i].parent = spokes[spokes[i].parent].parent;
    return i;
}

// The root of a group is its first spoke.
static void join(struct spoke *spokes, uint32_t a, uint32_t b) {
    a = root(spokes, a), b = root(spokes, b);
    if (a < b)
        spokes[b].parent = a;
    else
        spokes[a].parent = b;
}

static int by_vertex(const void *a, const void *b) {
    const struct rim *x = a, *y = b;
    if (x->vertex != y->vertex) return x->vertex < y->vertex ? -1 : 1;
    return (x->spoke > y->spoke) - (x->spoke < y->spoke);
}

static void rims_sort(struct rim *rims, size_t count) {
    if (count > 32) {
        qsort(rims, count, sizeof *rims, by_vertex);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        struct rim rim = rims[i];
        size_t j = i;
        for (; j > 0 && by_vertex(&rims[j - 1], &rim) > 0; j--) rims[j] = rims[j - 1];
        rims[j] = rim;
    }
}

// Fills the spokes of ring r, joins them across smooth edges, and numbers the groups in order of their first spoke. Returns their number.
static uint32_t ring_group(const struct smoothing *s, const struct scratch *scratch, uint32_t r) {
    const struct scene_mesh *mesh = s->mesh;
    const uint32_t *corners = s->corners + s->ring_first[r];
    const uint32_t count = s->ring_first[r + 1] - s->ring_first[r];
    struct spoke *spokes = scratch->spokes;
    for (uint32_t i = 0; i < count; i++) {
        spokes[i] = spoke_make(mesh, corners[i], i);
        const uint32_t *face = mesh->indices + corners[i] / 3 * (size_t)3;
        scratch->rims[2 * i] = (struct rim){s->number[face[(corners[i] % 3 + 1) % 3]], i};
        scratch->rims[2 * i + 1] = (struct rim){s->number[face[(corners[i] % 3 + 2) % 3]], i};
    }
    rims_sort(scratch->rims, 2 * (size_t)count);
    for (size_t i = 1; i < 2 * (size_t)count; i++) {
        struct rim a = scratch->rims[i - 1], b = scratch->rims[i];
        if (a.vertex == b.vertex && dot(spokes[a.spoke].normal, spokes[b.spoke].normal) >= s->least_cosine) join(spokes, a.spoke, b.spoke);
    }
    uint32_t groups = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t first = root(spokes, i);
        spokes[i].group = first == i ? groups++ : spokes[first].group;
    }
    return groups;
}

static bool rings_group(void *data, size_t begin, size_t end, unsigned thread) {
    struct smoothing *s = data;
    const struct scratch *scratch = &s->scratch[thread];
    for (size_t r = begin; r < end; r++) {
        s->vertex_first[r + 1] = ring_group(s, scratch, (uint32_t)r);
        for (uint32_t i = s->ring_first[r]; i < s->ring_first[r + 1]; i++) s->groups[i] = scratch->spokes[i - s->ring_first[r]].group;
    }
    return true;
}

// Makes the vertices of each ring, one for each group, and turns groups into vertex numbers.
static bool rings_write(void *data, size_t begin, size_t end, unsigned thread) {
    struct smoothing *s = data;
    struct spoke *sums = s->scratch[thread].spokes;
    for (size_t r = begin; r < end; r++) {
        const size_t first = s->vertex_first[r], count = s->vertex_first[r + 1] - first;
        memset(sums, 0, count * sizeof *sums);
        for (uint32_t i = s->ring_first[r]; i < s->ring_first[r + 1]; i++) {
            const uint32_t corner = s->corners[i], group = s->groups[i];
            const struct spoke spoke = spoke_make(s->mesh, corner, 0);
            for (int k = 0; k < 3; k++) sums[group].normal[k] += spoke.angle * spoke.normal[k];
            memcpy(s->out.positions + 3 * (first + group), corner_position(s->mesh, corner / 3, corner % 3), 3 * sizeof(float));
            s->groups[i] = (uint32_t)first + group;
        }
        for (size_t group = 0; group < count; group++) {
            const double length = sqrt(dot(sums[group].normal, sums[group].normal));
            for (int k = 0; k < 3; k++) s->out.normals[3 * (first + group) + k] = length > 0 ? (float)(sums[group].normal[k] / length) : 0;
        }
    }
    return true;
}

// Counts and sorts the corners by ring. Rings are the distinct positions that the mesh uses.
static bool rings_make(struct smoothing *s, struct context *ctx, uint32_t *longest) {
    const size_t corner_count = 3 * (size_t)s->mesh->triangle_count;
    s->ring_first = array_alloc(ctx, (size_t)s->ring_count + 1, sizeof *s->ring_first, "rings of faces");
    s->corners = array_alloc(ctx, corner_count, sizeof *s->corners, "rings of faces");
    if (!s->ring_first || !s->corners) return false;
    for (size_t i = 0; i < corner_count; i++) s->ring_first[s->number[s->mesh->indices[i]]]++;
    uint32_t before = 0;
    *longest = 0;
    for (uint32_t r = 0; r <= s->ring_count; r++) {
        const uint32_t count = s->ring_first[r];
        if (count > *longest) *longest = count;
        s->ring_first[r] = before;
        before += count;
    }
    for (size_t i = 0; i < corner_count; i++) s->corners[s->ring_first[s->number[s->mesh->indices[i]]]++] = (uint32_t)i;
    for (uint32_t r = s->ring_count; r > 0; r--) s->ring_first[r] = s->ring_first[r - 1]; // each had moved to the next one's place
    s->ring_first[0] = 0;
    return true;
}

static bool scratch_make(struct smoothing *s, struct context *ctx, uint32_t longest) {
    s->threads = context_threads(ctx);
    s->scratch = array_alloc(ctx, s->threads, sizeof *s->scratch, "rings of faces");
    if (!s->scratch) return false;
    for (unsigned i = 0; i < s->threads; i++) {
        s->scratch[i].spokes = array_alloc(ctx, longest, sizeof(struct spoke), "a ring of faces");
        s->scratch[i].rims = array_alloc(ctx, longest, 2 * sizeof(struct rim), "a ring of faces");
        if (!s->scratch[i].spokes || !s->scratch[i].rims) return false;
    }
    return true;
}

static void smoothing_finish(struct smoothing *s) {
    for (unsigned i = 0; s->scratch && i < s->threads; i++) {
        free(s->scratch[i].spokes);
        free(s->scratch[i].rims);
    }
    free(s->scratch);
    free(s->ring_first);
    free(s->corners);
    free(s->groups);
    free(s->vertex_first);
    mesh_finish(&s->out);
}

static bool smooth(struct smoothing *s, struct context *ctx) {
    const size_t corner_count = 3 * (size_t)s->mesh->triangle_count;
    uint32_t longest;
    if (!rings_make(s, ctx, &longest) || !scratch_make(s, ctx, longest)) return false;
    s->groups = array_alloc(ctx, corner_count, sizeof *s->groups, "groups of faces");
    s->vertex_first = array_alloc(ctx, (size_t)s->ring_count + 1, sizeof *s->vertex_first, "groups of faces");
    if (!s->groups || !s->vertex_first) return false;
    if (!parallel_for_progress(ctx, "scene", s->ring_count, 4096, rings_group, s)) return false;
    for (uint32_t r = 0; r < s->ring_count; r++) s->vertex_first[r + 1] += s->vertex_first[r];
    if (!mesh_init(&s->out, ctx, s->vertex_first[s->ring_count], 0, true)) return false;
    return parallel_for_progress(ctx, "scene", s->ring_count, 4096, rings_write, s);
}

// Parts the new vertices by the texture coordinates that the old ones had: corner i has old vertex old[i] and new one mesh->indices[i].
static bool split_by_uvs(struct scene_mesh *mesh, struct context *ctx, const float *old_uvs, const uint32_t *old) {
    struct row {
        uint32_t vertex;
        float uv[2];
    };
    const uint32_t corner_count = 3 * mesh->triangle_count;
    struct row *rows = array_alloc(ctx, corner_count, sizeof *rows, "texture coordinates");
    uint32_t *number = array_alloc(ctx, corner_count, sizeof *number, "vertex numbers"), count;
    for (uint32_t i = 0; rows && i < corner_count; i++) {
        rows[i].vertex = mesh->indices[i];
        memcpy(rows[i].uv, old_uvs + 2 * (size_t)old[i], sizeof rows[i].uv);
    }
    struct scene_mesh split = {0};
    const bool done = rows && number && unique_rows(number, &count, ctx, rows, corner_count, 3) && mesh_init(&split, ctx, count, 0, true) &&
                      mesh_add_uvs(&split, ctx);
    for (uint32_t i = 0; done && i < corner_count; i++) {
        const size_t to = number[i], from = rows[i].vertex;
        memcpy(split.positions + 3 * to, mesh->positions + 3 * from, 3 * sizeof(float));
        memcpy(split.normals + 3 * to, mesh->normals + 3 * from, 3 * sizeof(float));
        memcpy(split.uvs + 2 * to, rows[i].uv, sizeof rows[i].uv);
        mesh->indices[i] = number[i];
    }
    if (done) {
        free(mesh->positions);
        free(mesh->normals);
        mesh->positions = split.positions, mesh->normals = split.normals, mesh->uvs = split.uvs, mesh->vertex_count = count;
        split.positions = split.normals = split.uvs = NULL;
    }
    mesh_finish(&split);
    free(number);
    free(rows);
    return done;
}

// A copy of the indices, if there are texture coordinates to be told apart by them.
static bool keep_indices(uint32_t **out, const struct scene_mesh *mesh, struct context *ctx) {
    *out = NULL;
    if (!mesh->uvs) return true;
    *out = array_alloc(ctx, mesh->triangle_count, 3 * sizeof **out, "vertex numbers");
    if (*out && mesh->triangle_count > 0) memcpy(*out, mesh->indices, 3 * sizeof **out * mesh->triangle_count);
    return *out != NULL;
}

bool mesh_smooth(struct scene_mesh *mesh, struct context *ctx, double crease_deg) {
    struct smoothing s = {.mesh = mesh, .least_cosine = cos(crease_deg * (PI / 180))};
    uint32_t *number = array_alloc(ctx, mesh->vertex_count, sizeof *number, "vertex numbers"), *old;
    bool done = keep_indices(&old, mesh, ctx) && number;
    s.number = number;
    done = done && unique_rows(number, &s.ring_count, ctx, mesh->positions, mesh->vertex_count, 3) && smooth(&s, ctx);
    if (done) {
        for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) mesh->indices[s.corners[i]] = s.groups[i];
        free(mesh->positions);
        free(mesh->normals);
        mesh->positions = s.out.positions, mesh->normals = s.out.normals, mesh->vertex_count = s.out.vertex_count;
        s.out.positions = s.out.normals = NULL;
        float *uvs = mesh->uvs;
        mesh->uvs = NULL;
        done = !uvs || split_by_uvs(mesh, ctx, uvs, old);
        free(uvs);
    }
    free(number);
    free(old);
    smoothing_finish(&s);
    return done;
}
