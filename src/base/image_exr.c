// OpenEXR through OpenEXRCore, the library's C interface: fp32 scan lines written; scan lines and tiles of half, float or uint read.
// Both work in memory: a file read is whole there already, and one that is written goes out at once when it is complete.
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/image_codec.h"

// The initializers of OpenEXR 3.3 name the first fields only.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

// A guess at what the strongest compression can do to a constant picture; what counts is that a small file claims no terabytes.
#define MOST_PIXELS_PER_BYTE 65536.0

// A file in memory: read from `source`, or written to `data`, which grows.
struct exr_memory {
    const char *source;
    unsigned char *data;
    size_t size, capacity;
    char message[256]; // the library's first complaint
};

// Memory for the library, zeroed: it leaves parts unwritten when a damaged file ends early.
static void *zeroed_memory(size_t size) { return calloc(1, size); }

// ---- writing

static int64_t memory_write(exr_const_context_t exr, void *user, const void *bytes, uint64_t size, uint64_t offset,
                            exr_stream_error_func_ptr_t error) {
    (void)exr, (void)error;
    struct exr_memory *memory = user;
    if (size > SIZE_MAX / 4 || offset > SIZE_MAX / 4) return -1;
    size_t end = (size_t)(offset + size);
    if (end > memory->capacity) {
        size_t capacity = end + end / 2;
        unsigned char *data = realloc(memory->data, capacity);
        if (!data) return -1;
        memset(data + memory->capacity, 0, capacity - memory->capacity);
        memory->data = data;
        memory->capacity = capacity;
    }
    memcpy(memory->data + offset, bytes, (size_t)size);
    if (end > memory->size) memory->size = end;
    return (int64_t)size;
}

// While writing, the library calls this with its own lock held, so nothing can be asked of it; the result code says enough.
static void drop_message(exr_const_context_t exr, exr_result_t code, const char *text) { (void)exr, (void)code, (void)text; }

struct exr_layers {
    const struct image_layer *layers;
    size_t count;
};

static exr_result_t describe(exr_context_t exr, const struct exr_layers *all) {
    const struct image *first = all->layers[0].image;
    int part;
    exr_result_t result = exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part);
    if (!result)
        result = exr_initialize_required_attr_simple(exr, part, (int32_t)first->width, (int32_t)first->height, EXR_COMPRESSION_ZIP);
    for (size_t i = 0; i < all->count; i++)
        for (uint32_t c = 0; !result && c < all->layers[i].image->channels; c++)
            result = exr_add_channel(exr, part, all->layers[i].names[c], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    return result ? result : exr_write_header(exr);
}

// Points a channel of the file to where its samples lie; row y of the image is the first of the chunk.
static void channel_from(exr_coding_channel_info_t *channel, const struct exr_layers *all, uint32_t y) {
    for (size_t i = 0; i < all->count; i++) {
        const struct image *image = all->layers[i].image;
        for (uint32_t c = 0; c < image->channels; c++) {
            if (strcmp(channel->channel_name, all->layers[i].names[c]) != 0) continue;
            channel->encode_from_ptr = (const uint8_t *)(image->pixels + (size_t)y * image->width * image->channels + c);
            channel->user_pixel_stride = (int32_t)(image->channels * sizeof(float));
            channel->user_line_stride = (int32_t)(image->width * image->channels * sizeof(float));
            channel->user_bytes_per_element = sizeof(float);
            channel->user_data_type = EXR_PIXEL_FLOAT;
        }
    }
}

static exr_result_t write_chunks(exr_context_t exr, const struct exr_layers *all) {
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    int32_t lines = 1;
    bool started = false;
    exr_result_t result = exr_get_scanlines_per_chunk(exr, 0, &lines);
    for (uint32_t y = 0; !result && y < all->layers[0].image->height; y += (uint32_t)lines) {
        result = exr_write_scanline_chunk_info(exr, 0, (int)y, &chunk);
        if (!result) result = started ? exr_encoding_update(exr, 0, &chunk, &encoder) : exr_encoding_initialize(exr, 0, &chunk, &encoder);
        if (result) break;
        for (int16_t i = 0; i < encoder.channel_count; i++) channel_from(&encoder.channels[i], all, y);
        if (!started) result = exr_encoding_choose_default_routines(exr, 0, &encoder);
        started = true;
        if (!result) result = exr_encoding_run(exr, 0, &encoder);
    }
    exr_encoding_destroy(exr, &encoder);
    return result;
}

static exr_result_t exr_encode(struct exr_memory *memory, const struct exr_layers *all) {
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.error_handler_fn = drop_message;
    how.user_data = memory;
    how.write_fn = memory_write;
    exr_context_t exr = NULL;
    exr_result_t result = exr_start_write(&exr, "memory", EXR_WRITE_FILE_DIRECTLY, &how);
    if (!result) result = describe(exr, all);
    if (!result) result = write_chunks(exr, all);
    exr_result_t finished = exr ? exr_finish(&exr) : EXR_ERR_SUCCESS;
    return result ? result : finished;
}

static bool check_layers(const struct exr_layers *all, struct context *ctx, const char *path) {
    const struct image *first = all->count > 0 ? all->layers[0].image : NULL;
    // The library counts in int32_t, and the bytes of a line, too.
    bool fine = first && first->width > 0 && first->height > 0 && first->height < INT32_MAX;
    fine = fine && first->width <= INT32_MAX / (4 * sizeof(float));
    for (size_t i = 0; fine && i < all->count; i++) {
        const struct image *image = all->layers[i].image;
        fine = image->pixels && image->width == first->width && image->height == first->height && image->channels <= 4;
        for (uint32_t c = 0; fine && c < image->channels; c++) fine = all->layers[i].names[c] != NULL;
    }
    return fine || fail(ctx, GN_INTERNAL, "%s: the layers of an EXR file must be of one size and have names", path);
}

bool image_write_exr(const struct image_layer *layers, size_t count, struct context *ctx, const char *path) {
    struct exr_layers all = {layers, count};
    struct exr_memory memory = {0};
    struct output_file file = {0};
    if (!check_layers(&all, ctx, path) || !output_begin(&file, ctx, path)) return false;
    exr_result_t result = exr_encode(&memory, &all);
    if (result) {
        bool memory_ended = result == EXR_ERR_OUT_OF_MEMORY || result == EXR_ERR_WRITE_IO;
        fail(ctx, memory_ended ? GN_LIMIT : GN_INTERNAL, "%s: cannot be encoded as EXR: %s", path, exr_get_default_error_message(result));
        goto fail;
    }
    if (!output_write(&file, ctx, memory.data, memory.size)) goto fail;
    free(memory.data);
    return output_commit(&file, ctx);
fail:
    free(memory.data);
    output_abort(&file);
    return false;
}

// ---- reading

static int64_t memory_read(exr_const_context_t exr, void *user, void *out, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t error) {
    (void)exr, (void)error;
    const struct exr_memory *memory = user;
    if (offset >= memory->size) return 0;
    size_t left = memory->size - (size_t)offset, count = size < left ? (size_t)size : left;
    memcpy(out, memory->source + offset, count);
    return (int64_t)count;
}

static int64_t memory_size(exr_const_context_t exr, void *user) {
    (void)exr;
    return (int64_t)((const struct exr_memory *)user)->size;
}

static void keep_message(exr_const_context_t exr, exr_result_t code, const char *text) {
    (void)code;
    void *user = NULL;
    if (!exr || exr_get_user_data(exr, &user) != EXR_ERR_SUCCESS || !user) return;
    struct exr_memory *memory = user;
    if (!memory->message[0]) snprintf(memory->message, sizeof memory->message, "%s", text);
}

// A file being read. Of a grey file all three sources are the one channel Y.
struct exr_reader {
    exr_context_t exr;
    struct exr_memory memory;
    exr_attr_box2i_t window;
    const char *sources[3];
    bool tiled;
};

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *name) {
    for (int i = 0; i < list->num_channels; i++)
        if (strcmp(list->entries[i].name.str, name) == 0) return &list->entries[i];
    return NULL;
}

static bool choose_channels(struct exr_reader *reader, struct context *ctx, const char *path) {
    static const char *const colours[3] = {"R", "G", "B"};
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_channels(reader->exr, 0, &list) != EXR_ERR_SUCCESS || !list) return fail(ctx, GN_IO, "%s: has no channels", path);
    bool coloured = find_channel(list, "R") && find_channel(list, "G") && find_channel(list, "B");
    if (!coloured && !find_channel(list, "Y")) return fail(ctx, GN_IO, "%s: has no channels R, G, B, nor Y", path);
    for (int i = 0; i < 3; i++) {
        const exr_attr_chlist_entry_t *channel = find_channel(list, coloured ? colours[i] : "Y");
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return fail(ctx, GN_IO, "%s: channel %s is subsampled, which is not supported", path, channel->name.str);
        reader->sources[i] = channel->name.str;
    }
    return true;
}

static bool open_reader(struct exr_reader *reader, struct context *ctx, const char *path) {
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.error_handler_fn = keep_message;
    how.alloc_fn = zeroed_memory;
    how.free_fn = free;
    how.user_data = &reader->memory;
    how.read_fn = memory_read;
    how.size_fn = memory_size;
    how.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    int parts = 0;
    exr_result_t result = exr_start_read(&reader->exr, "memory", &how);
    if (!result) result = exr_get_count(reader->exr, &parts);
    if (!result) result = exr_get_storage(reader->exr, 0, &storage);
    if (!result) result = exr_get_data_window(reader->exr, 0, &reader->window);
    if (result) {
        const char *why = reader->memory.message[0] ? reader->memory.message : exr_get_default_error_message(result);
        return fail(ctx, GN_IO, "%s: is not a valid EXR file: %s", path, why);
    }
    if (parts != 1) return fail(ctx, GN_IO, "%s: has %d parts; a file of one part was expected", path, parts);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return fail(ctx, GN_IO, "%s: has deep pixels, which are not supported", path);
    reader->tiled = storage == EXR_STORAGE_TILED;
    return choose_channels(reader, ctx, path);
}

// Decodes one chunk to where it belongs: its corner is pixel (x, y) of the image. `decoder` is zeroed before the first.
static exr_result_t decode_chunk(const struct exr_reader *reader, const struct image *out, exr_decode_pipeline_t *decoder,
                                 const exr_chunk_info_t *chunk, int64_t x, int64_t y) {
    if (x + chunk->width > out->width || y + chunk->height > out->height || chunk->packed_size == 0) return EXR_ERR_CORRUPT_CHUNK;
    bool first = decoder->context == NULL;
    exr_result_t result =
        first ? exr_decoding_initialize(reader->exr, 0, chunk, decoder) : exr_decoding_update(reader->exr, 0, chunk, decoder);
    if (result) return result;
    // A channel of the file can feed several of ours (Y), so only the first is decoded to; spread_grey copies the others.
    for (int16_t i = 0; i < decoder->channel_count; i++) {
        exr_coding_channel_info_t *channel = &decoder->channels[i];
        channel->decode_to_ptr = NULL;
        for (size_t c = 3; c-- > 0;)
            if (strcmp(channel->channel_name, reader->sources[c]) == 0)
                channel->decode_to_ptr = (uint8_t *)(out->pixels + ((size_t)y * out->width + (size_t)x) * 3 + c);
        channel->user_pixel_stride = 3 * sizeof(float);
        channel->user_line_stride = (int32_t)(out->width * 3 * sizeof(float));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    if (first) result = exr_decoding_choose_default_routines(reader->exr, 0, decoder);
    return result ? result : exr_decoding_run(reader->exr, 0, decoder);
}

static exr_result_t read_scan_lines(const struct exr_reader *reader, const struct image *out, exr_decode_pipeline_t *decoder) {
    int32_t lines = 1;
    exr_chunk_info_t chunk;
    exr_result_t result = exr_get_scanlines_per_chunk(reader->exr, 0, &lines);
    if (!result && lines < 1) result = EXR_ERR_CORRUPT_CHUNK;
    for (int64_t y = 0; !result && y < out->height; y += lines) {
        result = exr_read_scanline_chunk_info(reader->exr, 0, (int)(y + reader->window.min.y), &chunk);
        if (!result) result = decode_chunk(reader, out, decoder, &chunk, 0, y);
    }
    return result;
}

static exr_result_t read_tiles(const struct exr_reader *reader, const struct image *out, exr_decode_pipeline_t *decoder) {
    int32_t width = 0, height = 0;
    exr_chunk_info_t chunk;
    exr_result_t result = exr_get_tile_sizes(reader->exr, 0, 0, 0, &width, &height);
    if (!result && (width < 1 || height < 1)) result = EXR_ERR_CORRUPT_CHUNK;
    for (int64_t y = 0; !result && y < out->height; y += height)
        for (int64_t x = 0; !result && x < out->width; x += width) {
            result = exr_read_tile_chunk_info(reader->exr, 0, (int)(x / width), (int)(y / height), 0, 0, &chunk);
            if (!result) result = decode_chunk(reader, out, decoder, &chunk, x, y);
        }
    return result;
}

static void spread_grey(struct image *image) {
    size_t count = (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++) image->pixels[3 * i + 1] = image->pixels[3 * i + 2] = image->pixels[3 * i];
}

bool image_decode_exr(struct image *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    *out = (struct image){0};
    struct exr_reader reader = {.memory = {.source = bytes->data, .size = bytes->size}};
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_UNKNOWN;
    if (!open_reader(&reader, ctx, path)) goto finish;
    uint64_t width = (uint64_t)((int64_t)reader.window.max.x - reader.window.min.x + 1);
    uint64_t height = (uint64_t)((int64_t)reader.window.max.y - reader.window.min.y + 1);
    if (!image_init_announced(out, ctx, path, width, height, bytes->size, MOST_PIXELS_PER_BYTE)) goto finish;
    result = reader.tiled ? read_tiles(&reader, out, &decoder) : read_scan_lines(&reader, out, &decoder);
    if (result) {
        const char *why = reader.memory.message[0] ? reader.memory.message : exr_get_default_error_message(result);
        fail(ctx, GN_IO, "%s: its pixels cannot be decoded: %s", path, why);
    } else if (strcmp(reader.sources[0], "Y") == 0) {
        spread_grey(out);
    }
finish:
    if (reader.exr) exr_decoding_destroy(reader.exr, &decoder);
    if (reader.exr) exr_finish(&reader.exr);
    if (result) image_finish(out);
    return result == EXR_ERR_SUCCESS;
}
