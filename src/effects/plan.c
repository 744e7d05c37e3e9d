// The rules: what calls for each effect, and why leaving it out changes no pixel when nothing does.
#include "effects/plan.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/words.h"

#define BECAUSE_SIZE sizeof(((struct plan *)0)->because[0])
#define ALL_EFFECTS ((1u << EFFECT_COUNT) - 1)
#define EFFECTS_OF_GEOMETRY (uint32_t)(EFFECT_TRIANGLES | EFFECT_SPHERES | EFFECT_BVH | EFFECT_INSTANCES)
#define FEW_PRIMITIVES 4 // as many are tested one by one as fast as by way of boxes

// What the rules look at. Shapes of a disabled kind are not there.
struct facts {
    const struct scene *scene;
    uint32_t disabled; // EFFECT_* bits
    uint32_t effects;  // that are called for, of those with a lower number
    uint32_t spp;
    uint32_t *used_by; // for each material the first shape that uses it, or NOT_USED
    uint64_t triangles;
    uint32_t spheres;
    uint32_t last_shape; // that is there
    int64_t source[3];   // what lights surfaces in a channel, as lit_by says
};
#define NOT_USED UINT32_MAX

static bool says(char *because, bool on, const char *format, ...) __attribute__((format(printf, 3, 4)));
static bool says(char *because, bool on, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(because, BECAUSE_SIZE, format, arguments);
    va_end(arguments);
    return on;
}

// ------------------------------------------------------------------------------------------------------------------- facts

static bool is_there(const struct facts *facts, uint32_t shape) {
    const bool sphere = facts->scene->shapes[shape].type == SHAPE_SPHERE, instance = facts->scene->shapes[shape].instance != 0;
    return !(facts->disabled & (sphere ? EFFECT_SPHERES : EFFECT_TRIANGLES)) && !(instance && facts->disabled & EFFECT_INSTANCES);
}

static void note_material(struct facts *facts, uint32_t material, uint32_t shape) {
    if (facts->used_by[material] == NOT_USED) facts->used_by[material] = shape;
}

static bool any_positive(const float v[3]) { return v[0] > 0 || v[1] > 0 || v[2] > 0; }

// The brightest red, green or blue that a shape sends out by itself.
static float emission_of(const struct scene *scene, uint32_t shape, int channel) {
    const struct scene_mesh *mesh = &scene->shapes[shape].mesh;
    float most = 0;
    for (uint32_t i = 0; mesh->materials && i < mesh->triangle_count; i++) most = fmaxf(most, scene->materials[mesh->materials[i]].emission[channel]);
    return mesh->materials ? most : scene->materials[scene->shapes[shape].material].emission[channel];
}

static float intensity_of(const struct scene *scene, uint32_t light, int channel) {
    const struct scene_light *l = &scene->lights[light];
    return l->type == LIGHT_AREA ? emission_of(scene, l->shape, channel) : l->intensity[channel];
}

// What lights surfaces in a channel: the number of a light, LIT_BY_SKY, LIT_BY_ALL where surfaces light each other, or LIT_BY_NONE.
enum { LIT_BY_NONE = -1, LIT_BY_SKY = -2, LIT_BY_ALL = -3 };

static int64_t lit_by(const struct scene *scene, int channel) {
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (intensity_of(scene, i, channel) > 0) return i;
    if (scene->environment.width > 0 && scene->environment.scale > 0) return LIT_BY_SKY;
    return scene->paths.indirect && scene->paths.max_depth > 0 ? LIT_BY_ALL : LIT_BY_NONE;
}

static bool facts_init(struct facts *out, struct context *ctx, const struct scene *scene, uint32_t disabled, uint32_t spp) {
    *out = (struct facts){.scene = scene, .disabled = disabled, .spp = spp};
    for (int k = 0; k < 3; k++) out->source[k] = lit_by(scene, k);
    out->used_by = array_alloc(ctx, scene->material_count, sizeof *out->used_by, "materials");
    if (!out->used_by) return false;
    for (uint32_t i = 0; i < scene->material_count; i++) out->used_by[i] = NOT_USED;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const struct scene_shape *shape = &scene->shapes[i];
        if (!is_there(out, i)) continue;
        out->last_shape = i;
        const struct scene_mesh *mesh = scene_mesh_of(scene, i);
        if (shape->type == SHAPE_SPHERE)
            out->spheres++;
        else
            out->triangles += mesh->triangle_count;
        if (!mesh->materials || (shape->type == SHAPE_INSTANCE && shape->own_material))
            note_material(out, shape->material, i);
        else
            for (uint32_t k = 0; k < mesh->triangle_count; k++) note_material(out, mesh->materials[k], i);
    }
    return true;
}

static bool is_lit(const struct facts *facts) {
    return facts->source[0] != LIT_BY_NONE || facts->source[1] != LIT_BY_NONE || facts->source[2] != LIT_BY_NONE;
}

struct source_text { char text[32]; };
static struct source_text source_text(int64_t source) {
    struct source_text out;
    if (source >= 0) snprintf(out.text, sizeof out.text, "light %u", (uint32_t)source);
    else snprintf(out.text, sizeof out.text, "%s", source == LIT_BY_SKY ? "the environment" : "indirect light");
    return out;
}

// All of a metal's light is in its highlight.
static bool has_diffuse(const struct scene_material *m) {
    const bool metal = m->model == MODEL_METALLIC_ROUGHNESS && m->metallic == 1 && m->roughness_map.texture == NO_TEXTURE;
    return m->model <= MODEL_METALLIC_ROUGHNESS && !metal;
}
static bool has_highlight(const struct scene_material *m) { return m->model == MODEL_PHONG; }
static const float *diffuse_of(const struct scene_material *material) { return material->diffuse; }
static const float *specular_of(const struct scene_material *material) { return material->specular; }

// Which materials have a part, its color, and its name.
struct lobe {
    bool (*there)(const struct scene_material *);
    const float *(*color)(const struct scene_material *);
    const char *name;
};

// A light and a material in use whose colors have a channel in common: the product of intensity and color is 0 for all others, and so is
// what they add.
static bool light_meets(const struct facts *facts, const struct lobe *lobe, char *because) {
    const struct scene *scene = facts->scene;
    const int64_t *source = facts->source;
    if (!is_lit(facts)) return says(because, false, scene->light_count ? "no light has any intensity" : "there are no lights");
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int k = 0; k < 3; k++)
            if (facts->used_by[i] != NOT_USED && source[k] != LIT_BY_NONE && lobe->there(&scene->materials[i]) && lobe->color(&scene->materials[i])[k] > 0)
                return says(because, true, "%s and the %s color of material '%s' on shape %u", source_text(source[k]).text, lobe->name,
                            excerpt_word(scene->materials[i].name).text, facts->used_by[i]);
    return says(because, false, "no material in use has a %s color that a light could show", lobe->name);
}

// ------------------------------------------------------------------------------------------------------------------- rules

#define X(number, id, name, text) static bool rule_##id(const struct facts *facts, char *because);
EFFECTS(X)
#undef X
static bool has_normal_map(const struct scene *scene, const struct scene_material *m);
static bool is_cut_out(const struct scene *scene, const struct scene_material *m);

static bool rule_TRIANGLES(const struct facts *facts, char *because) {
    for (uint32_t i = 0; i < facts->scene->shape_count; i++)
        if (is_there(facts, i) && facts->scene->shapes[i].type != SHAPE_SPHERE)
            return says(because, true, "shape %u and %" PRIu64 " triangle%s in all", i, facts->triangles, facts->triangles == 1 ? "" : "s");
    return says(because, false, "there are no triangles");
}

static bool rule_SPHERES(const struct facts *facts, char *because) {
    for (uint32_t i = 0; i < facts->scene->shape_count; i++)
        if (is_there(facts, i) && facts->scene->shapes[i].type == SHAPE_SPHERE)
            return says(because, true, "shape %u and %u sphere%s in all", i, facts->spheres, facts->spheres == 1 ? "" : "s");
    return says(because, false, "there are no spheres");
}

// A hierarchy decides which primitives are tested, not which are hit. A leaf holds primitives of one kind. Disabled kinds count: they are in the
// hierarchy, too, which is built for the scene.
static bool rule_BVH(const struct facts *facts, char *because) {
    const uint32_t triangles = scene_triangle_count(facts->scene), spheres = scene_sphere_count(facts->scene), count = triangles + spheres;
    if (facts->scene->instance_count) return says(because, true, "%u instance%s", facts->scene->instance_count, facts->scene->instance_count == 1 ? "" : "s");
    if (count > FEW_PRIMITIVES) return says(because, true, "%u primitives", count);
    if (triangles && spheres) return says(because, true, "triangles and spheres");
    return says(because, false, "%u primitive%s: one leaf", count, count == 1 ? "" : "s");
}

// Without vertex normals the shading normal is the geometric one.
static bool rule_SMOOTH_NORMALS(const struct facts *facts, char *because) {
    for (uint32_t i = 0; i < facts->scene->shape_count; i++)
        if (is_there(facts, i) && scene_mesh_of(facts->scene, i)->normals) return says(because, true, "the vertex normals of shape %u", i);
    return says(because, false, "no mesh has vertex normals");
}

static bool rule_DIFFUSE(const struct facts *facts, char *because) {
    static const struct lobe lobe = {has_diffuse, diffuse_of, "diffuse"};
    return light_meets(facts, &lobe, because);
}

static bool rule_SPECULAR(const struct facts *facts, char *because) {
    static const struct lobe lobe = {has_highlight, specular_of, "specular"};
    return light_meets(facts, &lobe, because);
}

// Where a point certainly is: 1 inside the sphere, -1 outside, 0 on it or too near to tell. The sum is off by a few 2^-53 of itself.
static int side_of(const struct scene_shape *sphere, const float point[3]) {
    double square = 0;
    for (int i = 0; i < 3; i++) square += ((double)point[i] - sphere->center[i]) * ((double)point[i] - sphere->center[i]);
    const double radius2 = (double)sphere->radius * sphere->radius;
    return square < radius2 * (1 - 1e-12) ? 1 : square > radius2 * (1 + 1e-12) ? -1 : 0;
}

// A sphere alone. From outside, one sees the outward side of points whose normal n points outward, and a light counts where n·l > 0: from
// such a point the way to the light leaves the ball, which is convex, and never meets it again. A light inside the ball counts only for the
// inward side, and the way to it stays inside. What is left, a light outside that would shine on the inward side, needs a camera that is
// not outside.
static bool sphere_shadows_itself(const struct scene *scene, const struct scene_shape *sphere) {
    if (sphere->moves) return true; // where it is at the ray's time is not looked at
    if (side_of(sphere, scene->camera.position) < 0) return false;
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (scene->lights[i].type == LIGHT_DIRECTIONAL || side_of(sphere, scene->lights[i].position) <= 0) return true;
    return scene->environment.width > 0;
}

// Whether rays may come to a sphere's inside though the camera is outside, or from where the argument above does not look.
static bool light_goes_round(const struct facts *facts) {
    const struct scene_camera *camera = &facts->scene->camera;
    for (uint32_t i = 0; i < facts->scene->material_count; i++) {
        const struct scene_material *m = &facts->scene->materials[i];
        if (facts->used_by[i] != NOT_USED && (m->model == MODEL_DIELECTRIC || is_cut_out(facts->scene, m) || any_positive(m->emission))) return true;
    }
    return camera->moves || camera->lens_radius > 0;
}

// Whether a shading normal may look to a light that the surface itself does not: then it stands in its own light.
static bool normals_are_bent(const struct facts *facts) {
    for (uint32_t i = 0; i < facts->scene->material_count; i++)
        if (facts->used_by[i] != NOT_USED && has_normal_map(facts->scene, &facts->scene->materials[i])) return true;
    return facts->effects & EFFECT_SMOOTH_NORMALS;
}

// Whether points of fog ask for light: then all that is there can stand in its way.
static bool fog_is_lit(const struct facts *facts) { return facts->scene->fog.density > 0 && is_lit(facts); }

// Whether any point asks for light. The lobes of Blinn-Phong and GGX have higher numbers.
static bool light_is_asked(const struct facts *facts) {
    char unused[BECAUSE_SIZE];
    return facts->effects & (EFFECT_DIFFUSE | EFFECT_SPECULAR) || rule_BLINN(facts, unused) || rule_GGX(facts, unused) || fog_is_lit(facts);
}

static bool shape_moves(const struct scene *scene) {
    for (uint32_t i = 0; i < scene->shape_count; i++)
        if (scene->shapes[i].moves || scene->shapes[i].type == SHAPE_INSTANCE) return true;
    return false;
}

// A triangle alone: the way to a light starts in its plane, on the side of the light, and meets the plane nowhere else unless it lies in it, which
// is no hit. That side is the one of the shading normal only where this is the triangle's own.
static bool rule_SHADOWS(const struct facts *facts, char *because) {
    const struct scene *scene = facts->scene;
    if (!scene->shadows) return says(because, false, "the scene switches shadows off");
    if (!light_is_asked(facts)) return says(because, false, "nothing is lit that could lie in shadow");
    if (facts->triangles + facts->spheres == 0) return says(because, false, "there is nothing that casts a shadow");
    if (fog_is_lit(facts)) return says(because, true, "fog, and %" PRIu64 " primitives that shade it", facts->triangles + facts->spheres);
    const struct scene_shape *last = &scene->shapes[facts->last_shape];
    if (shape_moves(scene)) return says(because, true, "light and instances or shapes that move");
    if (facts->triangles + facts->spheres > 1) return says(because, true, "light and %" PRIu64 " primitives", facts->triangles + facts->spheres);
    if (normals_are_bent(facts)) return says(because, true, "shape %u, whose shading normals are not its own", facts->last_shape);
    if (facts->triangles == 1) return says(because, false, "a triangle alone casts no shadow on itself");
    if (light_goes_round(facts) || sphere_shadows_itself(scene, last)) return says(because, true, "shape %u, a sphere that is seen from inside", facts->last_shape);
    return says(because, false, "a sphere alone casts no shadow on the side that is lit");
}

// One sample goes through the pixel's center.
static bool rule_ANTIALIASING(const struct facts *facts, char *because) {
    return says(because, facts->spp > 1, "%u sample%s per pixel", facts->spp, facts->spp == 1 ? "" : "s");
}

// A box of the pixel's size is what antialiasing does without; one sample has no filter.
static bool rule_FILTER(const struct facts *facts, char *because) {
    const struct scene_film *film = &facts->scene->film;
    if (film->filter == FILTER_BOX && film->filter_radius == 0.5f) return says(because, false, "samples are spread over their pixel");
    return says(because, facts->spp > 1, "a filter of radius %g and %u sample%s per pixel", film->filter_radius, facts->spp, facts->spp == 1 ? "" : "s");
}

// Every point of a disk of radius 0 is its center.
static bool rule_DEPTH_OF_FIELD(const struct facts *facts, char *because) {
    const float radius = facts->scene->camera.lens_radius;
    if (!(radius > 0)) return says(because, false, "the camera is a pinhole");
    return says(because, true, "a lens of radius %g", radius);
}

static bool rule_MOTION_BLUR(const struct facts *facts, char *because) {
    if (facts->scene->camera.moves) return says(because, true, "the camera moves");
    for (uint32_t i = 0; i < facts->scene->shape_count; i++)
        if (is_there(facts, i) && facts->scene->shapes[i].moves) return says(because, true, "shape %u moves", i);
    return says(because, false, "nothing moves");
}

// A prototype that one shape draws, and that does not move, has become a mesh of the scene: the same triangles, to the bit.
static bool rule_INSTANCES(const struct facts *facts, char *because) {
    const struct scene *scene = facts->scene;
    for (uint32_t i = 0; i < scene->shape_count; i++)
        if (is_there(facts, i) && scene->shapes[i].instance)
            return says(because, true, "shape %u, which %s", i, scene->shapes[i].moves ? "moves" : "draws a mesh that is drawn more than once");
    return says(because, false, "no mesh is drawn more than once, and none moves");
}

// ----------------------------------------------------------------------------------------------------------------- lights

static bool shines(const struct scene_light *light) { return any_positive(light->intensity); }

// A light that nothing asks for, or that sends out nothing, adds nothing.
static bool light_of_type(const struct facts *facts, enum light_type type, const char *name, char *because) {
    uint32_t i = 0;
    while (i < facts->scene->light_count && !(facts->scene->lights[i].type == type && shines(&facts->scene->lights[i]))) i++;
    if (i == facts->scene->light_count) return says(because, false, "there are no %s lights", name);
    return says(because, light_is_asked(facts), light_is_asked(facts) ? "light %u" : "light %u shines on nothing that shows it", i);
}

static bool rule_DIRECTIONAL(const struct facts *facts, char *because) { return light_of_type(facts, LIGHT_DIRECTIONAL, "directional", because); }
static bool rule_SPOT(const struct facts *facts, char *because) { return light_of_type(facts, LIGHT_SPOT, "spot", because); }

// The first material in use for which `calls` holds.
static bool material_calls(const struct facts *facts, bool (*calls)(const struct scene *, const struct scene_material *), const char *none, char *because) {
    for (uint32_t i = 0; i < facts->scene->material_count; i++)
        if (facts->used_by[i] != NOT_USED && calls(facts->scene, &facts->scene->materials[i]))
            return says(because, true, "material '%s' on shape %u", excerpt_word(facts->scene->materials[i].name).text, facts->used_by[i]);
    return says(because, false, "%s", none);
}

static bool emits(const struct scene *scene, const struct scene_material *m) {
    (void)scene;
    return any_positive(m->emission);
}
static bool rule_EMISSION(const struct facts *facts, char *because) { return material_calls(facts, emits, "no material in use sends out light", because); }

// Where nothing asks for light, paths do not go on by a sample of a surface either, so no light is weighted by how it could have been sampled.
static bool rule_SOFT_SHADOWS(const struct facts *facts, char *because) {
    for (uint32_t i = 0; i < facts->scene->light_count; i++)
        if (facts->scene->lights[i].type == LIGHT_AREA)
            return says(because, light_is_asked(facts), light_is_asked(facts) ? "light %u, which is shape %u" : "light %u, shape %u, shines on nothing that shows it", i,
                        facts->scene->lights[i].shape);
    return says(because, false, "no light has a size");
}

// A sky without light is a black background; but where there is a sky, nobody sees the background's own color.
static bool rule_ENVIRONMENT(const struct facts *facts, char *because) {
    const struct scene_environment *sky = &facts->scene->environment;
    if (sky->width == 0) return says(because, false, "the background is one colour");
    if (!(sky->scale > 0) && !any_positive(facts->scene->background)) return says(because, false, "the environment is black");
    return says(because, true, "an environment of %u × %u texels", sky->width, sky->height);
}

// -------------------------------------------------------------------------------------------------------------- materials

static bool is_blinn(const struct scene_material *m) { return m->model == MODEL_BLINN_PHONG; }
static bool rule_BLINN(const struct facts *facts, char *because) {
    static const struct lobe lobe = {is_blinn, specular_of, "Blinn-Phong specular"};
    return light_meets(facts, &lobe, because);
}

// Along the horizon all of them are white.
static bool is_ggx(const struct scene_material *m) { return m->model == MODEL_METALLIC_ROUGHNESS; }
static const float *white_of(const struct scene_material *m) {
    static const float white[3] = {1, 1, 1};
    (void)m;
    return white;
}
static bool rule_GGX(const struct facts *facts, char *because) {
    static const struct lobe lobe = {is_ggx, white_of, "metallic-roughness"};
    return light_meets(facts, &lobe, because);
}

static bool has_texture(const struct scene *scene, const struct scene_material *m) {
    (void)scene;
    return m->diffuse_map.texture != NO_TEXTURE || m->roughness_map.texture != NO_TEXTURE || m->emission_map.texture != NO_TEXTURE;
}
static bool rule_TEXTURES(const struct facts *facts, char *because) { return material_calls(facts, has_texture, "no material in use has a texture", because); }

static bool has_normal_map(const struct scene *scene, const struct scene_material *m) {
    (void)scene;
    return m->normal_map.texture != NO_TEXTURE;
}
static bool rule_NORMAL_MAPS(const struct facts *facts, char *because) {
    return material_calls(facts, has_normal_map, "no material in use has a normal map", because);
}

// Whether every lookup of a map gives an alpha of 1: that is what lies between two ones, too.
static bool map_is_opaque(const struct scene *scene, const struct scene_map *map) {
    if (map->texture == NO_TEXTURE) return true;
    const struct scene_texture *texture = &scene->textures[map->texture - 1];
    for (size_t i = 0; i < (size_t)texture->width * texture->height; i++)
        if (texture->texels[4 * i + 3] != 255) return false;
    return true;
}

// A share of 1 is more than any random number, and a mask's alpha that reaches the cutoff is a surface.
static bool is_cut_out(const struct scene *scene, const struct scene_material *m) {
    if (m->alpha_mode == ALPHA_OPAQUE) return false;
    const bool whole = m->alpha_mode == ALPHA_BLEND ? m->alpha >= 1 : m->alpha >= m->alpha_cutoff;
    return !whole || !map_is_opaque(scene, &m->diffuse_map);
}
static bool rule_ALPHA(const struct facts *facts, char *because) { return material_calls(facts, is_cut_out, "every material in use is opaque", because); }

// Mirrors and glass only say where a path goes on.
static bool paths_end(const struct facts *facts, char *because) {
    if (facts->scene->paths.max_depth > 0) return false;
    says(because, false, "paths end at the first surface");
    return true;
}

static bool is_mirror(const struct scene *scene, const struct scene_material *m) {
    (void)scene;
    return m->model == MODEL_MIRROR ? any_positive(m->diffuse) : m->model <= MODEL_LAMBERT && any_positive(m->reflection);
}
static bool rule_REFLECTION(const struct facts *facts, char *because) {
    return !paths_end(facts, because) && material_calls(facts, is_mirror, "no material in use is a mirror", because);
}

// An index of 1 calls for refraction, too: its light goes straight on, but no light sample comes through, as through any glass.
static bool is_glass(const struct scene *scene, const struct scene_material *m) {
    (void)scene;
    return m->model == MODEL_DIELECTRIC;
}
static bool rule_REFRACTION(const struct facts *facts, char *because) {
    return !paths_end(facts, because) && material_calls(facts, is_glass, "no material in use is a dielectric", because);
}

static bool absorbs(const struct scene *scene, const struct scene_material *m) { return is_glass(scene, m) && !m->thin && any_positive(m->absorption); }
static bool rule_ABSORPTION(const struct facts *facts, char *because) {
    return !paths_end(facts, because) && material_calls(facts, absorbs, "no dielectric in use takes light away", because);
}

static bool rule_INDIRECT(const struct facts *facts, char *because) {
    if (!facts->scene->paths.indirect) return says(because, false, "the scene does not ask for indirect light");
    return !paths_end(facts, because) && says(because, true, "the scene asks for indirect light, paths of %u", facts->scene->paths.max_depth);
}

static bool rule_FOG(const struct facts *facts, char *because) {
    if (!(facts->scene->fog.density > 0)) return says(because, false, "there is no medium");
    return says(because, true, "a density of %g", facts->scene->fog.density);
}

// -------------------------------------------------------------------------------------------------------------------- plan

static const struct {
    const char *name;
    bool (*rule)(const struct facts *, char *);
} effects[EFFECT_COUNT] = {
#define X(number, id, name, text) [number] = {name, rule_##id},
    EFFECTS(X)
#undef X
};

const char *effect_name(uint32_t effect) { return effect < EFFECT_COUNT ? effects[effect].name : ""; }

void effect_names(uint32_t bits, char *text, size_t capacity) {
    size_t used = 0;
    if (capacity) text[0] = '\0';
    for (uint32_t i = 0; i < EFFECT_COUNT; i++)
        if (bits >> i & 1 && used < capacity)
            used += (size_t)snprintf(text + used, capacity - used, "%s%s", used ? "," : "", effects[i].name);
}

static bool parse_one(uint32_t *bits, struct context *ctx, const char *name, size_t length) {
    char all[512], wanted[64];
    snprintf(wanted, sizeof wanted, "%.*s", (int)(length < 60 ? length : 60), name);
    struct nearest nearest = nearest_to(wanted);
    for (uint32_t i = 0; i < EFFECT_COUNT; i++) {
        if (strcmp(wanted, effects[i].name) == 0) {
            *bits |= 1u << i;
            return true;
        }
        nearest_offer(&nearest, effects[i].name);
    }
    effect_names(ALL_EFFECTS, all, sizeof all);
    return fail(ctx, GN_USAGE, "'%s' is no effect, expected some of: %s%s", excerpt_word(wanted).text, all, nearest_hint(&nearest).text);
}

static bool parse_effects(uint32_t *bits, struct context *ctx, const char *list) {
    *bits = 0;
    for (const char *at = list; at && *at;) {
        const size_t length = strcspn(at, ",");
        if (!parse_one(bits, ctx, at, length)) return false;
        at += length;
        if (*at == ',' && at[1] == '\0') return parse_one(bits, ctx, "", 0);
        at += *at == ',';
    }
    return true;
}

bool plan_make(struct plan *out, struct context *ctx, const struct scene *scene, const struct plan_params *params) {
    *out = (struct plan){0};
    uint32_t disabled, only;
    struct facts facts;
    if (!parse_effects(&disabled, ctx, params->disable) || !parse_effects(&only, ctx, params->only)) return false;
    if (params->only && *params->only) disabled |= ALL_EFFECTS & ~(only | EFFECTS_OF_GEOMETRY);
    if (!facts_init(&facts, ctx, scene, disabled, params->spp)) return false;
    for (uint32_t i = 0; i < EFFECT_COUNT; i++) {
        bool on = effects[i].rule(&facts, out->because[i]);
        if (on && disabled & 1u << i & EFFECT_BVH) {
            free(facts.used_by);
            return fail(ctx, GN_USAGE, "effect 'bvh' cannot be disabled here (%s): it changes no picture, and nothing is hit without it", out->because[i]);
        }
        if (disabled >> i & 1)
            on = says(out->because[i], false, "disabled on request");
        else if (on)
            facts.effects |= 1u << i;
        else if (params->no_prune)
            on = says(out->because[i], true, "pruning is switched off");
        if (on) out->effects |= 1u << i;
    }
    free(facts.used_by);
    return true;
}
