#include "ply.h"

#include <stdlib.h>
#include <string.h>

static void flush(struct ply *ply) {
    if (!ply->failed && fwrite(ply->buffer, 1, ply->used, ply->output.file) != ply->used) ply->failed = true;
    ply->used = 0;
}

static void put_byte(struct ply *ply, unsigned char byte) {
    if (ply->used == sizeof ply->buffer) flush(ply);
    ply->buffer[ply->used++] = byte;
}

static void put_u32(struct ply *ply, uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) put_byte(ply, (unsigned char)(value >> shift));
}

static void put_float(struct ply *ply, double value) {
    float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    put_u32(ply, bits);
}

static void put_v3(struct ply *ply, struct v3 v) {
    put_float(ply, v.x);
    put_float(ply, v.y);
    put_float(ply, v.z);
}

bool ply_begin(struct ply *ply, const struct ply_params *params) {
    memset(ply, 0, sizeof *ply);
    ply->normals = params->normals;
    ply->offset = params->offset;
    if (!output_open(&ply->output, params->path)) return false;
    FILE *file = ply->output.file;
    fprintf(file, "ply\nformat binary_little_endian 1.0\ncomment gnomon_meshgen\nelement vertex %llu\n",
            (unsigned long long)params->vertices);
    fputs("property float x\nproperty float y\nproperty float z\n", file);
    if (ply->normals) fputs("property float nx\nproperty float ny\nproperty float nz\n", file);
    fprintf(file, "element face %llu\nproperty list uchar int vertex_indices\nend_header\n", (unsigned long long)params->triangles);
    return true;
}

void ply_vertex(struct ply *ply, struct v3 position, struct v3 normal) {
    put_v3(ply, v3_add(position, ply->offset));
    if (ply->normals) put_v3(ply, normal);
}

void ply_triangle(struct ply *ply, uint32_t a, uint32_t b, uint32_t c) {
    put_byte(ply, 3);
    put_u32(ply, a);
    put_u32(ply, b);
    put_u32(ply, c);
}

bool ply_end(struct ply *ply) {
    flush(ply);
    return output_close(&ply->output, !ply->failed);
}

// An array of `capacity` elements of `size` bytes with room for element `count`; NULL when there is no memory for that.
static void *with_room(void *array, uint32_t count, uint32_t *capacity, size_t size) {
    if (count < *capacity) return array;
    uint32_t wanted = *capacity ? 2 * *capacity : 256;
    void *grown = realloc(array, wanted * size);
    if (grown) *capacity = wanted;
    return grown;
}

uint32_t mesh_vertex(struct mesh *mesh, struct v3 position, struct v3 normal) {
    struct vertex *room = with_room(mesh->vertices, mesh->vertex_count, &mesh->vertex_capacity, sizeof *room);
    if (!room) {
        mesh->failed = true;
        return 0;
    }
    mesh->vertices = room;
    room[mesh->vertex_count] = (struct vertex){position, normal};
    return mesh->vertex_count++;
}

void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c) {
    struct triangle *room = with_room(mesh->triangles, mesh->triangle_count, &mesh->triangle_capacity, sizeof *room);
    if (!room) {
        mesh->failed = true;
        return;
    }
    mesh->triangles = room;
    room[mesh->triangle_count++] = (struct triangle){{a, b, c}};
}

void mesh_quad(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    mesh_triangle(mesh, a, b, c);
    mesh_triangle(mesh, a, c, d);
}

static bool write_all(const struct mesh *mesh, struct ply *ply) {
    for (uint32_t i = 0; i < mesh->vertex_count; i++) ply_vertex(ply, mesh->vertices[i].position, mesh->vertices[i].normal);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *v = mesh->triangles[i].v;
        ply_triangle(ply, v[0], v[1], v[2]);
    }
    return ply_end(ply);
}

bool mesh_write(struct mesh *mesh, const struct ply_params *params) {
    struct ply ply;
    struct ply_params counted = *params;
    counted.vertices = mesh->vertex_count;
    counted.triangles = mesh->triangle_count;
    if (mesh->failed) fprintf(stderr, "gnomon_meshgen: out of memory\n");
    bool done = !mesh->failed && ply_begin(&ply, &counted) && write_all(mesh, &ply);
    free(mesh->vertices);
    free(mesh->triangles);
    memset(mesh, 0, sizeof *mesh);
    return done;
}
