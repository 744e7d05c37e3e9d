#include "measure/sample.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "reference/reference.h"

struct lattice sample_lattice(uint32_t width, uint32_t height, double pixels) {
    double all = (double)width * height;
    uint32_t stride = pixels < all ? (uint32_t)fmin(ceil(sqrt(all / fmax(pixels, 1))), 65535) : 1;
    uint32_t shorter = width < height ? width : height;
    if (stride > shorter) stride = shorter;
    return (struct lattice){.stride = stride, .x = stride / 2, .y = stride / 2};
}

double sample_pixels(const struct sample *sample) {
    const struct lattice *lattice = &sample->lattice;
    return (double)lattice_side(sample->width, lattice->x, lattice->stride) * lattice_side(sample->height, lattice->y, lattice->stride);
}

bool sample_reference(struct image *out, double *seconds, struct context *ctx, const struct sample *sample, uint32_t spp, uint32_t seed) {
    struct reference_film film;
    const struct reference_params params = {.width = sample->width,
                                            .height = sample->height,
                                            .spp = spp,
                                            .seed = seed,
                                            .effects = sample->effects,
                                            .lattice = sample->lattice};
    double start = clock_seconds();
    if (!reference_render(&film, ctx, sample->scene, sample->bvh, &params)) return false;
    *out = film.color;
    if (seconds) *seconds = clock_seconds() - start;
    return true;
}

double sample_rmse(const struct image *a, const struct image *b) {
    size_t count = (size_t)a->width * a->height * a->channels;
    double squares = 0;
    for (size_t i = 0; i < count; i++) {
        double difference = (double)a->pixels[i] - (double)b->pixels[i];
        squares += difference * difference;
    }
    return isfinite(squares) && count > 0 ? sqrt(squares / (double)count) : INFINITY;
}

bool sample_gather(struct image *out, struct context *ctx, const struct sample *sample, const struct image *whole) {
    const struct lattice *lattice = &sample->lattice;
    uint32_t stride = lattice->stride ? lattice->stride : 1, channels = whole->channels;
    uint32_t width = lattice_side(whole->width, lattice->x, stride), height = lattice_side(whole->height, lattice->y, stride);
    if (!image_init(out, ctx, width, height, channels, "a sample of the picture")) return false;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            size_t from = (lattice->y + (size_t)y * stride) * whole->width + lattice->x + (size_t)x * stride;
            memcpy(out->pixels + ((size_t)y * width + x) * channels, whole->pixels + from * channels, channels * sizeof(float));
        }
    return true;
}
