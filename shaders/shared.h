// What crosses between C and GLSL: lists, constants, layouts. Read by both, so only what both understand.
//
// Buffers are arrays of 16-byte words (uvec4 in GLSL, struct word4 in C); floats travel as their bits. What each word
// holds is written here, once, and nowhere else.
#ifndef GNOMON_SHARED_H
#define GNOMON_SHARED_H

// ------------------------------------------------------------------------------------------------------------- effects
// What a scene may call for. Each row is a specialization constant (its number), a bit in C, a name on the command line, and what calls for it.
#define EFFECTS(X)                                                                                            \
    X(0, TRIANGLES,      "triangles",       "a triangle or a mesh is in the scene")                           \
    X(1, SPHERES,        "spheres",         "a sphere is in the scene")                                       \
    X(2, BVH,            "bvh",             "more than a few primitives are in the scene")                    \
    X(3, SMOOTH_NORMALS, "smooth_normals",  "a mesh has vertex normals")                                      \
    X(4, DIFFUSE,        "diffuse",         "a light and a material with a diffuse colour")                   \
    X(5, SPECULAR,       "specular",        "a light and a material with a specular colour")                  \
    X(6, SHADOWS,        "shadows",         "a light, and a shape that can stand in its way")                 \
    X(7, ANTIALIASING,   "antialiasing",    "more than one sample per pixel")                                 \
    X(8, FILTER,         "filter",          "a reconstruction filter other than the pixel's square")          \
    X(9, DEPTH_OF_FIELD, "depth_of_field",  "a lens with a radius")                                           \
    X(10, MOTION_BLUR,   "motion_blur",     "a camera or a shape that moves")                                 \
    X(11, INSTANCES,     "instances",       "a mesh that is drawn more than once, or moves")                  \
    X(12, DIRECTIONAL,   "directional",     "a light whose rays are parallel")                                \
    X(13, SPOT,          "spot",            "a light with a cone")                                            \
    X(14, EMISSION,      "emission",        "a material that sends out light, on a shape")                    \
    X(15, SOFT_SHADOWS,  "soft_shadows",    "a light with a size")                                            \
    X(16, ENVIRONMENT,   "environment",     "a picture behind everything")                                    \
    X(17, BLINN,         "blinn_phong",     "a light and a highlight from the half vector")                   \
    X(18, GGX,           "ggx",             "a metallic-roughness material")                                  \
    X(19, TEXTURES,      "textures",        "a material with a picture on it")                                \
    X(20, NORMAL_MAPS,   "normal_maps",     "a material with a normal map")                                   \
    X(21, ALPHA,         "alpha",           "a material that is not there everywhere")                        \
    X(22, REFLECTION,    "reflection",      "a mirror that sees something")                                   \
    X(23, REFRACTION,    "refraction",      "a dielectric")                                                   \
    X(24, ABSORPTION,    "absorption",      "a dielectric whose inside takes light away")                     \
    X(25, INDIRECT,      "indirect",        "light that surfaces send to each other")                         \
    X(26, FOG,           "fog",             "a medium")

#define EFFECT_COUNT 27

// --------------------------------------------------------------------------------------------------------------- tiers
// How decisions are made. Each row is a value of the specialization constant TIER, a name, and one GLSL file tier_<name>.glsl.
#define TIERS(X)                                                                 \
    X(0, FAST,   "fast",   "what a good plain renderer does")                    \
    X(1, ROBUST, "robust", "watertight, error-bounded offsets, safe boxes")      \
    X(2, EXACT,  "exact",  "every decision as in exact arithmetic")             \
    X(3, FP64,   "fp64",   "the whole path in double, on devices that have it")

#define TIER_COUNT 4

// --------------------------------------------------------------------------------------------------------------- knobs
// What else accuracy can be bought with. Each row is a specialization constant (its number), a name, and the names of its positions in order, beginning with
// 0, the default. Where that is "tier", the tier says; else it is what all tiers do.
#define KNOBS(X)                                                             \
    X(48, OFFSET,    "offset",    "tier|share|bound|bound and self")         \
    X(49, NORMALIZE, "normalize", "tier|inverse root|root and division")     \
    X(50, POWER,     "power",     "tier|built-in|own")                       \
    X(51, SAMPLER,   "sampler",   "sobol|independent")                       \
    X(52, SUM,       "sum",       "kahan|plain")

// Positions, as the rows above name them.
#define OFFSET_SHARE 1u             // a ray leaves a surface by a fixed share of the scene's size
#define OFFSET_BOUND 2u             // by the bound on the error of the point
#define OFFSET_BOUND_SELF 3u        // the same, and the primitive it leaves is not hit again
#define NORMALIZE_INVERSE_ROOT 1u
#define NORMALIZE_ROOT 2u
#define POWER_BUILT_IN 1u
#define POWER_OWN 2u
#define SAMPLER_INDEPENDENT 1u
#define SUM_PLAIN 1u

// Numbers of the specialization constants that are none of these.
#define CONSTANT_TIER       32
#define CONSTANT_AOVS       33      // GN_AOV_* bits
#define CONSTANT_MAX_STEPS  34      // loop iterations an invocation may spend before it gives up
#define CONSTANT_ANY_HIT    35      // trace kernel: occlusion only
#define CONSTANT_RESOLVE    36      // render kernel: goes on with the pending samples, with the answers to their questions

// ------------------------------------------------------------------------------------------------------------ bindings
#define BINDING_NODES       0       // node words
#define BINDING_TRIANGLES   1       // triangle words, in leaf order
#define BINDING_SPHERES     2       // sphere words, in leaf order
#define BINDING_OBJECTS     3       // object words, by object
#define BINDING_MATERIALS   4       // material words, by material
#define BINDING_LIGHTS      5       // light words
#define BINDING_INDICES     6       // vertex numbers for attributes: one word4 per triangle (three vertices, unused)
#define BINDING_NORMALS     7       // vertex normals: one word4 per vertex (x, y, z, unused)
#define BINDING_FILM        8       // rgba32f storage image: sum of samples r, g, b; samples done
#define BINDING_RESIDUE     9       // rgba32f storage image: what Kahan summation still owes r, g, b; nonfinite samples
#define BINDING_AOV_SHADE  10       // rgba32f storage image: sum of normal.xyz; sum of depth
#define BINDING_AOV_ID     11       // rgba32i storage image: object, primitive of sample 0; samples that hit; rays left undecided
#define BINDING_STATUS     12       // storage buffer: struct status
#define BINDING_RAYS       13       // trace kernel: 2 word4 per ray (origin, tmin; direction, tmax)
#define BINDING_HITS       14       // trace kernel: storage buffer, 6 words per ray, struct gn_hit
#define BINDING_GLOBALS    15       // global words
#define BINDING_PENDING    16       // exact tier: storage buffer, struct pending
#define BINDING_LIST       17       // exact tier, trace kernel: storage buffer, numbers of undecided rays
#define BINDING_UVS        18       // vertex texture coordinates: one word4 per vertex (u, v, 0, 0)
#define BINDING_TEXTURES   19       // texture words, by texture
#define BINDING_TEXELS     20       // four texels to a word4, 8 bits a channel, red lowest; each texture begins a word
#define BINDING_SKY        21       // environment: one word4 per texel
#define BINDING_SKY_ROWS   22       // environment: one word4 per row
#define BINDING_EMITTERS   23       // emitter words: the triangles of the lights that are meshes
#define BINDING_INSTANCES  24       // instance words
#define BINDING_CAMERA     25       // camera words
#define BINDING_COUNT      26

// Node: 4 word4. A node holds the boxes of its two children and what they are.
//   0: left min.xyz,  left ref      1: left max.xyz,  right ref
//   2: right min.xyz, unused        3: right max.xyz, unused
// A reference: an inner node's number; or a leaf: bit 31, bit 30 for spheres, bits 26–28 the count minus 1, bits 0–25 the first primitive;
// or an instance: bits 31 and 29, bits 0–25 the word of its record; or REF_NONE, a child that is not there (its box is empty).
// REF_RETURN on a traversal's stack: an instance is left.
#define NODE_WORDS 4
#define REF_LEAF 0x80000000u
#define REF_SPHERES 0x40000000u
#define REF_INSTANCE 0x20000000u
#define REF_COUNT_SHIFT 26
#define REF_FIRST_MASK 0x03ffffffu
#define REF_NONE 0xffffffffu
#define REF_RETURN 0xa0000000u

// Triangle: 3 word4:  v0.xyz, object    v1.xyz, primitive    v2.xyz, material
// Those of parts, which instances draw, come last: their vertices are in scene units and the part's coordinates, their object is 0.
#define TRIANGLE_WORDS 3
// Sphere: 2 word4:  center.xyz, radius    object, material, word of its record in INSTANCES if it moves else 0, 0
#define SPHERE_WORDS 2
// Object: 1 word4:  first word of its triangles in INDICES or NO_ATTRIBUTES, number of the light that it is or NO_LIGHT, 0, 0
#define OBJECT_WORDS 1
// Instances: the words of the objects' records, four to a word4, 0 for those that have none; then the records, of INSTANCE_WORDS word4 (instance.glsl says how they
// are used; a moving sphere's has only its center, as column 3, motion and base):
//   0: column 0 of the placement, object                          1: column 1, offset of the numbers of its triangles from those in leaf order
//   2: column 2, material for all of it or NO_MATERIAL            3: column 3, reference of its part's root
//   4: motion, 0                                                  5: base and scale, as render/upload.h has them
//   6, 7, 8: rows of the inverse that takes device units to the part's, slack along each axis     9: what it takes to 0, 0
#define INSTANCE_WORDS 10
#define INSTANCE_MOTION 4u
#define INSTANCE_BASE 5u
#define INSTANCE_INVERSE 6u
#define INSTANCE_CENTER 9u
#define NO_MATERIAL 0xffffffffu
#define NO_ATTRIBUTES 0xffffffffu
#define NO_LIGHT 0xffffffffu
// Material: 15 word4. Maps are two each: row 0 of the transform, texture or NO_TEXTURE_WORD; row 1, 1 for sRGB.
//   0: ambient.rgb, shininess       1: diffuse.rgb, enum material_model | alpha_mode << 8 | thin << 16
//   2: specular.rgb, roughness      3: reflection.rgb, metallic      4: emission.rgb, ior
//   5: absorption.rgb per device unit, priority                      6: alpha, cutoff, scale of the normal map, 0
//   7: diffuse map    9: normal map    11: roughness map    13: emission map
#define MATERIAL_WORDS 15
#define MATERIAL_MAP_DIFFUSE 7u
#define MATERIAL_MAP_NORMAL 9u
#define MATERIAL_MAP_ROUGHNESS 11u
#define MATERIAL_MAP_EMISSION 13u
#define NO_TEXTURE_WORD 0xffffffffu
// Material models and alpha modes, as in scene/scene.h.
#define PHONG_MODEL 0u
#define BLINN_PHONG_MODEL 1u
#define LAMBERT_MODEL 2u
#define METALLIC_ROUGHNESS_MODEL 3u
#define DIELECTRIC_MODEL 4u
#define MIRROR_MODEL 5u
#define ALPHA_MODE_OPAQUE 0u
#define ALPHA_MODE_MASK 1u
#define ALPHA_MODE_BLEND 2u
// Texture: 1 word4:  width, height, first word of its texels, wrap of u | wrap of v << 2 | TEXTURE_NEAREST
// TEXELS begins with what codes mean, 256 floats for sRGB and 256 for linear codes.
#define TEXTURE_WORDS 1
#define TEXTURE_REPEATS 0u
#define TEXTURE_CLAMPS 1u
#define TEXTURE_MIRRORS 2u
#define TEXTURE_NEAREST 16u
#define TEXEL_CODE_WORDS 128u
// Sky texel: 1 word4, and sky row: 1 word4, behind one of the whole picture: width, height, turns, 0. As in scene/sky.h.
// Light: 4 word4. Points and lengths are in device units, intensities and radiances as the scene has them, directions unit.
//                0                     1                                         2                            3
//   point        position, kind        intensity, 1 for inverse square else 0
//   spot         as a point light                                                its axis, 1 - cos outer      0, 0, 0, 1/(cos inner - cos outer)
//   directional  0, 0, 0, kind         intensity, 0                              the way to it, 0
//   sphere       center, kind          radiance, object                          radius, 0, 0, 0
//   triangle     v0, kind              radiance, object                          v1, 0                        v2, 0
//   rectangle    as a triangle; its fourth corner is v1 + v2 - v0
//   mesh         0, 0, 0, kind         0, 0, 0, object                           first emitter, count, 0, 0
#define LIGHT_WORDS 4
#define ABSENT_LIGHT 0u             // its effect is switched off, or its shape
#define POINT_LIGHT 1u
#define DIRECTIONAL_LIGHT 2u
#define SPOT_LIGHT 3u
#define SPHERE_LIGHT 4u
#define TRIANGLE_LIGHT 5u
#define RECTANGLE_LIGHT 6u
#define MESH_LIGHT 7u
// Emitter, a triangle of a mesh light: 4 word4:  v0.xyz, cdf    v1.xyz, object    v2.xyz, primitive    radiance.rgb, probability
#define EMITTER_WORDS 4
// Globals: 4 word4:
//   0: background.rgb, the most rays of a path after the camera's     1: ambient.rgb, the ray from which on paths end by chance
//   2: fog: albedo.rgb, density per device unit                       3: fog: center.xyz and radius of the ball that it fills; and
//   4: fog: anisotropy; SWITCH_* bits, 0, 0
#define GLOBAL_WORDS 5
// What a scene may switch off by itself, or lacks: kernels with everything in them ask before they do what would show.
#define SWITCH_SHADOWS 1u
#define SWITCH_INDIRECT 2u
#define SWITCH_ENVIRONMENT 4u

// Camera: what is not in render_args (render/camera.h), in device units; a single word where no effect calls for it.
//   0: travel.xyz, lens      1: aim, 0, 0, 0
//   from CAMERA_FILTER_WORD: the film filter's knots, four to a word (render/filter_table.h)
//   from CAMERA_FRAMES_WORD: CAMERA_FRAMES + 1 frames of three words: corner.xyz, 0    du.xyz, 0    dv.xyz, 0
#define CAMERA_FRAMES 64
#define CAMERA_FILTER_WORD 2
#define CAMERA_FRAMES_WORD (CAMERA_FILTER_WORD + FILTER_KNOTS / 4)
#define CAMERA_WORDS (CAMERA_FRAMES_WORD + 3 * (CAMERA_FRAMES + 1))

// Knots of a film filter: FILTER_CELLS = 2^FILTER_CELL_BITS to each halving of the distance from 0, down to 2^-24.
#define FILTER_CELL_BITS 5
#define FILTER_CELLS (1 << FILTER_CELL_BITS)
#define FILTER_KNOTS (23 * FILTER_CELLS + 4)

// Pending samples of the exact tier: those with a ray that the kernel's error bounds left undecided. The host decides the ray and the kernel does the sample again
// with the answers it has, until it comes through. A record is PENDING_WORDS word4:
//   0: pixel x, y in the band; answers so far; state PENDING_*      1: origin.xyz (device units), SELF_*
//   2: direction.xyz, tmax                                          3: 2 × number of the ray in its sample + 1 for any hit, its target, its time
//   4 + 2k: answer k: number of the ray, object, index, primitive (as a hit has them)      5 + 2k: t, u, v, 0
#define PENDING_CAPACITY 1024
#define PENDING_ANSWERS 63
#define PENDING_WORDS (4 + 2 * PENDING_ANSWERS)
#define PENDING_DONE 0u
#define PENDING_ASKS 1u
#define PENDING_ANSWERED 2u

// Stack entries of a traversal: BVH_MAX_DEPTH + 2; twice that where there are instances.
#define STACK_SIZE 64

// Invocations of a workgroup, and the square tile of pixels it renders.
#define GROUP_SIZE 64
#define TILE_SIDE 8

// Flags of a hit, as in gnomon.h.
#define HIT_INVALID 1u
#define HIT_UNDECIDED 2u

// Stress kernels: functions of stress_numbers.comp, and numbers in and out of an invocation.
#define STRESS_POWER 0u             // x, y
#define STRESS_LIGHT 1u             // intensity.rgb, falloff, distance
#define STRESS_NORMALIZE 2u         // a vector
#define STRESS_PHONG 3u             // diffuse.rgb, specular.rgb, shininess, n, l, v
#define STRESS_CAMERA 4u            // corner, du, dv, pixel x, y, offset
#define STRESS_UNIT_INTERVAL 5u     // two words of random bits
#define STRESS_TRIANGLE 6u          // o, d, v0, v1, v2: what the exact tier's filter says; lo, hi, and 1 for a certain hit, -1 for a certain miss, else 0
#define STRESS_SPHERE 7u            // o, d, center, radius, -1 or +1 for the root: the same
#define STRESS_DISK 8u              // u, v: a point of the lens
#define STRESS_LENS 9u              // direction, du, dv, aim, u, v: the direction through that point
#define STRESS_NUMBERS_IN 16u
// Functions of stress_shading.comp, and the effect that each is compiled with.
#define SHADING_FRAME 0u            // INDIRECT: n
#define SHADING_LOBE 1u             // INDIRECT: model, shininess or roughness, n, wo, u, choice, Kd, Ks, share of a mirror
#define SHADING_COSINE 2u           // INDIRECT: u
#define SHADING_MIRRORS 3u          // REFLECTION: two normals, direction, bounces
#define SHADING_FACETS 4u           // GGX: n, wo, wi, roughness
#define SHADING_SCHLICK 5u          // GGX: f0, cosine
#define SHADING_GLASS 6u            // REFRACTION: n, ng, wo, index here, beyond, choice
#define SHADING_INSIDE 7u           // REFRACTION: point on a unit sphere, direction, bounces
#define SHADING_LEFT 8u             // ABSORPTION: σ, way
#define SHADING_SPHERE_LIGHT 9u     // SOFT_SHADOWS: center, radius, u
#define SHADING_TEXELS 10u          // TEXTURES: coordinate, texels, wrap, 1 for nearest
#define SHADING_SPHERE_UV 11u       // TEXTURES: n
#define SHADING_SKY_UV 12u          // ENVIRONMENT: a direction
#define SHADING_BEND 13u            // NORMAL_MAPS: n, two edges, what uv change along them, texel
#define STRESS_SHADING_IN 16u
#define STRESS_SHADING_OUT 8u
#define STRESS_BOX_IN 14u
#define STRESS_LEAVE_IN 9u
#define STRESS_LEAVE_OUT 20u

// ------------------------------------------------------------------------------------------------------ dialects of C and GLSL
#ifdef GL_core_profile
#define X(number, id, name, text) layout(constant_id = number) const bool HAS_##id = true;
EFFECTS(X)
#undef X
#define X(number, id, name, text) const uint TIER_##id = number;
TIERS(X)
#undef X
#define X(number, id, name, positions) layout(constant_id = number) const uint CHOSEN_##id = 0u;
KNOBS(X)
#undef X
#else
#include <stdint.h>
struct word4 { uint32_t w[4]; };
typedef struct { float x, y, z, w; } vec4;
typedef uint32_t uint;
enum {
#define X(number, id, name, text) EFFECT_##id = 1 << number,
    EFFECTS(X)
#undef X
#define X(number, id, name, text) TIER_##id = number,
    TIERS(X)
#undef X
};
enum knob {
#define X(number, id, name, positions) KNOB_##id,
    KNOBS(X)
#undef X
    KNOB_COUNT
};
enum {
#define X(number, id, name, positions) CONSTANT_##id = number,
    KNOBS(X)
#undef X
};
#endif

// ---------------------------------------------------------------------------------- push constants (128 bytes at most) and status
// One dispatch of render.comp: some tiles of one band of rows of the film, up to some sample.
struct render_args {
    vec4 position;          // xyz of the camera, device coordinates (render/upload.h)
    vec4 corner;            // xyz, see render/camera.h; w: scene units per device unit, a power of two
    vec4 du, dv;            // xyz
    uint width, height;     // of the whole film, pixels: the picture, or where stride is not 1 every so manieth of its pixels
    uint band_y, band_rows; // the rows in the film images
    uint first_tile;        // workgroup g renders tile (first_tile + g) · tile_stride mod tile_count of the band
    uint tile_count, tile_stride;
    uint sample_end;        // every pixel goes on from the samples it has to this many
    uint spp, seed;
    uint light_count;
    uint root;              // reference of the root
    uint stride, phase;     // pixel (x, y) of the band's images, (x, y + band_y)·stride + (phase mod stride, phase / stride) of the picture
};

// One dispatch of trace.comp.
struct trace_args {
    vec4 base;              // xyz and w as base and scale in render/upload.h
    uint first, count;      // rays
    uint root;              // reference of the root
    uint list_first;        // exact tier: where the list of BINDING_LIST goes on
};

// One dispatch of a stress_*.comp, which reads numbers at BINDING_RAYS and writes numbers at BINDING_HITS.
struct stress_args {
    vec4 base;              // xyz and w as base and scale in render/upload.h
    uint count;             // cases
    uint root;              // reference of the root
    uint what;              // stress_numbers.comp: STRESS_*, stress_shading.comp: SHADING_*, the function
};

// What a dispatch reports; the host zeroes it before.
struct status {
    uint rays;              // shot, all kinds
    uint hits;              // trace kernel: rays that hit
    uint nonfinite;         // samples dropped
    uint undecided;         // rays that this stage left undecided
    uint decided;           // exact tier, second stage: pending rays that it decided
    uint unfinished;        // invocations that ran out of CONSTANT_MAX_STEPS with work left (they go on when dispatched again)
    uint stuck;             // invocations that ran out without finishing one sample: an error
};

#endif
