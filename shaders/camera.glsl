// Camera rays: the sequence of fp32 operations that render/camera.h defines, so that the reference shoots the same ray to the bit.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

// Direction through film position (pixel + offset); not normalised.
vec3 camera_direction(vec3 corner, vec3 du, vec3 dv, uvec2 pixel, vec2 offset) {
    precise vec3 to_pixel = (corner + float(pixel.x) * du) + float(pixel.y) * dv;
    precise vec3 within = offset.x * du + offset.y * dv;
    precise vec3 direction = to_pixel + within;
    return direction;
}

#endif
