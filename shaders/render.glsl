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
#include "pending.glsl"
#include "ray.glsl"
#include "traverse.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(push_constant) uniform push { render_args args; };
#include "path.glsl"
layout(set = 0, binding = BINDING_CAMERA) uniform usamplerBuffer camera_words;
layout(set = 0, binding = BINDING_STATUS) buffer status_buffer { status dispatch_status; };

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

// The sample of a path that comes to s first, still black. Behind a hole (`behind`) the ray does not begin at the camera.
film_sample black_sample(surface s, ray camera, ray r, hit h, bool behind) {
    real depth = HAS_ALPHA && behind ? length_of(s.p - camera.o) : h.t * length_of(r.d);
    return film_sample(vec3(0.0), vec3(s.n), float(depth * args.corner.w), h.object, h.index);
}

// How a sample ended.
#define SAMPLE_DONE 0u
#define SAMPLE_OUT_OF_STEPS 1u
#define SAMPLE_UNDECIDED 2u

// Where a ray goes on behind a place where the surface that it hit is not there.
ray pass_through(ray r, surface s, bool shadow) {
    s.ng = -s.ng;
    real3 start = leave_surface(s);
    ray on = r;
    on.o = start;
    on.self = leave_self(s);
    if (shadow && r.tmax != INFINITY) on.d = r.d + (r.o - start) / r.tmax;
    return on;
}

// A path comes to a surface: what shines there, and what stands ready for light.
void arrive(inout path p, inout vertex at, surface s, material m, ray r, hit h, inout int steps) {
    at = vertex(s, m, -normalize_tier(r.d), false);
    p.light = is_specular(m) ? LIGHTS_DONE : 0u;
    if (HAS_ABSORPTION) p.throughput *= absorb_on_the_way(p, h.t * length_of(r.d));
    if (HAS_EMISSION) add_emission(p, s, m, r, h, steps);
    p.radiance += p.throughput * (ambient() * m.ambient);
}

// One sample: the path of a camera ray, with a shadow ray to each light from each of its points. Only with SAMPLE_DONE is the result to be used.
film_sample shoot_sample(ray camera, draws d, inout int steps, inout uint rays, inout pending_sample pending, out uint end) {
    film_sample result = film_sample(vec3(0.0), vec3(0.0), 0.0, -1, -1);
    path p = path_begin(camera);
    vertex at;
    uint number = 0u;           // of the ray in the sample
    bool shadow = false, more;
    ray r = camera;
    end = SAMPLE_DONE;
    do {
        hit h;
        bool any = shadow && !HAS_ALPHA;
        if (!pending_answer(pending, number, h)) {
            search q = traverse(r, any, args.root, steps);
            h = q.best;
            if (search_undecided(q, any)) {
                pending_ask(pending, r, any, number);
                end = SAMPLE_UNDECIDED;
                return result;
            }
        }
        surface s;
        material m;
        bool there = h.object >= 0, hole = false, ends = false;
        bool scatters = HAS_FOG && !shadow && fog_scatters(r, h.t, draw(d, PAIR_FOG + number).x, at);
        if (there && !scatters && (!shadow || HAS_ALPHA)) {
            s = surface_at(r, h);
            m = material_at(s);
            if (HAS_ALPHA) hole = !(real(draw(d, PAIR_ALPHA + number).x) < m.alpha);
        }
        number++;
        if (scatters) {
            p.light = 0u;
            p.throughput *= real3(uintBitsToFloat(global_word(2).xyz));
        } else if (hole) {
            r = pass_through(r, s, shadow);
        } else if (shadow) {
            if (!there) p.radiance += p.adds;
        } else if (there) {
            arrive(p, at, s, m, r, h, steps);
            if (p.depth == 0u) result = black_sample(s, camera, r, h, number > 1u);
        } else {
            add_sky(p, r);
            ends = true;
        }
        more = hole;
        if (!hole && !ends) {
            shadow = shadow_ray(p, at, d, steps, r);
            more = shadow || (GOES_ON && next_ray(p, at, d, r));
        }
        steps--;
    } while (more && steps > 0);
    rays += number;
    result.radiance = vec3(p.radiance);
    if (more || steps <= 0) end = SAMPLE_OUT_OF_STEPS;
    return result;
}

// Brings a pixel on to args.sample_end, as far as steps and decisions go. With RESOLVE: one sample only.
void expose(inout film_pixel pixel, uvec2 position, inout pending_sample pending, inout uint rays) {
    int steps = int(MAX_STEPS);
    uint end = SAMPLE_DONE;
    uint sample_end = RESOLVE ? pixel.done + 1u : args.sample_end;
    while (pixel.done < sample_end && end == SAMPLE_DONE) {
        draws d = draws(args.seed, position, pixel.done);
        film_sample result = shoot_sample(camera_ray(position, pixel.done), d, steps, rays, pending, end);
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
