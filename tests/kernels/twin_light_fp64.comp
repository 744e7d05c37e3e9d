// The lights that have a size, and the spot's cone, in fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "twin_light.glsl"
