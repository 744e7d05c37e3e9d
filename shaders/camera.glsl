// Camera rays: the sequence of fp32 operations that render/camera.h defines, so that the reference shoots the same ray to the bit.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

struct camera_frame { vec3 corner, du, dv; };

// From a to b, where 0 <= share < 1.
vec3 camera_between(vec3 a, vec3 b, float share) {
    precise vec3 way = b - a;
    precise vec3 part = share * way;
    precise vec3 at = a + part;
    return at;
}

camera_frame camera_frame_between(camera_frame a, camera_frame b, float share) {
    return camera_frame(camera_between(a.corner, b.corner, share), camera_between(a.du, b.du, share), camera_between(a.dv, b.dv, share));
}

// Where the camera is at a time, 0 when the shutter opens and 1 when it closes.
vec3 camera_position(vec3 position, vec3 travel, float time) {
    precise vec3 part = time * travel;
    precise vec3 at = position + part;
    return at;
}

// Direction through film position (pixel + offset); not normalised.
vec3 camera_direction(vec3 corner, vec3 du, vec3 dv, uvec2 pixel, vec2 offset) {
    precise vec3 to_pixel = (corner + float(pixel.x) * du) + float(pixel.y) * dv;
    precise vec3 within = offset.x * du + offset.y * dv;
    precise vec3 direction = to_pixel + within;
    return direction;
}

// A point of the unit disk on a lens of this radius, relative to its middle.
vec3 camera_lens_point(vec2 point, float radius, vec3 du, vec3 dv) {
    precise vec2 scaled = point * radius;
    precise vec3 at = scaled.x * du + scaled.y * dv;
    return at;
}

vec3 camera_add(vec3 a, vec3 b) {
    precise vec3 sum = a + b;
    return sum;
}

// 1/x for 2^-24 <= x <= 1: a first guess from the exponent's complement, off by 12 % at most, and three steps of Newton's, each of which squares the error.
float camera_inverse(float x) {
    precise float inverse = uintBitsToFloat(0x7ef311c7u - floatBitsToUint(x));
    for (int i = 0; i < 3; i++) {
        precise float rest = 2.0 - x * inverse;
        inverse = inverse * rest;
    }
    return inverse;
}

// The unit disk, evenly, from the unit square: the distance from the middle is that of the square, the angle pi/4 times how far around the square's side; its sine
// and cosine are Taylor's, to 3e-8.
vec2 camera_disk_point(vec2 u) {
    vec2 at = 2.0 * u - 1.0; // exact
    bool wide = abs(at.x) > abs(at.y);
    float r = wide ? at.x : at.y, side = wide ? at.y : at.x;
    precise float inverse = camera_inverse(max(abs(r), 5.9604644775390625e-8)); // in the middle 0/0 is 0
    precise float turn = (r < 0.0 ? -side : side) * inverse;
    precise float t = turn * turn;
    precise float sine = (((3.13361689e-7 * t - 3.65762042e-5) * t + 0.00249039457) * t - 0.0807455122) * t + 0.785398163;
    precise float cosine = (((3.59086045e-6 * t - 0.000325991887) * t + 0.0158543442) * t - 0.308425138) * t + 1.0;
    sine = sine * turn;
    precise vec2 point = r * vec2(cosine, sine);
    return wide ? point : point.yx;
}

#endif
