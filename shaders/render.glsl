// Renders: each workgroup a tile of 8 × 8 pixels, each invocation a pixel, from the samples it has to args.sample_end. Included by render.comp and, with FP64
// defined, by render_fp64.comp.
//
// One loop shoots every kind of ray, so that the traversal stands in the kernel once: first the camera ray, then for each light that adds anything a
// shadow ray. Everything is inlined by the drivers; a second call site would double the kernel and its compile time.
#ifndef RENDER_GLSL
#define RENDER_GLSL
#include "shared.h"
#include "camera.glsl"
#include "constants.glsl"
#include "film.glsl"
#include "filter.glsl"
#include "light.glsl"
#include "pending.glsl"
#include "phong.glsl"
#include "ray.glsl"
#include "sampler.glsl"
#include "surface.glsl"
#include "traverse.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { render_args args; };
layout(set = 0, binding = BINDING_GLOBALS) uniform usamplerBuffer global_words;
layout(set = 0, binding = BINDING_CAMERA) uniform usamplerBuffer camera_words;
layout(set = 0, binding = BINDING_STATUS) buffer status_buffer { status dispatch_status; };

const bool HAS_LIGHT = HAS_DIFFUSE || HAS_SPECULAR;

real3 background() { return real3(uintBitsToFloat(texelFetch(global_words, 0).xyz)); }
real3 ambient() { return real3(uintBitsToFloat(texelFetch(global_words, 1).xyz)); }

// The pixel of this invocation in the band's images; false beyond the film's edge.
bool find_pixel(out ivec2 at) {
    uint tile = ((args.first_tile + gl_WorkGroupID.x) * args.tile_stride) % args.tile_count;
    uint tiles_across = (args.width + TILE_SIDE - 1u) / TILE_SIDE;
    uvec2 origin = uvec2(tile % tiles_across, tile / tiles_across) * TILE_SIDE;
    uvec2 within = uvec2(gl_LocalInvocationID.x % TILE_SIDE, gl_LocalInvocationID.x / TILE_SIDE);
    at = ivec2(origin + within);
    return at.x < int(args.width) && at.y < int(args.band_rows);
}

// The pixel of the picture that stands at `at` in the band's images.
uvec2 picture_pixel(ivec2 at) {
    return (uvec2(at) + uvec2(0u, args.band_y)) * args.stride + uvec2(args.phase % args.stride, args.phase / args.stride);
}

vec4 camera_word(int word) { return uintBitsToFloat(texelFetch(camera_words, word)); }

float filter_knot(uint knot) { return camera_word(CAMERA_FILTER_WORD + int(knot / 4u))[knot % 4u]; }

float filtered(float u) {
    filter_cell cell = filter_cell_of(u);
    return filter_offset(cell, filter_knot(cell.knot), filter_knot(cell.knot + 1u));
}

vec2 film_position(draws d) {
    vec2 offset = HAS_ANTIALIASING ? film_offset(d.seed, d.pixel, d.number, args.spp) : vec2(0.5);
    return HAS_FILTER ? vec2(filtered(offset.x), filtered(offset.y)) : offset;
}

camera_frame camera_frame_number(int number) {
    int word = CAMERA_FRAMES_WORD + 3 * number;
    return camera_frame(camera_word(word).xyz, camera_word(word + 1).xyz, camera_word(word + 2).xyz);
}

camera_frame camera_frame_at(float time) {
    float frames = time * float(CAMERA_FRAMES); // exact
    int first = int(frames);
    return camera_frame_between(camera_frame_number(first), camera_frame_number(first + 1), frames - float(first));
}

ray camera_ray(uvec2 pixel, uint number) {
    draws d = draws(args.seed, pixel, number);
    camera_frame frame = camera_frame(args.corner.xyz, args.du.xyz, args.dv.xyz);
    vec3 position = args.position.xyz;
    float time = 0.0;
    if (HAS_MOTION_BLUR) {
        time = draw(d, PAIR_TIME).x;
        frame = camera_frame_at(time);
        position = camera_position(position, camera_word(0).xyz, time);
    }
    vec3 direction = camera_direction(frame.corner, frame.du, frame.dv, pixel, film_position(d));
    if (HAS_DEPTH_OF_FIELD) {
        vec2 point = camera_disk_point(draw(d, PAIR_LENS));
        position = camera_add(position, camera_lens_point(point, camera_word(0).w, frame.du, frame.dv));
        direction = camera_add(direction, -camera_lens_point(point, camera_word(1).x, frame.du, frame.dv));
    }
    ray r = ray_make(real3(position), real3(direction), 0.0, INFINITY, SELF_NONE);
    r.time = time;
    return r;
}

// What light `number` would add at s, seen along -v, if nothing is in its way; and the way to it.
real3 light_reflect(surface s, phong_material m, real3 v, uint number, out real3 position) {
    uvec4 w0 = light_word(number, 0u), w1 = light_word(number, 1u);
    position = light_xyz(w0);
    real3 way = position - s.p;
    real3 l = normalize_any(way);
    real distance = dot(way, l) * args.corner.w;
    real3 light = light_arriving(light_xyz(w1), uintBitsToFloat(w1.w), distance);
    if (w0.w != POINT_LIGHT) return real3(0.0);
    return light * phong_reflect(m, s.n, l, v, HAS_DIFFUSE, HAS_SPECULAR);
}

// The sample of a camera ray that hits s, still black.
film_sample black_sample(surface s, ray r, hit h) {
    real depth = h.t * sqrt(dot(r.d, r.d)) * args.corner.w;
    return film_sample(vec3(0.0), vec3(s.n), float(depth), h.object, h.index);
}

// How a sample ended.
#define SAMPLE_DONE 0u
#define SAMPLE_OUT_OF_STEPS 1u
#define SAMPLE_UNDECIDED 2u

// One sample: the camera ray, and the shadow rays of what it hits. Only with SAMPLE_DONE is the result to be used.
film_sample shoot_sample(ray camera, inout int steps, inout uint rays, inout pending_sample pending, out uint end) {
    film_sample result = film_sample(vec3(0.0), vec3(0.0), 0.0, -1, -1);
    real3 radiance = background();
    surface s;
    phong_material m;
    real3 v = real3(0.0), adds = real3(0.0);
    uint light = 0u;            // the next one to look at
    uint number = 0u;           // of the ray in the sample
    bool more = true;
    ray r = camera;
    end = SAMPLE_DONE;
    do {
        bool first = number == 0u;
        hit h;
        if (!pending_answer(pending, number, h)) {
            search q = traverse(r, !first, args.root, steps);
            h = q.best;
            if (search_undecided(q, !first)) {
                pending_ask(pending, r, !first, number);
                end = SAMPLE_UNDECIDED;
                return result;
            }
        }
        number++;
        if (!first) {
            if (h.object < 0) radiance += adds;
        } else if (h.object >= 0) {
            s = surface_at(r, h);
            m = material_at(s.material);
            v = -normalize_tier(r.d);
            radiance = ambient() * m.ambient;
            result = black_sample(s, r, h);
        } else {
            light = args.light_count;
        }
        more = false;
        while (HAS_LIGHT && !more && light < args.light_count && steps > 0) {
            steps--;
            real3 position;
            adds = light_reflect(s, m, v, light, position);
            light++;
            if (HAS_SHADOWS) {
                real3 start = leave_surface(s);
                more = adds != real3(0.0);
                r = ray_make(start, position - start, 0.0, 1.0, leave_self(s));
            } else {
                radiance += adds;
            }
        }
        if (HAS_LIGHT && !more && light < args.light_count) steps = 0;
    } while (more && steps > 0);
    rays += number;
    result.radiance = vec3(radiance);
    if (more || steps <= 0) end = SAMPLE_OUT_OF_STEPS;
    return result;
}

// Brings a pixel on to args.sample_end, as far as steps and decisions go. With RESOLVE: one sample only.
void expose(inout film_pixel pixel, uvec2 position, inout pending_sample pending, inout uint rays) {
    int steps = int(MAX_STEPS);
    uint end = SAMPLE_DONE;
    uint sample_end = RESOLVE ? pixel.done + 1u : args.sample_end;
    while (pixel.done < sample_end && end == SAMPLE_DONE) {
        film_sample result = shoot_sample(camera_ray(position, pixel.done), steps, rays, pending, end);
        steps--;
        if (end == SAMPLE_DONE) film_add(pixel, result);
    }
}

// `asks`: a ray was undecided; `stored`: its question was written down.
void report(film_pixel before, film_pixel after, uint rays, bool asks, bool stored) {
    atomicAdd(dispatch_status.rays, rays);
    if (after.nonfinite != before.nonfinite) atomicAdd(dispatch_status.nonfinite, 1u);
    if (stored) atomicAdd(dispatch_status.undecided, 1u);
    uint pending = asks ? 1u : 0u; // a sample that the host brings to its end
    if (after.done + pending < args.sample_end) {
        atomicAdd(dispatch_status.unfinished, 1u);
        if (after.done == before.done && !asks) atomicAdd(dispatch_status.stuck, 1u);
    }
}

void main() {
    pending_sample pending;
    ivec2 at;
    if (!(RESOLVE ? pending_find(pending, at) : find_pixel(at))) return;
    if (!RESOLVE) pending = pending_none();
    film_pixel before = film_load(at), pixel = before;
    uint rays = 0u;
    expose(pixel, picture_pixel(at), pending, rays);
    bool stored = TIER == TIER_EXACT && pending_store(pending, at);
    if ((AOVS & AOV_UNDECIDED) != 0u && stored) pixel.id.w++;
    film_store(at, pixel);
    report(before, pixel, rays, pending.asks, stored);
}

#endif
