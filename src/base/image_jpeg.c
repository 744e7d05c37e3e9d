// JPEG through libjpeg-turbo's simple interface: 8 bits a channel, grey or colour. What the decoder only warns of, such as an early end, is
// a fault here.
#include <stdlib.h>
#include <turbojpeg.h>

#include "base/image_codec.h"

// An empty 8 × 8 block of a grey picture takes a bit at least.
#define MOST_PIXELS_PER_BYTE 512.0

static bool jpeg_decode(tjhandle jpeg, struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    const unsigned char *data = (const unsigned char *)bytes->data;
    int width = 0, height = 0, subsampling, space;
    if (tjDecompressHeader3(jpeg, data, bytes->size, &width, &height, &subsampling, &space) != 0 || width < 0 || height < 0)
        return fail(ctx, GN_IO, "%s: is not a valid JPEG file: %s", path, tjGetErrorStr2(jpeg));
    if (!codes_init_announced(out, ctx, path, (uint64_t)width, (uint64_t)height, bytes->size, MOST_PIXELS_PER_BYTE)) return false;
    const int flags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT;
    return tjDecompress2(jpeg, data, bytes->size, out->pixels, width, 0, height, TJPF_RGBA, flags) == 0 ||
           fail(ctx, GN_IO, "%s: is not a valid JPEG file: %s", path, tjGetErrorStr2(jpeg));
}

bool codes_decode_jpeg(struct codes *out, struct context *ctx, const char *path, const struct file_bytes *bytes) {
    *out = (struct codes){0};
    tjhandle jpeg = tjInitDecompress();
    if (!jpeg) return fail(ctx, GN_LIMIT, "%s: no memory to decode it", path);
    const bool done = jpeg_decode(jpeg, out, ctx, path, bytes);
    tjDestroy(jpeg);
    if (!done) codes_finish(out);
    return done;
}
