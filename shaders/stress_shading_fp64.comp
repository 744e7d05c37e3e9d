// One function of shading at a time, in fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "stress_shading.glsl"
