// False colour: black, purple, red, orange, pale yellow, always lighter.
#include <math.h>

#include "measure/compare.h"

// sRGB codes at equal steps from 0 to 1; between them codes are interpolated.
static const uint8_t ANCHORS[][3] = {{0, 0, 6},      {36, 14, 72},   {92, 24, 120},   {150, 38, 122}, {206, 62, 104},
                                     {242, 104, 82}, {252, 158, 92}, {254, 210, 136}, {255, 250, 205}};
enum { INTERVALS = sizeof ANCHORS / sizeof *ANCHORS - 1 };

// The linear light of each of 256 steps.
static void make_table(float table[256][3]) {
    for (unsigned step = 0; step < 256; step++) {
        double place = step / 255.0 * INTERVALS;
        unsigned left = place < INTERVALS ? (unsigned)place : INTERVALS - 1;
        for (unsigned c = 0; c < 3; c++) {
            double code = ANCHORS[left][c] + (place - left) * (ANCHORS[left + 1][c] - ANCHORS[left][c]);
            table[step][c] = transfer_decode(TRANSFER_SRGB, (uint8_t)lround(code));
        }
    }
}

bool heat_map(struct image *out, struct context *ctx, const struct image *values) {
    if (!image_init(out, ctx, values->width, values->height, 3, "the heat map")) return false;
    float table[256][3];
    make_table(table);
    size_t count = (size_t)values->width * values->height;
    for (size_t i = 0; i < count; i++) {
        const float *colour = table[transfer_encode(TRANSFER_LINEAR, values->pixels[i * values->channels])];
        for (size_t c = 0; c < 3; c++) out->pixels[3 * i + c] = colour[c];
    }
    return true;
}
