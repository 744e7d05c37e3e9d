// What a device makes of fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "arithmetic.glsl"
