// A scene as plain arrays: what a file said, checked, with every number rounded to fp32 once. Knows no Vulkan and no BVH.
//
// Shapes keep the file's order: a hit's `object` is an index in `shapes`. Triangles and spheres are also numbered through
// the whole scene, in shape order: `first_triangle` and `first_sphere` map those numbers to shapes.
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/context.h"
#include "base/image.h"

struct scene_camera {
    float position[3], look_at[3], up[3];
    float fov_y_deg; // full vertical angle, 0 < fov < 180
};

struct scene_film {
    uint32_t width, height; // pixels, 1 to 65535 each
    uint32_t spp;           // samples per pixel, at least 1
    enum transfer transfer;
};

struct scene_material {
    char *name;
    float ambient[3], diffuse[3], specular[3];
    float shininess; // exponent of r·v, at least 0
};

enum light_type { LIGHT_POINT };
enum light_falloff { FALLOFF_NONE, FALLOFF_INVERSE_SQUARE };

struct scene_light {
    enum light_type type;
    float position[3];
    float intensity[3]; // with FALLOFF_INVERSE_SQUARE: at distance 1
    enum light_falloff falloff;
};

// A triangle mesh in world space, with the shape's transform already applied.
struct scene_mesh {
    float *positions;    // 3 × vertex_count
    float *normals;      // 3 × vertex_count, not necessarily unit, a zero one counts as none; or NULL: flat
    uint32_t *indices;   // 3 × triangle_count, in file order
    uint32_t *materials; // triangle_count indices in scene.materials, or NULL: the shape's material
    uint32_t vertex_count, triangle_count;
};

enum shape_type { SHAPE_SPHERE, SHAPE_TRIANGLE, SHAPE_MESH };

struct scene_shape {
    enum shape_type type;
    uint32_t material;       // index in scene.materials
    float center[3], radius; // of a sphere; radius > 0
    struct scene_mesh mesh;  // of a mesh, or of a triangle (one triangle, three vertices)
};

// Zeroed is empty; scene_finish accepts a half-made scene.
struct scene {
    char *path; // as given by the user, for messages
    struct scene_camera camera;
    struct scene_film film;
    float background[3], ambient[3];
    bool shadows;
    struct scene_material *materials;
    struct scene_light *lights;
    struct scene_shape *shapes;
    uint32_t material_count, light_count, shape_count;
    uint32_t *first_triangle;           // shape_count + 1: number of triangles in the shapes before
    uint32_t *first_sphere;             // shape_count + 1: number of spheres in the shapes before
    float bounds_min[3], bounds_max[3]; // of all shapes, rounded outward, finite; min > max when there are none
};

// Loads a scene (.json) or a model (any other suffix), resolves and checks everything, and fills the derived fields.
// GN_SCENE with "file:line:column: what is wrong, what was expected"; GN_IO if the file itself cannot be read.
bool scene_load(struct scene *out, struct context *ctx, const char *path);
void scene_finish(struct scene *scene);

uint32_t scene_triangle_count(const struct scene *scene);
uint32_t scene_sphere_count(const struct scene *scene);

// One triangle of the scene, by its number through the whole scene.
struct scene_triangle {
    const float *v[3];  // vertices, 3 floats each
    uint32_t vertex[3]; // their indices in the mesh
    uint32_t object, primitive, material;
};
struct scene_triangle scene_triangle_at(const struct scene *scene, uint32_t number);

// The object (index in shapes) of the sphere with this number through the whole scene.
uint32_t scene_sphere_object(const struct scene *scene, uint32_t number);

#endif
