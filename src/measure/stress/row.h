// What a row of the table is, and what its functions are given.
#ifndef MEASURE_STRESS_ROW_H
#define MEASURE_STRESS_ROW_H

#include "measure/stress/stress.h"
#include "measure/stress/world.h"

// What came of a row at one tier, so far.
struct tally {
    uint64_t rays, wrong, leaks;
    uint64_t scaled, shaken; // decisions that another scale, another hierarchy changed
    double ulps;             // largest error of a t, in fp32 places
    double error;            // largest relative error of a number
    double ms;
    char note[160];  // what there is to say beside the numbers
    char first[200]; // the first wrong one
};

// With fewer rays than this to shoot at a row, what has a size of its own is smaller, too, and fewer kernels are made.
#define FEW_RAYS 5000u

struct row;

// A run of one row.
struct stress {
    struct context *ctx;
    struct device *device;
    const struct row *row;
    struct random random;    // the row's own: from the seed and its id
    uint32_t rays;           // to be shot at each tier, about
    bool judged[TIER_COUNT]; // tiers that are asked for, and that the device has
    struct tally tally[TIER_COUNT];
};

struct row {
    const char *id, *text;
    const char *waits; // for what; NULL: it is run
    bool (*run)(struct stress *s);
    bool (*also)(struct stress *s); // what is run after that, for the same tally [nothing]
    void (*fill)(struct world *world, struct random *random, uint32_t rays, uint32_t part); // for run_rays: shapes and rays of a part
    uint32_t parts;                                                                         // [1]
    uint32_t flags;                                                                         // RAYS_*
    uint32_t limit[TIER_COUNT];  // wrong ones per million that are known and accepted; those of the tier `exact` are always 0
    uint32_t leaks[TIER_COUNT];  // the same of leaks
    uint32_t shaken[TIER_COUNT]; // and of decisions that another hierarchy changes
};

// For run_rays, run_leave.
#define RAYS_AS_THEY_ARE 1u // the numbers are the case: no fuzz
#define RAYS_CLOSED 2u      // no ray is aimed at a free edge: leaks are counted

#define LEAVE_GRAZING 4u // second rays at a cosine of 1e-3

extern const struct row rows[];
extern const uint32_t row_count;

// Remembers a wrong one: counts it, and says of the first what it was.
void tally_wrong(struct tally *tally, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The same result for every tier that is judged: for what is the same code in all.
void tally_every(struct stress *s, const struct tally *tally);

// ------------------------------------------------------------------------------------------------- the kinds of rows
// Each is a value of row.run or row.also.
bool run_rays(struct stress *s);  // rays at a world, closest hit and occlusion, with all the variants (rays.c)
bool run_leave(struct stress *s); // rays that leave a surface (leave.c)

// Boxes alone (boxes.c).
bool boxes_thin(struct stress *s);
bool boxes_points(struct stress *s);
bool boxes_perturbed(struct stress *s);
bool boxes_from_afar(struct stress *s);
bool boxes_next_to_nothing(struct stress *s);
bool boxes_origin_on(struct stress *s);

// Functions of the shaders (numbers.c).
bool numbers_opposite_light(struct stress *s);
bool numbers_power_of_nothing(struct stress *s);
bool numbers_power_below_zero(struct stress *s);
bool numbers_over_one(struct stress *s);
bool numbers_power_near_one(struct stress *s);
bool numbers_own_power_near_one(struct stress *s);
bool numbers_any_length(struct stress *s);
bool numbers_light_at_point(struct stress *s);
bool numbers_light_far_away(struct stress *s);
bool numbers_random(struct stress *s);
bool numbers_last_pixel(struct stress *s);
bool numbers_disk(struct stress *s);
bool numbers_lens(struct stress *s);

// Shading (shading.c) and glass (glass.c).
bool shading_frames(struct stress *s);
bool shading_mirrors(struct stress *s);
bool shading_facets(struct stress *s);
bool shading_grazing(struct stress *s);
bool shading_lobes(struct stress *s);
bool glass_near_critical(struct stress *s);
bool glass_critical(struct stress *s);
bool glass_small_sines(struct stress *s);
bool glass_no_change(struct stress *s);
bool glass_least_change(struct stress *s);
bool glass_grazing_in(struct stress *s);
bool glass_total_reflection(struct stress *s);
bool glass_grazing_out(struct stress *s);
bool glass_round_trips(struct stress *s);
bool glass_what_is_left(struct stress *s);

// Directions, and places in pictures (places.c).
bool places_picked(struct stress *s);
bool places_small_light(struct stress *s);
bool places_hemisphere(struct stress *s);
bool places_near_pole(struct stress *s);
bool places_seam(struct stress *s);
bool places_pole(struct stress *s);
bool places_latitudes(struct stress *s);
bool places_below_zero(struct stress *s);
bool places_large(struct stress *s);
bool places_checker(struct stress *s);
bool places_centers(struct stress *s);
bool places_no_area(struct stress *s);

// Samples and pixels (film.c).
bool film_many_ones(struct stress *s);
bool film_tenths(struct stress *s);
bool film_counts(struct stress *s);
bool film_small_terms(struct stress *s);
bool film_bad_samples(struct stress *s);
bool film_srgb(struct stress *s);
bool film_bad_output(struct stress *s);

// Whole pictures (pictures.c).
bool pictures_no_normal(struct stress *s);
bool pictures_two_normals(struct stress *s);
bool pictures_light_on_surface(struct stress *s);
bool pictures_run_to_run(struct stress *s);
bool pictures_tiles_and_threads(struct stress *s);

// The camera (cameras.c).
bool cameras_wide(struct stress *s);
bool cameras_narrow(struct stress *s);
bool cameras_up_along_view(struct stress *s);

// Before any ray (loading.c).
bool loading_radius(struct stress *s);
bool loading_vertices(struct stress *s);
bool loading_uneven_scale(struct stress *s);
bool loading_mirror(struct stress *s);
bool loading_singular(struct stress *s);

// Hierarchies (hierarchies.c).
bool hierarchies_same_hits(struct stress *s);
bool hierarchies_lanes(struct stress *s);
bool hierarchies_sound_nodes(struct stress *s);
bool hierarchies_coincident(struct stress *s);
bool hierarchies_along_axes(struct stress *s);

// Closed meshes (watertight.c).
bool watertight_escapes(struct stress *s);
bool watertight_parity(struct stress *s);

// The exact tier's filter (filters.c).
bool filters_perturbed(struct stress *s);
bool filters_any_rounding(struct stress *s);

#endif
