// Camera rays through a lens and in motion: the device's against the reference's, bit by bit, and both against what a lens and a motion are.
#include "fixture.h"

#include <math.h>

#include "render/camera.h"
#include "twin_camera_ray.h"

#define CASES 8192
#define WIDTH 640
#define HEIGHT 360

static uint32_t random_state = 1;

static uint32_t random_bits(void) {
    random_state = random_state * 747796405u + 2891336453u;
    uint32_t word = ((random_state >> ((random_state >> 28) + 4)) ^ random_state) * 277803737u;
    return (word >> 22) ^ word;
}

static float random_unit(void) { return (float)(random_bits() >> 8) * 0x1p-24f; }
static float random_in(float low, float high) { return low + (high - low) * random_unit(); }

// A random number, often a nasty one.
static float nasty_unit(void) {
    static const float nasty[] = {0, 0x1p-24f, 0.25f, 0.5f - 0x1p-24f, 0.5f, 0.5f + 0x1p-24f, 0.75f, 1 - 0x1p-24f};
    return random_bits() % 2 ? random_unit() : nasty[random_bits() % 8];
}

static struct scene_camera random_camera(void) {
    struct scene_camera camera = {.up = {0, 1, 0}, .fov_y_deg = random_in(10, 120), .lens_radius = random_in(0, 0.5f), .focus_distance = random_in(0.5f, 20)};
    camera.moves = true;
    for (int i = 0; i < 3; i++) {
        camera.position[i] = random_in(-3, 3);
        camera.look_at[i] = random_in(-3, 3);
        camera.position_end[i] = camera.position[i] + random_in(-1, 1);
        camera.look_at_end[i] = camera.look_at[i] + random_in(-1, 1);
    }
    return camera;
}

static struct camera_rays rays_of(const struct scene_camera *camera) {
    struct camera_rays rays;
    camera_rays_make(&rays, camera, WIDTH, HEIGHT);
    return rays;
}

static struct camera_sample random_sample(float u[2]) {
    struct camera_sample sample = {.offset = {random_in(-1, 2), random_in(-1, 2)}, .time = nasty_unit()};
    u[0] = nasty_unit();
    u[1] = nasty_unit();
    camera_disk_point(sample.lens, u);
    return sample;
}

// -------------------------------------------------------------------------------------------------------------------- twins

static float in[CASES * 34], out[CASES * 8];

static void fill_case(float *to, const struct camera_rays *rays, uint32_t x, uint32_t y, const struct camera_sample *sample, const float u[2]) {
    float frames = sample->time * CAMERA_FRAMES;
    int first = (int)frames;
    memcpy(to, &rays->frames[first], 18 * sizeof *to);
    to[18] = frames - (float)first;
    memcpy(to + 19, rays->position, sizeof rays->position);
    memcpy(to + 22, rays->travel, sizeof rays->travel);
    const float rest[] = {sample->time, rays->lens, rays->aim, (float)x, (float)y, sample->offset[0], sample->offset[1], u[0], u[1]};
    memcpy(to + 25, rest, sizeof rest);
}

// The direction as hardware that fuses would make it, for the control.
static float fused(const float *c, int k) {
    float corner = fmaf(c[18], c[9 + k] - c[k], c[k]), du = fmaf(c[18], c[12 + k] - c[3 + k], c[3 + k]), dv = fmaf(c[18], c[15 + k] - c[6 + k], c[6 + k]);
    return fmaf(c[29], dv, fmaf(c[28], du, corner)) + fmaf(c[30], du, c[31] * dv);
}

static void device_has_the_same_bits(void **state) {
    (void)state;
    static float right[CASES * 8];
    uint32_t contracted = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        const struct scene_camera camera = random_camera();
        const struct camera_rays rays = rays_of(&camera);
        float u[2];
        const struct camera_sample sample = random_sample(u);
        const uint32_t x = random_bits() % WIDTH, y = random_bits() % HEIGHT;
        const struct gn_ray ray = camera_ray(&rays, x, y, &sample);
        fill_case(in + 34 * i, &rays, x, y, &sample, u);
        memcpy(right + 8 * i, ray.origin, sizeof ray.origin);
        memcpy(right + 8 * i + 3, ray.direction, sizeof ray.direction);
        memcpy(right + 8 * i + 6, sample.lens, sizeof sample.lens);
        const struct gn_ray pinhole = camera_ray(&rays, x, y, &(struct camera_sample){.offset = {sample.offset[0], sample.offset[1]}, .time = sample.time});
        for (int k = 0; k < 3; k++) contracted += fused(in + 34 * i, k) != pinhole.direction[k];
    }
    fixture_run(&(struct fixture_job){
        FIXTURE_KERNEL(twin_camera_ray), .in = in, .in_bytes = sizeof in, .out = out, .out_bytes = sizeof out, .count = CASES});
    for (uint32_t i = 0; i < CASES * 8; i++)
        if (memcmp(&out[i], &right[i], sizeof *out) != 0) fail_msg("case %u, number %u: %a, expected %a", i / 8, i % 8, out[i], right[i]);
    assert_true(contracted > CASES);
}

// --------------------------------------------------------------------------------------------------------------------- disk

// Shirley and Chiu's map.
static void disk_map(double point[2], const float u[2]) {
    const double a = 2.0 * u[0] - 1, b = 2.0 * u[1] - 1, quarter = atan(1);
    const bool wide = fabs(a) > fabs(b);
    const double r = wide ? a : b, angle = r == 0 ? 0 : wide ? quarter * b / a : 2 * quarter - quarter * a / b;
    point[0] = r * cos(angle);
    point[1] = r * sin(angle);
}

static void disk_is_the_map(void **state) {
    (void)state;
    double worst = 0, largest = 0, other = 0;
    for (int i = 0; i < 200000; i++) {
        const float u[2] = {nasty_unit(), nasty_unit()};
        float point[2];
        double right[2];
        camera_disk_point(point, u);
        disk_map(right, u);
        for (int k = 0; k < 2; k++) worst = fmax(worst, fabs(point[k] - right[k]));
        if (!(isfinite(point[0]) && isfinite(point[1]))) fail_msg("at %a, %a: %g, %g", u[0], u[1], point[0], point[1]);
        largest = fmax(largest, hypot(point[0], point[1]));
        other = fmax(other, fabs(point[0] - right[1]));
    }
    if (!(worst <= 3e-7)) fail_msg("off by %g", worst);
    if (!(largest <= 1 + 3e-7)) fail_msg("as far from the middle as 1 + %g", largest - 1);
    assert_true(other > 0.1);
    float middle[2];
    camera_disk_point(middle, (const float[]){0.5f, 0.5f});
    assert_true(middle[0] == 0 && middle[1] == 0);
}

// Chi-squared of 2^18 points over 256 cells of equal area, 255 degrees of freedom: from 163 to 374 with a probability of 1 - 1e-5. `power` of the distance from
// the middle is even in a disk for 2.
static double disk_chi_squared(double power) {
    enum { COUNT = 1 << 18, SIDE = 16 };
    static double cells[SIDE * SIDE];
    memset(cells, 0, sizeof cells);
    for (int i = 0; i < COUNT; i++) {
        const float u[2] = {random_unit(), random_unit()};
        float point[2];
        camera_disk_point(point, u);
        const double ring = pow(fmin(hypot(point[0], point[1]), 1 - 1e-9), power), turn = (atan2(point[1], point[0]) + 4 * atan(1)) / (8 * atan(1));
        cells[(int)(ring * SIDE) * SIDE + (int)fmin(turn * SIDE, SIDE - 1)]++;
    }
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++) sum += (cells[i] - COUNT / 256.0) * (cells[i] - COUNT / 256.0) / (COUNT / 256.0);
    return sum;
}

static void disk_is_even(void **state) {
    (void)state;
    const double chi = disk_chi_squared(2), control = disk_chi_squared(1.95);
    if (!(chi > 163 && chi < 374)) fail_msg("chi-squared is %g", chi);
    assert_false(control > 163 && control < 374);
}

// --------------------------------------------------------------------------------------------------------------------- lens

// How far from where the pinhole's ray is at `distance` along the view the lens's is, over the lens's radius.
static double miss(const struct scene_camera *camera, double distance) {
    const struct camera_rays rays = rays_of(camera);
    double worst = 0;
    for (int i = 0; i < 64; i++) {
        float u[2];
        struct camera_sample sample = random_sample(u);
        const struct gn_ray ray = camera_ray(&rays, 200, 50, &sample);
        sample.lens[0] = sample.lens[1] = 0;
        const struct gn_ray middle = camera_ray(&rays, 200, 50, &sample);
        for (int k = 0; k < 3; k++) {
            const double at = ray.origin[k] + distance * ray.direction[k], right = middle.origin[k] + distance * middle.direction[k];
            worst = fmax(worst, fabs(at - right));
        }
    }
    return worst / camera->lens_radius;
}

// All rays of a film position meet on the plane of focus, up to the rounding of origin and direction; and not a hundredth before it.
static void rays_meet_in_focus(void **state) {
    (void)state;
    for (int i = 0; i < 256; i++) {
        struct scene_camera camera = random_camera();
        camera.lens_radius = random_in(0.1f, 0.5f);
        const double off = miss(&camera, camera.focus_distance), before = miss(&camera, 0.99 * camera.focus_distance);
        if (!(off <= 1e-4)) fail_msg("camera %d: off by %g of the lens", i, off);
        assert_true(before > 3e-3);
    }
}

static bool same_ray(const struct gn_ray *a, const struct gn_ray *b) {
    for (int k = 0; k < 3; k++)
        if (a->origin[k] != b->origin[k] || a->direction[k] != b->direction[k]) return false;
    return true;
}

// C05, and a focus that is nowhere: finite, and without a radius the pinhole's ray, to the bit.
static void no_lens_is_a_pinhole(void **state) {
    (void)state;
    static const float distances[] = {0, 1e-30f, 1e-6f, 1, 1e30f, INFINITY};
    uint32_t blurred = 0;
    for (int i = 0; i < 6 * 256; i++) {
        struct scene_camera camera = random_camera();
        float u[2];
        struct camera_sample sample = random_sample(u), middle = sample;
        middle.lens[0] = middle.lens[1] = 0;
        camera.focus_distance = distances[i % 6];
        const struct camera_rays wide = rays_of(&camera);
        camera.lens_radius = 0;
        const struct camera_rays none = rays_of(&camera);
        const struct gn_ray through = camera_ray(&none, 3, 5, &sample), pinhole = camera_ray(&none, 3, 5, &middle), other = camera_ray(&wide, 3, 5, &sample);
        if (!same_ray(&through, &pinhole)) fail_msg("case %d: a lens of radius 0 is no pinhole", i);
        for (int k = 0; k < 3; k++)
            if (!isfinite(other.origin[k]) || !isfinite(other.direction[k])) fail_msg("case %d: focus at %g gives a ray that is not finite", i, distances[i % 6]);
        blurred += !same_ray(&other, &pinhole);
    }
    assert_true(blurred > 6 * 128);
}

// ------------------------------------------------------------------------------------------------------------------- motion

// When the shutter opens a camera is where it would stand still, and one that stands still is there all the time.
static void still_is_still(void **state) {
    (void)state;
    uint32_t moved = 0;
    for (int i = 0; i < 512; i++) {
        struct scene_camera camera = random_camera();
        const struct camera_rays moving = rays_of(&camera);
        camera.moves = false;
        const struct camera_rays still = rays_of(&camera);
        float u[2];
        struct camera_sample sample = random_sample(u), open = sample;
        open.time = 0;
        const struct gn_ray a = camera_ray(&still, 7, 9, &open), b = camera_ray(&moving, 7, 9, &open);
        const struct gn_ray c = camera_ray(&still, 7, 9, &sample), d = camera_ray(&moving, 7, 9, &sample);
        if (!same_ray(&a, &b)) fail_msg("camera %d: not the same when the shutter opens", i);
        if (!same_ray(&a, &c)) fail_msg("camera %d stands still and does not", i);
        moved += sample.time > 0 && !same_ray(&a, &d);
    }
    assert_true(moved > 256);
}

// Where the camera is at some time, as a camera of its own.
static struct scene_camera camera_at(const struct scene_camera *camera, double time) {
    struct scene_camera at = *camera;
    at.moves = false;
    for (int i = 0; i < 3; i++) {
        at.position[i] = (float)(camera->position[i] + time * ((double)camera->position_end[i] - camera->position[i]));
        at.look_at[i] = (float)(camera->look_at[i] + time * ((double)camera->look_at_end[i] - camera->look_at[i]));
    }
    return at;
}

// The angle between two directions, from their difference over the length of the first.
static double angle(const float a[3], const float b[3]) {
    double difference = 0, length = 0;
    for (int k = 0; k < 3; k++) difference += ((double)a[k] - b[k]) * ((double)a[k] - b[k]), length += (double)a[k] * a[k];
    return sqrt(difference / length);
}

// A camera that turns by up to about 20 degrees while the shutter is open: a hundredth of a pixel at most, here.
static void motion_is_between(void **state) {
    (void)state;
    uint32_t far = 0;
    for (int i = 0; i < 512; i++) {
        struct scene_camera camera = random_camera();
        camera.lens_radius = 0;
        camera.fov_y_deg = 60;
        camera.position[2] = 6, camera.position_end[2] = 6;
        const struct camera_rays rays = rays_of(&camera);
        const struct camera_sample sample = {.offset = {0.5f, 0.5f}, .time = random_unit()};
        const struct scene_camera at = camera_at(&camera, sample.time);
        const struct camera_rays right_rays = rays_of(&at), first = rays_of(&camera);
        const struct gn_ray got = camera_ray(&rays, 500, 300, &sample), right = camera_ray(&right_rays, 500, 300, &sample);
        for (int k = 0; k < 3; k++)
            if (!(fabsf(got.origin[k] - right.origin[k]) <= 1e-6f)) fail_msg("camera %d is at %g, expected %g", i, got.origin[k], right.origin[k]);
        const double off = angle(right.direction, got.direction);
        if (!(off <= 2e-5)) fail_msg("camera %d: the ray is off by %g", i, off);
        const struct gn_ray start = camera_ray(&first, 500, 300, &(struct camera_sample){.offset = {0.5f, 0.5f}});
        far += angle(right.direction, start.direction) > 2e-3;
    }
    assert_true(far > 256);
}

// A camera that flies through what it looks at, and one that turns around: there is a view at every time.
static void every_view_is_one(void **state) {
    (void)state;
    const struct scene_camera cameras[] = {
        {.position = {0, 0, 1}, .position_end = {0, 0, -1}, .up = {0, 1, 0}, .fov_y_deg = 90, .moves = true},
        {.position = {1, 2, 3}, .position_end = {1, 2, 3}, .look_at = {1, 2, 2}, .look_at_end = {1, 2, 4}, .up = {0, 1, 0}, .fov_y_deg = 90, .moves = true},
        {.look_at = {0, 1, -1}, .look_at_end = {0, 1, 1}, .up = {0, 1, 0}, .fov_y_deg = 90, .moves = true},
    };
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        const struct camera_rays rays = rays_of(&cameras[i]);
        for (int k = 0; k <= CAMERA_FRAMES; k++) {
            float numbers[9];
            memcpy(numbers, &rays.frames[k], sizeof numbers);
            for (int j = 0; j < 9; j++)
                if (!isfinite(numbers[j])) fail_msg("camera %zu, frame %d is not finite", i, k);
        }
    }
}

// Measured from another point the rays are the same, but for the rounding of their origins.
static void base_moves_origins_alone(void **state) {
    (void)state;
    struct scene_camera camera = random_camera();
    for (int i = 0; i < 3; i++) {
        camera.position[i] = 4096 + (float)i;
        camera.position_end[i] = camera.position[i] + 1;
        camera.look_at[i] = camera.look_at_end[i] = 4100;
    }
    const float base[3] = {4098, 4098, 0};
    struct camera_rays world = rays_of(&camera), rebased = world;
    camera_rays_rebase(&rebased, base);
    for (int i = 0; i < 64; i++) {
        float u[2];
        const struct camera_sample sample = random_sample(u);
        const struct gn_ray a = camera_ray(&world, 1, 2, &sample), b = camera_ray(&rebased, 1, 2, &sample);
        for (int k = 0; k < 3; k++) {
            assert_true(a.direction[k] == b.direction[k]);
            assert_true(fabs(a.origin[k] - ((double)b.origin[k] + rebased.base[k])) <= 4100 * 0x1p-23);
        }
    }
    assert_true(rebased.position[0] == -2 && rebased.position[2] == 4098);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(device_has_the_same_bits),
        cmocka_unit_test(disk_is_the_map),
        cmocka_unit_test(disk_is_even),
        cmocka_unit_test(rays_meet_in_focus),
        cmocka_unit_test(no_lens_is_a_pinhole),
        cmocka_unit_test(still_is_still),
        cmocka_unit_test(motion_is_between),
        cmocka_unit_test(every_view_is_one),
        cmocka_unit_test(base_moves_origins_alone),
        cmocka_unit_test(fixture_silent),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_close);
}
