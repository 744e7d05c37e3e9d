// Rows of whole pictures: small scenes through the renderer, whose pixels have a known answer.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bvh/scene_boxes.h"
#include "effects/plan.h"
#include "measure/stress/row.h"
#include "render/render.h"

// A scene for pictures. Zeroed is empty.
struct studio {
    struct world world;
    struct scene scene;
    struct bvh bvh;
};

static void studio_finish(struct studio *studio) {
    world_finish(&studio->world);
    scene_finish(&studio->scene);
    bvh_finish(&studio->bvh);
}

// The scene of studio->world, of one material, white and matt, with `lights` white lights at the origin.
static bool studio_make(struct studio *studio, struct stress *s, uint32_t lights) {
    struct scene *scene = &studio->scene;
    if (!world_ok(&studio->world, s->ctx) || !world_scene(scene, s->ctx, &studio->world) || !bvh_build_scene(&studio->bvh, s->ctx, scene))
        return false;
    scene->lights = array_alloc(s->ctx, lights, sizeof *scene->lights, "lights");
    scene->materials[0].name = strdup("white");
    if (!scene->lights || !scene->materials[0].name) return fail(s->ctx, GN_LIMIT, "no memory for a picture's scene");
    scene->light_count = lights;
    for (int k = 0; k < 3; k++) {
        scene->materials[0].diffuse[k] = 1;
        for (uint32_t i = 0; i < lights; i++) scene->lights[i].intensity[k] = 1;
    }
    return true;
}

static bool photograph(struct render_film *out, struct stress *s, const struct studio *studio, const struct render_params *wish) {
    struct render_params params = *wish;
    struct plan plan;
    if (!plan_make(&plan, s->ctx, &studio->scene, &(struct plan_params){.spp = params.spp})) return false;
    params.effects = plan.effects;
    return render_picture(out, s->ctx, s->device, &studio->scene, &studio->bvh, &params);
}

static void look(struct scene *scene, const float from[3], const float at[3], float fov_y_deg) {
    memcpy(scene->camera.position, from, 3 * sizeof *from);
    memcpy(scene->camera.look_at, at, 3 * sizeof *at);
    scene->camera.fov_y_deg = fov_y_deg;
}

// ---------------------------------------------------------------------------------------------------------------- normals

// Gives the first mesh of the scene these vertex normals.
static bool set_normals(struct studio *studio, struct stress *s, const float (*normals)[3]) {
    struct scene_mesh *mesh = &studio->scene.shapes[0].mesh;
    mesh->normals = array_alloc(s->ctx, mesh->vertex_count, sizeof *normals, "normals");
    if (mesh->normals) memcpy(mesh->normals, normals, 3 * sizeof *normals);
    return mesh->normals != NULL;
}

// A triangle in the plane z = 0 seen along -z by one pixel whose ray meets it at `at`, and far below it another, so that there may be
// shadows.
static bool triangle_studio(struct studio *studio, struct stress *s, const float (*normals)[3], const float at[2], const float light[3]) {
    world_lone_triangle(&studio->world, (float[9]){-1, -1, 0, 1, -1, 0, 0, 1, 0});
    studio->world.mesh = 1;
    world_lone_triangle(&studio->world, (float[9]){-1, -1, -9, 1, -1, -9, 0, 1, -9});
    if (!studio_make(studio, s, 1) || !set_normals(studio, s, normals)) return false;
    look(&studio->scene, (float[3]){at[0], at[1], 4}, (float[3]){at[0], at[1], 0}, 1);
    memcpy(studio->scene.lights[0].position, light, sizeof studio->scene.lights[0].position);
    return true;
}

struct normal_case {
    float normals[3][3], light[3];
    double normal[3], color;
};

static bool judge_normal(struct stress *s, const struct normal_case *c) {
    const float middle[2] = {0, 0}; // weighs the vertices 1/4, 1/4, 1/2
    struct studio studio = {0};
    bool done = triangle_studio(&studio, s, c->normals, middle, c->light);
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        struct render_film film = {0};
        if (!s->judged[tier]) continue;
        done =
            photograph(&film, s, &studio, &(struct render_params){.width = 1, .height = 1, .spp = 1, .tier = tier, .aovs = GN_AOV_NORMAL});
        struct tally *tally = &s->tally[tier];
        tally->rays++;
        const float *n = done ? film.normal.pixels : (float[3]){0}, *color = done ? film.color.pixels : n;
        bool right = fabs(color[0] - c->color) <= 1e-5;
        for (int k = 0; k < 3; k++) right = right && fabs(n[k] - c->normal[k]) <= 1e-5;
        if (done && !right)
            tally_wrong(tally, "right: normal (%g, %g, %g), %g; got (%g, %g, %g), %g", c->normal[0], c->normal[1], c->normal[2], c->color,
                        n[0], n[1], n[2], color[0]);
        render_film_finish(&film);
    }
    studio_finish(&studio);
    return done;
}

// H08: where vertex normals cancel, the geometric normal stands in.
bool pictures_no_normal(struct stress *s) {
    static const struct normal_case cases[] = {
        {{{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}}, {0, 0, 8}, {0, 0, 1}, 1},
        {{{1, 2, 3}, {1, 2, 3}, {-1, -2, -3}}, {0, 0, 8}, {0, 0, 1}, 1},
        {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {0, 0, 8}, {0, 0, 1}, 1},
        {{{0, 0, 1e-30f}, {0, 0, 1e-30f}, {0, 0, 1e-30f}}, {0, 0, 8}, {0, 0, 1}, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (!judge_normal(s, &cases[i])) return false;
    return true;
}

// H09: the shading normal n alone says whether a light counts, once it is turned to the viewer's side of the surface; the geometric one
// says from which side the shadow ray starts, and its own triangle stands in no light's way.
bool pictures_two_normals(struct stress *s) {
    const float a = 0.6f, b = 0.8f;
    const struct normal_case cases[] = {
        {{{b, 0, a}, {b, 0, a}, {b, 0, a}}, {-8, 0, 1}, {b, 0, a}, 0},                           // Ng·L > 0, N·L < 0: dark
        {{{b, 0, a}, {b, 0, a}, {b, 0, a}}, {8, 0, -1}, {b, 0, a}, (8 * b - a) / sqrt(65)},      // Ng·L < 0, N·L > 0: lit
        {{{-b, 0, -a}, {-b, 0, -a}, {-b, 0, -a}}, {8, 0, 1}, {b, 0, a}, (8 * b + a) / sqrt(65)}, // a normal from the other side is turned
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (!judge_normal(s, &cases[i])) return false;
    return true;
}

// H10: a light in the surface, or 1e-20 from it. Every pixel is a number; a sample that is not is dropped and counted.
bool pictures_light_on_surface(struct stress *s) {
    struct studio studio = {0};
    world_lone_triangle(&studio.world, (float[9]){-1, -1, 0, 1, -1, 0, 0, 1, 0});
    bool done = studio_make(&studio, s, 2);
    if (done) {
        look(&studio.scene, (float[3]){0, 0, 4}, (float[3]){0, 0, 0}, 20);
        studio.scene.lights[0].falloff = studio.scene.lights[1].falloff = FALLOFF_INVERSE_SQUARE;
        studio.scene.lights[1].position[2] = 1e-20f;
    }
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        enum { SIDE = 9 };
        struct render_film film = {0};
        if (!s->judged[tier]) continue;
        done = photograph(&film, s, &studio, &(struct render_params){.width = SIDE, .height = SIDE, .spp = 1, .tier = tier});
        for (int i = 0; done && i < 3 * SIDE * SIDE; i++) {
            s->tally[tier].rays++;
            if (!isfinite(film.color.pixels[i])) tally_wrong(&s->tally[tier], "pixel %d is %g", i / 3, film.color.pixels[i]);
        }
        render_film_finish(&film);
    }
    studio_finish(&studio);
    return done;
}

// -------------------------------------------------------------------------------------------------------------- same bits

// Edges, vertices, shadows and spheres, so that the exact tier has something to ask for.
static bool busy_studio(struct studio *studio, struct stress *s) {
    struct world *w = &studio->world;
    for (int y = 0; y <= 8; y++)
        for (int x = 0; x <= 8; x++) world_vertex(w, 0.25 * (x - 4), 0.25 * (y - 4), -2 - 0.125 * ((5 * x + 3 * y) % 4));
    for (uint32_t y = 0; y < 8; y++)
        for (uint32_t x = 0; x < 8; x++) {
            uint32_t a = 9 * y + x;
            world_triangle(w, a, a + 1, a + 10);
            world_triangle(w, a, a + 10, a + 9);
        }
    world_sphere(w, (float[3]){0.3f, 0.2f, -1.7f}, 0.25f);
    if (!studio_make(studio, s, 2)) return false;
    memcpy(studio->scene.lights[0].position, (float[3]){1, 2, 1}, 3 * sizeof(float));
    memcpy(studio->scene.lights[1].position, (float[3]){-3, 0.5f, -1.5f}, 3 * sizeof(float));
    look(&studio->scene, (float[3]){0, 0, 0}, (float[3]){0, 0, -1}, 70);
    return true;
}

// Renders with `tile_pixels` and CPU threads, and holds the picture against *first, which the first call fills.
static bool compare_picture(struct stress *s, const struct studio *studio, uint32_t tier, uint32_t tile_pixels, unsigned threads,
                            struct render_film *first) {
    const struct render_params params = {
        .width = 60, .height = 44, .spp = 3, .seed = 5, .tier = tier, .tile_pixels = tile_pixels, .aovs = GN_AOV_ID};
    struct render_film film = {0};
    const unsigned threads_before = s->ctx->host.threads;
    s->ctx->host.threads = threads;
    bool done = photograph(&film, s, studio, &params);
    s->ctx->host.threads = threads_before;
    if (done && first->color.pixels) {
        const size_t numbers = 3 * (size_t)params.width * params.height;
        for (size_t i = 0; i < numbers; i++) {
            s->tally[tier].rays++;
            if (memcmp(&film.color.pixels[i], &first->color.pixels[i], sizeof(float)) != 0)
                tally_wrong(&s->tally[tier], "pieces of %u pixels, %u threads: pixel %zu was %.9g, is %.9g", tile_pixels, threads, i / 3,
                            first->color.pixels[i], film.color.pixels[i]);
        }
    } else if (done) {
        *first = film;
        return true;
    }
    render_film_finish(&film);
    return done;
}

struct way {
    uint32_t tile_pixels;
    unsigned threads;
};

static bool same_bits(struct stress *s, const struct way *ways, size_t count) {
    struct studio studio = {0};
    bool done = busy_studio(&studio, s);
    for (uint32_t tier = 0; done && tier < TIER_COUNT; tier++) {
        struct render_film first = {0};
        for (size_t i = 0; done && s->judged[tier] && i < count; i++)
            done = compare_picture(s, &studio, tier, ways[i].tile_pixels, ways[i].threads, &first);
        render_film_finish(&first);
    }
    studio_finish(&studio);
    return done;
}

// A09: again and again.
bool pictures_run_to_run(struct stress *s) { return same_bits(s, (struct way[]){{0, 0}, {0, 0}, {0, 0}}, 3); }

// A12: in pieces of any size, with any number of threads.
bool pictures_tiles_and_threads(struct stress *s) {
    return same_bits(s, (struct way[]){{0, 0}, {64, 1}, {192, 2}, {1000, 3}, {100000, 1}}, 5);
}
