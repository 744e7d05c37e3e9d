// Lights as the words of shared.h.
#ifndef RENDER_UPLOAD_LIGHTS_H
#define RENDER_UPLOAD_LIGHTS_H

#include "render/light_table.h"
#include "shaders/shared.h"

// Where device coordinates come from, as in render/upload.h.
struct light_frame {
    const struct scene *scene;
    const struct light_table *table;
    float base[3], scale;
};

void write_light(struct word4 to[LIGHT_WORDS], const struct light_frame *frame, uint32_t light);
void write_emitter(struct word4 to[EMITTER_WORDS], const struct light_frame *frame, uint32_t number);

#endif
