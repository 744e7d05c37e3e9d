// Meshes: memory and transforms.
#include "scene/mesh.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

void mesh_finish(struct scene_mesh *mesh) {
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->indices);
    free(mesh->materials);
    *mesh = (struct scene_mesh){0};
}

bool mesh_init(struct scene_mesh *out, struct context *ctx, uint64_t vertices, uint64_t triangles, bool normals) {
    *out = (struct scene_mesh){0};
    if (vertices > UINT32_MAX || triangles > MOST_PRIMITIVES)
        return fail(ctx, GN_LIMIT, "a mesh of %llu vertices and %llu triangles, at most %u and %u are possible",
                    (unsigned long long)vertices, (unsigned long long)triangles, UINT32_MAX, MOST_PRIMITIVES);
    out->positions = array_alloc(ctx, vertices, 3 * sizeof *out->positions, "vertices");
    out->indices = array_alloc(ctx, triangles, 3 * sizeof *out->indices, "triangles");
    if (normals) out->normals = array_alloc(ctx, vertices, 3 * sizeof *out->normals, "normals");
    if (!out->positions || !out->indices || (normals && !out->normals)) {
        mesh_finish(out);
        return false;
    }
    out->vertex_count = (uint32_t)vertices;
    out->triangle_count = (uint32_t)triangles;
    return true;
}

bool mesh_add_uvs(struct scene_mesh *mesh, struct context *ctx) {
    mesh->uvs = array_alloc(ctx, mesh->vertex_count, 2 * sizeof *mesh->uvs, "texture coordinates");
    return mesh->uvs != NULL;
}

bool mesh_count_allowed(struct context *ctx, const char *path, uint64_t triangles) {
    if (triangles <= MOST_PRIMITIVES) return true;
    return fail(ctx, GN_LIMIT, "%s: has %llu triangles or more, at most %u are possible", path, (unsigned long long)triangles,
                MOST_PRIMITIVES);
}

const struct transform transform_identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

struct transform transform_product(const struct transform *a, const struct transform *b) {
    struct transform out;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            out.m[i][j] = 0;
            for (int k = 0; k < 4; k++) out.m[i][j] += a->m[i][k] * b->m[k][j];
        }
    return out;
}

// The cofactors of the 3×3 part divided by its largest entry: its inverse transpose times its determinant. Returns that determinant.
static double cofactors(double c[3][3], const struct transform *transform, double *largest) {
    double a[3][3];
    *largest = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) *largest = fmax(*largest, fabs(transform->m[i][j]));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) a[i][j] = transform->m[i][j] / *largest;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
    return a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2];
}

double transform_condition(const struct transform *transform) {
    double c[3][3], largest, norm = 0, inverse_norm = 0;
    double determinant = cofactors(c, transform, &largest);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double a = transform->m[i][j] / largest;
            norm += a * a;
            inverse_norm += c[i][j] * c[i][j];
        }
    double condition = sqrt(norm) * sqrt(inverse_norm) / fabs(determinant);
    return isfinite(condition) ? condition : INFINITY;
}

static bool transform_point(float p[3], const struct transform *t) {
    const double x = p[0], y = p[1], z = p[2];
    for (int i = 0; i < 3; i++) {
        double value = t->m[i][0] * x + t->m[i][1] * y + t->m[i][2] * z + t->m[i][3];
        if (!(fabs(value) < FLT_MAX + 0x1p103)) return false; // rounds to infinity from half a place beyond FLT_MAX, or is NaN
        p[i] = (float)value;
    }
    return true;
}

// The result is scaled to largest component 1, so that no normal under- or overflows; a zero normal stays.
static void transform_normal(float n[3], const double c[3][3], double sign) {
    double out[3], largest = 0;
    for (int i = 0; i < 3; i++) {
        out[i] = sign * (c[i][0] * n[0] + c[i][1] * n[1] + c[i][2] * n[2]);
        largest = fmax(largest, fabs(out[i]));
    }
    for (int i = 0; i < 3; i++) n[i] = largest > 0 ? (float)(out[i] / largest) : 0;
}

bool mesh_transform(struct scene_mesh *mesh, const struct transform *transform, uint32_t first, uint32_t count, uint32_t *bad) {
    double c[3][3], largest;
    double determinant = cofactors(c, transform, &largest);
    for (uint32_t i = first; i < first + count; i++) {
        if (!transform_point(mesh->positions + 3 * (size_t)i, transform)) {
            *bad = i;
            return false;
        }
        if (mesh->normals) transform_normal(mesh->normals + 3 * (size_t)i, (const double(*)[3])c, determinant < 0 ? -1 : 1);
    }
    return true;
}
