// Pictures: the film in bands of rows, each band's samples in chunks, each chunk in pieces of tiles; every piece goes on where the pixels are, so that a piece
// can be dispatched again when some of its invocations ran out of steps.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "render/kernels.h"
#include "render/camera.h"
#include "render/pending.h"
#include "render/pieces.h"
#include "render/render.h"
#include "render/upload.h"
#include "render/upload_camera.h"
#include "render/upload_sky.h"
#include "render/upload_textures.h"

#define BAND_PIXELS (4u << 20)      // of the film images: 64 MiB each, whatever the picture's size
#define CHUNK_SAMPLES 16            // samples a pixel gets in one dispatch, at most
#define CHUNK_SAMPLES_EXACT 1       // an undecided sample holds up those behind it

struct pass {
    struct context *ctx;
    struct device *device;
    const struct render_params *params;
    struct device_scene ds;
    struct device_textures textures;
    struct device_sky sky;
    struct storage_image film, residue, shade, id;
    struct buffer status, camera;
    struct camera_rays camera_rays;
    struct kernel_specialization specialization;
    struct kernel_binding bindings[BINDING_COUNT];
    size_t binding_count;
    struct kernel kernel;
    struct render_args args;
    struct pending pending;
    struct pending_work pending_work;
    struct pieces pieces;
    struct render_film *out;
    uint32_t width, height;         // of the film: the picture's, or those of its lattice
    uint32_t band_rows;             // of a full band
    uint64_t work_done, work_total; // groups × samples
    double trace_start;
};

// ------------------------------------------------------------------------------------------------------------- set-up

static bool make_film(struct pass *p) {
    struct context *ctx = p->ctx;
    uint32_t width = p->width, rows = BAND_PIXELS / width, limit = p->device->properties.limits.maxImageDimension2D;
    rows = (rows < limit ? rows : limit) / TILE_SIDE * TILE_SIDE;
    if (rows < TILE_SIDE) rows = TILE_SIDE;
    p->band_rows = rows < p->height ? rows : p->height;
    uint32_t aovs = p->params->aovs, shade = aovs & (GN_AOV_DEPTH | GN_AOV_NORMAL);
    const VkFormat real = VK_FORMAT_R32G32B32A32_SFLOAT, whole = VK_FORMAT_R32G32B32A32_SINT;
    return storage_image_init(&p->film, ctx, p->device, "film", real, width, p->band_rows) &&
           storage_image_init(&p->residue, ctx, p->device, "film residue", real, width, p->band_rows) &&
           storage_image_init(&p->shade, ctx, p->device, "depth and normal", real, shade ? width : 1, shade ? p->band_rows : 1) &&
           storage_image_init(&p->id, ctx, p->device, "id", whole, aovs ? width : 1, aovs ? p->band_rows : 1);
}

static bool make_status(struct buffer *status, struct context *ctx, struct device *device) {
    struct buffer_params params = {.name = "status", .kind = BUFFER_STORAGE, .size = sizeof(struct status), .host_writes = true, .host_reads = true};
    return buffer_init(status, ctx, device, &params);
}

static bool make_kernel(struct pass *p) {
    p->binding_count = device_scene_bindings(&p->ds, p->bindings, true);
    device_textures_bindings(&p->textures, p->bindings + p->binding_count);
    device_sky_bindings(&p->sky, p->bindings + p->binding_count + DEVICE_TEXTURES_BINDINGS);
    p->binding_count += DEVICE_TEXTURES_BINDINGS + DEVICE_SKY_BINDINGS;
    struct kernel_binding others[] = {
        {BINDING_FILM, NULL, &p->film},      {BINDING_RESIDUE, NULL, &p->residue}, {BINDING_AOV_SHADE, NULL, &p->shade},
        {BINDING_AOV_ID, NULL, &p->id},      {BINDING_STATUS, &p->status, NULL},   {BINDING_PENDING, &p->pending.buffer, NULL},
        {BINDING_CAMERA, &p->camera, NULL},
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) p->bindings[p->binding_count++] = others[i];
    p->specialization = (struct kernel_specialization){.tier = p->params->tier, .effects = p->params->effects, .aovs = p->params->aovs};
    memcpy(p->specialization.knobs, p->params->knobs, sizeof p->specialization.knobs);
    enum kernel_name name = p->params->tier == TIER_FP64 ? KERNEL_RENDER_FP64 : KERNEL_RENDER;
    return render_kernel_init(&p->kernel, p->ctx, p->device, name, &p->specialization, p->bindings, p->binding_count,
                              sizeof(struct render_args));
}

static struct render_place place_of(const struct kernel_binding *binding, const struct device *device) {
    const VkPhysicalDeviceLimits *limits = &device->properties.limits;
    if (binding->image) return (struct render_place){binding->image->name, 16ull * binding->image->width * binding->image->height, 0};
    const uint64_t limit = binding->buffer->kind == BUFFER_TEXELS ? 16ull * limits->maxTexelBufferElements : limits->maxStorageBufferRange;
    return (struct render_place){binding->buffer->name, binding->buffer->size, limit};
}

_Static_assert(RENDER_PLACES >= BINDING_COUNT, "all bindings have room");
static void note_places(struct pass *p) {
    for (size_t i = 0; i < p->binding_count; i++) p->out->places[p->out->place_count++] = place_of(&p->bindings[i], p->device);
}

static void make_pending_work(struct pass *p, const struct scene *scene, const struct bvh *bvh) {
    p->pending_work = (struct pending_work){
        .ctx = p->ctx,
        .device = p->device,
        .scene = scene,
        .bvh = bvh,
        .ds = &p->ds,
        .specialization = &p->specialization,
        .bindings = p->bindings,
        .binding_count = p->binding_count,
        .args = &p->args,
        .status = p->status.map,
    };
}

static vec4 vec4_of(const float v[3], float w) { return (vec4){v[0], v[1], v[2], w}; }

static void make_args(struct pass *p, const struct scene *scene) {
    const struct render_params *params = p->params;
    const struct camera_frame *frame = &p->camera_rays.frames[0];
    float position[3];
    device_point(position, &p->ds, scene->camera.position);
    p->args = (struct render_args){
        .position = vec4_of(position, 0),
        .corner = vec4_of(frame->corner, 1.0f / p->ds.scale),
        .du = vec4_of(frame->du, 0),
        .dv = vec4_of(frame->dv, 0),
        .width = p->width,
        .height = p->height,
        .spp = params->spp,
        .seed = params->seed,
        .light_count = p->ds.light_count,
        .root = p->ds.root,
        .stride = params->lattice.stride ? params->lattice.stride : 1,
        .phase = params->lattice.y * params->lattice.stride + params->lattice.x,
    };
}

// -------------------------------------------------------------------------------------------------------------- pieces

// An empty dispatch: drivers that compile at the first one do it here, and the time counts as the pipeline's.
static bool warm_up(struct pass *p) {
    p->args.band_rows = 0;
    p->args.tile_count = 1;
    return kernel_run(&p->kernel, p->ctx, p->device, &p->args, 1, NULL);
}

static bool count_status(struct pass *p, const struct status *status) {
    p->out->rays += status->rays;
    p->out->nonfinite_pixels += status->nonfinite;
    p->out->undecided_rays += status->undecided;
    p->out->second_stage_rays += status->decided;
    if (status->stuck == 0) return true;
    return fail(p->ctx, GN_LIMIT,
                "%u pixels need more than %u traversal steps for one sample, the most that this device's driver allows; "
                "another device or a newer driver may do (gnomon devices)",
                status->stuck, p->device->max_loop_steps);
}

static bool report_progress(struct pass *p) {
    double fraction = p->work_total ? (double)p->work_done / (double)p->work_total : 1;
    double spent = clock_seconds() - p->trace_start;
    return progress(p->ctx, "trace", fraction, fraction > 0 ? spent * (1 - fraction) / fraction : -1);
}

// One piece, dispatched until every pixel of it has its samples.
static bool run_piece(struct pass *p, uint32_t groups) {
    struct status *status = p->status.map, sums;
    bool again;
    do {
        double seconds;
        *status = (struct status){0};
        pending_clear(&p->pending);
        if (!kernel_run(&p->kernel, p->ctx, p->device, &p->args, groups, &seconds)) return false;
        pieces_learn(&p->pieces, groups, seconds);
        sums = *status;
        again = sums.unfinished > 0 || pending_overflowed(&p->pending);
        if (!pending_resolve(&p->pending, &p->pending_work, &sums)) return false;
        if (!count_status(p, &sums) || !report_progress(p)) return false;
    } while (again);
    return true;
}

static bool run_chunk(struct pass *p, uint32_t sample_begin, uint32_t sample_end) {
    p->args.sample_end = sample_end;
    for (uint32_t tile = 0; tile < p->args.tile_count;) {
        uint32_t left = p->args.tile_count - tile, groups = left < p->pieces.groups ? left : p->pieces.groups;
        p->args.first_tile = tile;
        if (!run_piece(p, groups)) return false;
        tile += groups;
        p->work_done += (uint64_t)groups * (sample_end - sample_begin);
    }
    return true;
}

// -------------------------------------------------------------------------------------------------------------- bands

static uint32_t tiles_of(uint32_t width, uint32_t rows) { return (width + TILE_SIDE - 1) / TILE_SIDE * ((rows + TILE_SIDE - 1) / TILE_SIDE); }

static uint32_t greatest_common_divisor(uint32_t a, uint32_t b) { return b ? greatest_common_divisor(b, a % b) : a; }

// Tiles are visited with a stride near the golden section of their number, so that every piece, and every half of it that a driver gives
// to a thread, is spread over the whole band. stride · tile stays below 2^32: a band has at most 2^16 tiles and one row of them.
static uint32_t tile_stride(uint32_t tiles) {
    if (tiles >= 1u << 16) return 1;
    uint32_t stride = (uint32_t)(0.6180339887 * tiles);
    while (stride > 1 && greatest_common_divisor(stride, tiles) != 1) stride--;
    return stride ? stride : 1;
}

static void store_color(struct pass *p, uint32_t band_y, uint32_t rows, const vec4 *sums, const vec4 *residues) {
    float *to = p->out->color.pixels + 3 * (size_t)band_y * p->width;
    for (size_t i = 0; i < (size_t)rows * p->width; i++, to += 3) {
        double finite = (double)sums[i].w - (double)residues[i].w, inverse = finite > 0 ? 1 / finite : 0;
        to[0] = (float)(((double)sums[i].x - residues[i].x) * inverse);
        to[1] = (float)(((double)sums[i].y - residues[i].y) * inverse);
        to[2] = (float)(((double)sums[i].z - residues[i].z) * inverse);
    }
}

static void store_aovs(struct pass *p, uint32_t band_y, uint32_t rows, const vec4 *shade, const int32_t *ids) {
    struct render_film *out = p->out;
    size_t start = (size_t)band_y * p->width;
    for (size_t i = 0; i < (size_t)rows * p->width; i++) {
        float hits = (float)ids[4 * i + 2];
        if (out->depth.pixels) out->depth.pixels[start + i] = hits > 0 ? shade[i].w / hits : INFINITY;
        if (out->normal.pixels) {
            float *normal = out->normal.pixels + 3 * (start + i);
            normal[0] = hits > 0 ? shade[i].x / hits : 0;
            normal[1] = hits > 0 ? shade[i].y / hits : 0;
            normal[2] = hits > 0 ? shade[i].z / hits : 0;
        }
        if (out->undecided.pixels) out->undecided.pixels[start + i] = (float)ids[4 * i + 3];
        if (!out->id.pixels) continue;
        out->id.pixels[2 * (start + i)] = (float)ids[4 * i];
        out->id.pixels[2 * (start + i) + 1] = (float)ids[4 * i + 1];
    }
}

// Reads the band back into the picture.
static bool read_band(struct pass *p, uint32_t band_y, uint32_t rows) {
    struct context *ctx = p->ctx;
    size_t pixels = (size_t)rows * p->width;
    vec4 *first = array_alloc(ctx, pixels, sizeof *first, "the film read back");
    vec4 *second = array_alloc(ctx, pixels, sizeof *second, "the film read back");
    bool ok = first && second && storage_image_download(&p->film, ctx, p->device, rows, first) &&
              storage_image_download(&p->residue, ctx, p->device, rows, second);
    if (ok) store_color(p, band_y, rows, first, second);
    bool shade = p->params->aovs & (GN_AOV_DEPTH | GN_AOV_NORMAL);
    if (ok && p->params->aovs) {
        ok = (!shade || storage_image_download(&p->shade, ctx, p->device, rows, first)) &&
             storage_image_download(&p->id, ctx, p->device, rows, second);
        if (ok) store_aovs(p, band_y, rows, first, (const int32_t *)second);
    }
    free(first);
    free(second);
    return ok;
}

static bool clear_film(struct pass *p) {
    struct storage_image *images[] = {&p->film, &p->residue, &p->shade, &p->id};
    for (int i = 0; i < 4; i++)
        if (!storage_image_clear(images[i], p->ctx, p->device)) return false;
    return true;
}

static bool render_band(struct pass *p, uint32_t band_y) {
    uint32_t left = p->height - band_y, rows = left < p->band_rows ? left : p->band_rows;
    if (band_y > 0 && !clear_film(p)) return false;
    p->args.band_y = band_y;
    p->args.band_rows = rows;
    p->args.tile_count = tiles_of(p->width, rows);
    p->args.tile_stride = tile_stride(p->args.tile_count);
    uint32_t spp = p->params->spp, chunk = p->params->tier == TIER_EXACT ? CHUNK_SAMPLES_EXACT : CHUNK_SAMPLES;
    for (uint32_t begin = 0; begin < spp; begin += chunk) {
        uint32_t end = spp - begin < chunk ? spp : begin + chunk;
        if (!run_chunk(p, begin, end)) return false;
    }
    return read_band(p, band_y, rows);
}

static bool render_bands(struct pass *p) {
    p->work_total = (uint64_t)tiles_of(p->width, p->height) * p->params->spp;
    p->trace_start = clock_seconds();
    for (uint32_t y = 0; y < p->height; y += p->band_rows)
        if (!render_band(p, y)) return false;
    return true;
}

// ------------------------------------------------------------------------------------------------------------ together

static bool make_images(struct pass *p) {
    struct render_film *out = p->out;
    struct context *ctx = p->ctx;
    const struct render_params *params = p->params;
    uint32_t w = p->width, h = p->height;
    return image_init(&out->color, ctx, w, h, 3, "the picture") &&
           (!(params->aovs & GN_AOV_DEPTH) || image_init(&out->depth, ctx, w, h, 1, "the depth picture")) &&
           (!(params->aovs & GN_AOV_NORMAL) || image_init(&out->normal, ctx, w, h, 3, "the normal picture")) &&
           (!(params->aovs & GN_AOV_ID) || image_init(&out->id, ctx, w, h, 2, "the id picture")) &&
           (!(params->aovs & GN_AOV_UNDECIDED) || image_init(&out->undecided, ctx, w, h, 1, "the picture of undecided rays"));
}

static bool run_pass(struct pass *p, const struct scene *scene, const struct bvh *bvh) {
    struct render_film *out = p->out;
    double start = clock_seconds();
    if (!device_scene_init(&p->ds, p->ctx, p->device, scene, bvh, p->params->effects, scene->camera.position, true)) return false;
    if (!device_textures_init(&p->textures, p->ctx, p->device, scene, p->params->effects)) return false;
    if (!device_sky_init(&p->sky, p->ctx, p->device, scene, p->params->effects)) return false;
    if (!make_film(p) || !make_status(&p->status, p->ctx, p->device)) return false;
    camera_rays_make(&p->camera_rays, &scene->camera, p->params->width, p->params->height);
    const struct upload_camera_params camera = {&p->camera_rays, &scene->film, p->ds.scale, p->params->effects};
    if (!upload_camera(&p->camera, p->ctx, p->device, &camera)) return false;
    if (!pending_init(&p->pending, p->ctx, p->device, p->params->tier == TIER_EXACT)) return false;
    out->upload_ms = clock_ms_since(start);
    start = clock_seconds();
    make_args(p, scene);
    if (!make_kernel(p)) return false;
    note_places(p);
    make_pending_work(p, scene, bvh);
    if (!warm_up(p)) return false;
    out->pipeline_ms = clock_ms_since(start);
    start = clock_seconds();
    if (!render_bands(p)) return false;
    out->trace_ms = clock_ms_since(start);
    return true;
}

static void pass_finish(struct pass *p) {
    pending_finish(&p->pending, p->device);
    kernel_finish(&p->kernel, p->device);
    buffer_finish(&p->status, p->device);
    buffer_finish(&p->camera, p->device);
    storage_image_finish(&p->film, p->device);
    storage_image_finish(&p->residue, p->device);
    storage_image_finish(&p->shade, p->device);
    storage_image_finish(&p->id, p->device);
    device_textures_finish(&p->textures, p->device);
    device_sky_finish(&p->sky, p->device);
    device_scene_finish(&p->ds, p->device);
}

bool render_picture(struct render_film *out, struct context *ctx, struct device *device, const struct scene *scene, const struct bvh *bvh,
                    const struct render_params *params) {
    *out = (struct render_film){0};
    uint32_t tile_groups = params->tile_pixels ? (params->tile_pixels + GROUP_SIZE - 1) / GROUP_SIZE : 0;
    struct pass p = {.ctx = ctx, .device = device, .params = params, .out = out, .pieces = pieces_make(tile_groups)};
    p.width = lattice_side(params->width, params->lattice.x, params->lattice.stride);
    p.height = lattice_side(params->height, params->lattice.y, params->lattice.stride);
    bool ok = tier_available(ctx, device, params->tier) && make_images(&p) && run_pass(&p, scene, bvh);
    pass_finish(&p);
    if (!ok) render_film_finish(out);
    return ok;
}

void render_film_finish(struct render_film *film) {
    image_finish(&film->color);
    image_finish(&film->depth);
    image_finish(&film->normal);
    image_finish(&film->id);
    image_finish(&film->undecided);
    *film = (struct render_film){0};
}
