// A scene as plain arrays: what a file said, checked, with every number rounded to fp32 once. Knows no Vulkan and no BVH.
//
// Shapes keep the file's order: a hit's `object` is an index in `shapes`. Triangles and spheres are also numbered through
// the whole scene, in shape order: `first_triangle` and `first_sphere` map those numbers to shapes. A hierarchy numbers the triangles first, then the
// spheres, then the triangles of the instances as if each had its own.
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/context.h"
#include "base/image.h"

struct scene_camera {
    float position[3], look_at[3], up[3];
    float fov_y_deg; // full vertical angle, 0 < fov < 180
    // A lens: a disk of this radius around the position, sharp at this distance along the view. Radius 0: a pinhole.
    float lens_radius, focus_distance;
    // Where position and look_at are when the shutter closes; without motion, the same as above.
    bool moves;
    float position_end[3], look_at_end[3];
};

// How samples are spread around a pixel's center. All are positive, so that samples are drawn from them and all count the same.
enum film_filter { FILTER_BOX, FILTER_TENT, FILTER_GAUSSIAN, FILTER_BLACKMAN_HARRIS };

struct scene_film {
    uint32_t width, height; // pixels, 1 to 65535 each
    uint32_t spp;           // samples per pixel, at least 1
    enum transfer transfer;
    enum film_filter filter;
    float filter_radius;    // pixels, > 0; 0.5 with FILTER_BOX is the pixel itself
};

// ------------------------------------------------------------------------------------------------------------- textures
// A picture of 4 × 8 bits (red, green, blue, alpha) a texel; row 0 is the top one, at v = 0.
enum texture_wrap { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR };

struct scene_texture {
    char *name; // for messages
    uint32_t width, height;
    uint8_t *texels; // 4 × width × height
    enum texture_wrap wrap_u, wrap_v;
    bool nearest; // the nearest texel instead of bilinear interpolation
};

// A use of a texture. (u', v') = transform · (u, v, 1), two rows of three; then the texture is looked up.
#define NO_TEXTURE 0
struct scene_map {
    uint32_t texture; // 1 + index in scene.textures, or NO_TEXTURE
    bool srgb;        // red, green and blue are sRGB codes, else linear
    float transform[6];
};

// ------------------------------------------------------------------------------------------------------------ materials
// How light is sent back. Phong and Blinn-Phong: as interface.md's light model, the highlight from r·v or n·h. Lambert: diffuse alone. Metallic-roughness: glTF 2.0's
// (GGX), diffuse is its base color. Dielectric: smooth glass, diffuse tints what goes through. Mirror: diffuse is what it sends back.
enum material_model { MODEL_PHONG, MODEL_BLINN_PHONG, MODEL_LAMBERT, MODEL_METALLIC_ROUGHNESS, MODEL_DIELECTRIC, MODEL_MIRROR };

enum alpha_mode { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND };

struct scene_material {
    char *name;
    enum material_model model;
    float ambient[3], diffuse[3], specular[3];
    float shininess;     // exponent of r·v (n·h), at least 0
    float reflection[3]; // a share of light that is sent back as by a mirror, beside the rest: Phong, Blinn-Phong, Lambert
    float emission[3];   // radiance that the surface sends out, on both sides
    float metallic, roughness; // 0 to 1
    float ior;           // of a dielectric, > 0; for metallic-roughness what its Fresnel term takes
    float absorption[3]; // of a dielectric's inside, per scene unit (Beer-Lambert), at least 0
    uint32_t priority;   // of nested dielectrics: the higher one wins where two overlap
    bool thin;           // a dielectric sheet without inside: light goes straight through
    enum alpha_mode alpha_mode;
    float alpha, alpha_cutoff; // mask: what is below the cutoff is not there; blend: that share of it is
    struct scene_map diffuse_map;   // times diffuse; its alpha times alpha
    struct scene_map normal_map;    // tangent space, green up
    float normal_scale;             // of its x and y
    struct scene_map roughness_map; // green times roughness, blue times metallic
    struct scene_map emission_map;  // times emission
};

// --------------------------------------------------------------------------------------------------------------- lights
enum light_type { LIGHT_POINT, LIGHT_DIRECTIONAL, LIGHT_SPOT, LIGHT_AREA };
enum light_falloff { FALLOFF_NONE, FALLOFF_INVERSE_SQUARE };

// A light that shines on a diffuse surface head-on makes it send back intensity·Kd (at distance 1, with FALLOFF_INVERSE_SQUARE): in radiometric terms, it is π
// times a radiant intensity. Surfaces that emit are in radiometric units: a diffuse surface under a sky of radiance 1 sends back Kd.
struct scene_light {
    enum light_type type;
    float position[3];  // of LIGHT_AREA some point within its shape
    float direction[3]; // the way it shines, not necessarily unit: directional, spot
    float intensity[3]; // with FALLOFF_INVERSE_SQUARE: at distance 1; of LIGHT_AREA, channel by channel, its largest emission
    enum light_falloff falloff;
    float inner_deg, outer_deg; // half angles of a spot's cone: full light within the inner, none outside the outer one
    uint32_t shape;             // LIGHT_AREA: the shape that emits
};

// What lies behind everything: a picture in equirectangular projection. Row 0 is the zenith (+y); the middle column is where -z is, and x grows to the right.
struct scene_environment {
    uint32_t width, height; // 0: there is none, the background is one color
    float *texels;          // 3 × width × height, linear, finite, not negative; as the file has them
    float scale;            // radiance per texel value
    float rotation_deg;     // turned about +y, counterclockwise seen from above
};

// A homogeneous medium that fills the scene.
struct scene_fog {
    float density;   // extinction per scene unit; 0: none
    float albedo[3]; // scattered share of what is taken from a ray, 0 to 1
    float anisotropy; // g of Henyey and Greenstein, -1 < g < 1
};

// How paths go on.
struct scene_paths {
    uint32_t max_depth;      // rays of a path after the camera's, shadow rays not counted
    bool indirect;           // light that surfaces send to each other, not only mirrors and glass
    uint32_t roulette_depth; // from this ray on, paths end by chance
};

// --------------------------------------------------------------------------------------------------------------- shapes
// A triangle mesh in world space, with the shape's transform already applied.
struct scene_mesh {
    float *positions;    // 3 × vertex_count
    float *normals;      // 3 × vertex_count, not necessarily unit, a zero one counts as none; or NULL: flat
    float *uvs;          // 2 × vertex_count texture coordinates, v down; or NULL
    uint32_t *indices;   // 3 × triangle_count, in file order
    uint32_t *materials; // triangle_count indices in scene.materials, or NULL: the shape's material
    uint32_t vertex_count, triangle_count;
};

enum shape_type { SHAPE_SPHERE, SHAPE_TRIANGLE, SHAPE_MESH, SHAPE_RECTANGLE, SHAPE_INSTANCE };

struct scene_shape {
    enum shape_type type;
    uint32_t material;       // index in scene.materials
    float center[3], radius; // of a sphere; radius > 0
    struct scene_mesh mesh;  // of a mesh, of a triangle (one triangle, three vertices), of a rectangle (two: corner, +a, +b, +a+b)
    uint32_t prototype;      // of an instance: index in scene.prototypes
    float placement[12];     // of an instance: three rows of four; a vertex v becomes fl(fl(fl(m0·x + m1·y) + m2·z) + m3), each product rounded, too
    bool own_material;       // of an instance: `material` holds for all of it; else what the prototype's triangles have
    bool moves;
    float motion[3];         // how far it has moved when the shutter closes; at time τ a vertex or center is at fl(p + fl(τ·motion))
    uint32_t instance;       // derived: 1 + its number in scene.instances; 0: it is none of them
};

// A mesh that instances draw, or a shape that moves: kept once, in its own coordinates. Derived, as are the instances.
struct scene_part {
    const struct scene_mesh *mesh; // in prototypes or shapes
    uint32_t first;                // triangles in the parts before
    float min[3], max[3];          // of what its triangles use
};

// A shape that draws a part: an instance, or a mesh, triangle or rectangle that moves.
struct scene_instance {
    uint32_t shape, part;
    uint32_t first;       // triangles of the instances before
    float min[3], max[3]; // in scene coordinates, at all times
};

// Zeroed is empty; scene_finish accepts a half-made scene.
struct scene {
    char *path; // as given by the user, for messages
    struct scene_camera camera;
    struct scene_film film;
    float background[3], ambient[3];
    bool shadows;
    struct scene_environment environment;
    struct scene_fog fog;
    struct scene_paths paths;
    struct scene_material *materials;
    struct scene_texture *textures;
    struct scene_light *lights;     // as the file has them, then one LIGHT_AREA for each shape that emits
    struct scene_shape *shapes;
    struct scene_mesh *prototypes;  // meshes that instances draw
    uint32_t material_count, texture_count, light_count, shape_count, prototype_count;
    struct scene_part *parts;
    struct scene_instance *instances;   // in the order of their shapes
    uint32_t part_count, instance_count;
    uint32_t *first_triangle;           // shape_count + 1: number of triangles in the shapes before, without instances
    uint32_t *first_sphere;             // shape_count + 1: number of spheres in the shapes before
    float bounds_min[3], bounds_max[3]; // of all shapes, rounded outward, finite; min > max when there are none
};

// Loads a scene (.json) or a model (any other suffix), resolves and checks everything, and fills the derived fields.
// GN_SCENE with "file:line:column: what is wrong, what was expected"; GN_IO if the file itself cannot be read.
bool scene_load(struct scene *out, struct context *ctx, const char *path);
void scene_finish(struct scene *scene);

uint32_t scene_triangle_count(const struct scene *scene);
uint32_t scene_sphere_count(const struct scene *scene);

// Triangles of all instances together.
uint64_t scene_instanced_count(const struct scene *scene);

// The instance whose triangle has this number among those of all instances.
const struct scene_instance *scene_instance_at(const struct scene *scene, uint32_t number);

// The mesh that a shape draws: its own, or an instance's prototype.
const struct scene_mesh *scene_mesh_of(const struct scene *scene, uint32_t object);

// One triangle of the scene, by its number: below scene_triangle_count that through the whole scene; from scene_triangle_count + scene_sphere_count on it is an
// instance's.
struct scene_triangle {
    const float *v[3];  // vertices, 3 floats each; an instance's in its part's coordinates: scene_place (scene/instances.h) says where they are
    uint32_t vertex[3]; // their indices in the mesh
    uint32_t object, primitive, material;
};
struct scene_triangle scene_triangle_at(const struct scene *scene, uint32_t number);

// The object (index in shapes) of the sphere with this number through the whole scene.
uint32_t scene_sphere_object(const struct scene *scene, uint32_t number);

#endif
